//! A clip as a strip: every fourth frame from left to right; the frames above, then the labels found, then the true ones.
use experiments::clips::cases::Data;
use experiments::panels::Sheet;
use veronese::Result;

/// Every how many frames one is shown.
const EVERY: usize = 4;
/// Frames are made no wider than this, pixels, and strips either.
const WIDEST_FRAME: usize = 80;
const WIDEST: usize = 720;
/// Width of the white lines between frames, pixels.
const GAP: usize = 2;

/// The strip as an indexed PNG file. The background label found is shown as the frame is.
pub(crate) fn strip(data: &Data, labels: &[Vec<u8>]) -> Result<Vec<u8>> {
    let shown: Vec<usize> = (0..data.frames.len()).step_by(EVERY).collect();
    let (full, tall) = data.frames.first().map_or((1, 1), |frame| (frame.width(), frame.height()));
    let step = full.div_ceil(WIDEST_FRAME.min(WIDEST / shown.len().max(1)));
    let (width, height) = (full / step, tall / step);
    let mut sheet = Sheet::new(shown.len() * (width + GAP) - GAP, 3 * (height + GAP) - GAP);
    let background = background(labels);
    for (k, &t) in shown.iter().enumerate() {
        let own: Vec<u8> = labels[t].iter().map(|&label| exchanged(label, background)).collect();
        for (row, labels) in [None, Some(&own[..]), Some(&data.truths[t][..])].into_iter().enumerate() {
            let corner = [k * (width + GAP), row * (height + GAP)];
            sheet.place(corner, data.frames[t].luminance(), labels, step);
        }
    }
    sheet.png()
}

/// The label with the most pixels.
fn background(labels: &[Vec<u8>]) -> u8 {
    let mut sizes = [0usize; 255];
    for &label in labels.iter().flatten() {
        if let Some(size) = sizes.get_mut(usize::from(label)) {
            *size += 1;
        }
    }
    (0..255u8).reduce(|a, b| if sizes[usize::from(b)] > sizes[usize::from(a)] { b } else { a }).unwrap_or(0)
}

/// A label where the background has the number 0.
fn exchanged(label: u8, background: u8) -> u8 {
    match label {
        0 => background,
        label if label == background => 0,
        label => label,
    }
}
