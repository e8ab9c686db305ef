//! Records what the stages of a pair find, in pixels of the full frame.

use super::{
    Background, CandidateMotion, CandidateSource, Grid, Labelling, MeasuredPixels, PairStages, SelectedMotion,
};
use crate::error::Result;
use crate::estimation::proposal::algebraic::{from_algebra, unexplained};
use crate::estimation::proposal::local_flow::{LocalFlow, samples};
use crate::estimation::proposal::tiles::from_tiles;
use crate::estimation::selection::greedy::RoughCosts;
use crate::estimation::selection::{GreedySelection, ScoredMotion, winners};
use crate::frame::{Derivatives, Frame, Plane};
use crate::labelling::regions::description::counts;
use crate::lanes::each_with;
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::options::SegmentOptions;
use crate::pair::frames::Pair;
use crate::pair::observer::Observer;
use crate::pair::segment_observed;
use crate::pair::settings::Settings;
use crate::view::level::PairLevel;

/// [`segment_pair`](crate::segment_pair) with what its stages found: the same pipeline with an observer.
///
/// # Errors
/// As [`segment_pair`](crate::segment_pair).
pub fn segment_pair_stages(first: &Frame, second: &Frame, options: &SegmentOptions) -> Result<PairStages> {
    let mut recorder = Recorder::default();
    let result = segment_observed([first, second], options, &Model::DEFAULT, &mut recorder)?;
    let groups = 1 + result.motions.iter().map(|motion| motion.group).max().unwrap_or(0);
    let of_group = |group| result.motions.iter().filter(move |motion| motion.group == group).map(|motion| motion.label);
    Ok(PairStages {
        hypotheses: recorder.hypotheses,
        chosen: recorder.chosen,
        detail: recorder.detail,
        working: recorder.working,
        groups: (0..groups).map(|group| of_group(group).collect()).collect(),
        result,
    })
}

/// Everything that was found of a pair.
#[derive(Default)]
struct Recorder {
    hypotheses: Vec<Background>,
    chosen: usize,
    detail: Option<Labelling>,
    working: Labelling,
    /// The newest labels of the draft level.
    draft: Labelling,
}

impl Observer for Recorder {
    fn dominant_found(&mut self, pair: &Pair, dominant: AffineMotion, flow: &LocalFlow, settings: &Settings) {
        let level = &pair.levels[pair.base];
        let scale = level.pixel() * (pair.scaling.step as f64);
        let none = Plane::filled(level.width(), level.height(), 0.0);
        let local = samples(level, &dominant, &flow.u, &flow.v);
        let mut temporal = local.residual;
        each_with(temporal.values_mut(), [local.gx.values(), flow.u.values()], |t, [g, d]| t - g * d);
        each_with(temporal.values_mut(), [local.gy.values(), flow.v.values()], |t, [g, d]| t - g * d);
        let mut local_flow = [flow.u.clone(), flow.v.clone()];
        local_flow.iter_mut().flat_map(|plane| plane.values_mut()).for_each(|flow| *flow *= scale as f32);
        self.hypotheses.push(Background {
            dominant: dominant.scaled(pair.scaling.step as f64),
            base: grid(pair, level),
            noise: f64::from(level.noise),
            residual: samples(level, &dominant, &none, &none).residual,
            derivatives: Derivatives { x: local.gx, y: local.gy, t: temporal },
            local_flow,
            measured: measured(level, &dominant, flow, settings, scale),
            candidates: candidates(level, &dominant, flow, settings, pair.scaling.step as f64),
            penalty: 0.0,
            selected: Vec::new(),
            selection: Labelling::default(),
            refined: Vec::new(),
            refinement: Labelling::default(),
            draft: Labelling::default(),
            labelling: Labelling::default(),
        });
    }

    /// Scores the candidates. Those that the hypothesis did not begin with were known before.
    fn proposed(&mut self, pair: &Pair, dominant: &ScoredMotion, proposals: &[AffineMotion], how: GreedySelection) {
        let Some(hypothesis) = self.hypotheses.last_mut() else { return };
        hypothesis.penalty = how.penalty;
        let candidates = &mut hypothesis.candidates;
        let known = proposals.iter().skip(candidates.len());
        let known = known.map(|motion| candidate(motion, CandidateSource::Hypothesis, pair.scaling.step as f64));
        candidates.extend(known.collect::<Vec<_>>());
        let level = &pair.levels[pair.selection];
        let rough = RoughCosts::new(&level.thinned(), level.thinning(), proposals);
        let gains = rough.gains(&dominant.cost, how.window, level.model);
        for ((candidate, motion), gain) in candidates.iter_mut().zip(proposals).zip(gains) {
            debug_assert_eq!(candidate.matrix, motion.scaled(pair.scaling.step as f64));
            let both = [dominant.clone(), ScoredMotion::new(level, *motion)];
            candidate.gain = gain;
            candidate.support = shares(&cheapest(&both), 2)[1];
        }
    }

    fn selected(&mut self, pair: &Pair, selected: &[ScoredMotion]) {
        let Some(hypothesis) = self.hypotheses.last_mut() else { return };
        (hypothesis.selected, hypothesis.selection) = (supported(pair, selected), cheapest_labels(pair, selected));
    }

    fn refined(&mut self, pair: &Pair, refined: &[ScoredMotion]) {
        let Some(hypothesis) = self.hypotheses.last_mut() else { return };
        (hypothesis.refined, hypothesis.refinement) = (supported(pair, refined), cheapest_labels(pair, refined));
    }

    fn regrouped(&mut self, pair: &Pair, motions: &[AffineMotion], labels: &[u8]) {
        self.draft = labelling(pair, &pair.levels[pair.draft], motions, labels);
    }

    fn labelled(&mut self, pair: &Pair, motions: &[AffineMotion], labels: &[u8]) {
        let Some(hypothesis) = self.hypotheses.last_mut() else { return };
        hypothesis.draft = std::mem::take(&mut self.draft);
        hypothesis.labelling = labelling(pair, pair.finest(), motions, labels);
    }

    fn chosen(&mut self, hypothesis: usize) {
        self.chosen = hypothesis;
    }

    fn carried_on(&mut self, pair: &Pair, motions: &[AffineMotion], labels: &[u8]) {
        self.detail = Some(labelling(pair, pair.finest(), motions, labels));
    }

    fn finished(&mut self, pair: &Pair, motions: &[AffineMotion], labels: &[u8]) {
        self.working = labelling(pair, pair.finest(), motions, labels);
    }
}

/// The measurements of the multibody constraint; `scale` is that of the level.
fn measured(
    level: &PairLevel,
    dominant: &AffineMotion,
    flow: &LocalFlow,
    settings: &Settings,
    scale: f64,
) -> Option<MeasuredPixels> {
    let found = unexplained(level, dominant, flow, settings.measurements)?;
    let half = 0.5 * level.width() as f64;
    let place = |&[x, y]: &[f64; 2]| [(x + 1.0) * half, y * half + 0.5 * level.height() as f64];
    Some(MeasuredPixels {
        places: found.measurements.positions().iter().map(|at| place(at).map(|side| side.round() * scale)).collect(),
        measurements: found.measurements,
        weights: found.weights,
        unit: level.model.algebra_unit * scale,
    })
}

/// The motions that a level proposes.
fn candidates(
    level: &PairLevel,
    dominant: &AffineMotion,
    flow: &LocalFlow,
    settings: &Settings,
    reduction: f64,
) -> Vec<CandidateMotion> {
    let mut candidates = Vec::new();
    for degree in 1..=settings.degrees {
        // Those of lower degrees come first.
        let all = from_algebra(level, dominant, flow, degree, settings.measurements);
        let new = all.iter().skip(candidates.len());
        candidates.extend(new.map(|motion| candidate(motion, CandidateSource::Constraint(degree), reduction)));
    }
    let windows = from_tiles(level, dominant, flow, settings.tiles);
    candidates.extend(windows.iter().map(|motion| candidate(motion, CandidateSource::Window, reduction)));
    candidates
}

/// A candidate that is not yet scored.
fn candidate(motion: &AffineMotion, source: CandidateSource, reduction: f64) -> CandidateMotion {
    CandidateMotion { matrix: motion.scaled(reduction), source, gain: 0.0, support: 0.0 }
}

/// The cheapest motion of each pixel on the selection level, without regard to its neighbours.
fn cheapest_labels(pair: &Pair, scored: &[ScoredMotion]) -> Labelling {
    let level = &pair.levels[pair.selection];
    let motions: Vec<AffineMotion> = scored.iter().map(|one| one.motion).collect();
    // Costs of a refinement may be those of a finer level, some of whose pixels are left out.
    let scored: Vec<ScoredMotion> = motions.iter().map(|&motion| ScoredMotion::new(level, motion)).collect();
    labelling(pair, level, &motions, &cheapest(&scored))
}

fn labelling(pair: &Pair, level: &PairLevel, motions: &[AffineMotion], labels: &[u8]) -> Labelling {
    let motions = motions.iter().map(|motion| motion.scaled(pair.scaling.step as f64)).collect();
    Labelling { grid: grid(pair, level), motions, labels: labels.to_vec() }
}

fn grid(pair: &Pair, level: &PairLevel) -> Grid {
    Grid { width: level.width(), height: level.height(), scale: level.pixel() * (pair.scaling.step as f64) }
}

/// Motions with the share of the pixels at which each is cheapest.
fn supported(pair: &Pair, scored: &[ScoredMotion]) -> Vec<SelectedMotion> {
    let motion = |(scored, support): (&ScoredMotion, f64)| SelectedMotion {
        matrix: scored.motion.scaled(pair.scaling.step as f64),
        support,
    };
    scored.iter().zip(shares(&cheapest(scored), scored.len())).map(motion).collect()
}

/// The share of the pixels that each of `of` labels has.
fn shares(labels: &[u8], of: usize) -> Vec<f64> {
    counts(labels, of).into_iter().map(|count| count as f64 / labels.len().max(1) as f64).collect()
}

/// The label of the motion that is cheapest at each pixel.
fn cheapest(scored: &[ScoredMotion]) -> Vec<u8> {
    winners(scored).into_iter().map(|k| k as u8).collect()
}
