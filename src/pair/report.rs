//! The result: labels at full size, statistics of every motion, and scores of their number. Only here are motions numbered by pixel count.

use serde::Serialize;

mod candidates;
mod doubt;
mod junctions;
mod statistics;
mod unknown;

pub use junctions::Junction;
pub use statistics::SegmentedMotion;
use statistics::describe;

use super::figure;
use super::groups::Regions;
use super::labels::LabelledPair;
use super::settings::Settings;
use crate::answer::{Candidate, UNLABELLED};
use crate::frame::scaling::Scaling;
use crate::frame::{Frame, Plane};
use crate::labelling::confidence::probabilities;
use crate::labelling::regions::description::counts;
use crate::labelling::upsampling::{enlarged, upsample};
use crate::motion::AffineMotion;
use crate::options::SegmentOptions;
use crate::order::descending;
use crate::view::cost::{RobustKernel, costs};

/// The result of [`segment_pair`](crate::segment_pair).
#[non_exhaustive]
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
    /// One label per pixel of the first frame, row by row: an index of `motions`, or [`UNLABELLED`] where the frames do not determine it
    /// (only on request).
    #[serde(skip)]
    pub labels: Vec<u8>,
    /// The borders of neighbouring motions that may belong to one thing, by labels.
    pub junctions: Vec<Junction>,
    /// Scores of different numbers of motions.
    pub evidence: PairEvidence,
    /// Number of unlabelled pixels.
    pub unlabelled: usize,
    /// Confidence of every label, row by row, on request: 255 times the probability that the label is right; 0 for unlabelled pixels. It
    /// follows from how well all motions explain the pixel and its surroundings, and from the labels around it. For an object it is the
    /// probability that the pixel belongs to an object, and not to background at another depth: it is lower where the object is cut by the
    /// border of the frame, and in frames that no motions explain well. It is calibrated on real pairs and generated scenes: of the pixels
    /// with probability P, about the share P is right.
    #[serde(skip)]
    pub confidence: Option<Vec<u8>>,
}

/// Scores of different numbers of motions of a pair.
#[non_exhaustive]
#[derive(Clone, Debug, Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct PairEvidence {
    /// Description lengths of both frames in nats, from one motion to one more than were found; smaller is better. For fewer motions, the
    /// least useful ones are removed one by one; for one more, the best rejected motion is added. Labels are solved for each number with
    /// the same costs, on a level whose longer side is at most 224 pixels unless the frame is narrow. The pipeline decides by more than
    /// this list, so the number found need not have the smallest score.
    pub candidates: Vec<Candidate>,
}

/// The result of a pair.
pub(super) fn report(
    labelled: LabelledPair,
    settings: &Settings,
    [first, second]: [&Frame; 2],
    options: &SegmentOptions,
) -> Segmentation {
    let pair = &labelled.pair;
    let level = pair.finest();
    let (size, model) = ([level.width(), level.height()], level.model);
    let candidates = candidates::scored_candidates(&labelled, settings);
    let regions = Regions::new(&labelled.motions, &labelled.labels, size[0], model);
    let costs = if options.mark_unknown || options.confidence {
        costs(level, &labelled.motions, RobustKernel::labels(model))
    } else {
        Vec::new()
    };
    let mut sure = probabilities(&costs, &labelled.labels, model);
    let unknown = options.mark_unknown.then(|| unknown::unknown(&labelled, &sure));
    let full = upsample(&labelled.labels, &pair.scaling, labelled.motions.len(), first.luminance(), model);
    let order = by_size(&full, labelled.motions.len());
    let junctions = junctions::junctions(regions.clone(), pair.scaling.step, &order);
    let group_of = figure::groups(regions, &labelled.motions, &labelled.labels, level, settings.subject);
    let groups: Vec<usize> = order.iter().map(|&k| group_of[k]).collect();
    let mut confidence = options.confidence.then(|| {
        doubt::doubt_objects(&mut sure, &costs, &labelled.labels, &group_of, model);
        confidence(&sure, &full, &pair.scaling)
    });
    drop(costs);
    let mut rank = [0u8; 256];
    order.iter().enumerate().for_each(|(k, &old)| rank[old] = k as u8);
    let mut labels = full;
    labels.iter_mut().for_each(|l| *l = rank[usize::from(*l)]);
    if let Some(unknown) = unknown {
        labels
            .iter_mut()
            .zip(pair.scaling.enlarged(&unknown))
            .filter(|(_, unknown)| *unknown)
            .for_each(|(l, _)| *l = UNLABELLED);
    }
    for (sure, _) in confidence.iter_mut().flatten().zip(&labels).filter(|(_, label)| **label == UNLABELLED) {
        *sure = 0;
    }
    let matrices: Vec<AffineMotion> =
        order.iter().map(|&k| labelled.motions[k].scaled(pair.scaling.step as f64)).collect();
    let motions = describe(&matrices, &groups, &labels, first.luminance(), second.luminance());
    Segmentation {
        width: first.width(),
        height: first.height(),
        count: motions.len(),
        unlabelled: labels.iter().filter(|&&l| l == UNLABELLED).count(),
        motions,
        labels,
        junctions,
        evidence: PairEvidence { candidates },
        confidence,
    }
}

/// The probability of each pixel's label at full size, in steps of 1/255.
fn confidence(probabilities: &[Plane], labels: &[u8], scaling: &Scaling) -> Vec<u8> {
    let mut confidence = vec![0; labels.len()];
    for (k, of_motion) in probabilities.iter().enumerate() {
        let full = enlarged(of_motion, scaling);
        for ((c, p), _) in
            confidence.iter_mut().zip(full.values()).zip(labels).filter(|(_, label)| usize::from(**label) == k)
        {
            *c = (255.0 * p + 0.5) as u8;
        }
    }
    confidence
}

/// Labels by decreasing number of pixels, without those that have none.
fn by_size(labels: &[u8], of: usize) -> Vec<usize> {
    let sizes = counts(labels, of);
    let mut order = descending(sizes.iter().map(|&s| s as f64));
    order.retain(|&k| sizes[k] > 0);
    order
}
