//! Edits without propagation: reserved numbers, accepted frames, merged and deleted objects.

use std::sync::Arc;

use super::annotation::{Accepted, ObjectSet};
use super::changes::Changes;
use super::frame_annotation::FrameAnnotation;
use super::objects::{Description, Objects};
use super::segmented_clip::SegmentedClip;
use crate::answer::UNLABELLED;
use crate::frame::Frame;

impl SegmentedClip {
    /// Reserves numbers for given masks: an object found automatically under one of them gets the lowest free number or, if there is none,
    /// becomes background and counts as [`dropped`](Self::dropped). Annotated objects keep their numbers. Returns the indices of the
    /// changed frames.
    pub(super) fn reserve(&mut self, numbers: &[u8]) -> Vec<usize> {
        let mut user_objects: ObjectSet =
            std::array::from_fn(|k| self.frames.iter().any(|frame| frame.anchors(k as u8)));
        let mut is_found = [false; 256];
        for frame in &self.frames {
            frame.exact.iter().for_each(|exact| exact.mark(&mut user_objects));
            frame.found_labels().mark(&mut is_found);
        }
        let objects = self.objects_mut();
        let is_taken = |k: &u8, objects: &Objects| {
            let known = usize::from(*k);
            is_found[known] || user_objects[known] || objects.used[known] || numbers.contains(k)
        };
        let all = 1..UNLABELLED;
        let free: Vec<u8> = all.clone().filter(|k| !is_taken(k, objects)).collect();
        let mut free = free.into_iter();
        let mut now: Vec<u8> = (0..=UNLABELLED).collect();
        for k in all.filter(|k| numbers.contains(k) && !user_objects[usize::from(*k)]) {
            let old = usize::from(k);
            let number = std::mem::replace(&mut objects.numbers[old], k);
            if is_found[old] {
                now[old] = free.next().unwrap_or(0);
                match now[old] {
                    0 => objects.dropped += 1,
                    new => objects.numbers[usize::from(new)] = number,
                }
                objects.locked.swap(old, usize::from(now[old]));
                objects.named.swap(old, usize::from(now[old]));
                let description = objects.description(k);
                objects.describe(k, Description::default());
                if now[old] > 0 {
                    objects.describe(now[old], description);
                }
            }
        }
        // Objects that were merged into a renumbered object follow it.
        for (_, number) in objects.numbers.iter_mut().enumerate().filter(|(k, number)| usize::from(**number) != *k) {
            *number = now[usize::from(*number)];
        }
        let mut changed = Vec::new();
        for (index, frame) in self.frames.iter_mut().enumerate() {
            let labels = frame.found_labels().map(|label| now[usize::from(label)]);
            if let Some(layer) = &mut frame.layer {
                let given = |label: u8| if user_objects[usize::from(label)] { label } else { now[usize::from(label)] };
                let labels = layer.labels.map(given);
                Arc::make_mut(layer).labels = labels;
            }
            if labels != *frame.found_labels() {
                frame.renumbered = Some(Arc::new(labels));
                changed.push(index);
            }
        }
        changed
    }

    /// Accepts a frame with the given labels, without them with the labels that it has.
    pub(super) fn accept(&mut self, frame: &Frame, Accepted { frame: index, labels }: Accepted, changes: &mut Changes) {
        let shown = self.shown(index, frame.luminance());
        let labels = labels.unwrap_or_else(|| shown.clone());
        let layer = self.frames[index].layer.as_ref();
        let before = layer.map(|layer| (layer.labels.values(), self.log_odds_of(index, layer)));
        let (_, found) = self.found(index);
        let log_odds = |p: usize, at: usize| match &before {
            Some((labels, log_odds)) if labels[p] != UNLABELLED => log_odds.values()[at],
            _ => found.values()[at],
        };
        let layer = self.layer_of(index, &labels, &log_odds);
        (self.frames[index].layer, self.frames[index].accepted) = (layer, true);
        if labels != shown {
            changes.set(index, &shown, &labels);
        }
    }

    /// Gives every pixel of an object another number in the whole clip. The annotations of an object that becomes background are deleted.
    /// Returns the indices of the changed frames.
    pub(super) fn renumber(&mut self, [object, number]: [u8; 2]) -> Vec<usize> {
        let number = self.objects.number(number);
        if number != 0 && self.frames_with(number).is_empty() {
            return Vec::new();
        }
        let changed = self.frames_with(object);
        self.objects_mut().numbers.iter_mut().filter(|given| **given == object).for_each(|given| *given = number);
        for annotation in self.frames.iter_mut().filter_map(|frame| frame.annotation.as_mut()) {
            let mut now = FrameAnnotation::clone(annotation);
            now.forget(&self.objects.numbers);
            if now != **annotation {
                *annotation = Arc::new(now);
            }
        }
        changed
    }
}
