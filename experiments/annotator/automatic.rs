//! What is found when nothing is said, with all parts of the clip segmenter and without each of some. Pairs are solved once; all the rest
//! takes seconds.

use std::fmt::Write;

use serde::Serialize;
use veronese::clip::vary;

use crate::cases::Case;
use crate::measure::{best_label, groups_of};
use crate::overlap::of_label;
use crate::parts::{PARTS, Part};
use crate::scores::scores;
use crate::session::Session;
use crate::{Failure, Options, dump};

/// `click` is that of the other tables, the others are defined in experiments/clips/scores.rs.
const TITLES: [&str; 6] = ["auto", "click", "tracks", "F tracks", "assigned", "switches"];

/// The figures of a clip.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Row {
    clip: String,
    /// The part that is left out, nothing at first, and the figures without it.
    figures: Vec<(String, [f64; TITLES.len()])>,
}

/// The part of a name.
pub(crate) fn part(name: &str) -> Result<&'static Part, String> {
    PARTS.iter().find(|part| part.name == name).ok_or(format!("There is no part '{name}'."))
}

pub(crate) fn measure(case: &Case, options: &Options) -> Result<Row, Failure> {
    let data = case.load()?;
    let width = data.frames.first().ok_or_else(|| format!("{} has no frames", case.name))?.width();
    let truths: Vec<Vec<bool>> = data.truths.iter().map(|truth| of_label(truth, 1)).collect();
    let mut figures = Vec::new();
    for name in std::iter::once("nothing").chain(options.without.iter().map(String::as_str)) {
        vary(part(name).map_or(options.model, |part| part.left_out_of(options.model)));
        let labels = Session::open(&data.frames, options.quality, &options.pairs(case))?.labels;
        dump::write(options, case, &format!("without-{name}"), &data, &labels)?;
        let scores = scores(&data.truths, &labels, width);
        let identities = scores.identities.map_or([f64::NAN; 2], |of| [of.assigned, of.switches]);
        let click = best_label(&labels, &truths).map_or(0.0, |(_, j)| j);
        let f = scores.f_tracks.unwrap_or(f64::NAN);
        let own = [scores.j_auto, click, scores.j_tracks, f, identities[0], identities[1]];
        figures.push((name.to_owned(), own));
    }
    Ok(Row { clip: case.name.clone(), figures })
}

/// Means, and what changes from clip to clip when a part is left out, with its standard error.
pub(crate) fn table(rows: &[Row]) -> String {
    let mut text = format!("| clips | without | {} |\n|{}\n", TITLES.join(" | "), "---|".repeat(TITLES.len() + 2));
    for (group, rows) in groups_of(rows, |row| &row.clip) {
        for (k, (name, _)) in rows[0].figures.iter().enumerate() {
            let cell = |figure: usize| {
                let values = |k: usize| rows.iter().map(move |row| row.figures[k].1[figure]);
                if k == 0 {
                    return format!("{:.3}", mean_and_error(&values(0).collect::<Vec<_>>())[0]);
                }
                let changes: Vec<f64> = values(k).zip(values(0)).map(|(without, with)| without - with).collect();
                let [mean, error] = mean_and_error(&changes);
                format!("{mean:+.3} ± {error:.3}")
            };
            let cells: Vec<String> = (0..TITLES.len()).map(cell).collect();
            let _ = writeln!(text, "| {group} ({}) | {name} | {} |", rows.len(), cells.join(" | "));
        }
    }
    text
}

/// The mean of values and its standard error.
fn mean_and_error(values: &[f64]) -> [f64; 2] {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>();
    [mean, (squares / (n * (n - 1.0))).sqrt()]
}
