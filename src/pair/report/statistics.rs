//! Statistics of every motion, and the numbers of the groups.

use crate::labelling::BACKGROUND;
use serde::Serialize;

use crate::frame::Plane;
use crate::frame::warp::{CHUNK, Footprints, RowPath};
use crate::lanes::{each_with, lane_sum};
use crate::motion::AffineMotion;
use crate::order::descending;

/// One motion of a [`Segmentation`](crate::Segmentation).
#[non_exhaustive]
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct SegmentedMotion {
    /// Its label.
    pub label: u8,
    /// Its six entries, pixels of the full-size frame.
    pub matrix: AffineMotion,
    /// Number of its pixels.
    pub pixels: usize,
    /// Their share of all pixels, 0…1.
    pub share: f64,
    /// Root mean square of the motion-compensated intensity difference over its pixels, grey levels (0 where none of them lands
    /// inside the second frame).
    pub residual: f64,
    /// Bounding box of its pixels: x, y, width, height.
    pub bbox: [usize; 4],
    /// Group: motions that are parts of one thing share a number; 0 is the ground, the others are numbered like labels.
    pub group: u8,
}

/// Pixels, residuals, boxes and group numbers of the motions.
pub(super) fn describe(
    motions: &[AffineMotion],
    grouping: &[usize],
    labels: &[u8],
    first: &Plane,
    second: &Plane,
) -> Vec<SegmentedMotion> {
    let tallies = tallies(motions, labels, first, second);
    let sizes: Vec<usize> = tallies.iter().map(|tally| tally.pixels).collect();
    let group_numbers = number_groups(grouping, &sizes);
    let described = motions.iter().zip(&tallies).zip(group_numbers).enumerate();
    described
        .map(|(k, ((motion, tally), group))| SegmentedMotion {
            label: k as u8,
            matrix: *motion,
            pixels: tally.pixels,
            share: tally.pixels as f64 / labels.len() as f64,
            residual: (tally.squares / tally.compared.max(1) as f64).sqrt(),
            bbox: tally.bounds(),
            group,
        })
        .collect()
}

/// Statistics of a motion's pixels.
struct Tally {
    pixels: usize,
    /// First column and row, and one past the last.
    corners: [usize; 4],
    /// Sum of the squared intensity differences along the motion.
    squares: f64,
    /// Number of pixels in that sum: those that land inside the second frame.
    compared: usize,
}

impl Tally {
    /// x, y, width, height; zeros where there are no pixels.
    fn bounds(&self) -> [usize; 4] {
        let [left, top, right, bottom] = self.corners;
        if self.pixels == 0 { [0; 4] } else { [left, top, right - left, bottom - top] }
    }
}

/// A tally of every motion, in one pass over the runs of its label.
fn tallies(motions: &[AffineMotion], labels: &[u8], first: &Plane, second: &Plane) -> Vec<Tally> {
    let (width, height) = (first.width(), first.height());
    let none = |_| Tally { pixels: 0, corners: [usize::MAX, usize::MAX, 0, 0], squares: 0.0, compared: 0 };
    let mut tallies: Vec<Tally> = motions.iter().map(none).collect();
    let (mut samples, mut at) = ([0.0; CHUNK], Footprints::new());
    for (y, row) in labels.chunks_exact(width).enumerate() {
        let mut start = 0;
        for run in row.chunk_by(|a, b| a == b) {
            let (k, columns) = (usize::from(run[0]), start..start + run.len());
            start = columns.end;
            let (Some(motion), Some(tally)) = (motions.get(k), tallies.get_mut(k)) else { continue };
            tally.pixels += run.len();
            let [left, top, right, bottom] = tally.corners;
            tally.corners = [left.min(columns.start), top.min(y), right.max(columns.end), bottom.max(y + 1)];
            let path = RowPath::new(motion, columns.start, y);
            for (part, values) in first.row(y)[columns].chunks(CHUNK).enumerate() {
                at.follow(&path, part * CHUNK, values.len(), width, height);
                at.sample(second.values(), &mut samples);
                each_with(&mut samples, [values], |sample, [value]| (sample - value) * (sample - value));
                if !at.all_inside(values.len()) {
                    let outside = samples.iter_mut().enumerate().filter(|(k, _)| !at.is_inside(*k));
                    outside.for_each(|(_, square)| *square = 0.0);
                }
                tally.squares += f64::from(lane_sum(&samples[..values.len()]));
                tally.compared += at.count_inside(values.len());
            }
        }
    }
    tallies
}

/// Numbers the groups by decreasing number of pixels, after the ground, which has 0.
fn number_groups(grouping: &[usize], sizes: &[usize]) -> Vec<u8> {
    let mut totals: Vec<(usize, usize)> = vec![(BACKGROUND, usize::MAX)];
    for (&group, &size) in grouping.iter().zip(sizes).filter(|(group, _)| **group != BACKGROUND) {
        match totals.iter_mut().find(|t| t.0 == group) {
            Some(t) => t.1 += size,
            None => totals.push((group, size)),
        }
    }
    let order = descending(totals.iter().map(|t| t.1 as f64));
    grouping.iter().map(|g| order.iter().position(|&k| totals[k].0 == *g).unwrap_or(0) as u8).collect()
}
