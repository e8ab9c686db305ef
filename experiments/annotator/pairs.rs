//! Strokes on pairs of frames: a robot corrects the object in the first frame.
use std::time::Instant;

use experiments::Failure;
use experiments::annotator::overlap::{iou, mean};
use experiments::annotator::robot::stroke;
use experiments::clips::cases::Case;
use serde::Serialize;
use veronese::{AffineMotion, Correction, Frame, SegmentOptions, Segmentation, relabel, segment_pair};

use crate::Options;
use crate::measure::is_old;

/// First frames of the pairs of a clip.
const FIRST: [usize; 4] = [0, 8, 16, 24];

/// The figures of a clip.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Row {
    clip: String,
    /// Whether constants of clips were first set on it.
    old: bool,
    /// Of each pair: J of the motions that are the object's, as found and after each round of strokes.
    pairs: Vec<Vec<f64>>,
    /// Time of a correction.
    milliseconds: f64,
}

/// All figures of a clip.
pub(crate) fn measure(case: &Case, options: &Options) -> Result<Row, Failure> {
    let data = case.load()?;
    let asked = SegmentOptions::default().with_quality(options.quality);
    let (mut pairs, mut times) = (Vec::new(), Vec::new());
    for t in FIRST.into_iter().filter(|t| t + 1 < data.frames.len()) {
        let frames = [&data.frames[t], &data.frames[t + 1]];
        let truth: Vec<bool> = data.truths[t].iter().map(|&label| label > 0).collect();
        let found = segment_pair(frames[0], frames[1], &asked, &mut |_| {})?;
        let Some(object) = motions_of(&truth, &found) else { continue };
        let corrector = Corrector { frames, found: &found, options: &asked, object };
        let mut now = corrector.mask(&found.labels);
        let mut allowed = vec![0u16; truth.len()];
        let mut figures = vec![iou(&now, &truth)];
        for _ in 0..options.rounds {
            for (inside, set) in [(true, object), (false, corrector.others())] {
                let wrong: Vec<bool> = (0..truth.len()).map(|p| truth[p] == inside && now[p] != inside).collect();
                stroke(&wrong, found.width).into_iter().for_each(|p| allowed[p] = set);
            }
            let start = Instant::now();
            now = corrector.corrected(&allowed)?;
            times.push(1e3 * start.elapsed().as_secs_f64());
            figures.push(iou(&now, &truth));
        }
        pairs.push(figures);
    }
    Ok(Row { clip: case.name.clone(), old: is_old(&case.name), pairs, milliseconds: mean(&times) })
}

/// The motions that a person would call the object: those with more than half of their pixels inside or, if there are none, the one with
/// the largest share. None of a pair without two sides.
fn motions_of(truth: &[bool], found: &Segmentation) -> Option<u16> {
    let share = |motion: usize| {
        let own = truth.iter().zip(&found.labels).filter(|(_, label)| usize::from(**label) == motion);
        let [all, inside] = own.fold([0usize; 2], |[all, hits], (inside, _)| [all + 1, hits + usize::from(*inside)]);
        inside as f64 / all.max(1) as f64
    };
    let count = found.motions.len();
    let most = (1..count).max_by(|&a, &b| share(a).total_cmp(&share(b)))?;
    let all = (0..count).filter(|&k| share(k) > 0.5).fold(0u16, |set, k| set | 1 << k);
    let object = if all == 0 { 1 << most } else { all };
    (object.count_ones() < count as u32).then_some(object)
}

struct Corrector<'a> {
    frames: [&'a Frame; 2],
    found: &'a Segmentation,
    options: &'a SegmentOptions,
    /// The object's motions, a bit for each.
    object: u16,
}

impl Corrector<'_> {
    fn others(&self) -> u16 {
        (0..self.found.motions.len()).fold(0, |set, k| set | 1 << k) & !self.object
    }

    fn mask(&self, labels: &[u8]) -> Vec<bool> {
        labels.iter().map(|&label| label < 16 && self.object >> label & 1 == 1).collect()
    }

    /// The object's mask under strokes.
    fn corrected(&self, allowed: &[u16]) -> veronese::Result<Vec<bool>> {
        let motions: Vec<AffineMotion> = self.found.motions.iter().map(|motion| motion.matrix).collect();
        let groups: Vec<u8> = self.found.motions.iter().map(|motion| motion.group).collect();
        let correction = Correction { motions: &motions, groups: &groups, labels: &self.found.labels, allowed };
        let [first, second] = self.frames;
        Ok(self.mask(&relabel(first, second, &correction, self.options, &mut |_| {})?.labels))
    }
}
