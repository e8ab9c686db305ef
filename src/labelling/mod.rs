//! From motions to masks: costs and coherence, visibility, splitting and describing regions, groups, full size.

pub(crate) mod appearance;
pub(crate) mod confidence;
pub(crate) mod description;
pub(crate) mod energy;
mod expansion;
pub(crate) mod groups;
mod max_flow;
pub(crate) mod merging;
mod messages;
mod potts;
pub(crate) mod sharpening;
pub(crate) mod solver;
pub(crate) mod splitting;
pub(crate) mod upsampling;
mod variance_inflation;
pub(crate) mod views;
pub(crate) mod visibility;

use crate::frame::Plane;
use crate::workspace::Buffer;

/// Calls `pair` for every two of `count` pixels that lie beside or above each other on a grid `width` wide.
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

/// The pixels that have certain labels, in order.
pub(crate) fn pixels(labels: &[u8], which: impl Fn(usize) -> bool) -> Buffer<usize> {
    (0..labels.len()).filter(|&p| which(usize::from(labels[p]))).collect()
}

/// One label's pixels as a plane of ones on zeros.
pub(crate) fn mask_of(labels: &[u8], label: u8, width: usize, height: usize) -> Plane {
    Plane::from_buffer(width, height, labels.iter().map(|&l| if l == label { 1.0 } else { 0.0 }).collect())
}
