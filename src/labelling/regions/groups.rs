//! Groups of motions: a continuous surface has a continuous flow, so two neighbouring regions whose motions agree along their common
//! border belong together (a slanted plane, the depth layers of a rigid background).
//!
//! Regions are joined pair by pair, the smallest jump first, and the jumps of the joined region are measured again along its whole
//! border. A chain of small jumps therefore does not join two regions that differ along their own border; otherwise a slowly moving
//! limb would tie a whole animal to the ground.

use crate::labelling::{BACKGROUND, across_borders};
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::order::median_f64;

/// The group of every motion, named by its smallest label. `motions` are in pixels of the labels, each of which is `reduction` pixels
/// of the frame wide.
pub(crate) fn groups(
    motions: &[AffineMotion],
    labels: &[u8],
    width: usize,
    reduction: f64,
    model: &Model,
) -> Vec<usize> {
    let borders = borders(motions, labels, width);
    let all = joined(motions.len(), borders.clone(), model, &|_| true);
    let largest = all.iter().fold(0.0f64, |m, j| m.max(j.jump));
    let side = width.max(labels.len() / width) as f64;
    let least = model.group_tolerance / reduction;
    let tolerance = (model.group_relative * largest).min(model.group_largest * side).max(least);
    // Before a camera at rest all layers of a rigid background are at rest: what moves is an object.
    let at_rest = motions[BACKGROUND] == AffineMotion::STATIC;
    let continuous = |join: &Join| join.jump < if at_rest && join.keep == BACKGROUND { least } else { tolerance };
    let mut group: Vec<usize> = (0..motions.len()).collect();
    for Join { keep, drop, .. } in joined(motions.len(), borders, model, &continuous) {
        group.iter_mut().filter(|g| **g == drop).for_each(|g| *g = keep);
    }
    group
}

/// The join of two regions, which keeps the smaller of the two labels.
struct Join {
    keep: usize,
    drop: usize,
    /// Median jump of the flow along their border at the time of the join, pixels.
    jump: f64,
}

/// Joins regions one after another, smallest jump first, until no two may be joined.
fn joined(n: usize, mut borders: Vec<Vec<f64>>, model: &Model, may_join: &dyn Fn(&Join) -> bool) -> Vec<Join> {
    let mut joined = Vec::new();
    while let Some(next) = closest(n, &mut borders, model, may_join) {
        for other in 0..n {
            let moved = std::mem::take(&mut borders[pair(n, next.drop, other)]);
            if other != next.keep && other != next.drop {
                borders[pair(n, next.keep, other)].extend(moved);
            }
        }
        joined.push(next);
    }
    joined
}

/// The pair that may be joined with the smallest jump along a border that is long enough.
fn closest(n: usize, borders: &mut [Vec<f64>], model: &Model, may_join: &dyn Fn(&Join) -> bool) -> Option<Join> {
    let mut best: Option<Join> = None;
    for (k, along) in borders.iter_mut().enumerate().filter(|(_, along)| along.len() >= model.shortest_border) {
        let Some(jump) = median_f64(along) else { continue };
        let join = Join { keep: k / n, drop: k % n, jump };
        if may_join(&join) && best.as_ref().is_none_or(|best| jump < best.jump) {
            best = Some(join);
        }
    }
    best
}

/// Index of a pair of labels in a list of n · n.
pub(crate) fn pair(n: usize, i: usize, j: usize) -> usize {
    i.min(j) * n + i.max(j)
}

/// For every [`pair`] of labels, the difference of their flows at each pixel pair of the border.
pub(crate) fn borders(motions: &[AffineMotion], labels: &[u8], width: usize) -> Vec<Vec<f64>> {
    let n = motions.len();
    let mut found: Vec<Vec<f64>> = vec![Vec::new(); n * n];
    across_borders(labels, width, &mut |p, q| {
        let (i, j) = (usize::from(labels[p]), usize::from(labels[q]));
        if i < n && j < n {
            let (x, y) = ((p % width) as f64, (p / width) as f64);
            let ([u, v], [r, s]) = (motions[i].flow(x, y), motions[j].flow(x, y));
            found[pair(n, i, j)].push(((u - r) * (u - r) + (v - s) * (v - s)).sqrt());
        }
    });
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_continuous_surface_is_one_group_and_a_jump_is_two() {
        // Left third, middle third, right third; flow continuous at x = 20, jumping at x = 40.
        let labels: Vec<u8> = (0..60 * 30).map(|p| ((p % 60) / 20) as u8).collect();
        let motions = [
            AffineMotion::translation(1.0, 0.0),
            AffineMotion::new([0.05, 0.0, 0.0, 0.0, 0.0, 0.0]),
            AffineMotion::translation(7.0, 0.0),
        ];
        assert_eq!(groups(&motions, &labels, 60, 1.0, &Model::DEFAULT), [0, 0, 2]);
    }

    #[test]
    fn a_chain_of_small_jumps_does_not_tie_a_moving_thing_to_the_ground() {
        // The thing (1) jumps by 0.56 pixels against the ground (0) along most of its border; its foot (2) moves half as much, which
        // is too little a difference from either.
        let (width, height) = (60, 60);
        let labels: Vec<u8> = (0..width * height)
            .map(|p| match (p % width, p / width) {
                (20..40, 10..40) => 1,
                (26..42, 40..44) => 2,
                _ => 0,
            })
            .collect();
        let motions = [
            AffineMotion::translation(0.0, 0.0),
            AffineMotion::translation(0.56, 0.0),
            AffineMotion::translation(0.28, 0.0),
        ];
        let groups = groups(&motions, &labels, width, 1.0, &Model::DEFAULT);
        assert_ne!(groups[0], groups[1]);
    }

    #[test]
    fn before_a_camera_at_rest_there_are_no_layers_of_the_background() {
        // Two things: one moves by 5 pixels of the frame against the ground, the other one by 1, as a layer of the ground might.
        let (width, height) = (90, 40);
        let labels: Vec<u8> = (0..width * height)
            .map(|p| match (p % width, p / width) {
                (10..30, 10..30) => 1,
                (50..70, 10..30) => 2,
                _ => 0,
            })
            .collect();
        let groups = |camera: f64| {
            let motions = [0.0, 0.5, 0.1].map(|u| AffineMotion::translation(camera + u, 0.0));
            groups(&motions, &labels, width, 10.0, &Model::DEFAULT)
        };
        assert_eq!(groups(1.0), [0, 1, 0]);
        assert_eq!(groups(0.0), [0, 1, 2]);
    }

    #[test]
    fn where_nothing_touches_every_motion_is_its_own_group() {
        let labels = vec![0; 32 * 32];
        assert_eq!(
            groups(&[AffineMotion::STATIC, AffineMotion::translation(9.0, 0.0)], &labels, 32, 1.0, &Model::DEFAULT),
            [0, 1]
        );
    }
}
