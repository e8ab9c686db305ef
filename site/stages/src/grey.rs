//! Image derivatives in grey levels.

use veronese::{Derivatives, Error, Frame, Result, derivatives};

/// [`derivatives`] of two frames in grey levels from 0 to 255, per pixel and per frame, half-way between the frames.
///
/// # Errors
/// [`Error::FrameSizeMismatch`].
pub fn grey_derivatives(first: &Frame, second: &Frame) -> Result<Derivatives> {
    let [one, other] = [first, second].map(|frame| (frame.width(), frame.height()));
    if one != other {
        return Err(Error::FrameSizeMismatch { first: one, second: other });
    }
    let mut planes = derivatives(first, second, None);
    for plane in [&mut planes.x, &mut planes.y, &mut planes.t] {
        plane.values_mut().iter_mut().for_each(|value| *value *= 255.0);
    }
    Ok(planes)
}
