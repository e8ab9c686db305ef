//! The four mirror images of a frame. What was found in one is carried over to the frame itself.

use std::borrow::Cow;

use super::Frame;
use crate::motion::AffineMotion;

/// A mirror image. Taking it twice gives the frame back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Mirror {
    /// The columns are in reverse order.
    columns: bool,
    /// The rows are in reverse order.
    rows: bool,
}

impl Mirror {
    /// The frame itself, then its images.
    pub(crate) const ALL: [Mirror; 4] = [
        Mirror { columns: false, rows: false },
        Mirror { columns: true, rows: false },
        Mirror { columns: false, rows: true },
        Mirror { columns: true, rows: true },
    ];

    /// The mirror image of a frame.
    pub(crate) fn frame(self, frame: &Frame) -> Cow<'_, Frame> {
        if self == Mirror::ALL[0] {
            return Cow::Borrowed(frame);
        }
        let mut mirrored = frame.clone();
        self.reorder(mirrored.luminance.values_mut(), frame.width());
        self.reorder(mirrored.rgba.as_chunks_mut::<4>().0, frame.width());
        Cow::Owned(mirrored)
    }

    /// Puts the pixels of an image, row by row, where they are in the mirror image.
    pub(crate) fn reorder<T>(self, pixels: &mut [T], width: usize) {
        if self.rows {
            pixels.reverse();
        }
        if self.columns != self.rows {
            pixels.chunks_exact_mut(width).for_each(<[T]>::reverse);
        }
    }

    /// The motion in the mirror image of a frame of the given width and height.
    pub(crate) fn motion(self, motion: &AffineMotion, [width, height]: [usize; 2]) -> AffineMotion {
        let [mut a11, mut a12, mut a13, mut a21, mut a22, mut a23] = motion.matrix;
        // Subtracted from zero so that no zero becomes negative.
        if self.columns {
            let last = (width - 1) as f64;
            (a13, a23) = (0.0 - (a11 * last + a13), a21 * last + a23);
            (a12, a21) = (0.0 - a12, 0.0 - a21);
        }
        if self.rows {
            let last = (height - 1) as f64;
            (a13, a23) = (a12 * last + a13, 0.0 - (a22 * last + a23));
            (a12, a21) = (0.0 - a12, 0.0 - a21);
        }
        (a11, a22) = (a11 + 0.0, a22 + 0.0);
        AffineMotion::new([a11, a12, a13, a21, a22, a23])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_and_its_motion_go_to_the_same_place() {
        let [width, height] = [7, 5];
        let motion = AffineMotion::new([0.1, -0.2, 1.5, 0.05, 0.3, -2.0]);
        for mirror in Mirror::ALL {
            let mut pixels: Vec<usize> = (0..width * height).collect();
            mirror.reorder(&mut pixels, width);
            let mirrored = mirror.motion(&motion, [width, height]);
            for (place, &pixel) in pixels.iter().enumerate() {
                let at = |p: usize| [(p % width) as f64, (p / width) as f64];
                let ([x, y], [mx, my]) = (at(pixel), at(place));
                let ([u, v], [mu, mv]) = (motion.flow(x, y), mirrored.flow(mx, my));
                let expected = [if mirror.columns { -u } else { u }, if mirror.rows { -v } else { v }];
                assert!((mu - expected[0]).abs() < 1e-12 && (mv - expected[1]).abs() < 1e-12, "{mirror:?}");
            }
            assert!(mirror.motion(&mirrored, [width, height]).relative_error(&motion) < 1e-12);
        }
    }

    #[test]
    fn no_motion_has_no_negative_zeros() {
        for mirror in Mirror::ALL {
            assert!(mirror.motion(&AffineMotion::STATIC, [7, 5]).matrix.iter().all(|a| a.is_sign_positive()));
        }
    }
}
