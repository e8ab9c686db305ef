//! The probability that a region that moves differently from the ground is an object.
//!
//! A correct motion does not make its pixels an object: in real scenes, parts of the background at another depth move differently, too.
//!
//! ```text
//! ln Q/(1−Q) = α ln P/(1−P) − β √b − γ m + δ        of an object's pixel
//! ```
//! Q is the probability that a pixel belongs to an object, and P that of its motion. b is the share of the object's outline that lies on
//! the border of the frame: parts of the background reach it more often than objects do. m is the mean cost of all pixels under their own
//! motions: where affine motions do not explain the frames, more regions are found that are no objects.
//!
//! The weights are a maximum likelihood fit to real pairs and generated scenes, with both qualities; docs/masks.md has the
//! measurement on others.

use crate::frame::Plane;
use crate::labelling::BACKGROUND;
use crate::model::Model;
use crate::pair::groups::shares_on_frame;

/// Smallest and largest P that are distinguished. Guard.
const LIMITS: [f32; 2] = [0.002, 0.998];

/// Turns the probabilities of the motions of objects into probabilities of being an object.
pub(super) fn doubt_objects(
    probabilities: &mut [Plane],
    costs: &[Plane],
    labels: &[u8],
    groups: &[usize],
    model: &Model,
) {
    let Some(width) = probabilities.first().map(Plane::width) else { return };
    let own = labels.iter().enumerate().map(|(p, &label)| f64::from(costs[usize::from(label)].values()[p]));
    let misfit = own.sum::<f64>() / labels.len() as f64;
    let on_border = shares_on_frame(labels, groups.len(), width);
    for (k, plane) in probabilities.iter_mut().enumerate().filter(|(k, _)| groups[*k] != BACKGROUND) {
        let constant =
            model.doubt_constant - model.doubt_frame_border * libm::sqrt(on_border[k]) - model.doubt_misfit * misfit;
        for p in plane.values_mut() {
            let probable = f64::from(p.clamp(LIMITS[0], LIMITS[1]));
            let log_odds = model.doubt_motion * libm::log(probable / (1.0 - probable)) + constant;
            *p = 1.0 / (1.0 + libm::expf(-log_odds as f32));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of nine pixels, its left column at `x`.
    fn square(x: usize) -> Vec<u8> {
        (0..96).map(|p| u8::from((x..x + 3).contains(&(p % 12)) && (2..5).contains(&(p / 12)))).collect()
    }

    fn doubted(labels: &[u8], groups: &[usize], cost: f32) -> [f32; 2] {
        let plane = |value| Plane::filled(12, 8, value);
        let mut probabilities = [plane(0.9), plane(0.9)];
        doubt_objects(&mut probabilities, &[plane(cost), plane(cost)], labels, groups, &Model::DEFAULT);
        probabilities.map(|plane| plane.at(5, 3))
    }

    #[test]
    fn only_objects_are_doubted_and_by_all_features() {
        let [background, object] = doubted(&square(4), &[0, 1], 0.4);
        assert_eq!(background, 0.9);
        assert!(object < doubted(&square(4), &[0, 1], 0.3)[1], "more misfit");
        assert!(object > doubted(&square(0), &[0, 1], 0.4)[1], "cut by the frame");
        assert_eq!(doubted(&square(0), &[0, 0], 0.9), [0.9, 0.9], "a part of the background");
    }
}
