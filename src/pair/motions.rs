//! The motions of a hypothesis: the first is the dominant one, the others are proposed and selected, then refined level by level.

use super::frames::Pair;
use super::observer::Observer;
use super::settings::Settings;
use crate::estimation::alignment::{Alignment, Support, align, ridge_of_label, softened};
use crate::estimation::proposal::algebraic::from_algebra;
use crate::estimation::proposal::local_flow::local_flow;
use crate::estimation::proposal::tiles::from_tiles;
use crate::estimation::selection::{
    GreedySelection, ScoredMotion, add_motions, fine_proposals, prune, refit, smallest_cost,
};
use crate::frame::filter::eroded;
use crate::frame::scaling::Scaling;
use crate::labelling::regions::description::motion_penalty_on;
use crate::labelling::{BACKGROUND, mask_of};
use crate::motion::AffineMotion;
use crate::view::brightness::GainBias;
use crate::view::level::PairLevel;

impl Settings {
    /// The penalty of a motion on a level, in summed costs; small if the number of motions is given, so that every motion that helps is
    /// added.
    fn penalty(&self, level: &PairLevel) -> f64 {
        if self.least > 1 { 1.0 } else { motion_penalty_on(level) }
    }

    /// How motions are added on a level.
    fn greedy(&self, level: &PairLevel) -> GreedySelection {
        GreedySelection {
            penalty: self.penalty(level),
            most: self.most,
            tries: self.tries,
            window: self.model.cost_window,
            convergence: self.refinement,
        }
    }

    /// Refines motions on a level, each on its own pixels.
    fn refit(&self, level: &PairLevel, selected: &mut [ScoredMotion]) {
        refit(level, selected, self.model.refit_rounds, self.refinement);
    }

    /// Refines motions that were estimated on a sample of the working pixels on all of them.
    fn complete(&self, pair: &Pair, selected: &mut Vec<ScoredMotion>) {
        if self.completes {
            let level = pair.finest();
            *selected = scored_on(level, &motions_of(selected));
            refit(level, selected, 1, self.refinement);
        }
    }

    /// Removes motions whose gain is below their penalty, unless the number of motions is given.
    fn prune(&self, level: &PairLevel, selected: &mut Vec<ScoredMotion>) {
        if self.least == 1 {
            prune(selected, self.penalty(level));
        }
    }
}

/// The motions selected in addition to the dominant one, and the best proposal that was rejected.
pub(super) fn select(
    pair: &Pair,
    dominant: AffineMotion,
    others: &[AffineMotion],
    settings: &Settings,
    observer: &mut dyn Observer,
) -> (Vec<ScoredMotion>, Option<AffineMotion>) {
    let level = &pair.levels[pair.base];
    observer.stage_begins("measurements");
    let flow = local_flow(&pair.levels, &dominant, pair.base);
    observer.dominant_found(pair, dominant, &flow, settings);
    observer.stage_begins("algebra");
    let mut proposals = from_algebra(level, &dominant, &flow, settings.degrees, settings.measurements);
    proposals.extend(from_tiles(level, &dominant, &flow, settings.tiles));
    proposals.extend(others);
    observer.stage_begins("selection");
    let level = &pair.levels[pair.selection];
    let mut selected = vec![ScoredMotion::new(level, dominant)];
    observer.proposed(pair, &selected[0], &proposals, settings.greedy(level));
    let rejected = add_motions(level, &mut selected, &proposals, settings.greedy(level));
    observer.selected(pair, &selected);
    settings.refit(level, &mut selected);
    (selected, rejected)
}

/// Refines the motions from the selection level up to the working size, and adds motions that only show at finer levels. Returns the best
/// of these proposals that was rejected.
pub(super) fn refine(pair: &Pair, selected: &mut Vec<ScoredMotion>, settings: &Settings) -> Option<AffineMotion> {
    let level = &pair.levels[pair.selection];
    settings.refit(level, selected);
    settings.prune(level, selected);
    let mut rejected = None;
    for level in pair.levels[..pair.selection].iter().rev() {
        let level = &level.thinned();
        *selected = scored_on(level, &motions_of(selected));
        rejected = add_fine(level, selected, settings).or(rejected);
    }
    if pair.selection > 0 {
        settings.complete(pair, selected);
    }
    rejected
}

/// Adds motions that only show on a thinned level, and refines all motions. Returns the best proposal that was rejected.
fn add_fine(level: &PairLevel, selected: &mut Vec<ScoredMotion>, settings: &Settings) -> Option<AffineMotion> {
    let how = GreedySelection { tries: settings.model.tries_fast, ..settings.greedy(level) };
    let proposals = fine_proposals(level, selected, settings.tiles);
    let rejected = add_motions(level, selected, &proposals, how);
    settings.refit(level, selected);
    rejected
}

/// Adds motions that only show at the working size. Returns the best proposal that was rejected.
pub(super) fn add_detail(pair: &Pair, motions: &mut Vec<AffineMotion>, settings: &Settings) -> Option<AffineMotion> {
    let level = &pair.finest().thinned();
    let mut selected = scored_on(level, motions);
    let rejected = add_fine(level, &mut selected, settings);
    *motions = motions_of(&selected);
    rejected
}

/// The motions without their costs.
pub(super) fn motions_of(selected: &[ScoredMotion]) -> Vec<AffineMotion> {
    selected.iter().map(|one| one.motion).collect()
}

/// Motions with their costs on a level.
fn scored_on(level: &PairLevel, motions: &[AffineMotion]) -> Vec<ScoredMotion> {
    motions.iter().map(|&motion| ScoredMotion::new(level, motion)).collect()
}

/// The summed cost of a sample of the working pixels, each under the motion that fits it best.
pub(super) fn cost(pair: &Pair, motions: &[AffineMotion]) -> f64 {
    smallest_cost(&scored_on(&pair.finest().thinned(), motions)).total()
}

/// Refines each motion on the pixels that expected labels of the working size give it. Motions that are no longer needed are removed
/// together with their pixels. Also returns the cost of the sample on which the motions were refined.
pub(super) fn follow(
    pair: &Pair,
    dominant: AffineMotion,
    objects: &[AffineMotion],
    labels: &mut [u8],
    settings: &Settings,
) -> (Vec<AffineMotion>, f64) {
    let level = &pair.finest().thinned();
    let (width, height, model) = (level.width(), level.height(), level.model);
    let expected = Scaling::between(pair.scaling.small, [width, height]).thinned(labels);
    let mut selected = vec![ScoredMotion::new(level, dominant)];
    for (label, motion) in (BACKGROUND + 1..).zip(objects) {
        let region = softened(&eroded(&mask_of(&expected, label as u8, width, height)));
        let how = Alignment::of_region(model.region_iterations, ridge_of_label(label, model), model);
        let motion = align(level, motion, &Support::weighted(&region, model), &mut GainBias::default(), how);
        selected.push(ScoredMotion::new(level, motion));
    }
    settings.refit(level, &mut selected);
    let all = motions_of(&selected);
    settings.prune(level, &mut selected);
    let number = |motion: &AffineMotion| selected.iter().position(|scored| scored.motion == *motion);
    let numbers: Vec<u8> = all.iter().map(|motion| number(motion).unwrap_or(BACKGROUND) as u8).collect();
    labels.iter_mut().for_each(|label| *label = numbers[usize::from(*label)]);
    let cost = smallest_cost(&selected).total();
    settings.complete(pair, &mut selected);
    (motions_of(&selected), cost)
}

/// Adds at most `most` motions from single windows whose gain exceeds their penalty. The first motion is the dominant one.
pub(super) fn add_missing(pair: &Pair, motions: &mut Vec<AffineMotion>, most: usize, settings: &Settings) {
    let level = &pair.levels[pair.selection];
    let dominant = &motions[BACKGROUND];
    let flow = local_flow(&pair.levels, dominant, pair.base);
    let proposals = from_tiles(&pair.levels[pair.base], dominant, &flow, settings.tiles);
    let mut selected = scored_on(level, motions);
    add_motions(level, &mut selected, &proposals, GreedySelection { most, ..settings.greedy(level) });
    motions.extend(selected[motions.len()..].iter().map(|one| one.motion));
}
