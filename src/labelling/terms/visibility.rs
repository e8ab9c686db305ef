//! Occlusion: a pixel that lands behind another object in the second frame cannot look the same there.

use crate::frame::Plane;
use crate::frame::filter::eroded;
use crate::frame::warp::warp;
use crate::labelling::{BACKGROUND, is_background, mask_of, objects};
use crate::lanes::each_with;
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::view::level::Level;

/// Costs in which a motion pays no more than [`Model::hidden_cost`] for pixels that it moves behind another object.
///
/// The dominant motion may be occluded by any object, an object only at pixels labelled as an object so far. Otherwise objects would
/// grow into the background around others.
pub(crate) fn with_visibility(
    level: &Level,
    motions: &[AffineMotion],
    costs: &[Plane],
    labels: &[u8],
    object_bias: f32,
) -> Vec<Plane> {
    let hide = |(k, hidden): (usize, Vec<bool>)| {
        let most = most_where_hidden(k, object_bias, level.model);
        let mut out = costs[k].clone();
        for (c, _) in out.values_mut().iter_mut().zip(&hidden).filter(|(_, hidden)| **hidden) {
            *c = c.min(most);
        }
        out
    };
    hidden_under(level, motions, labels).into_iter().enumerate().map(hide).collect()
}

/// Largest cost of a label where its motion moves a pixel behind another object.
pub(crate) fn most_where_hidden(label: usize, object_bias: f32, model: &Model) -> f32 {
    model.hidden_cost + if label == BACKGROUND { 0.0 } else { object_bias }
}

/// For every motion, the pixels at which [`with_visibility`] limits its cost.
pub(crate) fn hidden_under(level: &Level, motions: &[AffineMotion], labels: &[u8]) -> Vec<Vec<bool>> {
    let landed = landed(level, motions, labels);
    let hidden = |k: usize| {
        let covered = covered(level, &motions[k], &landed, k);
        covered
            .values()
            .iter()
            .zip(labels)
            .map(|(covered, label)| *covered > 0.5 && (k == BACKGROUND || !is_background(*label)))
            .collect()
    };
    (0..motions.len()).map(hidden).collect()
}

/// Pixels labelled dominant that the dominant motion moves behind an object.
pub(crate) fn hidden(level: &Level, motions: &[AffineMotion], labels: &[u8]) -> Vec<bool> {
    let covered = covered(level, &motions[BACKGROUND], &landed(level, motions, labels), BACKGROUND);
    covered.values().iter().zip(labels).map(|(&covered, &label)| is_background(label) && covered > 0.5).collect()
}

/// The masks of all objects where they are in the second frame, with their labels.
fn landed(level: &Level, motions: &[AffineMotion], labels: &[u8]) -> Vec<(usize, Plane)> {
    objects(motions.len()).map(|k| (k, moved_mask(level, &motions[k], labels, k))).collect()
}

/// How far the position that a motion moves each pixel to is covered by objects other than `own`, 0…1.
fn covered(level: &Level, motion: &AffineMotion, landed: &[(usize, Plane)], own: usize) -> Plane {
    let mut cover = Plane::filled(level.width(), level.height(), 0.0);
    for (_, mask) in landed.iter().filter(|(other, _)| *other != own) {
        each_with(cover.values_mut(), [mask.values()], |c, [m]| if m > c { m } else { c });
    }
    warp(&cover, &level.scaled(motion))
}

/// The eroded mask of an object, moved to its place in the second frame.
fn moved_mask(level: &Level, motion: &AffineMotion, labels: &[u8], label: usize) -> Plane {
    let mask = eroded(&mask_of(labels, label as u8, level.width(), level.height()));
    match level.scaled(motion).inverse() {
        Some(back) => warp(&mask, &back),
        None => mask,
    }
}
