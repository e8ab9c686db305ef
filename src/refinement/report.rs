//! How an iterative solver ended: a value, never an error.

use serde::Serialize;

/// Why a solver stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
pub enum Termination {
    /// The cost no longer falls by more than the tolerance, or is zero.
    Converged,
    /// No step of any damping lowers the cost: a minimum to rounding, or data that determine nothing.
    Stalled,
    /// The bound of the iterations was reached.
    MaxIterations,
}

/// What an iterative solver did.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Report {
    /// Why it stopped.
    pub termination: Termination,
    /// Accepted steps.
    pub iterations: usize,
    /// Cost at the start.
    pub initial_cost: f64,
    /// Cost at the end, never above the initial one.
    pub final_cost: f64,
}

impl Report {
    /// Whether the solver ended by itself rather than by its bound.
    pub fn was_successful(&self) -> bool {
        self.termination != Termination::MaxIterations
    }
}
