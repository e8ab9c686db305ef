//! Calls on image files, in the module with codecs only.

use js_sys::{Object, Reflect, Uint8Array};
use wasm_bindgen::prelude::*;

use crate::Failure;
use veronese::codecs;

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

/// Encodes an 8-bit indexed PNG from one index per pixel; `palette` holds RGB for index 0, 1, ….
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`.
#[wasm_bindgen(js_name = encodeIndexedPng)]
pub fn encode_indexed_png(width: u32, height: u32, indices: &[u8], palette: &[u8]) -> Result<Uint8Array, JsValue> {
    copy(codecs::encode_indexed_png(width as usize, height as usize, indices, palette))
}

/// Encodes an 8-bit grey PNG from one byte per pixel.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`.
#[wasm_bindgen(js_name = encodeGreyPng)]
pub fn encode_grey_png(width: u32, height: u32, grey: &[u8]) -> Result<Uint8Array, JsValue> {
    copy(codecs::encode_grey_png(width as usize, height as usize, grey))
}

/// Encodes an RGB PNG from three bytes per pixel, or an RGBA PNG from four.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`.
#[wasm_bindgen(js_name = encodeColourPng)]
pub fn encode_colour_png(width: u32, height: u32, pixels: &[u8]) -> Result<Uint8Array, JsValue> {
    copy(codecs::encode_colour_png(width as usize, height as usize, pixels))
}

fn copy(file: veronese::Result<Vec<u8>>) -> Result<Uint8Array, JsValue> {
    Ok(Uint8Array::from(&file.map_err(Failure::from)?[..]))
}
