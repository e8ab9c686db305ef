//! Regions of one label: what they cost to describe, and where splitting or joining them pays.

pub(crate) mod description;
pub(crate) mod merging;
pub(crate) mod splitting;
