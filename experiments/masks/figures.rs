//! The figures as JSON: means over the cases that belong together for the documentation, and the outcomes of every case.
use experiments::masks::cases::Set;
use experiments::masks::outcome::{Method, Outcome};
use serde::Serialize;

use crate::measure::Measured;
use crate::summary::Summary;

#[derive(Serialize)]
pub(crate) struct Figures {
    scenes: Vec<Row>,
    sequences: Vec<Row>,
    pairs: Vec<Row>,
}

/// The mean scores of a method on some cases.
#[derive(Serialize)]
struct Row {
    of: &'static str,
    method: &'static str,
    #[serde(flatten)]
    summary: Summary,
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

impl Figures {
    pub(crate) fn of(measured: &[Measured]) -> Figures {
        let real = |set: Set| rows(set.title(), &measured.iter().filter(|one| one.case.set == set).collect::<Vec<_>>());
        Figures { scenes: scenes(measured), sequences: real(Set::Sequences), pairs: real(Set::Pairs) }
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

fn scenes(measured: &[Measured]) -> Vec<Row> {
    let alike = [Set::Generated, Set::Colour, Set::Large];
    let of = |sets: &[Set]| measured.iter().filter(|one| sets.contains(&one.case.set)).collect::<Vec<_>>();
    let mut scenes = rows("generated, grey and colour, 200 × 150 to 1280 × 720", &of(&alike));
    let others = Set::ALL.into_iter().filter(|set| set.is_scene() && !alike.contains(set));
    scenes.extend(others.flat_map(|set| rows(set.title(), &of(&[set]))));
    scenes
}
