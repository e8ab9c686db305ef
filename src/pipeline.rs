//! Two frames in, masks out: the image pipeline as its stages in order, and nothing else.

use serde::Serialize;

use crate::error::{Error, Result};
use crate::frame::Frame;
use crate::motion::AffineMotion;
use crate::options::SegmentOptions;
use crate::points::Candidate;
use crate::progress::{Progress, Stages};

/// What [`segment_pair`] found.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Segmentation {
    /// Width of the frames, pixels.
    pub width: usize,
    /// Height of the frames, pixels.
    pub height: usize,
    /// Number of motions.
    pub count: usize,
    /// The motions by decreasing number of pixels; `motions[i].label == i`.
    pub motions: Vec<SegmentedMotion>,
    /// One label per pixel, row by row; [`UNLABELLED`](crate::UNLABELLED) where nothing can be said (only on request).
    #[serde(skip)]
    pub labels: Vec<u8>,
    /// What the number of motions rests on.
    pub evidence: PairEvidence,
    /// Number of unlabelled pixels.
    pub unlabelled: usize,
}

/// One motion of a [`Segmentation`].
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct SegmentedMotion {
    /// Its label.
    pub label: u8,
    /// Its six entries, pixels of the full-size frame.
    pub matrix: AffineMotion,
    /// Number of its pixels.
    pub pixels: usize,
    /// Their share of all pixels, 0…1.
    pub share: f64,
    /// Root mean square of the motion-compensated intensity difference over its pixels, grey levels.
    pub residual: f64,
    /// Bounding box of its pixels: x, y, width, height.
    pub bbox: [usize; 4],
    /// Group: motions of one rigid background share a number; numbered like labels, 0 is the largest group.
    pub group: u8,
}

/// Evidence for the number of motions of a pair.
#[derive(Clone, Debug, Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct PairEvidence {
    /// The numbers of motions that were tried; a smaller score is better.
    pub candidates: Vec<Candidate>,
}

const STAGES: &[&str] = &["frames"];

/// Segments two frames: how many things move, how each moves, which pixels belong to it.
///
/// `before` is the frame before the first: a third view that helps where something is hidden in the second.
///
/// # Errors
/// [`Error::InvalidOption`], [`Error::FrameSizeMismatch`].
pub fn segment_pair(
    first: &Frame,
    second: &Frame,
    before: Option<&Frame>,
    options: &SegmentOptions,
    progress: Progress<'_>,
) -> Result<Segmentation> {
    options.motions.validate()?;
    let size = (first.width(), first.height());
    for other in [Some(second), before].into_iter().flatten() {
        if (other.width(), other.height()) != size {
            return Err(Error::FrameSizeMismatch { first: size, second: (other.width(), other.height()) });
        }
    }
    let mut stages = Stages::new(STAGES, progress);
    stages.begin("frames");
    Ok(Segmentation {
        width: size.0,
        height: size.1,
        count: 1,
        motions: vec![SegmentedMotion {
            label: 0,
            matrix: AffineMotion::STATIC,
            pixels: size.0 * size.1,
            share: 1.0,
            residual: 0.0,
            bbox: [0, 0, size.0, size.1],
            group: 0,
        }],
        labels: vec![0; size.0 * size.1],
        evidence: PairEvidence::default(),
        unlabelled: 0,
    })
}
