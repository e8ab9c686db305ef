//! Regions of one label: their description length, and where splitting or merging shortens it.

pub(crate) mod description;
pub(crate) mod merging;
pub(crate) mod splitting;
