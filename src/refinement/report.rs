//! The report of an iterative solver.

use serde::Serialize;

/// Why a solver stopped.
#[non_exhaustive]
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

impl Termination {
    /// Its name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Termination::Converged => "converged",
            Termination::Stalled => "stalled",
            Termination::MaxIterations => "maxIterations",
        }
    }
}

/// The report of an iterative solver. A solver that stops early is not an error.
///
/// ```
/// use veronese::refinement::{Termination, product};
/// use veronese::{AffineMotion, Measurements};
///
/// // A horizontal and a vertical gradient at each of three positions; all of them move by (0.5, -0.25).
/// let positions = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].repeat(2);
/// let derivatives = (0..6).map(|j| if j < 3 { [2.0, 0.0, -1.0] } else { [0.0, 2.0, 0.5] }).collect();
/// let (_, report) = product::refine(&[AffineMotion::STATIC], &Measurements::new(positions, derivatives)?);
/// assert_eq!((report.termination, report.was_successful()), (Termination::Converged, true));
/// assert!(report.final_cost < report.initial_cost);
/// # Ok::<(), veronese::Error>(())
/// ```
#[non_exhaustive]
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
