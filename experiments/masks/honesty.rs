//! Whether the pipeline knows what it does not know: how often labels of each confidence are right, and which pixels are marked as
//! unknown.

use veronese::{Result, SegmentOptions, UNLABELLED, segment_pair};

use crate::cases::Data;

/// Lower edges of the ranges of confidence.
pub(crate) const RANGES: [f64; 8] = [0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.995];

/// Pixels in a range of confidence.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Range {
    pub(crate) pixels: usize,
    pub(crate) right: usize,
    /// Sum of the confidences.
    pub(crate) confidence: f64,
}

/// Counts over the pixels of scenes whose truth is known entirely.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Honesty {
    pub(crate) ranges: [Range; RANGES.len()],
    /// Pixels hidden or outside in the second frame, and how many of them are marked as unknown.
    pub(crate) occluded: [usize; 2],
    /// The same of the others.
    pub(crate) visible: [usize; 2],
    /// Of the visible pixels that are marked: those whose label would have been wrong.
    pub(crate) saved: usize,
}

impl Honesty {
    /// The counts of one scene; none where it is not known what is hidden.
    pub(crate) fn of(data: &Data) -> Result<Option<Honesty>> {
        let (Some(truth), Some(occluded)) = (&data.truth, &data.occluded) else { return Ok(None) };
        let run = |options: &SegmentOptions| segment_pair(&data.first, &data.second, None, options, &mut |_| {});
        let sure = run(&SegmentOptions { confidence: true, ..SegmentOptions::default() })?;
        let marked = run(&SegmentOptions { mark_unknown: true, ..SegmentOptions::default() })?;
        let meaning = meanings(&sure.labels, truth);
        let mut counts = Honesty::default();
        let confidence = sure.confidence.unwrap_or_default();
        for (p, (&label, &true_label)) in sure.labels.iter().zip(truth).enumerate() {
            let right = meaning[usize::from(label)] == true_label;
            let probability = confidence.get(p).map_or(0.0, |&c| f64::from(c) / 255.0);
            let above = RANGES.iter().filter(|&&edge| probability >= edge).count();
            let range = &mut counts.ranges[above.max(1) - 1];
            range.pixels += 1;
            range.right += usize::from(right);
            range.confidence += probability;
            let mark = marked.labels[p] == UNLABELLED;
            let kind = if occluded[p] { &mut counts.occluded } else { &mut counts.visible };
            kind[0] += 1;
            kind[1] += usize::from(mark);
            counts.saved += usize::from(mark && !occluded[p] && !right);
        }
        Ok(Some(counts))
    }

    pub(crate) fn add(&mut self, other: &Honesty) {
        for (own, other) in self.ranges.iter_mut().zip(&other.ranges) {
            own.pixels += other.pixels;
            own.right += other.right;
            own.confidence += other.confidence;
        }
        for k in 0..2 {
            self.occluded[k] += other.occluded[k];
            self.visible[k] += other.visible[k];
        }
        self.saved += other.saved;
    }
}

/// The true label that most pixels of each found label have.
fn meanings(found: &[u8], truth: &[u8]) -> [u8; 256] {
    let mut votes = vec![[0usize; 256]; 256];
    for (&f, &t) in found.iter().zip(truth) {
        votes[usize::from(f)][usize::from(t)] += 1;
    }
    std::array::from_fn(|f| (0..=255u8).rev().max_by_key(|&t| votes[f][usize::from(t)]).unwrap_or(0))
}
