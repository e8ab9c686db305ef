//! Calls on clips. The module keeps a clip from its opening to its closing, under a number that the caller gives it.
//!
//! The caller gives a clip commands ([`apply_clip`]) and the frames that it wants ([`take_clip`]). Each call that changes a clip returns a
//! plain object: `{ records, replaces, frames, settled, cancelled, wanted, steps }`, and where more may have changed also `status`, what is
//! known of frames and objects. pkg/src/calls/messages.ts has all fields. Calls return `null` if there is no such clip.
//!
//! The handle is a number, not an exported object, because the package replaces the instance after a panic: a pointer into the old instance
//! would be used in the new one. A number that is used only once is simply not found there.

use std::cell::RefCell;

use js_sys::{Array, Float64Array, Reflect, Uint8Array};
use wasm_bindgen::prelude::*;

use crate::frames::{frame_from_pixels, pair_option};
use crate::plain::{Record, list, numbers};
use crate::{Failure, entries, unknown};
use veronese::clip::{
    Annotation, Changed, Click, Clip, ClipFrame, ClipObject, ClipStage, Command, Content, Declaration, Description,
    Events, FramePairs, Object, OpenOptions, Recovered, Settled, Spread, StepId, Wanted, solve_pair,
};
use veronese::{AffineMotion, Error, SegmentOptions};

thread_local! {
    static CLIPS: RefCell<Vec<(u32, Clip)>> = const { RefCell::new(Vec::new()) };
}

/// Opens a clip of so many frames, or one that was saved. `clip` is a number that no other clip has had. With `saved` the result also has
/// `length`, the number of frames, `used`, the number of bytes that were read, and `isDamaged`.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`.
#[wasm_bindgen(js_name = openClip)]
pub fn open_clip(clip: u32, frames: usize, mark_unknown: bool, saved: Option<Vec<u8>>) -> Result<JsValue, JsValue> {
    let options = OpenOptions::default().with_mark_unknown(mark_unknown);
    let mut record = Record::new();
    let mut opened = match &saved {
        None => Clip::new(frames, options).map_err(Failure::from)?,
        Some(bytes) => {
            let Recovered { clip, used, is_damaged, .. } = Clip::read(bytes, options).map_err(Failure::from)?;
            record = record.count("used", used).set("isDamaged", &is_damaged.into());
            clip
        }
    };
    record = record.count("length", opened.len());
    let answer = answer(record, &mut opened, true);
    CLIPS.with_borrow_mut(|clips| clips.push((clip, opened)));
    Ok(answer)
}

/// Gives a clip a command, as `ClipCommand` of pkg/src/calls/messages.ts. The result also has `step`, its number.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option` or `object-locked`. Nothing has changed then.
#[wasm_bindgen(js_name = applyClip)]
pub fn apply_clip(clip: u32, given: &JsValue) -> Result<JsValue, JsValue> {
    let saved = bytes_in(given, "saved");
    let mut command = if saved.is_none() { Some(command(given)?) } else { None };
    with(clip, &mut |clip| {
        let step = match (&saved, command.take()) {
            (Some(saved), _) => clip.restore(saved)?,
            (None, Some(command)) => clip.apply(command)?,
            (None, None) => return Ok(JsValue::NULL),
        };
        Ok(answer(Record::new().number("step", step_number(step)), clip, true))
    })
}

/// Does `what`, and says in `done` whether there was something to do: `undo` or `redo` a step, `cancel` one that has not taken effect, or
/// `finish` a range after the frames that are in.
#[wasm_bindgen(js_name = moveClip)]
pub fn move_clip(clip: u32, what: &str, step: u32) -> Result<JsValue, JsValue> {
    with(clip, &mut |clip| {
        let done = match what {
            "undo" => clip.undo(),
            "redo" => clip.redo(),
            "cancel" => clip.cancel(step.into()),
            _ => {
                clip.finish(step.into());
                true
            }
        };
        Ok(answer(Record::new().set("done", &done.into()), clip, true))
    })
}

/// Gives a clip a frame that it wants, `{ data, width, height }`, with the solved pairs if there are some. The result also has `labels`, if the
/// frame was wanted for these, and with `draft` the `draft` of a frame, if there is a new one.
///
/// # Errors
/// A `VeroneseError` of code `frame-size-mismatch`, or `invalid-input` for a malformed frame, or one other than that which was segmented.
#[wasm_bindgen(js_name = takeClip)]
pub fn take_clip(
    clip: u32,
    index: usize,
    frame: &JsValue,
    solved: Option<Vec<u8>>,
    draft: bool,
) -> Result<JsValue, JsValue> {
    let frame = frame_from_pixels("the frame", frame)?;
    let solved = solved.and_then(|bytes| FramePairs::from_bytes(&bytes).ok());
    with(clip, &mut |clip| {
        let is_for_labels = clip.wanted().is_some_and(|wanted| wanted.stage == ClipStage::Labels);
        clip.take(index, &frame, solved.as_ref())?;
        let mut record = Record::new();
        if is_for_labels {
            record = with_labels(record, clip, index);
        }
        if let Some(draft) = draft.then(|| clip.preview()).flatten() {
            record = record.set("draft", &clip_frame(&draft));
        }
        Ok(answer(record, clip, false))
    })
}

/// Asks for the labels of a frame. The result has them as `labels` if they are known; otherwise the clip wants the frame for them, if it has
/// masks. Without an index no labels are asked for.
#[wasm_bindgen(js_name = lookAtClip)]
pub fn look_at_clip(clip: u32, index: Option<usize>) -> Result<JsValue, JsValue> {
    with(clip, &mut |clip| {
        clip.look_at(index);
        let record = Record::new();
        let record = if let Some(index) = index { with_labels(record, clip, index) } else { record };
        Ok(answer(record, clip, false))
    })
}

/// The annotations of a frame, as the package's `ClipAnnotation`.
#[wasm_bindgen(js_name = annotationsOfClip)]
pub fn annotations_of_clip(clip: u32, index: usize) -> Result<JsValue, JsValue> {
    with(clip, &mut |clip| Ok(list(&clip.annotations(index), annotation_record)))
}

/// The bytes of a clip, for [`open_clip`].
#[wasm_bindgen(js_name = saveClip)]
pub fn save_clip(clip: u32) -> Result<JsValue, JsValue> {
    with(clip, &mut |clip| Ok(bytes(&clip.save())))
}

/// Closes a clip and frees its memory. Does nothing if there is no such clip.
#[wasm_bindgen(js_name = closeClip)]
pub fn close_clip(clip: u32) {
    CLIPS.with_borrow_mut(|clips| clips.retain(|(number, _)| *number != clip));
}

/// The solved pairs of a frame with the previous one as bytes, for [`take_clip`]. Options are those of a range.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`, `frame-size-mismatch`, or `invalid-input` for a malformed frame.
#[wasm_bindgen(js_name = solvePair)]
pub fn solve_pair_of_frames(before: &JsValue, frame: &JsValue, options: &JsValue) -> Result<JsValue, JsValue> {
    let [before, frame] = [frame_from_pixels("the frame before", before)?, frame_from_pixels("the frame", frame)?];
    let pairs = solve_pair(&before, &frame, &range_options(options)?).map_err(Failure::from)?;
    Ok(bytes(&pairs.to_bytes()))
}

/// What `work` returns for a clip, or `null`. Not generic, so that it is compiled only once.
fn with(clip: u32, work: &mut dyn FnMut(&mut Clip) -> Result<JsValue, Error>) -> Result<JsValue, JsValue> {
    let done = CLIPS.with_borrow_mut(|clips| {
        let (_, clip) = clips.iter_mut().find(|(number, _)| *number == clip)?;
        Some(work(clip))
    });
    Ok(done.transpose().map_err(Failure::from)?.unwrap_or(JsValue::NULL))
}

/// Labels are asked for once: what is on a screen is asked for again when it changes.
fn with_labels(record: Record, clip: &mut Clip, index: usize) -> Record {
    match clip.labels(index) {
        None => record,
        Some(frame) => {
            clip.look_at(None);
            record.set("labels", &clip_frame(&frame))
        }
    }
}

/// Adds to a record what has happened, and what the clip wants next.
fn answer(record: Record, clip: &mut Clip, with_status: bool) -> JsValue {
    let Events { records, replaces, frames, settled, cancelled, .. } = clip.take_events();
    let cancelled: Vec<f64> = cancelled.into_iter().map(step_number).collect();
    let mut record = record
        .set("frames", &indices(&frames))
        .list("settled", &settled, settled_step)
        .numbers("cancelled", &cancelled)
        .numbers("steps", &clip.steps().map(|steps| steps as f64));
    if !records.is_empty() {
        record = record.bytes("records", &records).set("replaces", &replaces.into());
    }
    if let Some(Wanted { frame, stage, step, .. }) = clip.wanted() {
        let stage = match stage {
            ClipStage::Pairs => "pairs",
            ClipStage::Annotations => "annotations",
            ClipStage::Labels => "labels",
        };
        let step = step.map_or(0.0, step_number);
        let wanted = Record::new().count("frame", frame).text("stage", stage).number("step", step);
        record = record.set("wanted", &wanted.into_value());
    }
    if with_status || !settled.is_empty() {
        record = record.set("status", &status(clip));
    }
    record.into_value()
}

fn step_number(step: StepId) -> f64 {
    u32::from(step).into()
}

fn settled_step(settled: &Settled) -> JsValue {
    let Settled { step, changes, .. } = settled;
    let record = Record::new().number("step", step_number(*step));
    match changes {
        Ok(changes) => record.list("changes", changes, changed),
        Err(error) => record.text("code", error.code()).text("message", &error.to_string()),
    }
    .into_value()
}

/// What is known of all frames and objects. Each frame has a byte of flags (1 has masks, 2 accepted, 4 annotated) and its revision, of which
/// the low bits are left out.
fn status(clip: &Clip) -> JsValue {
    let frames = clip.frames();
    let flags: Vec<u8> = frames
        .iter()
        .map(|frame| u8::from(frame.has_masks) | u8::from(frame.accepted) << 1 | u8::from(frame.annotated) << 2)
        .collect();
    let revisions: Vec<f64> = frames.iter().map(|frame| (frame.revision >> 11) as f64).collect();
    let [width, height] = clip.size();
    Record::new()
        .bytes("flags", &flags)
        .set("revisions", &Float64Array::from(&revisions[..]))
        .list("objects", &clip.objects(), object)
        .count("nextObject", clip.next_object().map_or(0, usize::from))
        .count("width", width)
        .count("height", height)
        .count("dropped", clip.dropped())
        .set("solved", &indices(&clip.solved_pairs()))
        .into_value()
}

fn object(object: &Object) -> JsValue {
    let Object { number, description: Description { name, class, colour }, locked, annotated, became, .. } = object;
    let record = Record::new()
        .count("number", usize::from(*number))
        .text("name", name)
        .text("class", class)
        .set("locked", &(*locked).into())
        .set("annotated", &(*annotated).into())
        .count("became", usize::from(*became));
    match colour {
        Some(colour) => record.numbers("colour", &colour.map(f64::from)),
        None => record,
    }
    .into_value()
}

pub(super) fn bytes(bytes: &[u8]) -> JsValue {
    Uint8Array::from(bytes).into()
}

pub(super) fn indices(indices: &[usize]) -> JsValue {
    list(indices, |index| (*index as f64).into())
}

pub(super) fn changed(changed: &Changed) -> JsValue {
    let Changed { frame, object, gained, lost, .. } = changed;
    Record::new()
        .count("frame", *frame)
        .count("object", usize::from(*object))
        .count("gained", *gained)
        .count("lost", *lost)
        .into_value()
}

/// A command from its plain object, whose values the package has checked, except the options of a range.
fn command(value: &JsValue) -> Result<Command, Failure> {
    let objects = || bytes_in(value, "objects").unwrap_or_default();
    let frames = || each(value, "frames").iter().map(whole).collect();
    let object = || number(value, "object") as u8;
    let on = || get(value, "on").is_some_and(|on| on.is_truthy());
    Ok(match text(value, "type").as_str() {
        "segment" => {
            let options = range_options(&get(value, "options").unwrap_or_default())?;
            Command::Segment { frames: number(value, "first")..number(value, "last") + 1, options }
        }
        "annotate" => Command::Annotate(each(value, "annotations").iter().map(annotation).collect()),
        "clear" => {
            Command::Clear { frame: number(value, "frame"), object: Some(object()).filter(|&object| object > 0) }
        }
        "accept" => Command::Accept { frames: frames(), on: on() },
        "lock" => Command::Lock { objects: objects(), on: on() },
        "describe" => Command::Describe { object: object(), description: description(value), coalesce: on() },
        "merge" => Command::Merge(objects()),
        "delete" => Command::Delete(objects()),
        "split" => Command::Split { object: object(), frame: number(value, "frame"), new: number(value, "new") as u8 },
        _ => Command::ReplaceAnnotations(Declaration {
            annotations: each(value, "annotations").iter().map(annotation).collect(),
            locked: bytes_in(value, "locked").unwrap_or_default(),
            described: each(value, "described")
                .iter()
                .map(|of| (number(of, "object") as u8, description(of)))
                .collect(),
            merged: each(value, "merged").iter().map(|group| Uint8Array::new(group).to_vec()).collect(),
            deleted: bytes_in(value, "deleted").unwrap_or_default(),
            accepted: each(value, "accepted").iter().map(whole).collect(),
        }),
    })
}

fn annotation_record(annotation: &Annotation) -> JsValue {
    let Annotation { frame, content, spread } = annotation;
    let spread = match spread {
        Spread::Both => "both",
        Spread::Forward => "forward",
        Spread::Backward => "backward",
        Spread::None => "none",
        Spread::Exact => "exact",
    };
    let record = Record::new().count("frame", *frame).text("propagate", spread);
    match content {
        Content::Labels(labels) | Content::Given(labels) => record.bytes("labels", labels),
        Content::Strokes { object, labels } | Content::Mask { object, labels } => {
            record.count("object", usize::from(*object)).bytes("strokes", labels)
        }
        Content::Prompt { object, clicks, within } => {
            let click = |click: &Click| {
                let [x, y] = click.at.map(|at| at as f64);
                numbers(&[x, y, if click.inside { 1.0 } else { -1.0 }])
            };
            let record = record.count("object", usize::from(*object)).list("clicks", clicks, click);
            match within {
                Some(sides) => record.numbers("box", &sides.map(|side| side as f64)),
                None => record,
            }
        }
    }
    .into_value()
}

fn description(value: &JsValue) -> Description {
    let colour = bytes_in(value, "colour").and_then(|colour| colour.try_into().ok());
    Description { name: text(value, "name"), class: text(value, "class"), colour }
}

fn annotation(value: &JsValue) -> Annotation {
    let object = number(value, "object") as u8;
    let labels = bytes_in(value, "labels").unwrap_or_default();
    let content = match text(value, "content").as_str() {
        "strokes" => Content::Strokes { object, labels },
        "mask" => Content::Mask { object, labels },
        "labels" => Content::Labels(labels),
        "given" => Content::Given(labels),
        _ => {
            let [clicks, sides] = ["clicks", "box"].map(|name| each(value, name).iter().map(whole).collect::<Vec<_>>());
            let clicks = clicks.as_chunks::<3>().0.iter();
            let clicks = clicks.map(|&[x, y, inside]| Click { at: [x, y], inside: inside > 0 }).collect();
            Content::Prompt { object, clicks, within: sides.try_into().ok() }
        }
    };
    Annotation { frame: number(value, "frame"), content, spread: spread(value) }
}

pub(super) fn spread(value: &JsValue) -> Spread {
    match text(value, "propagate").as_str() {
        "forward" => Spread::Forward,
        "backward" => Spread::Backward,
        "none" => Spread::None,
        "exact" => Spread::Exact,
        _ => Spread::Both,
    }
}

/// The options of a range.
fn range_options(value: &JsValue) -> Result<SegmentOptions, Failure> {
    let mut options = SegmentOptions::default();
    for (name, value) in entries(value)? {
        match name.as_str() {
            "markUnknown" => return Err(unknown(&name, "motions, quality, subject")),
            _ => pair_option(&mut options, &name, &value, "motions, quality, subject")?,
        }
    }
    Ok(options)
}

pub(super) fn get(value: &JsValue, name: &str) -> Option<JsValue> {
    Reflect::get(value, &name.into()).ok().filter(|value| !value.is_undefined())
}

fn whole(value: &JsValue) -> usize {
    value.as_f64().unwrap_or_default() as usize
}

#[inline(never)]
fn text(value: &JsValue, name: &str) -> String {
    get(value, name).and_then(|text| text.as_string()).unwrap_or_default()
}

#[inline(never)]
pub(super) fn number(value: &JsValue, name: &str) -> usize {
    get(value, name).map_or(0, |value| whole(&value))
}

#[inline(never)]
pub(super) fn bytes_in(value: &JsValue, name: &str) -> Option<Vec<u8>> {
    get(value, name).map(|bytes| Uint8Array::new(&bytes).to_vec())
}

/// The entries of a list; none if there is no list.
#[inline(never)]
pub(super) fn each(value: &JsValue, name: &str) -> Vec<JsValue> {
    get(value, name).map(|list| Array::from(&list).to_vec()).unwrap_or_default()
}

pub(super) fn clip_frame(frame: &ClipFrame) -> JsValue {
    let ClipFrame { index, labels, objects, background, .. } = frame;
    Record::new()
        .count("index", *index)
        .bytes("labels", labels)
        .list("objects", objects, clip_object)
        .set("background", &matrix(background.as_ref()))
        .into_value()
}

fn clip_object(object: &ClipObject) -> JsValue {
    let ClipObject { id, pixels, bbox, confidence, matrix: motion, .. } = object;
    Record::new()
        .count("id", usize::from(*id))
        .count("pixels", *pixels)
        .numbers("bbox", &bbox.map(|side| side as f64))
        .number("confidence", *confidence)
        .set("matrix", &matrix(motion.as_ref()))
        .into_value()
}

fn matrix(motion: Option<&AffineMotion>) -> JsValue {
    motion.map_or(JsValue::NULL, |motion| numbers(&motion.matrix))
}
