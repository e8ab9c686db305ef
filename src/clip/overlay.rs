//! The labels of a frame: those found automatically, under the layer of annotations.

use std::sync::Arc;

use super::annotation::{ObjectSet, is_object};
use super::description::{ClipFrame, WorkingFrame};
use super::layer::Layer;
use super::options::model;
use super::segmented_clip::SegmentedClip;
use crate::answer::UNLABELLED;
use crate::error::Result;
use crate::frame::{Frame, Plane};

impl SegmentedClip {
    /// The labels and objects of a frame, which must be the one that was segmented.
    ///
    /// # Errors
    /// [`Error::InvalidOption`](crate::Error::InvalidOption) for an index that is not below [`len`](Self::len),
    /// [`Error::FrameSizeMismatch`](crate::Error::FrameSizeMismatch), [`Error::OtherFrame`](crate::Error::OtherFrame).
    pub fn frame(&self, index: usize, frame: &Frame) -> Result<ClipFrame> {
        self.described(index, frame, self.mark_unknown)
    }

    /// [`frame`](Self::frame), with or without marks of unknown pixels.
    pub(super) fn described(&self, index: usize, frame: &Frame, mark_unknown: bool) -> Result<ClipFrame> {
        self.check(index, frame)?;
        let state = &self.frames[index];
        let user_objects = self.user_objects_in(index);
        let is_users = |label: u8| user_objects[usize::from(label)];
        // Labels that the layer distinguishes keep their numbers until the layer is applied.
        let given = |label: u8| match self.objects.numbers[usize::from(label)] {
            number if is_users(label) || is_users(number) => label,
            number => number,
        };
        let (mut labels, mut log_odds) = self.found(index);
        labels.iter_mut().for_each(|label| *label = given(*label));
        let onward = self.onward(index);
        let working = |labels: &[u8], log_odds: &Plane, mark_unknown| {
            WorkingFrame { index, labels, log_odds, onward: onward.as_ref(), mark_unknown }.described(frame.luminance())
        };
        let is_final = |label: &u8| self.objects.numbers[usize::from(*label)] == *label && !is_users(*label);
        if state.layer.is_none() && state.exact.is_none() && labels.iter().all(is_final) {
            return Ok(working(&labels, &log_odds, mark_unknown));
        }
        let found = working(&labels, &log_odds, false).labels;
        let mut full = self.overlaid(index, &found, &user_objects);
        full.iter_mut().for_each(|label| *label = self.objects.numbers[usize::from(*label)]);
        let layer = state.layer.as_ref().map(|layer| self.log_odds_of(index, layer)).zip(self.layer_labels(index));
        let exact = self.exact_labels(index);
        for (label, exact) in full.iter_mut().zip(exact.iter().flatten()).filter(|(_, exact)| **exact != UNLABELLED) {
            *label = *exact;
        }
        let scaling = self.scaling(index);
        for at in 0..labels.len() {
            let p = scaling.corner(at);
            let log_odds = &mut log_odds.values_mut()[at];
            match &layer {
                _ if exact.as_ref().is_some_and(|exact| exact[p] != UNLABELLED) => {
                    *log_odds = if full[p] > 0 { 2.0 * model().certain } else { -2.0 * model().certain };
                }
                Some((of_layer, above)) if above[p] != UNLABELLED => *log_odds = of_layer.values()[at],
                _ if full[p] == 0 && found[p] > 0 => *log_odds = -model().certain,
                _ => {}
            }
            labels[at] = full[p];
        }
        let onward = onward.as_ref();
        Ok(WorkingFrame { index, labels: &labels, log_odds: &log_odds, onward, mark_unknown }.marked(
            full,
            exact.as_deref(),
            frame.width(),
        ))
    }

    /// The labels of a frame found automatically, at full size.
    pub(super) fn found_full(&self, index: usize, luminance: &Plane) -> Vec<u8> {
        let (labels, log_odds) = self.found(index);
        WorkingFrame { index, labels: &labels, log_odds: &log_odds, onward: None, mark_unknown: false }
            .upsampled(luminance)
    }

    /// The labels of a frame, before objects are merged or deleted.
    pub(super) fn shown(&self, index: usize, luminance: &Plane) -> Vec<u8> {
        self.overlaid(index, &self.found_full(index, luminance), &self.user_objects_in(index))
    }

    /// The labels found automatically, at full size, under the layer of a frame. Found pixels of annotated objects and of deleted ones are
    /// hidden, and so is the rest of an object most of which lies under masks that were given.
    pub(super) fn overlaid(&self, index: usize, found: &[u8], user_objects: &ObjectSet) -> Vec<u8> {
        let layer = self.layer_labels(index).unwrap_or_else(|| vec![UNLABELLED; found.len()]);
        let (mut sizes, given) = ([[0usize; 2]; 256], &self.objects.given);
        if given.contains(&true) {
            for (&found, &label) in found.iter().zip(&layer) {
                sizes[usize::from(found)][0] += 1;
                sizes[usize::from(found)][1] += usize::from(given[usize::from(label)]);
            }
        }
        let protected = self.protected();
        let is_hidden = |label: u8| {
            let k = usize::from(label);
            user_objects[k] || self.objects.numbers[k] == 0 || !protected[k] && 2 * sizes[k][1] > sizes[k][0]
        };
        let hidden: Vec<bool> = (0..=u8::MAX).map(is_hidden).collect();
        let label = |(&layer, &found): (&u8, &u8)| match layer {
            UNLABELLED if hidden[usize::from(found)] => 0,
            UNLABELLED => found,
            label => label,
        };
        layer.iter().zip(found).map(label).collect()
    }

    /// The labels of the layer of a frame, if it has one. At the pixels of deleted objects, the labels below show.
    pub(super) fn layer_labels(&self, index: usize) -> Option<Vec<u8>> {
        let is_deleted: ObjectSet = std::array::from_fn(|k| self.objects.numbers[k] == 0 && is_object(k as u8));
        let mut labels = self.frames[index].layer.as_ref()?.labels.values();
        if is_deleted.contains(&true) {
            labels.iter_mut().filter(|label| is_deleted[usize::from(**label)]).for_each(|label| *label = UNLABELLED);
        }
        Some(labels)
    }

    /// The labels drawn exactly in a frame, if there are any, with the current numbers of their objects; open where an object was deleted.
    fn exact_labels(&self, index: usize) -> Option<Vec<u8>> {
        let number = |label: u8| match self.objects.number(label) {
            0 if label > 0 => UNLABELLED,
            number => number,
        };
        Some(self.frames[index].exact.as_ref()?.map(number).values())
    }

    /// A layer of full-size labels for a frame; `None` if all are 255. `log_odds` gives the log-odds of a full-size pixel and of the working pixel
    /// whose corner it is.
    pub(super) fn layer_of(
        &self,
        index: usize,
        labels: &[u8],
        log_odds: &dyn Fn(usize, usize) -> f32,
    ) -> Option<Arc<Layer>> {
        if labels.iter().all(|&label| label == UNLABELLED) {
            return None;
        }
        let scaling = self.scaling(index);
        let [width, height] = scaling.small;
        let log_odds = Plane::from_fn(width, height, |x, y| {
            let at = y * width + x;
            let p = scaling.corner(at);
            match labels[p] {
                UNLABELLED => 0.0,
                0 => -2.0 * model().certain,
                _ => log_odds(p, at),
            }
        });
        Some(Arc::new(Layer::of(labels, &log_odds)))
    }
}
