//! Calls on two frames.

use numpy::{PyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;
use veronese::{AffineMotion, Correction, SegmentOptions};

use crate::errors::Failure;
use crate::frames::{given, image, values};
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

/// The motions of a `Segmentation`, the labels and the number of unlabelled pixels. `matrices` has a row of six entries for each motion.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "they are named in Python")]
pub(crate) fn relabel<'py>(
    py: Python<'py>,
    first: &Bound<'py, PyAny>,
    second: &Bound<'py, PyAny>,
    matrices: &Bound<'py, PyArrayDyn<f64>>,
    groups: Vec<u8>,
    labels: &Bound<'py, PyAny>,
    evidence: &Bound<'py, PyAny>,
    quality: &Bound<'py, PyAny>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<(Vec<Bound<'py, PyAny>>, Bound<'py, PyAny>, usize)> {
    let options = SegmentOptions::default().with_quality(options::quality(quality)?);
    let (first, second) = (given("the first frame", first)?, given("the second frame", second)?);
    let (labels, size) = image::<u8>("the labels", "uint8", labels)?;
    let (evidence, of) = image::<u16>("the evidence", "uint16", evidence)?;
    if size != of {
        return Err(Failure::input("the labels and the evidence differ in size".into()).into());
    }
    let [_, 6] = *matrices.shape() else {
        return Err(Failure::input("the matrices must hold 6 numbers each".into()).into());
    };
    let entries = values("the matrices", matrices)?;
    let motions: Vec<AffineMotion> = entries.as_chunks().0.iter().map(|&entries| AffineMotion::new(entries)).collect();
    let relabelled = alone(py, progress, move |progress| {
        let (first, second) = (first.frame()?, second.frame()?);
        if size != [first.width(), first.height()] {
            return Err(Failure::input("the labels do not have the size of the frames".into()));
        }
        let correction = Correction { motions: &motions, groups: &groups, labels: &labels, allowed: &evidence };
        Ok(veronese::relabel(&first, &second, &correction, &options, progress)?)
    })?;
    let motions = relabelled.motions.iter().map(|motion| results::segmented_motion(py, motion));
    Ok((motions.collect::<PyResult<_>>()?, results::labels(py, relabelled.labels, size)?, relabelled.unlabelled))
}
