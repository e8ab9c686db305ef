//! The result: labels at full size, numbered by pixel count, statistics of every motion, evidence for their number.

use serde::Serialize;

use super::Pair;
use super::evidence::evidence;
use super::labels::Labelled;
use super::settings::{Part, Settings};
use crate::answer::{Candidate, UNLABELLED};
use crate::frame::filter::gaussian;
use crate::frame::warp::{CHUNK, Footprint, Footprints, RowPath};
use crate::frame::{Frame, Plane};
use crate::labelling::confidence::probabilities;
use crate::labelling::regions::description::counts;
use crate::labelling::regions::groups::groups;
use crate::labelling::resolution::upsampling::{enlarged, upsample};
use crate::labelling::terms::views::costs_where_seen;
use crate::labelling::terms::visibility::hidden;
use crate::lanes::each_with;
use crate::motion::AffineMotion;
use crate::options::SegmentOptions;
use crate::order::descending;
use crate::view::cost::{CostModel, cost, lane_sum};
use crate::workspace::Buffer;

/// What [`segment_pair`](crate::segment_pair) found.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Segmentation {
    /// Width of the frames, pixels.
    pub width: usize,
    /// Height of the frames, pixels.
    pub height: usize,
    /// Number of motions.
    pub count: usize,
    /// The motions by decreasing number of pixels; `motions[i].label == i`.
    pub motions: Vec<SegmentedMotion>,
    /// One label per pixel, row by row; [`UNLABELLED`] where the data cannot tell (only on request).
    #[serde(skip)]
    pub labels: Vec<u8>,
    /// Evidence for the number of motions.
    pub evidence: PairEvidence,
    /// Number of unlabelled pixels.
    pub unlabelled: usize,
    /// Confidence of every label, row by row, if requested: 255 times the probability of the pixel's motion, given how well all
    /// motions explain the pixel and its surroundings and which labels surround it. 255 is certain, 0 unlabelled. The probability
    /// is calibrated: of the pixels with probability P, about the share P is right. It is low where no motion fits.
    #[serde(skip)]
    pub confidence: Option<Vec<u8>>,
}

/// One motion of a [`Segmentation`].
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
    /// Group: motions of one rigid background share a number; numbered like labels, 0 is the largest group.
    pub group: u8,
}

/// Evidence for the number of motions of a pair.
#[derive(Clone, Debug, Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct PairEvidence {
    /// Description lengths of both frames in nats, from one motion up to one more than were found; smaller is better. For fewer
    /// motions the least worthy are removed one by one; for one more the best rejected motion is added. Labels are solved for each
    /// number with the same costs, on a level whose longer side is at most 224 pixels unless the frame is narrow. The stages of
    /// the pipeline decide on more than this list, so the number found need not have the smallest score.
    pub candidates: Vec<Candidate>,
}

/// Standard deviation of the window in which a motion must explain a pixel, working pixels.
const UNKNOWN_WINDOW: f32 = 1.5;
/// Share of the saturated cost above which the motion does not explain the pixel.
const UNKNOWN_COST: f32 = 0.7;
/// Standard deviation of the window in which texture is measured, working pixels.
const TEXTURE_WINDOW: f32 = 3.0;
/// Mean squared gradient, in units of the noise variance, below which there is no texture: noise alone has 0.15 to 0.2.
const NO_TEXTURE: f32 = 0.2;

pub(super) fn report(
    pair: &Pair<'_>,
    labelled: Labelled,
    settings: &Settings,
    first: &Frame,
    second: &Frame,
    options: &SegmentOptions,
) -> Segmentation {
    let level = pair.finest();
    let size = [level.width(), level.height()];
    let candidates = evidence(pair, &labelled, settings);
    let sure = (options.mark_unknown || options.confidence)
        .then(|| probabilities(&costs_where_seen(level, &labelled.motions), &labelled.labels));
    let unknown = sure.as_ref().filter(|_| options.mark_unknown).map(|sure| unknown(pair, &labelled, sure));
    let grouping = groups(&labelled.motions, &labelled.labels, size[0], pair.reduction);

    let full = if settings.has(Part::GuidedEnlarging) {
        upsample(&labelled.labels, size, labelled.motions.len(), first.luminance())
    } else {
        nearest(&labelled.labels, size, first, pair.reduction)
    };
    let mut confidence = sure.filter(|_| options.confidence).map(|sure| confidence(&sure, &full, first.width()));
    let order = by_size(&full, labelled.motions.len());
    let mut rank = [0u8; 256];
    order.iter().enumerate().for_each(|(k, &old)| rank[old] = k as u8);
    let mut labels = full;
    labels.iter_mut().for_each(|l| *l = rank[usize::from(*l)]);
    if let Some(unknown) = unknown {
        mark_unlabelled(&mut labels, first.width(), &unknown, size, pair.reduction);
    }
    for (sure, _) in confidence.iter_mut().flatten().zip(&labels).filter(|(_, label)| **label == UNLABELLED) {
        *sure = 0;
    }
    let matrices: Vec<AffineMotion> =
        order.iter().map(|&k| at_full_size(&labelled.motions[k], pair.reduction)).collect();
    let groups: Vec<usize> = order.iter().map(|&k| grouping[k]).collect();
    let motions = describe(&matrices, &groups, &labels, first.luminance(), second.luminance());
    Segmentation {
        width: first.width(),
        height: first.height(),
        count: motions.len(),
        unlabelled: labels.iter().filter(|&&l| l == UNLABELLED).count(),
        motions,
        labels,
        evidence: PairEvidence { candidates },
        confidence,
    }
}

/// The probability of each pixel's label at full size, in steps of 1/255.
fn confidence(probabilities: &[Plane], labels: &[u8], width: usize) -> Vec<u8> {
    let mut confidence = vec![0; labels.len()];
    for (k, of_motion) in probabilities.iter().enumerate() {
        let full = enlarged(of_motion, width, labels.len() / width);
        for ((c, p), _) in
            confidence.iter_mut().zip(full.values()).zip(labels).filter(|(_, label)| usize::from(**label) == k)
        {
            *c = (255.0 * p + 0.5) as u8;
        }
    }
    confidence
}

/// Labels by decreasing number of pixels, without those that have none.
fn by_size(labels: &[u8], of: usize) -> Buffer<usize> {
    let sizes = counts(labels, of);
    let mut order = descending(sizes.iter().map(|&s| s as f64));
    order.retain(|&k| sizes[k] > 0);
    order
}

/// A motion of the working size in pixels of the full size.
fn at_full_size(motion: &AffineMotion, reduction: f64) -> AffineMotion {
    let mut a = motion.matrix;
    a[2] *= reduction;
    a[5] *= reduction;
    AffineMotion::new(a)
}

/// A motion of the full size in pixels of the working size.
pub(super) fn at_working_size(motion: &AffineMotion, reduction: f64) -> AffineMotion {
    let mut a = motion.matrix;
    a[2] /= reduction;
    a[5] /= reduction;
    AffineMotion::new(a)
}

/// Working pixels that leave the frame, are occluded, are not explained by their own motion, have no texture around them, or
/// whose label is more likely wrong than right.
fn unknown(pair: &Pair<'_>, labelled: &Labelled, probabilities: &[Plane]) -> Buffer<bool> {
    let level = pair.finest();
    let limit = UNKNOWN_COST * CostModel::LABELS.truncation;
    let texture = gaussian(&level.energy, TEXTURE_WINDOW);
    let no_texture = NO_TEXTURE * level.noise * level.noise;
    let mut unknown = hidden(level, &labelled.motions, &labelled.labels);
    for (k, motion) in labelled.motions.iter().enumerate() {
        let own = gaussian(&cost(level, motion, CostModel::LABELS), UNKNOWN_WINDOW);
        let scaled = level.scaled(motion);
        for y in 0..level.height() {
            let path = RowPath::new(&scaled, 0, y);
            for x in 0..level.width() {
                let p = y * level.width() + x;
                if usize::from(labelled.labels[p]) == k {
                    let (px, py) = path.at(x);
                    let inside = Footprint::new(px, py, level.width(), level.height()).inside;
                    let decided = texture.values()[p] > no_texture && probabilities[k].values()[p] >= 0.5;
                    unknown[p] |= !inside || !decided || own.values()[p] > limit;
                }
            }
        }
    }
    unknown
}

/// Labels enlarged by nearest neighbour.
fn nearest(labels: &[u8], size: [usize; 2], frame: &Frame, reduction: f64) -> Vec<u8> {
    (0..frame.width() * frame.height()).map(|p| labels[working_pixel(p, frame.width(), size, reduction)]).collect()
}

/// The working pixel that a full-size pixel belongs to.
fn working_pixel(p: usize, width: usize, size: [usize; 2], reduction: f64) -> usize {
    let step = reduction as usize;
    (p / width / step).min(size[1] - 1) * size[0] + (p % width / step).min(size[0] - 1)
}

fn mark_unlabelled(labels: &mut [u8], width: usize, unknown: &[bool], size: [usize; 2], reduction: f64) {
    for (p, label) in labels.iter_mut().enumerate() {
        if unknown[working_pixel(p, width, size, reduction)] {
            *label = UNLABELLED;
        }
    }
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
    /// Sum of the squared intensity differences along the motion …
    squares: f64,
    /// … and the number of pixels it is taken over: those that land inside the second frame.
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

/// Groups numbered by decreasing number of pixels.
fn number_groups(grouping: &[usize], sizes: &[usize]) -> Vec<u8> {
    let mut totals: Vec<(usize, usize)> = Vec::new();
    for (&group, &size) in grouping.iter().zip(sizes) {
        match totals.iter_mut().find(|t| t.0 == group) {
            Some(t) => t.1 += size,
            None => totals.push((group, size)),
        }
    }
    let order = descending(totals.iter().map(|t| t.1 as f64));
    grouping.iter().map(|g| order.iter().position(|&k| totals[k].0 == *g).unwrap_or(0) as u8).collect()
}
