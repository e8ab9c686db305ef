//! Two frames at one size, and how a motion explains one by the other.

pub(crate) mod brightness;
pub(crate) mod cost;
pub(crate) mod level;
