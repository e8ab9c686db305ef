//! What a correction of one frame does to the others: pixels that it makes right, and pixels that it makes wrong.
use std::collections::BTreeMap;

use experiments::Failure;
use experiments::annotator::overlap::{iou, masks, mean};
use experiments::annotator::robot::NOTHING_SAID;
use experiments::clips::cases::Case;
use serde::Serialize;

use crate::Options;
use crate::measure::{best_label, corrected, is_old, open, truths_of};

/// Loss of J of the other frames from which a correction has made them worse.
const WORSE: f64 = 0.01;

/// The masks of an object after a correction, against those before it, in all frames but the corrected ones.
#[derive(Clone, Copy, Debug, Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Change {
    /// J before and after.
    before: f64,
    after: f64,
    /// Pixels that were right and are wrong, and the other way round.
    spoilt: usize,
    mended: usize,
}

impl Change {
    pub(crate) fn between(
        [before, after]: [&[Vec<bool>]; 2],
        truths: &[Vec<bool>],
        is_corrected: impl Fn(usize) -> bool,
    ) -> Change {
        let others: Vec<usize> = (0..truths.len()).filter(|&t| !is_corrected(t)).collect();
        let j = |masks: &[Vec<bool>]| mean(&others.iter().map(|&t| iou(&masks[t], &truths[t])).collect::<Vec<f64>>());
        let mut change = Change { before: j(before), after: j(after), ..Change::default() };
        for &t in &others {
            for ((before, after), truth) in before[t].iter().zip(&after[t]).zip(&truths[t]) {
                change.spoilt += usize::from(before == truth && after != truth);
                change.mended += usize::from(before != truth && after == truth);
            }
        }
        change
    }
}

/// The figures of a clip.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Row {
    clip: String,
    /// Whether constants of clips were first set on it.
    old: bool,
    /// The frame whose true mask is given.
    frame: usize,
    /// The object is painted over: nothing is said elsewhere, but that what was wrongly found is not the object's.
    painted: Change,
    /// The object is outlined: nothing else is the object's.
    outlined: Change,
    /// One for each round of strokes, against the round before.
    rounds: Vec<Change>,
}

/// The rows of a clip, one for each frame asked for. Only the first has rounds: they go by the worst frames.
pub(crate) fn measure(case: &Case, options: &Options) -> Result<Vec<Row>, Failure> {
    let data = case.load()?;
    let automatic = open(case, &data, options)?;
    let truths = truths_of(&data);
    let Some((label, _)) = best_label(&automatic.labels, &truths) else { return Ok(Vec::new()) };
    let before = masks(&automatic.labels, label);
    let middle = [truths.len() / 2];
    let frames = if options.at.is_empty() { &middle[..] } else { &options.at };
    let mut rounds = corrected(case, &data, &automatic, options)?.changes;
    let mut rows = Vec::new();
    for &frame in frames.iter().filter(|&&frame| frame < truths.len()) {
        let change = |elsewhere: &dyn Fn(usize) -> u8| -> Result<Change, Failure> {
            let mut session = automatic.clone();
            let said = |(p, &is_object): (usize, &bool)| if is_object { label } else { elsewhere(p) };
            session.paint(frame, &truths[frame].iter().enumerate().map(said).collect::<Vec<u8>>())?;
            let after = masks(&session.labels, label);
            Ok(Change::between([&before, &after], &truths, |t| t == frame))
        };
        rows.push(Row {
            clip: case.name.clone(),
            old: is_old(&case.name),
            frame,
            painted: change(&|p| if before[frame][p] { 0 } else { NOTHING_SAID })?,
            outlined: change(&|_| 0)?,
            rounds: std::mem::take(&mut rounds),
        });
    }
    Ok(rows)
}

/// A line for each way of saying something.
pub(crate) fn print_summary(rows: &[Row]) {
    let mut ways: BTreeMap<String, Vec<Change>> = BTreeMap::new();
    for row in rows {
        ways.entry("painted".into()).or_default().push(row.painted);
        ways.entry("outlined".into()).or_default().push(row.outlined);
        for (k, change) in row.rounds.iter().enumerate() {
            ways.entry(format!("round {}", k + 1)).or_default().push(*change);
        }
    }
    for (way, changes) in ways {
        let j = |of: &dyn Fn(&Change) -> f64| mean(&changes.iter().map(of).collect::<Vec<f64>>());
        let sum = |of: &dyn Fn(&Change) -> usize| changes.iter().map(of).sum::<usize>();
        let worse = changes.iter().filter(|of| of.after < of.before - WORSE).count();
        println!(
            "{way}: J of the other frames {:.3} -> {:.3}, harm {:.2}, worse in {worse} of {}",
            j(&|of| of.before),
            j(&|of| of.after),
            sum(&|of| of.spoilt) as f64 / sum(&|of| of.mended).max(1) as f64,
            changes.len(),
        );
    }
}
