//! The measurement by which changes are judged: a fixed choice of pairs, scenes and clips, scored in some minutes and compared with
//! the figures that are kept. `npm run score` runs it, and the expectations after it.

mod cases;

use std::fs;
use std::path::PathBuf;
use std::time::Instant;

use experiments::parallel::in_parallel;
use experiments::score::report::{self, Entry};
use experiments::{Failure, program};

const HELP: &str = "\
Scores a fixed choice of pairs, generated scenes and clips, writes out/score.json and says what changed since experiments/score.json.

  --save         write the figures to experiments/score.json instead of comparing with it
  --only A,B     only cases whose name or row contains one of these
  --file FILE    another file to compare with, or to write
  --shared DIR   folder with real pairs and clips, if it exists; default ../shared
";

const KEPT: &str = "experiments/score.json";

struct Options {
    save: bool,
    only: Vec<String>,
    file: PathBuf,
    shared: PathBuf,
}

fn main() {
    program::start(HELP, options(std::env::args().skip(1)), run);
}

/// The options; `None` for help.
fn options(mut arguments: impl Iterator<Item = String>) -> Result<Option<Options>, String> {
    let mut options = Options { save: false, only: Vec::new(), file: KEPT.into(), shared: "../shared".into() };
    while let Some(name) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{name} needs a value."));
        match name.as_str() {
            "--help" | "-h" => return Ok(None),
            "--save" => options.save = true,
            "--only" => options.only = value()?.split(',').map(str::to_owned).collect(),
            "--file" => options.file = value()?.into(),
            "--shared" => options.shared = value()?.into(),
            _ => return Err(format!("There is no option '{name}'.")),
        }
    }
    Ok(Some(options))
}

fn run(options: &Options) -> Result<(), Failure> {
    let start = Instant::now();
    let (mut jobs, missing) = cases::jobs(&options.shared)?;
    let folder = options.shared.join("data");
    if !folder.is_dir() {
        eprintln!("{} is not there: only generated scenes are measured.", folder.display());
    } else if !missing.is_empty() {
        eprintln!(
            "{} does not have everything that is measured: {} are missing.",
            folder.display(),
            missing.join(", ")
        );
    }
    if !options.only.is_empty() {
        jobs.retain(|job| options.only.iter().any(|part| job.name().contains(part) || job.part().contains(part)));
    }
    if jobs.is_empty() {
        return Err("There is no such case.".into());
    }
    if options.save && options.file.as_os_str() == KEPT && !(missing.is_empty() && options.only.is_empty()) {
        return Err(
            format!("{KEPT} has the figures of all cases: a part of them can be saved in another --file.").into()
        );
    }
    let mut entries = in_parallel(&jobs, |job| {
        let entry = job.measure()?;
        eprintln!("{}, {}: J {:.3}", entry.case, entry.quality, entry.j.unwrap_or(f64::NAN));
        Ok(entry)
    })?;
    entries.sort_by_key(order);
    let text = report::file(&entries)?;
    fs::create_dir_all("out")?;
    fs::write("out/score.json", &text)?;
    print!("\n{}", report::table(&entries));
    println!("\nMeans with 95 % intervals (bootstrap over sequences). J of scenes is the mean IoU.\n");
    if options.save {
        fs::write(&options.file, &text)?;
        println!("Saved in {}.", options.file.display());
    } else {
        match fs::read_to_string(&options.file) {
            Ok(kept) => {
                let kept: Vec<Entry> = serde_json::from_str(&kept)
                    .map_err(|error| format!("{} is no file of figures: {error}", options.file.display()))?;
                print!("Since {}:\n\n{}", options.file.display(), report::changes(&kept, &entries));
            }
            Err(error) => println!("Nothing to compare with: {}: {error}.", options.file.display()),
        }
    }
    eprintln!("\n{} results in {:.0} s.", entries.len(), start.elapsed().as_secs_f64());
    Ok(())
}

/// Pairs, then scenes, then clips; within a row as measured.
fn order(entry: &Entry) -> (usize, String, String) {
    let kinds = ["pairs", "scenes", "clips"];
    let kind = kinds.iter().position(|kind| entry.part.starts_with(kind)).unwrap_or(kinds.len());
    (kind, entry.part.clone(), entry.quality.clone())
}
