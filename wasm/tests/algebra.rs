//! The interface to JavaScript under Node: panics, and that reports have all entries. Everything else is tested by the package.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "clippy knows #[test] only, not #[wasm_bindgen_test]")]

use js_sys::{Function, Reflect};
use serde_json::Value;
use veronese::clip::{ClipOptions, StreamSegmenter};
use veronese::{FitOptions, Frame, Measurements, Method, MotionCount, Quality, SegmentOptions};
use wasm_bindgen::prelude::*;
use wasm_bindgen_test::wasm_bindgen_test;

fn property(value: &JsValue, name: &str) -> Option<String> {
    Reflect::get(value, &name.into()).ok()?.as_string()
}

#[wasm_bindgen_test]
fn a_panic_is_thrown_as_an_error_that_keeps_its_message_and_place() {
    veronese_wasm::start();
    let panicking = Closure::<dyn Fn()>::new(|| panic!("the reason"));
    let function: &Function = panicking.as_ref().unchecked_ref();
    let thrown = function.call0(&JsValue::UNDEFINED).unwrap_err();
    assert_eq!(property(&thrown, "name").as_deref(), Some("VeroneseError"));
    assert_eq!(property(&thrown, "code").as_deref(), Some("internal"));
    let message = property(&thrown, "message").unwrap();
    assert!(message.contains("the reason") && message.contains("boundary.rs"), "{message}");
    assert!(thrown.is_instance_of::<js_sys::Error>());
}

/// Every entry of `expected` is in `found`, with the same value. Numbers differ by rounding in the last digits at most.
fn assert_contains(found: &Value, expected: &Value, path: &str) {
    match (found, expected) {
        (Value::Object(found), Value::Object(expected)) => {
            for (name, value) in expected {
                let path = format!("{path}.{name}");
                let found = found.get(name).unwrap_or_else(|| panic!("there is no {path}"));
                assert_contains(found, value, &path);
            }
        }
        (Value::Array(found), Value::Array(expected)) => {
            assert_eq!(found.len(), expected.len(), "{path}");
            found.iter().zip(expected).for_each(|(found, expected)| assert_contains(found, expected, path));
        }
        (Value::Number(found), Value::Number(expected)) => {
            let [found, expected] = [found, expected].map(|number| number.as_f64().unwrap());
            assert!((found - expected).abs() <= 1e-15 * expected.abs(), "{path}: {found} is not {expected}");
        }
        _ => assert_eq!(found, expected, "{path}"),
    }
}

fn json(value: &JsValue) -> Value {
    serde_json::from_str(&String::from(js_sys::JSON::stringify(value).unwrap())).unwrap()
}

fn object(entries: &[(&str, JsValue)]) -> JsValue {
    let object = js_sys::Object::new();
    entries.iter().for_each(|(name, value)| drop(Reflect::set(&object, &(*name).into(), value)));
    object.into()
}

/// A textured frame with a square that has moved by some pixels.
fn rgba(moved: usize) -> Vec<u8> {
    let texture = |x: usize, y: usize, seed: usize| ((x * x + 3 * y * y + x * y * seed) % 97 + 60) as u8;
    let at = |x: usize, y: usize| match (x.wrapping_sub(20 + moved), y.wrapping_sub(15)) {
        (a @ ..20, b @ ..20) => texture(a / 3, b / 3, 7),
        _ => texture(x / 3, y / 3, 2),
    };
    (0..48 * 64).flat_map(|p| [at(p % 64, p / 64); 3].into_iter().chain([255])).collect()
}

#[wasm_bindgen_test]
fn nothing_of_a_segmentation_is_left_out() {
    let frames = [rgba(0), rgba(2)];
    let [first, second] = frames.each_ref().map(|rgba| {
        let data = js_sys::Uint8Array::from(&rgba[..]).into();
        object(&[("data", data), ("width", 64.into()), ("height", 48.into())])
    });
    let found = json(&veronese_wasm::segment_pair(&first, &second, &JsValue::UNDEFINED, None).unwrap());
    let [first, second] = frames.map(|rgba| Frame::from_rgba(64, 48, rgba).unwrap());
    let expected = veronese::segment_pair(&first, &second, &SegmentOptions::default(), &mut |_| {}).unwrap();
    assert_eq!(expected.count, 2);
    assert_contains(&found, &serde_json::to_value(&expected).unwrap(), "segmentation");
}

#[wasm_bindgen_test]
fn nothing_of_a_fit_is_left_out() {
    // Two motions by halves; gradients in all directions.
    let positions: Vec<[f64; 2]> =
        (0..200).map(|j| [f64::from(j % 20) / 10.0 - 1.0, f64::from(j / 20) / 5.0 - 1.0]).collect();
    let derivatives: Vec<[f64; 3]> = (0..200)
        .map(|j| {
            let (ix, iy) = (f64::from(j * j % 7) - 3.5, f64::from(j * 5 % 11) - 5.5);
            let [u, v] = if j % 2 == 0 { [0.5, -0.25] } else { [-0.4, 0.1] };
            [ix, iy, -ix * u - iy * v]
        })
        .collect();
    let measurements = Measurements::new(positions.clone(), derivatives.clone()).unwrap();
    for method in [Method::Paper, Method::Best] {
        let asked = object(&[("method", method.name().into()), ("motions", 2.into())]);
        let found = veronese_wasm::fit_motions(positions.as_flattened(), derivatives.as_flattened(), &asked, None);
        let options = FitOptions::default().with_method(method).with_motions(MotionCount::Given(2));
        let expected = veronese::fit_motions(&measurements, &options, &mut |_| {}).unwrap();
        assert_contains(&json(&found.unwrap()), &serde_json::to_value(&expected).unwrap(), "fit");
    }
}

#[wasm_bindgen_test]
fn nothing_of_a_frame_of_a_clip_is_left_out() {
    let clip = 1;
    let options = object(&[("lookAhead", 0.into()), ("quality", "fast".into())]);
    veronese_wasm::begin_clip(clip, false, &options).unwrap();
    let pair = SegmentOptions::default().with_quality(Quality::Fast);
    let mut stream = StreamSegmenter::new(ClipOptions::default().with_pair(pair).with_look_ahead(Some(0))).unwrap();
    let mut objects = 0;
    for moved in [0, 2, 4] {
        let rgba = rgba(moved);
        let data = js_sys::Uint8Array::from(&rgba[..]).into();
        let pixels = object(&[("data", data), ("width", 64.into()), ("height", 48.into())]);
        let found = veronese_wasm::push_clip(clip, &pixels, None).unwrap();
        if let Some(expected) = stream.push(Frame::from_rgba(64, 48, rgba).unwrap()).unwrap() {
            objects += expected.objects.len();
            assert_contains(&json(&found), &serde_json::to_value(&expected).unwrap(), "frame");
        }
    }
    assert!(objects > 0);
    veronese_wasm::end_clip(clip);
}
