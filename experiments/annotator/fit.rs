//! Fits the constants of the propagation on half of the clips and reports them on the other half, and the other way round.

use std::path::PathBuf;

use veronese::clip::{propagation_constants, vary_propagation};

use crate::cases::Case;
use crate::measure;
use crate::overlap::mean;
use crate::parallel::in_parallel;
use crate::{Failure, Options};

/// Factors that a constant is tried with, one constant after another.
const FACTORS: [f32; 2] = [1.25, 0.8];
/// Gain of a factor below which the constant stays: chance.
const LEAST: f64 = 0.0005;

/// Mean J of a mask given and of one round of strokes.
fn score(cases: &[&Case], options: &Options, constants: [f32; 10]) -> Result<f64, Failure> {
    let of_clip = |case: &&Case| {
        vary_propagation(constants);
        let row = measure::measure(case, options)?;
        Ok(0.5 * (row.mask + row.rounds[1]))
    };
    Ok(mean(&in_parallel(cases, of_clip)?))
}

/// The constants fitted to some clips, with their score there.
fn fitted(cases: &[&Case], options: &Options) -> Result<([f32; 10], f64), Failure> {
    let mut constants = options.constants;
    let mut best = score(cases, options, constants)?;
    for (k, (name, _)) in propagation_constants().into_iter().enumerate() {
        for factor in FACTORS {
            let mut others = constants;
            // On in the same direction while that helps.
            loop {
                others[k] *= factor;
                let now = score(cases, options, others)?;
                println!("{name} {:.4}: {now:.4}", others[k]);
                if now < best + LEAST {
                    break;
                }
                (best, constants) = (now, others);
            }
        }
    }
    Ok((constants, best))
}

pub(crate) fn run(cases: &[Case], options: &Options) -> Result<(), Failure> {
    let options = Options { rounds: 1, dump: None, out: PathBuf::from(&options.out), ..options.clone() };
    for held_out in 0..2 {
        let fold =
            |own: bool| cases.iter().enumerate().filter(move |(k, _)| (k % 2 == held_out) != own).map(|(_, case)| case);
        let [own, other] = [true, false].map(|own| fold(own).collect::<Vec<_>>());
        let before = [score(&own, &options, options.constants)?, score(&other, &options, options.constants)?];
        let (constants, fitted) = fitted(&own, &options)?;
        let after = score(&other, &options, constants)?;
        println!(
            "\nfitted to {} clips: {:.4} → {fitted:.4}; on the {} others {:.4} → {after:.4}",
            own.len(),
            before[0],
            other.len(),
            before[1]
        );
        for ((name, old), new) in propagation_constants().into_iter().zip(constants) {
            println!("  {name} {old} → {new:.4}");
        }
    }
    Ok(())
}
