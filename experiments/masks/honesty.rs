//! Whether the pipeline knows what it does not know: how often labels of each confidence are right, and which pixels are marked as
//! unknown.
use experiments::Failure;
use experiments::masks::cases::{Case, Data, Set, a_third};
use experiments::masks::scores::VOID;
use experiments::parallel::in_parallel;
use serde_json::{Value, json};
use veronese::{Result, SegmentOptions, Segmentation, UNLABELLED, segment_pair};

/// Lower edges of the ranges of confidence.
const RANGES: [f64; 8] = [0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.995];

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
        }
        Ok(Some(counts))
    }

    fn add(&mut self, other: &OfScenes) {
        self.ranges.add(&other.ranges);
        for k in 0..2 {
            self.occluded[k] += other.occluded[k];
            self.visible[k] += other.visible[k];
        }
    }
}

/// Counts over the pixels of real pairs, in which one object has a mask: of those that are said to be an object, which are right in the mask,
/// then of those said to be background, which are right outside it.
#[derive(Clone, Copy, Debug, Default)]
struct OfPairs([Ranges; 2]);

impl OfPairs {
    fn of(data: &Data) -> Result<OfPairs> {
        let options = SegmentOptions::default().with_confidence(true);
        let found = segment_pair(&data.first, &data.second, &options, &mut |_| {})?;
        let truth = data.truth.as_deref().unwrap_or_default();
        let is_object = objects(&found);
        let mut counts = OfPairs::default();
        for ((&label, &confidence), &truth) in found.labels.iter().zip(found.confidence.iter().flatten()).zip(truth) {
            if truth != VOID {
                let said = is_object[usize::from(label)];
                counts.0[usize::from(!said)].count(confidence, said == (truth != 0));
            }
        }
        Ok(counts)
    }

    fn add(&mut self, other: &OfPairs) {
        self.0.iter_mut().zip(&other.0).for_each(|(own, other)| own.add(other));
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

/// The counts of a case: of a scene, or of a real pair.
pub(crate) struct Counted {
    scene: Option<OfScenes>,
    pair: Option<OfPairs>,
}

/// Counts the generated scenes and two real pairs of each sequence among the cases.
pub(crate) fn measure(cases: &[Case]) -> std::result::Result<Vec<Counted>, Failure> {
    let mut chosen = a_third(cases.iter().filter(|case| case.set == Set::Sequences).cloned());
    chosen.extend(cases.iter().filter(|case| case.set.is_scene()).cloned());
    in_parallel(&chosen, |case| {
        let data = case.load().map_err(|error| error.to_string())?;
        let pair = if case.set == Set::Sequences { Some(OfPairs::of(&data)?) } else { None };
        eprintln!("{}", case.name);
        Ok(Counted { scene: OfScenes::of(&data)?, pair })
    })
}

/// The counts as values for programs.
pub(crate) fn json(counted: &[Counted]) -> Value {
    let (mut scenes, mut pairs) = (OfScenes::default(), OfPairs::default());
    counted.iter().filter_map(|one| one.scene.as_ref()).for_each(|counts| scenes.add(counts));
    counted.iter().filter_map(|one| one.pair.as_ref()).for_each(|counts| pairs.add(counts));
    json!({
        "scenes": scenes.ranges.json(), "object": pairs.0[0].json(), "background": pairs.0[1].json(),
        "unknown": {
            "occluded": scenes.occluded[0], "occludedMarked": scenes.occluded[1],
            "visible": scenes.visible[0], "visibleMarked": scenes.visible[1],
        },
    })
}
