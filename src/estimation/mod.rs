//! From intensities to motions: the dominant motion, proposals, selection, alignment.

pub(crate) mod alignment;
pub(crate) mod dominant;
pub(crate) mod proposal;
pub(crate) mod selection;
