//! The motions of a pair: they are proposed and selected beside the dominant one, then refined level by level.

use super::Pair;
use super::observer::Observer;
use super::settings::Settings;
use crate::estimation::alignment::{Alignment, Support, align, ridge_of_label, softened};
use crate::estimation::dominant::DominantSearch;
use crate::estimation::proposal::algebraic::from_algebra;
use crate::estimation::proposal::local_flow::local_flow;
use crate::estimation::proposal::tiles::from_tiles;
use crate::estimation::selection::{Deflation, ScoredMotion, add_motions, fine_proposals, prune, refit, smallest_cost};
use crate::frame::filter::eroded;
use crate::labelling::regions::description::price_on;
use crate::labelling::{BACKGROUND, mask_of};
use crate::motion::AffineMotion;
use crate::view::brightness::Photometric;
use crate::view::level::Level;

impl Settings {
    /// How the dominant motion is found.
    pub(super) fn dominant_search(&self) -> DominantSearch {
        DominantSearch { brightness: self.brightness(), convergence: self.dominant }
    }

    /// What pays for a motion on a level, in summed costs. Who gives the number of motions knows better: anything that helps is added.
    fn price(&self, level: &Level) -> f64 {
        if self.least > 1 { 1.0 } else { price_on(level) }
    }

    /// How motions are added on a level.
    fn deflation(&self, level: &Level) -> Deflation {
        Deflation {
            price: self.price(level),
            most: self.most,
            tries: self.tries,
            window: self.model.window,
            convergence: self.refinement,
        }
    }

    fn refit(&self, level: &Level, selected: &mut [ScoredMotion], rounds: usize) {
        refit(level, selected, rounds, self.refinement);
    }
}

/// The selected motions, and the best proposal that was rejected.
pub(super) struct Found {
    pub(super) selected: Vec<ScoredMotion>,
    pub(super) runner_up: Option<AffineMotion>,
}

/// The motions with which labels go on, each refined on the pixels that it is expected to have; those that have become needless are left
/// out, together with their pixels. And their cost. The first motion is the dominant one.
pub(super) fn followed(
    pair: &Pair,
    dominant: AffineMotion,
    objects: &[AffineMotion],
    labels: &mut [u8],
    settings: &Settings,
) -> (Found, f64) {
    let level = &pair.levels[pair.selection];
    let (width, height, model) = (level.width(), level.height(), level.model);
    let mut selected = vec![ScoredMotion::new(level, dominant)];
    for (label, motion) in (BACKGROUND + 1..).zip(objects) {
        let region = softened(&eroded(&mask_of(labels, label as u8, width, height)));
        let how = Alignment::of_region(model.iterations, ridge_of_label(label, model), model);
        let motion = align(level, motion, &Support::weighted(&region, model), &mut Photometric::default(), how);
        selected.push(ScoredMotion::new(level, motion));
    }
    settings.refit(level, &mut selected, settings.model.rounds);
    let all: Vec<AffineMotion> = selected.iter().map(|scored| scored.motion).collect();
    if settings.least == 1 {
        prune(&mut selected, settings.price(level));
    }
    let cost = cost_of(&selected);
    let number = |motion: &AffineMotion| selected.iter().position(|scored| scored.motion == *motion);
    let numbers: Vec<u8> = all.iter().map(|motion| number(motion).unwrap_or(BACKGROUND) as u8).collect();
    labels.iter_mut().for_each(|label| *label = numbers[usize::from(*label)]);
    (Found { selected, runner_up: None }, cost)
}

/// Whether a motion from a single window would pay for itself beside those found. The first of these is the dominant one.
pub(super) fn is_missing(pair: &Pair, found: &Found, settings: &Settings) -> bool {
    let (base, level) = (&pair.levels[pair.base], &pair.levels[pair.selection]);
    let dominant = &found.selected[BACKGROUND].motion;
    let flow = local_flow(&pair.levels, dominant, pair.base);
    let proposals = from_tiles(base, dominant, &flow, settings.tiles);
    let (known, how) = (found.selected.len(), settings.deflation(level));
    let mut selected = found.selected.clone();
    add_motions(level, &mut selected, &proposals, Deflation { most: how.most.min(known + 1), ..how });
    selected.len() > known
}

/// The cost of motions.
pub(super) fn cost(pair: &Pair, motions: &[AffineMotion]) -> f64 {
    let level = &pair.levels[pair.selection];
    let scored: Vec<ScoredMotion> = motions.iter().map(|&motion| ScoredMotion::new(level, motion)).collect();
    cost_of(&scored)
}

fn cost_of(selected: &[ScoredMotion]) -> f64 {
    smallest_cost(selected).total()
}

/// Motions that were found at another size, scaled to this one. The first is the dominant one.
pub(super) fn known(pair: &Pair, motions: &[AffineMotion], runner_up: Option<AffineMotion>) -> Found {
    let level = &pair.levels[pair.selection];
    Found { selected: motions.iter().map(|&motion| ScoredMotion::new(level, motion)).collect(), runner_up }
}

/// The motions selected beside the dominant one.
pub(super) fn with_dominant(
    pair: &Pair,
    dominant: AffineMotion,
    others: &[AffineMotion],
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Found {
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
    observer.proposed(pair, &selected[0], &proposals, settings.deflation(level));
    let runner_up = add_motions(level, &mut selected, &proposals, settings.deflation(level));
    observer.selected(pair, &selected);
    settings.refit(level, &mut selected, settings.model.rounds);
    Found { selected, runner_up }
}

/// Refines the motions from the selection level up to the working size, adding motions that only show at finer levels.
pub(super) fn refine(pair: &Pair, found: Found, settings: &Settings) -> Found {
    let Found { mut selected, mut runner_up } = found;
    settings.refit(&pair.levels[pair.selection], &mut selected, settings.model.rounds);
    if settings.least == 1 {
        prune(&mut selected, settings.price(&pair.levels[pair.selection]));
    }
    for level in pair.levels[..pair.selection].iter().rev() {
        let level = &level.thinned();
        selected = selected.iter().map(|l| ScoredMotion::new(level, l.motion)).collect();
        let how = Deflation { tries: settings.model.tries_fast, ..settings.deflation(level) };
        let proposals = fine_proposals(level, &selected, settings.tiles);
        runner_up = add_motions(level, &mut selected, &proposals, how).or(runner_up);
        settings.refit(level, &mut selected, settings.model.rounds);
    }
    Found { selected, runner_up }
}
