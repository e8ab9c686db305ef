//! The clip benchmark: labels that persist through time, of generated and real clips, beside what OpenCV gives.
//! `npm run bench -- clips` runs it.

mod ablation;
mod figures;
mod measure;
mod strips;

use std::fs;
use std::path::PathBuf;

use experiments::clips::cases;
use experiments::clips::methods::Method;
use experiments::parallel::in_parallel;
use experiments::{Failure, left_out, program};
use figures::Figures;
use serde_json::json;

const HELP: &str = "\
Scores labels that persist through time, of generated and real clips, in two steps. OpenCV's methods run between them.

  frames       writes the generated clips and prints a line per clip: its name, a tab, its folder
  measure      measures and writes clips.json (means), clips.jsonl, a strip of every clip, and the labels of every method

A step of its own, as npm run bench -- clips --ablation; it writes ablation.json:

  ablation     measures the scores without parts of the way from pairs to objects

  --quick            every fourth generated clip, no real ones
  --only A,B         only clips whose name contains one of these
  --speed S          generated clips alone, at this share of the usual speed
  --methods A,B      only these methods: clip, stream, stream-fast, live, flow, mog2, knn
  --out DIR          output folder; default out/clips
  --pairs DIR        keeps what pairs of the real clips told, as the annotator benchmark does in out/annotator/pairs
  --shared DIR       folder with real clips, if it exists; default ../shared
  --write-docs       also write the figures to docs/figures, and docs/clips.md from them
";

struct Options {
    step: String,
    quick: bool,
    only: Vec<String>,
    speed: Option<f64>,
    methods: Vec<String>,
    out: PathBuf,
    pairs: Option<PathBuf>,
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
        speed: None,
        methods: Vec::new(),
        out: PathBuf::from("out/clips"),
        pairs: None,
        shared: PathBuf::from("../shared"),
    };
    while let Some(name) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{name} needs a value."));
        match name.as_str() {
            "--help" | "-h" => return Ok(None),
            "frames" | "measure" | "ablation" => options.step = name,
            "--quick" => options.quick = true,
            "--methods" => options.methods = value()?.split(',').map(str::to_owned).collect(),
            "--only" => options.only = value()?.split(',').map(str::to_owned).collect(),
            "--speed" => {
                let speed = value()?;
                options.speed = Some(speed.parse().map_err(|_| format!("--speed must be a number, not '{speed}'."))?);
            }
            "--out" => options.out = PathBuf::from(value()?),
            "--pairs" => options.pairs = Some(PathBuf::from(value()?)),
            "--shared" => options.shared = PathBuf::from(value()?),
            _ => return Err(format!("There is no option '{name}'.")),
        }
    }
    match options.step.is_empty() {
        true => Err("Say which step: frames, measure or ablation.".into()),
        false => Ok(Some(options)),
    }
}

fn run(options: &Options) -> Result<(), Failure> {
    let mut cases = match options.speed {
        Some(speed) => cases::generated(speed),
        None => cases::all(&options.shared, options.quick)?,
    };
    if !options.only.is_empty() {
        cases.retain(|case| options.only.iter().any(|part| case.name.contains(part)));
    }
    if cases.is_empty() {
        return Err("There is no such clip.".into());
    }
    let out = &options.out;
    let cannot = |error: std::io::Error| format!("{} cannot be written: {error}", out.display());
    fs::create_dir_all(out).map_err(cannot)?;
    if options.step == "frames" {
        let folders = in_parallel(&cases, |case| case.folder(&out.join("generated")))?;
        for (case, folder) in cases.iter().zip(folders) {
            println!("{}\t{}", case.name, folder.display());
        }
        return Ok(());
    }
    if options.step == "ablation" {
        let rows = ablation::measure(cases)?;
        fs::write(out.join("ablation.json"), serde_json::to_string(&json!({ "rows": rows }))?).map_err(cannot)?;
        return Ok(left_out::all_change(&rows)?);
    }
    if cases.iter().all(cases::Case::is_generated)
        && !options.quick
        && options.speed.is_none()
        && options.only.is_empty()
    {
        eprintln!("{} has no clips: only the generated ones are measured.", options.shared.display());
    }
    let mut methods = Method::ALL.to_vec();
    if !options.methods.is_empty() {
        methods.retain(|method| options.methods.iter().any(|name| name == method.name()));
    }
    if methods.is_empty() {
        return Err("There is no such method.".into());
    }
    let measured = measure::all(&cases, &methods, out, options.pairs.as_deref())?;
    fs::write(out.join("clips.jsonl"), figures::lines(&measured)?).map_err(cannot)?;
    fs::write(out.join("clips.json"), serde_json::to_string(&Figures::of(&measured))?).map_err(cannot)?;
    for one in &measured {
        fs::write(out.join(format!("{}.png", one.case.name)), &one.strip).map_err(cannot)?;
    }
    eprintln!("The results are in {}.", out.display());
    Ok(())
}
