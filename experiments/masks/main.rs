//! The mask benchmark: generated scenes and real pairs through the pipeline, beside what OpenCV gives, with an ablation.
//! `npm run bench -- masks` runs it.

mod ablation;
mod figures;
mod honesty;
mod measure;
mod pictures;
mod summary;

use std::fs;
use std::path::PathBuf;

use experiments::masks::cases::{self, Case};
use experiments::masks::outcome::Method;
use experiments::parallel::in_parallel;
use experiments::{Failure, left_out, program};
use figures::Figures;
use serde_json::{Value, json};

const HELP: &str = "\
Scores masks of generated scenes and real pairs against an OpenCV baseline, in two steps. The baseline runs between them.

  frames       writes the frames of the generated cases and prints a line per case: its name, a tab, its folder
  measure      measures and writes masks.json (means), cases.jsonl and a picture of every case

Steps of their own, as npm run bench -- masks --STEP; each writes STEP.json:

  ablation     measures the scores without parts of the pipeline
  calibration  measures how often labels of each confidence are right

  --quick            a subset of the generated cases, no large frames
  --only A,B         only cases whose name or set contains one of these
  --out DIR          output folder; default out/masks
  --shared DIR       folder with further pairs, if it exists; default ../shared
  --write-docs       also write the figures to docs/figures, and docs/masks.md from them
";

struct Options {
    step: String,
    quick: bool,
    only: Vec<String>,
    out: PathBuf,
    shared: PathBuf,
}

fn main() {
    program::start(HELP, options(std::env::args().skip(1)), run);
}

/// What was asked for; `None` where help was.
fn options(mut arguments: impl Iterator<Item = String>) -> Result<Option<Options>, String> {
    let mut options = Options {
        step: String::new(),
        quick: false,
        only: Vec::new(),
        out: PathBuf::from("out/masks"),
        shared: PathBuf::from("../shared"),
    };
    while let Some(name) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{name} needs a value."));
        match name.as_str() {
            "--help" | "-h" => return Ok(None),
            "frames" | "measure" | "ablation" | "calibration" => options.step = name,
            "--quick" => options.quick = true,
            "--only" => options.only = value()?.split(',').map(str::to_owned).collect(),
            "--out" => options.out = PathBuf::from(value()?),
            "--shared" => options.shared = PathBuf::from(value()?),
            _ => return Err(format!("There is no option '{name}'.")),
        }
    }
    match options.step.is_empty() {
        true => Err("Say which step: frames, measure, ablation or calibration.".into()),
        false => Ok(Some(options)),
    }
}

fn run(options: &Options) -> Result<(), Failure> {
    let here = fs::canonicalize(&options.shared).is_ok();
    let mut cases = cases::all(&options.shared, options.quick).map_err(|error| error.to_string())?;
    if !options.only.is_empty() {
        let wanted = |case: &Case| options.only.iter().any(|part| case.name.contains(part) || case.set.name() == part);
        cases.retain(wanted);
    }
    if cases.is_empty() {
        return Err("There is no such case.".into());
    }
    let out = &options.out;
    let cannot = |error: std::io::Error| format!("{} cannot be written: {error}", out.display());
    fs::create_dir_all(out).map_err(cannot)?;
    if options.step == "frames" {
        let folders =
            in_parallel(&cases, |case| Ok(case.folder(&out.join("frames")).map_err(|error| error.to_string())?))?;
        for (case, folder) in cases.iter().zip(folders) {
            println!("{}\t{}", case.name, folder.display());
        }
        return Ok(());
    }
    let write =
        |figures: Value| fs::write(out.join(format!("{}.json", options.step)), figures.to_string()).map_err(cannot);
    if options.step == "ablation" {
        let rows = ablation::measure(cases)?;
        write(json!({ "rows": rows }))?;
        return Ok(left_out::all_change(&rows)?);
    }
    if options.step == "calibration" {
        return Ok(write(honesty::json(&honesty::measure(&cases)?))?);
    }
    if !here {
        eprintln!("{} is not there: only the generated cases are measured.", options.shared.display());
    }
    let measured = measure::all(&cases, &out.join("baseline"))?;
    fs::write(out.join("cases.jsonl"), figures::lines(&measured)?).map_err(cannot)?;
    let figures = serde_json::to_string(&Figures::of(&measured))?;
    fs::write(out.join("masks.json"), figures).map_err(cannot)?;
    for one in &measured {
        fs::write(out.join(format!("{}.png", one.case.name)), &one.picture).map_err(cannot)?;
    }
    if !measured.iter().any(|one| one.of(Method::Baseline).is_some()) {
        eprintln!("There are no figures of the baseline, which did not run.");
    }
    eprintln!("The results are in {}.", out.display());
    Ok(())
}
