//! Problem 1 of the paper on given measurements: the number of motions, the motions, the segmentation.

use serde::Serialize;

use crate::error::Result;
use crate::measurements::Measurements;
use crate::motion::AffineMotion;
use crate::options::FitOptions;
use crate::progress::Progress;

/// The label of a measurement or pixel that no motion explains.
pub const UNLABELLED: u8 = 255;

/// What [`fit_motions`] found.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct MotionFit {
    /// Number of motions, n.
    pub count: usize,
    /// The motions by decreasing number of measurements; `motions[i].label == i`.
    pub motions: Vec<FittedMotion>,
    /// One label per measurement, in input order; [`UNLABELLED`] for an outlier.
    #[serde(skip)]
    pub labels: Vec<u8>,
    /// What the number of motions rests on.
    pub evidence: FitEvidence,
    /// What the steps of the paper gave; only with [`Method::Paper`](crate::Method::Paper).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stages: Option<PaperStages>,
}

/// One motion of a [`MotionFit`].
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct FittedMotion {
    /// Its label.
    pub label: u8,
    /// Its six entries, in the coordinates of the input.
    pub matrix: AffineMotion,
    /// Number of measurements that belong to it.
    pub measurements: usize,
    /// How many of the six entries its measurements determine (the rank of their constraints): below 6 the rest is a choice.
    pub determined: usize,
}

/// Evidence for the number of motions.
#[derive(Clone, Debug, Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct FitEvidence {
    /// Singular values of the embedded data matrix P̃_n at the n that was chosen, decreasing, columns scaled to unit norm.
    pub singular_values: Vec<f64>,
    /// The numbers of motions that were tried; a smaller score is better.
    pub candidates: Vec<Candidate>,
}

/// One number of motions that was tried.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Candidate {
    /// The number.
    pub motions: usize,
    /// Its score; smaller is better.
    pub score: f64,
}

/// What the steps of the paper gave, one after another.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct PaperStages {
    /// Motions after the polynomial factorisation (section 3.3).
    pub factorisation: Vec<AffineMotion>,
    /// Motions after the nonlinear refinement of (19).
    pub refined: Vec<AffineMotion>,
}

/// Solves Problem 1: how many affine motions explain the measurements, which, and which measurement belongs to which.
///
/// # Errors
/// [`Error::InvalidOption`](crate::Error::InvalidOption), [`Error::TooFewMeasurements`](crate::Error::TooFewMeasurements).
pub fn fit_motions(_measurements: &Measurements, options: &FitOptions, _progress: Progress<'_>) -> Result<MotionFit> {
    options.motions.validate()?;
    Ok(MotionFit { count: 0, motions: Vec::new(), labels: Vec::new(), evidence: FitEvidence::default(), stages: None })
}
