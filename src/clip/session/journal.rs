//! The journal of a clip: what is written, when it is compacted, and how a clip is read from it.

use std::sync::Arc;

use super::events::Events;
use super::history::{Difference, History, State};
use super::log::{Kind, Log, Reader, Written, result};
use super::shown::Shown;
use super::{Clip, MOST_FRAMES, OpenOptions};
use crate::clip::command::Command;
use crate::clip::saved::Saved;
use crate::clip::segmented_clip::SegmentedClip;
use crate::error::{Error, Result};

/// A log that has grown by so many bytes, and to twice its size, since it was compacted is compacted again.
const GROWTH: usize = 1 << 20;

/// A [`Clip`] that was read from a journal.
#[non_exhaustive]
#[derive(Debug)]
pub struct Recovered {
    /// The clip.
    pub clip: Clip,
    /// Number of bytes that were read. What follows was not written completely, or is damaged, and has to be cut off before more is appended.
    pub used: usize,
    /// Whether what follows is damaged: steps that had been kept are lost.
    pub is_damaged: bool,
}

impl Clip {
    /// A clip from its journal, or from what [`save`](Self::save) gave. Steps whose result the journal does not have wait, and take effect
    /// again. Reading ends at the first record that is cut off or damaged.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] for bytes that are no journal of a clip.
    pub fn read(bytes: &[u8], options: OpenOptions) -> Result<Recovered> {
        let reason = "it is no journal of a clip, or of another version".into();
        let other = || Error::InvalidOption { name: "saved", reason };
        let Some(mut reader) = Reader::new(bytes) else { return Err(other()) };
        let Some((Kind::Open, mut content)) = reader.next() else { return Err(other()) };
        let Some(frames) = usize::read(&mut content).filter(|&frames| frames <= MOST_FRAMES) else {
            return Err(other());
        };
        let mut clip = Clip::of(frames, options, Log::new());
        let mut is_damaged = false;
        loop {
            let before = reader.hash();
            let Some((kind, content)) = reader.next() else { break };
            if clip.replay(kind, content).is_none() {
                reader.refuse(content, before);
                is_damaged = true;
                break;
            }
        }
        clip.history.forget(options.undo);
        clip.log = Log::after(&reader, clip.history.bytes());
        clip.advance();
        clip.changed.fill(false);
        Ok(Recovered { clip, used: reader.used, is_damaged: is_damaged || reader.is_damaged() })
    }

    /// Applies a record; `None` if it is not valid.
    fn replay(&mut self, kind: Kind, content: &[u8]) -> Option<()> {
        let mut rest = content;
        let bytes = &mut rest;
        match kind {
            Kind::Open => return None,
            Kind::Pairs => {
                let (frame, pairs) = Saved::read(bytes)?;
                *self.pairs.get_mut::<usize>(frame)? = Some(pairs);
            }
            Kind::Command => {
                let step: usize = Saved::read(bytes)?;
                let command = Command::read(bytes)?;
                self.note_step(step)?;
                self.history.after(step as u32).is_none().then_some(())?;
                self.given.iter().all(|(of, ..)| *of as usize != step).then_some(())?;
                self.wait(step as u32, command).ok()?;
                self.keep(step as u32, kind, Written(content.to_vec()));
            }
            Kind::Result => {
                let ([step, parent], difference): ([usize; 2], Difference) = Saved::read(bytes)?;
                let [is_open, is_first]: [bool; 2] = Saved::read(bytes)?;
                let parent = if is_first { 0 } else { parent as u32 };
                (is_first || self.history.after(step as u32).is_none()).then_some(())?;
                let before = self.history.after(parent)?;
                let remembered = before.remembered.clone();
                let segmented: Vec<usize> = difference.segmented().collect();
                let clip = difference.applied(&before.clip)?;
                let state = State::new(step as u32, clip, remembered, is_open, content.len());
                self.forget_waiting(step as u32);
                segmented.iter().for_each(|&frame| self.pairs[frame] = None);
                self.note_step(step)?;
                match is_first {
                    true => self.history = History::first(state),
                    false => self.history.push(parent, state),
                }
            }
            Kind::Current => {
                let step: usize = Saved::read(bytes)?;
                self.history.go_to(step as u32).then_some(())?;
            }
            Kind::Dropped => {
                let step: usize = Saved::read(bytes)?;
                // A range whose frames have all been in has found what was there.
                let complete = self.ranges.iter().find(|range| range.step as usize == step && range.is_complete);
                if let Some(range) = complete {
                    self.pairs[range.frames.clone()].fill(None);
                }
                self.forget_waiting(step as u32);
            }
            Kind::Range => {
                let ([step, end], is_complete) = Saved::read(bytes)?;
                let range = self.ranges.iter_mut().find(|range| range.step as usize == step)?;
                match is_complete {
                    true => range.is_complete = true,
                    false => drop(range.finish(Some(end))),
                }
                self.keep(step as u32, kind, Written(content.to_vec()));
            }
            Kind::Shown => {
                let (frame, shown): (usize, Shown) = Saved::read(bytes)?;
                let state = self.history.current_mut();
                state.clip.frames.get(frame)?.found.as_ref()?;
                let [width, height] = state.clip.size;
                shown.is_valid(width * height).then_some(())?;
                state.remembered[frame] = Some(Arc::new(shown));
            }
        }
        bytes.is_empty().then_some(())
    }

    /// The next step follows one that was read.
    fn note_step(&mut self, step: usize) -> Option<()> {
        let step = u32::try_from(step).ok().filter(|&step| step < u32::MAX / 2)?;
        self.next = self.next.max(step + 1);
        Some(())
    }

    /// What has happened since the last call.
    pub fn take_events(&mut self) -> Events {
        let is_idle = self.running.is_none() && self.waiting.is_empty() && self.ranges.is_empty();
        if is_idle && self.log.length > 2 * self.log.compacted + GROWTH {
            let compacted = self.compacted();
            self.log.replace(compacted);
        }
        let (records, replaces) = self.log.take();
        let frames = (0..self.len()).filter(|&index| std::mem::take(&mut self.changed[index])).collect();
        let (settled, cancelled) = (std::mem::take(&mut self.settled), std::mem::take(&mut self.cancelled));
        Events { records, replaces, frames, settled, cancelled }
    }

    /// The bytes of this clip, for [`read`](Self::read): its states, what waits, and all labels that are known.
    pub fn save(&self) -> Vec<u8> {
        self.compacted().take().0
    }

    fn compacted(&self) -> Log {
        let mut log = Log::with_capacity(self.history.bytes());
        log.append(Kind::Open, &self.len());
        let empty = SegmentedClip::empty(self.len());
        let mut before = (0, &empty);
        for (k, state) in self.history.states().iter().enumerate() {
            let difference = Difference::between(before.1, &mut state.clip.clone());
            log.append(Kind::Result, &result(state.step, before.0, &difference, state.is_open, k == 0));
            before = (state.step, &state.clip);
        }
        let current = self.state();
        log.append(Kind::Current, &(current.step as usize));
        for (index, shown) in current.remembered.iter().enumerate() {
            if let Some(shown) = shown
                && shown.key == current.clip.key(index, self.options.mark_unknown)
            {
                log.append(Kind::Shown, &(index, shown.clone()));
            }
        }
        for (index, pairs) in self.pairs.iter().enumerate() {
            if let Some(pairs) = pairs {
                log.append(Kind::Pairs, &(index, pairs.clone()));
            }
        }
        self.given.iter().for_each(|(_, kind, content)| log.append(*kind, content));
        log
    }

    /// Writes a record of a step that has not taken effect.
    pub(super) fn note(&mut self, step: u32, kind: Kind, content: Written) {
        self.log.append(kind, &content);
        self.keep(step, kind, content);
    }

    fn keep(&mut self, step: u32, kind: Kind, content: Written) {
        let at = self.given.partition_point(|(of, ..)| *of <= step);
        self.given.insert(at, (step, kind, content));
    }

    /// The command of a step that has not taken effect.
    pub(super) fn command(&self, step: u32) -> Option<Command> {
        let (.., Written(content)) = self.given.iter().find(|(of, ..)| *of == step)?;
        let (_, command): (usize, Command) = Saved::read(&mut &content[..])?;
        Some(command)
    }
}
