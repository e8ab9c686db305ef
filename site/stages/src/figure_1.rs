//! One trial of the paper's Figure 1: how far each method is from the true motions.

use crate::within;
use scenes::protocol::{Problem, Protocol};
use veronese::embedding::rank::{MAX_TRIED, number_of_motions};
use veronese::paper::paper_fit;
use veronese::{AffineMotion, FitOptions, MotionCount, Result, fit_motions};

/// Largest noise in the figure.
const MOST_NOISE: f64 = 0.05;

/// The result of [`figure_1_trial`].
#[derive(Clone, Debug, PartialEq)]
pub struct Figure1Trial {
    /// The true motions.
    pub truth: Vec<AffineMotion>,
    /// The error of the paper's factorisation.
    pub factorisation: TrialError,
    /// The error of the paper's nonlinear refinement.
    pub refined: TrialError,
    /// The error of [`Method::Best`](veronese::Method::Best).
    pub best: TrialError,
    /// The error of the least squares estimate that knows the true labels.
    pub oracle: TrialError,
    /// Whether the rank rule (12) finds the number of motions.
    pub rule_right: bool,
    /// Whether [`Method::Best`](veronese::Method::Best) finds it.
    pub best_right: bool,
}

/// Relative errors (20) of the motions of one method under the best assignment; infinite if it finds none or another number of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrialError {
    /// The mean over the motions.
    pub mean: f64,
    /// The largest.
    pub largest: f64,
}

/// A trial of Figure 1 for 2 to 4 motions and noise from 0 to 0.05: 600 measurements by [`Protocol`].
///
/// # Errors
/// [`Error::InvalidOption`](veronese::Error::InvalidOption) for `motions` or `noise` out of range.
pub fn figure_1_trial(motions: usize, noise: f64, seed: u64) -> Result<Figure1Trial> {
    within("motions", motions, [2, 4])?;
    within("noise", noise, [0.0, MOST_NOISE])?;
    let problem = Protocol::new(motions, noise).problem(seed);
    let data = &problem.measurements;
    let paper = paper_fit(data, MotionCount::Given(motions), &mut |_| {}).ok();
    let given = FitOptions::default().with_motions(MotionCount::Given(motions));
    let ours = fit_motions(data, &given, &mut |_| {}).ok();
    let rule = number_of_motions(&data.normalised().0, MAX_TRIED).ok();
    let count = fit_motions(data, &FitOptions::default(), &mut |_| {}).ok();
    let ours = ours.map(|fit| fit.motions.iter().map(|motion| motion.matrix).collect());
    Ok(Figure1Trial {
        factorisation: error(&problem, paper.as_ref().map(|fit| fit.factorisation.clone())),
        refined: error(&problem, paper.map(|fit| fit.refined)),
        best: error(&problem, ours),
        oracle: error(&problem, Some(problem.oracle())),
        rule_right: rule.is_some_and(|rule| rule.motions == motions),
        best_right: count.is_some_and(|fit| fit.count == motions),
        truth: problem.motions,
    })
}

impl TrialError {
    /// The mean in per cent.
    pub fn per_cent(self) -> f64 {
        100.0 * self.mean
    }
}

fn error(problem: &Problem, found: Option<Vec<AffineMotion>>) -> TrialError {
    let (mean, largest) = problem.errors(&found.unwrap_or_default());
    TrialError { mean, largest }
}
