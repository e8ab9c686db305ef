//! Observers get what the stages of a pair find, while they find it: for progress reports, or for the figures of the site.

use super::frames::Pair;
use super::settings::Settings;
use crate::estimation::proposal::local_flow::LocalFlow;
use crate::estimation::selection::{GreedySelection, ScoredMotion};
use crate::motion::AffineMotion;
use crate::progress::Stages;

/// Is called by the stages of a pair, in the order of the methods. Motions are in pixels of the working size; the first is that of the
/// background.
pub(crate) trait Observer {
    /// A round begins. The frames are prepared in every round, each time with a finer working size.
    fn round_begins(&mut self, _round: usize, _rounds: usize) {}

    /// A stage begins.
    fn stage_begins(&mut self, _name: &'static str) {}

    /// A hypothesis about the background begins: its motion, and the local flow relative to it on the base level.
    fn dominant_found(&mut self, _: &Pair, _dominant: AffineMotion, _: &LocalFlow, _: &Settings) {}

    /// Motions are proposed in addition to the dominant one, which is scored on the level of the selection. Known ones come last.
    fn proposed(&mut self, _: &Pair, _dominant: &ScoredMotion, _proposals: &[AffineMotion], _: GreedySelection) {}

    /// Motions have been selected greedily.
    fn selected(&mut self, _: &Pair, _: &[ScoredMotion]) {}

    /// The selected motions have been refined on the intensities of their pixels.
    fn refined(&mut self, _: &Pair, _: &[ScoredMotion]) {}

    /// Labels have been solved, and motions merged and split.
    fn regrouped(&mut self, _: &Pair, _motions: &[AffineMotion], _labels: &[u8]) {}

    /// Labels have been solved with colours, which ends the hypothesis.
    fn labelled(&mut self, _: &Pair, _motions: &[AffineMotion], _labels: &[u8]) {}

    /// One of two hypotheses is taken.
    fn chosen(&mut self, _hypothesis: usize) {}

    /// The search has been continued at a finer working size.
    fn carried_on(&mut self, _: &Pair, _motions: &[AffineMotion], _labels: &[u8]) {}

    /// Labels of the working size are final.
    fn finished(&mut self, _: &Pair, _motions: &[AffineMotion], _labels: &[u8]) {}
}

/// No observer.
impl Observer for () {}

impl Observer for Stages<'_> {
    fn round_begins(&mut self, round: usize, rounds: usize) {
        self.begin_round(round, rounds);
    }

    fn stage_begins(&mut self, name: &'static str) {
        self.begin(name);
    }
}
