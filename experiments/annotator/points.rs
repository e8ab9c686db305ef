//! What pointing to an object gives in its frame.
use experiments::Failure;
use experiments::annotator::overlap::{each, of_label};
use experiments::clips::cases::Case;
use serde::Serialize;
use veronese::clip::{Click, Prompt, Spread};

use crate::Options;
use crate::measure::{GIVEN, boxed, deepest, is_old, open, truths_of, width_of};

/// J of an object in the frame in which it is pointed to.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Row {
    clip: String,
    /// Whether constants of clips were first set on it.
    old: bool,
    frame: usize,
    boxed: f64,
    /// After one, two and three clicks, each at the deepest pixel that is wrong.
    clicks: Vec<f64>,
    /// Of the box, and of the last of the clicks.
    milliseconds: [f64; 2],
}

/// The first, the middle and the last frame of a clip.
pub(crate) fn measure(case: &Case, options: &Options) -> Result<Vec<Row>, Failure> {
    let data = case.load()?;
    let automatic = open(case, &data, options)?;
    let (width, truths) = (width_of(case, &data)?, truths_of(&data));
    let mut rows = Vec::new();
    for frame in [0, truths.len() / 2, truths.len() - 1] {
        let truth = &truths[frame];
        if !truth.contains(&true) {
            continue;
        }
        let mut times = [0.0; 2];
        let mut shown = |clicks: &[Click], within, kind: usize| -> Result<Vec<bool>, Failure> {
            let prompt = Prompt { frame, object: GIVEN, clicks: clicks.to_vec(), within, spread: Spread::None };
            let (labels, took) = automatic.clone().point(prompt)?;
            times[kind] = 1e3 * took.as_secs_f64();
            Ok(of_label(&labels, GIVEN))
        };
        let score = |found: &Vec<bool>| each(std::slice::from_ref(found), std::slice::from_ref(truth))[0];
        let in_box = score(&shown(&[], Some(boxed(truth, width)), 0)?);
        let (mut clicks, mut scores) = (Vec::new(), Vec::new());
        let mut found = vec![false; truth.len()];
        for _ in 0..3 {
            let wrong: Vec<bool> = found.iter().zip(truth).map(|(a, b)| a != b).collect();
            let at = deepest(&wrong, width);
            clicks.push(Click { at: [at % width, at / width], inside: truth[at] });
            found = shown(&clicks, None, 1)?;
            scores.push(score(&found));
        }
        rows.push(Row {
            clip: case.name.clone(),
            old: is_old(&case.name),
            frame,
            boxed: in_box,
            clicks: scores,
            milliseconds: times,
        });
    }
    Ok(rows)
}
