//! What can be seen of a clip: labels, frames, objects and tracks.

use std::sync::Arc;

use super::Clip;
use super::log::Kind;
use super::shown::Shown;
use crate::answer::UNLABELLED;
use crate::clip::annotation::Spread;
use crate::clip::command::{Annotation, Content};
use crate::clip::description::ClipFrame;
use crate::clip::objects::{Description, Objects};
use crate::clip::segmented_clip::SegmentedClip;
use crate::clip::tracks::{ClipTracks, Tracks};
use crate::error::Result;
use crate::frame::Frame;

/// What is known of a frame of a [`Clip`].
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameStatus {
    /// Whether it was segmented.
    pub has_masks: bool,
    /// Whether a person has accepted it.
    pub accepted: bool,
    /// Whether a person has annotated it.
    pub annotated: bool,
    /// A hash of all inputs of its labels: equal revisions have equal labels. 0 before it is segmented.
    pub revision: u64,
}

/// An object of a [`Clip`].
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Object {
    /// Its number, 1…254.
    pub number: u8,
    /// Its name, class and colour.
    pub description: Description,
    /// Whether it is locked.
    pub locked: bool,
    /// Whether a person has annotated it in any frame.
    pub annotated: bool,
    /// The number under which it goes on: its own, that of the object it was merged into, or 0 if it was deleted.
    pub became: u8,
}

impl Clip {
    /// Computes the labels of a frame.
    pub(super) fn describe(&mut self, index: usize, frame: &Frame) -> Result<()> {
        let mark_unknown = self.options.mark_unknown;
        let clip = self.clip_of(index);
        let shown = Shown::of(&clip.described(index, frame, mark_unknown)?, clip.key(index, mark_unknown));
        let is_running = self.is_changing(index);
        let remembered = if is_running { &mut self.remembered } else { &mut self.history.current_mut().remembered };
        remembered[index] = Some(Arc::new(shown));
        Ok(())
    }

    /// Looks at a frame, as one that is on screen: its labels come before all other work, as soon as it has masks and whenever they change. The
    /// frame that was looked at before is no longer; `None` looks at no frame.
    pub fn look_at(&mut self, index: impl Into<Option<usize>>) {
        self.looked_at = index.into();
    }

    /// Whether a frame has masks, but its labels are not known.
    pub(super) fn is_unknown(&self, index: usize) -> bool {
        let frame = self.state().clip.frames.get(index);
        frame.is_some_and(|frame| frame.found.is_some()) && self.shown(index).is_none()
    }

    /// The labels and objects of a frame as they are now; `None` if they are not known, see [`look_at`](Self::look_at).
    pub fn labels(&self, index: usize) -> Option<ClipFrame> {
        self.shown(index).map(|shown| shown.frame(index))
    }

    fn shown(&self, index: usize) -> Option<&Shown> {
        let known = if self.is_changing(index) { &self.remembered } else { &self.state().remembered };
        let shown = known.get(index)?.as_deref()?;
        (shown.key == self.clip_of(index).key(index, self.options.mark_unknown)).then_some(shown)
    }

    /// A draft of the newest frame of the range under way, from its own pairs alone, with numbers that may differ from those of the masks.
    /// `None` if it was returned already.
    pub fn preview(&mut self) -> Option<ClipFrame> {
        self.ranges.front_mut()?.preview()
    }

    /// The annotations of a frame, under the current numbers of their objects: label maps and strokes, then what was drawn exactly, then prompts.
    pub fn annotations(&self, index: usize) -> Vec<Annotation> {
        let clip = &self.state().clip;
        let Some(frame) = clip.frames.get(index) else { return Vec::new() };
        let (painted, prompts) = frame.annotation.as_ref().map(|of| of.given(index)).unwrap_or_default();
        let number = |object: u8| if object == UNLABELLED { object } else { clip.objects.number(object) };
        let renumbered = |labels: &[u8]| labels.iter().map(|&label| number(label)).collect();
        let mut all = Vec::new();
        for of in painted {
            let content = match of.object {
                None => Content::Labels(renumbered(&of.labels)),
                Some(object) => {
                    let labels = of.labels.iter().map(|&label| if label == object { 1 } else { label }).collect();
                    Content::Strokes { object: number(object), labels }
                }
            };
            all.push(Annotation { frame: index, content, spread: of.spread });
        }
        if let Some(exact) = &frame.exact {
            let content = Content::Labels(renumbered(&exact.values()));
            all.push(Annotation { frame: index, content, spread: Spread::Exact });
        }
        for of in prompts {
            let content = Content::Prompt { object: number(of.object), clicks: of.clicks, within: of.within };
            all.push(Annotation { frame: index, content, spread: of.spread });
        }
        all
    }

    /// What is known of each frame.
    pub fn frames(&self) -> Vec<FrameStatus> {
        let status = |index: usize| {
            let clip = self.clip_of(index);
            let frame = &clip.frames[index];
            FrameStatus {
                has_masks: frame.found.is_some(),
                accepted: frame.accepted,
                annotated: frame.annotation.is_some() || frame.exact.is_some(),
                revision: clip.key(index, self.options.mark_unknown),
            }
        };
        (0..self.len()).map(status).collect()
    }

    /// All objects that there have been, by number.
    pub fn objects(&self) -> Vec<Object> {
        let clip = &self.state().clip;
        let Objects { locked, used, .. } = &*clip.objects;
        let annotated = clip.annotated();
        let object = |number: u8| Object {
            number,
            description: clip.objects.description(number),
            locked: locked[usize::from(number)],
            annotated: annotated[usize::from(number)],
            became: clip.objects.number(number),
        };
        (1..UNLABELLED).filter(|&number| used[usize::from(number)]).map(object).collect()
    }

    /// The lowest number that no object has had, and that no command gives which has not taken effect; `None` if none is left.
    pub fn next_object(&self) -> Option<u8> {
        let mut used = self.state().clip.objects.used;
        for (step, ..) in self.given.iter().filter(|(_, kind, _)| *kind == Kind::Command) {
            if let Some(command) = self.command(*step) {
                command.add_objects(&mut used);
            }
        }
        (1..UNLABELLED).find(|&k| !used[usize::from(k)])
    }

    /// Number of objects for which no number was left; they count as background.
    pub fn dropped(&self) -> usize {
        self.state().clip.dropped()
    }

    /// Indices of the frames whose pairs are solved, and which are not segmented with these yet.
    pub fn solved_pairs(&self) -> Vec<usize> {
        (0..self.len()).filter(|&index| self.pairs[index].is_some()).collect()
    }

    /// The tracks of all objects in the frames whose labels are known.
    pub fn tracks(&self) -> ClipTracks {
        let mut tracks = Tracks::default();
        for (index, shown) in (0..self.len()).filter_map(|index| Some((index, self.shown(index)?))) {
            tracks.add(index, shown.objects(), shown.background());
        }
        tracks.value(self.dropped())
    }

    /// The clip with the masks of a frame: as the command under way has left it, if it has changed this frame.
    fn clip_of(&self, index: usize) -> &SegmentedClip {
        match &self.running {
            Some(running) if running.has_changed(index) => &running.clip,
            _ => &self.state().clip,
        }
    }

    fn is_changing(&self, index: usize) -> bool {
        self.running.as_ref().is_some_and(|running| running.has_changed(index))
    }
}
