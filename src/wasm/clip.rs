//! Calls on clips. The segmenter of a clip stays in the module between calls; the caller gives it a number.
//!
//! The handle is a number, not an exported object, because the package replaces the instance after a panic: a pointer into the old instance
//! would be used in the new one. A number that is used only once is simply not found there.

use std::cell::RefCell;

use wasm_bindgen::prelude::*;

use super::frames::{frame_from_pixels, quality};
use super::plain::{Record, numbers};
use super::{Failure, entries, invalid, motions, seed, unknown};
use crate::AffineMotion;
use crate::clip::{ClipFrame, ClipObject, ClipOptions, ClipSegmenter, MAX_LOOK_AHEAD};

thread_local! {
    /// Clips in progress; rarely more than one.
    static CLIPS: RefCell<Vec<(u32, ClipSegmenter)>> = const { RefCell::new(Vec::new()) };
}

/// Begins a clip. `clip` is a number that no other clip has had. Options: `motions`, `quality`, `seed` and `lookAhead` (`'all'`, the
/// default, stands for a whole clip).
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`.
#[wasm_bindgen(js_name = beginClip)]
pub fn begin_clip(clip: u32, options: &JsValue) -> Result<(), JsValue> {
    let segmenter = ClipSegmenter::new(clip_options(options)?).map_err(Failure::from)?;
    CLIPS.with_borrow_mut(|clips| clips.push((clip, segmenter)));
    Ok(())
}

/// Adds a frame, `{ data, width, height }`. Returns a frame that has waited long enough as `{ index, labels, objects, background }`,
/// `undefined` if there is none, or `null` if there is no such clip.
///
/// # Errors
/// A `VeroneseError` of code `frame-size-mismatch`, or `invalid-input` for a malformed frame. The clip can continue with another frame.
#[wasm_bindgen(js_name = pushClip)]
pub fn push_clip(clip: u32, frame: &JsValue) -> Result<JsValue, JsValue> {
    let frame = frame_from_pixels("the frame", frame)?;
    let pushed = CLIPS.with_borrow_mut(|clips| {
        let (_, segmenter) = clips.iter_mut().find(|(number, _)| *number == clip)?;
        Some(segmenter.push(frame))
    });
    let Some(pushed) = pushed else { return Ok(JsValue::NULL) };
    Ok(pushed.map_err(Failure::from)?.as_ref().map_or(JsValue::UNDEFINED, clip_frame))
}

/// Ends a clip. Returns `{ frames, dropped }`: the frames that were still waiting, and the number of objects beyond the last number. Returns
/// `null` if there is no such clip.
#[wasm_bindgen(js_name = finishClip)]
pub fn finish_clip(clip: u32) -> JsValue {
    let Some(mut segmenter) = take(clip) else { return JsValue::NULL };
    let frames = segmenter.finish();
    Record::new().list("frames", &frames, clip_frame).count("dropped", segmenter.dropped()).into_value()
}

/// Ends a clip early and frees its memory. Does nothing if there is no such clip.
#[wasm_bindgen(js_name = endClip)]
pub fn end_clip(clip: u32) {
    drop(take(clip));
}

fn take(clip: u32) -> Option<ClipSegmenter> {
    CLIPS.with_borrow_mut(|clips| {
        let place = clips.iter().position(|(number, _)| *number == clip)?;
        Some(clips.swap_remove(place).1)
    })
}

fn clip_options(value: &JsValue) -> Result<ClipOptions, Failure> {
    let mut options = ClipOptions::default();
    for (name, value) in entries(value)? {
        match name.as_str() {
            "motions" => options.pair.motions = motions(&value)?,
            "quality" => options.pair.quality = quality(&value)?,
            "seed" => options.pair.seed = seed(&value)?,
            "lookAhead" => options.look_ahead = look_ahead(&value)?,
            _ => return Err(unknown(&name, "motions, quality, seed, lookAhead")),
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
    let ClipFrame { index, labels, objects, background } = frame;
    Record::new()
        .count("index", *index)
        .bytes("labels", labels)
        .list("objects", objects, clip_object)
        .set("background", &matrix(background.as_ref()))
        .into_value()
}

fn clip_object(object: &ClipObject) -> JsValue {
    let ClipObject { id, pixels, bbox, confidence, matrix: motion } = object;
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
