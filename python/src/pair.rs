//! Calls on two frames.

use pyo3::prelude::*;
use veronese::SegmentOptions;

use crate::frames::given;
use crate::options;
use crate::results;
use crate::worker::alone;

/// A `Segmentation`.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "they are named in Python")]
pub(crate) fn segment_pair<'py>(
    py: Python<'py>,
    first: &Bound<'py, PyAny>,
    second: &Bound<'py, PyAny>,
    motions: &Bound<'py, PyAny>,
    quality: &Bound<'py, PyAny>,
    mark_unknown: bool,
    confidence: bool,
    subject: bool,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let options = SegmentOptions::default()
        .with_motions(options::motions(motions)?)
        .with_quality(options::quality(quality)?)
        .with_mark_unknown(mark_unknown)
        .with_confidence(confidence)
        .with_subject(subject);
    let (first, second) = (given("the first frame", first)?, given("the second frame", second)?);
    let segmentation = alone(py, progress, move |progress| {
        Ok(veronese::segment_pair(&first.frame()?, &second.frame()?, &options, progress)?)
    })?;
    results::segmentation(py, segmentation, options.quality)
}
