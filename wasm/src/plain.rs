//! Conversion of reports to plain JavaScript objects, entry by entry.
//!
//! A serialiser would need three times as much code. A test compares the entries with those that serialisation gives.

use js_sys::{Array, Object, Reflect, Uint8Array};
use wasm_bindgen::JsValue;

use veronese::Candidate;

/// A builder of a plain object.
pub(super) struct Record(Object);

impl Record {
    pub(super) fn new() -> Record {
        Record(Object::new())
    }

    #[inline(never)]
    pub(super) fn set(self, name: &str, value: &JsValue) -> Record {
        // Cannot fail: the object is an ordinary one, created here.
        let _ = Reflect::set(&self.0, &name.into(), value);
        self
    }

    #[inline(never)]
    pub(super) fn number(self, name: &str, value: f64) -> Record {
        self.set(name, &value.into())
    }

    #[inline(never)]
    pub(super) fn count(self, name: &str, value: usize) -> Record {
        self.number(name, value as f64)
    }

    #[inline(never)]
    pub(super) fn text(self, name: &str, value: &str) -> Record {
        self.set(name, &value.into())
    }

    #[inline(never)]
    pub(super) fn bytes(self, name: &str, value: &[u8]) -> Record {
        self.set(name, &Uint8Array::from(value))
    }

    #[inline(never)]
    pub(super) fn numbers(self, name: &str, values: &[f64]) -> Record {
        self.set(name, &numbers(values))
    }

    pub(super) fn list<T>(self, name: &str, items: &[T], plain: fn(&T) -> JsValue) -> Record {
        self.set(name, &list(items, plain))
    }

    pub(super) fn into_value(self) -> JsValue {
        self.0.into()
    }
}

pub(super) fn candidate(candidate: &Candidate) -> JsValue {
    let Candidate { motions, score, .. } = candidate;
    Record::new().count("motions", *motions).number("score", *score).into_value()
}

#[inline(never)]
pub(super) fn numbers(values: &[f64]) -> JsValue {
    list(values, |value| (*value).into())
}

pub(super) fn list<T>(items: &[T], plain: fn(&T) -> JsValue) -> JsValue {
    items.iter().map(plain).collect::<Array>().into()
}
