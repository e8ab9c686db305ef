//! Panels side by side: the first frame, then labellings of it. Label 0 is as in the frame, every other label has its colour, pixels
//! without a label are dark.

use veronese::Result;
use veronese::codecs::encode_indexed_png;

use crate::cases::Data;
use crate::scores::VOID;

/// Panels are made no wider than this, pixels.
const WIDEST: usize = 216;
/// Width of the white lines between panels, pixels.
const GAP: usize = 4;
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

/// The frame and the labellings as an indexed PNG file.
pub(crate) fn panels(data: &Data, labellings: &[Vec<u8>]) -> Result<Vec<u8>> {
    let (frame_width, frame_height) = (data.first.width(), data.first.height());
    let step = frame_width.div_ceil(WIDEST);
    let (width, height) = (frame_width / step, frame_height / step);
    let full_width = (labellings.len() + 1) * (width + GAP) - GAP;
    let mut indices = vec![WHITE; full_width * height];
    for k in 0..=labellings.len() {
        for y in 0..height {
            for x in 0..width {
                let square = (0..step * step).map(|i| (x * step + i % step, y * step + i / step));
                let sum: f32 = square.map(|(u, v)| data.first.luminance().at(u, v)).sum();
                let shade = (sum / (step * step) as f32 / 255.0 * (STEPS - 1) as f32).round() as usize;
                let label = k.checked_sub(1).map_or(0, |k| labellings[k][(y * frame_width + x) * step]);
                let group = match label {
                    VOID => DARK,
                    0 => 0,
                    label => 1 + usize::from(label - 1) % COLOURS.len(),
                };
                indices[y * full_width + k * (width + GAP) + x] = (group * STEPS + shade.min(STEPS - 1)) as u8;
            }
        }
    }
    encode_indexed_png(full_width, height, &indices, &palette())
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
