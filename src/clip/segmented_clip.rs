//! Clips whose frames can be read again: they are segmented once, and then give any frame, are corrected and saved.

use std::cmp::Ordering;

use super::annotation::{Direction, ObjectSet};
use super::frame_state::FrameState;
use super::layer::Layer;
use super::options::ClipOptions;
use super::pairs::LayeredMotion;
use super::saved::{Format, saved};
use crate::answer::UNLABELLED;
use crate::error::{Error, Result};
use crate::frame::scaling::Scaling;
use crate::frame::{Frame, MAX_SIDE, MIN_SIDE, Plane};
use crate::options::{Quality, SegmentOptions};
use crate::pair::settings::Settings;

const CLIP: Format = Format { name: "state", mark: concat!("VERCLIP6 ", env!("CARGO_PKG_VERSION"), "\n") };

/// A clip whose objects are known in every frame. It stores some kilobytes per frame, and not the frames themselves.
#[derive(Clone, Debug)]
pub struct SegmentedClip {
    /// Width and height of the frames.
    pub(super) size: [usize; 2],
    pub(super) mark_unknown: bool,
    /// Whether the quality is the best.
    pub(super) best: bool,
    /// Whether the clip was segmented as a stream is, with a look-ahead.
    pub(super) stream: bool,
    pub(super) dropped: usize,
    /// For each object, its number in the results: its own unless the object was merged or deleted.
    pub(super) numbers: Vec<u8>,
    /// For each object, whether it is locked.
    pub(super) locked: Vec<bool>,
    /// For each object, whether a person has named it, so that only annotations of itself change it.
    pub(super) named: Vec<bool>,
    /// For each object, whether masks of it were given, which replace the object found there.
    pub(super) given: Vec<bool>,
    /// The hash of every segmented frame.
    pub(super) hashes: Vec<u64>,
    pub(super) frames: Vec<FrameState>,
}

saved!(SegmentedClip { size, mark_unknown, best, stream, dropped, numbers, locked, named, given, hashes, frames });

impl SegmentedClip {
    /// Number of frames.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Whether there is no frame.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// Width and height of the frames; 0 if there is none.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Number of objects for which no number was left; they count as background.
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// Sets whether pixels whose log-odds do not decide get the label 255.
    pub fn mark_unknown(&mut self, mark: bool) {
        self.mark_unknown = mark;
    }

    /// Indices of the frames that contain an object, by its current number.
    pub fn frames_with(&self, object: u8) -> Vec<usize> {
        let is_it = |(label, _): (u8, usize)| self.numbers[usize::from(label)] == object;
        let is_there = |frame: &FrameState| {
            let layers = [Some(&frame.found), frame.layer.as_ref()];
            layers.into_iter().flatten().any(|layer| layer.labels.each().any(is_it))
        };
        (0..self.len()).filter(|&index| is_there(&self.frames[index])).collect()
    }

    /// The objects in any frame, by their numbers before merges and deletions.
    pub fn objects(&self) -> Vec<u8> {
        let mut is_there: ObjectSet = [false; 256];
        let layers = self.frames.iter().flat_map(|frame| [Some(&frame.found), frame.layer.as_ref()]).flatten();
        layers.flat_map(|layer| layer.labels.each()).for_each(|(label, _)| is_there[usize::from(label)] = true);
        (1..UNLABELLED).filter(|&object| is_there[usize::from(object)]).collect()
    }

    /// First and last frame of the scene that contains a frame.
    pub(super) fn scene(&self, index: usize) -> [usize; 2] {
        let (mut first, mut last) = (index, index);
        while self.frames[first].back.is_some() && first > 0 {
            first -= 1;
        }
        while last + 1 < self.len() && self.frames[last + 1].back.is_some() {
            last += 1;
        }
        [first, last]
    }

    /// The objects that annotations of the scene propagate to a frame. What was found there under their numbers is hidden.
    pub(super) fn user_objects_in(&self, index: usize) -> ObjectSet {
        let [first, last] = self.scene(index);
        let mut objects = [false; 256];
        for t in first..=last {
            let Some(annotation) = &self.frames[t].annotation else { continue };
            for &object in &annotation.anchored {
                let spread = annotation.spread_of(object);
                objects[usize::from(object)] |= match t.cmp(&index) {
                    Ordering::Less => spread.goes(Direction::Forward),
                    Ordering::Equal => true,
                    Ordering::Greater => spread.goes(Direction::Backward),
                };
            }
        }
        objects
    }

    /// The protected objects, which change only by annotations of themselves: locked, named and merged ones, and those in accepted frames.
    pub(super) fn protected(&self) -> ObjectSet {
        let mut protected: ObjectSet = std::array::from_fn(|k| self.locked[k] || self.named[k]);
        for layer in self.frames.iter().filter(|frame| frame.accepted).filter_map(|frame| frame.layer.as_ref()) {
            layer.labels.each().for_each(|(label, _)| protected[usize::from(label)] = true);
        }
        let is_merged = |(k, number): &(usize, &u8)| **number != 0 && usize::from(**number) != *k;
        for (k, &number) in self.numbers.iter().enumerate().filter(is_merged) {
            (protected[k], protected[usize::from(number)]) = (true, true);
        }
        // Neither the background nor a deleted object is protected.
        protected.iter_mut().zip(&self.numbers).for_each(|(of, number)| *of &= *number > 0);
        protected
    }

    /// The bytes of this clip, for [`from_bytes`](Self::from_bytes) of the same version.
    pub fn to_bytes(&self) -> Vec<u8> {
        CLIP.written(self)
    }

    /// A clip from its bytes.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] for bytes of another version and damaged ones.
    pub fn from_bytes(bytes: &[u8]) -> Result<SegmentedClip> {
        let clip: SegmentedClip = CLIP.read(bytes)?;
        if clip.is_valid() { Ok(clip) } else { Err(CLIP.damaged()) }
    }

    fn is_valid(&self) -> bool {
        let [width, height] = self.size;
        if [self.numbers.len(), self.locked.len(), self.named.len(), self.given.len()] != [256; 4]
            || self.hashes.len() != self.frames.len()
        {
            return false;
        }
        if self.frames.is_empty() {
            return self.size == [0, 0];
        }
        if ![width, height].iter().all(|side| (MIN_SIDE..=MAX_SIDE).contains(side)) {
            return false;
        }
        let [w, h] = self.scaling().small;
        self.frames.iter().all(|frame| frame.is_valid(w * h, width * height))
    }

    pub(super) fn check_index(&self, index: usize) -> Result<()> {
        let reason = || format!("there is no frame {index} in a clip of {} frames", self.len());
        if index < self.len() { Ok(()) } else { Err(Error::InvalidOption { name: "frame", reason: reason() }) }
    }

    pub(super) fn check(&self, index: usize, frame: &Frame) -> Result<()> {
        self.check_index(index)?;
        let (first, second) = ((self.size[0], self.size[1]), (frame.width(), frame.height()));
        if first != second {
            return Err(Error::FrameSizeMismatch { first, second });
        }
        if frame.hash() == self.hashes[index] { Ok(()) } else { Err(Error::OtherFrame { index }) }
    }

    fn settings(&self) -> Settings {
        let quality = if self.best { Quality::Best } else { Quality::Fast };
        let pair = SegmentOptions { quality, ..SegmentOptions::default() };
        ClipOptions { pair, look_ahead: self.stream.then_some(0) }.settings(self.size)
    }

    /// The scaling from the frames to their working size.
    pub(super) fn scaling(&self) -> Scaling {
        self.settings().scaling(self.size)
    }

    /// The log-odds of a layer.
    pub(super) fn log_odds_of(&self, layer: &Layer) -> Plane {
        let [width, height] = self.scaling().small;
        layer.log_odds.log_odds(width, height)
    }

    /// Labels and log-odds of a frame as the clip was segmented.
    pub(super) fn found(&self, index: usize) -> (Vec<u8>, Plane) {
        let found = &self.frames[index].found;
        (found.labels.values(), self.log_odds_of(found))
    }

    /// The labels of a frame as the clip was segmented, enlarged to a size. Merged objects have one number.
    pub(super) fn found_at(&self, index: usize, size: [usize; 2]) -> Vec<u8> {
        let (objects, labels) = (self.objects_of_found(), self.frames[index].found.labels.values());
        let labels: Vec<u8> = labels.iter().map(|&label| objects[usize::from(label)]).collect();
        Scaling::between(size, self.scaling().small).enlarged(&labels)
    }

    /// Whether an object, or one that was merged into it, was found in a frame.
    pub(super) fn is_found_in(&self, index: usize, object: u8) -> bool {
        let objects = self.objects_of_found();
        self.frames[index].found.labels.each().any(|(label, _)| objects[usize::from(label)] == object)
    }

    /// For each label found automatically, its object. An object that was annotated before it was merged keeps its own annotations, and a
    /// deleted one stands for what is drawn anew in its place.
    pub(super) fn objects_of_found(&self) -> [u8; 256] {
        let is_annotated = |label: u8| self.frames.iter().any(|frame| frame.anchors(label));
        std::array::from_fn(|label| match self.numbers[label] {
            number if number > 0 && usize::from(number) != label && !is_annotated(label as u8) => number,
            _ => label as u8,
        })
    }

    /// Motion to the next frame of the scene; `None` after its last frame.
    pub(super) fn onward(&self, index: usize) -> Option<LayeredMotion> {
        self.frames[index].onward.as_ref().map(|flow| flow.layered_motion(self.scaling().small[0]))
    }

    /// Motion to the previous frame; `None` before the first frame of a scene.
    pub(super) fn back(&self, index: usize) -> Option<LayeredMotion> {
        self.frames[index].back.as_ref().map(|flow| flow.layered_motion(self.scaling().small[0]))
    }
}
