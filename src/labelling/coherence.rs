//! How labels hold together, and how well they are solved.

use crate::labelling::solver::Solver;

/// The smoothness of labels, and how they are solved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coherence {
    /// λ: price of a border between two pixels of equal intensity, in costs.
    pub(crate) smoothness: f32,
    /// Price of every object pixel: it favours the dominant motion where the data cannot tell.
    pub(crate) object_bias: f32,
    /// Solver while motions are still added and removed.
    pub(crate) draft_solver: Solver,
    /// Solver of the final labels.
    pub(crate) solver: Solver,
    /// Solver that starts from the labels of a coarser level.
    pub(crate) sharpening: Solver,
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) const COHERENCE: Coherence = Coherence {
        smoothness: 8.0,
        object_bias: 0.05,
        draft_solver: Solver::FAST,
        solver: Solver::BEST,
        sharpening: Solver::FAST,
    };
}
