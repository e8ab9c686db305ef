//! The score of a fit: its negative log-likelihood plus a penalty for each motion.
//!
//! The likelihood always increases with n; the penalty approximates the Bayesian evidence. Integrating over the six entries of a motion
//! around their maximum (Laplace's method) costs `½ log det(I + s² H / σ²)`, where s is the typical flow and H the normal matrix
//! `Σ w J Jᵀ` of the motion. With a heavy-tailed prior of scale s, the shares of the mixture, and the n! orders of the same motions:
//!
//! `score = −2 log L + Σ_i [ log det(I + s² H_i/σ²) + 7 log(1 + |a_i|²/6s²) + log N − 2 log i + margin ]`, smaller is better.
//!
//! The penalty of BIC, `7 log N` per motion, does not work here: some motion always fits six outliers exactly, and each such fit gains
//! `log(1/σ)`. The determinant grows with `6 log(1/σ)` and compensates that; `log N` does not depend on σ. With 20 % outliers, BIC finds
//! the number of motions in 60 to 95 % of the trials at 2 % noise and in none without noise; this score finds it in all (measured).

use nalgebra::Matrix6;

use super::mixture::{EmBuffers, Mixture, cholesky};
use super::samples::Samples;

/// Lower bound of σ, in units of the root mean square length of the derivatives. Without it, the score of exact data is infinite.
const LEAST_SIGMA: f64 = 1e-4;
/// Additional penalty per motion: twice the logarithm of odds of e⁵ to 1, because the maximum of many searches is biased.
const MARGIN: f64 = 10.0;

/// The score of a fit on all measurements; `scale` is the typical flow s.
pub(super) fn score(samples: &Samples, scale: f64, buffers: &mut EmBuffers, fit: &Mixture) -> f64 {
    let mut fit = fit.clone();
    fit.sigma = fit.sigma.max(LEAST_SIGMA);
    let normals = buffers.evaluate(samples, &mut fit);
    let s = scale.max(fit.sigma);
    let information = s * s / (fit.sigma * fit.sigma);
    let mut score = -2.0 * fit.log_likelihood;
    for (i, normal) in normals.iter().enumerate() {
        let matrix = normal.matrix * information + Matrix6::identity();
        let size: f64 = fit.motions[i].iter().map(|a| a * a).sum();
        score += cholesky(matrix).ln_determinant() + 7.0 * libm::log(1.0 + size / (6.0 * s * s));
        score += libm::log(samples.len().max(1) as f64) - 2.0 * libm::log((i + 1) as f64) + MARGIN;
    }
    score
}
