//! The paper's experiments: Figure 1 as tables and a plot, Figures 2 and 3 as pictures. Run it with `npm run paper`.

mod figure_1;
mod pictures;
mod plot;

use std::fs;
use std::path::PathBuf;

use experiments::{Failure, program};
use figure_1::{Cell, METHODS};
use pictures::OfPair;
use serde::Serialize;

const HELP: &str = "\
Repeats the paper's experiments with its method and with ours.

  --trials N   trials per noise level of Figure 1, 1 to 100000; default 1000
  --seed N     seed of the trials and of the generated scene, a whole number below 2^32; default 1
  --out DIR    output folder; default out/paper
  --write-docs also write the figures to docs/figures, the plot and the pictures to docs/images, and docs/experiments.md from them
";

struct Options {
    trials: usize,
    seed: u64,
    out: PathBuf,
}

/// Everything that was measured. The errors of a cell are in the order of `methods`.
#[derive(Serialize)]
struct Figures<'a> {
    trials: usize,
    seed: u64,
    methods: [&'static str; METHODS.len()],
    cells: &'a [Cell],
    pairs: &'a [OfPair],
}

fn main() {
    program::start(HELP, options(std::env::args().skip(1)), run);
}

/// The options; `None` if help was requested.
fn options(mut arguments: impl Iterator<Item = String>) -> Result<Option<Options>, String> {
    let mut options = Options { trials: 1000, seed: 1, out: PathBuf::from("out/paper") };
    while let Some(name) = arguments.next() {
        if name == "--help" || name == "-h" {
            return Ok(None);
        }
        if !["--trials", "--seed", "--out"].contains(&name.as_str()) {
            return Err(format!("There is no option '{name}'."));
        }
        let value = arguments.next().ok_or(format!("{name} needs a value."))?;
        let number = |low: u64, high: u64| match value.parse() {
            Ok(number) if (low..=high).contains(&number) => Ok(number),
            _ => Err(format!("{name} must be a whole number from {low} to {high}, not '{value}'.")),
        };
        match name.as_str() {
            "--trials" => options.trials = number(1, 100_000)? as usize,
            "--seed" => options.seed = number(0, u64::from(u32::MAX))?,
            _ => options.out = PathBuf::from(&value),
        }
    }
    Ok(Some(options))
}

fn run(options: &Options) -> Result<(), Failure> {
    let Options { trials, seed, ref out } = *options;
    let cannot = |error: std::io::Error| format!("{} cannot be written: {error}", out.display());
    fs::create_dir_all(out).map_err(cannot)?;
    let (files, pairs) = pictures::pictures(seed)?;
    for (name, file) in files {
        fs::write(out.join(name), file).map_err(cannot)?;
    }
    let cells = figure_1::measure(trials, seed)?;
    fs::write(out.join("figure-1.svg"), plot::svg(&cells)?).map_err(cannot)?;
    let figures = Figures { trials, seed, methods: METHODS, cells: &cells, pairs: &pairs };
    fs::write(out.join("experiments.json"), serde_json::to_string(&figures)?).map_err(cannot)?;
    eprintln!("The results are in {}.", out.display());
    Ok(())
}
