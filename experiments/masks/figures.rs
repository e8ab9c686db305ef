//! The figures as JSON: means over the cases that belong together for the documentation, and the outcomes of every case.

use serde::Serialize;

use crate::cases::Set;
use crate::measure::Measured;
use crate::outcome::{Method, Outcome};
use crate::summary::Summary;

#[derive(Serialize)]
pub(crate) struct Figures<'a> {
    scenes: Vec<Row>,
    sequences: Vec<Row>,
    pairs: Vec<Row>,
    flow: Vec<Flow<'a>>,
}

/// The mean scores of a method on some cases.
#[derive(Serialize)]
struct Row {
    of: &'static str,
    method: &'static str,
    #[serde(flatten)]
    summary: Summary,
}

/// Median end point errors, pixels.
#[derive(Serialize)]
struct Flow<'a> {
    pair: &'a str,
    best: Option<f64>,
    fast: Option<f64>,
    baseline: Option<f64>,
}

/// All outcomes of a case.
#[derive(Serialize)]
struct OfCase<'a> {
    case: &'a str,
    set: &'static str,
    size: [usize; 2],
    outcomes: &'a [Outcome],
}

/// Every case with its outcomes, a line of JSON for each.
pub(crate) fn lines(measured: &[Measured]) -> serde_json::Result<String> {
    let line = |one: &Measured| {
        let (case, set) = (&*one.case.name, one.case.set.name());
        serde_json::to_string(&OfCase { case, set, size: one.size, outcomes: &one.outcomes })
    };
    Ok(measured.iter().map(line).collect::<Result<Vec<_>, _>>()?.join("\n"))
}

impl<'a> Figures<'a> {
    pub(crate) fn of(measured: &'a [Measured]) -> Figures<'a> {
        let (scenes, flow) = (scenes(measured), flow(measured));
        Figures { scenes, sequences: sequences(measured), pairs: pairs(measured), flow }
    }
}

/// A row for each method that has outcomes.
fn rows(of: &'static str, cases: &[&Measured]) -> Vec<Row> {
    let row = |method: Method| {
        let summary = Summary::of(cases.iter().filter_map(|one| Some((&one.case, one.of(method)?))));
        (summary.cases > 0).then(|| Row { of, method: method.name(), summary })
    };
    Method::ALL.into_iter().filter_map(row).collect()
}

fn of_set(measured: &[Measured], set: Set) -> Vec<&Measured> {
    measured.iter().filter(|one| one.case.set == set).collect()
}

fn scenes(measured: &[Measured]) -> Vec<Row> {
    let sets = Set::ALL.into_iter().filter(|set| set.is_scene());
    let mut scenes: Vec<Row> = sets.flat_map(|set| rows(set.title(), &of_set(measured, set))).collect();
    let own = [Set::Generated, Set::Colour, Set::Large];
    let all: Vec<&Measured> = measured.iter().filter(|one| own.contains(&one.case.set)).collect();
    scenes.extend(rows("generated, grey and colour, all sizes", &all));
    scenes
}

/// Pairs of one sequence are alike, so that folds are made of whole sequences.
fn sequences(measured: &[Measured]) -> Vec<Row> {
    let all = of_set(measured, Set::Sequences);
    let mut sequences: Vec<&str> = all.iter().map(|one| one.case.sequence()).collect();
    sequences.dedup();
    let place = |one: &Measured| sequences.iter().position(|name| *name == one.case.sequence()).unwrap_or_default();
    parts(["all", "first fold", "second fold"], &all, place)
}

/// Pairs alternate in the order of their names.
fn pairs(measured: &[Measured]) -> Vec<Row> {
    let all = of_set(measured, Set::Pairs);
    let place = |one: &Measured| all.iter().position(|other| other.case.name == one.case.name).unwrap_or_default();
    parts(["all", "first half", "second half"], &all, place)
}

/// Rows of all cases, of those at even places, and of those at odd ones.
fn parts([name, even, odd]: [&'static str; 3], all: &[&Measured], place: impl Fn(&Measured) -> usize) -> Vec<Row> {
    let half = |rest: usize| all.iter().copied().filter(|one| place(one) % 2 == rest).collect::<Vec<_>>();
    [rows(name, all), rows(even, &half(0)), rows(odd, &half(1))].into_iter().flatten().collect()
}

fn flow(measured: &[Measured]) -> Vec<Flow<'_>> {
    let of = |one: &'_ Measured, method| one.of(method).and_then(|outcome| outcome.flow_error);
    let row = |one: &'_ Measured| Method::ALL.map(|method| of(one, method));
    let named = |one| {
        let [best, fast, baseline] = row(one);
        Flow { pair: &one.case.name, best, fast, baseline }
    };
    measured.iter().filter(|one| one.case.set == Set::Flow).map(named).collect()
}
