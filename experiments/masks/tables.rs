//! The figures as files for programs: a row for each case and method, and everything in one JSON.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::ablation::Worth;
use crate::cases::Set;
use crate::measure::Measured;
use crate::outcome::{Method, Outcome};
use crate::scores::Scores;
use crate::summary::Summary;

const COLUMNS: [&str; 10] = [
    "miou",
    "accuracy",
    "j_background",
    "j_oracle",
    "j_auto",
    "boundary",
    "all_boundaries",
    "rand",
    "truth_count",
    "found_count",
];

fn figures(scores: Option<&Scores>) -> [Option<f64>; COLUMNS.len()] {
    let Some(s) = scores else { return [None; COLUMNS.len()] };
    [
        Some(s.miou),
        Some(s.accuracy),
        s.j_background,
        s.j_oracle,
        s.j_auto,
        s.boundary,
        s.all_boundaries,
        Some(s.rand),
        Some(s.truth_count as f64),
        Some(s.found_count as f64),
    ]
}

/// Comma separated values with a header line; a figure that does not exist is empty.
pub(crate) fn csv(measured: &[Measured]) -> String {
    let mut text = String::from("case,set,width,height,method");
    for column in COLUMNS {
        let _ = write!(text, ",{column}");
    }
    for column in COLUMNS {
        let _ = write!(text, ",grouped_{column}");
    }
    text.push_str(",flow_error,milliseconds\n");
    for one in measured {
        for outcome in &one.outcomes {
            let [width, height] = one.size;
            let _ =
                write!(text, "{},{},{width},{height},{}", one.case.name, one.case.set.name(), outcome.method.name());
            let cells = figures(outcome.single.as_ref()).into_iter().chain(figures(outcome.grouped.as_ref()));
            for cell in cells.chain([outcome.flow_error, Some(outcome.milliseconds)]) {
                let _ = match cell {
                    Some(value) => write!(text, ",{value}"),
                    None => write!(text, ","),
                };
            }
            text.push('\n');
        }
    }
    text
}

/// Everything that was measured.
pub(crate) fn all(measured: &[Measured], ablation: &[Worth]) -> Value {
    let cases: Vec<Value> = measured
        .iter()
        .map(|one| {
            let methods: serde_json::Map<String, Value> =
                one.outcomes.iter().map(|outcome| (outcome.method.name().into(), of_outcome(outcome))).collect();
            json!({
                "case": one.case.name, "set": one.case.set.name(), "size": one.size, "subPixel": one.case.sub_pixel,
                "methods": methods,
            })
        })
        .collect();
    let mut sets = serde_json::Map::new();
    for set in Set::ALL {
        let of_set = |method: Method| {
            let own = measured.iter().filter(|one| one.case.set == set);
            own.filter_map(move |one| one.of(method).map(|outcome| (&one.case, outcome)))
        };
        let methods: serde_json::Map<String, Value> = Method::ALL
            .into_iter()
            .filter(|&method| of_set(method).next().is_some())
            .map(|method| (method.name().into(), of_summary(&Summary::of(of_set(method)))))
            .collect();
        if !methods.is_empty() {
            sets.insert(set.name().into(), Value::Object(methods));
        }
    }
    let worths: Vec<Value> = ablation
        .iter()
        .map(|worth| {
            let [best, fast] = worth.with.each_ref().map(|scored| {
                json!({
                    "scenes": of_summary(&scored.scenes), "bare": of_summary(&scored.bare),
                    "sequences": scored.pairs.as_ref().map(of_summary),
                })
            });
            json!({ "variant": worth.title, "best": best, "fast": fast })
        })
        .collect();
    json!({ "cases": cases, "sets": sets, "ablation": worths })
}

fn of_outcome(outcome: &Outcome) -> Value {
    let named = |scores: Option<&Scores>| {
        let values =
            COLUMNS.iter().zip(figures(scores)).filter_map(|(name, value)| Some(((*name).into(), json!(value?))));
        Value::Object(values.collect())
    };
    json!({
        "single": named(outcome.single.as_ref()), "grouped": named(outcome.grouped.as_ref()),
        "flowError": outcome.flow_error, "milliseconds": outcome.milliseconds,
    })
}

fn of_summary(s: &Summary) -> Value {
    json!({
        "cases": s.cases, "miou": s.miou, "subPixel": s.sub_pixel, "countRight": s.count_right,
        "jBackground": s.j_background, "jOracle": s.j_oracle, "boundary": s.boundary,
        "groupedBoundary": s.grouped_boundary, "rand": s.rand, "milliseconds": s.milliseconds,
    })
}
