//! Pairs of frames: a robot corrects the masks of an object stroke by stroke.

use std::fmt::Write;
use std::time::Instant;

use serde::{Deserialize, Serialize};
use veronese::{AffineMotion, Correction, MotionCount, SegmentOptions, relabel, segment_pair};

use crate::cases::Case;
use crate::overlap::{each, mean};
use crate::robot::stroke;
use crate::{Failure, Options};

/// First frames of the pairs of a clip.
const FIRST: [usize; 4] = [0, 8, 16, 24];

/// The figures of a clip.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Row {
    pub(crate) clip: String,
    /// Of each pair: J of the labels that fit best, and after each round of strokes.
    pub(crate) rounds: Vec<Vec<f64>>,
    pub(crate) milliseconds: f64,
}

/// All figures of a clip.
pub(crate) fn measure(case: &Case, options: &Options) -> Result<Row, Failure> {
    let data = case.load()?;
    let (mut rounds, mut times) = (Vec::new(), Vec::new());
    for t in FIRST.into_iter().filter(|t| t + 1 < data.frames.len()) {
        let [first, second] = [&data.frames[t], &data.frames[t + 1]];
        let truth: Vec<bool> = data.truths[t].iter().map(|&label| label > 0).collect();
        let asked =
            SegmentOptions { quality: options.quality, motions: MotionCount::Auto, ..SegmentOptions::default() };
        let found = segment_pair(first, second, None, &asked, &mut |_| {})?;
        let motions: Vec<AffineMotion> = found.motions.iter().map(|motion| motion.matrix).collect();
        let groups: Vec<u8> = found.motions.iter().map(|motion| motion.group).collect();
        if motions.len() < 2 {
            continue;
        }
        // The labels that a person would merge: most of their pixels are the object's.
        let inside = |k: usize| {
            let own = (0..truth.len()).filter(|&p| usize::from(found.labels[p]) == k);
            let [all, hits] = own.fold([0usize; 2], |[all, hits], p| [all + 1, hits + usize::from(truth[p])]);
            hits as f64 / all.max(1) as f64
        };
        let mut set = (0..motions.len()).filter(|&k| inside(k) > 0.5).fold(0u16, |set, k| set | 1 << k);
        if set == 0 {
            set = 1 << (1..motions.len()).max_by(|&a, &b| inside(a).total_cmp(&inside(b))).unwrap_or(1);
        }
        let everything = (1u16 << motions.len()) - 1;
        if set == everything {
            continue;
        }
        let mask =
            |labels: &[u8]| -> Vec<bool> { labels.iter().map(|&l| u32::from(l) < 16 && set >> l & 1 == 1).collect() };
        let mut now = mask(&found.labels);
        let mut allowed = vec![0u16; truth.len()];
        let j = |mask: &[bool]| each(&[mask.to_vec()], std::slice::from_ref(&truth))[0];
        let mut figures = vec![j(&now)];
        for _ in 0..options.rounds {
            for (object, set) in [(true, set), (false, everything & !set)] {
                let region: Vec<bool> = (0..truth.len()).map(|p| truth[p] == object && now[p] != object).collect();
                stroke(&region, first.width()).into_iter().for_each(|p| allowed[p] = set);
            }
            let correction =
                Correction { motions: &motions, groups: &groups, labels: &found.labels, allowed: &allowed };
            let start = Instant::now();
            now = mask(&relabel(first, second, None, &correction, &asked, &mut |_| {})?.labels);
            times.push(1e3 * start.elapsed().as_secs_f64());
            figures.push(j(&now));
        }
        rounds.push(figures);
    }
    Ok(Row { clip: case.name.clone(), rounds, milliseconds: mean(&times) })
}

/// The figures as a table of Markdown.
pub(crate) fn table(rows: &[Row]) -> String {
    let mut text = String::from("| pairs | found | rounds … | ms |\n|---|---|---|---|\n");
    let mut line = |name: &str, rows: &[&Row]| {
        let pairs: Vec<&Vec<f64>> = rows.iter().flat_map(|row| &row.rounds).collect();
        let Some(count) = pairs.first().map(|figures| figures.len()) else { return };
        let columns: Vec<String> = (0..count)
            .map(|k| format!("{:.3}", mean(&pairs.iter().map(|figures| figures[k]).collect::<Vec<_>>())))
            .collect();
        let time = mean(&rows.iter().map(|row| row.milliseconds).filter(|ms| ms.is_finite()).collect::<Vec<_>>());
        let _ = writeln!(text, "| {name} ({}) | {} | {time:.0} |", pairs.len(), columns.join(" | "));
    };
    for (name, old) in [("old", true), ("new", false)] {
        line(name, &rows.iter().filter(|row| crate::measure::OLD.contains(&&*row.clip) == old).collect::<Vec<_>>());
    }
    line("all", &rows.iter().collect::<Vec<_>>());
    text
}
