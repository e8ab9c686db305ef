//! Annotations that are given together, over those that were given before.

use super::phase::{Phase, invalid, some_labels};
use crate::answer::UNLABELLED;
use crate::clip::annotation::{Painted, Prompt, Spread, check_labels, is_object};
use crate::clip::command::{Annotation, Content};
use crate::clip::segmented_clip::SegmentedClip;
use crate::error::{Error, Result};

/// Annotations that are given together.
pub(super) struct Combined<'a> {
    clip: &'a SegmentedClip,
    pub(super) masks: Vec<Painted>,
    /// Label maps and strokes over those before, one for each frame and object, in the order of their last change.
    pub(super) painted: Vec<Painted>,
    pub(super) prompts: Vec<Prompt>,
    /// What is drawn exactly, after all others.
    pub(super) draws: Vec<Phase>,
    /// Frames, objects and labels as they were given: exact drawing under them goes.
    pub(super) covers: Vec<(usize, Option<u8>, Vec<u8>)>,
}

impl<'a> Combined<'a> {
    /// Combines annotations, under the current numbers of their objects.
    ///
    /// # Errors
    /// [`Error::InvalidOption`]; [`Error::ObjectLocked`] for exact drawing and given masks, which no job checks.
    pub(super) fn new(clip: &'a SegmentedClip, all: Vec<Annotation>) -> Result<Combined<'a>> {
        let [masks, painted] = [Vec::new(), Vec::new()];
        let (prompts, draws, covers) = (Vec::new(), Vec::new(), Vec::new());
        let mut combined = Combined { clip, masks, painted, prompts, draws, covers };
        all.into_iter().try_for_each(|annotation| combined.add(annotation))?;
        Ok(combined)
    }

    fn add(&mut self, Annotation { frame, content, spread }: Annotation) -> Result<()> {
        let is_exact = spread == Spread::Exact;
        if let Content::Strokes { labels, .. }
        | Content::Mask { labels, .. }
        | Content::Labels(labels)
        | Content::Given(labels) = &content
        {
            check_labels("labels", labels, self.clip.size)?;
        }
        match content {
            Content::Strokes { object, labels } | Content::Mask { object, labels }
                if labels.iter().any(|l| ![0, 1, UNLABELLED].contains(l)) =>
            {
                return invalid("labels", format!("those of object {object} alone are 1, 0 and 255"));
            }
            Content::Given(_) | Content::Prompt { .. } if is_exact => {
                return invalid("spread", "clicks, boxes and given masks cannot be drawn exactly: draw a mask".into());
            }
            Content::Strokes { object, labels } | Content::Mask { object, labels } if is_exact => {
                let (object, labels) = self.own_labels(object, &labels)?;
                self.draw(frame, Some(object), labels)?;
            }
            Content::Labels(labels) if is_exact => self.draw(frame, None, self.current_labels(&labels)?)?,
            Content::Strokes { object, labels } => {
                let (object, labels) = self.own_labels(object, &labels)?;
                self.cover(frame, Some(object), labels.clone());
                self.exclude_merged(frame, object, &labels, spread);
                let all = over(self.earlier(frame, Some(object)), labels);
                self.paint(frame, Some(object), all, spread);
            }
            Content::Mask { object, labels } => {
                let (object, labels) = self.own_labels(object, &labels)?;
                self.cover(frame, Some(object), labels.clone());
                self.exclude_merged(frame, object, &labels, spread);
                self.paint(frame, Some(object), labels, spread);
            }
            Content::Labels(labels) => self.add_map(frame, self.current_labels(&labels)?, spread),
            Content::Given(labels) => {
                if let Some(object) = labels.iter().copied().find(|&label| self.is_locked(label)) {
                    return Err(Error::ObjectLocked { object });
                }
                self.current_labels(&labels)?;
                self.cover(frame, None, labels.clone());
                self.masks.retain(|of| of.frame != frame);
                self.masks.push(Painted { frame, object: None, labels, spread });
            }
            Content::Prompt { object, clicks, within } => {
                let object = self.clip.objects.current(object)?;
                self.prompts.retain(|of| (of.frame, of.object) != (frame, object));
                self.prompts.push(Prompt { frame, object, clicks, within, spread });
            }
        }
        Ok(())
    }

    /// A label map that names objects covers the strokes of those that are not locked. One that names none erases their strokes, too, and over
    /// a map that names objects, everything that is shown there.
    fn add_map(&mut self, frame: usize, labels: Vec<u8>, spread: Spread) {
        self.cover(frame, None, labels.clone());
        let names_objects = |labels: &[u8]| labels.iter().any(|&label| is_object(label));
        let before = self.earlier(frame, None);
        let is_eraser = !names_objects(&labels);
        for object in 1..UNLABELLED {
            let Some(strokes) = self.earlier(frame, Some(object)).filter(|_| !self.is_locked(object)) else { continue };
            let now: Vec<u8> = strokes
                .iter()
                .zip(&labels)
                .map(|(&stroke, &label)| match label {
                    UNLABELLED => stroke,
                    _ if is_eraser => 0,
                    _ => UNLABELLED,
                })
                .collect();
            if now != strokes {
                let spread = self.spread_of(frame, object);
                self.paint(frame, Some(object), now, spread);
            }
        }
        if is_eraser && before.as_ref().is_some_and(|before| names_objects(before)) {
            let zeros: Vec<u8> = labels.iter().map(|&label| if label == 0 { 0 } else { UNLABELLED }).collect();
            for object in self.under(frame, &labels) {
                let all = over(self.earlier(frame, Some(object)), zeros.clone());
                self.paint(frame, Some(object), all, spread);
            }
        } else {
            self.paint(frame, None, over(before, labels), spread);
        }
    }

    /// The objects at the zeros of labels that are not locked.
    fn under(&self, frame: usize, labels: &[u8]) -> Vec<u8> {
        let found = self.clip.found_at(frame, self.clip.size);
        let layer = self.clip.layer_labels(frame);
        let mut is_under = [false; 256];
        for p in (0..labels.len()).filter(|&p| labels[p] == 0) {
            let above = layer.as_ref().map_or(UNLABELLED, |layer| layer[p]);
            is_under[usize::from(if above == UNLABELLED { found[p] } else { above })] = true;
        }
        (1..UNLABELLED).filter(|&object| is_under[usize::from(object)] && !self.is_locked(object)).collect()
    }

    /// Where an object is not, neither is what was merged into it.
    fn exclude_merged(&mut self, frame: usize, object: u8, labels: &[u8], spread: Spread) {
        if !labels.contains(&0) {
            return;
        }
        let is_merged = |&k: &u8| k != object && self.clip.objects.number(k) == object;
        let merged: Vec<u8> = (1..UNLABELLED).filter(is_merged).collect();
        for other in merged {
            let zeros = labels.iter().map(|&label| if label == 0 { 0 } else { UNLABELLED }).collect();
            let all = over(self.earlier(frame, Some(other)), zeros);
            self.paint(frame, Some(other), all, spread);
        }
    }

    /// The label map, or the strokes of an object, that a frame has so far.
    fn earlier(&self, frame: usize, object: Option<u8>) -> Option<Vec<u8>> {
        let own = self.painted.iter().find(|of| (of.frame, of.object) == (frame, object)).map(|of| of.labels.clone());
        own.or_else(|| self.clip.frames[frame].annotation.as_ref()?.painted_of(object.unwrap_or(0)))
    }

    /// The frames to which earlier strokes of an object spread.
    fn spread_of(&self, frame: usize, object: u8) -> Spread {
        let own = self.painted.iter().find(|of| (of.frame, of.object) == (frame, Some(object))).map(|of| of.spread);
        own.or_else(|| Some(self.clip.frames[frame].annotation.as_ref()?.spread_of(object))).unwrap_or_default()
    }

    fn paint(&mut self, frame: usize, object: Option<u8>, labels: Vec<u8>, spread: Spread) {
        self.painted.retain(|of| (of.frame, of.object) != (frame, object));
        self.painted.push(Painted { frame, object, labels, spread });
    }

    fn cover(&mut self, frame: usize, object: Option<u8>, labels: Vec<u8>) {
        self.covers.push((frame, object, labels));
    }

    fn draw(&mut self, frame: usize, object: Option<u8>, labels: Vec<u8>) -> Result<()> {
        let named = object.into_iter().chain(labels.iter().copied().filter(|&label| is_object(label)));
        if let Some(object) = named.into_iter().find(|&object| self.is_locked(object)) {
            return Err(Error::ObjectLocked { object });
        }
        self.draws.push(Phase::Draw { frame, object, labels });
        Ok(())
    }

    fn is_locked(&self, object: u8) -> bool {
        self.clip.objects.locked[usize::from(object)]
    }

    /// The current number of an object, and labels of it with this number in place of 1.
    fn own_labels(&self, object: u8, labels: &[u8]) -> Result<(u8, Vec<u8>)> {
        let object = self.clip.objects.current(object)?;
        Ok((object, labels.iter().map(|&label| if label == 1 { object } else { label }).collect()))
    }

    /// A label map with the current numbers of its objects.
    fn current_labels(&self, labels: &[u8]) -> Result<Vec<u8>> {
        let number = |&label: &u8| if is_object(label) { self.clip.objects.current(label) } else { Ok(label) };
        labels.iter().map(number).collect()
    }
}

/// Labels over those before, where they are not open.
pub(super) fn over(before: Option<Vec<u8>>, now: Vec<u8>) -> Vec<u8> {
    let Some(before) = before else { return now };
    before.into_iter().zip(now).map(|(before, now)| if now == UNLABELLED { before } else { now }).collect()
}

/// Removes what was drawn exactly under labels that are painted later, except of locked objects. A stroke of 0 removes only its own object.
pub(super) fn uncover_under(clip: &mut SegmentedClip, frame: usize, object: Option<u8>, labels: &[u8]) {
    let objects = clip.objects.clone();
    let frame = &mut clip.frames[frame];
    let Some(exact) = frame.exact.take() else { return };
    let mut exact = exact.values();
    for (p, exact) in exact.iter_mut().enumerate().filter(|(p, _)| labels[*p] != UNLABELLED) {
        let under = objects.number(*exact);
        let is_others = labels[p] == 0 && object.is_some_and(|object| object != under);
        if !is_others && !objects.locked[usize::from(under)] {
            *exact = UNLABELLED;
        }
    }
    frame.exact = some_labels(&exact);
}

/// Removes what was drawn exactly in a frame, of one object or of all.
pub(super) fn uncover(clip: &mut SegmentedClip, frame: usize, object: Option<u8>) {
    let numbers = clip.objects.numbers;
    let goes = |label: u8| object.is_none_or(|object| numbers[usize::from(label)] == object);
    let frame = &mut clip.frames[frame];
    frame.exact = frame.exact.take().and_then(|exact| {
        let labels: Vec<u8> = exact.values().into_iter().map(|l| if goes(l) { UNLABELLED } else { l }).collect();
        some_labels(&labels)
    });
}
