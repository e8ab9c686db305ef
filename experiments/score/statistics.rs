//! Means and their intervals. Cases of one sequence are alike, so that whole sequences are drawn.

use serde::Serialize;
use veronese::Random;

/// Draws of the bootstrap (Efron 1979).
const DRAWS: usize = 10_000;
const SEED: u64 = 1;
/// Share of the draws outside of the interval, half of it on either side.
const OUTSIDE: f64 = 0.05;
/// With fewer sequences than this there is no interval: a bootstrap would mean little.
const LEAST_SEQUENCES: usize = 5;

/// A mean, and where it lies in 95 % of the draws.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    pub cases: usize,
    pub mean: f64,
    pub interval: Option<[f64; 2]>,
}

/// The mean of values, each with its sequence; those of one sequence stand together. None of no values.
pub fn estimate(values: &[(&str, f64)]) -> Option<Estimate> {
    let sequences: Vec<(f64, usize)> = values
        .chunk_by(|(one, _), (other, _)| one == other)
        .map(|list| (list.iter().map(|(_, value)| value).sum(), list.len()))
        .collect();
    let mean = |of: &mut dyn Iterator<Item = (f64, usize)>| {
        let (sum, count) = of.fold((0.0, 0), |(sum, count), (s, c)| (sum + s, count + c));
        sum / count as f64
    };
    if sequences.is_empty() {
        return None;
    }
    let interval = (sequences.len() >= LEAST_SEQUENCES).then(|| {
        let mut random = Random::from_seed(SEED);
        let mut draw = || mean(&mut (0..sequences.len()).map(|_| sequences[random.below(sequences.len())]));
        let mut means: Vec<f64> = (0..DRAWS).map(|_| draw()).collect();
        means.sort_by(f64::total_cmp);
        let outside = (0.5 * OUTSIDE * DRAWS as f64) as usize;
        [means[outside], means[DRAWS - 1 - outside]]
    });
    Some(Estimate { cases: values.len(), mean: mean(&mut sequences.iter().copied()), interval })
}

/// How a figure has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It is the same in every case.
    Same,
    Rose,
    Fell,
    /// The interval contains 0, or there are too few sequences for one.
    Unclear,
}

/// The mean change of a figure, each change with its sequence, and the verdict.
pub fn verdict(changes: &[(&str, f64)]) -> Option<(Estimate, Verdict)> {
    let change = estimate(changes)?;
    let verdict = match change.interval {
        _ if changes.iter().all(|(_, change)| *change == 0.0) => Verdict::Same,
        Some([low, _]) if low > 0.0 => Verdict::Rose,
        Some([_, high]) if high < 0.0 => Verdict::Fell,
        _ => Verdict::Unclear,
    };
    Some((change, verdict))
}
