//! Cases, methods and figures of the clip benchmark.
#![allow(dead_code, reason = "the benchmark uses the rest")]

use crate::boundary;

#[path = "../clips/cases.rs"]
pub(crate) mod cases;
#[path = "../clips/methods.rs"]
pub(crate) mod methods;
#[path = "../clips/scores.rs"]
pub(crate) mod scores;
