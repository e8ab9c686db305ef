//! Panels side by side: the first frame, then labellings of it.
use experiments::masks::cases::Data;
use experiments::panels::Sheet;
use veronese::Result;

/// Panels are made no wider than this, pixels.
const WIDEST: usize = 216;
/// Width of the white lines between panels, pixels.
const GAP: usize = 4;

/// The frame and the labellings as an indexed PNG file.
pub(crate) fn panels(data: &Data, labellings: &[Vec<u8>]) -> Result<Vec<u8>> {
    let step = data.first.width().div_ceil(WIDEST);
    let (width, height) = (data.first.width() / step, data.first.height() / step);
    let mut sheet = Sheet::new((labellings.len() + 1) * (width + GAP) - GAP, height);
    for k in 0..=labellings.len() {
        let labels = k.checked_sub(1).map(|k| &labellings[k][..]);
        sheet.place([k * (width + GAP), 0], data.first.luminance(), labels, step);
    }
    sheet.png()
}
