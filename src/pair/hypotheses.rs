//! Two hypotheses about the background: it moves with the dominant motion, or it is at rest.
//!
//! The dominant motion explains more pixels than any other *single* motion. Ground without texture fits every motion, so the dominant
//! motion may be one that spans several objects although the camera is at rest. Where most pixels favour rest, both hypotheses are
//! therefore solved to the end, each with its own objects and change of brightness, and the one that describes the frames in fewer nats is
//! taken.

use super::dominant::{Dominant, Objects};
use super::frames::Pair;
use super::labels::{LabelledPair, Start, label};
use super::motions::{add_detail, follow, motions_of, refine, select};
use super::observer::Observer;
use super::settings::Settings;
use crate::estimation::selection::ScoredMotion;
use crate::frame::scaling::Scaling;
use crate::labelling::BACKGROUND;
use crate::motion::AffineMotion;
use crate::view::level::PairLevel;

/// Solves a pair under the hypothesis with the shorter description. `likely` are candidate motions of objects.
pub(super) fn solve(
    mut pair: Pair,
    likely: &[AffineMotion],
    settings: &Settings,
    observer: &mut dyn Observer,
) -> LabelledPair {
    let mut at_rest = pair.clone();
    observer.stage_begins("dominant");
    let dominant = pair.settle_dominant(Dominant::Sought(None), settings);
    let moving = under(pair, dominant, likely, settings, observer);
    let mut known = moving.motions.clone();
    if known[BACKGROUND] == AffineMotion::STATIC || settings.model.solves_at_rest == 0 {
        return moving;
    }
    let width = moving.pair.finest().width();
    let objects = Objects { motions: &known[BACKGROUND + 1..], labels: &moving.labels, width };
    if !rest_is_likely(&at_rest.sample_of_rest(&objects, settings), &known[BACKGROUND]) {
        return moving;
    }
    let rest = at_rest.settle_dominant(Dominant::Rest(&objects), settings);
    known.extend(likely);
    let at_rest = under(at_rest, rest, &known, settings, observer);
    // Lengths can be compared only if they assume the same noise.
    let noise = moving.pair.finest().noise.min(at_rest.pair.finest().noise);
    let [rest, motion] = [&at_rest, &moving].map(|labelled| labelled.length(noise));
    observer.chosen(usize::from(rest < motion));
    if rest < motion { at_rest } else { moving }
}

/// Solves a pair under one hypothesis.
fn under(
    pair: Pair,
    background: AffineMotion,
    likely: &[AffineMotion],
    settings: &Settings,
    observer: &mut dyn Observer,
) -> LabelledPair {
    let (mut selected, rejected) = select(&pair, background, likely, settings, observer);
    observer.stage_begins("refinement");
    let rejected = refine(&pair, &mut selected, settings).or(rejected);
    observer.refined(&pair, &selected);
    observer.stage_begins("labels");
    let labelled = label(pair, motions_of(&selected), rejected, Start::Costs, settings, observer);
    observer.labelled(&labelled.pair, &labelled.motions, &labelled.labels);
    labelled
}

/// Continues a search at the finer working size of `pair`: refines the motions, and solves the labels once.
pub(super) fn carry_on(
    found: LabelledPair,
    mut pair: Pair,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> LabelledPair {
    let scaling = Scaling::between(pair.scaling.small, found.pair.scaling.small);
    let scale = scaling.step as f64;
    let motions: Vec<AffineMotion> = found.motions.iter().map(|motion| motion.scaled(scale)).collect();
    observer.stage_begins("dominant");
    let dominant = pair.settle_dominant(Dominant::Known(&motions[BACKGROUND]), settings);
    observer.stage_begins("refinement");
    let mut labels = scaling.enlarged(&found.labels);
    let (mut motions, _) = follow(&pair, dominant, &motions[BACKGROUND + 1..], &mut labels, settings);
    let rejected =
        add_detail(&pair, &mut motions, settings).or_else(|| found.rejected.map(|motion| motion.scaled(scale)));
    observer.stage_begins("labels");
    let start = Start::Expected { labels, regroups: false };
    let labelled = label(pair, motions, rejected, start, settings, &mut ());
    observer.carried_on(&labelled.pair, &labelled.motions, &labelled.labels);
    labelled
}

/// Whether rest explains more pixels better than `motion` than it explains worse. Pixels are counted, and costs are not summed, because an
/// object that `motion` spans may cost so much more at rest that it outweighs the ground around it.
fn rest_is_likely(level: &PairLevel, motion: &AffineMotion) -> bool {
    let [rest, moving] = [AffineMotion::STATIC, *motion].map(|motion| ScoredMotion::new(level, motion).cost);
    let pixels = || rest.values().iter().zip(moving.values());
    pixels().filter(|(rest, moving)| rest < moving).count() >= pixels().filter(|(rest, moving)| rest > moving).count()
}
