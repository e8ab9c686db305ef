//! The motions of a pair: proposals beside the dominant motion, their selection, and refinement level by level.

use super::Work;
use super::settings::{Part, Settings};
use crate::frame::pyramid::Level;
use crate::motion::AffineMotion;
use crate::progress::Stages;
use crate::proposal::algebraic::from_algebra;
use crate::proposal::local_flow::local_flow;
use crate::proposal::tiles::from_tiles;
use crate::random::Random;
use crate::selection::{Deflation, Layer, add_motions, fine_proposals, prune, refit};

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

/// The dominant motion and those beside it that are proposed and pay for themselves.
pub(super) fn select(
    work: &Work,
    dominant: AffineMotion,
    settings: &Settings,
    random: &mut Random,
    stages: &mut Stages<'_>,
) -> Found {
    let base = &work.levels[work.base];
    stages.begin("measurements");
    let flow = local_flow(&work.levels, &dominant, work.base);
    stages.begin("algebra");
    let mut proposals = Vec::new();
    if settings.has(Part::Algebra) {
        proposals = from_algebra(base, &dominant, &flow, settings.degrees, settings.measurements, random);
    }
    if settings.has(Part::Windows) {
        proposals.extend(from_tiles(base, &dominant, &flow, settings.tiles));
    }
    stages.begin("selection");
    let level = &work.levels[work.selection];
    let mut layers = vec![Layer::new(level, dominant)];
    let left_out = add_motions(level, &mut layers, &proposals, settings.deflation(0));
    Found { layers, left_out }
}

/// Refines motions from the level of the selection to the working size, adding what only shows there.
pub(super) fn refine(work: &Work, found: Found, settings: &Settings) -> Found {
    let Found { mut layers, mut left_out } = found;
    settings.refit(&work.levels[work.selection], &mut layers, 3);
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
