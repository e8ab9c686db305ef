//! Calls on two frames.

use js_sys::{Function, Reflect, Uint8Array, Uint8ClampedArray};
use wasm_bindgen::prelude::*;
use web_sys::ImageData;

use crate::plain::{Record, candidate};
use crate::{Failure, REPORT_VERSION, SOFTWARE, choice, entries, invalid, listener, motions, motions_asked, unknown};
use veronese::{
    Error, Frame, Junction, MAX_SIDE, MIN_SIDE, PairEvidence, Quality, SegmentOptions, Segmentation, SegmentedMotion,
};

/// Segments two frames. A frame is `{ data, width, height }` with RGBA bytes,
/// like `ImageData`. `on_stage(name, index, of)` is called at the beginning of every stage.
///
/// Returns the report of a pair as a plain object without `milliseconds`, which the caller measures, with `labels: Uint8Array` and, on
/// request, `confidence: Uint8Array`.
///
/// # Errors
/// A `VeroneseError`: the codes of [`Error`], and `invalid-input` for a frame of another shape.
#[wasm_bindgen(js_name = segmentPair)]
pub fn segment_pair(
    first: &JsValue,
    second: &JsValue,
    options: &JsValue,
    on_stage: Option<Function>,
) -> Result<JsValue, JsValue> {
    let options = segment_options(options)?;
    let (first, second) = frames(first, second)?;
    let segmentation =
        veronese::segment_pair(&first, &second, &options, &mut listener(on_stage)).map_err(Failure::from)?;
    Ok(report_of_pair(&segmentation, &options))
}

/// The report of a pair, with its labels.
#[inline(always)]
pub fn report_of_pair(segmentation: &Segmentation, options: &SegmentOptions) -> JsValue {
    let settings = Record::new()
        .set("motions", &motions_asked(options.motions))
        .text("quality", options.quality.name())
        .set("markUnknown", &options.mark_unknown.into())
        .set("subject", &options.subject.into())
        .text("software", SOFTWARE);
    let report = add_segmentation(Record::new().number("version", REPORT_VERSION), segmentation)
        .set("settings", &settings.into_value())
        .bytes("labels", &segmentation.labels);
    match &segmentation.confidence {
        Some(confidence) => report.bytes("confidence", confidence),
        None => report,
    }
    .into_value()
}

/// Two frames, each `{ data, width, height }`.
pub fn frames(first: &JsValue, second: &JsValue) -> Result<(Frame, Frame), Failure> {
    Ok((frame_from_pixels("the first frame", first)?, frame_from_pixels("the second frame", second)?))
}

/// A frame from an `ImageData` or `{ data, width, height }`. The size is checked before bytes are copied.
pub(super) fn frame_from_pixels(which: &str, pixels: &JsValue) -> Result<Frame, Failure> {
    if let Some(image) = pixels.dyn_ref::<ImageData>() {
        return Ok(Frame::from_rgba(image.width() as usize, image.height() as usize, image.data().0)?);
    }
    let shape = || Failure::input(format!("{which} must be {{ data, width, height }} with RGBA bytes, like ImageData"));
    let get = |name: &str| Reflect::get(pixels, &name.into()).map_err(|_| shape());
    let side = |name: &str| match get(name)?.as_f64() {
        Some(value) if value >= 0.0 && value <= f64::from(u32::MAX) && value == value.floor() => Ok(value as usize),
        _ => Err(Failure::input(format!("{which}: '{name}' must be a whole number of pixels"))),
    };
    let (width, height) = (side("width")?, side("height")?);
    let data = get("data")?;
    let data = match data.dyn_ref::<Uint8ClampedArray>() {
        Some(clamped) => {
            Uint8Array::new_with_byte_offset_and_length(&clamped.buffer(), clamped.byte_offset(), clamped.length())
        }
        None => data.dyn_into::<Uint8Array>().map_err(|_| shape())?,
    };
    let found = data.length() as usize;
    let supported = MIN_SIDE..=MAX_SIDE;
    if !supported.contains(&width) || !supported.contains(&height) {
        return Err(Error::FrameSizeUnsupported { width, height, min: MIN_SIDE, max: MAX_SIDE }.into());
    }
    let needed = width * height * 4;
    if found != needed {
        return Err(Error::PixelCountMismatch { width, height, needed, found }.into());
    }
    Ok(Frame::from_rgba(width, height, data.to_vec())?)
}

/// The options of [`segment_pair`].
pub fn segment_options(value: &JsValue) -> Result<SegmentOptions, Failure> {
    let mut options = SegmentOptions::default();
    for (name, value) in entries(value)? {
        match name.as_str() {
            "confidence" => options.confidence = flag("confidence", &value)?,
            _ => pair_option(&mut options, &name, &value, "motions, quality, markUnknown, subject, confidence")?,
        }
    }
    Ok(options)
}

/// Sets an option that calls on pairs and on clips have. `known`: all options of the call.
#[inline(never)]
pub(super) fn pair_option(
    options: &mut SegmentOptions,
    name: &str,
    value: &JsValue,
    known: &str,
) -> Result<(), Failure> {
    match name {
        "motions" => options.motions = motions(value)?,
        "quality" => options.quality = quality(value)?,
        "markUnknown" => options.mark_unknown = flag("markUnknown", value)?,
        "subject" => options.subject = flag("subject", value)?,
        _ => return Err(unknown(name, known)),
    }
    Ok(())
}

fn quality(value: &JsValue) -> Result<Quality, Failure> {
    choice("quality", value, [("fast", Quality::Fast), ("best", Quality::Best)])
}

fn flag(name: &str, value: &JsValue) -> Result<bool, Failure> {
    value.as_bool().ok_or_else(|| invalid(name, "true or false", value))
}

/// Adds the entries of a segmentation except its byte arrays.
fn add_segmentation(record: Record, segmentation: &Segmentation) -> Record {
    let Segmentation {
        width, height, count, motions, labels: _, junctions, evidence, unlabelled, confidence: _, ..
    } = segmentation;
    let PairEvidence { candidates, .. } = evidence;
    record
        .count("width", *width)
        .count("height", *height)
        .count("count", *count)
        .list("motions", motions, segmented_motion)
        .list("junctions", junctions, junction)
        .set("evidence", &Record::new().list("candidates", candidates, candidate).into_value())
        .count("unlabelled", *unlabelled)
}

fn segmented_motion(motion: &SegmentedMotion) -> JsValue {
    let SegmentedMotion { label, matrix, pixels, share, residual, bbox, group, .. } = motion;
    Record::new()
        .count("label", usize::from(*label))
        .numbers("matrix", &matrix.matrix)
        .count("pixels", *pixels)
        .number("share", *share)
        .number("residual", *residual)
        .numbers("bbox", &bbox.map(|side| side as f64))
        .count("group", usize::from(*group))
        .into_value()
}

fn junction(junction: &Junction) -> JsValue {
    let Junction { labels, likelihood, border, .. } = junction;
    Record::new()
        .numbers("labels", &labels.map(f64::from))
        .number("likelihood", *likelihood)
        .count("border", *border)
        .into_value()
}
