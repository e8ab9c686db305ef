//! What the parts of a pipeline are worth: the same cases with everything, then without one part after another, and the mean differences.
//! Cases differ much more than what one part changes in each of them, so that differences of the same case say more than those of means.

use std::collections::BTreeMap;
use std::fs;
use std::time::Instant;

use serde::Serialize;

use crate::score::statistics::{Estimate, estimate};

/// What is left out, and the constants that leave it out. The first row of an ablation leaves nothing out.
pub type Row = (&'static str, &'static [(&'static str, f64)]);

/// The figures that a case has, by name.
pub type Figures = BTreeMap<&'static str, f64>;

/// What a case gives.
pub struct Measured {
    /// The table that it counts in.
    pub table: &'static str,
    /// Cases of one sequence are alike; they stand together.
    pub sequence: String,
    /// Figures and milliseconds of each row.
    pub rows: Vec<(Figures, f64)>,
}

/// A row of the tables.
#[derive(Serialize)]
pub struct Worth {
    without: &'static str,
    tables: BTreeMap<&'static str, Change>,
}

/// A row of one table.
#[derive(Serialize)]
struct Change {
    cases: usize,
    /// Cases of which any figure changes.
    changed: usize,
    /// The time of all cases as a share of that of the first row.
    time: f64,
    /// The mean differences from the first row; of that row the means.
    figures: BTreeMap<&'static str, Estimate>,
}

/// A model with the constants of a row.
pub fn with<M>(mut model: M, (_, values): &Row, set: fn(&mut M, &str, f64) -> bool) -> M {
    for (name, value) in *values {
        assert!(set(&mut model, name, *value), "there is no constant {name}");
    }
    model
}

/// What `work` returns, and how long this thread had a processor for it, milliseconds: other programs do not count. Where the system does
/// not tell, the time that passed.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    // Nanoseconds come first.
    let on_processor = || fs::read_to_string("/proc/thread-self/schedstat").ok()?.split(' ').next()?.parse().ok();
    let before: Option<f64> = on_processor();
    let done = work();
    let passed = 1e3 * start.elapsed().as_secs_f64();
    (done, before.zip(on_processor()).map_or(passed, |(before, after)| 1e-6 * (after - before)))
}

/// The tables of an ablation.
pub fn worth(rows: &[Row], measured: &[Measured]) -> Vec<Worth> {
    let mut tables: BTreeMap<&'static str, Vec<&Measured>> = BTreeMap::new();
    measured.iter().for_each(|one| tables.entry(one.table).or_default().push(one));
    let of = |(k, (without, _)): (usize, &Row)| Worth {
        without,
        tables: tables.iter().map(|(&table, cases)| (table, change(k, cases))).collect(),
    };
    rows.iter().enumerate().map(of).collect()
}

fn change(row: usize, cases: &[&Measured]) -> Change {
    let time = |row: usize| cases.iter().map(|case| case.rows[row].1).sum::<f64>();
    let mut values: BTreeMap<&'static str, Vec<(&str, f64)>> = BTreeMap::new();
    for Measured { sequence, rows, .. } in cases {
        for (name, figure) in &rows[row].0 {
            let before = if row == 0 { Some(&0.0) } else { rows[0].0.get(name) };
            values.entry(name).or_default().extend(before.map(|before| (&**sequence, figure - before)));
        }
    }
    Change {
        cases: cases.len(),
        changed: cases.iter().filter(|case| case.rows[row].0 != case.rows[0].0).count(),
        time: time(row) / time(0),
        figures: values.iter().filter_map(|(name, values)| Some((*name, estimate(values)?))).collect(),
    }
}

/// An error for rows that change no figure of any case: they measure nothing.
pub fn all_change(rows: &[Worth]) -> Result<(), String> {
    let is_void = |row: &&Worth| row.tables.values().all(|table| table.changed == 0);
    let void: Vec<&str> = rows.iter().skip(1).filter(is_void).map(|row| row.without).collect();
    match void.is_empty() {
        true => Ok(()),
        false => Err(format!(
            "Nothing changes in any case without: {}. Either such a row leaves nothing out, or no case shows what it leaves out.",
            void.join("; ")
        )),
    }
}
