//! Figure 1 of the paper with protocol B1: mean and median errors of factorisation, refinement and differentiation. It prints
//! measurements: `cargo test --test figure_1 -- --ignored --nocapture`.
#![allow(clippy::unwrap_used, reason = "test code may panic")]
#![cfg(not(target_arch = "wasm32"))]

mod synthetic;

use synthetic::{Protocol, errors, random_motions};
use veronese::factorisation::choose;
use veronese::factorisation::differentiation::{POINTS, algebraic_start};
use veronese::paper::paper_fit;
use veronese::{AffineMotion, Measurements, MotionCount, Random};

const TRIALS: usize = 200;

#[test]
#[ignore = "takes half a minute and prints a table"]
fn figure_1() {
    println!("mean / median error of (20), % [share of trials with a motion wrong by more than 20 %]");
    for n in 2..=4 {
        for noise in [0.01, 0.05] {
            let mut random = Random::from_seed(1000 + n as u64);
            let mut columns = [const { Vec::new() }; 3];
            for _ in 0..TRIALS {
                let truth = random_motions(n, &mut random);
                let data = Protocol::B1.measurements(&truth, 600, noise, &mut random);
                let fit = paper_fit(&data, MotionCount::Given(n), &mut |_| {}).unwrap();
                columns[0].push(errors(&truth, &fit.factorisation));
                columns[1].push(errors(&truth, &fit.refined));
                columns[2].push(errors(&truth, &by_differentiation(&data, n, &mut random)));
            }
            println!(
                "n {n} noise {noise}: factorisation {}, refined {}, differentiation {}",
                summary(&columns[0]),
                summary(&columns[1]),
                summary(&columns[2])
            );
        }
    }
}

fn by_differentiation(data: &Measurements, n: usize, random: &mut Random) -> Vec<AffineMotion> {
    let (normalised, normalisation) = data.normalised();
    let pool = algebraic_start(&normalised, n, random, POINTS).unwrap();
    let choice = choose(&pool, &normalised, n, f64::INFINITY);
    choice.indices.iter().map(|&k| normalisation.restore(&pool[k])).collect()
}

fn summary(trials: &[Vec<f64>]) -> String {
    let mut means: Vec<f64> = trials.iter().map(|e| 100.0 * e.iter().sum::<f64>() / e.len() as f64).collect();
    means.sort_by(f64::total_cmp);
    let failed = trials.iter().filter(|e| e.iter().any(|e| *e > 0.2)).count();
    let mean = means.iter().sum::<f64>() / means.len() as f64;
    format!("{mean:.3}/{:.3} [{:.1}]", means[means.len() / 2], 100.0 * failed as f64 / means.len() as f64)
}

/// How often the rank rule finds the number of motions, with raw and with scaled columns. "=" counts numbers that satisfy (12), "<=" the
/// smallest number with a deficient rank.
#[test]
#[ignore = "takes ten seconds and prints a table"]
fn rank_rule() {
    use veronese::embedding::EmbeddedData;
    use veronese::embedding::monomials::unknowns;
    use veronese::embedding::rank::{KAPPA, numerical_rank};
    for n in 1..=4 {
        for noise in [0.0, 0.01, 0.02, 0.05, 0.1] {
            let mut right = [0; 4];
            for seed in 0..40 {
                let mut random = Random::from_seed(seed);
                let truth = random_motions(n, &mut random);
                let data = Protocol::B1.measurements(&truth, 600, noise, &mut random).normalised().0;
                let mut found = [0; 4];
                for i in (1..=n + 1).rev() {
                    let embedded = EmbeddedData::new(&data, i);
                    let mut scaled = embedded.triangle().clone();
                    scaled.scale_columns();
                    for (k, values) in [embedded.singular_values(), scaled.singular_values()].into_iter().enumerate() {
                        let rank = numerical_rank(&values.unwrap(), KAPPA);
                        if rank + 1 == unknowns(i) {
                            found[2 * k] = i;
                        }
                        if rank < unknowns(i) {
                            found[2 * k + 1] = i;
                        }
                    }
                }
                for k in 0..4 {
                    right[k] += usize::from(found[k] == n);
                }
            }
            println!(
                "n {n} noise {noise}: right of 40: raw = {}, raw <= {}, scaled = {}, scaled <= {}",
                right[0], right[1], right[2], right[3]
            );
        }
    }
}
