//! Anchors: the annotated frames from which an object is propagated.

use std::sync::Arc;

use super::features::FrameFeatures;
use super::plan::Anchor;
use super::strokes;
use crate::answer::UNLABELLED;
use crate::clip::annotation::{ObjectSet, Seed, Spread};
use crate::clip::frame_annotation::FrameAnnotation;
use crate::clip::segmented_clip::SegmentedClip;

/// How an annotation covers the pixels of an object found automatically: numbers of pixels.
#[derive(Clone, Copy, Default)]
struct Covered {
    all: usize,
    /// Pixels erased by a label map without object numbers.
    ground: usize,
    /// Pixels annotated as another object.
    others: usize,
}

impl SegmentedClip {
    /// For each object number, the object's anchors in a scene: the frames that annotate it and, if there are any, the frames accepted with
    /// it.
    #[inline(never)]
    pub(super) fn anchors(&self, [first, last]: [usize; 2]) -> Vec<Vec<Anchor>> {
        let of = |object: u8| {
            let frames = &self.frames[first..=last];
            if !frames.iter().any(|frame| frame.anchors(object)) {
                return Vec::new();
            }
            let spread = |t: usize| match &self.frames[t].annotation {
                Some(annotation) if annotation.anchored.contains(&object) => Some(annotation.spread_of(object)),
                _ => self.frames[t].accepts(object).then_some(Spread::Both),
            };
            let is_whole = |t: usize| {
                self.frames[t].accepts(object)
                    || self.frames[t].annotation.as_ref().is_some_and(|of| of.is_whole(object))
                    || self.paints_over(t, object)
            };
            let anchor = |frame| Some(Anchor { frame, spread: spread(frame)?, is_whole: is_whole(frame) });
            (first..=last).filter_map(anchor).collect()
        };
        (0..UNLABELLED).map(of).collect()
    }

    /// Decides of which objects each frame of a scene is an anchor: those that it annotates by number, and those found automatically that
    /// it erases in part. An erased object that another one takes over in some frame is left out unless it is annotated by number.
    #[inline(never)]
    pub(super) fn update_anchors(&mut self, [first, last]: [usize; 2]) {
        let names = |clip: &SegmentedClip, t: usize, object: u8| {
            clip.frames[t].annotation.as_ref().is_some_and(|annotation| annotation.names(object))
        };
        let mut is_taken = [false; 256];
        let mut erased: Vec<ObjectSet> = Vec::new();
        for t in first..=last {
            let mut erases = [false; 256];
            if let Some(annotation) = &self.frames[t].annotation {
                let covered = self.covered(t, annotation);
                for (label, Covered { all, ground, others }) in covered.into_iter().enumerate().skip(1) {
                    is_taken[label] |= 2 * others > all;
                    // A lock that was set later takes nothing back.
                    let is_free = !self.objects.locked[label] || annotation.anchored.contains(&(label as u8));
                    erases[label] = ground > 0 && ground + others < all && is_free;
                }
            }
            erased.push(erases);
        }
        let is_named: ObjectSet = std::array::from_fn(|k| (first..=last).any(|t| names(self, t, k as u8)));
        for (erases, t) in erased.iter().zip(first..=last) {
            let is_anchor = |&object: &u8| {
                let k = usize::from(object);
                self.objects.numbers[k] > 0 && (names(self, t, object) || erases[k] && (!is_taken[k] || is_named[k]))
            };
            let anchored: Vec<u8> = (1..UNLABELLED).filter(is_anchor).collect();
            if let Some(annotation) = &mut self.frames[t].annotation
                && annotation.anchored != anchored
            {
                Arc::make_mut(annotation).anchored = anchored;
            }
        }
    }

    /// The seeds of an object in a frame, at the size of the features, and the frames to which they spread.
    #[inline(never)]
    pub(super) fn seeds_at(&self, t: usize, object: u8, features: &FrameFeatures) -> Option<(Vec<Seed>, Spread)> {
        let frame = &self.frames[t];
        let annotated = frame.annotation.as_ref().and_then(|of| Some((of.seeds(object)?, of.spread_of(object))));
        let accepted = || {
            let labels = frame.layer.as_ref().filter(|_| frame.accepted)?.labels.values();
            let seed = |label: u8| if label == object { Seed::Object } else { Seed::Other };
            Some((labels.into_iter().map(seed).collect(), Spread::Both))
        };
        let (seeds, spread) = annotated.or_else(accepted)?;
        let mut seeds = features.scaling.gathered(&seeds, Seed::Nothing);
        if self.paints_over(t, object) {
            strokes::fill(&mut seeds, &self.found_at(t, features.size), object);
        }
        Some((seeds, spread))
    }

    /// Whether strokes cover a whole object as it was found in a frame. The painted pixels are then its mask, although the ground around it
    /// was not annotated. This depends only on what was found, so the order of annotations does not matter.
    #[inline(never)]
    pub(super) fn paints_over(&self, t: usize, object: u8) -> bool {
        let Some(seeds) = self.frames[t].annotation.as_ref().and_then(|of| of.painted_seeds(object)) else {
            return false;
        };
        let scaling = self.scaling(t);
        strokes::paints_over(&self.found_at(t, scaling.small), object, &scaling.gathered(&seeds, Seed::Nothing))
    }

    /// The mask of an object that the frame showed right after strokes were drawn: 1 inside, at the size of the features.
    #[inline(never)]
    pub(super) fn seen_at(&self, t: usize, object: u8, features: &FrameFeatures) -> Option<Vec<u8>> {
        let seen = self.frames[t].annotation.as_ref()?.seen(object)?;
        Some(features.scaling.gathered(&seen, UNLABELLED))
    }

    /// For each object found automatically, by number, how an annotation covers it.
    #[inline(never)]
    fn covered(&self, t: usize, annotation: &FrameAnnotation) -> [Covered; 256] {
        let (found, _) = self.found(t);
        let painted = annotation.painted_labels().map(|labels| self.scaling(t).gathered(&labels, UNLABELLED));
        let painted = painted.unwrap_or_else(|| vec![UNLABELLED; found.len()]);
        let erases = annotation.names_no_object();
        let mut covered = [Covered::default(); 256];
        for (&found, &painted) in found.iter().zip(&painted) {
            let of = &mut covered[usize::from(found)];
            of.all += 1;
            of.ground += usize::from(painted == 0 && erases);
            of.others += usize::from(painted != 0 && painted != UNLABELLED && painted != found);
        }
        for (object, outline) in annotation.outlines() {
            for (p, _) in self
                .scaling(t)
                .gathered(&outline, UNLABELLED)
                .into_iter()
                .enumerate()
                .filter(|(_, label)| *label == object)
            {
                covered[usize::from(found[p])].others += usize::from(found[p] != object && painted[p] == UNLABELLED);
            }
        }
        covered
    }
}
