//! The number of motions, by the [`score`](super::score) of the best fit for each n.

use super::estimator::Search;
use super::mixture::Mixture;

/// So many larger n without a better score end the search.
const PATIENCE: usize = 2;

/// The fit of the chosen number of motions, and all that were tried.
pub(crate) struct Selection {
    pub(crate) fit: Mixture,
    /// (number of motions, score), by increasing number.
    pub(crate) tried: Vec<(usize, f64)>,
}

/// Tries 1, 2, … up to `largest` motions. `hypotheses(n)` are motions worth trying at n.
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

/// What was found at the chosen n is in the pool now: perhaps one motion fewer explains the data as well after all.
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
