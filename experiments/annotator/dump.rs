//! Labels as files to look at.

use std::fs;

use veronese::codecs::encode_indexed_png;

use crate::cases::{Case, Data};
use crate::strips::strip;
use crate::{Failure, Options};

/// Writes labels of a clip at some stage, if they were asked for: an indexed image of every frame, and a strip of small ones.
pub(crate) fn write(
    options: &Options,
    case: &Case,
    stage: &str,
    data: &Data,
    labels: &[Vec<u8>],
) -> Result<(), Failure> {
    let Some(folder) = options.dump.as_ref().map(|folder| folder.join(&case.name)) else { return Ok(()) };
    fs::create_dir_all(folder.join(stage))?;
    for (t, (frame, labels)) in data.frames.iter().zip(labels).enumerate() {
        let file = folder.join(stage).join(format!("{t:05}.png"));
        fs::write(file, encode_indexed_png(frame.width(), frame.height(), labels, &palette())?)?;
    }
    fs::write(folder.join(format!("{stage}.png")), strip(data, labels)?)?;
    Ok(())
}

/// The palette of Pascal VOC and DAVIS: the bits of a label, by turns to red, green and blue, the lowest ones first.
fn palette() -> Vec<u8> {
    let channel = |label: u8, first: u8| {
        (first..8).step_by(3).zip((0..8).rev()).map(|(bit, place)| (label >> bit & 1) << place).sum::<u8>()
    };
    (0..=u8::MAX).flat_map(|label| (0..3).map(move |first| channel(label, first))).collect()
}
