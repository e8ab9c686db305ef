//! The terms of the labelling energy.

pub(crate) mod colour;
pub(crate) mod data;
pub(crate) mod smoothness;
pub(crate) mod variance_inflation;
pub(crate) mod visibility;
