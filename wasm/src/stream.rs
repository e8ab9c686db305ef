//! Calls on streams: clips whose frames come once. The module keeps a stream between calls, under a number as `clip.rs` does. Calls return
//! `null` if there is no such stream.

use std::cell::RefCell;

use wasm_bindgen::prelude::*;

use crate::clip::clip_frame;
use crate::frames::{frame_from_pixels, pair_option};
use crate::plain::Record;
use crate::{Failure, entries, invalid};
use veronese::clip::{ClipOptions, MAX_LOOK_AHEAD, StreamSegmenter};

thread_local! {
    static STREAMS: RefCell<Vec<(u32, StreamSegmenter)>> = const { RefCell::new(Vec::new()) };
}

/// Begins a stream. `stream` is a number that no other stream has had. Options: `motions`, `quality`, `markUnknown`, `subject` and `lookAhead`.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`.
#[wasm_bindgen(js_name = beginStream)]
pub fn begin_stream(stream: u32, options: &JsValue) -> Result<(), JsValue> {
    let begun = StreamSegmenter::new(clip_options(options)?).map_err(Failure::from)?;
    STREAMS.with_borrow_mut(|streams| streams.push((stream, begun)));
    Ok(())
}

/// Adds a frame, `{ data, width, height }`. Returns a frame that has waited long enough as `{ index, labels, objects, background }`, or
/// `undefined` if there is none.
///
/// # Errors
/// A `VeroneseError` of code `frame-size-mismatch`, or `invalid-input` for a malformed frame. The stream can continue with another frame.
#[wasm_bindgen(js_name = pushStream)]
pub fn push_stream(stream: u32, frame: &JsValue) -> Result<JsValue, JsValue> {
    let frame = frame_from_pixels("the frame", frame)?;
    let pushed = STREAMS.with_borrow_mut(|streams| {
        let (_, stream) = streams.iter_mut().find(|(number, _)| *number == stream)?;
        Some(stream.push(frame))
    });
    match pushed {
        None => Ok(JsValue::NULL),
        Some(pushed) => Ok(pushed.map_err(Failure::from)?.map_or(JsValue::UNDEFINED, |frame| clip_frame(&frame))),
    }
}

/// Ends a stream and frees its memory. Returns `{ frames, dropped }`: the frames that were still waiting, and the number of objects beyond the
/// last number.
#[wasm_bindgen(js_name = finishStream)]
pub fn finish_stream(stream: u32) -> JsValue {
    let ended = STREAMS.with_borrow_mut(|streams| {
        let place = streams.iter().position(|(number, _)| *number == stream)?;
        Some(streams.swap_remove(place).1)
    });
    let Some(mut ended) = ended else { return JsValue::NULL };
    let frames = ended.finish();
    Record::new().list("frames", &frames, clip_frame).count("dropped", ended.dropped()).into_value()
}

pub(super) fn clip_options(value: &JsValue) -> Result<ClipOptions, Failure> {
    let mut options = ClipOptions::default();
    for (name, value) in entries(value)? {
        match name.as_str() {
            "lookAhead" => options.look_ahead = look_ahead(&value)?,
            _ => pair_option(&mut options.pair, &name, &value, "motions, quality, markUnknown, subject, lookAhead")?,
        }
    }
    Ok(options)
}

/// `None` for `'all'`.
fn look_ahead(value: &JsValue) -> Result<Option<usize>, Failure> {
    match (value.as_string().as_deref(), value.as_f64()) {
        (Some("all"), _) => Ok(None),
        (_, Some(n)) if (0.0..=MAX_LOOK_AHEAD as f64).contains(&n) && n == n.floor() => Ok(Some(n as usize)),
        _ => Err(invalid("lookAhead", &format!("'all' or a whole number from 0 to {MAX_LOOK_AHEAD}"), value)),
    }
}
