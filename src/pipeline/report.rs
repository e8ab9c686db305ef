//! What the caller gets: labels at full size, numbered by size, each motion with its figures, the evidence.

use serde::Serialize;

use super::Work;
use super::masks::Labelled;
use crate::alignment::cost::{CostModel, cost, total};
use crate::frame::filter::gaussian;
use crate::frame::warp::{CHUNK, Footprint, Footprints, RowPath};
use crate::frame::{Frame, Plane};
use crate::labelling::description::{counts, price_of_motion, worth};
use crate::labelling::groups::groups;
use crate::labelling::upsampling::upsample;
use crate::motion::AffineMotion;
use crate::options::SegmentOptions;
use crate::order::descending;
use crate::points::{Candidate, UNLABELLED};

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
    /// One label per pixel, row by row; [`UNLABELLED`] where nothing can be said (only on request).
    #[serde(skip)]
    pub labels: Vec<u8>,
    /// What the number of motions rests on.
    pub evidence: PairEvidence,
    /// Number of unlabelled pixels.
    pub unlabelled: usize,
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
    /// Description lengths, nats at the working size, of one motion up to one more than were found; smaller is better.
    pub candidates: Vec<Candidate>,
}

/// Window over which it is judged whether a motion explains a pixel, working pixels.
const UNKNOWN_WINDOW: f32 = 1.5;
/// Share of the saturated cost above which it does not.
const UNKNOWN_COST: f32 = 0.7;

pub(super) fn report(
    work: &Work,
    labelled: Labelled,
    left_over: f64,
    first: &Frame,
    second: &Frame,
    options: &SegmentOptions,
) -> Segmentation {
    let level = work.finest();
    let size = [level.width(), level.height()];
    let candidates = evidence(work, &labelled, left_over);
    let unknown = options.mark_unknown.then(|| unexplained(work, &labelled));
    let grouping = groups(&labelled.motions, &labelled.labels, size[0], work.reduction);

    let full = upsample(&labelled.labels, size, labelled.motions.len(), first.luminance());
    let order = by_size(&full, labelled.motions.len());
    let mut rank = vec![0u8; labelled.motions.len()];
    order.iter().enumerate().for_each(|(k, &old)| rank[old] = k as u8);
    let mut labels: Vec<u8> = full.iter().map(|&l| rank[usize::from(l)]).collect();
    if let Some(unknown) = unknown {
        mark(&mut labels, first.width(), &unknown, size, work.reduction);
    }
    let matrices: Vec<AffineMotion> = order.iter().map(|&k| enlarged(&labelled.motions[k], work.reduction)).collect();
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
    }
}

/// Labels by decreasing number of pixels; those without pixels are left out, but the first stays.
fn by_size(labels: &[u8], of: usize) -> Vec<usize> {
    let sizes = counts(labels, of);
    let mut order = descending(sizes.iter().map(|&s| s as f64));
    order.retain(|&k| sizes[k] > 0);
    order
}

/// A motion of the working size in pixels of the full size.
fn enlarged(motion: &AffineMotion, reduction: f64) -> AffineMotion {
    let mut a = motion.matrix;
    a[2] *= reduction;
    a[5] *= reduction;
    AffineMotion::new(a)
}

/// Working pixels that their own motion does not explain, or that leave the frame.
fn unexplained(work: &Work, labelled: &Labelled) -> Vec<bool> {
    let level = work.finest();
    let limit = UNKNOWN_COST * CostModel::LABELS.truncation;
    let mut unknown = vec![false; labelled.labels.len()];
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
                    unknown[p] = !inside || own.values()[p] > limit;
                }
            }
        }
    }
    unknown
}

fn mark(labels: &mut [u8], width: usize, unknown: &[bool], size: [usize; 2], reduction: f64) {
    let step = reduction as usize;
    for (p, label) in labels.iter_mut().enumerate() {
        let (x, y) = ((p % width / step).min(size[0] - 1), (p / width / step).min(size[1] - 1));
        if unknown[y * size[0] + x] {
            *label = UNLABELLED;
        }
    }
}

/// Description lengths: of what was found, of what remains as the least worthy motions are taken away, and of one more.
fn evidence(work: &Work, labelled: &Labelled, left_over: f64) -> Vec<Candidate> {
    let level = work.finest();
    let pixels = labelled.labels.len();
    let mut raw: Vec<Plane> = labelled.motions.iter().map(|m| cost(level, m, CostModel::ESTIMATION)).collect();
    let mut labels = labelled.labels.clone();
    let n = raw.len();
    let mut own = Plane::filled(level.width(), level.height(), 0.0);
    for (p, slot) in own.values_mut().iter_mut().enumerate() {
        *slot = raw[usize::from(labels[p])].values()[p];
    }
    let mut length = 0.5 * total(&own) + n as f64 * price_of_motion(pixels);
    let one_more = length + price_of_motion(pixels) - 0.5 * left_over;
    let mut candidates = vec![Candidate { motions: n + 1, score: one_more }, Candidate { motions: n, score: length }];
    while raw.len() > 1 {
        let worths = worth(&raw, &labels, level.width());
        let Some((weakest, value)) = worths.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)) else { break };
        length += value.max(-price_of_motion(pixels));
        raw.remove(weakest);
        reassign(&mut labels, weakest as u8, &raw);
        candidates.push(Candidate { motions: raw.len(), score: length });
    }
    candidates.reverse();
    candidates
}

/// Gives a removed label's region to the remaining motion that explains it best.
fn reassign(labels: &mut [u8], removed: u8, raw: &[Plane]) {
    let sums: Vec<f64> = raw
        .iter()
        .map(|plane| {
            let costs = plane.values().iter().zip(labels.iter());
            costs.filter(|&(_, &l)| l == removed).map(|(&c, _)| f64::from(c)).sum()
        })
        .collect();
    let best = sums.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(k, _)| k) as u8;
    for label in labels {
        if *label == removed {
            *label = best;
        } else if *label > removed {
            *label -= 1;
        }
    }
}

/// Pixels, residuals, boxes and group numbers of the motions.
fn describe(
    motions: &[AffineMotion],
    grouping: &[usize],
    labels: &[u8],
    first: &Plane,
    second: &Plane,
) -> Vec<SegmentedMotion> {
    let sizes = counts(labels, motions.len());
    let group_numbers = number_groups(grouping, &sizes);
    let boxes = bounding_boxes(labels, motions.len(), first.width());
    let residuals = residuals(motions, &boxes, labels, first, second);
    motions
        .iter()
        .enumerate()
        .map(|(k, motion)| SegmentedMotion {
            label: k as u8,
            matrix: *motion,
            pixels: sizes[k],
            share: sizes[k] as f64 / labels.len() as f64,
            residual: residuals[k],
            bbox: boxes[k],
            group: group_numbers[k],
        })
        .collect()
}

/// Root mean square of the intensity difference along each motion over its pixels.
fn residuals(motions: &[AffineMotion], boxes: &[[usize; 4]], labels: &[u8], first: &Plane, second: &Plane) -> Vec<f64> {
    let (width, height) = (first.width(), first.height());
    let mut sums = vec![(0.0, 0usize); motions.len()];
    let mut samples = [0.0; CHUNK];
    for (y, row) in labels.chunks_exact(width).enumerate() {
        let mut start = 0;
        for run in row.chunk_by(|a, b| a == b) {
            let k = usize::from(run[0]);
            let columns = start..start + run.len();
            start = columns.end;
            let (Some(motion), Some((sum, count))) = (motions.get(k), sums.get_mut(k)) else { continue };
            let left = boxes[k][0];
            let path = RowPath::new(motion, left, y);
            for (part, values) in first.row(y)[columns.clone()].chunks(CHUNK).enumerate() {
                let at = Footprints::along(&path, columns.start - left + part * CHUNK, width, height);
                at.sample(second.values(), &mut samples[..values.len()]);
                let seen = values.iter().zip(&samples).zip(&at.inside);
                for ((value, sample), _) in seen.filter(|(_, inside)| **inside) {
                    let difference = f64::from(sample - value);
                    *sum += difference * difference;
                    *count += 1;
                }
            }
        }
    }
    sums.into_iter().map(|(sum, count)| (sum / count.max(1) as f64).sqrt()).collect()
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

/// x, y, width, height of every label's pixels; zeros where it has none.
fn bounding_boxes(labels: &[u8], of: usize, width: usize) -> Vec<[usize; 4]> {
    let mut corners = vec![[usize::MAX, usize::MAX, 0, 0]; of];
    for (y, row) in labels.chunks_exact(width).enumerate() {
        let mut start = 0;
        for run in row.chunk_by(|a, b| a == b) {
            let end = start + run.len();
            if let Some([left, top, right, bottom]) = corners.get_mut(usize::from(run[0])) {
                (*left, *top) = ((*left).min(start), (*top).min(y));
                (*right, *bottom) = ((*right).max(end), (*bottom).max(y + 1));
            }
            start = end;
        }
    }
    corners.into_iter().map(|[l, t, r, b]| if r == 0 { [0; 4] } else { [l, t, r - l, b - t] }).collect()
}
