//! The sensitivity: the same cases with one tuned constant made smaller or larger by half.

use serde::Serialize;
use serde_json::{Value, json};
use veronese::Model;

use crate::Failure;
use crate::cases::{Case, Set, a_third};
use crate::outcome::{Method, Outcome, Variant, of_variant};
use crate::parallel::in_parallel;
use crate::scores::Scores;

/// What a constant is multiplied by.
const FACTORS: [f64; 2] = [0.5, 1.5];
/// With *best* it would take hours; nearly all constants are those of both qualities.
const QUALITY: Method = Method::Fast;

/// A figure of a table, on the sets it is computed on.
struct Column {
    title: &'static str,
    sets: &'static [Set],
    figure: fn(&Outcome) -> Option<f64>,
}

const COLUMNS: [Column; 5] = [
    Column { title: "J", sets: &[Set::Sequences], figure: |o| grouped(o)?.j_background },
    Column { title: "J by hand", sets: &[Set::Sequences], figure: |o| single(o)?.j_oracle },
    Column { title: "F", sets: &[Set::Sequences], figure: |o| grouped(o)?.boundary },
    Column { title: "mean IoU", sets: &[Set::Generated, Set::Colour], figure: |o| Some(single(o)?.miou) },
    Column { title: "mean IoU, bare ground", sets: &[Set::Bare], figure: |o| Some(single(o)?.miou) },
];

fn single(outcome: &Outcome) -> Option<&Scores> {
    outcome.single.as_ref()
}

fn grouped(outcome: &Outcome) -> Option<&Scores> {
    outcome.grouped.as_ref()
}

/// A case with the outcomes of the pipeline as it is, then of every constant with every factor.
pub(crate) struct Varied {
    case: Case,
    outcomes: Vec<Outcome>,
}

/// The cases that are measured: generated scenes, those with a bare ground, and a third of the pairs of every sequence.
pub(crate) fn chosen(cases: Vec<Case>) -> Vec<Case> {
    let (pairs, mut chosen): (Vec<Case>, Vec<Case>) = cases.into_iter().partition(|case| case.set == Set::Sequences);
    chosen.retain(|case| matches!(case.set, Set::Generated | Set::Colour | Set::Bare));
    chosen.extend(a_third(pairs.into_iter()));
    chosen
}

/// The value of a constant.
fn value(name: &str) -> f64 {
    Model::DEFAULT.get(name).unwrap_or(f64::NAN)
}

/// Measures all cases with all constants.
pub(crate) fn measure(cases: &[Case]) -> Result<Vec<Varied>, Failure> {
    let varied = |name: &&'static str| FACTORS.map(|factor| Variant::with(&[(*name, factor * value(name))]));
    let constants = Model::NAMES.iter().flat_map(varied);
    let variants: Vec<Variant> = std::iter::once(Variant::Whole).chain(constants).collect();
    in_parallel(cases, |case| {
        let data = case.load().map_err(|error| error.to_string())?;
        let outcome = |&variant| of_variant(variant, QUALITY, &data);
        let outcomes = variants.iter().map(outcome).collect::<Result<_, _>>()?;
        eprintln!("{}", case.name);
        Ok(Varied { case: case.clone(), outcomes })
    })
}

/// A mean change and its standard error.
#[derive(Clone, Copy, Serialize)]
struct Change {
    mean: f64,
    error: f64,
}

impl Change {
    /// Of a figure between the pipeline as it is and variant `k`. Pairs of one sequence are alike, so that the error is that over the
    /// sequences.
    fn of(measured: &[Varied], column: &Column, k: usize) -> Change {
        let own = measured.iter().filter(|one| column.sets.contains(&one.case.set));
        let change = |one: &Varied| Some((column.figure)(&one.outcomes[k])? - (column.figure)(&one.outcomes[0])?);
        let mut sequences: Vec<(&str, Vec<f64>)> = Vec::new();
        for (name, change) in own.filter_map(|one| Some((one.case.sequence(), change(one)?))) {
            match sequences.last_mut().filter(|(last, _)| *last == name) {
                Some((_, changes)) => changes.push(change),
                None => sequences.push((name, vec![change])),
            }
        }
        let means: Vec<f64> = sequences.iter().map(|(_, list)| list.iter().sum::<f64>() / list.len() as f64).collect();
        let n = means.len() as f64;
        let mean = means.iter().sum::<f64>() / n;
        let variance = means.iter().map(|m| (m - mean) * (m - mean)).sum::<f64>() / (n - 1.0);
        Change { mean, error: (variance / n).sqrt() }
    }
}

/// Index of the outcome of constant `k` with factor `f`.
fn variant(k: usize, f: usize) -> usize {
    1 + FACTORS.len() * k + f
}

/// The changes as values for programs.
pub(crate) fn json(measured: &[Varied]) -> Value {
    let count = |column: &Column| measured.iter().filter(|one| column.sets.contains(&one.case.set)).count();
    let columns = COLUMNS.each_ref().map(|column| json!({ "figure": column.title, "cases": count(column) }));
    let rows = Model::NAMES.iter().enumerate().flat_map(|(k, name)| {
        FACTORS.iter().enumerate().map(move |(f, factor)| {
            let changes = COLUMNS.each_ref().map(|column| Change::of(measured, column, variant(k, f)));
            json!({ "constant": name, "factor": factor, "changes": changes })
        })
    });
    json!({ "quality": QUALITY.name(), "columns": columns, "rows": rows.collect::<Vec<_>>() })
}
