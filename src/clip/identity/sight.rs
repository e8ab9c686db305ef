//! Size, position, motion and colours of a set of pixels.

use crate::clip::pairs::LayeredMotion;
use crate::clip::record::Record;
use crate::frame::palette::COLOURS;
use crate::labelling::is_background;

/// A set of pixels of one frame, summarised.
#[derive(Clone, Debug)]
pub(crate) struct Sight {
    /// Number of working pixels.
    pub(crate) size: f64,
    /// Their centre, working pixels.
    pub(crate) centre: [f64; 2],
    /// Their mean displacement to the next frame, working pixels.
    pub(crate) velocity: [f64; 2],
    /// Share of each colour among them; the sum is 1.
    pub(crate) colours: Vec<f32>,
}

impl Sight {
    pub(crate) fn of(record: &Record, pixels: &[usize]) -> Sight {
        let (width, palette) = (record.size()[0], &record.palette);
        let size = pixels.len().max(1) as f64;
        let (mut centre, mut colours) = ([0.0; 2], vec![0.0; COLOURS]);
        for &p in pixels {
            centre = [centre[0] + (p % width) as f64 / size, centre[1] + (p / width) as f64 / size];
            colours[palette.index(p)] += 1.0 / size as f32;
        }
        Sight { size, centre, velocity: velocity(record, pixels), colours }
    }

    /// Overlap of the two colour histograms, 0…1.
    pub(crate) fn alike(&self, other: &Sight) -> f64 {
        self.colours.iter().zip(&other.colours).map(|(a, b)| f64::from(a.min(*b))).sum()
    }
}

/// The motion that shows how the pixels of a frame move: that to the next frame or, at the end of a scene or if the next frame repeats this
/// one, that to the previous frame.
pub(crate) fn shown_motion(record: &Record) -> Option<&LayeredMotion> {
    record.onward.as_ref().filter(|onward| !onward.is_still()).or(record.back.as_ref()).or(record.onward.as_ref())
}

/// Mean displacement of some pixels along a flow.
pub(crate) fn mean_motion(along: &LayeredMotion, pixels: &[usize]) -> [f64; 2] {
    let (n, width) = (pixels.len().max(1) as f64, along.width);
    let sums = pixels.iter().fold([0.0, 0.0], |[a, b], &p| {
        let [u, v] = along.at(p % width, p / width);
        [a + u, b + v]
    });
    sums.map(|sum| sum / n)
}

/// Mean displacement of some pixels from this frame to the next one, as far as it is known.
fn velocity(record: &Record, pixels: &[usize]) -> [f64; 2] {
    match (shown_motion(record), &record.onward) {
        (Some(along), Some(onward)) if std::ptr::eq(along, onward) => mean_motion(along, pixels),
        (Some(back), _) => mean_motion(back, pixels).map(|v| -v),
        (None, _) => [0.0; 2],
    }
}

/// Whether most of some pixels move differently from the background.
pub(crate) fn moves(record: &Record, pixels: &[usize]) -> bool {
    shown_motion(record)
        .is_some_and(|flow| 2 * pixels.iter().filter(|&&p| !is_background(flow.labels[p])).count() > pixels.len())
}
