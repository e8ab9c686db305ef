//! Tables beyond the paper's: the estimator beside the statistical limit, and the rank rule.

use std::error::Error;
use std::time::Instant;

use veronese::embedding::EmbeddedData;
use veronese::embedding::monomials::unknowns;
use veronese::embedding::rank::{KAPPA, numerical_rank};
use veronese::stages::protocol::{Problem, Protocol, Relation};
use veronese::{AffineMotion, FitOptions, MotionCount, MotionFit, Random, fit_motions};

use crate::Table;
use crate::synthetic::{self, random_motions};

/// A motion with a larger relative error (eq. 20) counts as not found.
const GROSS: f64 = 0.2;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// The tables by name.
pub(crate) const TABLES: [(&str, Table); 2] = [("limit", limit), ("rank-rule", rank_rule)];

fn fit(problem: &Problem, motions: MotionCount) -> Result<MotionFit> {
    Ok(fit_motions(&problem.measurements, &FitOptions::default().with_motions(motions), &mut |_| {})?)
}

/// A line: the mean errors of the estimator and of the oracle, which knows the true labels.
fn line(name: &str, protocol: &Protocol, trials: usize, seed: u64) -> Result<()> {
    let (mut error, mut of_oracle, mut failures, mut times) = (0.0, 0.0, 0, Vec::new());
    for trial in 0..trials as u64 {
        let problem = protocol.problem(1_000_000 * seed + trial);
        let start = Instant::now();
        let found = fit(&problem, MotionCount::Given(protocol.motions))?;
        times.push(1e3 * start.elapsed().as_secs_f64());
        let motions: Vec<AffineMotion> = found.motions.iter().map(|motion| motion.matrix).collect();
        let (mean, worst) = problem.errors(&motions);
        error += 100.0 * mean / trials as f64;
        of_oracle += 100.0 * problem.errors(&problem.oracle()).0 / trials as f64;
        failures += usize::from(worst > GROSS);
    }
    times.sort_by(f64::total_cmp);
    println!(
        "{name:22} n {}  p {:4.2}  outliers {:.1}  error {error:6.3} %  oracle {of_oracle:6.3} %  ratio {:.3}  \
         failures {failures}/{trials}  {:.2} ms",
        protocol.motions,
        protocol.noise,
        protocol.outliers,
        error / of_oracle,
        times[times.len() / 2]
    );
    Ok(())
}

fn limit(trials: usize, seed: u64) -> Result<()> {
    for noise in [0.02, 0.05] {
        (2..=6).try_for_each(|n| line("general", &Protocol::new(n, noise), trials, seed))?;
    }
    (2..=5).try_for_each(|n| line("outliers", &Protocol { outliers: 0.3, ..Protocol::new(n, 0.02) }, trials, seed))?;
    line("one motion 5 %", &Protocol { first_share: Some(0.05), ..Protocol::new(4, 0.05) }, trials, seed)?;
    for distance in [0.2, 0.1] {
        let near = |n| Protocol { relation: Relation::Near(distance), ..Protocol::new(n, 0.05) };
        (2..=3).try_for_each(|n| line("near", &near(n), trials, seed))?;
    }
    Ok(())
}

/// How often the rank rule finds the number of motions, with raw and with scaled columns. "=" counts numbers that satisfy (12), "<=" the
/// smallest number with a deficient rank.
fn rank_rule(trials: usize, seed: u64) -> Result<()> {
    for n in 1..=4 {
        for noise in [0.0, 0.01, 0.02, 0.05, 0.1] {
            let mut right = [0; 4];
            for trial in 0..trials as u64 {
                let mut random = Random::from_seed(1_000_000 * seed + trial);
                let truth = random_motions(n, &mut random);
                let data = synthetic::measurements(&truth, 600, noise, &mut random).normalised().0;
                let mut found = [0; 4];
                for i in (1..=n + 1).rev() {
                    let embedded = EmbeddedData::new(&data, i);
                    let mut scaled = embedded.triangle().clone();
                    scaled.scale_columns();
                    for (k, values) in [embedded.singular_values(), scaled.singular_values()].into_iter().enumerate() {
                        let rank = numerical_rank(&values.ok_or("no singular values")?, KAPPA);
                        if rank + 1 == unknowns(i) {
                            found[2 * k] = i;
                        }
                        if rank < unknowns(i) {
                            found[2 * k + 1] = i;
                        }
                    }
                }
                right.iter_mut().zip(found).for_each(|(right, found)| *right += usize::from(found == n));
            }
            let [raw, raw_least, scaled, scaled_least] = right;
            println!(
                "n {n} noise {noise}: right of {trials}: raw = {raw}, raw <= {raw_least}, scaled = {scaled}, scaled <= {scaled_least}"
            );
        }
    }
    Ok(())
}
