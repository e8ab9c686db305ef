//! What a caller may choose, checked in one place.

use crate::error::{Error, Result};

/// Largest number of motions (the paper's own limit: n = 10 needs 2430 measurements).
pub const MAX_MOTIONS: usize = 10;

/// How many motions to look for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum MotionCount {
    /// Find the number.
    #[default]
    Auto,
    /// Exactly this many, 1 to [`MAX_MOTIONS`].
    Given(usize),
}

impl MotionCount {
    /// # Errors
    /// [`Error::InvalidOption`] for a number outside 1…10.
    pub fn validate(self) -> Result<()> {
        match self {
            MotionCount::Given(n) if n == 0 || n > MAX_MOTIONS => Err(Error::InvalidOption {
                name: "motions",
                reason: format!("must be 'auto' or a whole number from 1 to {MAX_MOTIONS}, not {n}"),
            }),
            _ => Ok(()),
        }
    }
}

/// Which algorithm solves Problem 1 on points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Method {
    /// The paper's: rank rule, factorisation, nonlinear refinement of (19), labels by the smallest residual.
    Paper,
    /// Ours: algebraic start by differentiation, mixture likelihood, best of many starts.
    #[default]
    Best,
}

/// How much work to spend on an image pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Quality {
    /// For live use.
    Fast,
    /// For keeping.
    #[default]
    Best,
}

/// Options of [`fit_motions`](crate::fit_motions).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FitOptions {
    /// Number of motions; default [`MotionCount::Auto`].
    pub motions: MotionCount,
    /// Algorithm; default [`Method::Best`].
    pub method: Method,
    /// Seed of every random choice; default 1.
    pub seed: u64,
}

impl Default for FitOptions {
    fn default() -> Self {
        FitOptions { motions: MotionCount::Auto, method: Method::Best, seed: 1 }
    }
}

/// Options of [`segment_pair`](crate::segment_pair).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SegmentOptions {
    /// Number of motions; default [`MotionCount::Auto`].
    pub motions: MotionCount,
    /// Work to spend; default [`Quality::Best`].
    pub quality: Quality,
    /// Label 255 where a pixel is hidden or outside in the second frame, where there is no texture around it, and where its label
    /// would more likely be wrong than right; default off.
    pub mark_unknown: bool,
    /// Say for every pixel how sure its label is ([`Segmentation::confidence`](crate::Segmentation::confidence)); default off.
    pub confidence: bool,
    /// Seed of every random choice; default 1.
    pub seed: u64,
}

impl Default for SegmentOptions {
    fn default() -> Self {
        SegmentOptions {
            motions: MotionCount::Auto,
            quality: Quality::Best,
            mark_unknown: false,
            confidence: false,
            seed: 1,
        }
    }
}
