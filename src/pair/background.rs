//! What the background does: what the dominant motion says, or nothing.
//!
//! The dominant motion explains more pixels than any other *single* motion. Plain ground fits every motion, so that it may be one that
//! spans several objects although the camera is at rest. Where most pixels speak for rest, both hypotheses are therefore solved to the end, each
//! with objects and a change of brightness of its own, and the one that describes the frames in fewer nats is taken.

use super::hypothesis::{known, refine, with_dominant};
use super::labels::{Labelled, label};
use super::observer::Observer;
use super::settings::Settings;
use super::{Objects, Pair};
use crate::estimation::selection::ScoredMotion;
use crate::labelling::BACKGROUND;
use crate::motion::AffineMotion;
use crate::view::level::Level;

/// A pair whose change of brightness is removed, and its labels.
pub(super) struct Solved {
    pub(super) pair: Pair,
    pub(super) labelled: Labelled,
}

impl Solved {
    /// The search carried on at the working size of `pair`, from the motions that were found.
    pub(super) fn continued(self, mut pair: Pair, settings: &Settings, observer: &mut dyn Observer) -> Solved {
        let scale = self.pair.reduction / pair.reduction;
        let motions: Vec<AffineMotion> = self.labelled.motions.iter().map(|motion| motion.scaled(scale)).collect();
        let runner_up = self.labelled.runner_up.map(|motion| motion.scaled(scale));
        observer.stage_begins("dominant");
        pair.take_dominant(&motions[BACKGROUND], settings.brightness());
        observer.stage_begins("refinement");
        let found = refine(&pair, known(&pair, &motions, runner_up), settings);
        observer.stage_begins("labels");
        let labelled = label(&pair, found, settings, observer);
        observer.carried_on(&pair, &labelled.motions, &labelled.labels);
        Solved { pair, labelled }
    }
}

/// Solves a pair under the hypothesis with the shorter description. `likely` are motions of objects to look for.
pub(super) fn solve(
    mut pair: Pair,
    likely: &[AffineMotion],
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Solved {
    let mut at_rest = pair.clone();
    observer.stage_begins("dominant");
    let dominant = pair.find_dominant(None, settings.dominant_search());
    let moving = under(pair, dominant, likely, settings, observer);
    let mut known = moving.labelled.motions.clone();
    if known[BACKGROUND] == AffineMotion::STATIC {
        return moving;
    }
    let Solved { pair, labelled } = &moving;
    let width = pair.finest().width();
    let objects = Objects { motions: &known[BACKGROUND + 1..], labels: &labelled.labels, width };
    if !rest_is_likely(&at_rest.sample_of_rest(&objects, settings.brightness()), &known[BACKGROUND]) {
        return moving;
    }
    at_rest.take_rest(&objects, settings.brightness());
    known.extend(likely);
    let at_rest = under(at_rest, AffineMotion::STATIC, &known, settings, observer);
    // Lengths can be compared only if they assume the same noise.
    let noise = moving.pair.finest().noise.min(at_rest.pair.finest().noise);
    let [rest, motion] = [&at_rest, &moving].map(|solved| solved.labelled.length(solved.pair.finest(), noise));
    observer.chosen(usize::from(rest < motion));
    if rest < motion { at_rest } else { moving }
}

/// Solves a pair whose background is known.
fn under(
    pair: Pair,
    background: AffineMotion,
    likely: &[AffineMotion],
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Solved {
    let found = with_dominant(&pair, background, likely, settings, observer);
    observer.stage_begins("refinement");
    let found = refine(&pair, found, settings);
    observer.refined(&pair, &found.selected);
    observer.stage_begins("labels");
    let labelled = label(&pair, found, settings, observer);
    observer.labelled(&pair, &labelled.motions, &labelled.labels);
    Solved { pair, labelled }
}

/// Whether rest explains more pixels better than `motion` than it explains worse. Pixels are counted, because an object that `motion` spans
/// may be explained so much worse at rest that it outweighs the ground around it.
fn rest_is_likely(level: &Level, motion: &AffineMotion) -> bool {
    let [rest, moving] = [AffineMotion::STATIC, *motion].map(|motion| ScoredMotion::new(level, motion).cost);
    let pixels = || rest.values().iter().zip(moving.values());
    pixels().filter(|(rest, moving)| rest < moving).count() >= pixels().filter(|(rest, moving)| rest > moving).count()
}
