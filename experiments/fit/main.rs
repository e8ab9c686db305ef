//! The fit: constants of the pipeline tried, searched for on one half of the real sequences, and reported on the other. `npm run fit`
//! runs it.

mod change;
mod measure;
mod report;
mod search;

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::time::Duration;

use experiments::masks::outcome::Method;
use experiments::{Failure, program};
use measure::Part;

const HELP: &str = "\
Fits the constants of src/model.rs. The 30 sequences of real pairs beside the project are two folds: every other sequence is A, the rest B.

  try NAME=VALUE[,NAME=VALUE…] …   what the scores change by with these constants; one row for each argument
  search                           searches on a fold and on generated scenes; goes on where it was stopped
  report                           the scores of what was found on one fold, on the other one; constants that both searches changed

  --fold A|B         the fold to search on; default A
  --minutes N        the search stops after so long; default 60
  --all              all pairs of a sequence; otherwise a third of them
  --mirrored         the mean over the four mirror images of each case, which tells smaller changes from chance
  --quality Q        try with best, fast or both; default both
  --subject          the main subject of each pair
  --out DIR          folder of what was found; default out/fit
  --shared DIR       folder with the pairs; default ../shared
";

struct Options {
    step: String,
    tried: Vec<BTreeMap<String, f64>>,
    fold: Part,
    time: Duration,
    whole: bool,
    images: usize,
    methods: Vec<Method>,
    subject: bool,
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
        tried: Vec::new(),
        fold: Part::A,
        time: Duration::from_secs(3600),
        whole: false,
        images: 1,
        methods: vec![Method::Best, Method::Fast],
        subject: false,
        out: PathBuf::from("out/fit"),
        shared: PathBuf::from("../shared"),
    };
    while let Some(name) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{name} needs a value."));
        match name.as_str() {
            "--help" | "-h" => return Ok(None),
            "--fold" => options.fold = fold(&value()?)?,
            "--minutes" => {
                let minutes: u64 = value()?.parse().map_err(|_| "--minutes needs a whole number.")?;
                options.time = Duration::from_secs(60 * minutes);
            }
            "--all" => options.whole = true,
            "--mirrored" => options.images = 4,
            "--quality" => options.methods = methods(&value()?)?,
            "--subject" => options.subject = true,
            "--out" => options.out = PathBuf::from(value()?),
            "--shared" => options.shared = PathBuf::from(value()?),
            "try" | "search" | "report" if options.step.is_empty() => options.step = name,
            _ if options.step == "try" && !name.starts_with('-') => options.tried.push(constants(&name)?),
            _ => return Err(format!("There is no option '{name}'.")),
        }
    }
    match options.step.is_empty() {
        true => Err("Say which step: try, search or report.".into()),
        false => Ok(Some(options)),
    }
}

fn fold(name: &str) -> Result<Part, String> {
    let named = Part::ALL.into_iter().find(|part| part.is_fold() && part.name() == name);
    named.ok_or(format!("There is no fold '{name}'."))
}

fn methods(name: &str) -> Result<Vec<Method>, String> {
    match name {
        "best" => Ok(vec![Method::Best]),
        "fast" => Ok(vec![Method::Fast]),
        "both" => Ok(vec![Method::Best, Method::Fast]),
        _ => Err(format!("There is no quality '{name}'.")),
    }
}

/// Constants in the form `name=value,name=value`.
fn constants(text: &str) -> Result<BTreeMap<String, f64>, String> {
    let parsed = |one: &str| {
        let (name, value) = one.split_once('=')?;
        Some((name.to_owned(), value.parse().ok()?))
    };
    text.split(',').map(|one| parsed(one).ok_or(format!("'{one}' is not NAME=VALUE."))).collect()
}

fn run(options: &Options) -> Result<(), Failure> {
    let path = |fold: Part| options.out.join(format!("{}.json", fold.name()));
    let load = |parts: &[Part]| measure::load(&options.shared, parts, options.whole, options.subject);
    let images = options.images;
    match options.step.as_str() {
        "try" => report::tried(&load(&Part::ALL)?, &options.tried, &options.methods, images),
        "search" => {
            fs::create_dir_all(&options.out)?;
            search::search(
                &load(&[options.fold, Part::Scenes])?,
                options.fold,
                images,
                &path(options.fold),
                options.time,
            )
        }
        _ => report::held_out(&load(&Part::ALL)?, images, [Part::A, Part::B].map(|fold| (fold, path(fold)))),
    }
}
