//! Several objects in one clip: generated clips whose truth is exact.
use experiments::Failure;
use experiments::annotator::overlap::{each, masks, mean, of_label, worst};
use experiments::annotator::robot::{NOTHING_SAID, View};
use experiments::clips::cases::Case;
use scenes::{ClipSceneOptions, Event};
use serde::Serialize;

use crate::Options;
use crate::session::Session;

/// Seed of the first clip; no other program uses any of these.
const SEED: u64 = 83_000;
/// Clips of each kind.
const EACH: u64 = 4;
/// A kind of clips: its name, what happens, the least number of objects, whether they have colours in common, and the number of frames.
type Kind = (&'static str, &'static [Event], usize, bool, usize);
const KINDS: [Kind; 6] = [
    ("crossing", &[Event::Crossing], 3, false, 32),
    ("hidden", &[Event::HiddenByBackground, Event::HiddenByObject], 3, false, 32),
    ("limbs", &[Event::Articulated, Event::Articulated], 2, false, 32),
    ("similar colours", &[Event::Crossing], 3, true, 32),
    ("all together", &[Event::Crossing, Event::HiddenByBackground, Event::Articulated], 4, true, 32),
    ("long", &[Event::Crossing, Event::HiddenByBackground, Event::Articulated], 4, true, 120),
];
/// An object whose mask is given has its true number and this much.
const GIVEN: u8 = 100;

/// The figures of a clip.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Row {
    clip: String,
    quality: String,
    objects: Vec<Object>,
    /// Time of a frame that the masks changed.
    frame_milliseconds: f64,
}

/// The figures of an object whose mask was given.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Object {
    /// Mean IoU over the frames after the first in which it is in sight …
    assigned: f64,
    /// … of those in the last quarter of the clip; none where it is out of sight there …
    last_quarter: Option<f64>,
    /// … and of all after strokes in the worst of them.
    stroked: f64,
    /// Pixels of the other given objects, all frames, that these strokes changed.
    others_changed: usize,
}

/// All clips.
pub(crate) fn cases() -> Vec<Case> {
    let seeds = KINDS.into_iter().flat_map(|kind| [kind; EACH as usize]).zip(SEED..);
    let case = |((kind, events, objects, alike, frames), seed): (Kind, u64)| {
        // Before a camera at rest and one that pans, by turns.
        let pan = (seed % 2 == 1).then_some(Event::Pan);
        let events = events.iter().copied().chain(pan).collect();
        let options = ClipSceneOptions { objects, events, alike, frames, seed, ..ClipSceneOptions::default() };
        Case::generated(format!("{kind} {seed}"), options)
    };
    seeds.map(case).collect()
}

/// All figures of a clip.
pub(crate) fn measure(case: &Case, options: &Options) -> Result<Row, Failure> {
    let data = case.load()?;
    let width = data.frames.first().ok_or_else(|| format!("{} has no frames", case.name))?.width();
    let mut session = Session::open(&data.frames, options.quality, &options.pairs(case))?;
    let given: Vec<u8> = data.truths[0].iter().map(|&label| if label > 0 { GIVEN + label } else { 0 }).collect();
    session.paint(0, &given)?;
    let frame_milliseconds = session.effort.per_frame();

    let mut numbers: Vec<u8> = data.truths[0].iter().copied().filter(|&number| number > 0).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let is_other = |label: u8, number: u8| label > GIVEN && label != GIVEN + number && label != NOTHING_SAID;
    let mut objects = Vec::new();
    for &number in &numbers {
        let truths = masks(&data.truths, number);
        // Infinite where it is not judged: in the given frame and where it is out of sight.
        let seen = |session: &Session<'_>| {
            let values = each(&masks(&session.labels, GIVEN + number), &truths);
            let judged =
                |(t, value): (usize, f64)| if t > 0 && truths[t].contains(&true) { value } else { f64::INFINITY };
            values.into_iter().enumerate().map(judged).collect::<Vec<f64>>()
        };
        let of = |values: &[f64]| mean(&values.iter().copied().filter(|value| value.is_finite()).collect::<Vec<_>>());
        let before = seen(&session);
        if !before.iter().any(|value| value.is_finite()) {
            continue;
        }
        let worst = worst(&before);
        let found = of_label(&session.labels[worst], GIVEN + number);
        let mut said = vec![NOTHING_SAID; found.len()];
        // What is another's, truly or as given, is not this object's to correct.
        let free = |p: usize| {
            let truth = data.truths[worst][p];
            let others = truth != number && numbers.contains(&truth);
            !others && !is_other(session.labels[worst][p], number)
        };
        View { width, truth: &truths[worst], found: &found }.draw(GIVEN + number, free, &mut said);
        let mut corrected = session.clone();
        corrected.paint(worst, &said)?;
        let pixels = session.labels.iter().flatten().zip(corrected.labels.iter().flatten());
        let changed = |&(&a, &b): &(&u8, &u8)| a != b && (is_other(a, number) || is_other(b, number));
        let (assigned, stroked) = (of(&before), of(&seen(&corrected)));
        let last = &before[3 * before.len() / 4..];
        let last_quarter = last.iter().any(|value| value.is_finite()).then(|| of(last));
        objects.push(Object { assigned, last_quarter, stroked, others_changed: pixels.filter(changed).count() });
    }
    let quality = options.quality_name().into();
    Ok(Row { clip: case.name.clone(), quality, objects, frame_milliseconds })
}
