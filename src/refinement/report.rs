//! The report of an iterative solver.

use serde::Serialize;

/// Why a solver stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
pub enum Termination {
    /// The last step lowered the cost by less than the tolerance, or the cost is zero.
    Converged,
    /// No damping gives a step that lowers the cost: a minimum to rounding, or data that determine nothing.
    Stalled,
    /// The maximum number of iterations was reached.
    MaxIterations,
}

/// The report of an iterative solver. A solver that stops early is not an error.
///
/// ```
/// use veronese::refinement::{Report, Termination};
///
/// let report = Report { termination: Termination::Stalled, iterations: 3, initial_cost: 2.0, final_cost: 1.0 };
/// assert!(report.was_successful());
/// assert!(!Report { termination: Termination::MaxIterations, ..report }.was_successful());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Report {
    /// Why it stopped.
    pub termination: Termination,
    /// Number of accepted steps.
    pub iterations: usize,
    /// Cost at the start.
    pub initial_cost: f64,
    /// Cost at the end, at most the initial cost.
    pub final_cost: f64,
}

impl Report {
    /// Whether the solver stopped before the maximum number of iterations.
    pub fn was_successful(&self) -> bool {
        self.termination != Termination::MaxIterations
    }
}
