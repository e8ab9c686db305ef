//! From the labels of a coarse level to those of the working size, and from there to the full frame.

pub(crate) mod sharpening;
pub(crate) mod upsampling;
