//! Image derivatives in grey levels.

use crate::error::Result;
use crate::frame::{Derivatives, Frame, derivatives};

/// [`derivatives`] of two frames in grey levels from 0 to 255, per pixel and per frame, half-way between the frames.
///
/// # Errors
/// [`Error::FrameSizeMismatch`](crate::Error::FrameSizeMismatch).
pub fn grey_derivatives(first: &Frame, second: &Frame) -> Result<Derivatives> {
    first.check_size_of(second)?;
    let mut planes = derivatives(first, second, None);
    for plane in [&mut planes.x, &mut planes.y, &mut planes.t] {
        plane.values_mut().iter_mut().for_each(|value| *value *= 255.0);
    }
    Ok(planes)
}
