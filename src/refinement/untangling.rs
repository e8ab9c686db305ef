//! Restarts of pairs of motions that are close to each other.
//!
//! If two motions differ by only a few σ, the likelihood of all n motions has many local maxima, which divide the measurements of the two
//! differently. Restarting the two on their own measurements, from both sides of their mean, is cheap and finds a better maximum.

use super::estimator::Search;
use super::mixture::{Mixture, Stop, nearest_distances};
use super::samples::Samples;
use crate::order::median_f64;

/// A pair is close if at least half of its measurements are within this many σ of both motions.
const CLOSE_SIGMAS: f64 = 8.0;
/// Number of restarts of a pair.
const TRIES: usize = 8;
/// Standard deviation of the offset of a restarted motion from the mean, per entry, in units of σ; used in turn.
const SPREADS: [f64; 4] = [1.0, 2.0, 4.0, 8.0];
/// Initial σ of a restart, in units of the σ of the fit.
const WIDER: f64 = 2.0;
/// Smallest significant gain in log-likelihood.
const GAIN: f64 = 0.1;
const STOP: Stop = Stop { iterations: 40, gain: 1e-6, step: 1e-4 };

impl Search<'_> {
    /// Restarts close pairs until one makes the whole fit more likely. Returns whether one did.
    pub(super) fn untangle(&mut self, best: &mut Mixture) -> bool {
        let labels = best.labels(&self.sample);
        for i in 0..best.motions.len() {
            for k in i + 1..best.motions.len() {
                let Some(own) = self.labelled(&labels, &[i, k]) else { continue };
                let pair = [best.motions[i], best.motions[k]];
                if farther_distance(&own, &pair) > CLOSE_SIGMAS * best.sigma {
                    continue;
                }
                let mut motions = best.motions.clone();
                [motions[i], motions[k]] = self.restart(&own, pair, best.sigma);
                let candidate = self.buffers.maximise(&self.sample, Mixture::new(motions, best.sigma), STOP);
                if candidate.log_likelihood > best.log_likelihood + GAIN {
                    *best = candidate;
                    return true;
                }
            }
        }
        false
    }

    /// The most likely two motions found in the measurements of a pair.
    fn restart(&mut self, own: &Samples, pair: [[f64; 6]; 2], sigma: f64) -> [[f64; 6]; 2] {
        let mut best = self.buffers.maximise(own, Mixture::new(pair.to_vec(), sigma), STOP);
        for spread in SPREADS.iter().cycle().take(TRIES) {
            let offset: [f64; 6] = std::array::from_fn(|_| spread * sigma * self.random.normal());
            let side = |sign: f64| std::array::from_fn(|e| 0.5 * (pair[0][e] + pair[1][e]) + sign * offset[e]);
            let start = Mixture::new(vec![side(1.0), side(-1.0)], WIDER * sigma);
            let found = self.buffers.maximise(own, start, STOP);
            if found.log_likelihood > best.log_likelihood {
                best = found;
            }
        }
        [best.motions[0], best.motions[1]]
    }
}

/// Median over the measurements of the larger of the distances from the two motions.
fn farther_distance(own: &Samples, pair: &[[f64; 6]; 2]) -> f64 {
    let mut first = nearest_distances(own, &pair[..1]);
    let second = nearest_distances(own, &pair[1..]);
    first.iter_mut().zip(&second).for_each(|(a, &b)| *a = a.max(b));
    median_f64(&first).unwrap_or(0.0)
}
