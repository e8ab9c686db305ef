//! Whether the pipeline knows what it does not know: how often labels of each confidence are right, and which pixels are marked as
//! unknown.

use serde_json::{Value, json};
use veronese::{Quality, Result, SegmentOptions, Segmentation, UNLABELLED, segment_pair};

use crate::Failure;
use crate::cases::{Case, Data, Set, a_third};
use crate::parallel::in_parallel;
use crate::scores::VOID;

/// Lower edges of the ranges of confidence.
const RANGES: [f64; 8] = [0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.995];
const QUALITIES: [Quality; 2] = [Quality::Best, Quality::Fast];

/// Pixels in a range of confidence.
#[derive(Clone, Copy, Debug, Default)]
struct Range {
    pixels: usize,
    right: usize,
    /// Sum of the confidences.
    confidence: f64,
}

/// Pixels by the range of their confidence.
#[derive(Clone, Copy, Debug, Default)]
struct Ranges([Range; RANGES.len()]);

impl Ranges {
    fn count(&mut self, confidence: u8, right: bool) {
        let probability = f64::from(confidence) / 255.0;
        let above = RANGES.iter().filter(|&&edge| probability >= edge).count();
        let range = &mut self.0[above.max(1) - 1];
        range.pixels += 1;
        range.right += usize::from(right);
        range.confidence += probability;
    }

    fn add(&mut self, other: &Ranges) {
        for (own, other) in self.0.iter_mut().zip(&other.0) {
            own.pixels += other.pixels;
            own.right += other.right;
            own.confidence += other.confidence;
        }
    }

    fn json(&self) -> Value {
        let of = |(r, from): (&Range, f64)| json!({ "from": from, "pixels": r.pixels, "right": r.right, "confidence": r.confidence });
        self.0.iter().zip(RANGES).map(of).collect()
    }
}

/// Counts over the pixels of scenes whose truth is known entirely.
#[derive(Clone, Copy, Debug, Default)]
struct OfScenes {
    ranges: Ranges,
    /// Pixels hidden or outside in the second frame, and how many of them are marked as unknown.
    occluded: [usize; 2],
    /// The same of the others.
    visible: [usize; 2],
    /// Of the visible pixels that are marked: those whose label would have been wrong.
    saved: usize,
}

impl OfScenes {
    /// The counts of one scene; none where it is not known what is hidden.
    fn of(data: &Data) -> Result<Option<OfScenes>> {
        let (Some(truth), Some(occluded)) = (&data.truth, &data.occluded) else { return Ok(None) };
        let run = |options: &SegmentOptions| segment_pair(&data.first, &data.second, options, &mut |_| {});
        let sure = run(&SegmentOptions::default().with_confidence(true))?;
        let marked = run(&SegmentOptions::default().with_mark_unknown(true))?;
        let meaning = meanings(&sure.labels, truth);
        let mut counts = OfScenes::default();
        for (p, (&label, &confidence)) in sure.labels.iter().zip(sure.confidence.iter().flatten()).enumerate() {
            let right = meaning[usize::from(label)] == truth[p];
            counts.ranges.count(confidence, right);
            let mark = marked.labels[p] == UNLABELLED;
            let kind = if occluded[p] { &mut counts.occluded } else { &mut counts.visible };
            kind[0] += 1;
            kind[1] += usize::from(mark);
            counts.saved += usize::from(mark && !occluded[p] && !right);
        }
        Ok(Some(counts))
    }

    fn add(&mut self, other: &OfScenes) {
        self.ranges.add(&other.ranges);
        for k in 0..2 {
            self.occluded[k] += other.occluded[k];
            self.visible[k] += other.visible[k];
        }
        self.saved += other.saved;
    }
}

/// Counts over the pixels of real pairs, in which one object has a mask: of those that are said to be an object, then of those said to be
/// background.
#[derive(Clone, Copy, Debug, Default)]
struct OfPairs {
    /// The group says it. An object is right in the mask, background outside it.
    grouped: [Ranges; 2],
    /// The truth says it of every label, as a user would join them.
    by_hand: [Ranges; 2],
}

impl OfPairs {
    fn of(data: &Data, quality: Quality) -> Result<OfPairs> {
        let options = SegmentOptions::default().with_quality(quality).with_confidence(true);
        let found = segment_pair(&data.first, &data.second, &options, &mut |_| {})?;
        let truth = data.truth.as_deref().unwrap_or_default();
        let meaning = meanings(&found.labels, truth);
        let is_object = objects(&found);
        let mut counts = OfPairs::default();
        for ((&label, &confidence), &truth) in found.labels.iter().zip(found.confidence.iter().flatten()).zip(truth) {
            if truth == VOID {
                continue;
            }
            let [label, inside] = [usize::from(label), usize::from(truth != 0)];
            let (grouped, by_hand) = (usize::from(is_object[label]), usize::from(meaning[label] != 0));
            counts.grouped[1 - grouped].count(confidence, grouped == inside);
            counts.by_hand[1 - by_hand].count(confidence, by_hand == inside);
        }
        Ok(counts)
    }

    fn add(&mut self, other: &OfPairs) {
        for k in 0..2 {
            self.grouped[k].add(&other.grouped[k]);
            self.by_hand[k].add(&other.by_hand[k]);
        }
    }
}

/// Which labels are those of objects: all but those in the largest group.
fn objects(found: &Segmentation) -> [bool; 256] {
    std::array::from_fn(|label| found.motions.get(label).is_some_and(|motion| motion.group != 0))
}

/// The true label that most pixels of each found label have.
fn meanings(found: &[u8], truth: &[u8]) -> [u8; 256] {
    let mut votes = vec![[0usize; 256]; 256];
    for (&f, &t) in found.iter().zip(truth) {
        votes[usize::from(f)][usize::from(t)] += 1;
    }
    std::array::from_fn(|f| (0..=255u8).rev().max_by_key(|&t| votes[f][usize::from(t)]).unwrap_or(0))
}

/// The counts of a case.
pub(crate) struct Counted {
    case: Case,
    scene: Option<OfScenes>,
    /// Of a real pair, with each quality.
    pair: Option<[OfPairs; QUALITIES.len()]>,
}

/// Counts the generated scenes and two real pairs of each sequence among the cases.
pub(crate) fn measure(cases: &[Case]) -> std::result::Result<Vec<Counted>, Failure> {
    let mut chosen = a_third(cases.iter().filter(|case| case.set == Set::Sequences).cloned());
    chosen.extend(cases.iter().filter(|case| case.set.is_scene()).cloned());
    in_parallel(&chosen, |case| {
        let data = case.load().map_err(|error| error.to_string())?;
        let real = case.set == Set::Sequences;
        let with = |k: usize| OfPairs::of(&data, QUALITIES[k]);
        let pair = if real { Some([with(0)?, with(1)?]) } else { None };
        eprintln!("{}", case.name);
        Ok(Counted { case: case.clone(), scene: OfScenes::of(&data)?, pair })
    })
}

fn sum_of_scenes(counted: &[Counted]) -> OfScenes {
    let mut sum = OfScenes::default();
    counted.iter().filter_map(|one| one.scene.as_ref()).for_each(|counts| sum.add(counts));
    sum
}

/// The sums of the real pairs: of all, then of both folds of every second sequence.
fn sums_of_pairs(counted: &[Counted]) -> [[OfPairs; QUALITIES.len()]; 3] {
    let pairs: Vec<_> = counted.iter().filter_map(|one| Some((one.case.sequence(), one.pair?))).collect();
    let mut sequences: Vec<&str> = pairs.iter().map(|(sequence, _)| *sequence).collect();
    sequences.dedup();
    let mut sums = [[OfPairs::default(); QUALITIES.len()]; 3];
    for (sequence, counts) in &pairs {
        let place = sequences.iter().position(|name| name == sequence).unwrap_or_default();
        for sum in [0, 1 + place % 2] {
            sums[sum].iter_mut().zip(counts).for_each(|(sum, counts)| sum.add(counts));
        }
    }
    sums
}

/// The counts as values for programs.
pub(crate) fn json(counted: &[Counted]) -> Value {
    let scenes = sum_of_scenes(counted);
    let both = |[object, background]: &[Ranges; 2]| json!({ "object": object.json(), "background": background.json() });
    let of_pairs = |counts: &OfPairs| json!({ "grouped": both(&counts.grouped), "byHand": both(&counts.by_hand) });
    let named = |name: &str, [best, fast]: &[OfPairs; 2]| json!({ "pairs": name, "best": of_pairs(best), "fast": of_pairs(fast) });
    let pairs: Vec<Value> = FOLDS.iter().zip(&sums_of_pairs(counted)).map(|(name, sums)| named(name, sums)).collect();
    json!({
        "scenes": scenes.ranges.json(), "pairs": pairs,
        "unknown": {
            "occluded": scenes.occluded[0], "occludedMarked": scenes.occluded[1],
            "visible": scenes.visible[0], "visibleMarked": scenes.visible[1], "wrongAndMarked": scenes.saved,
        },
    })
}

const FOLDS: [&str; 3] = ["all", "first fold", "second fold"];
