//! The annotator benchmark: what somebody gets for what he says of a clip. `npm run bench:annotator` runs it.

#[path = "../clips/cases.rs"]
#[allow(dead_code, reason = "the clip benchmark uses the rest")]
mod cases;
mod dump;
mod measure;
mod objects;
mod overlap;
#[path = "../panels.rs"]
mod panels;
#[path = "../parallel.rs"]
mod parallel;
mod robot;
mod session;
#[path = "../clips/strips.rs"]
mod strips;

use std::error::Error;
use std::fs;
use std::path::PathBuf;

use parallel::{in_parallel, on_threads};
use veronese::Quality;

const HELP: &str = "\
Measures what an annotator gets for what he says of a clip, in steps:

  measure        real clips with masks of one object: a line of figures for each, then means; writes measure.jsonl
  objects        generated clips with several objects: the same; writes objects.jsonl

  --data DIR         folder of the real clips; default ../shared/data/clips
  --only A,B         only clips whose name contains one of these
  --quality Q        fast or best; default best
  --rounds N         rounds of strokes; default 4
  --jobs N           clips at once; default one for each core
  --out DIR          output folder; default out/annotator. Its folder states keeps what was found automatically
  --dump DIR         also write the labels of every stage as indexed images, and strips of small ones
";

pub(crate) type Failure = Box<dyn Error + Send + Sync>;

pub(crate) struct Options {
    step: String,
    data: PathBuf,
    only: Vec<String>,
    pub(crate) quality: Quality,
    pub(crate) rounds: usize,
    jobs: Option<usize>,
    pub(crate) out: PathBuf,
    pub(crate) dump: Option<PathBuf>,
}

fn main() {
    match options(std::env::args().skip(1)).map(|options| options.map(|options| run(&options))) {
        Ok(None) => print!("{HELP}"),
        Ok(Some(Ok(()))) => {}
        Ok(Some(Err(error))) => stop(&error.to_string(), 1),
        Err(message) => stop(&format!("{message}\n\n{HELP}"), 2),
    }
}

fn stop(message: &str, code: i32) {
    eprintln!("{message}");
    std::process::exit(code);
}

/// What was asked for; `None` where help was.
fn options(mut arguments: impl Iterator<Item = String>) -> Result<Option<Options>, String> {
    let mut options = Options {
        step: String::new(),
        data: "../shared/data/clips".into(),
        only: Vec::new(),
        quality: Quality::Best,
        rounds: 4,
        jobs: None,
        out: "out/annotator".into(),
        dump: None,
    };
    while let Some(name) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{name} needs a value."));
        let number = |text: String| text.parse().map_err(|_| format!("'{text}' is no number."));
        match name.as_str() {
            "--help" | "-h" => return Ok(None),
            "measure" | "objects" => options.step = name,
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
            "--jobs" => options.jobs = Some(number(value()?)?.max(1)),
            "--out" => options.out = value()?.into(),
            "--dump" => options.dump = Some(value()?.into()),
            _ => return Err(format!("There is no option '{name}'.")),
        }
    }
    match options.step.is_empty() {
        true => Err("Say which step: measure or objects.".into()),
        false => Ok(Some(options)),
    }
}

fn run(options: &Options) -> Result<(), Failure> {
    fs::create_dir_all(options.out.join("states"))?;
    let table = if options.step == "objects" {
        let cases = options.chosen(objects::cases())?;
        objects::table(&options.on_all(&cases, |case| objects::measure(case, options))?, false)
    } else {
        let cases = options.chosen(cases::of_folders(&options.data)?)?;
        measure::table(&options.on_all(&cases, |case| measure::measure(case, options))?, false)
    };
    print!("\n{table}");
    Ok(())
}

impl Options {
    pub(crate) fn quality_name(&self) -> &'static str {
        if self.quality == Quality::Best { "best" } else { "fast" }
    }

    /// Where what was found automatically in a clip is kept.
    pub(crate) fn state(&self, case: &cases::Case) -> PathBuf {
        self.out.join("states").join(format!("{}-{}", case.name, self.quality_name()))
    }

    fn chosen(&self, mut cases: Vec<cases::Case>) -> Result<Vec<cases::Case>, Failure> {
        cases.retain(|case| self.only.is_empty() || self.only.iter().any(|part| case.name.contains(part)));
        if cases.is_empty() { Err("There is no such clip.".into()) } else { Ok(cases) }
    }

    /// `work` on all cases; a line of figures for each as soon as it is done, and a file of all.
    fn on_all<T: serde::Serialize + Send>(
        &self,
        cases: &[cases::Case],
        work: impl Fn(&cases::Case) -> Result<T, Failure> + Sync,
    ) -> Result<Vec<T>, Failure> {
        let shown = |case: &cases::Case| {
            let row = work(case).map_err(|error| format!("{}: {error}", case.name))?;
            println!("{}", serde_json::to_string(&row)?);
            Ok(row)
        };
        let rows = match self.jobs {
            Some(jobs) => on_threads(jobs, cases, shown),
            None => in_parallel(cases, shown),
        }?;
        let lines = rows.iter().map(serde_json::to_string).collect::<Result<Vec<_>, _>>()?;
        fs::write(self.out.join(format!("{}.jsonl", self.step)), lines.join("\n") + "\n")?;
        Ok(rows)
    }
}
