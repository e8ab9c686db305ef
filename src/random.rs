//! Seeded random numbers, the same bits on every machine.
//!
//! Written out rather than taken from a crate because the sequence is part of our results: a new version of a library may
//! draw differently, and then the same seed would no longer give the same masks.

/// The generator xoshiro256++ of Blackman and Vigna (ACM TOMS 47(4), 2021), seeded through SplitMix64.
#[derive(Clone, Debug)]
pub struct Random {
    state: [u64; 4],
}

impl Random {
    /// A generator whose whole sequence follows from `seed`.
    #[inline(never)]
    pub fn from_seed(seed: u64) -> Self {
        let mut z = seed;
        let state = std::array::from_fn(|_| {
            z = z.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mut s = z;
            s = (s ^ (s >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            s = (s ^ (s >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            s ^ (s >> 31)
        });
        Random { state }
    }

    fn next_u64(&mut self) -> u64 {
        let s = &mut self.state;
        let result = s[0].wrapping_add(s[3]).rotate_left(23).wrapping_add(s[0]);
        let t = s[1] << 17;
        s[2] ^= s[0];
        s[3] ^= s[1];
        s[1] ^= s[2];
        s[0] ^= s[3];
        s[2] ^= t;
        s[3] = s[3].rotate_left(45);
        result
    }

    /// Uniform in [0, 1), 53 bits.
    pub fn unit(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Uniform in [low, high).
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform in 0…bound−1 (0 for a bound of 0). The bias of the product method is below 2⁻⁵³·bound.
    pub fn below(&mut self, bound: usize) -> usize {
        ((self.unit() * bound as f64) as usize).min(bound.saturating_sub(1))
    }

    /// Standard normal, by Marsaglia's polar method.
    #[inline(never)]
    pub fn normal(&mut self) -> f64 {
        // Each try succeeds with probability π/4: 64 failures in a row happen once in 10^42.
        for _ in 0..64 {
            let (a, b) = (self.uniform(-1.0, 1.0), self.uniform(-1.0, 1.0));
            let s = a * a + b * b;
            if s > 0.0 && s < 1.0 {
                return a * (-2.0 * libm::log(s) / s).sqrt();
            }
        }
        0.0
    }

    /// `count` different indices below `total`, in random order (all of them where there are fewer).
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
