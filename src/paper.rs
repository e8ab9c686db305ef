//! The paper's whole algorithm on points (its Problem 1): rank rule → multibody motion → five steps → refinement of
//! (19) → labels. Kept as the paper gives it, to compare with; [`Method::Best`](crate::Method::Best) does better.

use crate::embedding::rank::{MAX_TRIED, RankCandidate, RankRule, number_of_motions};
use crate::embedding::{EmbeddedData, MultibodyMotion, monomials};
use crate::error::{Error, Result};
use crate::factorisation::five_steps;
use crate::measurements::Measurements;
use crate::motion::AffineMotion;
use crate::options::MotionCount;
use crate::progress::{Progress, Stages};
use crate::refinement::{Report, product};

const STAGES: &[&str] = &["embedding", "factorisation", "refinement", "labels"];

/// What each step of the paper's algorithm gave.
#[derive(Clone, Debug)]
pub struct PaperFit {
    /// Ranks at the numbers of motions that were tried (Theorem 1); empty where the number was given.
    pub ranks: Vec<RankCandidate>,
    /// Whether the rank rule (12) was fulfilled; `None` where the number was given. Where it was not, see
    /// [`number_of_motions`] for the number that is used.
    pub rank_rule_fired: Option<bool>,
    /// Singular values of P̃_n on normalised measurements, columns scaled to unit length, decreasing; empty for n > 6, where they
    /// are too costly.
    pub singular_values: Vec<f64>,
    /// The multibody motion 𝒜 of (9), in normalised coordinates.
    pub multibody: MultibodyMotion,
    /// Motions after the five steps of section 3.3, in the coordinates of the input.
    pub factorisation: Vec<AffineMotion>,
    /// Motions after the minimisation of (19), in the coordinates of the input.
    pub refined: Vec<AffineMotion>,
    /// How that minimisation ended.
    pub refinement: Report,
    /// For each measurement the index in `refined` of the motion with the smallest |yᵀA x|: the segmentation that Problem 1 asks for.
    pub labels: Vec<usize>,
}

/// The paper's algorithm. A given number of motions skips the rank rule.
///
/// # Errors
/// [`Error::InvalidOption`], and [`Error::TooFewMeasurements`] where N < M_n² − Z_n − 1 (for the automatic number: N < 6).
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

/// The embedded data of a given number of motions, as if the rank rule had chosen it.
fn given(measurements: &Measurements, motions: usize) -> Result<RankRule> {
    let needed = monomials::unknowns(motions) - 1;
    if measurements.len() < needed {
        return Err(Error::TooFewMeasurements { motions, needed, found: measurements.len() });
    }
    let data = EmbeddedData::new(measurements, motions);
    let singular_values = data.scaled_singular_values().unwrap_or_default();
    Ok(RankRule { motions, fired: false, candidates: Vec::new(), singular_values, data })
}

/// For each measurement the index of the motion for which `measure` is smallest; the first among equals.
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
