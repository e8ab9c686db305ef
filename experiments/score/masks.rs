//! Cases, forms of the pipeline and figures of the mask benchmark.
#![allow(dead_code, reason = "the benchmark uses the rest")]

use crate::boundary;

#[path = "../masks/cases.rs"]
pub(crate) mod cases;
#[path = "../masks/outcome.rs"]
pub(crate) mod outcome;
#[path = "../masks/scores.rs"]
mod scores;
