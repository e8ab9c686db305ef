//! The paper's complete algorithm for Problem 1: rank rule (12), multibody motion (9), factorisation in five steps (section 3.3),
//! nonlinear refinement (19), labels.
//!
//! It follows the paper to the letter and serves for comparison. [`Method::Best`](crate::Method::Best) is more accurate.

use crate::embedding::rank::{MAX_TRIED, RankCandidate, RankRule, number_of_motions};
use crate::embedding::{EmbeddedData, MultibodyMotion, monomials};
use crate::error::Result;
use crate::factorisation::five_steps;
use crate::measurements::Measurements;
use crate::motion::AffineMotion;
use crate::options::MotionCount;
use crate::progress::{Progress, Stages};
use crate::refinement::{Report, product};

const STAGES: &[&str] = &["embedding", "factorisation", "refinement", "labels"];

/// The results of all steps of [`paper_fit`].
#[non_exhaustive]
#[derive(Clone, Debug)]
pub struct PaperFit {
    /// Rank for each number of motions tried (Theorem 1); empty if the number was given.
    pub ranks: Vec<RankCandidate>,
    /// Whether some number satisfied the rank rule (12); `None` if the number was given. If none did, see [`number_of_motions`] for the
    /// number that is used.
    pub rank_rule_fired: Option<bool>,
    /// Singular values of P̃_n for normalised measurements, columns scaled to unit length, decreasing; empty for n > 6, where they are
    /// too costly.
    pub singular_values: Vec<f64>,
    /// The multibody motion 𝒜 of (9), in normalised coordinates.
    pub multibody: MultibodyMotion,
    /// Motions after the five steps of section 3.3, in the coordinates of the input.
    pub factorisation: Vec<AffineMotion>,
    /// Motions after the minimisation of (19), in the coordinates of the input and the same order.
    pub refined: Vec<AffineMotion>,
    /// How that minimisation ended.
    pub refinement: Report,
    /// For each measurement, the index in `refined` of the motion with the smallest |yᵀA x|.
    pub labels: Vec<usize>,
}

/// Runs the paper's algorithm. A given number of motions skips the rank rule.
///
/// ```
/// use veronese::paper::paper_fit;
/// # use veronese::{AffineMotion, Measurements, Random};
/// use veronese::MotionCount;
///
/// # fn main() -> veronese::Result<()> {
/// let truth = [
///     AffineMotion::new([0.1, -0.2, 0.5, 0.2, 0.1, -0.3]),
///     AffineMotion::new([-0.3, 0.4, -0.4, 0.1, 0.2, 0.6]),
/// ];
/// # let mut random = Random::from_seed(2);
/// # let positions: Vec<_> = (0..300).map(|_| [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)]).collect();
/// # let derivative = |(j, &[x, y]): (usize, &[f64; 2])| {
/// #     let ([u, v], [ix, iy]) = (truth[j % 2].flow(x, y), [random.normal(), random.normal()]);
/// #     [ix, iy, -ix * u - iy * v]
/// # };
/// # let derivatives = positions.iter().enumerate().map(derivative).collect();
/// # let data = Measurements::new(positions, derivatives)?;
/// // `data` are 300 measurements of the two motions, without noise.
/// let fit = paper_fit(&data, MotionCount::Auto, &mut |_| {})?;
/// assert_eq!((fit.rank_rule_fired, fit.refined.len()), (Some(true), 2));
/// for motion in &truth {
///     assert!(fit.refined.iter().any(|found| motion.relative_error(found) < 1e-6));
/// }
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`Error::InvalidOption`](crate::Error::InvalidOption) for a number of motions outside 1 to 10;
/// [`Error::TooFewMeasurements`](crate::Error::TooFewMeasurements) if N < M_n² − Z_n − 1, or N < 6 if the number is not given.
pub fn paper_fit(measurements: &Measurements, motions: MotionCount, progress: Progress<'_>) -> Result<PaperFit> {
    motions.validate()?;
    let mut stages = Stages::new(STAGES, progress);
    let (normalised, normalisation) = measurements.normalised();
    stages.begin("embedding");
    let rule = match motions {
        MotionCount::Auto => number_of_motions(&normalised, MAX_TRIED)?,
        MotionCount::Given(n) => given(&normalised, n)?,
    };
    let multibody = MultibodyMotion::from_embedded(&rule.data);
    stages.begin("factorisation");
    let start = five_steps(&multibody);
    stages.begin("refinement");
    let (refined, refinement) = product::refine(&start, &normalised);
    stages.begin("labels");
    let labels = nearest_by(&normalised, &refined, |a, x, y| a.residual(x, y).abs());
    let restored = |motions: &[AffineMotion]| motions.iter().map(|a| normalisation.restore(a)).collect();
    Ok(PaperFit {
        rank_rule_fired: (motions == MotionCount::Auto).then_some(rule.fired),
        ranks: rule.candidates,
        singular_values: rule.singular_values,
        factorisation: restored(&start),
        refined: restored(&refined),
        multibody,
        refinement,
        labels,
    })
}

/// The embedded data for a given number of motions, in place of the rank rule.
fn given(measurements: &Measurements, motions: usize) -> Result<RankRule> {
    measurements.check_number(motions, monomials::unknowns(motions) - 1)?;
    let data = EmbeddedData::new(measurements, motions);
    let singular_values = data.scaled_singular_values().unwrap_or_default();
    Ok(RankRule { motions, fired: false, candidates: Vec::new(), singular_values, data })
}

/// For each measurement, the index of the motion with the smallest `measure`; ties go to the first.
pub(crate) fn nearest_by(
    measurements: &Measurements,
    motions: &[AffineMotion],
    measure: impl Fn(&AffineMotion, [f64; 2], [f64; 3]) -> f64,
) -> Vec<usize> {
    let nearest = |(x, y)| {
        let values = motions.iter().map(|a| measure(a, x, y)).enumerate();
        values.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(i, _)| i)
    };
    measurements.iter().map(nearest).collect()
}
