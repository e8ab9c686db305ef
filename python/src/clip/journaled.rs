//! A clip and its journal, in the thread that keeps both. Records are in the journal before a call returns.

use std::path::PathBuf;

use veronese::Frame;
use veronese::clip::{
    Changed, Clip, ClipFrame, ClipStage, Command, Events, OpenOptions, Recovered, Settled, StepId, Wanted,
};

use crate::clip::journal::Journal;
use crate::errors::Failure;

pub(crate) struct JournaledClip {
    pub(crate) clip: Clip,
    pub(crate) journal: Option<Journal>,
    /// The step of the call under way, and whether it segments.
    step: Option<(StepId, bool)>,
    settled: Vec<Settled>,
}

impl JournaledClip {
    /// A clip of so many frames: a new one, or what was saved or is in the journal. Returns it with a sentence about what could not be read.
    pub(crate) fn open(
        frames: usize,
        saved: Option<&[u8]>,
        journal: Option<PathBuf>,
        options: OpenOptions,
    ) -> Result<(JournaledClip, Option<String>), Failure> {
        let (mut journal, content) = journal.map(Journal::open).transpose()?.unzip();
        let content = content.filter(|content| !content.is_empty());
        let mut warning = None;
        let clip = match (&content, saved) {
            (Some(_), Some(_)) => {
                return Err(Failure::option("saved", "the journal has a clip already: give one of the two"));
            }
            (Some(content), None) => {
                let Recovered { clip, used, is_damaged, .. } = recovered("journal", content, frames, options)?;
                if let Some(journal) = &mut journal {
                    warning = journal.cut(content, used, is_damaged)?;
                }
                clip
            }
            (None, Some(saved)) => {
                let Recovered { clip, used, .. } = recovered("saved", saved, frames, options)?;
                if used < saved.len() {
                    return Err(Failure::option("saved", "it is damaged or cut off"));
                }
                if let Some(journal) = &mut journal {
                    journal.write(saved, true)?;
                }
                clip
            }
            (None, None) => Clip::new(frames, options)?,
        };
        let mut kept = JournaledClip { clip, journal, step: None, settled: Vec::new() };
        kept.keep()?;
        Ok((kept, warning))
    }

    /// Does something with the clip, and keeps what that has done.
    pub(crate) fn with<R>(&mut self, work: impl FnOnce(&mut Clip) -> R) -> Result<R, Failure> {
        let done = work(&mut self.clip);
        self.keep()?;
        Ok(done)
    }

    /// Writes to the journal what has happened. At the end of all work it waits until that is kept.
    fn keep(&mut self) -> Result<(), Failure> {
        let Events { records, replaces, settled, .. } = self.clip.take_events();
        self.settled.extend(settled);
        let Some(journal) = &mut self.journal else { return Ok(()) };
        journal.write(&records, replaces)?;
        if self.clip.wanted().is_none() { journal.sync() } else { Ok(()) }
    }

    /// Begins a step.
    pub(crate) fn apply(&mut self, command: Command) -> Result<(), Failure> {
        self.settled.clear();
        let segments = matches!(command, Command::Segment { .. });
        self.step = Some((self.clip.apply(command)?, segments));
        self.keep()
    }

    /// The frame that is wanted. A range that another process has begun is not gone on with, but its solved pairs are kept.
    pub(crate) fn wanted(&mut self) -> Result<Option<Wanted>, Failure> {
        while let Some(Wanted { stage: ClipStage::Pairs, step: Some(step), .. }) = self.clip.wanted()
            && self.step.is_none_or(|(own, _)| own != step)
        {
            self.with(|clip| clip.cancel(step))?;
        }
        Ok(self.clip.wanted())
    }

    /// Cancels everything that is under way or waits.
    pub(crate) fn cancel_all(&mut self) -> Result<(), Failure> {
        while let Some(step) = self.clip.wanted().and_then(|wanted| wanted.step) {
            self.with(|clip| clip.cancel(step))?;
        }
        Ok(())
    }

    /// Takes a frame that is wanted.
    pub(crate) fn take(&mut self, index: usize, frame: &Frame) -> Result<(), Failure> {
        let taken = self.with(|clip| clip.take(index, frame, None))?;
        taken.map_err(|error| of_frame(index, error))
    }

    /// The end of the step under way: what has changed, or why nothing has.
    pub(crate) fn outcome(&mut self) -> Result<Vec<Changed>, Failure> {
        let own = self.step.take();
        let settled =
            std::mem::take(&mut self.settled).into_iter().find(|of| own.is_some_and(|(step, _)| of.step == step));
        Ok(settled.map_or(Ok(Vec::new()), |settled| settled.changes)?)
    }

    /// Takes back the step under way. Masks of a range that are complete stay.
    pub(crate) fn take_back(&mut self) {
        let Some((step, segments)) = self.step.take() else { return };
        // What cannot be written now is written later.
        let _ = self.with(|clip| {
            if !clip.cancel(step) && !segments && clip.last_step() == Some(step) {
                clip.undo();
            }
        });
    }

    /// Whether a frame has masks whose labels are not known.
    pub(crate) fn needs(&mut self, index: usize) -> bool {
        self.clip.look_at(index);
        let needs = self.clip.wanted().is_some_and(|wanted| wanted.stage == ClipStage::Labels);
        self.clip.look_at(None);
        needs
    }

    /// The labels of a frame as far as they are known.
    pub(crate) fn labels(&mut self, index: usize) -> Result<Option<ClipFrame>, Failure> {
        let length = self.clip.len();
        if index >= length {
            let reason = format!("there is no frame {index} in a clip of {length} frames");
            return Err(Failure::option("frame", &reason));
        }
        let known = self.clip.labels(index);
        if known.is_none() && !self.needs(index) {
            return Err(Failure::option("frame", &format!("frame {index} has no masks: segment it first")));
        }
        Ok(known)
    }

    /// The labels of a frame with masks.
    pub(crate) fn labels_of(&mut self, index: usize, frame: &Frame) -> Result<ClipFrame, Failure> {
        self.clip.look_at(index);
        let taken = self.take(index, frame);
        self.clip.look_at(None);
        taken?;
        self.clip.labels(index).ok_or_else(|| Failure::internal(format!("the labels of frame {index} are not there")))
    }
}

fn recovered(name: &str, bytes: &[u8], frames: usize, options: OpenOptions) -> Result<Recovered, Failure> {
    let recovered =
        Clip::read(bytes, options).map_err(|_| Failure::option(name, "it is no clip, or of another version"))?;
    match recovered.clip.len() {
        found if found == frames => Ok(recovered),
        found => Err(Failure::option(name, &format!("it is of a clip of {found} frames, not {frames}"))),
    }
}

/// An error with the frame that it is about.
fn of_frame(index: usize, error: veronese::Error) -> Failure {
    match error {
        veronese::Error::OtherFrame { .. } => error.into(),
        error => Failure::from(error).about(&format!("frame {index}")),
    }
}
