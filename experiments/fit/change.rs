//! Means over sequences, and mean changes with their standard errors.

use crate::measure::{Loaded, Part, Scored};

/// A mean over the cases of a part and its standard error over the sequences: pairs of one sequence are alike.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mean {
    pub(crate) mean: f64,
    pub(crate) error: f64,
}

/// The mean of a figure of the cases of a part.
pub(crate) fn mean(cases: &[Loaded], part: Part, figure: impl Fn(usize) -> f64) -> Mean {
    let mut sequences: Vec<(&str, f64, f64)> = Vec::new();
    for (k, case) in cases.iter().enumerate().filter(|(_, case)| case.part == part) {
        match sequences.iter_mut().find(|(name, ..)| *name == case.sequence) {
            Some((_, sum, count)) => (*sum, *count) = (*sum + figure(k), *count + 1.0),
            None => sequences.push((&case.sequence, figure(k), 1.0)),
        }
    }
    let (cases, n) = (sequences.iter().map(|(.., count)| count).sum::<f64>(), sequences.len() as f64);
    let mean = sequences.iter().map(|(_, sum, _)| sum).sum::<f64>() / cases;
    // Of a ratio of sums: sequences have different numbers of pairs.
    let squares: f64 = sequences.iter().map(|(_, sum, count)| (sum - mean * count) * (sum - mean * count)).sum();
    Mean { mean, error: (squares * n / (n - 1.0)).sqrt() / cases }
}

/// What the search maximises, of one case: the masks of single motions and of groups count alike.
pub(crate) fn value(part: Part, scored: &Scored) -> f64 {
    if part.is_fold() { 0.5 * (scored.j + scored.hand) } else { scored.j }
}

/// The change of the objective, the sum of the means of these parts, between two models.
pub(crate) fn change(cases: &[Loaded], parts: &[Part], before: &[Scored], after: &[Scored]) -> Mean {
    let of = |part: Part| mean(cases, part, |k| value(part, &after[k]) - value(part, &before[k]));
    parts.iter().map(|&part| of(part)).fold(Mean { mean: 0.0, error: 0.0 }, |sum, one| Mean {
        mean: sum.mean + one.mean,
        error: sum.error.hypot(one.error),
    })
}
