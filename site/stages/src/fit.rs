//! The paper's algorithm for Problem 1 step by step, and differentiation beside its factorisation.

use veronese::embedding::monomials::unknowns;
use veronese::factorisation::assignment::assign;
use veronese::factorisation::differentiation::{POINTS, motions_from_points};
use veronese::factorisation::{five_steps, third_columns};
use veronese::paper::{PaperFit, paper_fit};
use veronese::{AffineMotion, Measurements, MotionCount, Normalisation, Random, Result};

/// Seed of the points at which the multibody motion is differentiated.
const SEED: u64 = 1;
/// Entries that differ by less than this share of the largest one, or of a pixel, count as equal: a double root has the accuracy of √ε.
const EQUAL: f64 = 1e-5;

/// The result of [`paper_stages`].
#[derive(Clone, Debug)]
pub struct FitStages {
    /// All steps of the paper. Its multibody motion is in normalised coordinates, its motions are in those of the input.
    pub fit: PaperFit,
    /// The change to normalised coordinates.
    pub normalisation: Normalisation,
    /// Rows and columns of the embedded data P̃_n: N and M_n² − Z_n.
    pub embedded: [usize; 2],
    /// Step 2: the factors of the last column of 𝒜, which are the third columns of the motions in normalised coordinates, the flows (u, v)
    /// at [`Normalisation::centre`]. In the order of the motions of the factorisation.
    pub third_columns: Vec<[f64; 2]>,
    /// The smallest differences of two third columns in u and in v; none for one motion.
    pub gaps: Option<[f64; 2]>,
    /// The largest differences, in u and in v, of a third column and the third entry of the row that step 5 gives to it.
    pub mismatches: [f64; 2],
    /// Whether step 5 cannot tell which row belongs to which motion: a gap vanishes, or is not larger than twice the mismatch.
    pub ambiguous: bool,
    /// Motions by differentiation of the same multibody motion at [`POINTS`] measurements, in the coordinates of the input, each beside the
    /// refined motion that it resembles. Empty if no point is usable.
    pub differentiation: Vec<AffineMotion>,
}

/// Runs [`paper_fit`] and differentiates the multibody motion that it finds.
///
/// # Errors
/// As [`paper_fit`].
pub fn paper_stages(measurements: &Measurements, motions: MotionCount) -> Result<FitStages> {
    let fit = paper_fit(measurements, motions, &mut |_| {})?;
    let (normalised, normalisation) = measurements.normalised();
    let third_columns: Vec<[f64; 2]> = third_columns(&fit.multibody).iter().map(|b| [b[0], b[1]]).collect();
    let rows: Vec<[f64; 2]> = five_steps(&fit.multibody).iter().map(|a| [a.matrix[2], a.matrix[5]]).collect();
    let mismatches =
        [0, 1].map(|j| third_columns.iter().zip(&rows).map(|(b, row)| (b[j] - row[j]).abs()).fold(0.0, f64::max));
    let gaps = (third_columns.len() > 1).then(|| [0, 1].map(|j| smallest_gap(third_columns.iter().map(|b| b[j]))));
    let largest = third_columns.iter().flatten().fold(1.0, |most: f64, entry| most.max(entry.abs()));
    let closes = |(gap, mismatch): (f64, f64)| gap <= 2.0 * mismatch || gap <= EQUAL * largest;
    let ambiguous = gaps.is_some_and(|gaps| gaps.into_iter().zip(mismatches).any(closes));
    let found = motions_from_points(&fit.multibody, &normalised, POINTS, &mut Random::from_seed(SEED));
    let found: Vec<AffineMotion> = found.iter().map(|motion| normalisation.restore(motion)).collect();
    Ok(FitStages {
        embedded: [measurements.len(), unknowns(fit.multibody.degree())],
        differentiation: beside(&fit.refined, found),
        fit,
        normalisation,
        third_columns,
        gaps,
        mismatches,
        ambiguous,
    })
}

/// The smallest difference of two values.
fn smallest_gap(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min)
}

/// Motions in the order of others that they resemble.
fn beside(others: &[AffineMotion], motions: Vec<AffineMotion>) -> Vec<AffineMotion> {
    if others.len() != motions.len() {
        return motions;
    }
    let errors: Vec<Vec<f64>> =
        others.iter().map(|other| motions.iter().map(|motion| other.relative_error(motion)).collect()).collect();
    assign(&errors).into_iter().map(|k| motions[k]).collect()
}
