//! The number of motions from the ranks of the embedded data (Theorem 1).

use serde::Serialize;

use super::embedded::EmbeddedData;
use super::monomials::unknowns;
use super::multibody::measurements_needed;
use crate::error::{Error, Result};
use crate::measurements::Measurements;

/// κ of the paper's footnote 4.
pub const KAPPA: f64 = 3e-3;

/// Largest number of motions that the rule tries: beyond, the singular values of P̃_n are too costly.
pub const MAX_TRIED: usize = 6;

/// What the rank rule saw at one tried number of motions.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct RankCandidate {
    /// The number of motions i that was tried.
    pub motions: usize,
    /// Numerical rank of P̃_i.
    pub rank: usize,
    /// Number of columns of P̃_i, M_i² − Z_i; the rule fires where the rank is one less.
    pub columns: usize,
    /// σ_m / (σ_1 + … + σ_{m−1}) for the last of the m singular values: below κ the matrix has a null vector.
    pub ratio: f64,
}

/// The answer of [`number_of_motions`].
#[derive(Clone, Debug)]
pub struct RankRule {
    /// The number of motions of (12); where no tried number fulfils it, see [`number_of_motions`].
    pub motions: usize,
    /// Whether (12) was fulfilled.
    pub fired: bool,
    /// What was seen at each tried number.
    pub candidates: Vec<RankCandidate>,
    /// Singular values of P̃_n at the answer, columns scaled to unit length, decreasing.
    pub singular_values: Vec<f64>,
    /// The embedded data at the answer, to go on with.
    pub data: EmbeddedData,
}

/// The numerical rank of footnote 4: the first r with `σ_{r+1} / (σ_1 + … + σ_r) < κ`, or the number of values.
pub fn numerical_rank(singular_values: &[f64], kappa: f64) -> usize {
    let mut sum = 0.0;
    for (r, &value) in singular_values.iter().enumerate() {
        // For r = 0 the sum is empty: the rank is 0 only where everything is zero.
        let negligible = if r == 0 { value == 0.0 } else { value < kappa * sum };
        if negligible {
            return r;
        }
        sum += value;
    }
    singular_values.len()
}

/// Theorem 1, eq. (12): the smallest i with rank P̃_i = M_i² − Z_i − 1, the rank being that of footnote 4 with
/// [`KAPPA`]. Columns of P̃_i are scaled to unit length, so that the units of the data do not matter.
///
/// Tries i = 1, 2, … as far as N ≥ M_i² − Z_i − 1, at most to `largest` (no more than [`MAX_TRIED`]). Expects normalised
/// measurements. By (11) a rank below M_i² − Z_i − 1 says that i is already larger than n, so the search ends there;
/// where no smaller i has fulfilled (12), that i is the answer, and `fired` is false. Where no rank is deficient at all,
/// the answer is the last tried.
///
/// **Limits.** The paper claims that its rule is always right. We measured (40 trials each, protocol B1, N = 600; command:
/// `cargo test --test figure_1 rank_rule -- --ignored --nocapture`): right for n = 2 up to 2 % noise and in 37 of 40 at
/// 5 %, for n = 1 only below 2 % noise, for n = 3 nearly always but mostly without (12) being fulfilled, for n = 4 in
/// 14 of 40 even without noise: κ measures the conditioning of the monomials rather than the noise.
///
/// # Errors
/// [`Error::TooFewMeasurements`] where there are fewer than 6.
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

/// The last singular value over the sum of the others; 0 where these are all zero.
fn last_ratio(singular_values: &[f64]) -> f64 {
    match singular_values.split_last() {
        Some((last, others)) if others.iter().sum::<f64>() > 0.0 => last / others.iter().sum::<f64>(),
        _ => 0.0,
    }
}
