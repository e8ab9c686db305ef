//! The score of a fit: its likelihood, charged for the number of its motions.
//!
//! The likelihood always grows with n; by how much it must grow is what Bayes' rule says. Integrating a motion's six entries
//! out around their best values (Laplace) charges it with `½ log det(I + s² H / σ²)`: how much more precisely the data must
//! determine it than was known before, s being the typical flow and H the motion's normal matrix `Σ w J Jᵀ`. With a
//! heavy-tailed prior of scale s, the shares of the mixture, and n! orders of the same motions,
//!
//! `score = −2 log L + Σ_i [ log det(I + s² H_i/σ²) + 7 log(1 + |a_i|²/6s²) + log N − 2 log i + margin ]`, smaller is better.
//!
//! Why not the usual `7 log N` per motion (BIC): among outliers there is always a motion that six of them fit exactly, and each such
//! fit gains `log(1/σ)`. The precision the motion is charged with is counted in the same coin, `6 log(1/σ)`; `log N` knows
//! nothing of σ. Measured: with 20 % outliers BIC is right in 60…95 % at 2 % noise and in none at all without noise; this score in all.

use super::mixture::{EmBuffers, Mixture};
use super::samples::Samples;
use super::symmetric::{cholesky, log_determinant};

/// σ never counts as less than this (in units of the derivatives' root mean square): exact data would be infinitely sure.
const LEAST_SIGMA: f64 = 1e-4;
/// What every further motion must bring beyond even odds: e⁵ to 1 (twice the logarithm), against the accidents of many searches.
const MARGIN: f64 = 10.0;

/// The score of a fit on all measurements, `scale` being the typical flow s.
pub(super) fn score(samples: &Samples, scale: f64, buffers: &mut EmBuffers, fit: &Mixture) -> f64 {
    let mut fit = fit.clone();
    fit.sigma = fit.sigma.max(LEAST_SIGMA);
    let normals = buffers.evaluate(samples, &mut fit);
    let s = scale.max(fit.sigma);
    let information = s * s / (fit.sigma * fit.sigma);
    let mut score = -2.0 * fit.log_likelihood;
    for (i, normal) in normals.iter().enumerate() {
        let mut matrix = normal.matrix.map(|row| row.map(|entry| entry * information));
        (0..6).for_each(|k| matrix[k][k] += 1.0);
        let size: f64 = fit.motions[i].iter().map(|a| a * a).sum();
        score += log_determinant(&cholesky(&matrix)) + 7.0 * libm::log(1.0 + size / (6.0 * s * s));
        score += libm::log(samples.len().max(1) as f64) - 2.0 * libm::log((i + 1) as f64) + MARGIN;
    }
    score
}
