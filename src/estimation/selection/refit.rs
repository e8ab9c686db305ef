//! Every motion refined on the pixels where it wins.

use super::ScoredMotion;
use crate::estimation::alignment::{Alignment, Convergence, Support, align, ridge_of_label, softened};
use crate::frame::Plane;
use crate::frame::filter::eroded;
use crate::lanes::each_with;
use crate::model::Model;
use crate::view::brightness::GainBias;
use crate::view::level::PairLevel;

/// Refines every motion in `rounds` rounds. A refined motion is kept only if it lowers the cost of its own region.
pub(crate) fn refit(level: &PairLevel, selected: &mut [ScoredMotion], rounds: usize, convergence: Convergence) {
    let model = level.model;
    for _ in 0..rounds {
        let regions: Vec<Option<Plane>> = (0..selected.len()).map(|k| region_of(selected, k, level.model)).collect();
        for (k, (scored, region)) in selected.iter_mut().zip(regions).enumerate() {
            let Some(region) = region else { continue };
            let how = Alignment::of_region(model.region_iterations, ridge_of_label(k, model), model).until(convergence);
            let motion =
                align(level, &scored.motion, &Support::weighted(&region, model), &mut GainBias::default(), how);
            let refined = ScoredMotion::new(level, motion);
            if weighted_sum(&refined.cost, &region) < weighted_sum(&scored.cost, &region) {
                *scored = refined;
            }
        }
    }
}

fn weighted_sum(cost: &Plane, weights: &Plane) -> f64 {
    let mut weighted = cost.clone();
    each_with(weighted.values_mut(), [weights.values()], |c, [w]| c * w);
    weighted.total()
}

/// Weights of the pixels where motion `k` is cheapest, eroded and softened.
fn region_of(selected: &[ScoredMotion], k: usize, model: &Model) -> Option<Plane> {
    let cost = &selected[k].cost;
    let mut region = Plane::filled(cost.width(), cost.height(), 1.0);
    for (other, scored) in selected.iter().enumerate().filter(|&(other, _)| other != k) {
        each_with(region.values_mut(), [cost.values(), scored.cost.values()], |r, [own, value]| {
            let wins = if k < other { own <= value } else { own < value };
            if wins { r } else { 0.0 }
        });
    }
    let pixels_of = |region: &Plane| region.values().iter().filter(|&&w| w > 0.0).count();
    if pixels_of(&region) < model.fewest {
        return None;
    }
    // Pixels at the border may belong to another motion; they are left out if enough others remain.
    let inner = eroded(&region);
    let enough = pixels_of(&inner) >= model.fewest;
    Some(softened(if enough { &inner } else { &region }))
}
