//! Occlusion: a pixel that moves behind another object cannot look the same in the second frame.

use crate::frame::Plane;
use crate::frame::filter::eroded;
use crate::frame::warp::warp;
use crate::labelling::{BACKGROUND, is_background, mask_of, objects};
use crate::lanes::each_with;
use crate::motion::AffineMotion;
use crate::view::level::PairLevel;

/// Costs in which a motion costs at most `Model::hidden_cost` at pixels that it moves behind another object.
///
/// The dominant motion may be occluded by any object, an object only at pixels labelled as an object so far. Otherwise objects would
/// grow into the background around others.
pub(crate) fn with_visibility(
    level: &PairLevel,
    motions: &[AffineMotion],
    costs: &[Plane],
    labels: &[u8],
    object_bias: f32,
) -> Vec<Plane> {
    let landed = landed(level, motions, labels);
    let hide = |(k, costs): (usize, &Plane)| {
        let most = level.model.hidden_cost + if k == BACKGROUND { 0.0 } else { object_bias };
        let covered = covered(level, &motions[k], &landed, k);
        let mut out = costs.clone();
        for ((cost, covered), label) in out.values_mut().iter_mut().zip(covered.values()).zip(labels) {
            if *covered > 0.5 && (k == BACKGROUND || !is_background(*label)) {
                *cost = cost.min(most);
            }
        }
        out
    };
    costs.iter().enumerate().map(hide).collect()
}

/// Pixels labelled dominant that the dominant motion moves behind an object.
pub(crate) fn hidden(level: &PairLevel, motions: &[AffineMotion], labels: &[u8]) -> Vec<bool> {
    let covered = covered(level, &motions[BACKGROUND], &landed(level, motions, labels), BACKGROUND);
    covered.values().iter().zip(labels).map(|(&covered, &label)| is_background(label) && covered > 0.5).collect()
}

/// The masks of all objects at their positions in the second frame, with their labels.
fn landed(level: &PairLevel, motions: &[AffineMotion], labels: &[u8]) -> Vec<(usize, Plane)> {
    objects(motions.len()).map(|k| (k, moved_mask(level, &motions[k], labels, k))).collect()
}

/// How much the position to which a motion moves each pixel is covered by objects other than `own`, 0…1.
fn covered(level: &PairLevel, motion: &AffineMotion, landed: &[(usize, Plane)], own: usize) -> Plane {
    let mut cover = Plane::filled(level.width(), level.height(), 0.0);
    for (_, mask) in landed.iter().filter(|(other, _)| *other != own) {
        each_with(cover.values_mut(), [mask.values()], |c, [m]| if m > c { m } else { c });
    }
    warp(&cover, &level.scaled(motion))
}

/// The eroded mask of an object, moved to its position in the second frame.
fn moved_mask(level: &PairLevel, motion: &AffineMotion, labels: &[u8], label: usize) -> Plane {
    let mask = eroded(&mask_of(labels, label as u8, level.width(), level.height()));
    match level.scaled(motion).inverse() {
        Some(back) => warp(&mask, &back),
        None => mask,
    }
}
