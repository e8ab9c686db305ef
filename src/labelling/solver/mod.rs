//! Minimisation of the labelling energy of [`Potts`].
//!
//! Finding the minimum is NP-hard from three labels on, so there are two solvers with different strengths:
//! [`Solver::Messages`] (tree-reweighted message passing) is the faster one and knows a lower bound of the energy;
//! [`Solver::Expansion`] (α-expansion by minimum cuts) is exact for two labels and comes nearest with more.
//!
//! On generated scenes, 320×240 pixels, four labels (the ignored test `energies_and_times`): [`Solver::FAST`] is 0.1 % above
//! the bound, twenty iterations 0.02 %, α-expansion 0.00 % in about twice their time, and all three mislabel the same number
//! of pixels, because of the costs. Two iterations without the pyramid are 1 % above and mislabel more.

mod expansion;
mod max_flow;
mod messages;
pub(crate) mod potts;

use crate::workspace::Buffer;
use potts::Potts;

/// How to minimise the energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Solver {
    /// Sequential tree-reweighted message passing, at most `iterations` on each of `levels` levels of a pyramid (1: the
    /// grid alone). A few iterations on several levels are cheap, many iterations come close to the optimum.
    Messages { levels: usize, iterations: usize },
    /// α-expansion, at most `sweeps` times over all labels.
    Expansion { sweeps: usize },
}

impl Solver {
    /// For interactive use.
    pub(crate) const FAST: Solver = Solver::Messages { levels: 4, iterations: 2 };
    /// For problems that are nearly decided.
    pub(crate) const LIGHT: Solver = Solver::Messages { levels: 4, iterations: 1 };
    /// For final results.
    pub(crate) const BEST: Solver = Solver::Messages { levels: 4, iterations: 10 };
}

/// Minimises the energy; returns one label per pixel, row by row. With `init`, [`Solver::Expansion`] starts there, and no solver
/// returns labels of higher energy. Up to 255 labels; more than 16 are always solved by expansion.
pub(crate) fn minimise(problem: &Potts<'_>, solver: Solver, init: Option<&[u8]>) -> Buffer<u8> {
    let labels = problem.costs.len();
    let size = problem.width() * problem.height();
    if labels < 2 || size == 0 {
        return Buffer::filled(size, 0);
    }
    let init = init.filter(|l| l.len() == size && l.iter().all(|&l| usize::from(l) < labels));
    let found = match solver {
        Solver::Messages { levels, iterations } if labels <= messages::MAX_LABELS => {
            messages::minimise(problem, levels, iterations).labels
        }
        Solver::Messages { .. } => expansion::minimise(problem, 3, init),
        Solver::Expansion { sweeps } => expansion::minimise(problem, sweeps, init),
    };
    match init {
        Some(init) if problem.energy(init) < problem.energy(&found) => Buffer::of(init),
        _ => found,
    }
}

#[cfg(test)]
mod tests;
