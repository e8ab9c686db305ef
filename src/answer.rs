//! What is found on measurements, and the two things that answers on frames share with it.

use serde::Serialize;

use crate::embedding::rank::RankCandidate;
use crate::motion::AffineMotion;
use crate::refinement::Report;

/// The label of a measurement or pixel that no motion explains.
pub const UNLABELLED: u8 = 255;

/// What [`fit_motions`](crate::fit_motions) found.
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
    /// Covariance of the six entries, in the squared units of the entries, where the labels are taken as known; only with
    /// [`Method::Best`](crate::Method::Best).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub covariance: Option<[[f64; 6]; 6]>,
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
    /// Ranks at the numbers of motions that were tried (Theorem 1); empty where the number was given.
    pub ranks: Vec<RankCandidate>,
    /// Whether the rank rule (12) was fulfilled; where not, the number is the smallest whose rank is too low, or else the last
    /// tried. `None` where the number was given.
    pub rank_rule_fired: Option<bool>,
    /// Motions after the polynomial factorisation (section 3.3), in the order of [`MotionFit::motions`].
    pub factorisation: Vec<AffineMotion>,
    /// Motions after the nonlinear refinement of (19), in the same order.
    pub refined: Vec<AffineMotion>,
    /// How the refinement ended.
    pub refinement: Report,
}
