//! The motions of a pair: proposals, their selection for each hypothesis about the dominant motion, and refinement level by level.

use super::Work;
use super::settings::Settings;
use crate::alignment::cost::{CostModel, cost, total};
use crate::motion::AffineMotion;
use crate::progress::Stages;
use crate::proposal::algebraic::from_algebra;
use crate::proposal::local_flow::local_flow;
use crate::proposal::tiles::from_tiles;
use crate::random::Random;
use crate::selection::{Deflation, Layer, add_motions, fine_proposals, prune, refit, smallest_cost};

/// No motion is a hypothesis of its own as long as it costs no more than this many times what the dominant motion costs: where much
/// of the frame is flat, one motion bent over several objects can explain more than the background that stands still.
const PLAUSIBLE: f64 = 1.5;

/// The cheapest set of motions, over the hypotheses "the dominant motion is as found" and "nothing but objects moves".
pub(super) fn best(
    work: &Work,
    dominant: AffineMotion,
    settings: &Settings,
    random: &mut Random,
    stages: &mut Stages<'_>,
) -> Vec<Layer> {
    let (mut winner, least) = with_dominant(work, dominant, None, settings, random, stages);
    let base = &work.levels[work.base];
    let alone = |motion: &AffineMotion| total(&cost(base, motion, CostModel::ESTIMATION));
    if dominant != AffineMotion::STATIC && alone(&AffineMotion::STATIC) < PLAUSIBLE * alone(&dominant) {
        let (found, cost) = with_dominant(work, AffineMotion::STATIC, Some(dominant), settings, random, stages);
        if cost < least {
            winner = found;
        }
    }
    winner
}

/// Motions of the base level under one hypothesis, and their cost.
fn with_dominant(
    work: &Work,
    dominant: AffineMotion,
    rival: Option<AffineMotion>,
    settings: &Settings,
    random: &mut Random,
    stages: &mut Stages<'_>,
) -> (Vec<Layer>, f64) {
    let level = &work.levels[work.base];
    stages.begin("measurements");
    let flow = local_flow(&work.levels, &dominant, work.base);
    stages.begin("algebra");
    let mut proposals = from_algebra(level, &dominant, &flow, settings.degrees, settings.measurements, random);
    proposals.extend(from_tiles(level, &dominant, &flow, settings.tiles));
    proposals.extend(rival);
    stages.begin("selection");
    let mut layers = vec![Layer::new(level, dominant)];
    let how = Deflation { price: settings.price[0], most: settings.most, tries: settings.tries };
    add_motions(level, &mut layers, &proposals, how);
    refit(level, &mut layers, 1);
    let cost = total(&smallest_cost(&layers)) + settings.hypothesis_price * layers.len() as f64;
    (layers, cost)
}

/// Refines motions from the base level to the working size, adding what only shows there. Also returns the cost that the best
/// motion that was *not* added would have saved.
pub(super) fn refine(work: &Work, mut layers: Vec<Layer>, settings: &Settings) -> (Vec<AffineMotion>, f64) {
    let base = &work.levels[work.base];
    refit(base, &mut layers, 2);
    if settings.least == 1 {
        prune(&mut layers, settings.price[0]);
    }
    let mut left_over = 0.0;
    for level in work.levels[..work.base].iter().rev() {
        layers = layers.iter().map(|l| Layer::new(level, l.motion)).collect();
        let look = level.index >= 1 || work.base == 1;
        if look {
            let how = Deflation { price: settings.price[1], most: settings.most, tries: 2 };
            let proposals = fine_proposals(level, &layers);
            left_over = add_motions(level, &mut layers, &proposals, how);
        }
        refit(level, &mut layers, 1);
    }
    (layers.into_iter().map(|l| l.motion).collect(), left_over)
}
