//! Edits without propagation: reserved numbers, accepted frames, merged and deleted objects.

use super::annotation::{Accepted, ObjectSet};
use super::changes::Changes;
use super::segmented_clip::SegmentedClip;
use crate::answer::UNLABELLED;
use crate::frame::Frame;

impl SegmentedClip {
    /// Reserves numbers for given masks: an object found automatically under one of them gets the lowest free number or, if there is none,
    /// becomes background and counts as [`dropped`](Self::dropped). Annotated objects keep their numbers. Returns the indices of the
    /// changed frames.
    pub(super) fn reserve(&mut self, numbers: &[u8]) -> Vec<usize> {
        let user_objects: ObjectSet = std::array::from_fn(|k| self.frames.iter().any(|frame| frame.anchors(k as u8)));
        let mut is_found = [false; 256];
        for (label, _) in self.frames.iter().flat_map(|frame| frame.found.labels.each()) {
            is_found[usize::from(label)] = true;
        }
        let objects = 1..UNLABELLED;
        let is_taken = |k: &u8| is_found[usize::from(*k)] || user_objects[usize::from(*k)] || numbers.contains(k);
        let mut free = objects.clone().filter(|k| !is_taken(k));
        let mut now: Vec<u8> = (0..=UNLABELLED).collect();
        for k in objects.clone().filter(|k| numbers.contains(k) && !user_objects[usize::from(*k)]) {
            let old = usize::from(k);
            let number = std::mem::replace(&mut self.numbers[old], k);
            if is_found[old] {
                now[old] = free.next().unwrap_or(0);
                match now[old] {
                    0 => self.dropped += 1,
                    new => self.numbers[usize::from(new)] = number,
                }
                self.locked.swap(old, usize::from(now[old]));
                self.named.swap(old, usize::from(now[old]));
            }
        }
        // Objects that were merged into a renumbered object follow it.
        for (_, number) in self.numbers.iter_mut().enumerate().filter(|(k, number)| usize::from(**number) != *k) {
            *number = now[usize::from(*number)];
        }
        let mut changed = Vec::new();
        for (index, frame) in self.frames.iter_mut().enumerate() {
            let labels = frame.found.labels.map(|label| now[usize::from(label)]);
            if let Some(layer) = frame.layer.as_mut().filter(|_| frame.accepted) {
                let given = |label: u8| if user_objects[usize::from(label)] { label } else { now[usize::from(label)] };
                layer.labels = layer.labels.map(given);
            }
            if labels != frame.found.labels {
                frame.found.labels = labels;
                changed.push(index);
            }
        }
        changed
    }

    /// Accepts a frame with the given labels, without them with the labels that it has.
    pub(super) fn accept(&mut self, frame: &Frame, Accepted { frame: index, labels }: Accepted, changes: &mut Changes) {
        let shown = self.shown(index, frame.luminance());
        let labels = labels.unwrap_or_else(|| shown.clone());
        let before = self.frames[index].layer.as_ref().map(|layer| (layer.labels.values(), self.log_odds_of(layer)));
        let found = self.log_odds_of(&self.frames[index].found);
        let log_odds = |p: usize, at: usize| match &before {
            Some((labels, log_odds)) if labels[p] != UNLABELLED => log_odds.values()[at],
            _ => found.values()[at],
        };
        let layer = self.layer_of(&labels, &log_odds);
        (self.frames[index].layer, self.frames[index].accepted) = (layer, true);
        if labels != shown {
            changes.set(index, &shown, &labels);
        }
    }

    /// Gives every pixel of an object another number in the whole clip. The annotations of an object that becomes background are deleted.
    /// Returns the indices of the changed frames.
    pub(super) fn renumber(&mut self, [object, number]: [u8; 2]) -> Vec<usize> {
        let number = self.numbers[usize::from(number)];
        if number != 0 && self.frames_with(number).is_empty() {
            return Vec::new();
        }
        let changed = self.frames_with(object);
        self.numbers.iter_mut().filter(|given| **given == object).for_each(|given| *given = number);
        for annotation in self.frames.iter_mut().filter_map(|frame| frame.annotation.as_mut()) {
            annotation.forget(&self.numbers);
        }
        changed
    }
}
