//! What is noted of a pair while it is solved, in the words of [`Recording`].

use super::Pair;
use super::hypothesis::Found;
use super::labels::Labelled;
use super::settings::Settings;
use crate::estimation::proposal::algebraic::{self, from_algebra};
use crate::estimation::proposal::local_flow::{LocalFlow, samples};
use crate::estimation::proposal::tiles::from_tiles;
use crate::estimation::selection::{Deflation, ScoredMotion, rough_gains};
use crate::frame::Plane;
use crate::lanes::each_with;
use crate::motion::AffineMotion;
use crate::recording::{Hypothesis, Labels, Proposed, Recording, Seen, Source, Supported};
use crate::view::level::Level;

/// Begins a hypothesis: the base level along its dominant motion, and where its proposals will come from.
pub(super) fn seen(
    recording: &mut Recording,
    pair: &Pair,
    dominant: AffineMotion,
    flow: &LocalFlow,
    settings: &Settings,
) {
    let level = &pair.levels[pair.base];
    let none = Plane::filled(level.width(), level.height(), 0.0);
    let residual = samples(level, &dominant, &none, &none).residual;
    let local = samples(level, &dominant, &flow.u, &flow.v);
    let mut temporal = local.residual;
    each_with(temporal.values_mut(), [local.gx.values(), flow.u.values()], |t, [g, d]| t - g * d);
    each_with(temporal.values_mut(), [local.gy.values(), flow.v.values()], |t, [g, d]| t - g * d);
    let mut proposals = Vec::new();
    for degree in 1..=settings.degrees {
        // Those of lower degrees come first.
        let all = from_algebra(level, &dominant, flow, degree, settings.measurements);
        let new = all.into_iter().skip(proposals.len());
        proposals.extend(new.map(|motion| without_score(motion, Source::Constraint(degree))));
    }
    let windows = from_tiles(level, &dominant, flow, settings.tiles);
    proposals.extend(windows.into_iter().map(|motion| without_score(motion, Source::Window)));
    recording.hypotheses.push(Hypothesis {
        dominant,
        reduction: pair.reduction,
        seen: Seen {
            pixel: level.pixel(),
            noise: level.noise,
            residual,
            derivatives: [local.gx, local.gy, temporal],
            flow: [flow.u.clone(), flow.v.clone()],
        },
        measured: algebraic::recorded(level, &dominant, flow, settings.measurements),
        proposals,
        ..Hypothesis::default()
    });
}

fn without_score(motion: AffineMotion, source: Source) -> Proposed {
    Proposed { motion, source, gain: 0.0, support: 0.0 }
}

/// Scores the proposals. Those that the hypothesis did not begin with were known before.
pub(super) fn proposed(
    recording: &mut Recording,
    level: &Level,
    dominant: &[ScoredMotion],
    proposals: &[AffineMotion],
    how: Deflation,
) {
    let Some(hypothesis) = recording.hypotheses.last_mut() else { return };
    hypothesis.price = how.price;
    let known = proposals.iter().skip(hypothesis.proposals.len()).map(|&motion| without_score(motion, Source::Known));
    let known: Vec<Proposed> = known.collect();
    hypothesis.proposals.extend(known);
    let gains = rough_gains(level, dominant, proposals, how);
    for ((proposed, motion), gain) in hypothesis.proposals.iter_mut().zip(proposals).zip(gains) {
        debug_assert_eq!(proposed.motion, *motion);
        let both = [dominant[0].clone(), ScoredMotion::new(level, *motion)];
        proposed.gain = gain;
        proposed.support = supported(&both)[1].support;
    }
}

/// Notes the motions after greedy selection.
pub(super) fn selected(recording: &mut Recording, pair: &Pair, selected: &[ScoredMotion]) {
    let Some(hypothesis) = recording.hypotheses.last_mut() else { return };
    hypothesis.selected = supported(selected);
    hypothesis.selection = cheapest_labels(pair, selected);
}

/// Notes the motions after refinement.
pub(super) fn refined(recording: &mut Recording, pair: &Pair, found: &Found) {
    let Some(hypothesis) = recording.hypotheses.last_mut() else { return };
    hypothesis.refined = supported(&found.selected);
    hypothesis.refinement = cheapest_labels(pair, &found.selected);
}

/// The cheapest motion of each pixel, on the selection level: what single pixels say before any asks its neighbours.
fn cheapest_labels(pair: &Pair, scored: &[ScoredMotion]) -> Labels {
    let level = &pair.levels[pair.selection];
    let motions: Vec<AffineMotion> = scored.iter().map(|one| one.motion).collect();
    // Costs of a refinement may be those of a finer level, some of whose pixels are left out.
    let scored: Vec<ScoredMotion> = motions.iter().map(|&motion| ScoredMotion::new(level, motion)).collect();
    labels(pair, level, &motions, &cheapest(&scored))
}

/// Notes the labels of a hypothesis.
pub(super) fn solved(recording: &mut Recording, pair: &Pair, labelled: &Labelled) {
    let Some(hypothesis) = recording.hypotheses.last_mut() else { return };
    hypothesis.draft = labelled.draft.clone();
    hypothesis.labels = self::labelled(pair, labelled);
}

/// Labels of the working size.
pub(super) fn labelled(pair: &Pair, labelled: &Labelled) -> Labels {
    labels(pair, pair.finest(), &labelled.motions, &labelled.labels)
}

/// Labels of a level.
pub(super) fn labels(pair: &Pair, level: &Level, motions: &[AffineMotion], labels: &[u8]) -> Labels {
    Labels {
        size: [level.width(), level.height()],
        scale: level.pixel() * pair.reduction,
        reduction: pair.reduction,
        motions: motions.to_vec(),
        labels: labels.to_vec(),
    }
}

/// The share of the pixels at which each motion is cheapest; ties go to the first.
fn supported(scored: &[ScoredMotion]) -> Vec<Supported> {
    let cheapest = cheapest(scored);
    let mut counts = vec![0_usize; scored.len()];
    cheapest.iter().for_each(|&k| counts[usize::from(k)] += 1);
    let share = |count: usize| count as f64 / cheapest.len().max(1) as f64;
    let supported =
        |(scored, count): (&ScoredMotion, usize)| Supported { motion: scored.motion, support: share(count) };
    scored.iter().zip(counts).map(supported).collect()
}

/// The index of the motion that is cheapest at each pixel; ties go to the first.
fn cheapest(scored: &[ScoredMotion]) -> Vec<u8> {
    let cost = |k: u8, p: usize| scored[usize::from(k)].cost.values()[p];
    let least = |p| (1..scored.len() as u8).fold(0, |least, k| if cost(k, p) < cost(least, p) { k } else { least });
    (0..scored[0].cost.values().len()).map(least).collect()
}
