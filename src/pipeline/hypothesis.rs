//! The motions of a pair: proposals, their selection for each hypothesis about the dominant motion, and refinement level by level.

use super::Work;
use super::settings::{Part, Settings};
use crate::alignment::cost::total;
use crate::frame::pyramid::Level;
use crate::motion::AffineMotion;
use crate::progress::Stages;
use crate::proposal::algebraic::from_algebra;
use crate::proposal::local_flow::local_flow;
use crate::proposal::tiles::from_tiles;
use crate::random::Random;
use crate::selection::{Deflation, Layer, add_motions, fine_proposals, prune, refit, smallest_cost};

/// "Nothing but objects moves" is a hypothesis of its own only where standing still, added to the motions found beside the dominant one,
/// brings the cost below this share: where much of the frame is flat, one motion bent over several objects can explain more than the
/// background that stands still, and then much of the background is explained by nothing else.
const MISSING: f64 = 0.95;
/// It wins only where all motions together then cost less than this share of what they cost beside the dominant motion: a background
/// that moves by less than a pixel costs about as much at rest, with a motion more.
const CLEARLY: f64 = 0.9;

impl Settings {
    /// How motions are added at the level of the selection (0) and at finer ones (1).
    fn deflation(&self, stage: usize) -> Deflation {
        Deflation { price: self.price[stage], most: self.most, tries: self.tries, window: self.gain_window }
    }

    fn refit(&self, level: &Level, layers: &mut [Layer], rounds: usize) {
        refit(level, layers, if self.has(Part::Refinement) { rounds } else { 0 });
    }
}

/// Motions, and the best one that was proposed and is not among them.
pub(super) struct Found {
    pub(super) layers: Vec<Layer>,
    pub(super) left_out: Option<AffineMotion>,
}

/// The motions beside the dominant one as found, or those beside "nothing but objects moves" where these are clearly cheaper.
pub(super) fn best(
    work: &Work,
    dominant: AffineMotion,
    settings: &Settings,
    random: &mut Random,
    stages: &mut Stages<'_>,
) -> Found {
    let (mut winner, least) = with_dominant(work, dominant, None, settings, random, stages);
    let other = dominant != AffineMotion::STATIC && settings.has(Part::StaticHypothesis);
    if other && rest_is_missing(&work.levels[work.selection], &winner.layers) {
        let (found, cost) = with_dominant(work, AffineMotion::STATIC, Some(dominant), settings, random, stages);
        if cost < CLEARLY * least {
            winner = found;
        }
    }
    winner
}

/// Whether standing still explains much that no layer does.
fn rest_is_missing(level: &Level, layers: &[Layer]) -> bool {
    let found = smallest_cost(layers);
    let mut with_rest = found.clone();
    Layer::new(level, AffineMotion::STATIC).lower(&mut with_rest);
    total(&with_rest) < MISSING * total(&found)
}

/// Motions under one hypothesis, and what they cost.
fn with_dominant(
    work: &Work,
    dominant: AffineMotion,
    rival: Option<AffineMotion>,
    settings: &Settings,
    random: &mut Random,
    stages: &mut Stages<'_>,
) -> (Found, f64) {
    let level = &work.levels[work.base];
    stages.begin("measurements");
    let flow = local_flow(&work.levels, &dominant, work.base);
    stages.begin("algebra");
    let mut proposals = Vec::new();
    if settings.has(Part::Algebra) {
        proposals = from_algebra(level, &dominant, &flow, settings.degrees, settings.measurements, random);
    }
    if settings.has(Part::Windows) {
        proposals.extend(from_tiles(level, &dominant, &flow, settings.tiles));
    }
    proposals.extend(rival);
    stages.begin("selection");
    let level = &work.levels[work.selection];
    let mut layers = vec![Layer::new(level, dominant)];
    let left_out = add_motions(level, &mut layers, &proposals, settings.deflation(0));
    settings.refit(level, &mut layers, 1);
    let cost = total(&smallest_cost(&layers)) + settings.hypothesis_price * layers.len() as f64;
    (Found { layers, left_out }, cost)
}

/// Refines motions from the level of the selection to the working size, adding what only shows there.
pub(super) fn refine(work: &Work, found: Found, settings: &Settings) -> Found {
    let Found { mut layers, mut left_out } = found;
    settings.refit(&work.levels[work.selection], &mut layers, 2);
    if settings.least == 1 {
        prune(&mut layers, settings.price[0]);
    }
    for level in work.levels[..work.selection].iter().rev() {
        let level = &level.thinned(2);
        layers = layers.iter().map(|l| Layer::new(level, l.motion)).collect();
        if settings.has(Part::FinerLevels) {
            let how = Deflation { tries: 2, ..settings.deflation(1) };
            let proposals = fine_proposals(level, &layers);
            left_out = add_motions(level, &mut layers, &proposals, how).or(left_out);
        }
        settings.refit(level, &mut layers, 1);
    }
    Found { layers, left_out }
}
