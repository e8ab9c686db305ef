//! The search: one constant after the other is made larger and smaller, and a change is kept where the objective rises by more than its
//! standard error.
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use experiments::Failure;
use experiments::masks::outcome::Method;
use serde::{Deserialize, Serialize};
use veronese::Model;

use crate::change::change;
use crate::measure::{Loaded, Part, Scored, measure};

/// What a constant is multiplied by, first in the first round, then in the second.
const FACTORS: [f64; 2] = [1.5, 1.2];
/// Standard errors that a rise must exceed. Smaller rises are chance, and constants would follow the fold they are fitted to.
const SIGNIFICANT: f64 = 1.0;

/// What is known of a search, as written to disk after every constant.
#[derive(Default, Serialize, Deserialize)]
pub(crate) struct State {
    /// Constants that differ from their default.
    pub(crate) changed: BTreeMap<String, f64>,
    /// How many constants of all rounds have been tried.
    done: usize,
}

/// The model with the constants of a search.
pub(crate) fn model(changed: &BTreeMap<String, f64>) -> Result<Model, String> {
    let mut model = Model::DEFAULT;
    match changed.iter().find(|(name, value)| !model.set(name, **value)) {
        Some((name, _)) => Err(format!("There is no constant {name}.")),
        None => Ok(model),
    }
}

/// The state in a file; a new one where there is none.
pub(crate) fn state(path: &Path) -> Result<State, Failure> {
    match fs::read(path) {
        Ok(bytes) => Ok(serde_json::from_slice(&bytes)?),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(State::default()),
        Err(error) => Err(error.into()),
    }
}

/// Goes on with the search on a fold and the scenes until it is done or the time is over.
pub(crate) fn search(cases: &[Loaded], fold: Part, images: usize, path: &Path, time: Duration) -> Result<(), Failure> {
    let start = Instant::now();
    let mut state = state(path)?;
    let all = Model::NAMES.len() * FACTORS.len();
    let mut best = measure(cases, &model(&state.changed)?, Method::Best, images)?;
    let once = start.elapsed();
    let left = |done: usize| once.mul_f64(2.0 * (all - done) as f64).as_secs() / 60;
    eprintln!(
        "{} cases, {} s each time; about {} minutes for the rest.",
        cases.len(),
        once.as_secs(),
        left(state.done)
    );
    while state.done < all && start.elapsed() < time {
        let name = Model::NAMES[state.done % Model::NAMES.len()];
        let factor = FACTORS[state.done / Model::NAMES.len()];
        if let Some((value, rise, scored)) = better(cases, fold, images, &state.changed, name, factor, &best)? {
            eprintln!("{name} = {value}: {rise:+.4}");
            state.changed.insert(name.to_owned(), value);
            best = scored;
        }
        state.done += 1;
        fs::write(path, serde_json::to_vec_pretty(&state)?)?;
    }
    eprintln!("{} of {all} tried; about {} minutes for the rest.", state.done, left(state.done));
    Ok(())
}

/// A value of one constant that raises the objective significantly: larger or smaller by this factor.
fn better(
    cases: &[Loaded],
    fold: Part,
    images: usize,
    changed: &BTreeMap<String, f64>,
    name: &str,
    factor: f64,
    best: &[Scored],
) -> Result<Option<(f64, f64, Vec<Scored>)>, Failure> {
    let now = model(changed)?;
    let mut found: Option<(f64, f64, Vec<Scored>)> = None;
    for factor in [factor, 1.0 / factor] {
        let mut other = now;
        other.set(name, now.get(name).unwrap_or(0.0) * factor);
        // A small whole number may not have changed.
        if other == now {
            continue;
        }
        let scored = measure(cases, &other, Method::Best, images)?;
        let rise = change(cases, &[fold, Part::Scenes], best, &scored);
        let least = found.as_ref().map_or(0.0, |(_, rise, _)| *rise);
        if rise.mean > least && rise.mean > SIGNIFICANT * rise.error {
            found = Some((other.get(name).unwrap_or(0.0), rise.mean, scored));
        }
    }
    Ok(found)
}
