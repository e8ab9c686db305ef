//! Conversion of reports to plain JavaScript objects, entry by entry.
//!
//! A serialiser would need three times as much code. A test compares the entries with those that serialisation gives.

use js_sys::{Array, Object, Reflect, Uint8Array};
use wasm_bindgen::JsValue;

use veronese::Candidate;

/// A builder of a plain object.
pub struct Record(Object);

impl Record {
    #[allow(clippy::new_without_default, reason = "a record begins empty, and in one way")]
    pub fn new() -> Record {
        Record(Object::new())
    }

    #[inline(never)]
    pub fn set(self, name: &str, value: &JsValue) -> Record {
        // Cannot fail: the object is an ordinary one, created here.
        let _ = Reflect::set(&self.0, &name.into(), value);
        self
    }

    #[inline(never)]
    pub fn number(self, name: &str, value: f64) -> Record {
        self.set(name, &value.into())
    }

    #[inline(never)]
    pub fn count(self, name: &str, value: usize) -> Record {
        self.number(name, value as f64)
    }

    #[inline(never)]
    pub fn text(self, name: &str, value: &str) -> Record {
        self.set(name, &value.into())
    }

    #[inline(never)]
    pub fn bytes(self, name: &str, value: &[u8]) -> Record {
        self.set(name, &Uint8Array::from(value))
    }

    #[inline(never)]
    pub fn numbers(self, name: &str, values: &[f64]) -> Record {
        self.set(name, &numbers(values))
    }

    pub fn list<T>(self, name: &str, items: &[T], plain: fn(&T) -> JsValue) -> Record {
        self.set(name, &list(items, plain))
    }

    pub fn into_value(self) -> JsValue {
        self.0.into()
    }
}

pub fn candidate(candidate: &Candidate) -> JsValue {
    let Candidate { motions, score, .. } = candidate;
    Record::new().count("motions", *motions).number("score", *score).into_value()
}

#[inline(never)]
pub fn numbers(values: &[f64]) -> JsValue {
    list(values, |value| (*value).into())
}

pub fn list<T>(items: &[T], plain: fn(&T) -> JsValue) -> JsValue {
    items.iter().map(plain).collect::<Array>().into()
}
