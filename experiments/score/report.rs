//! The figures as a table, as a file, and against those of an earlier run.

use std::fmt::Write;

use serde::{Deserialize, Serialize};

use super::statistics::{Estimate, Verdict, estimate, verdict};

/// Changes of J of a single case that are listed.
const LARGE: f64 = 0.05;
/// How many falls and how many rises are listed.
const LISTED: usize = 5;

/// The figures of one case with one quality.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Entry {
    /// The row of the table.
    pub part: String,
    pub case: String,
    pub sequence: String,
    pub quality: String,
    /// J without help; of scenes the mean IoU.
    pub j: Option<f64>,
    pub by_hand: Option<f64>,
    pub f: Option<f64>,
    /// 1 or 0.
    pub n_right: Option<f64>,
}

type Figure = fn(&Entry) -> Option<f64>;

const FIGURES: [(&str, Figure); 4] =
    [("J", |e| e.j), ("by hand", |e| e.by_hand), ("F", |e| e.f), ("n right", |e| e.n_right)];

impl Entry {
    /// Figures to four digits, as they stand in the file.
    pub fn rounded(mut self) -> Entry {
        for figure in [&mut self.j, &mut self.by_hand, &mut self.f, &mut self.n_right] {
            *figure = figure.map(to_four);
        }
        self
    }

    fn key(&self) -> [&str; 3] {
        [&self.part, &self.case, &self.quality]
    }
}

/// To four digits after the point.
fn to_four(value: f64) -> f64 {
    (1e4 * value).round() / 1e4
}

/// A line for each case, so that differences of two files can be read.
pub fn file(entries: &[Entry]) -> serde_json::Result<String> {
    let lines = entries.iter().map(serde_json::to_string).collect::<serde_json::Result<Vec<String>>>()?;
    Ok(format!("[\n{}\n]\n", lines.join(",\n")))
}

/// The rows of the table: part, quality and the entries of both, in the order of their first entries.
fn rows(entries: &[Entry]) -> Vec<(&str, &str, Vec<&Entry>)> {
    let mut rows: Vec<(&str, &str, Vec<&Entry>)> = Vec::new();
    for entry in entries {
        match rows.iter_mut().find(|(part, quality, _)| (*part, *quality) == (&entry.part, &entry.quality)) {
            Some((_, _, list)) => list.push(entry),
            None => rows.push((&entry.part, &entry.quality, vec![entry])),
        }
    }
    rows
}

/// The figures with their intervals.
pub fn table(entries: &[Entry]) -> String {
    let mut text = format!("{:32}{:>5}", "", "cases");
    FIGURES.iter().for_each(|(title, _)| _ = write!(text, "  {title:21}"));
    for (part, quality, list) in rows(entries) {
        let _ = write!(text, "\n{:32}{:>5}", format!("{part}, {quality}"), list.len());
        for (_, figure) in FIGURES {
            let values: Vec<(&str, f64)> =
                list.iter().filter_map(|entry| Some((entry.sequence.as_str(), figure(entry)?))).collect();
            let cell = estimate(&values).map_or("–".into(), |found| cell(&found, false));
            let _ = write!(text, "  {cell:21}");
        }
    }
    trimmed(&text)
}

/// A mean and its interval.
fn cell(found: &Estimate, signed: bool) -> String {
    let number = |value: f64| if signed { format!("{value:+.3}") } else { format!("{value:.3}") };
    match found.interval {
        Some([low, high]) => format!("{} [{}, {}]", number(found.mean), number(low), number(high)),
        None => number(found.mean),
    }
}

/// The changes since `before`, of the cases of both.
pub fn changes(before: &[Entry], now: &[Entry]) -> String {
    let mut text = String::new();
    let old = |entry: &Entry| before.iter().find(|other| other.key() == entry.key());
    for (part, quality, list) in rows(now) {
        for (title, figure) in FIGURES {
            let difference = |entry: &Entry| Some(to_four(figure(entry)? - old(entry).and_then(figure)?));
            let changes: Vec<(&str, f64)> =
                list.iter().filter_map(|entry| Some((entry.sequence.as_str(), difference(entry)?))).collect();
            let (change, word) = match verdict(&changes) {
                None | Some((_, Verdict::Same)) => continue,
                Some((change, Verdict::Rose)) => (change, "rose"),
                Some((change, Verdict::Fell)) => (change, "FELL"),
                Some((change, Verdict::Unclear)) => (change, "unclear"),
            };
            let moved = changes.iter().filter(|(_, change)| *change != 0.0).count();
            let row = format!("{part}, {quality}");
            let cell = cell(&change, true);
            let _ = writeln!(text, "{row:32}{title:9}{word:9}{cell:26}{moved} of {} cases changed", change.cases);
        }
    }
    if text.is_empty() {
        text.push_str("Nothing changed.\n");
    }
    let mut single: Vec<(f64, &Entry)> =
        now.iter().filter_map(|entry| Some((entry.j? - old(entry)?.j?, entry))).collect();
    single.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let falls = single.iter().filter(|(change, _)| *change <= -LARGE).take(LISTED);
    let rises = single.iter().rev().filter(|(change, _)| *change >= LARGE).take(LISTED);
    for (change, entry) in falls.chain(rises) {
        let word = if *change < 0.0 { "fell" } else { "rose" };
        let (old, j) = (entry.j.unwrap_or_default() - change, entry.j.unwrap_or_default());
        let _ = writeln!(text, "{}, {}: J {word} from {old:.3} to {j:.3}", entry.case, entry.quality);
    }
    let missing = now.iter().filter(|entry| old(entry).is_none()).count();
    if missing > 0 {
        let _ = writeln!(text, "{missing} results have nothing to compare with.");
    }
    text
}

/// Without spaces at the ends of lines.
fn trimmed(text: &str) -> String {
    text.lines().map(|line| format!("{}\n", line.trim_end())).collect()
}
