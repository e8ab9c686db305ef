//! The label of every working pixel.
//!
//! Draft labels are solved on a coarser level. There, motions that do not pay for themselves are pruned, costs are corrected for
//! occlusion, and regions are merged and split. The labels are then sharpened at the working size, and small components removed. In the end,
//! shadows are given back to the background.

use super::frames::Pair;
use super::observer::Observer;
use super::settings::Settings;
use crate::components::absorb_small;
use crate::frame::Plane;
use crate::labelling::regions::description::{counts, length, price_of_motion, worth};
use crate::labelling::regions::merging::best_merger;
use crate::labelling::regions::splitting::split_bodies;
use crate::labelling::resolution::sharpening::{CoarseLabelling, WorkingLevel, sharpened};
use crate::labelling::shadows;
use crate::labelling::solver::Solver;
use crate::labelling::terms::colour::{ColourPrices, add_colours};
use crate::labelling::terms::data::{Compared, LabelCosts, compare, estimation_costs};
use crate::labelling::terms::smoothness::Borders;
use crate::labelling::terms::visibility::{hidden_under, with_visibility};
use crate::labelling::{BACKGROUND, is_background, objects, thinned};
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::view::level::Level;

/// A pair with its motions (pixels of the working size) and the label of each working pixel.
pub(super) struct LabelledPair {
    /// Its change of brightness is removed.
    pub(super) pair: Pair,
    pub(super) motions: Vec<AffineMotion>,
    pub(super) labels: Vec<u8>,
    /// The best motion that was rejected, here or during selection, because it did not pay for itself.
    pub(super) rejected: Option<AffineMotion>,
}

impl LabelledPair {
    /// Description length of both frames at the working size if their noise is as given, nats.
    pub(super) fn length(&self, noise: f32) -> f64 {
        let level = Level { noise, ..self.pair.finest().clone() };
        let costs = estimation_costs(&level, &compare(&level, &self.motions, Vec::new()));
        length(&self.motions, &costs, &self.labels, level.width(), level.model)
    }
}

/// The energy of the labels on the draft level: the motions, their costs, the weights of borders, and the labels of least energy so far.
struct LabelEnergy<'a> {
    level: &'a Level,
    settings: &'a Settings,
    borders: Borders,
    motions: Vec<AffineMotion>,
    /// The frames along these motions.
    compared: Compared,
    /// Label costs, corrected for occlusion.
    costs: Vec<Plane>,
    /// Label costs before the correction for occlusion.
    uncorrected: LabelCosts,
    /// Estimation costs, from which description lengths are computed.
    raw: Vec<Plane>,
    labels: Vec<u8>,
    /// The motion pruned last, or the best one rejected by the selection.
    rejected: Option<AffineMotion>,
}

/// Labels a pair by the selected motions.
pub(super) fn label(
    pair: Pair,
    motions: Vec<AffineMotion>,
    rejected: Option<AffineMotion>,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> LabelledPair {
    let mut energy = LabelEnergy::new(&pair, motions, settings);
    energy.rejected = rejected;
    energy.solve();
    energy.prune();
    energy.try_static_background();
    energy.correct_occlusion();
    energy.regroup();
    observer.drafted(&pair, &energy.motions, &energy.labels);
    if pair.draft == 0 {
        energy.add_colour_costs(&pair);
        energy.solve_final();
    } else {
        energy.sharpen(&pair);
    }
    let (motions, labels, rejected) = energy.finished(&pair);
    LabelledPair { pair, motions, labels, rejected }
}

/// Labels that go on from those expected at the working size: unless regions are merged or split, they are solved once.
pub(super) fn label_on(
    pair: Pair,
    motions: Vec<AffineMotion>,
    expected: &[u8],
    regroups: bool,
    settings: &Settings,
) -> LabelledPair {
    let mut energy = LabelEnergy::new(&pair, motions, settings);
    energy.labels = thinned(expected, pair.finest().width(), 1 << pair.draft);
    if counts(&energy.labels, energy.motions.len()).last() == Some(&0) {
        // The last motion is not expected anywhere, as where it was added.
        energy.solve();
    }
    energy.prune();
    energy.try_static_background();
    if energy.motions.len() > 1 {
        energy.update_occlusion();
    }
    if regroups {
        energy.regroup();
    }
    if pair.draft == 0 {
        energy.add_colour_costs(&pair);
        energy.solve_final();
        energy.prune();
    } else {
        energy.solve();
        energy.prune();
        energy.sharpen(&pair);
    }
    let (motions, labels, rejected) = energy.finished(&pair);
    LabelledPair { pair, motions, labels, rejected }
}

/// Gives shadows of objects back to the background.
pub(super) fn return_shadows(labelled: &mut LabelledPair, settings: &Settings) {
    let LabelledPair { pair, motions, labels, .. } = labelled;
    if motions.len() < 2 || !settings.returns_shadows {
        return;
    }
    let (palette, borders) = (&pair.appearance.palette, borders(pair, 0, settings));
    shadows::return_shadows(pair.finest(), palette, &borders, motions, labels, settings.coherence.solver);
    let sizes = absorb_small_components(labels, pair.finest().width(), motions.len(), settings.model);
    for k in objects(sizes.len()).rev().filter(|&k| sizes[k] == 0) {
        motions.remove(k);
    }
}

/// Smoothness weights on a level.
pub(super) fn borders(pair: &Pair, index: usize, settings: &Settings) -> Borders {
    let level = &pair.levels[index];
    let smoothness = settings.coherence.smoothness;
    Borders::new(&pair.appearance.pictures[index], level.noise, smoothness, level.model)
}

impl<'a> LabelEnergy<'a> {
    /// The energy of labels that all are those of the background.
    fn new(pair: &'a Pair, motions: Vec<AffineMotion>, settings: &'a Settings) -> LabelEnergy<'a> {
        let level = &pair.levels[pair.draft];
        let compared = compare(level, &motions, Vec::new());
        let uncorrected = LabelCosts::new(level, &compared, settings.coherence);
        LabelEnergy {
            level,
            settings,
            borders: borders(pair, pair.draft, settings),
            costs: uncorrected.costs.clone(),
            uncorrected,
            raw: estimation_costs(level, &compared),
            compared,
            labels: vec![BACKGROUND as u8; level.width() * level.height()],
            motions,
            rejected: None,
        }
    }

    /// Motions, labels and the rejected motion, without small components and motions that have no pixels.
    fn finished(mut self, pair: &Pair) -> (Vec<AffineMotion>, Vec<u8>, Option<AffineMotion>) {
        self.clean(pair.finest().width());
        (self.motions, self.labels, self.rejected)
    }

    /// Computes all costs anew.
    fn recompute_costs(&mut self) {
        self.compared = compare(self.level, &self.motions, std::mem::take(&mut self.compared));
        self.uncorrected = LabelCosts::new(self.level, &self.compared, self.settings.coherence);
        self.costs = self.uncorrected.costs.clone();
        self.raw = estimation_costs(self.level, &self.compared);
    }

    fn solve(&mut self) {
        self.labels = self.borders.solve(&self.costs, self.settings.coherence.draft_solver);
    }

    fn uses_colour(&self) -> bool {
        self.motions.len() > 1 && self.settings.model.colour_price > 0.0
    }

    /// Adds the costs of the colours.
    fn add_colour_costs(&mut self, pair: &Pair) {
        if self.uses_colour() {
            add_colours(&mut self.costs, &pair.appearance.palette, &self.labels, self.level.model);
        }
    }

    /// Solves for the final labels.
    fn solve_final(&mut self) {
        self.labels = self.borders.solve(&self.costs, self.settings.coherence.solver);
    }

    /// Turns draft labels into labels of the working size.
    fn sharpen(&mut self, pair: &Pair) {
        let step = 1 << pair.draft;
        let colours = self.uses_colour().then(|| {
            ColourPrices::learned(&pair.appearance.palette.thinned(step), &self.costs, &self.labels, self.level.model)
        });
        let visible = self.motions.len() < 2;
        let hidden = if visible { Vec::new() } else { hidden_under(self.level, &self.motions, &self.labels) };
        let coarse = CoarseLabelling {
            width: self.level.width(),
            labels: &self.labels,
            step,
            variance_inflation: &self.uncorrected.variance_inflation,
            hidden: &hidden,
            colours: colours.as_ref(),
        };
        let fine = WorkingLevel {
            level: pair.finest(),
            picture: &pair.appearance.pictures[0],
            palette: &pair.appearance.palette,
            motions: &self.motions,
            coherence: self.settings.coherence,
        };
        self.labels = sharpened(&coarse, &fine, self.settings.coherence.sharpening);
    }

    /// Removes the least worthy motion and solves again, as long as there is one that does not pay for itself.
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
        self.uncorrected.costs.remove(k);
        self.raw.remove(k);
    }

    /// Corrects for occlusion. Takes several rounds, since what is occluded depends on the masks.
    fn correct_occlusion(&mut self) {
        if self.motions.len() < 2 {
            return;
        }
        for _ in 0..self.settings.visibility_rounds {
            self.update_occlusion();
            self.solve();
        }
        self.prune();
    }

    /// Updates the costs: no motion pays for pixels that are occluded in the second frame.
    fn update_occlusion(&mut self) {
        let object_bias = self.settings.coherence.object_bias;
        self.costs = with_visibility(self.level, &self.motions, &self.uncorrected.costs, &self.labels, object_bias);
    }

    /// Makes the background static if that shortens the description: the zero motion costs no parameters. A dominant motion that was
    /// fitted across objects on a flat background is recognised here, once the objects have motions of their own.
    fn try_static_background(&mut self) {
        if self.motions[BACKGROUND] == AffineMotion::STATIC || self.settings.model.tries_static == 0 {
            return;
        }
        let own = |plane: &Plane| -> f64 {
            let pixels = plane.values().iter().zip(&self.labels).filter(|(_, label)| is_background(**label));
            pixels.map(|(cost, _)| f64::from(*cost)).sum()
        };
        let rest = compare(self.level, &[AffineMotion::STATIC], Vec::new());
        let at_rest: f64 = estimation_costs(self.level, &rest).iter().map(own).sum();
        if 0.5 * (at_rest - own(&self.raw[BACKGROUND])) < price_of_motion(counts(&self.labels, 1)[0]) {
            self.motions[BACKGROUND] = AffineMotion::STATIC;
            self.recompute_costs();
            self.solve();
            self.prune();
        }
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
            self.update_occlusion();
            self.solve();
        }
    }

    /// Splits regions that contain several bodies. Returns whether there were any.
    fn split(&mut self) -> bool {
        if self.motions.len() < 2 || self.settings.model.splits == 0 {
            return false;
        }
        let level = self.level;
        self.clean(level.width());
        if !split_bodies(level, &mut self.motions, &mut self.labels, self.settings.most) {
            return false;
        }
        self.recompute_costs();
        self.update_occlusion();
        self.solve();
        true
    }

    /// Gives small components to the labels around them and removes motions without pixels. Rows of labels are `width` long.
    fn clean(&mut self, width: usize) {
        let sizes = absorb_small_components(&mut self.labels, width, self.motions.len(), self.level.model);
        for k in objects(sizes.len()).rev().filter(|&k| sizes[k] == 0) {
            self.remove(k);
        }
    }
}

/// Gives small components of labels, in rows of `width`, to the labels around them. Returns the pixels of each of the motions; afterwards the
/// labels are numbered as if there were no objects without pixels.
#[inline(never)]
fn absorb_small_components(labels: &mut [u8], width: usize, motions: usize, model: &Model) -> Vec<usize> {
    let smallest = (model.smallest_share * labels.len() as f64) as usize;
    absorb_small(labels, width, smallest);
    let sizes = counts(labels, motions);
    let mut next = 0u8;
    let renumbered: Vec<u8> = (0..motions)
        .map(|k| {
            let number = next;
            if k == BACKGROUND || sizes[k] > 0 {
                next += 1;
            }
            number
        })
        .collect();
    labels.iter_mut().for_each(|l| *l = renumbered[usize::from(*l)]);
    sizes
}
