//! A command that takes effect: on a copy of the state, in phases that ask for the frames that they need.

use std::collections::VecDeque;
use std::ops::Range;

use super::phase::{Phase, some_labels};
use super::phases::{phases, split};
use super::ranges::RangeJob;
use super::repeated::repeated;
use crate::answer::UNLABELLED;
use crate::clip::changes::{Changed, Changes};
use crate::clip::command::Command;
use crate::clip::description::ClipFrame;
use crate::clip::job::ClipJob;
use crate::clip::segmented_clip::SegmentedClip;
use crate::error::Result;
use crate::frame::Frame;

/// A command under way.
#[derive(Clone, Debug)]
pub(super) struct Running {
    pub(super) step: u32,
    pub(super) clip: SegmentedClip,
    /// Whether it is part of the step before.
    pub(super) joins: bool,
    /// The frames of the range that it puts in its place.
    pub(super) range: Option<Range<usize>>,
    phases: VecDeque<Phase>,
    job: Option<ClipJob>,
    /// What earlier phases have changed.
    changes: Changes,
}

impl Running {
    /// Begins a command on a copy of a state.
    ///
    /// # Errors
    /// [`Error::InvalidOption`], [`Error::ObjectLocked`].
    pub(super) fn new(step: u32, before: &SegmentedClip, command: Command) -> Result<Running> {
        let mut clip = before.clone();
        let joins = matches!(command, Command::Describe { coalesce: true, .. });
        let phases = phases(&mut clip, command)?;
        Running { step, clip, joins, range: None, phases, job: None, changes: Changes::default() }.advanced()
    }

    /// Puts a segmented range in its place, and applies the annotations of its scenes again.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] for a range of fewer than two frames.
    pub(super) fn of_range(range: RangeJob, before: &SegmentedClip) -> Result<Running> {
        let (step, frames) = (range.step, range.frames.clone());
        let (mut clip, scenes) = range.conclude(before)?;
        let phases = repeated(before, &mut clip, scenes).into();
        Running { step, clip, joins: false, range: Some(frames), phases, job: None, changes: Changes::default() }
            .advanced()
    }

    /// A state that takes the place of the one before.
    pub(super) fn of_state(step: u32, clip: SegmentedClip) -> Running {
        let phases = VecDeque::new();
        Running { step, clip, joins: false, range: None, phases, job: None, changes: Changes::default() }
    }

    /// The frame to [`take`](Self::take) next; `None` when the command has taken effect.
    pub(super) fn wanted(&self) -> Option<usize> {
        self.job.as_ref().and_then(ClipJob::wanted).or_else(|| match self.phases.front()? {
            Phase::Draw { frame, .. } | Phase::Split { frame, .. } => Some(*frame),
            Phase::Annotate(_) | Phase::Lock(_) | Phase::Restore(_) => None,
        })
    }

    /// Takes the frame that is wanted.
    ///
    /// # Errors
    /// [`Error::FrameSizeMismatch`], [`Error::OtherFrame`]: the right frame can be taken. Other errors end the command.
    pub(super) fn take(&mut self, frame: &Frame) -> Result<()> {
        if let Some(job) = &mut self.job {
            job.take(&mut self.clip, frame)?;
        } else if let Some(index) = self.wanted() {
            let shown = self.clip.frame(index, frame)?;
            match self.phases.pop_front() {
                Some(Phase::Draw { object, labels, .. }) => self.draw(&shown, object, &labels),
                Some(Phase::Split { object, new, .. }) => {
                    let annotations = split(&mut self.clip, &shown, object, new)?;
                    self.phases.push_front(Phase::Annotate(annotations));
                }
                _ => {}
            }
        }
        self.advance()
    }

    /// Whether it has changed a frame.
    pub(super) fn has_changed(&self, index: usize) -> bool {
        self.job.as_ref().map_or(self.changes.frames(), ClipJob::changed).contains(&index)
    }

    /// What objects have gained and lost, under their current numbers. Nothing for a range, whose masks are new.
    pub(super) fn changes(&self) -> Vec<Changed> {
        let mut all: Vec<Changed> = Vec::new();
        for changed in self.changes.list().into_iter().filter(|_| self.range.is_none()) {
            let object = self.clip.objects.number(changed.object);
            match all.iter_mut().find(|of| (of.frame, of.object) == (changed.frame, object)) {
                Some(of) => (of.gained, of.lost) = (of.gained + changed.gained, of.lost + changed.lost),
                None => all.push(Changed { object, ..changed }),
            }
        }
        all
    }

    fn advanced(mut self) -> Result<Running> {
        self.advance()?;
        Ok(self)
    }

    /// Goes on to the next phase that needs a frame.
    fn advance(&mut self) -> Result<()> {
        loop {
            if let Some(job) = self.job.take_if(|job| job.wanted().is_none()) {
                self.changes = job.into_changes();
            }
            if self.wanted().is_some() {
                return Ok(());
            }
            match self.phases.pop_front() {
                Some(Phase::Annotate(annotations)) => {
                    let earlier = std::mem::take(&mut self.changes);
                    self.job = Some(self.clip.annotate(annotations)?.after(earlier));
                }
                Some(Phase::Lock(objects)) => self.clip.objects_mut().locked = self.clip.objects.with_merged(&objects),
                Some(Phase::Restore(lifted)) => {
                    let objects = self.clip.objects_mut();
                    (objects.locked, objects.named, objects.numbers) = (lifted.locked, lifted.named, lifted.numbers);
                }
                _ => return Ok(()),
            }
        }
    }

    /// Draws labels exactly. Pixels of locked objects stay as they are; a stroke of 0 removes only its own object.
    fn draw(&mut self, shown: &ClipFrame, object: Option<u8>, labels: &[u8]) {
        let ClipFrame { index, labels: shown, .. } = shown;
        let frame = &mut self.clip.frames[*index];
        let mut exact = frame.exact.as_ref().map_or_else(|| vec![UNLABELLED; shown.len()], |exact| exact.values());
        let mut now = shown.clone();
        for (p, &label) in labels.iter().enumerate().filter(|(_, label)| **label != UNLABELLED) {
            let was = shown[p];
            let is_others = label == 0 && object.is_some_and(|object| object != was);
            if !self.clip.objects.locked[usize::from(was)] && !is_others {
                (exact[p], now[p]) = (label, label);
            }
        }
        frame.exact = some_labels(&exact);
        self.changes.set(*index, shown, &now);
    }
}
