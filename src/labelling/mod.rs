//! From motions to masks: the terms of the labelling energy, their solver, regions that are split and merged, and the way from coarse
//! labels to the full frame.
//!
//! Inside a labelling the background has the label [`BACKGROUND`], however few pixels it may have. How a result is numbered is a matter
//! of its report.

pub(crate) mod coherence;
pub(crate) mod confidence;
pub(crate) mod regions;
pub(crate) mod resolution;
pub(crate) mod shadows;
pub(crate) mod solver;
pub(crate) mod terms;

use crate::frame::Plane;
use crate::workspace::Buffer;

/// The label of the background in every labelling.
pub(crate) const BACKGROUND: usize = 0;

/// The labels of the objects among `of` labels.
pub(crate) fn objects(of: usize) -> std::ops::Range<usize> {
    BACKGROUND + 1..of
}

/// Whether a pixel's label is that of the background.
#[inline(always)]
pub(crate) fn is_background(label: u8) -> bool {
    usize::from(label) == BACKGROUND
}

/// Calls `pair` for every pair of 4-connected neighbours among `count` pixels of a grid `width` wide.
#[inline(always)]
pub(crate) fn neighbours(count: usize, width: usize, mut pair: impl FnMut(usize, usize)) {
    for p in 0..count {
        if (p + 1) % width != 0 {
            pair(p, p + 1);
        }
        if p + width < count {
            pair(p, p + width);
        }
    }
}

/// Indices of the pixels whose label satisfies `which`, in order.
pub(crate) fn pixels(labels: &[u8], which: impl Fn(usize) -> bool) -> Buffer<usize> {
    (0..labels.len()).filter(|&p| which(usize::from(labels[p]))).collect()
}

/// Indicator of a label: 1 on its pixels, 0 elsewhere.
pub(crate) fn mask_of(labels: &[u8], label: u8, width: usize, height: usize) -> Plane {
    Plane::from_buffer(width, height, labels.iter().map(|&l| if l == label { 1.0 } else { 0.0 }).collect())
}
