//! Clips whose frames can be read again: they are segmented once, and then give any frame, are corrected and saved.

use std::cmp::Ordering;
use std::sync::Arc;

use super::annotation::{Direction, ObjectSet};
use super::frame_state::{Found, FrameState};
use super::layer::Layer;
use super::objects::Objects;
use super::options::working_sizes;
use super::pairs::LayeredMotion;
use super::saved::{Format, saved};
use crate::answer::UNLABELLED;
use crate::error::{Error, Result};
use crate::frame::scaling::Scaling;
use crate::frame::{Frame, MAX_SIDE, MIN_SIDE, Plane};

const CLIP: Format = Format { name: "state", mark: concat!("VERCLIP7 ", env!("CARGO_PKG_VERSION"), "\n") };

/// A clip whose objects are known in every frame. It stores some kilobytes per frame, and not the frames themselves.
#[derive(Clone, Debug)]
pub struct SegmentedClip {
    /// Width and height of the frames.
    pub(super) size: [usize; 2],
    pub(super) mark_unknown: bool,
    pub(super) objects: Arc<Objects>,
    pub(super) frames: Vec<FrameState>,
}

saved!(SegmentedClip { size, mark_unknown, objects, frames });

impl SegmentedClip {
    /// A clip of which no frame is segmented.
    pub(super) fn empty(frames: usize) -> SegmentedClip {
        let (objects, frames) = (Arc::new(Objects::new(0)), vec![FrameState::default(); frames]);
        SegmentedClip { size: [0, 0], mark_unknown: false, objects, frames }
    }

    /// Number of frames.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// The objects, to be changed.
    pub(super) fn objects_mut(&mut self) -> &mut Objects {
        Arc::make_mut(&mut self.objects)
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
        self.objects.dropped
    }

    /// Sets whether pixels whose log-odds do not decide get the label 255.
    pub fn mark_unknown(&mut self, mark: bool) {
        self.mark_unknown = mark;
    }

    /// Indices of the frames that contain an object, by its current number.
    pub fn frames_with(&self, object: u8) -> Vec<usize> {
        let has_it = |index: &usize| {
            let mut is_there: ObjectSet = [false; 256];
            self.frames[*index].mark(&mut is_there);
            is_there.iter().zip(&self.objects.numbers).any(|(is_there, number)| *is_there && *number == object)
        };
        (0..self.len()).filter(has_it).collect()
    }

    /// The objects in any frame, by their numbers before merges and deletions.
    pub fn objects(&self) -> Vec<u8> {
        let mut is_there: ObjectSet = [false; 256];
        self.frames.iter().for_each(|frame| frame.mark(&mut is_there));
        (1..UNLABELLED).filter(|&object| is_there[usize::from(object)]).collect()
    }

    /// For each object, whether a person has annotated it in any frame.
    pub(super) fn annotated(&self) -> ObjectSet {
        let mut annotated = [false; 256];
        for frame in &self.frames {
            if let Some(annotation) = &frame.annotation {
                annotation.mark(&mut annotated);
            }
            if let Some(exact) = &frame.exact {
                exact.mark(&mut annotated);
            }
        }
        annotated
    }

    /// Notes the numbers of all objects, which are not given again.
    pub(super) fn mark_used(&mut self) {
        let mut used = self.annotated();
        self.frames.iter().for_each(|frame| frame.mark(&mut used));
        let is_new = |k: usize| used[k] && !self.objects.used[k];
        let new: Vec<usize> = (1..usize::from(UNLABELLED)).filter(|&k| is_new(k)).collect();
        if !new.is_empty() {
            let objects = self.objects_mut();
            new.into_iter().for_each(|k| objects.used[k] = true);
        }
    }

    /// First and last frame of the scene that contains a frame.
    pub(super) fn scene(&self, index: usize) -> [usize; 2] {
        let (mut first, mut last) = (index, index);
        while first > 0 && self.frames[first].goes_on() {
            first -= 1;
        }
        while last + 1 < self.len() && self.frames[last + 1].goes_on() {
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
        let Objects { numbers, locked, named, .. } = &*self.objects;
        let mut protected: ObjectSet = std::array::from_fn(|k| locked[k] || named[k]);
        for layer in self.frames.iter().filter(|frame| frame.accepted).filter_map(|frame| frame.layer.as_ref()) {
            layer.labels.mark(&mut protected);
        }
        let is_merged = |(k, number): &(usize, &u8)| **number != 0 && usize::from(**number) != *k;
        for (k, &number) in numbers.iter().enumerate().filter(is_merged) {
            (protected[k], protected[usize::from(number)]) = (true, true);
        }
        // Neither the background nor a deleted object is protected.
        protected.iter_mut().zip(numbers).for_each(|(of, number)| *of &= *number > 0);
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
        let is_segmented = clip.frames.iter().all(|frame| frame.found.is_some());
        if is_segmented && clip.is_valid() { Ok(clip) } else { Err(CLIP.damaged()) }
    }

    pub(super) fn is_valid(&self) -> bool {
        let [width, height] = self.size;
        if self.frames.iter().all(|frame| frame.found.is_none()) {
            return self.size == [0, 0] && self.frames.iter().all(|frame| frame.is_valid([0, 0]));
        }
        if ![width, height].iter().all(|side| (MIN_SIDE..=MAX_SIDE).contains(side)) {
            return false;
        }
        let halvings = working_sizes(self.size).map(|scaling| scaling.halvings());
        let is_known = |frame: &FrameState| frame.found.as_ref().is_none_or(|found| halvings.contains(&found.halvings));
        self.frames.iter().all(|frame| frame.is_valid(self.size) && is_known(frame))
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
        let is_it = |found: &Arc<Found>| found.hash == frame.hash();
        if self.frames[index].found.as_ref().is_some_and(is_it) { Ok(()) } else { Err(Error::OtherFrame { index }) }
    }

    /// The scaling from a frame to its working size.
    pub(super) fn scaling(&self, index: usize) -> Scaling {
        Scaling::halved(self.size, self.frames[index].found.as_ref().map_or(0, |found| found.halvings))
    }

    /// The log-odds of a layer of a frame.
    pub(super) fn log_odds_of(&self, index: usize, layer: &Layer) -> Plane {
        let [width, height] = self.scaling(index).small;
        layer.log_odds.log_odds(width, height)
    }

    /// Labels and log-odds found in a frame, which was segmented.
    pub(super) fn found(&self, index: usize) -> (Vec<u8>, Plane) {
        let (frame, [width, height]) = (&self.frames[index], self.scaling(index).small);
        let log_odds = frame.found.as_ref().map(|found| self.log_odds_of(index, &found.layer));
        (frame.found_labels().values(), log_odds.unwrap_or_else(|| Plane::filled(width, height, 0.0)))
    }

    /// The labels of a frame as the clip was segmented, enlarged to a size. Merged objects have one number.
    pub(super) fn found_at(&self, index: usize, size: [usize; 2]) -> Vec<u8> {
        let (objects, labels) = (self.objects_of_found(), self.frames[index].found_labels().values());
        let labels: Vec<u8> = labels.iter().map(|&label| objects[usize::from(label)]).collect();
        Scaling::between(size, self.scaling(index).small).enlarged(&labels)
    }

    /// Whether an object, or one that was merged into it, was found in a frame.
    pub(super) fn is_found_in(&self, index: usize, object: u8) -> bool {
        let objects = self.objects_of_found();
        self.frames[index].found_labels().any(&|label| objects[usize::from(label)] == object)
    }

    /// For each label found automatically, its object. An object that was annotated before it was merged keeps its own annotations, and a
    /// deleted one stands for what is drawn anew in its place.
    pub(super) fn objects_of_found(&self) -> [u8; 256] {
        let is_annotated = |label: u8| self.frames.iter().any(|frame| frame.anchors(label));
        std::array::from_fn(|label| match self.objects.numbers[label] {
            number if number > 0 && usize::from(number) != label && !is_annotated(label as u8) => number,
            _ => label as u8,
        })
    }

    /// Motion to the next frame of the scene; `None` after its last frame.
    pub(super) fn onward(&self, index: usize) -> Option<LayeredMotion> {
        let found = self.frames[index].found.as_ref()?;
        found.onward.as_ref().map(|flow| flow.layered_motion(self.scaling(index).small[0]))
    }

    /// Motion to the previous frame; `None` before the first frame of a scene.
    pub(super) fn back(&self, index: usize) -> Option<LayeredMotion> {
        let found = self.frames[index].found.as_ref()?;
        found.back.as_ref().map(|flow| flow.layered_motion(self.scaling(index).small[0]))
    }
}
