//! n motions of the greatest likelihood: many starts, one pool of motions, the best choice out of it.
//!
//! EM finds the nearest maximum, so everything depends on where it starts. A round of the search
//! 1. fills a pool of motions: over-complete EM (six times as many motions as wanted, random, wide σ) in every second
//!    round; the same on the measurements that the best fit so far leaves unexplained when its weakest motion is taken away;
//!    and each motion's own measurements tried with several motions, in case it covers two;
//! 2. chooses from the pool the n motions that explain the most ([`subset::choose`]), at two caps;
//! 3. runs EM from that choice and keeps the result if it is more likely than the best so far.
//!
//! It ends when rounds stop bringing anything: one where no outliers are left over, three where there are some. Then close
//! pairs of motions are taken apart anew ([`Search::untangle`](super::untangling)), and the best fit is polished on all measurements.
//!
//! Measured on the paper's experiment (general motions, n = 2…5, up to 30 % outliers, one motion with 5 % of the measurements),
//! this ends at the maximum that EM reaches from the true motions. Pitfalls found by measurement: a start σ of 0.05 or 0.15
//! freezes the random assignment; without taking the weakest motion away, a wrong motion hides half of the
//! measurements of a small one that is missing; the σ from which EM starts must be that of the *worst* chosen motion, or the
//! exact motions of noise-free data freeze the others.

use super::mixture::{EmBuffers, Mixture, Normal, Stop, nearest_distances, own_distances};
use super::samples::Samples;
use super::score::score;
use super::subset;
use crate::order::{median_f64, sort_few};
use crate::random::Random;

/// The search works on at most this many measurements, the last maximisation on all.
const SEARCHED: usize = 1000;
/// Random motions are drawn with this many times the typical normal flow as deviation.
const SEED_SCALE: f64 = 1.2;
/// Random motions per wanted motion: on all measurements, on the unexplained ones (more where outliers hide the motion that is
/// missing), on those of one motion.
const OVER_COMPLETE: usize = 6;
const UNEXPLAINED: usize = 6;
const UNEXPLAINED_AMONG_OUTLIERS: usize = 10;
const SPLIT: usize = 4;
/// σ at the start from random motions, of splitting one motion, and the largest at the start from a choice, all in units
/// of the derivatives' root mean square.
const WIDE: f64 = 0.3;
const SPLIT_WIDE: f64 = 0.1;
const CHOICE_WIDE: f64 = 0.1;
/// Distances count up to this many σ of the best fit in one choice and at this distance in the other.
const CAP_SIGMAS: f64 = 4.0;
const CAP: f64 = 0.1;
/// A measurement further than this many σ from every motion is unexplained.
const EXPLAINED_SIGMAS: f64 = 2.5;
/// No search in fewer measurements than this.
pub(super) const FEWEST: usize = 12;
/// A gain in log-likelihood that counts.
const GAIN: f64 = 0.5;
/// Rounds at most, and how many without gain end the search where more or less than `CLEAN` are outliers.
const ROUNDS: usize = 24;
const STALE: usize = 3;
const STALE_CLEAN: usize = 1;
const CLEAN: f64 = 0.02;
/// Close pairs are taken apart at most so many times.
const UNTANGLINGS: usize = 3;
/// By so much less the score must be to win before this is worth while; measured, it lowers the score by 24 at most.
const HOPELESS: f64 = 40.0;
/// Motions of the pool with an entry beyond this are nothing any more.
const LARGEST: f64 = 1e3;

const SEARCH: Stop = Stop { iterations: 15, gain: 1e-6, step: 1e-4 };
const REFINE: Stop = Stop { iterations: 25, gain: 1e-6, step: 1e-4 };
const POLISH: Stop = Stop { iterations: 60, gain: 1e-9, step: 1e-7 };

/// A search for motions in one set of measurements; what it finds at one n serves at the next.
pub(crate) struct Search<'a> {
    all: &'a Samples,
    pub(super) sample: Samples,
    pub(super) random: Random,
    /// The deviation with which entries of random motions are drawn.
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
        // The smallest scale only keeps the seeds of motionless data apart from zero.
        let scale = SEED_SCALE * sample.typical_flow() + 1e-12;
        Search { all, sample, random, scale, pool: Vec::new(), buffers: EmBuffers::default() }
    }

    /// The likelihood of a fit on all measurements, and the normal equations of its motions.
    pub(crate) fn evaluate(&mut self, fit: &mut Mixture) -> Vec<Normal> {
        self.buffers.evaluate(self.all, fit)
    }

    /// The score of a fit on all measurements, smaller is better.
    pub(crate) fn score(&mut self, fit: &Mixture) -> f64 {
        score(self.all, self.scale, &mut self.buffers, fit)
    }

    /// The most likely n motions found, on all measurements. `hypotheses` are motions worth trying; there may be none. Where the
    /// score is far above `rival`, that of another n, the last effort is saved.
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

    /// The first fit: from the hypotheses where there are enough, else from random motions.
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
            // What was chosen is in the best fit; the rest would only be compared with all measurements in every round.
            self.pool.truncate(known);
        }
        best
    }

    /// One round: more motions for the pool, then the best choice from it. Returns whether the likelihood has grown.
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

    /// Over-complete search on what the best fit does not explain without its weakest motion.
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

    /// Several motions on the measurements of each motion, in case it covers more than one.
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

    /// The best choice from the pool at both caps, refined. Returns whether the best fit has become better.
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

    /// The searched measurements with one of the given labels; `None` where there are too few to search in.
    pub(super) fn labelled(&self, labels: &[Option<usize>], wanted: &[usize]) -> Option<Samples> {
        let own: Vec<usize> =
            (0..labels.len()).filter(|&j| labels[j].is_some_and(|label| wanted.contains(&label))).collect();
        (own.len() >= FEWEST).then(|| self.sample.subset(own.into_iter()))
    }
}

fn is_usable(motion: &[f64; 6]) -> bool {
    motion.iter().all(|a| a.abs() < LARGEST)
}

/// The largest noise that the measurements nearest to one of the motions suggest: 1.4826 times the median of their distances.
fn widest_sigma(samples: &Samples, motions: &[[f64; 6]]) -> f64 {
    let typical = |own: &Vec<f64>| 1.4826 * median_f64(own).unwrap_or(0.0);
    own_distances(samples, motions).iter().map(typical).fold(0.0, f64::max)
}
