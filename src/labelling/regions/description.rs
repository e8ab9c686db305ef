//! The description length of both frames, in nats. Motions are added, removed, merged and split, and the background is taken to be at rest,
//! where that makes it shorter.
//!
//! ```text
//! L = ½ Σ_p w ρ(p, l_p)  +  Σ_k 3 ln n_k  +  ½ b
//! ```
//! ρ is the estimation cost of the pixel's motion and w the weight of a pixel of this level; n_k is the number of pixels of each motion
//! that is not at rest, b the number of pairs of neighbours with different labels. An object is removed unless it saves more than its whole
//! border costs: the labels that replace it may have borders, too, but these are not known in advance. Before there are labels, the penalty
//! of a motion is that of all pixels of the frame.

use crate::frame::Plane;
use crate::labelling::{BACKGROUND, across_borders};
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::view::level::PairLevel;

/// Number of entries of a motion; no motion is described with fewer pixels.
const ENTRIES: usize = 6;
/// Worth of a region that is too small to be an object, nats: less than that of any other.
const TOO_SMALL: f64 = -1e9;

/// Nats for the six parameters of a motion with so many pixels: (6/2) ln N (Schwarz, Annals of Statistics 6(2), 1978).
pub(crate) fn motion_penalty(pixels: usize) -> f64 {
    0.5 * ENTRIES as f64 * libm::log(pixels.max(ENTRIES) as f64)
}

/// Nats by which the parameters of two motions with so many pixels each cost more than those of one motion with all of them.
pub(super) fn second_motion_penalty(pixels: [usize; 2]) -> f64 {
    pixels.iter().map(|&n| motion_penalty(n)).sum::<f64>() - motion_penalty(pixels.iter().sum())
}

/// Nats for a border of some pixels.
pub(super) fn border_penalty(pixels: usize, model: &Model) -> f64 {
    model.border_penalty * pixels as f64
}

/// Weight of a pixel of a level, in working pixels.
pub(crate) fn weight_of_pixel(level: &PairLevel) -> f32 {
    level.pixel() as f32
}

/// The same as [`motion_penalty`], in summed costs of the pixels of a level.
pub(crate) fn motion_penalty_on(level: &PairLevel) -> f64 {
    2.0 * motion_penalty(level.width() * level.height()) / f64::from(weight_of_pixel(level))
}

/// Description length in nats of both frames by motions and labels: residuals, six parameters per motion, borders. Rest needs no
/// parameters.
///
/// `raw` as in [`worth`].
pub(crate) fn length(motions: &[AffineMotion], raw: &[Plane], labels: &[u8], width: usize, model: &Model) -> f64 {
    let left_over: f64 = labels.iter().enumerate().map(|(p, &l)| f64::from(raw[usize::from(l)].values()[p])).sum();
    let pixels = counts(labels, motions.len());
    let moving = motions.iter().zip(pixels).filter(|(motion, _)| **motion != AffineMotion::STATIC);
    let parameters: f64 = moving.map(|(_, pixels)| motion_penalty(pixels)).sum();
    // Every pair of neighbours is counted by both of its labels.
    let borders = border_lengths(labels, motions.len(), width).iter().sum::<usize>() / 2;
    0.5 * left_over + parameters + border_penalty(borders, model)
}

/// Nats that each object saves, minus those of its parameters and its border; infinite for the dominant motion, element 0.
///
/// `raw[k]` are the estimation costs of motion k; half a cost is a nat.
pub(crate) fn worth(raw: &[Plane], labels: &[u8], width: usize, model: &Model) -> Vec<f64> {
    let counts = counts(labels, raw.len());
    let borders = border_lengths(labels, raw.len(), width);
    let sums = sums(raw, labels);
    (0..raw.len())
        .map(|k| {
            if k == BACKGROUND {
                return f64::INFINITY;
            }
            if (counts[k] as f64) < model.smallest_share * labels.len() as f64 {
                return TOO_SMALL + counts[k] as f64;
            }
            let lost = |m: usize| 0.5 * (sums[k][m] - sums[k][k]) - second_motion_penalty([counts[k], counts[m]]);
            let others = (0..raw.len()).filter(|&m| m != k);
            others.map(lost).fold(f64::INFINITY, f64::min) - border_penalty(borders[k], model)
        })
        .collect()
}

/// Summed cost of every motion (second index) on the pixels of every label (first).
pub(crate) fn sums(raw: &[Plane], labels: &[u8]) -> Vec<Vec<f64>> {
    let mut sums = vec![vec![0.0f64; raw.len()]; raw.len()];
    for (p, &label) in labels.iter().enumerate() {
        for (sum, plane) in sums[usize::from(label)].iter_mut().zip(raw) {
            *sum += f64::from(plane.values()[p]);
        }
    }
    sums
}

/// Length of the border between each two labels, indexed with the smaller label first.
pub(super) fn between(labels: &[u8], of: usize, width: usize) -> Vec<Vec<usize>> {
    let mut between = vec![vec![0; of]; of];
    across_borders(labels, width, |p, q| {
        let (a, b) = (labels[p], labels[q]);
        between[usize::from(a.min(b))][usize::from(a.max(b))] += 1;
    });
    between
}

/// Number of pixels of each label.
pub(crate) fn counts(labels: &[u8], of: usize) -> Vec<usize> {
    /// Labels counted together; for speed.
    const PART: usize = 32;
    let mut counts = vec![0; of];
    for part in labels.chunks(PART) {
        // Most parts have one label.
        if let Some(count) = counts.get_mut(usize::from(part[0])).filter(|_| part.iter().all(|&l| l == part[0])) {
            *count += part.len();
            continue;
        }
        for &label in part {
            if let Some(count) = counts.get_mut(usize::from(label)) {
                *count += 1;
            }
        }
    }
    counts
}

/// Number of neighbouring pairs of which exactly one has the label.
pub(crate) fn border_lengths(labels: &[u8], of: usize, width: usize) -> Vec<usize> {
    let mut lengths = vec![0; of];
    across_borders(labels, width, |p, q| {
        lengths[usize::from(labels[p])] += 1;
        lengths[usize::from(labels[q])] += 1;
    });
    lengths
}
