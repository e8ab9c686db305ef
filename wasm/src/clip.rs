//! Calls on clips. What there is of a clip stays in the module between calls; the caller gives it a number.
//!
//! A stream is pushed frame by frame until it is finished. A whole clip is pushed, then concluded (or restored from its saved state); after
//! that it gives labels of any frame and takes corrections. All calls return `null` if there is no such clip, or it is not that far.
//!
//! The handle is a number, not an exported object, because the package replaces the instance after a panic: a pointer into the old instance
//! would be used in the new one. A number that is used only once is simply not found there.

use std::cell::RefCell;

use js_sys::Uint8Array;
use wasm_bindgen::prelude::*;

use crate::frames::{frame_from_pixels, pair_option};
use crate::plain::{Record, list, numbers};
use crate::{Failure, entries, invalid};
use veronese::clip::{
    ClipCorrection, ClipFrame, ClipObject, ClipOptions, ClipSegmenter, FramePairs, MAX_LOOK_AHEAD, Prompt,
    SegmentedClip, Spread, StreamSegmenter,
};
use veronese::{AffineMotion, Error, Frame};

thread_local! {
    /// Clips in progress; rarely more than one.
    static CLIPS: RefCell<Vec<(u32, Clip)>> = const { RefCell::new(Vec::new()) };
}

/// What there is of a clip.
enum Clip {
    Stream(StreamSegmenter),
    Pairs(ClipSegmenter),
    Segmented {
        clip: SegmentedClip,
        correction: Option<ClipCorrection>,
        /// Whether it came as bytes.
        restored: bool,
    },
}

/// Begins a clip. `clip` is a number that no other clip has had. Options: `motions`, `quality`, `markUnknown` and `lookAhead`
/// (`'all'`, the default, stands for as many frames as matter).
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`.
#[wasm_bindgen(js_name = beginClip)]
pub fn begin_clip(clip: u32, whole: bool, options: &JsValue) -> Result<(), JsValue> {
    let options = clip_options(options)?;
    let begun = if whole {
        ClipSegmenter::new(options).map(Clip::Pairs)
    } else {
        StreamSegmenter::new(options).map(Clip::Stream)
    };
    keep(clip, begun.map_err(Failure::from)?);
    Ok(())
}

/// Adds a frame, `{ data, width, height }`. A stream returns a frame that has waited long enough as `{ index, labels, objects,
/// background }`, or `undefined` if there is none. A whole clip returns what the frame's pairs have told as bytes, or `undefined` if these
/// bytes were `known`; bytes that are damaged, or of another version, other options or other frames count as unknown.
///
/// # Errors
/// A `VeroneseError` of code `frame-size-mismatch`, or `invalid-input` for a malformed frame. The clip can continue with another frame.
#[wasm_bindgen(js_name = pushClip)]
pub fn push_clip(clip: u32, frame: &JsValue, known: Option<Vec<u8>>) -> Result<JsValue, JsValue> {
    let mut given = Some((frame_from_pixels("the frame", frame)?, known));
    step(clip, &mut |clip| {
        let (frame, known) = given.take()?;
        match clip {
            Clip::Stream(stream) => {
                Some(stream.push(frame).map(|frame| frame.map_or(JsValue::UNDEFINED, |frame| clip_frame(&frame))))
            }
            Clip::Pairs(segmenter) => Some(push_pairs(segmenter, frame, known)),
            Clip::Segmented { .. } => None,
        }
    })
}

fn push_pairs(segmenter: &mut ClipSegmenter, frame: Frame, known: Option<Vec<u8>>) -> Result<JsValue, Error> {
    if let Some(pairs) = known.and_then(|bytes| FramePairs::from_bytes(&bytes).ok()) {
        match segmenter.push_known(frame.clone(), &pairs) {
            Err(Error::InvalidOption { .. }) => {}
            pushed => return pushed.map(|()| JsValue::UNDEFINED),
        }
    }
    segmenter.push(frame).map(|pairs| bytes(&pairs.to_bytes()))
}

/// What the pairs of a whole clip tell so far of the newest frame whose pairs are all solved, as [`push_clip`] of a stream returns it;
/// `undefined` if there is none that was not returned before.
#[wasm_bindgen(js_name = previewClip)]
pub fn preview_clip(clip: u32) -> Result<JsValue, JsValue> {
    step(clip, &mut |clip| match clip {
        Clip::Pairs(segmenter) => Some(Ok(segmenter.preview().map_or(JsValue::UNDEFINED, |frame| clip_frame(&frame)))),
        _ => None,
    })
}

/// Ends a stream. Returns `{ frames, dropped }`: the frames that were still waiting, and the number of objects beyond the last number.
#[wasm_bindgen(js_name = finishClip)]
pub fn finish_clip(clip: u32) -> JsValue {
    match take(clip) {
        Some(Clip::Stream(mut stream)) => {
            let frames = stream.finish();
            Record::new().list("frames", &frames, clip_frame).count("dropped", stream.dropped()).into_value()
        }
        _ => JsValue::NULL,
    }
}

/// Concludes a whole clip of the frames so far. Returns what [`restore_clip`] does.
#[wasm_bindgen(js_name = concludeClip)]
pub fn conclude_clip(clip: u32) -> JsValue {
    match take(clip) {
        Some(Clip::Pairs(segmenter)) => keep_segmented(clip, segmenter.conclude(), false),
        _ => JsValue::NULL,
    }
}

/// Puts a concluded clip, from the bytes of [`save_clip`], in the place of one that has begun. Returns `{ length, width, height, dropped }`.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option` for other bytes.
#[wasm_bindgen(js_name = restoreClip)]
pub fn restore_clip(clip: u32, state: &[u8], mark_unknown: bool) -> Result<JsValue, JsValue> {
    let mut segmented = SegmentedClip::from_bytes(state).map_err(Failure::from)?;
    segmented.mark_unknown(mark_unknown);
    end_clip(clip);
    Ok(keep_segmented(clip, segmented, true))
}

/// The bytes of a concluded clip, for [`restore_clip`].
#[wasm_bindgen(js_name = saveClip)]
pub fn save_clip(clip: u32) -> Result<JsValue, JsValue> {
    segmented(clip, &mut |clip, _| Ok(bytes(&clip.to_bytes())))
}

/// A frame of a concluded clip, as [`push_clip`] of a stream returns it.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`, `frame-size-mismatch` or `invalid-input`. A frame that is not the one that was segmented is
/// `invalid-input`, of a restored clip `invalid-option`.
#[wasm_bindgen(js_name = clipFrame)]
pub fn frame_of_clip(clip: u32, index: usize, frame: &JsValue) -> Result<JsValue, JsValue> {
    let frame = frame_from_pixels("the frame", frame)?;
    segmented(clip, &mut |clip, _| clip.frame(index, &frame).map(|frame| clip_frame(&frame)))
}

/// Keeps numbers of a concluded clip for objects of a person: those that were found get others. Returns the indices of the frames that
/// change.
#[wasm_bindgen(js_name = reserveClip)]
pub fn reserve_clip(clip: u32, numbers: &[u8]) -> Result<JsValue, JsValue> {
    segmented(clip, &mut |clip, _| Ok(indices(&clip.reserve(numbers))))
}

/// The objects of a concluded clip that no correction of others changes; all others can be changed from now on.
#[wasm_bindgen(js_name = lockClip)]
pub fn lock_clip(clip: u32, objects: &[u8]) -> Result<JsValue, JsValue> {
    segmented(clip, &mut |clip, _| {
        clip.lock(objects);
        Ok(JsValue::UNDEFINED)
    })
}

/// Begins a correction of a concluded clip: what is certain of every pixel of a frame, 255 for nothing. It first wants that frame. Where it
/// spreads is `forward`, `backward`, both or neither.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`.
#[wasm_bindgen(js_name = correctClip)]
pub fn correct_clip(clip: u32, index: usize, labels: &[u8], forward: bool, backward: bool) -> Result<JsValue, JsValue> {
    let spread = match (forward, backward) {
        (true, true) => Spread::Both,
        (true, false) => Spread::Forward,
        (false, true) => Spread::Backward,
        (false, false) => Spread::None,
    };
    segmented(clip, &mut |clip, correction| {
        *correction = Some(clip.correct(index, labels, spread)?);
        Ok(JsValue::UNDEFINED)
    })
}

/// What is to be said to [`correct_clip`] of a frame of a concluded clip when the object of a number is where a click (`[x, y]`) or a box
/// (`[x, y, width, height]`) points to.
///
/// # Errors
/// As [`frame_of_clip`].
#[wasm_bindgen(js_name = outlineClip)]
pub fn outline_clip(clip: u32, index: usize, frame: &JsValue, prompt: &[u32], number: u8) -> Result<JsValue, JsValue> {
    let frame = frame_from_pixels("the frame", frame)?;
    segmented(clip, &mut |clip, _| {
        let prompt = match *prompt {
            [x, y, width, height] => Prompt::Box([x, y, width, height].map(|side| side as usize)),
            [x, y] => Prompt::Click([x, y].map(|at| at as usize)),
            _ => return Err(Error::InvalidOption { name: "prompt", reason: "has two or four numbers".into() }),
        };
        clip.outline(index, &frame, prompt, number).map(|said| bytes(&said))
    })
}

/// Takes the frame that the correction wants. Returns `{ wanted, changed }`: the index of the next one, `undefined` at the end, and of the
/// frames that have changed since the call before for the first time.
///
/// # Errors
/// As [`frame_of_clip`].
#[wasm_bindgen(js_name = takeCorrection)]
pub fn take_correction(clip: u32, frame: &JsValue) -> Result<JsValue, JsValue> {
    let frame = frame_from_pixels("the frame", frame)?;
    segmented(clip, &mut |clip, correction| {
        let Some(under_way) = correction else { return Ok(JsValue::NULL) };
        let known = under_way.changed().len();
        under_way.take(clip, &frame)?;
        let wanted = under_way.wanted().map(|index| index as f64);
        let changed = indices(&under_way.changed()[known..]);
        Ok(Record::new().set("wanted", &wanted.into()).set("changed", &changed).into_value())
    })
}

/// Gives an object another number, 0 to make it background; numbers that no object has change nothing. Returns the indices of the frames
/// that change.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`.
#[wasm_bindgen(js_name = renumberClip)]
pub fn renumber_clip(clip: u32, object: u8, number: u8) -> Result<JsValue, JsValue> {
    segmented(clip, &mut |clip, _| clip.renumber(object, number).map(|changed| indices(&changed)))
}

/// Ends a clip and frees its memory. Does nothing if there is no such clip.
#[wasm_bindgen(js_name = endClip)]
pub fn end_clip(clip: u32) {
    drop(take(clip));
}

fn keep(number: u32, clip: Clip) {
    CLIPS.with_borrow_mut(|clips| clips.push((number, clip)));
}

fn keep_segmented(number: u32, clip: SegmentedClip, restored: bool) -> JsValue {
    let [width, height] = clip.size();
    let described = Record::new()
        .count("length", clip.len())
        .count("width", width)
        .count("height", height)
        .count("dropped", clip.dropped())
        .into_value();
    keep(number, Clip::Segmented { clip, correction: None, restored });
    described
}

fn take(clip: u32) -> Option<Clip> {
    CLIPS.with_borrow_mut(|clips| {
        let place = clips.iter().position(|(number, _)| *number == clip)?;
        Some(clips.swap_remove(place).1)
    })
}

/// What `work` makes of a clip, or `null`. Not generic: each call would have a copy of its own.
fn step(clip: u32, work: &mut dyn FnMut(&mut Clip) -> Option<Result<JsValue, Error>>) -> Result<JsValue, JsValue> {
    let done = CLIPS.with_borrow_mut(|clips| {
        let (_, clip) = clips.iter_mut().find(|(number, _)| *number == clip)?;
        work(clip)
    });
    Ok(done.transpose().map_err(Failure::from)?.unwrap_or(JsValue::NULL))
}

/// What is done with a clip that is concluded and with the correction that goes through it.
type Work<'a> = &'a mut dyn FnMut(&mut SegmentedClip, &mut Option<ClipCorrection>) -> Result<JsValue, Error>;

/// [`step`] for a clip that is concluded. Frames that are not those of a state are the state's fault.
fn segmented(clip: u32, work: Work<'_>) -> Result<JsValue, JsValue> {
    step(clip, &mut |clip| match clip {
        Clip::Segmented { clip, correction, restored } => Some(work(clip, correction).map_err(|error| match error {
            Error::OtherFrame { .. } if *restored => Error::InvalidOption { name: "state", reason: error.to_string() },
            error => error,
        })),
        _ => None,
    })
}

fn bytes(bytes: &[u8]) -> JsValue {
    Uint8Array::from(bytes).into()
}

fn indices(indices: &[usize]) -> JsValue {
    list(indices, |index| (*index as f64).into())
}

fn clip_options(value: &JsValue) -> Result<ClipOptions, Failure> {
    let mut options = ClipOptions::default();
    for (name, value) in entries(value)? {
        match name.as_str() {
            "lookAhead" => options.look_ahead = look_ahead(&value)?,
            _ => pair_option(&mut options.pair, &name, &value, "motions, quality, markUnknown, lookAhead")?,
        }
    }
    Ok(options)
}

/// None for `'all'`.
fn look_ahead(value: &JsValue) -> Result<Option<usize>, Failure> {
    match (value.as_string().as_deref(), value.as_f64()) {
        (Some("all"), _) => Ok(None),
        (_, Some(n)) if (0.0..=MAX_LOOK_AHEAD as f64).contains(&n) && n == n.floor() => Ok(Some(n as usize)),
        _ => Err(invalid("lookAhead", &format!("'all' or a whole number from 0 to {MAX_LOOK_AHEAD}"), value)),
    }
}

fn clip_frame(frame: &ClipFrame) -> JsValue {
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
