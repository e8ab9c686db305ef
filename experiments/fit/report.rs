//! Tables of scores.
use std::collections::BTreeMap;
use std::path::PathBuf;

use experiments::Failure;
use experiments::masks::outcome::Method;

use crate::change::mean;
use crate::measure::{Loaded, Part, Scored, measure};
use crate::search::{model, state};

/// A figure of a case and its name.
type Figure = (&'static str, fn(&Scored) -> f64);

const FIGURES: [Figure; 3] = [("J", |s| s.j), ("by hand", |s| s.hand), ("F", |s| s.f)];

/// What is printed above rows of scores.
fn head() -> String {
    let columns = Part::ALL.iter().flat_map(|part| match part.is_fold() {
        true => FIGURES.map(|(name, _)| format!("{} {name}", part.name())).to_vec(),
        false => vec![format!("{}: IoU", part.name()), "right number".into()],
    });
    columns.collect::<Vec<_>>().join(" | ")
}

/// The figures of all parts. Of changes, those of more than two standard errors are marked.
fn row(cases: &[Loaded], scored: &[Scored], before: Option<&[Scored]>) -> String {
    let mut cells = Vec::new();
    for part in Part::ALL {
        let figures = if part.is_fold() { &FIGURES[..] } else { &FIGURES[..2] };
        for (_, figure) in figures {
            let own = mean(cases, part, |k| figure(&scored[k]) - before.map_or(0.0, |before| figure(&before[k])));
            let mark = if own.mean.abs() > 2.0 * own.error { "*" } else { " " };
            cells.push(match before {
                None => format!("{:.3}", own.mean),
                Some(_) => format!("{:+.3}{mark}", own.mean),
            });
        }
    }
    cells.join(" | ")
}

/// The scores as they are, then what they change by with other constants.
pub(crate) fn tried(
    cases: &[Loaded],
    tried: &[BTreeMap<String, f64>],
    methods: &[Method],
    images: usize,
) -> Result<(), Failure> {
    println!("{}", head());
    let mut before = Vec::new();
    for &method in methods {
        let scored = measure(cases, &model(&BTreeMap::new())?, method, images)?;
        println!("{} {}", row(cases, &scored, None), method.name());
        before.push(scored);
    }
    for values in tried {
        for (&method, before) in methods.iter().zip(&before) {
            let scored = measure(cases, &model(values)?, method, images)?;
            let names: Vec<String> = values.iter().map(|(name, value)| format!("{name}={value}")).collect();
            println!("{} {} {}", row(cases, &scored, Some(before)), method.name(), names.join(","));
        }
    }
    Ok(())
}

/// The scores of the constants found on each fold, and the held-out halves together.
pub(crate) fn held_out(cases: &[Loaded], images: usize, folds: [(Part, PathBuf); 2]) -> Result<(), Failure> {
    println!("{}", head());
    println!("{} as they are", row(cases, &measure(cases, &model(&BTreeMap::new())?, Method::Best, images)?, None));
    let mut held_out: Vec<(usize, Scored)> = Vec::new();
    let mut found = Vec::new();
    for (fold, path) in folds {
        let state = state(&path)?;
        let scored = measure(cases, &model(&state.changed)?, Method::Best, images)?;
        println!("{} fitted to {}", row(cases, &scored, None), fold.name());
        let others = cases.iter().enumerate().filter(|(_, case)| case.part.is_fold() && case.part != fold);
        held_out.extend(others.map(|(k, _)| (k, scored[k])));
        found.push(state.changed);
    }
    let n = held_out.len() as f64;
    let of = |figure: fn(&Scored) -> f64| held_out.iter().map(|(_, scored)| figure(scored)).sum::<f64>() / n;
    let figures: Vec<String> = FIGURES.iter().map(|(name, figure)| format!("{name} {:.3}", of(*figure))).collect();
    println!("held out: {}", figures.join(", "));
    for (name, value) in &found[0] {
        if let Some(other) = found[1].get(name) {
            println!("{name}: {value} on A, {other} on B");
        }
    }
    Ok(())
}
