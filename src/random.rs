//! Seeded random numbers with the same bits on every platform.

use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// The generator xoshiro256++ of Blackman and Vigna (ACM TOMS 47(4), 2021), seeded by SplitMix64.
///
/// ```
/// use veronese::Random;
///
/// let (mut one, mut other) = (Random::from_seed(7), Random::from_seed(7));
/// for _ in 0..100 {
///     let value = one.uniform(-2.0, 3.0);
///     assert!((-2.0..3.0).contains(&value));
///     assert_eq!(value, other.uniform(-2.0, 3.0));
/// }
/// assert!(one.below(6) < 6);
/// ```
#[derive(Clone, Debug)]
pub struct Random {
    generator: Xoshiro256PlusPlus,
}

impl Random {
    /// A generator whose sequence is determined by `seed`.
    #[inline(never)]
    pub fn from_seed(seed: u64) -> Self {
        Random { generator: Xoshiro256PlusPlus::seed_from_u64(seed) }
    }

    /// A uniform number in [0, 1) with 53 random bits.
    #[inline(never)]
    pub fn unit(&mut self) -> f64 {
        (self.generator.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// A uniform number in [low, high).
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A uniform integer in 0…bound−1; 0 if the bound is 0. The bias of the product method is below 2⁻⁵³·bound.
    pub fn below(&mut self, bound: usize) -> usize {
        ((self.unit() * bound as f64) as usize).min(bound.saturating_sub(1))
    }

    /// A standard normal number, by Marsaglia's polar method.
    ///
    /// ```
    /// use veronese::Random;
    ///
    /// let mut random = Random::from_seed(1);
    /// let values: Vec<f64> = (0..10_000).map(|_| random.normal()).collect();
    /// let mean = values.iter().sum::<f64>() / 10_000.0;
    /// let variance = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / 10_000.0;
    /// assert!(mean.abs() < 0.05 && (variance - 1.0).abs() < 0.05);
    /// ```
    #[inline(never)]
    pub fn normal(&mut self) -> f64 {
        // Each attempt succeeds with probability π/4. The probability of 64 failures in a row is 10^−42.
        for _ in 0..64 {
            let (a, b) = (self.uniform(-1.0, 1.0), self.uniform(-1.0, 1.0));
            let s = a * a + b * b;
            if s > 0.0 && s < 1.0 {
                return a * (-2.0 * libm::log(s) / s).sqrt();
            }
        }
        0.0
    }

    /// `count` different indices below `total`, in random order; all `total` indices if `count` is larger.
    ///
    /// ```
    /// use veronese::Random;
    ///
    /// let mut chosen = Random::from_seed(1).choose(10, 4);
    /// chosen.sort_unstable();
    /// chosen.dedup();
    /// assert!(chosen.len() == 4 && chosen.iter().all(|&k| k < 10));
    /// assert_eq!(Random::from_seed(1).choose(3, 4).len(), 3);
    /// ```
    #[inline(never)]
    pub fn choose(&mut self, total: usize, count: usize) -> Vec<usize> {
        let mut indices: Vec<usize> = (0..total).collect();
        let count = count.min(total);
        for i in 0..count {
            let j = i + self.below(total - i);
            indices.swap(i, j);
        }
        indices.truncate(count);
        indices
    }
}
