//! The number of motions from the ranks of the embedded data (Theorem 1).

use serde::Serialize;

use super::embedded::EmbeddedData;
use super::monomials::unknowns;
use super::multibody::measurements_needed;
use crate::error::{Error, Result};
use crate::measurements::Measurements;

/// The tolerance κ of the paper's footnote 4.
pub const KAPPA: f64 = 3e-3;

/// Largest number of motions that the rank rule tries. For more, the singular values of P̃_n are too costly.
pub const MAX_TRIED: usize = 6;

/// The rank of P̃_i for one number of motions i.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct RankCandidate {
    /// The number of motions i.
    pub motions: usize,
    /// Numerical rank of P̃_i.
    pub rank: usize,
    /// Number of columns of P̃_i, M_i² − Z_i. The rule (12) is satisfied if the rank is one less.
    pub columns: usize,
    /// σ_m / (σ_1 + … + σ_{m−1}) for the last of the m singular values. Below κ, the matrix has a null vector.
    pub ratio: f64,
}

impl RankCandidate {
    /// The rank that satisfies the rule (12), one less than the number of columns.
    pub fn wanted(&self) -> usize {
        self.columns.saturating_sub(1)
    }
}

/// The result of [`number_of_motions`].
#[non_exhaustive]
#[derive(Clone, Debug)]
pub struct RankRule {
    /// The number of motions n of (12). If no number satisfies (12), see [`number_of_motions`].
    pub motions: usize,
    /// Whether (12) is satisfied.
    pub fired: bool,
    /// The ranks for all numbers tried, in increasing order.
    pub candidates: Vec<RankCandidate>,
    /// Singular values of P̃_n, columns scaled to unit length, decreasing.
    pub singular_values: Vec<f64>,
    /// The embedded data of degree n.
    pub data: EmbeddedData,
}

/// The numerical rank of footnote 4: the first r with `σ_{r+1} / (σ_1 + … + σ_r) < κ`, or the number of values if there is none.
/// `singular_values` must be decreasing.
///
/// ```
/// use veronese::embedding::rank::{KAPPA, numerical_rank};
///
/// assert_eq!(numerical_rank(&[4.0, 1.0, 0.01], KAPPA), 2);
/// assert_eq!(numerical_rank(&[4.0, 1.0, 0.1], KAPPA), 3);
/// ```
pub fn numerical_rank(singular_values: &[f64], kappa: f64) -> usize {
    let mut sum = 0.0;
    for (r, &value) in singular_values.iter().enumerate() {
        // For r = 0 the sum is empty. The rank is 0 only if all values are zero.
        let negligible = if r == 0 { value == 0.0 } else { value < kappa * sum };
        if negligible {
            return r;
        }
        sum += value;
    }
    singular_values.len()
}

/// The number of motions by Theorem 1: the smallest i with rank P̃_i = M_i² − Z_i − 1 (12), with the [`numerical_rank`] for [`KAPPA`].
/// Columns of P̃_i are scaled to unit length, so the units of the data do not matter.
///
/// Tries i = 1, 2, … while N ≥ M_i² − Z_i − 1, up to `largest` or [`MAX_TRIED`]. `measurements` should be normalised. By (11), a rank
/// below M_i² − Z_i − 1 means that i exceeds n, so the search ends there; if no smaller i has satisfied (12), that i is the result, and
/// `fired` is false. If no P̃_i is rank deficient, the result is the last i tried.
///
/// The [module example](super) estimates the number of two motions.
///
/// **Limits.** The paper reports that its rule is always right. Measured with protocol B1, 600 measurements and 40 trials each, it is
/// right for n = 2 up to 2 % noise and in 37 of 40 trials at 5 %; for n = 1 only below 2 % noise; for n = 3 nearly always, but mostly
/// without satisfying (12); for n = 4 in 14 of 40 trials even without noise. κ responds to the conditioning of the monomials more than to
/// noise.
///
/// # Errors
/// [`Error::TooFewMeasurements`] for fewer than 6 measurements.
pub fn number_of_motions(measurements: &Measurements, largest: usize) -> Result<RankRule> {
    let found = measurements.len();
    let mut candidates = Vec::new();
    let mut last = None;
    for motions in 1..=largest.clamp(1, MAX_TRIED) {
        if found < measurements_needed(motions) {
            break;
        }
        let data = EmbeddedData::new(measurements, motions);
        let singular_values = data.scaled_singular_values().unwrap_or_default();
        let columns = unknowns(motions);
        let rank = numerical_rank(&singular_values, KAPPA);
        candidates.push(RankCandidate { motions, rank, columns, ratio: last_ratio(&singular_values) });
        let fired = rank + 1 == columns;
        last = Some((motions, fired, singular_values, data));
        if rank < columns {
            break;
        }
    }
    let (motions, fired, singular_values, data) =
        last.ok_or(Error::TooFewMeasurements { motions: 1, needed: measurements_needed(1), found })?;
    Ok(RankRule { motions, fired, candidates, singular_values, data })
}

/// The last singular value divided by the sum of the others; 0 if these are all zero.
fn last_ratio(singular_values: &[f64]) -> f64 {
    match singular_values.split_last() {
        Some((last, others)) if others.iter().sum::<f64>() > 0.0 => last / others.iter().sum::<f64>(),
        _ => 0.0,
    }
}
