//! Confidence of labels: the probability of every motion at every pixel, from the costs of the motions there and around it.
//!
//! ```text
//! e_k = β (G₄w * ρ_k) − γ (G₂w * [l = k]) − δ [l = k]        of motion k at a pixel with label l
//! P_k = exp(−e_k) / (Σ_j exp(−e_j) + exp(−β u))
//! ```
//! G₄w and G₂w are Gaussian windows of four and two times the window of estimation, ρ is the label cost of a single pixel. The three terms
//! are the costs of the surroundings (a single pixel seldom decides), the surrounding labels, and the label that the energy minimisation
//! chose. The last term of the denominator stands for none of the motions: a pixel that no motion explains has low probabilities. Without
//! texture all motions cost the same, and only the labels count.
//!
//! β, γ and δ are a maximum likelihood fit to 30 generated scenes (seeds 700 and 900 of the benchmark's series), so that about the
//! share P of the pixels with probability P is right; docs/masks.md has the measurement on other scenes.

use std::f32::consts::LOG2_E;

use crate::exponential::power_of_two_f32;
use crate::frame::Plane;
use crate::frame::filter::gaussian;
use crate::labelling::mask_of;
use crate::lanes::each_with;
use crate::model::Model;

/// Probability, 0…1, of every motion at every pixel; `costs[k]` is the label cost of motion k.
pub(crate) fn probabilities(costs: &[Plane], labels: &[u8], model: &Model) -> Vec<Plane> {
    let (of_cost, of_own) = (model.confidence_cost, model.confidence_own);
    let of_neighbours = model.confidence_neighbours;
    let Some((width, height)) = costs.first().map(|plane| (plane.width(), plane.height())) else { return Vec::new() };
    let mut total = Plane::filled(width, height, libm::expf(-of_cost * model.unexplained));
    let mut weights: Vec<Plane> = Vec::with_capacity(costs.len());
    for (k, cost) in costs.iter().enumerate() {
        let mut weight = gaussian(cost, 2.0 * model.window_of_fit());
        let own = mask_of(labels, k as u8, width, height);
        let around = gaussian(&own, model.window_of_fit());
        each_with(weight.values_mut(), [around.values(), own.values()], |cost, [near, own]| {
            power_of_two_f32(LOG2_E * (of_neighbours * near + of_own * own - of_cost * cost))
        });
        total.values_mut().iter_mut().zip(weight.values()).for_each(|(t, w)| *t += w);
        weights.push(weight);
    }
    for weight in &mut weights {
        weight.values_mut().iter_mut().zip(total.values()).for_each(|(w, t)| *w /= t);
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Left and right half have a motion each; the middle third of the rows has no texture.
    fn halves() -> (Vec<Plane>, Vec<u8>) {
        let cost = |label: usize| {
            Plane::from_fn(96, 96, move |x, y| match (usize::from(x >= 48) == label, y / 32 == 1) {
                (_, true) => 0.5,
                (right, false) => {
                    if right {
                        0.5
                    } else {
                        1.8
                    }
                }
            })
        };
        (vec![cost(0), cost(1)], (0..96 * 96).map(|p| u8::from(p % 96 >= 48)).collect())
    }

    #[test]
    fn texture_makes_sure_and_borders_and_flat_areas_do_not() {
        let (costs, labels) = halves();
        let found = probabilities(&costs, &labels, &Model::DEFAULT);
        for (a, b) in found[0].values().iter().zip(found[1].values()) {
            assert!((0.0..=1.0).contains(a) && a + b <= 1.0 + 1e-6);
        }
        let (inside, border, flat) = (found[0].at(20, 8), found[0].at(47, 8), found[0].at(20, 48));
        assert!(inside > 0.98, "{inside}");
        assert!(border < inside - 0.05 && border > 0.5, "{border}");
        assert!(flat < inside - 0.005 && flat > 0.9, "{flat}");
        assert!(found[0].at(47, 48) < 0.85, "no texture and another label beside it: {}", found[0].at(47, 48));
        assert!(found[1].at(20, 8) < 0.01);
    }

    #[test]
    fn what_no_motion_explains_is_not_sure() {
        let costs = vec![Plane::from_fn(64, 64, |x, _| if x < 32 { 0.5 } else { 2.0 })];
        let found = probabilities(&costs, &[0; 64 * 64], &Model::DEFAULT);
        assert!(
            found[0].at(5, 30) > 0.99 && found[0].at(60, 30) < 0.9,
            "{} {}",
            found[0].at(5, 30),
            found[0].at(60, 30)
        );
    }
}
