//! The sensitivity: the same cases with one tuned constant made smaller or larger by half.

use std::fmt::Write;

use serde_json::{Value, json};
use veronese::Model;

use crate::Failure;
use crate::cases::{Case, Set, a_third};
use crate::outcome::{Method, Outcome, Variant, of_variant};
use crate::parallel::in_parallel;
use crate::scores::Scores;

/// What a constant is multiplied by.
const FACTORS: [f64; 2] = [0.5, 1.5];
/// A mean change of more standard errors than this is set in bold type.
const SIGNIFICANT: f64 = 2.0;

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
        let outcome = |&variant| of_variant(variant, Method::Best, &data);
        let outcomes = variants.iter().map(outcome).collect::<Result<_, _>>()?;
        eprintln!("{}", case.name);
        Ok(Varied { case: case.clone(), outcomes })
    })
}

/// A mean change and its standard error.
#[derive(Clone, Copy)]
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

    fn cell(self) -> String {
        match self.mean {
            mean if mean.is_nan() => "–".into(),
            0.0 => "0".into(),
            mean if mean.abs() > SIGNIFICANT * self.error => format!("**{mean:+.3}**"),
            mean => format!("{mean:+.3}"),
        }
    }
}

/// Index of the outcome of constant `k` with factor `f`.
fn variant(k: usize, f: usize) -> usize {
    1 + FACTORS.len() * k + f
}

/// The changes as values for programs.
pub(crate) fn json(measured: &[Varied]) -> Value {
    let rows = Model::NAMES.iter().enumerate().flat_map(|(k, title)| {
        FACTORS.iter().enumerate().map(move |(f, factor)| {
            let figures = COLUMNS.iter().map(|column| {
                let change = Change::of(measured, column, variant(k, f));
                (column.title.to_owned(), json!({ "change": change.mean, "standardError": change.error }))
            });
            json!({ "constant": title, "factor": factor, "figures": figures.collect::<serde_json::Map<_, _>>() })
        })
    });
    rows.collect()
}

/// The table of the page.
pub(crate) fn table(measured: &[Varied]) -> String {
    let count = |sets: &[Set]| measured.iter().filter(|one| sets.contains(&one.case.set)).count();
    let [pairs, scenes, bare] = [&COLUMNS[0], &COLUMNS[3], &COLUMNS[4]].map(|column| count(column.sets));
    let mut text = format!(
        "What the scores change by if one constant is multiplied by 0.5 / by 1.5 (best). J, J by hand and F are those of {pairs} of the \
         real pairs, two of each sequence; mean IoU is that of {scenes} generated scenes and of the {bare} of cars on bare ground. Changes \
         of more than {SIGNIFICANT} standard errors (over the sequences or scenes) are bold, and 0 means that no score changes.\n\n| constant |"
    );
    COLUMNS.iter().for_each(|column| _ = write!(text, " {} |", column.title));
    let _ = writeln!(text, "\n|---{}|", "|---".repeat(COLUMNS.len()));
    for (k, title) in Model::NAMES.iter().enumerate() {
        let _ = write!(text, "| {title} |");
        for column in &COLUMNS {
            let [less, more] = [0, 1].map(|f| Change::of(measured, column, variant(k, f)).cell());
            let _ = write!(text, " {less} / {more} |");
        }
        text.push('\n');
    }
    text
}
