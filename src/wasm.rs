//! The boundary to JavaScript, and the only file that knows it: RGBA bytes and plain options in, plain data out.
//!
//! Every object that is handed out is a copy of its own: nothing views the memory of the module and nothing needs freeing.
//! Every error is an `Error` named `VeroneseError` with a stable `code`. No arithmetic happens here.
//!
//! **Pitfalls.** A view of wasm memory (`Uint8Array::view`, `ImageData` over a Rust slice) goes stale when the memory grows:
//! copy. An exception that crosses Rust frames, as a panic here does, leaves the stack pointer where it was: the instance must
//! not be called again (the package starts a fresh one).

use js_sys::{Array, Function, Object, Reflect, Uint8Array, Uint8ClampedArray};
use wasm_bindgen::prelude::*;
use web_sys::{CanvasRenderingContext2d, ImageData, OffscreenCanvasRenderingContext2d};

use crate::{
    AffineMotion, Correction, Error, FitOptions, Frame, MAX_MOTIONS, MAX_SIDE, MIN_SIDE, Measurements, Method,
    MotionCount, Quality, SegmentOptions, Stage,
};
use plain::{Record, add_fit, add_segmentation, segmented_motions};

mod plain;

/// Version of the JSON.
const REPORT_VERSION: f64 = 1.0;
const SOFTWARE: &str = concat!("veronese ", env!("CARGO_PKG_VERSION"));
/// 2⁵³ − 1: the largest whole number that JavaScript counts to without gaps.
const MAX_SAFE_INTEGER: f64 = 9_007_199_254_740_991.0;

/// Runs when the module is instantiated: a panic, which would otherwise reach the caller as "unreachable", is thrown as an
/// error of code `internal` that keeps its message and place.
#[wasm_bindgen(start)]
pub fn start() {
    std::panic::set_hook(Box::new(|info| {
        wasm_bindgen::throw_val(Failure { code: "internal", message: info.to_string() }.into())
    }));
}

/// Segments two frames (and, as a third view, the frame before the first). A frame is anything of the shape of `ImageData`:
/// `{ data, width, height }` with RGBA bytes. `on_stage(name, index, of)` is called when a stage begins.
///
/// Returns the JSON of a pair, without `milliseconds` (the caller has the clock), with `labels: Uint8Array` and, where the
/// options ask for it, `confidence: Uint8Array`.
///
/// # Errors
/// A `VeroneseError`: the codes of [`Error`], and `invalid-input` for a frame of another shape.
#[wasm_bindgen(js_name = segmentPair)]
pub fn segment_pair(
    first: &JsValue,
    second: &JsValue,
    before: &JsValue,
    options: &JsValue,
    on_stage: Option<Function>,
) -> Result<JsValue, JsValue> {
    let options = segment_options(options)?;
    let first = frame_from_pixels("the first frame", first)?;
    let second = frame_from_pixels("the second frame", second)?;
    let before = if before.is_undefined() { None } else { Some(frame_from_pixels("the frame before", before)?) };
    let segmentation = crate::segment_pair(&first, &second, before.as_ref(), &options, &mut listener(on_stage))
        .map_err(Failure::from)?;
    let quality = match options.quality {
        Quality::Fast => "fast",
        Quality::Best => "best",
    };
    let settings = Record::new()
        .set("motions", &motions_asked(options.motions))
        .text("quality", quality)
        .set("markUnknown", &options.mark_unknown.into())
        .set("before", &before.is_some().into())
        .number("seed", options.seed as f64)
        .text("software", SOFTWARE);
    let report = add_segmentation(Record::new().number("version", REPORT_VERSION), &segmentation)
        .set("settings", &settings.into_value())
        .bytes("labels", &segmentation.labels);
    Ok(match &segmentation.confidence {
        Some(confidence) => report.bytes("confidence", confidence),
        None => report,
    }
    .into_value())
}

/// [`segment_pair`] for two `ImageData`, as `getImageData` gives them.
///
/// # Errors
/// As [`segment_pair`].
#[wasm_bindgen(js_name = segmentImageData)]
pub fn segment_image_data(first: &ImageData, second: &ImageData, options: &JsValue) -> Result<JsValue, JsValue> {
    segment_pair(first, second, &JsValue::UNDEFINED, options, None)
}

/// Solves the labels of a segmentation again under what is said about single pixels (see [`crate::Correction`]): `matrices` holds
/// six entries of each motion, `groups` its group, `labels` and `evidence` one entry per pixel; `options` has the `quality`.
///
/// Returns `{ motions, unlabelled, labels: Uint8Array }`, shaped as in [`segment_pair`].
///
/// # Errors
/// A `VeroneseError`: the codes of [`Error`], and `invalid-input` for a frame of another shape or matrices of another number.
#[wasm_bindgen]
#[allow(clippy::too_many_arguments, reason = "flat arrays are copied once; objects entry by entry")]
pub fn relabel(
    first: &JsValue,
    second: &JsValue,
    before: &JsValue,
    matrices: &[f64],
    groups: &[u8],
    labels: &[u8],
    evidence: &[u16],
    options: &JsValue,
    on_stage: Option<Function>,
) -> Result<JsValue, JsValue> {
    let options = segment_options(options)?;
    let first = frame_from_pixels("the first frame", first)?;
    let second = frame_from_pixels("the second frame", second)?;
    let before = if before.is_undefined() { None } else { Some(frame_from_pixels("the frame before", before)?) };
    let (entries, rest) = matrices.as_chunks::<6>();
    if !rest.is_empty() {
        return Err(Failure::input(format!("the matrices must hold 6 numbers each, found {}", matrices.len())).into());
    }
    let motions: Vec<AffineMotion> = entries.iter().map(|&entries| AffineMotion::new(entries)).collect();
    let correction = Correction { motions: &motions, groups, labels, allowed: evidence };
    let progress = &mut listener(on_stage);
    let relabelled = crate::relabel(&first, &second, before.as_ref(), &correction, &options, progress);
    let relabelled = relabelled.map_err(Failure::from)?;
    let report = Record::new()
        .set("motions", &segmented_motions(&relabelled.motions))
        .count("unlabelled", relabelled.unlabelled)
        .bytes("labels", &relabelled.labels);
    Ok(report.into_value())
}

/// Solves the paper's Problem 1 on measurements: `positions` holds x, y of each, `derivatives` I_x, I_y, I_t.
///
/// Returns the JSON of points, without `milliseconds`, with `labels: Uint8Array`.
///
/// # Errors
/// A `VeroneseError`: the codes of [`Error`], and `invalid-input` for arrays that do not hold whole measurements.
#[wasm_bindgen(js_name = fitMotions)]
pub fn fit_motions(
    positions: &[f64],
    derivatives: &[f64],
    options: &JsValue,
    on_stage: Option<Function>,
) -> Result<JsValue, JsValue> {
    let options = fit_options(options)?;
    let measurements = Measurements::new(rows("positions", positions)?, rows("derivatives", derivatives)?);
    let fit = measurements
        .and_then(|measurements| crate::fit_motions(&measurements, &options, &mut listener(on_stage)))
        .map_err(Failure::from)?;
    let method = match options.method {
        Method::Paper => "paper",
        Method::Best => "best",
    };
    let settings = Record::new()
        .set("motions", &motions_asked(options.motions))
        .text("method", method)
        .number("seed", options.seed as f64)
        .text("software", SOFTWARE);
    let report = add_fit(Record::new().number("version", REPORT_VERSION), &fit)
        .set("settings", &settings.into_value())
        .bytes("labels", &fit.labels);
    Ok(report.into_value())
}

/// Replaces the canvas's top-left width × height pixels by the colours of the labels: `palette` holds RGBA for label 0, 1, …;
/// labels beyond it are transparent. `opacity`, 0…1, scales every alpha. Lay the canvas over the frame.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`.
#[wasm_bindgen(js_name = paintLabels)]
pub fn paint_labels(
    context: &CanvasRenderingContext2d,
    labels: &[u8],
    width: u32,
    height: u32,
    palette: &[u8],
    opacity: f64,
) -> Result<(), JsValue> {
    context.put_image_data(&image_from_labels(labels, width, height, palette, opacity)?, 0.0, 0.0)
}

/// [`paint_labels`] for an `OffscreenCanvas`.
///
/// # Errors
/// As [`paint_labels`].
#[wasm_bindgen(js_name = paintLabelsOffscreen)]
pub fn paint_labels_offscreen(
    context: &OffscreenCanvasRenderingContext2d,
    labels: &[u8],
    width: u32,
    height: u32,
    palette: &[u8],
    opacity: f64,
) -> Result<(), JsValue> {
    context.put_image_data(&image_from_labels(labels, width, height, palette, opacity)?, 0.0, 0.0)
}

fn image_from_labels(
    labels: &[u8],
    width: u32,
    height: u32,
    palette: &[u8],
    opacity: f64,
) -> Result<ImageData, JsValue> {
    let invalid = |name, reason: String| Failure::from(Error::InvalidOption { name, reason });
    if labels.len() as u64 != u64::from(width) * u64::from(height) {
        return Err(invalid("labels", format!("{} do not fill {width}×{height} pixels", labels.len())).into());
    }
    if !palette.len().is_multiple_of(4) || palette.len() > 4 * 256 {
        let reason = format!("must hold 4 bytes for each of at most 256 colours, not {} bytes", palette.len());
        return Err(invalid("palette", reason).into());
    }
    if !(0.0..=1.0).contains(&opacity) {
        return Err(invalid("opacity", format!("must be a number from 0 to 1, not {}", written(opacity))).into());
    }
    let colours: Vec<[u8; 4]> = (0..256)
        .map(|label| match palette.get(4 * label..4 * label + 4) {
            Some(&[r, g, b, alpha]) => [r, g, b, (f64::from(alpha) * opacity).round() as u8],
            _ => [0; 4],
        })
        .collect();
    let rgba: Vec<u8> = labels.iter().flat_map(|&label| colours[usize::from(label)]).collect();
    ImageData::new_with_js_u8_clamped_array_and_sh(&Uint8ClampedArray::from(&rgba[..]), width, height)
}

/// Files in and out: only in the build with codecs.
#[cfg(feature = "codecs")]
pub mod files {
    use super::{Failure, JsValue, Object, Reflect, Uint8Array, wasm_bindgen};
    use crate::codecs;

    /// Decodes a PNG, JPEG, WebP, BMP or PNM file to `{ data: Uint8Array, width, height }`, RGBA.
    ///
    /// # Errors
    /// A `VeroneseError` of code `unreadable-image` or `frame-size-unsupported`.
    #[wasm_bindgen(js_name = decodeImage)]
    pub fn decode_image(bytes: &[u8]) -> Result<JsValue, JsValue> {
        let picture = codecs::decode_image(bytes).map_err(Failure::from)?;
        let pixels = Object::new();
        Reflect::set(&pixels, &"data".into(), &Uint8Array::from(&picture.rgba[..]))?;
        Reflect::set(&pixels, &"width".into(), &(picture.width as u32).into())?;
        Reflect::set(&pixels, &"height".into(), &(picture.height as u32).into())?;
        Ok(pixels.into())
    }

    /// An 8-bit indexed PNG of one index per pixel; `palette` holds RGB for index 0, 1, ….
    ///
    /// # Errors
    /// A `VeroneseError` of code `invalid-option`.
    #[wasm_bindgen(js_name = encodeIndexedPng)]
    pub fn encode_indexed_png(width: u32, height: u32, indices: &[u8], palette: &[u8]) -> Result<Uint8Array, JsValue> {
        copy(codecs::encode_indexed_png(width as usize, height as usize, indices, palette))
    }

    /// An 8-bit grey PNG of one byte per pixel.
    ///
    /// # Errors
    /// A `VeroneseError` of code `invalid-option`.
    #[wasm_bindgen(js_name = encodeGreyPng)]
    pub fn encode_grey_png(width: u32, height: u32, grey: &[u8]) -> Result<Uint8Array, JsValue> {
        copy(codecs::encode_grey_png(width as usize, height as usize, grey))
    }

    /// An RGB PNG of three bytes per pixel, or an RGBA PNG of four.
    ///
    /// # Errors
    /// A `VeroneseError` of code `invalid-option`.
    #[wasm_bindgen(js_name = encodeColourPng)]
    pub fn encode_colour_png(width: u32, height: u32, pixels: &[u8]) -> Result<Uint8Array, JsValue> {
        copy(codecs::encode_colour_png(width as usize, height as usize, pixels))
    }

    fn copy(file: crate::Result<Vec<u8>>) -> Result<Uint8Array, JsValue> {
        Ok(Uint8Array::from(&file.map_err(Failure::from)?[..]))
    }
}

/// What is thrown: an `Error` named `VeroneseError` with a `code`.
struct Failure {
    code: &'static str,
    message: String,
}

impl Failure {
    fn input(message: String) -> Failure {
        Failure { code: "invalid-input", message }
    }

    fn option(message: String) -> Failure {
        Failure { code: "invalid-option", message }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Failure {
        Failure { code: error.code(), message: error.to_string() }
    }
}

impl From<Failure> for JsValue {
    fn from(failure: Failure) -> JsValue {
        let error = js_sys::Error::new(&failure.message);
        error.set_name("VeroneseError");
        // Setting a property of an object of our own cannot fail.
        let _ = Reflect::set(&error, &"code".into(), &failure.code.into());
        error.into()
    }
}

/// The core's progress as calls of a function. What the function throws goes on to the caller at once.
fn listener(on_stage: Option<Function>) -> impl FnMut(Stage) {
    move |stage: Stage| {
        let Some(function) = &on_stage else { return };
        let called = function.call3(
            &JsValue::UNDEFINED,
            &stage.name.into(),
            &(stage.index as u32).into(),
            &(stage.of as u32).into(),
        );
        if let Err(thrown) = called {
            wasm_bindgen::throw_val(thrown);
        }
    }
}

/// A frame from `{ data, width, height }`. Sizes are checked before a byte is copied.
fn frame_from_pixels(which: &str, pixels: &JsValue) -> Result<Frame, Failure> {
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

/// Rows of `N` numbers from a flat array.
fn rows<const N: usize>(name: &str, values: &[f64]) -> Result<Vec<[f64; N]>, Failure> {
    let (rows, rest) = values.as_chunks::<N>();
    if !rest.is_empty() {
        return Err(Failure::input(format!(
            "'{name}' must hold {N} numbers for each measurement, found {}",
            values.len()
        )));
    }
    Ok(rows.to_vec())
}

/// The options' own entries that are not `undefined`: all of them, so that a misspelt one is not silently left out.
fn entries(options: &JsValue) -> Result<Vec<(String, JsValue)>, Failure> {
    if options.is_undefined() {
        return Ok(Vec::new());
    }
    if !options.is_object() || Array::is_array(options) {
        return Err(Failure::option("options must be an object".into()));
    }
    let pairs = Object::entries(options.unchecked_ref::<Object>());
    Ok(pairs
        .iter()
        .map(|pair| Array::from(&pair))
        .map(|pair| (pair.get(0).as_string().unwrap_or_default(), pair.get(1)))
        .filter(|(_, value)| !value.is_undefined())
        .collect())
}

fn segment_options(value: &JsValue) -> Result<SegmentOptions, Failure> {
    let mut options = SegmentOptions::default();
    for (name, value) in entries(value)? {
        match name.as_str() {
            "motions" => options.motions = motions(&value)?,
            "quality" => {
                options.quality = choice("quality", &value, &[("fast", Quality::Fast), ("best", Quality::Best)])?;
            }
            "markUnknown" => options.mark_unknown = flag("markUnknown", &value)?,
            "confidence" => options.confidence = flag("confidence", &value)?,
            "seed" => options.seed = seed(&value)?,
            _ => return Err(unknown(&name, "motions, quality, markUnknown, confidence, seed")),
        }
    }
    Ok(options)
}

fn fit_options(value: &JsValue) -> Result<FitOptions, Failure> {
    let mut options = FitOptions::default();
    for (name, value) in entries(value)? {
        match name.as_str() {
            "motions" => options.motions = motions(&value)?,
            "method" => options.method = choice("method", &value, &[("paper", Method::Paper), ("best", Method::Best)])?,
            "seed" => options.seed = seed(&value)?,
            _ => return Err(unknown(&name, "motions, method, seed")),
        }
    }
    Ok(options)
}

fn flag(name: &str, value: &JsValue) -> Result<bool, Failure> {
    value.as_bool().ok_or_else(|| invalid(name, "true or false", value))
}

fn motions(value: &JsValue) -> Result<MotionCount, Failure> {
    let range = format!("'auto' or a whole number from 1 to {MAX_MOTIONS}");
    match (value.as_string().as_deref(), value.as_f64()) {
        (Some("auto"), _) => Ok(MotionCount::Auto),
        (_, Some(n)) if n >= 1.0 && n <= MAX_MOTIONS as f64 && n == n.floor() => Ok(MotionCount::Given(n as usize)),
        _ => Err(invalid("motions", &range, value)),
    }
}

fn seed(value: &JsValue) -> Result<u64, Failure> {
    match value.as_f64() {
        Some(seed) if (0.0..=MAX_SAFE_INTEGER).contains(&seed) && seed == seed.floor() => Ok(seed as u64),
        _ => Err(invalid("seed", "a whole number from 0 to 9007199254740991", value)),
    }
}

fn choice<T: Copy>(name: &str, value: &JsValue, choices: &[(&str, T)]) -> Result<T, Failure> {
    let given = value.as_string();
    match choices.iter().find(|(word, _)| given.as_deref() == Some(*word)) {
        Some(&(_, choice)) => Ok(choice),
        None => {
            let words: Vec<String> = choices.iter().map(|(word, _)| format!("'{word}'")).collect();
            Err(invalid(name, &words.join(" or "), value))
        }
    }
}

fn invalid(name: &str, wanted: &str, found: &JsValue) -> Failure {
    let found = match (found.as_string(), found.as_f64(), found.as_bool()) {
        (Some(text), ..) => format!("'{text}'"),
        (_, Some(number), _) => written(number),
        (.., Some(flag)) => flag.to_string(),
        _ if found.is_null() => "null".into(),
        _ => format!("a value of type {}", found.js_typeof().as_string().unwrap_or_default()),
    };
    Failure::option(format!("option '{name}': must be {wanted}, not {found}"))
}

/// A number as JavaScript writes it: what Rust has for that is twelve kilobytes of the module.
fn written(number: f64) -> String {
    js_sys::Number::from(number).to_string_with_radix(10).map(String::from).unwrap_or_default()
}

fn unknown(name: &str, known: &str) -> Failure {
    Failure::option(format!("there is no option '{name}'; there are {known}"))
}

/// `"auto"` or a number.
fn motions_asked(count: MotionCount) -> JsValue {
    match count {
        MotionCount::Auto => "auto".into(),
        MotionCount::Given(n) => (n as f64).into(),
    }
}
