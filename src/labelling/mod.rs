//! From costs to labels: one motion per pixel, with spatial coherence. Knows neither images nor motions.

pub(crate) mod components;
mod expansion;
mod max_flow;
mod messages;
pub(crate) mod potts;
