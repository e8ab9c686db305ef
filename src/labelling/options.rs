//! How smooth labels are, and how well they are solved.

use crate::labelling::solver::Solver;

/// The options of a labelling.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LabellingOptions {
    /// λ: penalty of a border between two pixels of equal intensity, in costs.
    pub(crate) smoothness: f32,
    /// Cost of every object pixel: it favours the dominant motion where the data do not decide.
    pub(crate) object_bias: f32,
    /// Solver of the final labels. While motions are still added and removed it is [`Solver::FAST`].
    pub(crate) solver: Solver,
}

#[cfg(test)]
impl LabellingOptions {
    pub(crate) const OF_TESTS: LabellingOptions =
        // As for frames at their original size.
        LabellingOptions { smoothness: 8.0, object_bias: 0.05, solver: Solver::BEST };
}
