//! The interface to JavaScript: RGBA bytes and plain options in, plain data out. No arithmetic happens here.
//!
//! Calls on frames and calls on measurements share little code. The package builds a module for each, so that pages that only segment
//! frames do not load the algebra for measurements.
//!
//! Results are copies: nothing refers to the memory of the module. Nothing needs freeing except a clip that is abandoned. Every error is
//! an `Error` named `VeroneseError` with a stable `code`.
//!
//! **Pitfalls.** A view of WebAssembly memory (`Uint8Array::view`, `ImageData` over a Rust slice) becomes invalid when the memory grows, so
//! always copy. An exception that unwinds Rust frames, such as a panic, does not restore the stack pointer. The instance must not be
//! called again; the package replaces it.

#![cfg(target_arch = "wasm32")]

use js_sys::{Array, Function, Object, Reflect};
use wasm_bindgen::prelude::*;

use veronese::{Error, MAX_MOTIONS, MotionCount, Stage};

#[cfg(feature = "frames")]
mod clip;
#[cfg(feature = "codecs")]
mod files;
#[cfg(feature = "frames")]
mod frames;
#[doc(hidden)]
pub mod plain;
#[cfg(feature = "points")]
mod points;
#[cfg(feature = "frames")]
mod stream;

#[cfg(feature = "frames")]
pub use clip::{
    annotations_of_clip, apply_clip, close_clip, look_at_clip, move_clip, open_clip, save_clip, solve_pair_of_frames,
    take_clip,
};
#[cfg(feature = "codecs")]
pub use files::{decode_image, encode_colour_png, encode_grey_png, encode_indexed_png};
#[cfg(feature = "frames")]
pub use frames::segment_pair;
#[cfg(feature = "points")]
pub use points::fit_motions;
#[cfg(feature = "frames")]
pub use stream::{begin_stream, finish_stream, push_stream};

// For the site's module, which has these calls and some of its own.
#[cfg(feature = "frames")]
#[doc(hidden)]
pub use frames::{frames, report_of_pair, segment_options};
#[cfg(feature = "points")]
#[doc(hidden)]
pub use points::{matrix, report_of_refinement, rows, seed};

/// Version of the report format.
const REPORT_VERSION: f64 = 1.0;
const SOFTWARE: &str = concat!("veronese ", env!("CARGO_PKG_VERSION"));

/// Runs when the module is instantiated. It makes panics, which would otherwise be a `RuntimeError: unreachable`, throw an error with code
/// `internal` that has the message and location of the panic.
#[wasm_bindgen(start)]
pub fn start() {
    std::panic::set_hook(Box::new(|info| {
        wasm_bindgen::throw_val(Failure { code: "internal", message: info.to_string() }.into())
    }));
}

/// An error to throw: an `Error` named `VeroneseError` with a `code`.
#[doc(hidden)]
pub struct Failure {
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
        // Cannot fail: the object is an ordinary one, created here.
        let _ = Reflect::set(&error, &"code".into(), &failure.code.into());
        error.into()
    }
}

/// A progress listener that calls a JavaScript function. An exception of the function propagates to the caller.
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

/// The own entries of the options that are not `undefined`. All of them are read, so a misspelt name is an error.
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

#[doc(hidden)]
pub fn motions(value: &JsValue) -> Result<MotionCount, Failure> {
    let range = format!("'auto' or a whole number from 1 to {MAX_MOTIONS}");
    match (value.as_string().as_deref(), value.as_f64()) {
        (Some("auto"), _) => Ok(MotionCount::Auto),
        (_, Some(n)) if n >= 1.0 && n <= MAX_MOTIONS as f64 && n == n.floor() => Ok(MotionCount::Given(n as usize)),
        _ => Err(invalid("motions", &range, value)),
    }
}

fn choice<T: Copy>(name: &str, value: &JsValue, choices: [(&str, T); 2]) -> Result<T, Failure> {
    let given = value.as_string();
    let [(one, _), (other, _)] = choices;
    match choices.iter().find(|(word, _)| given.as_deref() == Some(*word)) {
        Some(&(_, choice)) => Ok(choice),
        None => Err(invalid(name, &format!("'{one}' or '{other}'"), value)),
    }
}

#[doc(hidden)]
pub fn invalid(name: &str, wanted: &str, found: &JsValue) -> Failure {
    let found = match (found.as_string(), found.as_f64(), found.as_bool()) {
        (Some(text), ..) => format!("'{text}'"),
        (_, Some(number), _) => written(number),
        (.., Some(flag)) => flag.to_string(),
        _ if found.is_null() => "null".into(),
        _ => format!("a value of type {}", found.js_typeof().as_string().unwrap_or_default()),
    };
    Failure::option(format!("option '{name}': must be {wanted}, not {found}"))
}

/// A number in JavaScript's notation. Rust's formatting of floats would add twelve kilobytes to the module.
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
