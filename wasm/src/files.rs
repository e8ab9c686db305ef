//! Calls on image files, in the module with codecs only.

use js_sys::{Array, Object, Reflect, Uint8Array};
use wasm_bindgen::prelude::*;

use crate::Failure;
use veronese::codecs::{self, Decoding};

/// Decodes a PNG, JPEG, WebP, BMP or PNM file to `{ data: Uint8Array, width, height }`, RGBA; with `range`, `[smallest, largest]`, if its samples
/// have 16 bits. `allow_damaged` takes a JPEG file as far as it goes; `range` holds the samples of 16 bits that become 0 and 255, if any;
/// `large` takes sides up to 16384 pixels.
///
/// # Errors
/// A `VeroneseError` of code `unreadable-image` or `frame-size-unsupported`.
#[wasm_bindgen(js_name = decodeImage)]
pub fn decode_image(bytes: &[u8], allow_damaged: bool, range: &[u16], large: bool) -> Result<JsValue, JsValue> {
    let mut decoding = Decoding::default();
    decoding.allow_damaged = allow_damaged;
    decoding.large = large;
    decoding.range = if let [low, high] = *range { Some((low, high)) } else { None };
    let picture = codecs::decode_image_with(bytes, &decoding).map_err(Failure::from)?;
    let pixels = Object::new();
    Reflect::set(&pixels, &"data".into(), &Uint8Array::from(&picture.rgba[..]))?;
    Reflect::set(&pixels, &"width".into(), &(picture.width as u32).into())?;
    Reflect::set(&pixels, &"height".into(), &(picture.height as u32).into())?;
    if let Some((low, high)) = picture.range {
        Reflect::set(&pixels, &"range".into(), &Array::of2(&low.into(), &high.into()))?;
    }
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
