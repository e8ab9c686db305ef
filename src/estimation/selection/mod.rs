//! Selection of motions from the proposals: greedily, with refinement of each motion on its own pixels and new proposals at finer levels.

mod fine;
pub(crate) mod greedy;
mod refit;

pub(crate) use fine::fine_proposals;
pub(crate) use greedy::{GreedySelection, add_motions, prune};
pub(crate) use refit::refit;

use crate::frame::Plane;
use crate::frame::filter::gaussian;
use crate::lanes::lower;
use crate::motion::AffineMotion;
use crate::view::cost::{RobustKernel, cost};
use crate::view::level::PairLevel;

/// A motion and its cost at every pixel of a level, averaged over windows.
#[derive(Clone, Debug)]
pub(crate) struct ScoredMotion {
    pub(crate) motion: AffineMotion,
    pub(crate) cost: Plane,
}

impl ScoredMotion {
    /// Computes the cost of a motion on a level.
    #[inline(never)]
    pub(crate) fn new(level: &PairLevel, motion: AffineMotion) -> ScoredMotion {
        ScoredMotion {
            motion,
            cost: gaussian(
                &cost(level, &motion, RobustKernel::estimation(level.model)),
                level.model.cost_window / level.stride as f32,
            ),
        }
    }

    /// Lowers a cost plane to this motion's cost wherever that is smaller.
    #[inline(never)]
    pub(crate) fn lower(&self, cost: &mut Plane) {
        lower(cost.values_mut(), self.cost.values());
    }
}

/// The smallest cost of any motion at every pixel.
pub(crate) fn smallest_cost(selected: &[ScoredMotion]) -> Plane {
    let mut smallest = selected[0].cost.clone();
    selected[1..].iter().for_each(|scored| scored.lower(&mut smallest));
    smallest
}

/// Index of the cheapest motion at every pixel; ties go to the first.
pub(crate) fn winners(selected: &[ScoredMotion]) -> Vec<usize> {
    let mut winners = vec![0; selected[0].cost.values().len()];
    for (p, winner) in winners.iter_mut().enumerate() {
        for k in 1..selected.len() {
            if selected[k].cost.values()[p] < selected[*winner].cost.values()[p] {
                *winner = k;
            }
        }
    }
    winners
}
