//! The result for a frame: its labels at full size, and its objects.

use serde::Serialize;

use super::options::model;
use super::pairs::LayeredMotion;
use crate::answer::UNLABELLED;
use crate::frame::Plane;
use crate::frame::scaling::Scaling;
use crate::labelling::BACKGROUND;
use crate::labelling::upsampling::upsample;
use crate::model::Model;
use crate::motion::AffineMotion;

/// One frame of a clip, segmented.
#[non_exhaustive]
#[derive(Clone, Debug, Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ClipFrame {
    /// Position in the clip, from 0.
    pub index: usize,
    /// One label per pixel, row by row: 0 for the background, 255 for a pixel that is marked as unknown, else the number of an object.
    #[serde(skip)]
    pub labels: Vec<u8>,
    /// The visible objects, by number.
    pub objects: Vec<ClipObject>,
    /// Motion of the background to the next frame, pixels; `None` if no frame of the same scene follows. With a look-ahead, the motion from
    /// the previous frame, continued.
    pub background: Option<AffineMotion>,
}

/// An object in one frame of a clip.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ClipObject {
    /// Its number, 1…254, the same in all frames.
    pub id: u8,
    /// Number of its pixels.
    pub pixels: usize,
    /// Bounding box of its pixels: x, y, width, height.
    pub bbox: [usize; 4],
    /// Mean probability, 0…1, that its pixels belong to an object.
    pub confidence: f64,
    /// Motion of its largest part to the next frame, as [`ClipFrame::background`].
    pub matrix: Option<AffineMotion>,
}

/// A frame at the working size.
pub(crate) struct WorkingFrame<'a> {
    pub(crate) index: usize,
    /// The object of every pixel, 0 for the background.
    pub(crate) labels: &'a [u8],
    /// Log-odds of object against background, nats.
    pub(crate) log_odds: &'a Plane,
    /// Motion to the next frame of the scene, if there is one.
    pub(crate) onward: Option<&'a LayeredMotion>,
    /// Whether pixels whose log-odds do not decide get the label 255.
    pub(crate) mark_unknown: bool,
}

impl WorkingFrame<'_> {
    /// The result for the frame at the size of its luminance.
    pub(crate) fn described(&self, luminance: &Plane) -> ClipFrame {
        self.marked(self.upsampled(luminance), None, luminance.width())
    }

    /// The result for full-size labels, of which the undecided ones are marked if that is asked for, except where labels were drawn exactly.
    pub(crate) fn marked(&self, mut labels: Vec<u8>, exact: Option<&[u8]>, width: usize) -> ClipFrame {
        let scaling = Scaling::between([width, labels.len() / width], [self.log_odds.width(), self.log_odds.height()]);
        if self.mark_unknown {
            for (label, log_odds) in labels.iter_mut().zip(scaling.enlarged(self.log_odds.values())) {
                if log_odds.abs() < model().undecided {
                    *label = UNLABELLED;
                }
            }
            let exact = exact.into_iter().flatten();
            labels.iter_mut().zip(exact).filter(|(_, exact)| **exact != UNLABELLED).for_each(|(l, exact)| *l = *exact);
        }
        self.describe(labels, &scaling)
    }

    /// The labels at full size.
    pub(crate) fn upsampled(&self, luminance: &Plane) -> Vec<u8> {
        let full = [luminance.width(), luminance.height()];
        let scaling = Scaling::between(full, [self.log_odds.width(), self.log_odds.height()]);
        let of = self.labels.iter().max().map_or(1, |&most| usize::from(most) + 1);
        upsample(self.labels, &scaling, of, luminance, &Model::DEFAULT)
    }

    /// Describes the objects of full-size labels.
    fn describe(&self, labels: Vec<u8>, scaling: &Scaling) -> ClipFrame {
        let scale = |motion: &AffineMotion| motion.scaled(scaling.step as f64);
        let background = self.onward.map(|onward| scale(&onward.motions[BACKGROUND]));
        let mut objects = boxes(&labels, scaling.full[0]);
        for object in &mut objects {
            let pixels = || (0..self.labels.len()).filter(|&p| self.labels[p] == object.id);
            object.confidence = mean_probability(self.log_odds, pixels());
            object.matrix = self.onward.map(|onward| {
                let of_largest_part = onward.most_frequent(pixels()).unwrap_or(BACKGROUND);
                scale(&onward.motions[of_largest_part])
            });
        }
        ClipFrame { index: self.index, labels, objects, background }
    }
}

/// Pixels and bounding box of every object in some labels.
fn boxes(labels: &[u8], width: usize) -> Vec<ClipObject> {
    let mut corners = [[usize::MAX, usize::MAX, 0, 0]; 256];
    let mut pixels = [0usize; 256];
    for (y, row) in labels.chunks_exact(width).enumerate() {
        let mut x = 0;
        for run in row.chunk_by(|a, b| a == b) {
            let (k, end) = (usize::from(run[0]), x + run.len());
            let [left, top, right, bottom] = corners[k];
            corners[k] = [left.min(x), top.min(y), right.max(end), bottom.max(y + 1)];
            pixels[k] += run.len();
            x = end;
        }
    }
    let described = |k: u8| {
        let ([left, top, right, bottom], pixels) = (corners[usize::from(k)], pixels[usize::from(k)]);
        let bbox = [left, top, right.wrapping_sub(left), bottom.wrapping_sub(top)];
        (pixels > 0).then_some(ClipObject { id: k, pixels, bbox, confidence: 0.0, matrix: None })
    };
    (1..UNLABELLED).filter_map(described).collect()
}

/// Mean probability of an object over some pixels, 0…1.
fn mean_probability(log_odds: &Plane, pixels: impl Iterator<Item = usize>) -> f64 {
    let probability = |log_odds: f32| f64::from(1.0 / (1.0 + libm::expf(-log_odds)));
    let (sum, count) =
        pixels.fold((0.0, 0usize), |(sum, count), p| (sum + probability(log_odds.values()[p]), count + 1));
    sum / count.max(1) as f64
}
