//! Figure 1: the error of the motions as a function of the noise, for two, three and four motions and 600 measurements.
use std::time::Instant;

use experiments::Failure;
use experiments::parallel::in_parallel;
use serde::Serialize;
use veronese_site::{Figure1Trial, TrialError, figure_1_trial};

/// The methods compared, in the order of [`Cell::methods`].
pub(crate) const METHODS: [&str; 4] = ["paper, factorisation", "paper, nonlinear", "ours", "oracle"];

/// A motion with a larger relative error (eq. 20) counts as not found.
const GROSS: f64 = 0.2;

/// Results for one number of motions and one noise level.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Cell {
    /// Number of motions.
    pub(crate) motions: usize,
    /// Half width of the noise, per cent of the length of y.
    pub(crate) noise: usize,
    /// The errors of each of [`METHODS`].
    pub(crate) methods: [Errors; METHODS.len()],
    /// Share of the trials, per cent, in which the number of motions is right: with the paper's rule (12), and with ours.
    pub(crate) count_right: [f64; 2],
}

/// The errors of one method, per cent.
#[derive(Serialize)]
pub(crate) struct Errors {
    /// Mean over the trials of (20).
    pub(crate) mean: f64,
    /// Median over the trials of (20).
    pub(crate) median: f64,
    /// Share of the trials with a motion that is wrong by more than 20 %.
    pub(crate) gross: f64,
}

/// All cells of the figure.
pub(crate) fn measure(trials: usize, seed: u64) -> Result<Vec<Cell>, Failure> {
    let mut cells = Vec::new();
    for motions in [2, 3, 4] {
        for noise in 0..=5 {
            let start = Instant::now();
            // Every trial has its own seed, so results do not depend on the threads.
            let first_seed = (seed << 32) + ((motions * 10 + noise) as u64) * 1_000_000;
            let seeds: Vec<u64> = (0..trials as u64).map(|k| first_seed + k).collect();
            let results: Vec<Figure1Trial> =
                in_parallel(&seeds, |&seed| Ok(figure_1_trial(motions, 0.01 * noise as f64, seed)?))?;
            let seconds = start.elapsed().as_secs_f64();
            eprintln!("Figure 1: {motions} motions, {noise} % noise: {trials} trials in {seconds:.1} s");
            cells.push(summary(motions, noise, &results));
        }
    }
    Ok(cells)
}

/// The errors of the methods, in the order of [`METHODS`].
fn errors(trial: &Figure1Trial) -> [TrialError; METHODS.len()] {
    [trial.factorisation, trial.refined, trial.best, trial.oracle]
}

fn summary(motions: usize, noise: usize, trials: &[Figure1Trial]) -> Cell {
    let share = |right: &dyn Fn(&Figure1Trial) -> bool| {
        100.0 * trials.iter().filter(|trial| right(trial)).count() as f64 / trials.len() as f64
    };
    Cell {
        motions,
        noise,
        methods: std::array::from_fn(|m| {
            let mut means: Vec<f64> = trials.iter().map(|trial| errors(trial)[m].per_cent()).collect();
            means.sort_by(f64::total_cmp);
            Errors {
                mean: means.iter().sum::<f64>() / means.len() as f64,
                median: 0.5 * (means[(means.len() - 1) / 2] + means[means.len() / 2]),
                gross: share(&|trial| errors(trial)[m].largest > GROSS),
            }
        }),
        count_right: [share(&|trial| trial.rule_right), share(&|trial| trial.best_right)],
    }
}
