//! What the mask benchmark measures, and how.

use crate::boundary;
#[path = "../masks/cases.rs"]
pub(crate) mod cases;
#[path = "../masks/outcome.rs"]
pub(crate) mod outcome;
#[path = "../masks/scores.rs"]
pub(crate) mod scores;
