//! The annotator benchmark: what somebody gets for what he says of a clip. `npm run annotator` runs it.

mod clip;
mod fit;
mod harm;
mod measure;
mod objects;
mod points;
mod session;

use std::fs;
use std::path::PathBuf;

use experiments::clips::cases::{self, Case};
use experiments::parallel::{in_parallel, on_threads};
use experiments::{Failure, program};
use veronese::clip::vary;
use veronese::{ClipModel, Quality};

const HELP: &str = "\
Measures what an annotator gets for what he says of a clip, in steps:

  frames         prints a line per real clip: its name, a tab, its folder
  measure        real clips with masks of one object: a line of figures for each; writes measure.jsonl
  harm           what a true mask of one frame, and rounds of strokes, do to the other frames: the same; writes harm.jsonl
  points         frames of the real clips with a box or clicks: the same; writes points.jsonl
  objects        generated clips with several objects: the same; writes objects.jsonl
  clip           200 frames with 50 strokes: latency, journal and memory; writes clip.jsonl
  fit            fits the constants of the propagation on half of the real clips, reports them on the other half, and vice versa

  --data DIR         folder of the real clips; default ../shared/data/clips
  --only A,B         only clips whose name contains one of these
  --quality Q        fast or best; default best
  --rounds N         rounds of strokes; default 4
  --at K,L           harm: the frames whose true masks are given; default the middle one
  --jobs N           clips at once; default one for each core
  --out DIR          output folder; default out/annotator. Its folder pairs keeps what pairs of frames told
  --set NAME=VALUE   another value of a constant of `ClipModel` in src/model.rs, as often as needed
  --write-docs       also write the figures to docs/figures, and docs/annotating.md from them

npm run annotator -- --page has an expert annotate clips in the page; -- --page --help lists its options
";

#[derive(Clone)]
pub(crate) struct Options {
    step: String,
    data: PathBuf,
    only: Vec<String>,
    pub(crate) quality: Quality,
    pub(crate) rounds: usize,
    pub(crate) at: Vec<usize>,
    jobs: Option<usize>,
    pub(crate) out: PathBuf,
    pub(crate) model: ClipModel,
}

fn main() {
    program::start(HELP, options(std::env::args().skip(1)), run);
}

/// What was asked for; `None` where help was.
fn options(mut arguments: impl Iterator<Item = String>) -> Result<Option<Options>, String> {
    let mut options = Options {
        step: String::new(),
        data: "../shared/data/clips".into(),
        only: Vec::new(),
        quality: Quality::Best,
        rounds: 4,
        at: Vec::new(),
        jobs: None,
        out: "out/annotator".into(),
        model: ClipModel::DEFAULT,
    };
    while let Some(name) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{name} needs a value."));
        let number = |text: String| text.parse().map_err(|_| format!("'{text}' is no number."));
        match name.as_str() {
            "--help" | "-h" => return Ok(None),
            "frames" | "measure" | "harm" | "points" | "objects" | "clip" | "fit" => options.step = name,
            "--data" => options.data = value()?.into(),
            "--only" => options.only = value()?.split(',').map(str::to_owned).collect(),
            "--quality" => {
                options.quality = match value()?.as_str() {
                    "best" => Quality::Best,
                    "fast" => Quality::Fast,
                    other => return Err(format!("There is no quality '{other}'.")),
                };
            }
            "--rounds" => options.rounds = number(value()?)?,
            "--at" => options.at = value()?.split(',').map(|text| number(text.to_owned())).collect::<Result<_, _>>()?,
            "--jobs" => options.jobs = Some(number(value()?)?.max(1)),
            "--out" => options.out = value()?.into(),
            "--set" => set(&mut options.model, &value()?)?,
            _ => return Err(format!("There is no option '{name}'.")),
        }
    }
    match options.step.is_empty() {
        true => Err("Say which step: frames, measure, harm, points, objects, clip or fit.".into()),
        false => Ok(Some(options)),
    }
}

/// Sets a constant as `NAME=VALUE` says.
fn set(model: &mut ClipModel, text: &str) -> Result<(), String> {
    let (name, value) = text.split_once('=').ok_or(format!("--set needs NAME=VALUE, not '{text}'."))?;
    let number = value.parse().map_err(|_| format!("'{value}' is no number."))?;
    if model.set(name, number) { Ok(()) } else { Err(format!("There is no constant '{name}'.")) }
}

fn run(options: &Options) -> Result<(), Failure> {
    fs::create_dir_all(&options.out)?;
    match options.step.as_str() {
        "frames" => {
            for case in options.real()? {
                println!("{}\t{}", case.name, case.folder(&options.out)?.display());
            }
            Ok(())
        }
        "fit" => fit::run(&options.real()?, options),
        "objects" => {
            let cases = options.chosen(objects::cases());
            options.on_all(&cases, |case| objects::measure(case, options)).map(drop)
        }
        "clip" => {
            let rows =
                options.real()?.iter().map(|case| clip::measure(case, options)).collect::<Result<Vec<_>, _>>()?;
            let lines: Vec<String> = rows.iter().map(serde_json::to_string).collect::<Result<_, _>>()?;
            Ok(fs::write(options.out.join("clip.jsonl"), lines.join("\n") + "\n")?)
        }
        "points" => options.on_all(&options.real()?, |case| points::measure(case, options)).map(drop),
        "harm" => {
            let rows = options.on_all(&options.real()?, |case| harm::measure(case, options))?;
            harm::print_summary(&rows.concat());
            Ok(())
        }
        _ => options.on_all(&options.real()?, |case| measure::measure(case, options)).map(drop),
    }
}

impl Options {
    pub(crate) fn quality_name(&self) -> &'static str {
        if self.quality == Quality::Best { "best" } else { "fast" }
    }

    /// Where what the pairs of a clip told is kept.
    pub(crate) fn pairs(&self, case: &Case) -> PathBuf {
        self.out.join("pairs").join(format!("{}-{}", case.name, self.quality_name()))
    }

    /// The real clips asked for.
    fn real(&self) -> Result<Vec<Case>, Failure> {
        if !self.data.is_dir() {
            eprintln!("{} is not there: only generated clips are measured.", self.data.display());
            return Ok(Vec::new());
        }
        Ok(self.chosen(cases::of_folders(&self.data)?))
    }

    fn chosen(&self, mut cases: Vec<Case>) -> Vec<Case> {
        cases.retain(|case| self.only.is_empty() || self.only.iter().any(|part| case.name.contains(part)));
        cases
    }

    /// `work` on all cases; a line of figures for each as soon as it is done, and a file of all.
    fn on_all<T: serde::Serialize + Send>(
        &self,
        cases: &[Case],
        work: impl Fn(&Case) -> Result<T, Failure> + Sync,
    ) -> Result<Vec<T>, Failure> {
        let shown = |case: &Case| {
            vary(self.model);
            let row = work(case).map_err(|error| format!("{}: {error}", case.name))?;
            println!("{}", serde_json::to_string(&row)?);
            Ok(row)
        };
        let rows = match self.jobs {
            Some(jobs) => on_threads(jobs, cases, shown),
            None => in_parallel(cases, shown),
        }?;
        let lines = rows.iter().map(serde_json::to_string).collect::<Result<Vec<_>, _>>()?;
        fs::write(self.out.join(format!("{}.jsonl", self.step)), lines.join("\n"))?;
        Ok(rows)
    }
}
