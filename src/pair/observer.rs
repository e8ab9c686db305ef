//! Who is told of what the stages of a pair find, while they find it: a listener to progress, or the figures of the site.

use super::frames::Pair;
use super::settings::Settings;
use crate::estimation::proposal::local_flow::LocalFlow;
use crate::estimation::selection::{GreedySelection, ScoredMotion};
use crate::motion::AffineMotion;
use crate::progress::Stages;

/// Listens to the stages of a pair, in the order of the methods. Motions are in pixels of the working size; the first is that of the
/// background.
pub(crate) trait Observer {
    /// The frames are prepared in one of several rounds, each with a finer working size.
    fn round_begins(&mut self, _round: usize, _rounds: usize) {}

    /// A stage begins.
    fn stage_begins(&mut self, _name: &'static str) {}

    /// A hypothesis about the background begins: its motion, and the flow beside it on the base level.
    fn dominant_found(&mut self, _: &Pair, _dominant: AffineMotion, _: &LocalFlow, _: &Settings) {}

    /// Motions are proposed beside the dominant one, which is scored on the level of the selection. Known ones come last.
    fn proposed(&mut self, _: &Pair, _dominant: &ScoredMotion, _proposals: &[AffineMotion], _: GreedySelection) {}

    /// Motions are selected greedily …
    fn selected(&mut self, _: &Pair, _: &[ScoredMotion]) {}

    /// … and refined on the intensities of their pixels.
    fn refined(&mut self, _: &Pair, _: &[ScoredMotion]) {}

    /// Labels are solved, motions merged and split …
    fn regrouped(&mut self, _: &Pair, _motions: &[AffineMotion], _labels: &[u8]) {}

    /// … and labels solved with colours, which ends the hypothesis.
    fn labelled(&mut self, _: &Pair, _motions: &[AffineMotion], _labels: &[u8]) {}

    /// Of two hypotheses this one is taken.
    fn chosen(&mut self, _hypothesis: usize) {}

    /// Labels are carried on at a finer working size.
    fn carried_on(&mut self, _: &Pair, _motions: &[AffineMotion], _labels: &[u8]) {}

    /// Labels of the working size are final.
    fn finished(&mut self, _: &Pair, _motions: &[AffineMotion], _labels: &[u8]) {}
}

/// Nobody listens.
impl Observer for () {}

impl Observer for Stages<'_> {
    fn round_begins(&mut self, round: usize, rounds: usize) {
        self.begin_round(round, rounds);
    }

    fn stage_begins(&mut self, name: &'static str) {
        self.begin(name);
    }
}
