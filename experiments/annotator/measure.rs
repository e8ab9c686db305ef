//! What an annotator gets for what he does, on clips with masks of one object.
use std::collections::BTreeMap;

use experiments::Failure;
use experiments::annotator::overlap::{between, each, masks, mean, of_label, worst};
use experiments::annotator::robot::{NOTHING_SAID, View, depths};
use experiments::clips::cases::{Case, Data, labels};
use serde::Serialize;
use veronese::clip::{Click, Prompt, Spread};

use crate::Options;
use crate::harm::Change;
use crate::session::{Effort, Session};

/// Clips that had part in setting constants before the others came.
const OLD: [&str; 10] =
    ["boat", "bus", "car-turn", "elephant", "flamingo", "hockey", "kite-walk", "scooter-gray", "soccerball", "tennis"];
/// The number of the object whose mask is given, and that of one that no label found fits.
pub(crate) const GIVEN: u8 = 200;
const NEW: u8 = 250;
/// Frames further than this from every stroke are far, and this is a loss of J there.
const FAR: usize = 8;
const LOSS: f64 = 0.02;
/// Least J of a label that is taken for the object.
const FITS: f64 = 0.05;

/// The figures of a clip. J is the mean IoU over all frames unless said.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Row {
    clip: String,
    /// Whether constants of clips were first set on it.
    old: bool,
    quality: String,
    frames: usize,
    /// J of everything but the background label, nothing said.
    auto: f64,
    /// J of the one label that fits best, as one click gives it.
    click: f64,
    /// J of the object in the frames between the first and the last, its true mask of frame 0 given.
    mask: f64,
    /// J of the object when a box around its true mask of frame 0 points to it, or the deepest pixel of that.
    boxed: Pointed,
    touched: Pointed,
    /// J of the object's label after one click and 0, 1, … rounds of strokes in the worst frame.
    rounds: Vec<f64>,
    /// Frames more than eight away from every stroke in which the object lost .02 or more in a round, and all such frames.
    far_lost: [usize; 2],
    /// Pixels of what was found that a box elsewhere, in the last frame but one, gave to anything but its own object.
    others_changed: usize,
    /// Pixels of two accepted frames that a round of strokes in another one changed.
    accepted_changed: usize,
    /// Time of each round, and of a frame that a correction changed.
    round_seconds: Vec<f64>,
    frame_milliseconds: f64,
    /// `mask` of OpenCV's flow and GrabCut.
    baseline: Option<f64>,
    /// `boxed.at_once` of OpenCV's GrabCut.
    baseline_boxed: Option<f64>,
}

/// What comes of pointing to an object in frame 0.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Pointed {
    /// J there.
    at_once: f64,
    /// J in the frames between the first and the last.
    through: f64,
    milliseconds: f64,
}

/// All figures of a clip.
pub(crate) fn measure(case: &Case, options: &Options) -> Result<Row, Failure> {
    let data = case.load()?;
    let automatic = open(case, &data, options)?;
    figures_of(case, &data, &automatic, options)
}

/// The clip as it is segmented when nothing is said.
pub(crate) fn open<'a>(case: &Case, data: &'a Data, options: &Options) -> Result<Session<'a>, Failure> {
    Session::open(&data.frames, options.quality, &options.pairs(case))
}

/// All figures of a clip that is segmented.
fn figures_of(case: &Case, data: &Data, automatic: &Session<'_>, options: &Options) -> Result<Row, Failure> {
    let width = width_of(case, data)?;
    let truths = truths_of(data);

    let (_, background) = areas(&automatic.labels);
    let moving = |labels: &Vec<u8>| labels.iter().map(|&label| label != background && label != NOTHING_SAID).collect();
    let auto = mean(&each(&automatic.labels.iter().map(moving).collect::<Vec<_>>(), &truths));
    let (session, mask) = given(automatic, &truths)?;
    let mut effort = session.effort;
    let [boxed, touched] = prompts(&truths[0], width).map(|prompt| pointed(automatic, prompt, &truths));
    let (boxed, touched) = (boxed?, touched?);
    let Rounds { click, rounds, far_lost, seconds: round_seconds, effort: of_rounds, .. } =
        corrected(case, data, automatic, options)?;
    let (others_changed, accepted_changed) =
        (others_changed(automatic, width)?, accepted_changed(automatic, &truths, width)?);
    effort.time += of_rounds.time;
    effort.frames += of_rounds.frames;
    let baseline = baseline(case, data, options, &truths)?;
    let baseline_boxed = baseline_boxed(case, data, options, &truths)?;
    let (clip, quality, frame_milliseconds) = (case.name.clone(), options.quality_name().into(), effort.per_frame());
    Ok(Row {
        old: is_old(&clip),
        clip,
        quality,
        frames: truths.len(),
        auto,
        click,
        mask,
        boxed,
        touched,
        rounds,
        far_lost,
        others_changed,
        accepted_changed,
        round_seconds,
        frame_milliseconds,
        baseline,
        baseline_boxed,
    })
}

/// Mean J of a mask given and of the last round of strokes.
pub(crate) fn score(case: &Case, data: &Data, automatic: &Session<'_>, options: &Options) -> Result<f64, Failure> {
    let (_, mask) = given(automatic, &truths_of(data))?;
    let corrected = corrected(case, data, automatic, options)?;
    Ok(0.5 * (mask + corrected.rounds.last().copied().unwrap_or(corrected.click)))
}

pub(crate) fn width_of(case: &Case, data: &Data) -> Result<usize, Failure> {
    Ok(data.frames.first().ok_or_else(|| format!("{} has no frames", case.name))?.width())
}

pub(crate) fn truths_of(data: &Data) -> Vec<Vec<bool>> {
    data.truths.iter().map(|truth| of_label(truth, 1)).collect()
}

/// The clip with the true mask of its first frame, and the object's J in the others.
fn given<'a>(automatic: &Session<'a>, truths: &[Vec<bool>]) -> Result<(Session<'a>, f64), Failure> {
    let mut session = automatic.clone();
    let given: Vec<u8> = truths[0].iter().map(|&object| if object { GIVEN } else { 0 }).collect();
    session.paint(0, &given)?;
    let mask = between(&masks(&session.labels, GIVEN), truths);
    Ok((session, mask))
}

/// What a click gives, and rounds of strokes after it.
pub(crate) struct Rounds {
    click: f64,
    /// J, that of the click first.
    rounds: Vec<f64>,
    far_lost: [usize; 2],
    /// What each round did to the other frames.
    pub(crate) changes: Vec<Change>,
    seconds: Vec<f64>,
    effort: Effort,
}

pub(crate) fn corrected(
    case: &Case,
    data: &Data,
    automatic: &Session<'_>,
    options: &Options,
) -> Result<Rounds, Failure> {
    let (width, truths) = (width_of(case, data)?, truths_of(data));
    let (count, pixels) = (truths.len(), truths[0].len());
    let (label, click) = best_label(&automatic.labels, &truths)
        .unwrap_or_else(|| (NEW, mean(&each(&vec![vec![false; pixels]; count], &truths))));
    let label = if click < FITS { NEW } else { label };
    let mut session = automatic.clone();
    let (mut rounds, mut changes, mut seconds) = (vec![click], Vec::new(), Vec::new());
    let mut strokes: BTreeMap<usize, Vec<u8>> = BTreeMap::new();
    let mut far_lost = [0; 2];
    for _ in 0..options.rounds {
        let found = masks(&session.labels, label);
        let worst = worst(&each(&found, &truths));
        let said = strokes.entry(worst).or_insert_with(|| vec![NOTHING_SAID; pixels]);
        View { width, truth: &truths[worst], found: &found[worst] }.draw(label, |_| true, said);
        let before = session.effort.time;
        let last = each(&found, &truths);
        session.paint(worst, said)?;
        seconds.push((session.effort.time - before).as_secs_f64());
        let after = masks(&session.labels, label);
        changes.push(Change::between([&found, &after], &truths, |t| t == worst));
        let now = each(&after, &truths);
        for t in (0..now.len()).filter(|t| strokes.keys().all(|stroke| stroke.abs_diff(*t) > FAR)) {
            far_lost[1] += 1;
            far_lost[0] += usize::from(now[t] <= last[t] - LOSS);
        }
        rounds.push(mean(&now));
    }
    Ok(Rounds { click, rounds, far_lost, changes, seconds, effort: session.effort })
}

/// Draws a box around ground in the last frame but one, and counts the pixels of what was found that become anything but its object.
fn others_changed(automatic: &Session<'_>, width: usize) -> Result<usize, Failure> {
    let mut session = automatic.clone();
    let frame = session.labels.len().saturating_sub(2);
    let ground = of_label(&session.labels[frame], 0);
    let height = ground.len() / width;
    let depths = depths(&ground, width);
    let deepest = (0..ground.len()).rev().max_by_key(|&p| depths[p]).unwrap_or(0);
    let sides = [width / 8, height / 8];
    let corner = [deepest % width, deepest / width].map(|at| at as isize);
    let at = |k: usize, side: usize| (corner[k] - sides[k] as isize / 2).clamp(0, (side - sides[k]) as isize) as usize;
    let within = Some([at(0, width), at(1, height), sides[0], sides[1]]);
    session.point(Prompt { frame, object: GIVEN, clicks: Vec::new(), within, spread: Spread::Both })?;
    let pixels = automatic.labels.iter().flatten().zip(session.labels.iter().flatten());
    Ok(pixels.filter(|&(before, now)| *before != 0 && before != now && *now != GIVEN).count())
}

/// Accepts two frames, draws strokes in the worst of the others, and counts the pixels of the accepted ones that change.
fn accepted_changed(automatic: &Session<'_>, truths: &[Vec<bool>], width: usize) -> Result<usize, Failure> {
    let mut session = automatic.clone();
    let count = truths.len();
    let accepted = [count / 3, 2 * count / 3];
    session.accept(&accepted)?;
    let label = best_label(&session.labels, truths).map_or(NEW, |(label, _)| label);
    let found = masks(&session.labels, label);
    let mut scores = each(&found, truths);
    accepted.iter().for_each(|&t| scores[t] = f64::INFINITY);
    let worst = worst(&scores);
    let mut said = vec![NOTHING_SAID; truths[0].len()];
    View { width, truth: &truths[worst], found: &found[worst] }.draw(label, |_| true, &mut said);
    session.paint(worst, &said)?;
    let changed = |&t: &usize| automatic.labels[t].iter().zip(&session.labels[t]).filter(|(a, b)| a != b).count();
    Ok(accepted.iter().map(changed).sum())
}

/// The smallest box around a mask.
pub(crate) fn boxed(mask: &[bool], width: usize) -> [usize; 4] {
    let inside: Vec<usize> = (0..mask.len()).filter(|&p| mask[p]).collect();
    let columns = || inside.iter().map(|p| p % width);
    let (left, right) = (columns().min().unwrap_or(0), columns().max().unwrap_or(0));
    let (top, bottom) = (inside.first().map_or(0, |p| p / width), inside.last().map_or(0, |p| p / width));
    [left, top, right + 1 - left, bottom + 1 - top]
}

/// The deepest pixel of a mask, the first of equals.
pub(crate) fn deepest(mask: &[bool], width: usize) -> usize {
    let depths = depths(mask, width);
    (0..mask.len()).rev().max_by_key(|&p| depths[p]).unwrap_or(0)
}

/// The smallest box around a mask, and a click at its deepest pixel, the first of equals.
fn prompts(mask: &[bool], width: usize) -> [Prompt; 2] {
    let deepest = deepest(mask, width);
    let within = Some(boxed(mask, width));
    let click = Click { at: [deepest % width, deepest / width], inside: true };
    let nothing = Prompt { frame: 0, object: GIVEN, clicks: Vec::new(), within: None, spread: Spread::Both };
    [Prompt { within, ..nothing.clone() }, Prompt { clicks: vec![click], ..nothing }]
}

fn pointed(automatic: &Session<'_>, prompt: Prompt, truths: &[Vec<bool>]) -> Result<Pointed, Failure> {
    let mut session = automatic.clone();
    let (shown, took) = session.point(prompt)?;
    let at_once = each(&[of_label(&shown, GIVEN)], &truths[..1])[0];
    let through = between(&masks(&session.labels, GIVEN), truths);
    Ok(Pointed { at_once, through, milliseconds: 1e3 * took.as_secs_f64() })
}

/// J in the first frame of what GrabCut makes of the box, if it ran.
fn baseline_boxed(case: &Case, data: &Data, options: &Options, truths: &[Vec<bool>]) -> Result<Option<f64>, Failure> {
    let frame = Data { frames: data.frames[..1].to_vec(), truths: data.truths[..1].to_vec() };
    let found = labels(&options.out.join("baseline").join(&case.name).join("box"), &frame)?;
    Ok(found.map(|labels| each(&masks(&labels, 1), &truths[..1])[0]))
}

/// Pixels of every label, and the label with most of them, the background's.
fn areas(labels: &[Vec<u8>]) -> ([usize; 256], u8) {
    let mut areas = [0usize; 256];
    labels.iter().flatten().for_each(|&label| areas[usize::from(label)] += 1);
    // The first of equals.
    let background = (0..=u8::MAX).rev().max_by_key(|&label| areas[usize::from(label)]).unwrap_or(0);
    (areas, background)
}

/// The label that fits best over the clip, and its J, if there is one beside the background's.
pub(crate) fn best_label(labels: &[Vec<u8>], truths: &[Vec<bool>]) -> Option<(u8, f64)> {
    let (areas, background) = areas(labels);
    let of = |label: u8| mean(&each(&masks(labels, label), truths));
    let there = (0..NOTHING_SAID).filter(|&label| label != background && areas[usize::from(label)] > 0);
    there.map(|label| (label, of(label))).reduce(|a, b| if b.1 > a.1 { b } else { a })
}

/// J between the first and the last frame of what OpenCV made of the first mask, if it ran.
fn baseline(case: &Case, data: &Data, options: &Options, truths: &[Vec<bool>]) -> Result<Option<f64>, Failure> {
    let found = labels(&options.out.join("baseline").join(&case.name), data)?;
    Ok(found.map(|labels| between(&masks(&labels, 1), truths)))
}

pub(crate) fn is_old(clip: &str) -> bool {
    OLD.contains(&clip)
}
