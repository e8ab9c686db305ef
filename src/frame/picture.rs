//! A frame without blur: labels may change along its edges.

use std::ops::Range;

use super::filter::halve;
use super::{Frame, Plane};

/// Luminance and colours of a frame at one size, grey levels.
#[derive(Clone, Debug)]
pub(crate) struct Picture {
    pub(crate) luminance: Plane,
    /// Red, green, blue.
    pub(crate) colours: [Plane; 3],
}

impl Picture {
    /// Luminance, red, green and blue of a run of pixels.
    pub(crate) fn run(&self, pixels: Range<usize>) -> [&[f32]; 4] {
        let [red, green, blue] = &self.colours;
        [&self.luminance, red, green, blue].map(|plane| &plane.values()[pixels.clone()])
    }

    /// The picture at half its size.
    pub(crate) fn halved(&self) -> Picture {
        Picture { luminance: halve(&self.luminance), colours: self.colours.each_ref().map(halve) }
    }
}

/// Red, green and blue of a frame, halved until they are at most `width` wide.
pub(crate) fn colours(frame: &Frame, width: usize) -> [Plane; 3] {
    let mut planes = if frame.width() > width {
        half_colours(frame)
    } else {
        let plane = |c: usize| frame.colours().iter().map(|colour| f32::from(colour[c])).collect();
        std::array::from_fn(|c| Plane::from_vec(frame.width(), frame.height(), plane(c)))
    };
    while planes[0].width() > width {
        planes = planes.each_ref().map(halve);
    }
    planes
}

/// Red, green and blue of a frame at half its size, smoothed by [1 2 1]/4 in integer arithmetic.
fn half_colours(frame: &Frame) -> [Plane; 3] {
    let (width, height) = (frame.width(), frame.height());
    let row = |y: usize| frame.colours()[y * width..(y + 1) * width].as_flattened();
    let [half_width, half_height] = [width, height].map(|size| size.div_ceil(2));
    let mut planes = [0; 3].map(|_| Plane::filled(half_width, half_height, 0.0));
    // Vertical sums over three rows, padded by a pixel on both sides.
    let mut sums = vec![[0u16; 4]; width + 2];
    for y in 0..half_height {
        let (above, here, below) = (row((2 * y).saturating_sub(1)), row(2 * y), row((2 * y + 1).min(height - 1)));
        for (((s, a), h), b) in sums[1..].as_flattened_mut().iter_mut().zip(above).zip(here).zip(below) {
            *s = u16::from(*a) + 2 * u16::from(*h) + u16::from(*b);
        }
        (sums[0], sums[width + 1]) = (sums[1], sums[width]);
        let [red, green, blue] = planes.each_mut().map(|plane| plane.row_mut(y));
        let places = red.iter_mut().zip(green).zip(blue);
        for (((red, green), blue), near) in places.zip(sums.windows(3).step_by(2)) {
            let sum: [f32; 4] = std::array::from_fn(|c| f32::from(near[0][c] + 2 * near[1][c] + near[2][c]) / 16.0);
            [*red, *green, *blue, _] = sum;
        }
    }
    planes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_of_half_the_size_are_weighted_means() {
        for (width, height) in [(16usize, 16usize), (17, 19), (21, 16)] {
            let bytes: Vec<u8> = (0..width * height * 4).map(|k| (k * k * 31 % 251) as u8).collect();
            let frame = Frame::from_rgba(width, height, &bytes).unwrap();
            let planes = half_colours(&frame);
            for (c, plane) in planes.iter().enumerate() {
                assert_eq!((plane.width(), plane.height()), (width.div_ceil(2), height.div_ceil(2)));
                for y in 0..plane.height() {
                    for x in 0..plane.width() {
                        let mut sum = 0.0;
                        for (dy, v) in [(-1i32, 1.0), (0, 2.0), (1, 1.0)] {
                            for (dx, u) in [(-1i32, 1.0), (0, 2.0), (1, 1.0)] {
                                let place = |at: usize, by: i32, size: usize| {
                                    (2 * at).saturating_add_signed(by as isize).min(size - 1)
                                };
                                let p = place(y, dy, height) * width + place(x, dx, width);
                                sum += u * v * f32::from(bytes[4 * p + c]);
                            }
                        }
                        assert_eq!(plane.at(x, y), sum / 16.0);
                    }
                }
            }
        }
    }
}
