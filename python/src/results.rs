//! Results as the classes of `veronese._types`.
//!
//! The order of arguments is that of the fields there.

use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use veronese::clip::{Changed, ClipFrame, ClipObject, Description, FrameStatus, Object};
use veronese::embedding::rank::RankCandidate;
use veronese::refinement::Report;
use veronese::{
    AffineMotion, Candidate, FitEvidence, FittedMotion, Junction, MotionFit, PairEvidence, PaperStages, Quality,
    Segmentation, SegmentedMotion,
};

type Value<'py> = Bound<'py, PyAny>;

pub(crate) fn class<'py>(py: Python<'py>, name: &str) -> PyResult<Value<'py>> {
    py.import("veronese._types")?.getattr(name)
}

fn all<'py, T>(
    py: Python<'py>,
    items: &[T],
    convert: impl Fn(Python<'py>, &T) -> PyResult<Value<'py>>,
) -> PyResult<Vec<Value<'py>>> {
    items.iter().map(|item| convert(py, item)).collect()
}

/// An image with one byte per pixel, from its width and height.
pub(crate) fn labels<'py>(py: Python<'py>, bytes: Vec<u8>, [width, height]: [usize; 2]) -> PyResult<Value<'py>> {
    Ok(PyArray1::from_vec(py, bytes).reshape([height, width])?.into_any())
}

/// An array of six numbers.
fn matrix<'py>(py: Python<'py>, motion: &AffineMotion) -> Value<'py> {
    PyArray1::from_slice(py, &motion.matrix).into_any()
}

fn numbers<'py>(py: Python<'py>, values: &[f64]) -> Value<'py> {
    PyArray1::from_slice(py, values).into_any()
}

fn bbox([x, y, width, height]: [usize; 4]) -> (usize, usize, usize, usize) {
    (x, y, width, height)
}

pub(crate) fn segmentation(py: Python<'_>, segmentation: Segmentation, quality: Quality) -> PyResult<Value<'_>> {
    let Segmentation {
        width,
        height,
        count,
        motions,
        labels: bytes,
        junctions,
        evidence: PairEvidence { candidates, .. },
        unlabelled,
        confidence,
        ..
    } = segmentation;
    let size = [width, height];
    class(py, "Segmentation")?.call1((
        width,
        height,
        count,
        all(py, &motions, segmented_motion)?,
        labels(py, bytes, size)?,
        all(py, &junctions, junction)?,
        all(py, &candidates, candidate)?,
        unlabelled,
        confidence.map(|confidence| labels(py, confidence, size)).transpose()?,
        quality.name(),
    ))
}

fn segmented_motion<'py>(py: Python<'py>, motion: &SegmentedMotion) -> PyResult<Value<'py>> {
    let SegmentedMotion { label, matrix: entries, pixels, share, residual, bbox: sides, group, .. } = motion;
    let arguments = (*label, matrix(py, entries), *pixels, *share, *residual, bbox(*sides), *group);
    class(py, "SegmentedMotion")?.call1(arguments)
}

fn junction<'py>(py: Python<'py>, junction: &Junction) -> PyResult<Value<'py>> {
    let Junction { labels: [one, other], likelihood, border, .. } = junction;
    class(py, "Junction")?.call1(((*one, *other), *likelihood, *border))
}

fn candidate<'py>(py: Python<'py>, candidate: &Candidate) -> PyResult<Value<'py>> {
    let Candidate { motions, score, .. } = candidate;
    class(py, "Candidate")?.call1((*motions, *score))
}

pub(crate) fn motion_fit(py: Python<'_>, fit: MotionFit) -> PyResult<Value<'_>> {
    let MotionFit { count, motions, labels, evidence: FitEvidence { singular_values, candidates, .. }, stages, .. } =
        fit;
    class(py, "MotionFit")?.call1((
        count,
        all(py, &motions, fitted_motion)?,
        PyArray1::from_vec(py, labels),
        all(py, &candidates, candidate)?,
        numbers(py, &singular_values),
        stages.map(|stages| paper_stages(py, &stages)).transpose()?,
    ))
}

fn fitted_motion<'py>(py: Python<'py>, motion: &FittedMotion) -> PyResult<Value<'py>> {
    let FittedMotion { label, matrix: entries, measurements, determined, covariance, .. } = motion;
    let square = |rows: &[[f64; 6]; 6]| PyArray1::from_slice(py, rows.as_flattened()).reshape([6, 6]);
    let covariance = covariance.as_ref().map(square).transpose()?;
    class(py, "FittedMotion")?.call1((*label, matrix(py, entries), *measurements, *determined, covariance))
}

fn paper_stages<'py>(py: Python<'py>, stages: &PaperStages) -> PyResult<Value<'py>> {
    let PaperStages { ranks, rank_rule_fired, factorisation, refined, refinement, .. } = stages;
    let Report { termination, iterations, initial_cost, final_cost, .. } = refinement;
    let report = class(py, "Refinement")?.call1((termination.name(), *iterations, *initial_cost, *final_cost))?;
    let matrices = |motions: &[AffineMotion]| motions.iter().map(|motion| matrix(py, motion)).collect::<Vec<_>>();
    class(py, "PaperStages")?.call1((
        all(py, ranks, rank_candidate)?,
        *rank_rule_fired,
        matrices(factorisation),
        matrices(refined),
        report,
    ))
}

fn rank_candidate<'py>(py: Python<'py>, tried: &RankCandidate) -> PyResult<Value<'py>> {
    let RankCandidate { motions, rank, columns, ratio, .. } = tried;
    class(py, "RankCandidate")?.call1((*motions, *rank, *columns, *ratio))
}

pub(crate) fn clip_frame(py: Python<'_>, frame: ClipFrame, size: [usize; 2]) -> PyResult<Value<'_>> {
    let ClipFrame { index, labels: bytes, objects, background, .. } = frame;
    let background = background.as_ref().map(|motion| matrix(py, motion));
    class(py, "ClipFrame")?.call1((index, labels(py, bytes, size)?, all(py, &objects, clip_object)?, background))
}

fn clip_object<'py>(py: Python<'py>, object: &ClipObject) -> PyResult<Value<'py>> {
    let ClipObject { id, pixels, bbox: sides, confidence, matrix: motion, .. } = object;
    let motion = motion.as_ref().map(|motion| matrix(py, motion));
    class(py, "ClipObject")?.call1((*id, *pixels, bbox(*sides), *confidence, motion))
}

/// `ClipTracks`, from the frames of each object, the motion of the background in frames, and the number of objects without a number.
pub(crate) fn clip_tracks<'py, 'o>(
    py: Python<'py>,
    objects: impl IntoIterator<Item = (u8, Vec<(usize, &'o ClipObject)>)>,
    background: impl IntoIterator<Item = (usize, AffineMotion)>,
    dropped: usize,
) -> PyResult<Value<'py>> {
    let track = |(id, seen): (u8, Vec<(usize, &ClipObject)>)| {
        let [first, last] = [seen.first(), seen.last()].map(|at| at.map(|(frame, _)| *frame));
        class(py, "ClipTrack")?.call1((id, first, last, all(py, &seen, sighting)?))
    };
    let objects: Vec<Value<'_>> = objects.into_iter().map(track).collect::<PyResult<_>>()?;
    let motion = |(frame, motion)| class(py, "BackgroundMotion")?.call1((frame, matrix(py, &motion)));
    let background: Vec<Value<'_>> = background.into_iter().map(motion).collect::<PyResult<_>>()?;
    class(py, "ClipTracks")?.call1((objects, background, dropped))
}

fn sighting<'py>(py: Python<'py>, (frame, object): &(usize, &ClipObject)) -> PyResult<Value<'py>> {
    let ClipObject { id: _, pixels, bbox: sides, confidence, matrix: motion, .. } = object;
    let motion = motion.as_ref().map(|motion| matrix(py, motion));
    class(py, "Sighting")?.call1((*frame, *pixels, bbox(*sides), *confidence, motion))
}

pub(crate) fn clip_changes<'py>(py: Python<'py>, changes: &[Changed]) -> PyResult<Vec<Value<'py>>> {
    all(py, changes, |py, &Changed { frame, object, gained, lost, .. }| {
        class(py, "ClipChange")?.call1((frame, object, gained, lost))
    })
}

pub(crate) fn clip_entries<'py>(py: Python<'py>, objects: &[Object]) -> PyResult<Vec<Value<'py>>> {
    all(py, objects, |py, object| {
        let Object {
            number, description: Description { name, class: kind, colour }, locked, annotated, became, ..
        } = object;
        let colour = colour.map(|[red, green, blue]| (red, green, blue));
        class(py, "ClipEntry")?.call1((*number, name, kind, colour, *locked, *annotated, *became))
    })
}

pub(crate) fn frame_statuses<'py>(py: Python<'py>, frames: &[FrameStatus]) -> PyResult<Vec<Value<'py>>> {
    all(py, frames, |py, &FrameStatus { has_masks, accepted, annotated, .. }| {
        class(py, "ClipFrameStatus")?.call1((has_masks, accepted, annotated))
    })
}
