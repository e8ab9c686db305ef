//! The result types for measurements, and [`UNLABELLED`] and [`Candidate`], which results for frames use too.

use serde::Serialize;

use crate::embedding::rank::RankCandidate;
use crate::motion::AffineMotion;
use crate::refinement::Report;

/// The label of a measurement or pixel without one: an outlier, a pixel whose motion is unknown, or one that is not annotated.
pub const UNLABELLED: u8 = 255;

/// The result of [`fit_motions`](crate::fit_motions).
#[non_exhaustive]
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
    /// What the number of motions was chosen by.
    pub evidence: FitEvidence,
    /// Results of the steps of the paper; only with [`Method::Paper`](crate::Method::Paper).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stages: Option<PaperStages>,
}

/// One motion of a [`MotionFit`].
#[non_exhaustive]
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct FittedMotion {
    /// Its label.
    pub label: u8,
    /// Its six entries, in the coordinates of the input.
    pub matrix: AffineMotion,
    /// Number of measurements that belong to it.
    pub measurements: usize,
    /// Rank of the constraints that its measurements put on the six entries, 0 to 6. Below 6, the entries are one of many solutions.
    pub determined: usize,
    /// Covariance of the six entries, in products of their units, with the labels taken as known; only with
    /// [`Method::Best`](crate::Method::Best).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub covariance: Option<[[f64; 6]; 6]>,
}

/// What the number of motions was chosen by.
#[non_exhaustive]
#[derive(Clone, Debug, Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct FitEvidence {
    /// Singular values of the embedded data matrix P̃_n for the chosen n, decreasing, columns scaled to unit length; empty with
    /// [`Method::Best`](crate::Method::Best) and for n > 6.
    pub singular_values: Vec<f64>,
    /// The numbers of motions that were tried, with their scores.
    pub candidates: Vec<Candidate>,
}

/// A number of motions that was tried.
#[non_exhaustive]
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Candidate {
    /// The number of motions.
    pub motions: usize,
    /// Its score; smaller is better.
    pub score: f64,
}

/// The results of the steps of the paper's algorithm.
#[non_exhaustive]
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct PaperStages {
    /// Rank for each number of motions tried (Theorem 1); empty if the number was given.
    pub ranks: Vec<RankCandidate>,
    /// Whether some number satisfied the rank rule (12); `None` if the number was given. If none did, see
    /// [`number_of_motions`](crate::embedding::rank::number_of_motions) for the number that is used.
    pub rank_rule_fired: Option<bool>,
    /// Motions after the polynomial factorisation (section 3.3), in the order of [`MotionFit::motions`].
    pub factorisation: Vec<AffineMotion>,
    /// Motions after the nonlinear refinement of (19), in the same order.
    pub refined: Vec<AffineMotion>,
    /// How the refinement ended.
    pub refinement: Report,
}
