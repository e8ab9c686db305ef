//! Global search for the n motions of maximum likelihood: many starts fill a pool of motions, from which the best n are selected.
//!
//! Expectation-maximisation (EM) finds a local maximum, so the result depends on its starting point. Each round of the search
//! 1. adds motions to the pool: over-complete EM (six times as many motions as wanted, random, with a large σ) in every second round;
//!    the same on the measurements that the best fit does not explain without its weakest motion; and EM with several motions on the
//!    measurements of each motion, in case it covers two;
//! 2. selects the n motions of the pool that explain the measurements best ([`subset::choose`]), for two caps of the distance;
//! 3. runs EM from this selection, and keeps the result if it is more likely than the best so far.
//!
//! The search ends after one round without gain, or three if there are outliers. Then pairs of close motions are restarted
//! ([`Search::untangle`](super::untangling)), and the best fit is refined on all measurements.
//!
//! On the paper's experiment (general motions, n = 2…5, up to 30 % outliers, one motion with 5 % of the measurements), the search reaches
//! the maximum that EM reaches from the true motions. **Pitfalls**, found by measurement: an initial σ of 0.05 or 0.15 freezes the random
//! assignment. Unless the weakest motion is removed, a wrong motion hides half of the measurements of a small motion that is missing.
//! The initial σ of EM must be that of the *worst* selected motion, otherwise the exact motions of noise-free data freeze the others.

use super::mixture::{EmBuffers, Mixture, Normal, Stop, nearest_distances, own_distances};
use super::samples::Samples;
use super::score::score;
use super::subset;
use crate::order::{median_f64, sort_few};
use crate::random::Random;

/// Largest number of measurements used by the search. The final maximisation uses all.
const SEARCHED: usize = 1000;
/// Standard deviation of the entries of random motions, in units of the typical normal flow.
const SEED_SCALE: f64 = 1.2;
/// Random motions per wanted motion, on all measurements.
const OVER_COMPLETE: usize = 6;
/// The same on unexplained measurements.
const UNEXPLAINED: usize = 6;
/// The same on unexplained measurements if outliers hide the missing motion.
const UNEXPLAINED_AMONG_OUTLIERS: usize = 10;
/// Random motions on the measurements of one motion.
const SPLIT: usize = 4;
/// Initial σ of random motions. This and the next two are in units of the root mean square length of the derivatives.
const WIDE: f64 = 0.3;
/// Initial σ when one motion is split.
const SPLIT_WIDE: f64 = 0.1;
/// Largest initial σ of a selection from the pool.
const CHOICE_WIDE: f64 = 0.1;
/// Cap of distances in the first selection, in units of the best fit's σ.
const CAP_SIGMAS: f64 = 4.0;
/// Cap of distances in the second selection.
const CAP: f64 = 0.1;
/// A measurement is unexplained if its distance from every motion exceeds this many σ.
const EXPLAINED_SIGMAS: f64 = 2.5;
/// Smallest number of measurements to search in.
pub(super) const FEWEST: usize = 12;
/// Smallest significant gain in log-likelihood.
const GAIN: f64 = 0.5;
/// Maximum number of rounds.
const ROUNDS: usize = 24;
/// Number of rounds without gain that ends the search if the share of outliers is at least [`CLEAN`].
const STALE: usize = 3;
/// The same for fewer outliers.
const STALE_CLEAN: usize = 1;
const CLEAN: f64 = 0.02;
/// Maximum number of times that close pairs are restarted.
const UNTANGLINGS: usize = 3;
/// Close pairs are not restarted if the score exceeds that of a rival by this much. Restarting lowers it by at most 24 (measured).
const HOPELESS: f64 = 40.0;
/// Motions with a larger absolute entry have diverged and are removed from the pool.
const LARGEST: f64 = 1e3;

const SEARCH: Stop = Stop { iterations: 15, gain: 1e-6, step: 1e-4 };
const REFINE: Stop = Stop { iterations: 25, gain: 1e-6, step: 1e-4 };
const POLISH: Stop = Stop { iterations: 60, gain: 1e-9, step: 1e-7 };

/// A search for motions in a set of measurements. Its pool is kept from one n to the next.
pub(crate) struct Search<'a> {
    all: &'a Samples,
    pub(super) sample: Samples,
    pub(super) random: Random,
    /// Standard deviation of the entries of random motions.
    pub(super) scale: f64,
    pool: Vec<[f64; 6]>,
    pub(super) buffers: EmBuffers,
}

impl<'a> Search<'a> {
    /// A search in normalised measurements.
    pub(crate) fn new(all: &'a Samples, seed: u64) -> Self {
        let mut random = Random::from_seed(seed);
        let sample =
            if all.len() > SEARCHED { all.subset(random.choose(all.len(), SEARCHED).into_iter()) } else { all.clone() };
        // The constant keeps the random motions of motionless data different from zero.
        let scale = SEED_SCALE * sample.typical_flow() + 1e-12;
        Search { all, sample, random, scale, pool: Vec::new(), buffers: EmBuffers::default() }
    }

    /// Updates the likelihood of a fit on all measurements; returns the normal equations of its motions.
    pub(crate) fn evaluate(&mut self, fit: &mut Mixture) -> Vec<Normal> {
        self.buffers.evaluate(self.all, fit)
    }

    /// The score of a fit on all measurements; smaller is better.
    pub(crate) fn score(&mut self, fit: &Mixture) -> f64 {
        score(self.all, self.scale, &mut self.buffers, fit)
    }

    /// The fit of n motions, on all measurements. `hypotheses` are motions to start from, possibly none. `rival` is the best score of
    /// another n: if this n is hopeless in comparison, close pairs are not restarted.
    pub(crate) fn fit(&mut self, n: usize, hypotheses: &[[f64; 6]], rival: f64) -> Mixture {
        let mut best = self.start(n, hypotheses);
        let mut stale = 0;
        for round in 1..=ROUNDS {
            let gained = self.round(n, round, &mut best);
            stale = if gained { 0 } else { stale + 1 };
            let enough = if best.outliers < CLEAN { STALE_CLEAN } else { STALE };
            if stale >= enough {
                break;
            }
        }
        if rival == f64::INFINITY || self.score(&best) < rival + HOPELESS {
            for _ in 0..UNTANGLINGS {
                if !self.untangle(&mut best) {
                    break;
                }
            }
        }
        let start = Mixture::new(best.motions, best.sigma);
        self.buffers.maximise(self.all, start, POLISH)
    }

    /// The first fit: from the hypotheses if there are enough, otherwise from random motions.
    fn start(&mut self, n: usize, hypotheses: &[[f64; 6]]) -> Mixture {
        let known = self.pool.len();
        self.pool.extend(hypotheses.iter().filter(|a| is_usable(a)));
        let enough = self.pool.len() >= known + n;
        if !enough {
            self.search_everywhere(n);
        }
        let mut best = Mixture::new(vec![[0.0; 6]; n], WIDE);
        self.choose_and_refine(n, &mut best);
        if enough {
            // The selected hypotheses are in the best fit. The others would only slow down every later selection.
            self.pool.truncate(known);
        }
        best
    }

    /// One round: more motions for the pool, then a selection from it. Returns whether the likelihood has increased.
    fn round(&mut self, n: usize, round: usize, best: &mut Mixture) -> bool {
        if round.is_multiple_of(2) {
            self.search_everywhere(n);
        }
        self.search_the_unexplained(n, best);
        self.split_motions(best);
        self.pool.extend_from_slice(&best.motions);
        self.pool.retain(is_usable);
        self.choose_and_refine(n, best)
    }

    fn search_everywhere(&mut self, n: usize) {
        let seeds = self.seeds(OVER_COMPLETE * n, &[0.0; 6], self.scale);
        let found = self.buffers.maximise(&self.sample, Mixture::new(seeds, WIDE), SEARCH);
        self.pool.extend(found.motions);
    }

    /// Over-complete search in the measurements that the best fit does not explain without its weakest motion.
    fn search_the_unexplained(&mut self, n: usize, best: &Mixture) {
        let weakest = (0..n).min_by(|&a, &b| best.shares[a].total_cmp(&best.shares[b]));
        let mut kept = best.motions.clone();
        if let Some(weakest) = weakest {
            kept.remove(weakest);
        }
        let near = nearest_distances(&self.sample, &kept);
        let rest: Vec<usize> = (0..near.len()).filter(|&j| near[j] > EXPLAINED_SIGMAS * best.sigma).collect();
        if rest.len() >= FEWEST {
            let rest = self.sample.subset(rest.into_iter());
            let many = if best.outliers < CLEAN { UNEXPLAINED } else { UNEXPLAINED_AMONG_OUTLIERS };
            let seeds = self.seeds(many * n, &[0.0; 6], self.scale);
            let found = self.buffers.maximise(&rest, Mixture::new(seeds, WIDE), SEARCH);
            self.pool.extend(found.motions);
        }
    }

    /// Several motions on the measurements of each motion, in case it covers more than one true motion.
    fn split_motions(&mut self, best: &Mixture) {
        let labels = best.labels(&self.sample);
        for (i, motion) in best.motions.iter().enumerate() {
            if let Some(own) = self.labelled(&labels, &[i]) {
                let seeds = self.seeds(SPLIT, motion, 0.5 * self.scale);
                let found = self.buffers.maximise(&own, Mixture::new(seeds, SPLIT_WIDE), SEARCH);
                self.pool.extend(found.motions);
            }
        }
    }

    /// Refines the best selection from the pool for both caps. Returns whether the best fit has improved.
    fn choose_and_refine(&mut self, n: usize, best: &mut Mixture) -> bool {
        let mut gained = false;
        let mut last = Vec::new();
        for cap in [CAP_SIGMAS * best.sigma, CAP] {
            let mut chosen = subset::choose(&self.sample, &self.pool, n, cap);
            sort_few(&mut chosen, usize::cmp);
            if chosen == last {
                continue;
            }
            let mut motions: Vec<[f64; 6]> = chosen.iter().map(|&k| self.pool[k]).collect();
            motions.resize(n, [0.0; 6]);
            last = chosen;
            let sigma = widest_sigma(&self.sample, &motions).min(CHOICE_WIDE);
            let candidate = self.buffers.maximise(&self.sample, Mixture::new(motions, sigma), REFINE);
            if candidate.log_likelihood > best.log_likelihood + GAIN {
                *best = candidate;
                gained = true;
            }
        }
        gained
    }

    /// Random motions around `centre`.
    fn seeds(&mut self, count: usize, centre: &[f64; 6], scale: f64) -> Vec<[f64; 6]> {
        let random = &mut self.random;
        (0..count).map(|_| centre.map(|c| c + scale * random.normal())).collect()
    }

    /// The measurements of the search with one of the given labels; `None` if they are fewer than [`FEWEST`].
    pub(super) fn labelled(&self, labels: &[Option<usize>], wanted: &[usize]) -> Option<Samples> {
        let own: Vec<usize> =
            (0..labels.len()).filter(|&j| labels[j].is_some_and(|label| wanted.contains(&label))).collect();
        (own.len() >= FEWEST).then(|| self.sample.subset(own.into_iter()))
    }
}

fn is_usable(motion: &[f64; 6]) -> bool {
    motion.iter().all(|a| a.abs() < LARGEST)
}

/// The largest σ among the motions, estimated as 1.4826 times the median distance of the measurements nearest to the motion.
fn widest_sigma(samples: &Samples, motions: &[[f64; 6]]) -> f64 {
    let typical = |own: &Vec<f64>| 1.4826 * median_f64(own).unwrap_or(0.0);
    own_distances(samples, motions).iter().map(typical).fold(0.0, f64::max)
}
