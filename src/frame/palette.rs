//! The quantised colours of a frame.

use super::Frame;
use super::scaling::Scaling;

/// Steps per colour channel: 8³ colours are few enough to learn from one frame, and enough to distinguish clothes from grass. Not varied.
const STEPS: usize = 8;
/// Number of different colours.
pub(crate) const COLOURS: usize = STEPS * STEPS * STEPS;

/// The colour that is a step brighter in every channel, if there is one.
pub(crate) fn brighter(colour: usize) -> Option<usize> {
    let channels = [colour / (STEPS * STEPS), colour / STEPS % STEPS, colour % STEPS];
    channels.iter().all(|&channel| channel + 1 < STEPS).then_some(colour + (STEPS + 1) * STEPS + 1)
}

/// The quantised colour of every working pixel.
#[derive(Clone, Debug)]
pub(crate) struct Palette {
    size: [usize; 2],
    indices: Vec<u16>,
}

impl Palette {
    /// Width and height.
    pub(crate) fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Quantises the mean colours over the full-size pixels of each working pixel.
    pub(crate) fn new(frame: &Frame, &Scaling { small: [width, height], step, .. }: &Scaling) -> Palette {
        let mut indices = Vec::with_capacity(width * height);
        let mut sums = vec![[0u32; 4]; width];
        for rows in frame.colours().chunks(frame.width() * step) {
            sums.fill([0; 4]);
            for row in rows.chunks(frame.width()) {
                for ([red, green, blue, count], colours) in sums.iter_mut().zip(row.chunks(step)) {
                    for [r, g, b, _] in colours {
                        *red += u32::from(*r);
                        *green += u32::from(*g);
                        *blue += u32::from(*b);
                    }
                    *count += colours.len() as u32;
                }
            }
            indices.extend(sums.iter().map(|[r, g, b, count]| {
                let [r, g, b] = [r, g, b].map(|sum| sum * STEPS as u32 / (256 * count.max(&1)));
                ((r * STEPS as u32 + g) * STEPS as u32 + b) as u16
            }));
        }
        Palette { size: [width, height], indices }
    }

    /// Width in working pixels.
    pub(crate) fn width(&self) -> usize {
        self.size[0]
    }

    /// The number of a pixel's colour, below [`COLOURS`].
    #[inline(always)]
    pub(crate) fn index(&self, pixel: usize) -> usize {
        usize::from(self.indices[pixel])
    }
}
