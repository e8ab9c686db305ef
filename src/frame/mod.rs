//! Frames, planes, pyramids and derivatives.

pub(crate) mod area;
mod derivatives;
pub(crate) mod filter;
pub(crate) mod lab;
pub(crate) mod palette;
pub(crate) mod picture;
mod plane;
pub(crate) mod pyramid;
pub(crate) mod scaling;
pub(crate) mod warp;

pub use derivatives::{Derivatives, derivatives};
pub use plane::Plane;

use std::borrow::Cow;

use crate::error::{Error, Result};
use crate::hash::hash;

/// Smallest side of a frame, pixels.
pub const MIN_SIDE: usize = 16;
/// Largest side of a frame, pixels.
pub const MAX_SIDE: usize = 4096;

/// One video frame: its luminance, 0…255, and its colours. Frames are equal if their pixels are; alpha is ignored.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    luminance: Plane,
    /// Red, green, blue and 255 of every pixel, row by row.
    rgba: Vec<u8>,
}

impl Frame {
    /// A frame from RGBA bytes, row by row, as `ImageData` has them. Alpha is ignored. Owned bytes are not copied.
    ///
    /// Luminance is Rec. 601, `0.299 R + 0.587 G + 0.114 B`, in grey levels.
    ///
    /// # Errors
    /// [`Error::FrameSizeUnsupported`], [`Error::PixelCountMismatch`].
    pub fn from_rgba<'a>(width: usize, height: usize, rgba: impl Into<Cow<'a, [u8]>>) -> Result<Frame> {
        let rgba = rgba.into();
        if !(MIN_SIDE..=MAX_SIDE).contains(&width) || !(MIN_SIDE..=MAX_SIDE).contains(&height) {
            return Err(Error::FrameSizeUnsupported { width, height, min: MIN_SIDE, max: MAX_SIDE });
        }
        let needed = width * height * 4;
        if rgba.len() != needed {
            return Err(Error::PixelCountMismatch { width, height, needed, found: rgba.len() });
        }
        let mut rgba = rgba.into_owned();
        let luminance = rgba
            .chunks_exact_mut(4)
            .map(|p| {
                p[3] = u8::MAX;
                0.299 * f32::from(p[0]) + 0.587 * f32::from(p[1]) + 0.114 * f32::from(p[2])
            })
            .collect();
        Ok(Frame { luminance: Plane::from_vec(width, height, luminance), rgba })
    }

    /// Rejects a frame of another size.
    pub(crate) fn check_size_of(&self, other: &Frame) -> Result<()> {
        let [first, second] = [self, other].map(|frame| (frame.width(), frame.height()));
        if first == second { Ok(()) } else { Err(Error::FrameSizeMismatch { first, second }) }
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.luminance.width()
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.luminance.height()
    }

    /// Red, green, blue and 255 of every pixel, row by row.
    pub(crate) fn colours(&self) -> &[[u8; 4]] {
        self.rgba.as_chunks().0
    }

    /// A hash of the size and the pixels; equal frames have the same.
    pub(crate) fn hash(&self) -> u64 {
        hash(self.width() as u64, &self.rgba)
    }

    /// Luminance in grey levels, 0…255.
    pub fn luminance(&self) -> &Plane {
        &self.luminance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alpha_makes_no_difference_and_colour_does() {
        let frame = |pixel: [u8; 4]| Frame::from_rgba(MIN_SIDE, MIN_SIDE, pixel.repeat(MIN_SIDE * MIN_SIDE)).unwrap();
        let [one, same, other] = [[10, 20, 30, 255], [10, 20, 30, 0], [10, 20, 31, 255]].map(frame);
        assert_eq!((&one, one.colours(), one.hash()), (&same, same.colours(), same.hash()));
        assert_ne!(one, other);
        assert_ne!(one.hash(), other.hash());
    }
}
