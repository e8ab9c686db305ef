//! Whether the likelihood of junctions is right: how often two neighbouring motions of a real pair are of one thing.

use serde_json::{Value, json};
use veronese::{AffineMotion, Quality, SegmentOptions, Segmentation, segment_pair};

use crate::Failure;
use crate::cases::{Case, Data, Set};
use crate::parallel::in_parallel;
use crate::scores::VOID;

/// Lower edges of the ranges of likelihood.
const RANGES: [f64; 5] = [0.0, 0.1, 0.35, 0.8, 0.95];
/// A motion of which a share between these is in the mask is part of both, and no truth.
const MIXED: [f64; 2] = [0.25, 0.75];
const QUALITIES: [Quality; 2] = [Quality::Best, Quality::Fast];
/// Largest motion below which jumps are not compared with it, pixels; as in the pipeline.
const LEAST: f64 = 0.3;
/// Newton's steps of the fit.
const STEPS: usize = 20;

/// A junction whose truth is known.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    /// Whether its sequence is in the second fold.
    held_out: bool,
    /// Whether both motions are of the object or both are not.
    one_thing: bool,
    /// Whether they are in one group.
    grouped: bool,
    likelihood: f64,
    /// Jump of the flow as a share of the largest motion.
    jump: f64,
}

/// The junctions of all pairs of the sequences, with either quality.
pub(crate) fn measure(cases: &[Case]) -> Result<Vec<Known>, Failure> {
    let pairs: Vec<Case> = cases.iter().filter(|case| case.set == Set::Sequences).cloned().collect();
    let mut sequences: Vec<&str> = pairs.iter().map(Case::sequence).collect();
    sequences.dedup();
    let known = in_parallel(&pairs, |case| {
        let data = case.load().map_err(|error| error.to_string())?;
        let place = sequences.iter().position(|name| *name == case.sequence()).unwrap_or_default();
        let mut known = Vec::new();
        for quality in QUALITIES {
            let options = SegmentOptions::default().with_quality(quality);
            let found = segment_pair(&data.first, &data.second, &options, &mut |_| {})?;
            known.extend(of_result(&found, &data, place % 2 == 1));
        }
        Ok(known)
    })?;
    Ok(known.into_iter().flatten().collect())
}

fn of_result(found: &Segmentation, data: &Data, held_out: bool) -> Vec<Known> {
    let inside = shares_in_mask(found, data.truth.as_deref().unwrap_or_default());
    let mixed = |label: u8| (MIXED[0]..=MIXED[1]).contains(&inside[usize::from(label)]);
    let largest = largest_motion(found);
    let clear = found.junctions.iter().filter(|junction| !junction.labels.iter().any(|&label| mixed(label)));
    clear
        .map(|junction| {
            let [one, other] = junction.labels.map(usize::from);
            let jump = jump(found, [one, other]);
            Known {
                held_out,
                one_thing: (inside[one] > 0.5) == (inside[other] > 0.5),
                grouped: found.motions[one].group == found.motions[other].group,
                likelihood: junction.likelihood,
                jump: jump / largest.max(jump).max(LEAST),
            }
        })
        .collect()
}

/// The share of each motion's pixels that are in the mask.
fn shares_in_mask(found: &Segmentation, truth: &[u8]) -> Vec<f64> {
    let mut counts = vec![[0usize; 2]; found.count];
    for (&label, &truth) in found.labels.iter().zip(truth).filter(|(_, truth)| **truth != VOID) {
        counts[usize::from(label)][usize::from(truth != 0)] += 1;
    }
    counts.iter().map(|[outside, inside]| *inside as f64 / (outside + inside).max(1) as f64).collect()
}

/// Length of the difference of two motions at a pixel.
fn difference(one: &AffineMotion, other: &AffineMotion, p: usize, width: usize) -> f64 {
    let (x, y) = ((p % width) as f64, (p / width) as f64);
    let ([u, v], [r, s]) = (one.flow(x, y), other.flow(x, y));
    (u - r).hypot(v - s)
}

/// Median jump of the flow along the border of two labels, pixels.
fn jump(found: &Segmentation, [one, other]: [usize; 2]) -> f64 {
    let Segmentation { labels, motions, width, .. } = found;
    let meet = |p: usize, q: usize| {
        let pair = [usize::from(labels[p]), usize::from(labels[q])];
        pair == [one, other] || pair == [other, one]
    };
    let right = |p: usize| !(p + 1).is_multiple_of(*width) && meet(p, p + 1);
    let below = |p: usize| p + width < labels.len() && meet(p, p + width);
    let border = (0..labels.len()).filter(|&p| right(p) || below(p));
    let mut jumps: Vec<f64> =
        border.map(|p| difference(&motions[one].matrix, &motions[other].matrix, p, *width)).collect();
    jumps.sort_by(f64::total_cmp);
    jumps.get(jumps.len() / 2).copied().unwrap_or(0.0)
}

/// The largest motion against that with most pixels, root mean square over its pixels.
fn largest_motion(found: &Segmentation) -> f64 {
    let mut squares = vec![0.0; found.count];
    for (p, &label) in found.labels.iter().enumerate() {
        let label = usize::from(label);
        squares[label] += difference(&found.motions[label].matrix, &found.motions[0].matrix, p, found.width).powi(2);
    }
    squares.iter().zip(&found.motions).map(|(sum, motion)| (sum / motion.pixels as f64).sqrt()).fold(0.0, f64::max)
}

/// How good probabilities are.
#[derive(Clone, Copy, Debug)]
struct Goodness {
    /// Mean of −ln of the probability of what is true.
    log_loss: f64,
    /// Probability that of two junctions, one of each kind, the one that is one thing has the larger probability.
    auc: f64,
    /// Mean difference between probability and truth over the ranges.
    error: f64,
}

impl Goodness {
    fn of(known: &[Known], probability: &dyn Fn(&Known) -> f64) -> Goodness {
        let n = known.len().max(1) as f64;
        let of_truth = |one: &Known| if one.one_thing { probability(one) } else { 1.0 - probability(one) };
        let (mut larger, mut pairs) = (0.0, 0.0);
        for one in known.iter().filter(|one| one.one_thing) {
            for other in known.iter().filter(|other| !other.one_thing) {
                let by = probability(one) - probability(other);
                larger += if by > 0.0 { 1.0 } else { 0.5 * f64::from(u8::from(by == 0.0)) };
                pairs += 1.0;
            }
        }
        let excess = |k: usize| {
            let inside = known.iter().filter(|one| range(probability(one)) == k);
            inside.map(|one| probability(one) - f64::from(u8::from(one.one_thing))).sum::<f64>().abs()
        };
        Goodness {
            log_loss: -known.iter().map(|one| of_truth(one).max(1e-9).ln()).sum::<f64>() / n,
            auc: larger / pairs,
            error: (0..RANGES.len()).map(excess).sum::<f64>() / n,
        }
    }
}

/// The index of the range that a probability is in.
fn range(probability: f64) -> usize {
    RANGES.iter().filter(|&&edge| probability >= edge).count().max(1) - 1
}

/// The share of `known` that are one thing.
fn share(known: impl Iterator<Item = Known>) -> f64 {
    let (sum, count) =
        known.fold((0.0, 0.0), |(sum, count), one| (sum + f64::from(u8::from(one.one_thing)), count + 1.0));
    sum / count
}

/// Constant and weight of the jump in the log odds: a maximum likelihood fit, by Newton's method.
fn fit_jump(known: &[Known]) -> [f64; 2] {
    let [mut constant, mut weight] = [0.0; 2];
    for _ in 0..STEPS {
        let (mut gradient, mut curvature) = ([0.0; 2], [0.0; 3]);
        for one in known {
            let p = logistic(constant + weight * one.jump);
            let (miss, spread) = (f64::from(u8::from(one.one_thing)) - p, p * (1.0 - p));
            gradient = [gradient[0] + miss, gradient[1] + miss * one.jump];
            let [a, b, c] = curvature;
            curvature = [a + spread, b + spread * one.jump, c + spread * one.jump * one.jump];
        }
        let [a, b, c] = curvature;
        let determinant = a * c - b * b;
        constant += (c * gradient[0] - b * gradient[1]) / determinant;
        weight += (a * gradient[1] - b * gradient[0]) / determinant;
    }
    [constant, weight]
}

fn logistic(log_odds: f64) -> f64 {
    1.0 / (1.0 + (-log_odds).exp())
}

/// The held-out fold, and what each way to tell is worth there: its name and its figures.
fn compared(known: &[Known]) -> (Vec<Known>, Vec<(&'static str, Goodness)>) {
    let (held_out, fitted): (Vec<Known>, Vec<Known>) = known.iter().partition(|one| one.held_out);
    let [apart, grouped] =
        [false, true].map(|grouped| share(fitted.iter().copied().filter(|one| one.grouped == grouped)));
    let [constant, weight] = fit_jump(&fitted);
    let goodness = |probability: &dyn Fn(&Known) -> f64| Goodness::of(&held_out, probability);
    let rows = vec![
        ("groups alone", goodness(&|one| if one.grouped { grouped } else { apart })),
        ("jump alone", goodness(&|one| logistic(constant + weight * one.jump))),
        ("likelihood", goodness(&|one| one.likelihood)),
    ];
    (held_out, rows)
}

/// The figures as values for programs.
pub(crate) fn json(known: &[Known]) -> Value {
    let (held_out, rows) = compared(known);
    let figures = |(name, good): &(&str, Goodness)| json!({ "by": name, "logLoss": good.log_loss, "auc": good.auc, "error": good.error });
    json!({ "junctions": known.len(), "heldOut": held_out.len(), "by": rows.iter().map(figures).collect::<Vec<_>>() })
}
