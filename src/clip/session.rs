//! A clip from its opening to its closing: commands in, labels out, undo, and a journal from which it can be read again.
//!
//! - A command takes effect on a copy of the state (`session/running.rs`), frame by frame; the copy becomes the state as a whole or not at all.
//! - A range of frames is segmented beside that (`session/ranges.rs`), and takes its place between two commands.
//! - The states after each step share all parts in which they do not differ (`session/history.rs`).
//! - The journal has every command before it takes effect, and what it has changed (`session/journal.rs`, `session/log.rs`).
//! - Labels are cached under a hash of their inputs (`session/view.rs`, `session/shown.rs`).

mod combined;
mod events;
mod history;
mod journal;
mod log;
mod phase;
mod phases;
mod ranges;
mod repeated;
mod running;
mod shown;
mod view;

use std::collections::VecDeque;
use std::sync::Arc;

use super::annotation::is_object;
use super::command::Command;
use super::frame_state::FrameState;
use super::saved::Saved;
use super::segmented_clip::SegmentedClip;
use super::segmenter::FramePairs;
use crate::error::{Error, Result};
use crate::frame::Frame;

use history::{ByFrame, Difference, History, State};
use log::{Kind, Log, Written, range_record, result};
use ranges::RangeJob;
use running::Running;
use shown::Shown;

pub use events::{ClipStage, Events, Settled, StepId, Wanted};
pub use journal::Recovered;
pub use view::{FrameStatus, Object};

/// Largest number of frames of a clip.
const MOST_FRAMES: usize = 1 << 20;

/// Largest number of commands that wait.
const MOST_WAITING: usize = 256;

/// Options of a [`Clip`].
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OpenOptions {
    /// Whether pixels get the label 255 where the log-odds do not decide between object and background.
    pub mark_unknown: bool,
    /// Bytes that are kept for undo: the oldest steps are forgotten first. By default 32 MiB.
    pub undo: usize,
}

impl Default for OpenOptions {
    fn default() -> OpenOptions {
        OpenOptions { mark_unknown: false, undo: 32 << 20 }
    }
}

impl OpenOptions {
    /// The same with or without marks of unknown pixels.
    #[must_use]
    pub const fn with_mark_unknown(self, mark_unknown: bool) -> OpenOptions {
        OpenOptions { mark_unknown, ..self }
    }

    /// The same with so many bytes for undo.
    #[must_use]
    pub const fn with_undo(self, undo: usize) -> OpenOptions {
        OpenOptions { undo, ..self }
    }
}

/// A command that waits, with the frames that it needs.
#[derive(Clone, Debug)]
struct Waiting {
    step: u32,
    frames: Vec<usize>,
}

/// A clip of frames that can be read again: it is segmented, corrected, and read, from its opening to its closing.
///
/// A clip does not hold its frames, and does nothing by itself. [`apply`](Self::apply) takes a command; then the clip asks for the frames that
/// it [wants](Self::wanted), one after another: [`run`](Self::run) gives it all of them, and [`take`](Self::take) one. Labels of a frame are
/// known when the frame is [looked at](Self::look_at).
///
/// ```
/// use veronese::clip::{Annotation, Clip, Command, Content, OpenOptions};
/// use veronese::{Frame, SegmentOptions};
///
/// # fn main() -> veronese::Result<()> {
/// # let scene = scenes::generate(&scenes::SceneOptions { width: 160, height: 120, objects: 1, ..Default::default() })?;
/// # let frames = [scene.first().clone(), scene.second().clone()];
/// let mut clip = Clip::new(frames.len(), OpenOptions::default())?;
/// clip.apply(Command::Segment { frames: 0..2, options: SegmentOptions::default() })?;
/// let strokes = (0..160 * 120).map(|p| if p % 160 < 8 { 1 } else { 255 }).collect();
/// clip.apply(Command::Annotate(vec![Annotation::new(0, Content::Strokes { object: 7, labels: strokes })]))?;
/// clip.look_at(1);
/// while let Some(wanted) = clip.wanted() {
///     clip.take(wanted.frame, &frames[wanted.frame], None)?;
/// }
/// let after = clip.labels(1).expect("it is looked at");
/// assert!(after.objects.iter().any(|object| object.id == 7));
/// clip.undo();
/// assert!(clip.objects().iter().all(|object| object.number != 7));
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Clip {
    options: OpenOptions,
    history: History,
    /// Commands other than ranges, in the order in which they were given.
    waiting: VecDeque<Waiting>,
    running: Option<Running>,
    /// The records of the steps that have not taken effect, in ascending order of steps: of each its command, then the ends of its range. Labels
    /// take less memory so.
    given: Vec<(u32, Kind, Written)>,
    /// Ranges to segment; the first is under way.
    ranges: VecDeque<RangeJob>,
    /// Solved pairs of frames of ranges that are not complete.
    pairs: ByFrame<FramePairs>,
    /// The frame whose labels come before other work.
    looked_at: Option<usize>,
    /// Labels of frames that the command under way has changed.
    remembered: ByFrame<Shown>,
    /// The number of the next step.
    next: u32,
    log: Log,
    settled: Vec<Settled>,
    cancelled: Vec<StepId>,
    /// For each frame, whether its labels have changed.
    changed: Vec<bool>,
}

impl Clip {
    /// A clip of so many frames, without masks.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] for more than 2²⁰ frames.
    pub fn new(frames: usize, options: OpenOptions) -> Result<Clip> {
        if frames > MOST_FRAMES {
            let reason = format!("a clip has at most {MOST_FRAMES}, not {frames}");
            return Err(Error::InvalidOption { name: "frames", reason });
        }
        let mut log = Log::new();
        log.append(Kind::Open, &frames);
        Ok(Clip::of(frames, options, log))
    }

    fn of(frames: usize, options: OpenOptions, log: Log) -> Clip {
        Clip {
            options,
            history: History::new(SegmentedClip::empty(frames)),
            waiting: VecDeque::new(),
            running: None,
            given: Vec::new(),
            ranges: VecDeque::new(),
            pairs: vec![None; frames],
            looked_at: None,
            remembered: vec![None; frames],
            next: 1,
            log,
            settled: Vec::new(),
            cancelled: Vec::new(),
            changed: vec![false; frames],
        }
    }

    /// Number of frames.
    pub fn len(&self) -> usize {
        self.state().clip.len()
    }

    /// Whether there is no frame.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Width and height of the frames; 0 before any is segmented.
    pub fn size(&self) -> [usize; 2] {
        self.state().clip.size
    }

    /// Gives the clip something to do. Commands take effect in the order in which they are given; while a range is being segmented, other
    /// commands go first if all their frames have masks.
    ///
    /// # Errors
    /// [`Error::InvalidOption`], [`Error::ObjectLocked`]; nothing has changed then. A command that waits or needs frames can also fail later: see
    /// [`Settled`].
    pub fn apply(&mut self, command: Command) -> Result<StepId> {
        self.check(&command)?;
        let step = self.next;
        let mut content = Vec::new();
        (step as usize).write(&mut content);
        command.write(&mut content);
        let can_begin = !self.is_under_way() && self.waiting.is_empty();
        match command {
            command @ Command::Segment { .. } => self.wait(step, command)?,
            command if can_begin && self.is_ready(&command.frames()) => {
                self.running = Some(Running::new(step, &self.state().clip, command)?);
            }
            command => self.wait(step, command)?,
        }
        self.next += 1;
        self.note(step, Kind::Command, Written(content));
        self.advance();
        Ok(StepId(step))
    }

    /// Checks what does not depend on the commands before.
    fn check(&self, command: &Command) -> Result<()> {
        let invalid = |name, reason| Err(Error::InvalidOption { name, reason });
        let clip = &self.state().clip;
        if self.waiting.len() + self.ranges.len() >= MOST_WAITING {
            return invalid("command", format!("{MOST_WAITING} commands wait already"));
        }
        let frames = command.frames();
        frames.iter().try_for_each(|&frame| clip.check_index(frame))?;
        let is_coming = |frame: usize| self.ranges.iter().any(|range| range.frames.contains(&frame));
        let has_masks = |frame: usize| clip.frames[frame].found.is_some();
        if let Some(frame) = frames.into_iter().find(|&frame| !has_masks(frame) && !is_coming(frame)) {
            return invalid("frame", format!("frame {frame} has no masks: segment it first"));
        }
        // What waits is written in the journal, and has to be readable.
        command.check_sizes()?;
        match command {
            Command::Describe { object, .. } if !is_object(*object) => {
                invalid("object", format!("{object} is no number of an object: these are 1 to 254"))
            }
            _ => Ok(()),
        }
    }

    fn wait(&mut self, step: u32, command: Command) -> Result<()> {
        if let Command::Segment { frames, options } = command {
            self.ranges.push_back(RangeJob::new(step, frames, options, self.len())?);
            return Ok(());
        }
        let frames = command.frames();
        if frames.iter().any(|&frame| frame >= self.len()) {
            return Err(Error::InvalidOption { name: "frame", reason: "there is no such frame".into() });
        }
        self.waiting.push_back(Waiting { step, frames });
        Ok(())
    }

    /// Whether a command on some frames can begin: these frames have masks, or any if it is about objects alone.
    fn is_ready(&self, frames: &[usize]) -> bool {
        let all = &self.state().clip.frames;
        let has_masks = |frame: &FrameState| frame.found.is_some();
        match frames {
            [] => self.ranges.is_empty() || all.iter().any(has_masks),
            frames => frames.iter().all(|&frame| has_masks(&all[frame])),
        }
    }

    /// Takes over a clip that was [saved](Self::save), as one step: its masks, and everything that was annotated. Its own steps are left out.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] if the bytes are not those of a whole clip of as many frames, or if a command has not taken effect.
    pub fn restore(&mut self, saved: &[u8]) -> Result<StepId> {
        let invalid = |reason: String| Err(Error::InvalidOption { name: "saved", reason });
        if self.is_under_way() || !self.waiting.is_empty() || !self.ranges.is_empty() {
            return invalid("a command has not taken effect".into());
        }
        let Recovered { clip: mut other, used, .. } = Clip::read(saved, self.options)?;
        if used < saved.len() {
            return invalid("it is damaged or cut off".into());
        }
        if other.len() != self.len() {
            return invalid(format!("it is of a clip of {} frames, not {}", other.len(), self.len()));
        }
        let step = self.next;
        self.next += 1;
        let State { clip, remembered, .. } = other.history.current_mut().clone();
        self.remembered = remembered;
        self.commit(Running::of_state(step, clip));
        Ok(StepId(step))
    }

    /// Takes back: the last command that waits, or else the one under way, or else the last step. Returns whether there was one. A range that is
    /// being segmented goes on: [`cancel`](Self::cancel) and [`finish`](Self::finish) end it.
    pub fn undo(&mut self) -> bool {
        let last = self.waiting.back().map(|waiting| waiting.step);
        let running = self.running.as_ref().map(|running| running.step);
        let range = self.ranges.front().filter(|range| range.is_complete).map(|range| range.step);
        match last.or(running).or(range) {
            Some(step) => self.drop_step(step),
            None => self.go(true),
        }
    }

    /// Does again the step that was undone last. Returns whether there was one; there is none while a command is under way.
    pub fn redo(&mut self) -> bool {
        !self.is_under_way() && self.waiting.is_empty() && self.go(false)
    }

    /// Goes to the state before or after.
    fn go(&mut self, is_undo: bool) -> bool {
        let Some(step) = self.history.beside(is_undo) else { return false };
        let before = self.state().clip.clone();
        self.history.go_to(step);
        self.log.append(Kind::Current, &(step as usize));
        self.add_changed(&before);
        // Another frame beside the range under way may have masks now, or none.
        self.advance();
        true
    }

    /// Numbers of steps that can be undone and redone, and of commands that have not taken effect.
    pub fn steps(&self) -> [usize; 3] {
        let [undo, redo] = self.history.steps();
        [undo, redo, self.waiting.len() + usize::from(self.running.is_some()) + self.ranges.len()]
    }

    /// The last step that has taken effect, which [`undo`](Self::undo) takes back when no command waits or is under way.
    pub fn last_step(&self) -> Option<StepId> {
        let [undo, _] = self.history.steps();
        (undo > 0).then(|| StepId(self.state().step))
    }

    /// Cancels a step that has not taken effect. Solved pairs are kept. Returns whether there was such a step.
    pub fn cancel(&mut self, StepId(step): StepId) -> bool {
        self.drop_step(step)
    }

    fn drop_step(&mut self, step: u32) -> bool {
        let is_known = self.forget_waiting(step);
        if is_known {
            self.log.append(Kind::Dropped, &(step as usize));
            self.cancelled.push(StepId(step));
            self.advance();
        }
        is_known
    }

    fn forget_waiting(&mut self, step: u32) -> bool {
        self.waiting.retain(|waiting| waiting.step != step);
        self.ranges.retain(|range| range.step != step);
        if let Some(running) = self.running.take_if(|running| running.step == step) {
            for (index, changed) in self.changed.iter_mut().enumerate() {
                *changed |= running.has_changed(index);
            }
            self.remembered.fill(None);
        }
        self.forget_given(step)
    }

    /// Forgets the records of a step. Returns whether there were some.
    fn forget_given(&mut self, step: u32) -> bool {
        let before = self.given.len();
        self.given.retain(|(of, ..)| *of != step);
        self.given.len() < before
    }

    /// Ends a range after the frames that are in, for instance because the next one cannot be read. It fails if these are fewer than two. The
    /// frame before the range is still wanted if it has masks; a second call does without it.
    pub fn finish(&mut self, StepId(step): StepId) {
        if let Some(range) = self.ranges.iter_mut().find(|range| range.step == step) {
            let end = range.finish(None);
            self.note(step, Kind::Range, range_record(step, end, false));
            self.advance();
        }
    }

    /// The frame to take next, and what for; `None` when there is nothing to do.
    pub fn wanted(&self) -> Option<Wanted> {
        if let Some(frame) = self.looked_at.filter(|&frame| self.is_unknown(frame)) {
            return Some(Wanted { frame, stage: ClipStage::Labels, step: None });
        }
        if let Some(running) = &self.running {
            let step = Some(StepId(running.step));
            return running.wanted().map(|frame| Wanted { frame, stage: ClipStage::Annotations, step });
        }
        let range = self.ranges.front()?;
        let frame = range.wanted(&self.state().clip)?;
        Some(Wanted { frame, stage: ClipStage::Pairs, step: Some(StepId(range.step)) })
    }

    /// Gives the clip all frames that it [wants](Self::wanted), as `read` reads them.
    ///
    /// # Errors
    /// Those of `read` and of [`take`](Self::take). The clip then still wants that frame. A command that fails is no error here: see [`Settled`].
    pub fn run<E: From<Error>>(&mut self, mut read: impl FnMut(usize) -> Result<Frame, E>) -> Result<(), E> {
        while let Some(Wanted { frame, .. }) = self.wanted() {
            self.take(frame, &read(frame)?, None)?;
        }
        Ok(())
    }

    /// Takes a frame. One that is not [wanted](Self::wanted) changes nothing. `solved` are the pairs of the frame with the previous one, if
    /// [`solve_pair`](super::solve_pair) has solved them with the options of the range; others are not used.
    ///
    /// # Errors
    /// [`Error::FrameSizeMismatch`], and [`Error::OtherFrame`] for pixels that are not those that were segmented. The right frame can be taken
    /// after that.
    pub fn take(&mut self, index: usize, frame: &Frame, solved: Option<&FramePairs>) -> Result<()> {
        let Some(wanted) = self.wanted().filter(|wanted| wanted.frame == index) else { return Ok(()) };
        match wanted.stage {
            ClipStage::Labels => self.describe(index, frame)?,
            ClipStage::Annotations => {
                let Some(running) = &mut self.running else { return Ok(()) };
                match running.take(frame) {
                    Err(error @ (Error::FrameSizeMismatch { .. } | Error::OtherFrame { .. })) => return Err(error),
                    Err(error) => self.fail(error),
                    Ok(()) => self.changed[index] |= running.has_changed(index),
                }
            }
            ClipStage::Pairs => {
                let clip = &self.history.current().clip;
                let Some(range) = self.ranges.front_mut() else { return Ok(()) };
                if let Some(entry) = range.take(clip, frame, solved, self.pairs[index].as_deref())? {
                    self.log.append(Kind::Pairs, &entry);
                    self.pairs[entry.0] = Some(Arc::new(entry.1));
                }
            }
        }
        self.advance();
        Ok(())
    }

    fn state(&self) -> &State {
        self.history.current()
    }

    /// Goes on as far as no frame is needed: commands take effect, and the next ones begin.
    fn advance(&mut self) {
        loop {
            if let Some(running) = self.running.take_if(|running| running.wanted().is_none()) {
                self.commit(running);
            } else if self.running.is_some() {
                return;
            } else if self.waiting.front().is_some_and(|waiting| self.is_ready(&waiting.frames))
                && !self.has_complete_range()
            {
                if let Some(Waiting { step, .. }) = self.waiting.pop_front() {
                    let damaged = Error::InvalidOption { name: "command", reason: "it is damaged".into() };
                    let begun = self.command(step).ok_or(damaged);
                    self.begin(step, begun.and_then(|command| Running::new(step, &self.state().clip, command)));
                }
            } else if self.ranges.front().is_some_and(|range| range.wanted(&self.state().clip).is_none())
                && let Some(range) = self.ranges.pop_front()
            {
                if !range.is_complete {
                    self.note(range.step, Kind::Range, range_record(range.step, range.frames.end, true));
                }
                self.begin(range.step, Running::of_range(range, &self.state().clip));
            } else if self.ranges.is_empty()
                && let Some(Waiting { step, frames }) = self.waiting.pop_front()
            {
                let frame = frames.into_iter().find(|&frame| !self.is_ready(&[frame])).unwrap_or(0);
                let reason = format!("frame {frame} has no masks: segment it first");
                self.begin(step, Err(Error::InvalidOption { name: "frame", reason }));
            } else {
                return;
            }
        }
    }

    fn has_complete_range(&self) -> bool {
        self.ranges.front().is_some_and(|range| range.is_complete)
    }

    /// Whether a step is taking effect. A range that was complete when the journal ended does so once its frames have been taken again.
    fn is_under_way(&self) -> bool {
        self.running.is_some() || self.has_complete_range()
    }

    fn begin(&mut self, step: u32, begun: Result<Running>) {
        match begun {
            Ok(running) => self.running = Some(running),
            Err(error) => self.failed(step, error),
        }
    }

    /// Ends the command under way, which has changed nothing.
    fn fail(&mut self, error: Error) {
        let Some(step) = self.running.as_ref().map(|running| running.step) else { return };
        self.forget_waiting(step);
        self.failed(step, error);
    }

    fn failed(&mut self, step: u32, error: Error) {
        self.forget_given(step);
        self.log.append(Kind::Dropped, &(step as usize));
        self.settled.push(Settled { step: StepId(step), changes: Err(error) });
    }

    /// Makes the copy on which a command has taken effect the state. A command that has changed nothing is no step.
    fn commit(&mut self, mut running: Running) {
        let step = running.step;
        if let Some(range) = &running.range {
            self.pairs[range.clone()].fill(None);
        }
        self.forget_given(step);
        running.clip.mark_used();
        let changes = running.changes();
        let before = self.state();
        let joined = (running.joins && before.is_open).then(|| self.history.before()).flatten();
        let parent = joined.unwrap_or(before);
        let is_same = Difference::between(&before.clip, &mut running.clip).is_empty();
        let (parent, difference) = (parent.step, Difference::between(&parent.clip, &mut running.clip));
        let before_clip = before.clip.clone();
        let mut remembered = before.remembered.clone();
        for (of, newer) in remembered.iter_mut().zip(&mut self.remembered) {
            *of = newer.take().or(of.take());
        }
        if is_same {
            self.log.append(Kind::Dropped, &(step as usize));
            self.history.current_mut().remembered = remembered;
        } else {
            let is_open = running.range.is_none();
            let content = result(step, parent, &difference, is_open, false);
            let bytes = content.0.len();
            self.log.append(Kind::Result, &content);
            self.history.push(parent, State::new(step, running.clip, remembered, is_open, bytes));
            self.history.forget(self.options.undo);
            self.add_changed(&before_clip);
        }
        self.settled.push(Settled { step: StepId(step), changes: Ok(changes) });
    }

    /// Adds the frames whose labels differ from those of a state before.
    fn add_changed(&mut self, before: &SegmentedClip) {
        let now = &self.history.current().clip;
        for (index, changed) in self.changed.iter_mut().enumerate() {
            *changed |= before.key(index, false) != now.key(index, false);
        }
    }
}
