//! The label of every working pixel.
//!
//! On the draft level, motions whose gain is below their penalty are removed, costs are corrected for occlusion, and regions are merged and
//! split. At the working size, labels are then solved once more, with colours, and small components are removed. Finally, shadows are
//! given back to the background.

use super::frames::Pair;
use super::observer::Observer;
use super::settings::Settings;
use crate::components::absorb_small;
use crate::frame::Plane;
use crate::labelling::regions::description::{counts, length, motion_penalty, worth};
use crate::labelling::regions::merging::best_merger;
use crate::labelling::regions::splitting::split_bodies;
use crate::labelling::shadows;
use crate::labelling::solver::Solver;
use crate::labelling::terms::colour::add_colours;
use crate::labelling::terms::data::{Compared, compare, estimation_costs, label_costs};
use crate::labelling::terms::smoothness::EdgeWeights;
use crate::labelling::terms::visibility::with_visibility;
use crate::labelling::{BACKGROUND, is_background, objects};
use crate::motion::AffineMotion;
use crate::view::level::PairLevel;

/// A pair with its motions (pixels of the working size) and the label of each working pixel.
pub(super) struct LabelledPair {
    /// Its change of brightness is removed.
    pub(super) pair: Pair,
    pub(super) motions: Vec<AffineMotion>,
    pub(super) labels: Vec<u8>,
    /// The best motion that was rejected, here or during selection, because its gain was below its penalty.
    pub(super) rejected: Option<AffineMotion>,
}

impl LabelledPair {
    /// Description length of both frames at the working size if their noise is as given, nats.
    pub(super) fn length(&self, noise: f32) -> f64 {
        let level = PairLevel { noise, ..self.pair.finest().clone() };
        let costs = estimation_costs(&level, &compare(&level, &self.motions, Vec::new()));
        length(&self.motions, &costs, &self.labels, level.width(), level.model)
    }
}

/// Where the labels of a pair start from.
pub(super) enum Start {
    /// Each pixel starts with its cheapest motion.
    Costs,
    /// Labels that are expected at the working size. Regions are merged and split, or taken as they are.
    Expected { labels: Vec<u8>, regroups: bool },
}

/// The energy of the labels on a level: the motions, their costs, the weights of edges, and the labels of least energy so far.
struct LabelEnergy<'a> {
    pair: &'a Pair,
    level: &'a PairLevel,
    settings: &'a Settings,
    borders: EdgeWeights,
    motions: Vec<AffineMotion>,
    /// The frames along these motions.
    compared: Compared,
    /// Label costs, corrected for occlusion.
    costs: Vec<Plane>,
    /// Label costs before the correction for occlusion.
    uncorrected: Vec<Plane>,
    /// Estimation costs, from which description lengths are computed.
    raw: Vec<Plane>,
    labels: Vec<u8>,
    /// The motion pruned last, or the best one rejected by the selection.
    rejected: Option<AffineMotion>,
}

/// Labels a pair by the selected motions; `rejected` is the best motion that was not selected.
pub(super) fn label(
    pair: Pair,
    motions: Vec<AffineMotion>,
    rejected: Option<AffineMotion>,
    start: Start,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> LabelledPair {
    let mut energy = LabelEnergy::new(&pair, motions, rejected, settings);
    let (rounds, regroups) = match start {
        Start::Costs => {
            energy.solve();
            (settings.visibility_rounds, true)
        }
        Start::Expected { labels, regroups } => {
            energy.expect(pair.draft_scaling().thinned(&labels));
            (1, regroups)
        }
    };
    energy.prune();
    energy.rest_background();
    energy.correct_occlusion(rounds);
    if regroups {
        energy.regroup();
    }
    observer.regrouped(&pair, &energy.motions, &energy.labels);
    let (mut labels, mut motions, rejected) = (energy.final_labels(), energy.motions, energy.rejected);
    remove_small_components(&mut labels, &mut motions, pair.finest());
    LabelledPair { pair, motions, labels, rejected }
}

/// Gives shadows of objects back to the background.
pub(super) fn return_shadows(labelled: &mut LabelledPair, settings: &Settings) {
    let LabelledPair { pair, motions, labels, .. } = labelled;
    if motions.len() < 2 || !settings.returns_shadows {
        return;
    }
    let (palette, borders) = (&pair.appearance.palette, borders(pair, 0, settings));
    shadows::return_shadows(pair.finest(), palette, &borders, motions, labels, settings.labelling.solver);
    remove_small_components(labels, motions, pair.finest());
}

/// Smoothness weights on a level.
pub(super) fn borders(pair: &Pair, index: usize, settings: &Settings) -> EdgeWeights {
    let level = &pair.levels[index];
    let smoothness = settings.labelling.smoothness;
    EdgeWeights::new(&pair.appearance.pictures[index], level.noise, smoothness, level.model)
}

impl<'a> LabelEnergy<'a> {
    /// The energy of labels that all are those of the background.
    fn new(
        pair: &'a Pair,
        motions: Vec<AffineMotion>,
        rejected: Option<AffineMotion>,
        settings: &'a Settings,
    ) -> LabelEnergy<'a> {
        let level = &pair.levels[pair.draft];
        let compared = compare(level, &motions, Vec::new());
        let uncorrected = label_costs(level, &compared, settings.labelling);
        LabelEnergy {
            pair,
            level,
            settings,
            borders: borders(pair, pair.draft, settings),
            costs: uncorrected.clone(),
            uncorrected,
            raw: estimation_costs(level, &compared),
            compared,
            labels: vec![BACKGROUND as u8; level.width() * level.height()],
            motions,
            rejected,
        }
    }

    /// Computes all costs anew.
    fn recompute_costs(&mut self) {
        self.compared = compare(self.level, &self.motions, std::mem::take(&mut self.compared));
        self.uncorrected = label_costs(self.level, &self.compared, self.settings.labelling);
        self.costs = self.uncorrected.clone();
        self.raw = estimation_costs(self.level, &self.compared);
    }

    fn solve(&mut self) {
        self.labels = self.borders.solve(&self.costs, Solver::FAST);
    }

    /// Starts from expected labels. Where the last motion is expected nowhere, as where it was added, they are solved.
    fn expect(&mut self, labels: Vec<u8>) {
        self.labels = labels;
        if counts(&self.labels, self.motions.len()).last() == Some(&0) {
            self.solve();
        }
    }

    /// Labels of the working size, with the costs of the colours.
    fn final_labels(&mut self) -> Vec<u8> {
        let LabelEnergy { pair, settings, .. } = self;
        let level = pair.finest();
        let options = settings.labelling;
        if pair.draft > 0 {
            self.labels = pair.draft_scaling().enlarged(&self.labels);
            let costs = label_costs(level, &compare(level, &self.motions, Vec::new()), options);
            self.costs = with_visibility(level, &self.motions, &costs, &self.labels, options.object_bias);
            self.borders = borders(pair, 0, settings);
        }
        if self.motions.len() > 1 && settings.model.colour_weight > 0.0 {
            add_colours(&mut self.costs, &pair.appearance.palette, &self.labels, settings.model);
        }
        self.borders.solve(&self.costs, options.solver)
    }

    /// Removes the motion that saves least and solves again, as long as there is one whose gain is below its penalty.
    fn prune(&mut self) {
        let most = self.settings.most;
        while self.motions.len() > self.settings.least {
            let worths = worth(&self.raw, &self.labels, self.level.width(), self.level.model);
            let Some((weakest, value)) = worths.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)) else { break };
            if *value > 0.0 && self.motions.len() <= most {
                break;
            }
            self.rejected = Some(self.motions[weakest]);
            self.remove(weakest);
            // Only the pixels of the removed motion are undecided.
            self.labels = self.borders.solve(&self.costs, Solver::LIGHT);
        }
    }

    fn remove(&mut self, k: usize) {
        self.motions.remove(k);
        self.costs.remove(k);
        self.uncorrected.remove(k);
        self.raw.remove(k);
    }

    /// Puts the background at rest if that describes its pixels in fewer nats: rest needs no parameters. A dominant motion that was fitted
    /// across objects on plain ground is recognised here, once the objects have motions of their own.
    fn rest_background(&mut self) {
        if self.motions[BACKGROUND] == AffineMotion::STATIC || self.settings.model.tries_static == 0 {
            return;
        }
        let of_background = |plane: &Plane| -> f64 {
            let pixels = plane.values().iter().zip(&self.labels).filter(|(_, label)| is_background(**label));
            pixels.map(|(cost, _)| f64::from(*cost)).sum()
        };
        let at_rest = estimation_costs(self.level, &compare(self.level, &[AffineMotion::STATIC], Vec::new()));
        let lost = 0.5 * (of_background(&at_rest[0]) - of_background(&self.raw[BACKGROUND]));
        if lost < motion_penalty(counts(&self.labels, 1)[BACKGROUND]) {
            self.motions[BACKGROUND] = AffineMotion::STATIC;
            self.recompute_costs();
            self.solve();
            self.prune();
        }
    }

    /// Corrects for occlusion in several rounds, since what is occluded depends on the labels.
    fn correct_occlusion(&mut self, rounds: usize) {
        if self.motions.len() < 2 {
            return;
        }
        for _ in 0..rounds {
            self.hide_occluded();
            self.solve();
        }
        self.prune();
    }

    /// Updates the costs: a motion costs less at pixels that it moves behind another object.
    fn hide_occluded(&mut self) {
        let object_bias = self.settings.labelling.object_bias;
        self.costs = with_visibility(self.level, &self.motions, &self.uncorrected, &self.labels, object_bias);
    }

    /// Merges and splits regions where that shortens the description.
    fn regroup(&mut self) {
        self.merge();
        if self.split() {
            self.prune();
            self.merge();
        }
    }

    /// Merges regions that one motion explains better than two.
    fn merge(&mut self) {
        while self.motions.len() > self.settings.least && self.settings.model.merges > 0 {
            let Some(merger) = best_merger(self.level, &self.motions, &self.raw, &self.labels) else { break };
            let [kept, gone] = merger.labels;
            self.motions[kept] = merger.motion;
            self.motions.remove(gone);
            for label in &mut self.labels {
                *label = match usize::from(*label) {
                    l if l == gone => kept as u8,
                    l if l > gone => *label - 1,
                    _ => *label,
                };
            }
            self.recompute_costs();
            self.hide_occluded();
            self.solve();
        }
    }

    /// Splits regions that contain several bodies. Returns whether there were any.
    fn split(&mut self) -> bool {
        if self.motions.len() < 2 || self.settings.model.splits == 0 {
            return false;
        }
        self.clean();
        if !split_bodies(self.level, &mut self.motions, &mut self.labels, self.settings.most) {
            return false;
        }
        self.recompute_costs();
        self.hide_occluded();
        self.solve();
        true
    }

    /// Gives small components to the labels around them and removes motions without pixels.
    fn clean(&mut self) {
        for k in absorb_small_components(&mut self.labels, self.level, self.motions.len()) {
            self.remove(k);
        }
    }
}

/// Gives small components of labels to the labels around them, and removes motions that are then without pixels.
fn remove_small_components(labels: &mut [u8], motions: &mut Vec<AffineMotion>, level: &PairLevel) {
    for k in absorb_small_components(labels, level, motions.len()) {
        motions.remove(k);
    }
}

/// Gives small components of labels to the labels around them. Returns the objects that are then without pixels, the last one first; labels
/// are numbered as if there were none.
#[inline(never)]
fn absorb_small_components(labels: &mut [u8], level: &PairLevel, motions: usize) -> Vec<usize> {
    let smallest = (level.model.smallest_share * labels.len() as f64) as usize;
    absorb_small(labels, level.width(), smallest);
    let sizes = counts(labels, motions);
    let without: Vec<usize> = objects(motions).rev().filter(|&k| sizes[k] == 0).collect();
    let renumbered = |label: u8| label - without.iter().filter(|&&k| k < usize::from(label)).count() as u8;
    labels.iter_mut().for_each(|label| *label = renumbered(*label));
    without
}
