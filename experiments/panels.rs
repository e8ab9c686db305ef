//! Frames and labellings on a white sheet. Label 0 is as in the frame, every other label has its colour, pixels without a label are
//! dark.

use veronese::codecs::encode_indexed_png;
use veronese::{Plane, Result, UNLABELLED};

/// Steps of grey; with the plain greys, the coloured and the dark ones they fill a palette.
const STEPS: usize = 18;
/// Colours of labels 1, 2, …
const COLOURS: [[f64; 3]; 12] = [
    [255.0, 140.0, 0.0],
    [60.0, 150.0, 255.0],
    [0.0, 200.0, 90.0],
    [240.0, 60.0, 160.0],
    [235.0, 220.0, 40.0],
    [150.0, 90.0, 255.0],
    [0.0, 210.0, 210.0],
    [200.0, 40.0, 40.0],
    [140.0, 200.0, 60.0],
    [250.0, 170.0, 170.0],
    [120.0, 120.0, 190.0],
    [170.0, 110.0, 50.0],
];
const DARK: usize = COLOURS.len() + 1;
const WHITE: u8 = STEPS as u8 - 1;

/// What pictures are made of: an indexed image.
pub struct Sheet {
    width: usize,
    height: usize,
    indices: Vec<u8>,
}

impl Sheet {
    pub fn new(width: usize, height: usize) -> Sheet {
        Sheet { width, height, indices: vec![WHITE; width * height] }
    }

    /// A frame, or a labelling of it, reduced by `step`, with its top left corner at `corner`. What does not fit is cut off.
    pub fn place(&mut self, corner: [usize; 2], luminance: &Plane, labels: Option<&[u8]>, step: usize) {
        let [left, top] = corner;
        for y in 0..(luminance.height() / step).min(self.height - top) {
            for x in 0..(luminance.width() / step).min(self.width - left) {
                let square = (0..step * step).map(|i| (x * step + i % step, y * step + i / step));
                let sum: f32 = square.map(|(u, v)| luminance.at(u, v)).sum();
                let shade = (sum / (step * step) as f32 / 255.0 * (STEPS - 1) as f32).round() as usize;
                let group = match labels.map_or(0, |labels| labels[(y * luminance.width() + x) * step]) {
                    UNLABELLED => DARK,
                    0 => 0,
                    label => 1 + usize::from(label - 1) % COLOURS.len(),
                };
                self.indices[(top + y) * self.width + left + x] = (group * STEPS + shade.min(STEPS - 1)) as u8;
            }
        }
    }

    /// As an indexed PNG file.
    pub fn png(&self) -> Result<Vec<u8>> {
        encode_indexed_png(self.width, self.height, &self.indices, &palette())
    }
}

fn palette() -> Vec<u8> {
    let mut palette = Vec::with_capacity(3 * (DARK + 1) * STEPS);
    for group in 0..=DARK {
        for step in 0..STEPS {
            let grey = step as f64 * 255.0 / (STEPS - 1) as f64;
            let colour = match group {
                0 => [grey; 3],
                DARK => [0.3 * grey; 3],
                label => COLOURS[label - 1].map(|c| 0.6 * c + 0.4 * grey),
            };
            palette.extend(colour.map(|value| value.round() as u8));
        }
    }
    palette
}
