//! The mask benchmark: generated scenes and real pairs through the pipeline, beside what OpenCV gives, with an ablation.
//! `npm run bench:masks` runs it.

mod ablation;
#[path = "../boundary.rs"]
mod boundary;
mod cases;
mod honesty;
mod junctions;
mod measure;
mod outcome;
mod page;
#[path = "../panels.rs"]
mod panels;
#[path = "../parallel.rs"]
mod parallel;
mod pictures;
#[path = "../program.rs"]
mod program;
mod scores;
#[path = "../sealed.rs"]
mod sealed;
mod sensitivity;
mod stability;
mod summary;
mod tables;

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use cases::Case;
use outcome::Method;
use parallel::in_parallel;

const HELP: &str = "\
Scores masks of generated scenes and real pairs against an OpenCV baseline, in two steps. The baseline runs between them.

  frames       writes the frames of the generated cases and prints a line per case: its name, a tab, its folder
  measure      measures and writes table.csv, masks.json, masks.md and a picture of every case

Steps of their own, as npm run bench:masks -- --STEP; each writes STEP.json and STEP.md:

  sensitivity  measures what tuned constants change
  stability    measures what alterations of the frames change
  calibration  measures how often labels of each confidence are right
  junctions    measures how often neighbouring motions are one thing

  --quick            a subset of the generated cases, no large frames, no ablation
  --only A,B         only cases whose name or set contains one of these
  --no-ablation      skip the ablation
  --out DIR          output folder; default out/masks
  --shared DIR       folder with further pairs, if it exists; default ../shared
  --write-docs       also write docs/masks.md and docs/images/masks-*.png; a step of its own writes its part of the page
";

struct Options {
    step: String,
    quick: bool,
    only: Vec<String>,
    ablation: bool,
    out: PathBuf,
    shared: PathBuf,
    write_docs: bool,
}

type Failure = Box<dyn Error + Send + Sync>;

fn main() {
    program::start(HELP, options(std::env::args().skip(1)), run);
}

/// What was asked for; `None` where help was.
fn options(mut arguments: impl Iterator<Item = String>) -> Result<Option<Options>, String> {
    let mut options = Options {
        step: String::new(),
        quick: false,
        only: Vec::new(),
        ablation: true,
        out: PathBuf::from("out/masks"),
        shared: PathBuf::from("../shared"),
        write_docs: false,
    };
    while let Some(name) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{name} needs a value."));
        match name.as_str() {
            "--help" | "-h" => return Ok(None),
            "frames" | "measure" | "sensitivity" | "stability" | "calibration" | "junctions" => options.step = name,
            "--quick" => (options.quick, options.ablation) = (true, false),
            "--no-ablation" => options.ablation = false,
            "--write-docs" => options.write_docs = true,
            "--only" => options.only = value()?.split(',').map(str::to_owned).collect(),
            "--out" => options.out = PathBuf::from(value()?),
            "--shared" => options.shared = PathBuf::from(value()?),
            _ => return Err(format!("There is no option '{name}'.")),
        }
    }
    match options.step.is_empty() {
        true => Err("Say which step: frames, measure, sensitivity, stability, calibration or junctions.".into()),
        false => Ok(Some(options)),
    }
}

fn run(options: &Options) -> Result<(), Failure> {
    let here = fs::canonicalize(&options.shared).is_ok();
    let page = fs::read_to_string(docs().join("masks.md"))?;
    let before = match sealed::opened(&page) {
        None if options.write_docs => return Err(sealed::changed("docs/masks.md", "experiments/masks").into()),
        text => text.unwrap_or(&page),
    };
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
    match options.step.as_str() {
        "sensitivity" => {
            let measured = sensitivity::measure(&sensitivity::chosen(cases))?;
            return write_apart(options, before, &sensitivity::json(&measured), &sensitivity::table(&measured));
        }
        "stability" => {
            let compared = stability::measure(&cases)?;
            return write_apart(options, before, &stability::json(&compared), &stability::text(&compared));
        }
        "calibration" => {
            let measured = honesty::measure(&cases)?;
            return write_apart(options, before, &honesty::json(&measured), &honesty::text(&measured));
        }
        "junctions" => {
            let measured = junctions::measure(&cases)?;
            return write_apart(options, before, &junctions::json(&measured), &junctions::text(&measured));
        }
        _ => {}
    }
    if !here {
        eprintln!("{} is not there: only the generated cases are measured.", options.shared.display());
    }
    let variants = if options.ablation { ablation::variants() } else { Vec::new() };
    let measured = measure::all(&cases, &out.join("baseline"), &variants, ablation::takes_part)?;
    let worths = ablation::worths(&measured);
    fs::write(out.join("table.csv"), tables::csv(&measured)).map_err(cannot)?;
    let json = serde_json::to_string_pretty(&tables::all(&measured, &worths))?;
    fs::write(out.join("masks.json"), json).map_err(cannot)?;
    for one in &measured {
        fs::write(out.join(format!("{}.png", one.case.name)), &one.picture).map_err(cannot)?;
    }
    let page = page::Page { measured: &measured, worths: &worths, reasons: reasons()?, before };
    fs::write(out.join("masks.md"), page.text("")).map_err(cannot)?;
    if options.write_docs {
        write_docs(&page)?;
    }
    if !measured.iter().any(|one| one.of(Method::Baseline).is_some()) {
        eprintln!("There are no figures of the baseline, which did not run.");
    }
    eprintln!("The results are in {}.", out.display());
    Ok(())
}

/// Writes what a step of its own has measured.
fn write_apart(options: &Options, before: &str, json: &serde_json::Value, text: &str) -> Result<(), Failure> {
    let Options { step, out, write_docs, .. } = options;
    fs::write(out.join(format!("{step}.json")), serde_json::to_string_pretty(json)?)?;
    fs::write(out.join(format!("{step}.md")), text)?;
    if *write_docs {
        let page = page::with_text(before, step, text);
        let page = page.ok_or(format!("docs/masks.md has no part for the {step}"))?;
        fs::write(docs().join("masks.md"), sealed::sealed(&page))?;
    }
    eprintln!("The results are in {}.", out.display());
    Ok(())
}

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

/// Why cases come out as they do, written by hand, by the name of the case.
fn reasons() -> Result<serde_json::Map<String, serde_json::Value>, Failure> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/masks/reasons.json");
    let text = fs::read_to_string(&path).map_err(|error| format!("{} cannot be read: {error}", path.display()))?;
    Ok(serde_json::from_str(&text)?)
}

/// The page and its pictures; pictures that it no longer shows go away.
fn write_docs(page: &page::Page<'_>) -> Result<(), Failure> {
    let docs = docs();
    let images = docs.join("images");
    for entry in fs::read_dir(&images)? {
        let entry = entry?;
        if entry.file_name().to_string_lossy().starts_with("masks-") {
            fs::remove_file(entry.path())?;
        }
    }
    for one in page.shown() {
        fs::write(images.join(format!("masks-{}.png", one.case.name)), &one.picture)?;
    }
    fs::write(docs.join("masks.md"), sealed::sealed(&page.text("images/masks-")))?;
    Ok(())
}
