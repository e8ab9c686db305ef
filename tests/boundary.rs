//! The interface to JavaScript under Node: panics. Everything else is tested by the package.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "clippy knows #[test] only, not #[wasm_bindgen_test]")]

use js_sys::{Function, Reflect};
use wasm_bindgen::prelude::*;
use wasm_bindgen_test::wasm_bindgen_test;

fn property(value: &JsValue, name: &str) -> Option<String> {
    Reflect::get(value, &name.into()).ok()?.as_string()
}

#[wasm_bindgen_test]
fn a_panic_is_thrown_as_an_error_that_keeps_its_message_and_place() {
    veronese::wasm::start();
    let panicking = Closure::<dyn Fn()>::new(|| panic!("the reason"));
    let function: &Function = panicking.as_ref().unchecked_ref();
    let thrown = function.call0(&JsValue::UNDEFINED).unwrap_err();
    assert_eq!(property(&thrown, "name").as_deref(), Some("VeroneseError"));
    assert_eq!(property(&thrown, "code").as_deref(), Some("internal"));
    let message = property(&thrown, "message").unwrap();
    assert!(message.contains("the reason") && message.contains("boundary.rs"), "{message}");
    assert!(thrown.is_instance_of::<js_sys::Error>());
}
