//! Selection of the number of motions by the [`score`](super::score) of the best fit for each n.

use super::estimator::Search;
use super::mixture::Mixture;

/// The search ends after this many larger n without a better score.
const PATIENCE: usize = 2;

/// The fit of the selected number of motions, and the scores of all numbers tried.
pub(crate) struct Selection {
    pub(crate) fit: Mixture,
    /// (number of motions, score), by increasing number.
    pub(crate) tried: Vec<(usize, f64)>,
}

/// Tries n = 1, 2, … up to `largest`. `hypotheses(n)` are motions to start from.
pub(crate) fn select(
    search: &mut Search<'_>,
    largest: usize,
    mut hypotheses: impl FnMut(usize) -> Vec<[f64; 6]>,
) -> Selection {
    let mut fit = search.fit(1, &hypotheses(1), f64::INFINITY);
    let mut tried = vec![(1, search.score(&fit))];
    let mut best = tried[0].1;
    for n in 2..=largest {
        let candidate = search.fit(n, &hypotheses(n), best);
        let score = search.score(&candidate);
        tried.push((n, score));
        if score < best {
            (fit, best) = (candidate, score);
        } else if n >= fit.motions.len() + PATIENCE {
            break;
        }
    }
    reconsider(search, &mut fit, &mut tried);
    Selection { fit, tried }
}

/// Tries smaller n again, now that the pool contains the motions found for the selected n.
fn reconsider(search: &mut Search<'_>, fit: &mut Mixture, tried: &mut [(usize, f64)]) {
    while fit.motions.len() > 1 {
        let n = fit.motions.len() - 1;
        let kept = tried[n].1;
        let smaller = search.fit(n, &[], kept);
        let score = search.score(&smaller);
        tried[n - 1].1 = tried[n - 1].1.min(score);
        if score >= kept {
            break;
        }
        *fit = smaller;
    }
}
