//! The annotator benchmark: what somebody gets for what he says of a clip. `npm run bench:annotator` runs it.

mod automatic;
#[path = "../boundary.rs"]
mod boundary;
#[path = "../clips/cases.rs"]
#[allow(dead_code, reason = "the clip benchmark uses the rest")]
mod cases;
mod dump;
mod fit;
mod measure;
mod objects;
mod overlap;
mod page;
mod pairs;
#[path = "../panels.rs"]
mod panels;
#[path = "../parallel.rs"]
mod parallel;
#[path = "../clips/parts.rs"]
#[allow(dead_code, reason = "the clip benchmark uses the rest")]
mod parts;
#[path = "../program.rs"]
mod program;
mod robot;
#[path = "../clips/scores.rs"]
#[allow(dead_code, reason = "the clip benchmark uses the rest")]
mod scores;
#[path = "../sealed.rs"]
mod sealed;
mod session;
#[path = "../clips/strips.rs"]
mod strips;

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use cases::Case;
use parallel::{in_parallel, on_threads};
use veronese::clip::vary;
use veronese::{ClipModel, Quality};

const HELP: &str = "\
Measures what an annotator gets for what he says of a clip, in steps:

  frames         prints a line per real clip: its name, a tab, its folder
  measure        real clips with masks of one object: a line of figures for each, then means; writes measure.jsonl
  objects        generated clips with several objects: the same; writes objects.jsonl
  automatic      real clips when nothing is said, also without parts of the clip segmenter; writes automatic.jsonl
  pairs          pairs of frames of the real clips with strokes: the same; writes pairs.jsonl
  page           writes annotating.md from these figures
  fit            fits the constants of the propagation on half of the real clips, reports them on the other half, and vice versa

  --data DIR         folder of the real clips; default ../shared/data/clips
  --only A,B         only clips whose name contains one of these
  --quality Q        fast or best; default best
  --rounds N         rounds of strokes; default 4
  --jobs N           clips at once; default one for each core
  --out DIR          output folder; default out/annotator. Its folder pairs keeps what pairs of frames told
  --dump DIR         also write the labels of every stage as indexed images, and strips of small ones
  --set NAME=VALUE   another value of a constant of `ClipModel` in src/model.rs, as often as needed
  --without A,B      parts that automatic leaves out by turns: both-directions, carrying, colours, second-round, grouping
  --generated        automatic measures the generated clips of npm run bench:clips
  --write-docs       also write docs/annotating.md

npm run bench:annotator -- --page has an expert annotate clips in the page; -- --page --help lists its options
";

pub(crate) type Failure = Box<dyn Error + Send + Sync>;

#[derive(Clone)]
pub(crate) struct Options {
    step: String,
    data: PathBuf,
    only: Vec<String>,
    pub(crate) quality: Quality,
    pub(crate) rounds: usize,
    jobs: Option<usize>,
    pub(crate) out: PathBuf,
    pub(crate) dump: Option<PathBuf>,
    pub(crate) without: Vec<String>,
    generated: bool,
    write_docs: bool,
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
        jobs: None,
        out: "out/annotator".into(),
        dump: None,
        without: Vec::new(),
        generated: false,
        write_docs: false,
        model: ClipModel::DEFAULT,
    };
    while let Some(name) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{name} needs a value."));
        let number = |text: String| text.parse().map_err(|_| format!("'{text}' is no number."));
        match name.as_str() {
            "--help" | "-h" => return Ok(None),
            "frames" | "measure" | "automatic" | "objects" | "pairs" | "page" | "fit" => options.step = name,
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
            "--set" => parts::set(&mut options.model, &value()?)?,
            "--without" => {
                options.without = value()?.split(',').map(str::to_owned).collect();
                options.without.iter().try_for_each(|name| automatic::part(name).map(|_| ()))?;
            }
            "--generated" => options.generated = true,
            "--write-docs" => options.write_docs = true,
            "--dump" => options.dump = Some(value()?.into()),
            _ => return Err(format!("There is no option '{name}'.")),
        }
    }
    match options.step.is_empty() {
        true => Err("Say which step: frames, measure, automatic, objects, pairs, page or fit.".into()),
        false => Ok(Some(options)),
    }
}

fn run(options: &Options) -> Result<(), Failure> {
    if options.write_docs {
        if !options.only.is_empty() {
            return Err("docs/annotating.md has all clips: --only and --write-docs exclude each other.".into());
        }
        let kept = fs::read_to_string(docs());
        if kept.is_ok_and(|page| sealed::opened(&page).is_none()) {
            return Err(sealed::changed("docs/annotating.md", "experiments/annotator").into());
        }
    }
    fs::create_dir_all(&options.out)?;
    let table = match options.step.as_str() {
        "frames" => {
            for case in options.real()? {
                println!("{}\t{}", case.name, case.folder(&options.out)?.display());
            }
            return Ok(());
        }
        "page" => return write_page(options),
        "fit" => return fit::run(&options.real()?, options),
        "automatic" => {
            let cases = if options.generated { options.chosen(cases::generated()) } else { options.real()? };
            automatic::table(&options.on_all(&cases, |case| automatic::measure(case, options))?)
        }
        "objects" => {
            let cases = options.chosen(objects::cases());
            objects::table(&options.on_all(&cases, |case| objects::measure(case, options))?, false)
        }
        "pairs" => pairs::table(&options.on_all(&options.real()?, |case| pairs::measure(case, options))?),
        _ => measure::table(&options.on_all(&options.real()?, |case| measure::measure(case, options))?, false),
    };
    print!("\n{table}");
    Ok(())
}

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/annotating.md")
}

fn write_page(options: &Options) -> Result<(), Failure> {
    let (real, generated) = (rows::<measure::Row>(options, "measure")?, rows::<objects::Row>(options, "objects")?);
    let strokes = rows::<pairs::Row>(options, "pairs")?;
    let fit = fs::read_to_string(options.out.join("fit.md")).ok();
    let before = fs::read_to_string(docs()).unwrap_or_default();
    let text = sealed::sealed(&page::text(&real, &generated, &strokes, fit.as_deref(), &before));
    fs::write(options.out.join("annotating.md"), &text)?;
    if options.write_docs {
        if real.is_empty() || generated.len() < objects::cases().len() {
            return Err("docs/annotating.md has all clips: measure them before.".into());
        }
        fs::write(docs(), &text)?;
    }
    Ok(())
}

/// The figures that a step has left.
fn rows<T: serde::de::DeserializeOwned>(options: &Options, step: &str) -> Result<Vec<T>, Failure> {
    let file = options.out.join(format!("{step}.jsonl"));
    let text = fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
    Ok(text.lines().map(serde_json::from_str).collect::<Result<_, _>>()?)
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
