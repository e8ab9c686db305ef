//! What there is of a clip, kept in a thread of its own.

use veronese::clip::{
    ClipCorrection, ClipFrame, ClipOptions, ClipSegmenter, Prompt, SegmentedClip, Spread, StreamSegmenter,
};
use veronese::{Error, Frame};

use crate::errors::Failure;

#[derive(Default)]
pub(crate) enum Kept {
    #[default]
    Nothing,
    Stream(StreamSegmenter),
    Pairs(ClipSegmenter),
    Segmented {
        clip: SegmentedClip,
        correction: Option<ClipCorrection>,
        /// Whether it came as bytes.
        restored: bool,
    },
}

/// A clip of which every frame is known.
pub(crate) struct Summary {
    pub(crate) length: usize,
    pub(crate) size: [usize; 2],
    pub(crate) dropped: usize,
}

/// A step of a correction: the frame that it wants next, and those that it has changed.
pub(crate) struct Step {
    pub(crate) wanted: Option<usize>,
    pub(crate) changed: Vec<usize>,
}

impl Kept {
    pub(crate) fn begin(&mut self, whole: bool, options: ClipOptions) -> Result<(), Failure> {
        *self = if whole {
            Kept::Pairs(ClipSegmenter::new(options)?)
        } else {
            Kept::Stream(StreamSegmenter::new(options)?)
        };
        Ok(())
    }

    /// A frame of a stream that has waited long enough, if there is one.
    pub(crate) fn push(&mut self, frame: Frame) -> Result<Option<ClipFrame>, Failure> {
        match self {
            Kept::Stream(stream) => Ok(stream.push(frame)?),
            Kept::Pairs(segmenter) => {
                segmenter.push(frame)?;
                Ok(None)
            }
            _ => Err(ended()),
        }
    }

    /// The frames of a stream that still wait, and the number of objects beyond the last number.
    pub(crate) fn finish(&mut self) -> Result<(Vec<ClipFrame>, usize), Failure> {
        match std::mem::take(self) {
            Kept::Stream(mut stream) => Ok((stream.finish(), stream.dropped())),
            _ => Err(ended()),
        }
    }

    pub(crate) fn conclude(&mut self) -> Result<Summary, Failure> {
        match std::mem::take(self) {
            Kept::Pairs(segmenter) => Ok(self.keep(segmenter.conclude(), false)),
            _ => Err(ended()),
        }
    }

    pub(crate) fn restore(&mut self, state: &[u8], mark_unknown: bool) -> Result<Summary, Failure> {
        let mut clip = SegmentedClip::from_bytes(state)?;
        clip.mark_unknown(mark_unknown);
        Ok(self.keep(clip, true))
    }

    fn keep(&mut self, clip: SegmentedClip, restored: bool) -> Summary {
        let summary = Summary { length: clip.len(), size: clip.size(), dropped: clip.dropped() };
        *self = Kept::Segmented { clip, correction: None, restored };
        summary
    }

    /// Frames that are not those of a state are the state's fault.
    pub(crate) fn segmented<R>(
        &mut self,
        work: impl FnOnce(&mut SegmentedClip) -> veronese::Result<R>,
    ) -> Result<R, Failure> {
        match self {
            Kept::Segmented { clip, restored, .. } => work(clip).map_err(|error| told(error, *restored)),
            _ => Err(ended()),
        }
    }

    /// What is to be said of a frame when an object is where a prompt points to.
    pub(crate) fn outline(
        &mut self,
        index: usize,
        frame: &Frame,
        prompt: Prompt,
        object: u8,
    ) -> Result<Vec<u8>, Failure> {
        self.segmented(|clip| clip.outline(index, frame, prompt, object))
    }

    /// Begins a correction, which wants the frame first.
    pub(crate) fn correct(&mut self, index: usize, labels: &[u8], spread: Spread) -> Result<(), Failure> {
        match self {
            Kept::Segmented { clip, correction, .. } => {
                *correction = Some(clip.correct(index, labels, spread)?);
                Ok(())
            }
            _ => Err(ended()),
        }
    }

    pub(crate) fn take(&mut self, frame: &Frame) -> Result<Step, Failure> {
        let Kept::Segmented { clip, correction: Some(correction), restored } = self else { return Err(ended()) };
        let known = correction.changed().len();
        correction.take(clip, frame).map_err(|error| told(error, *restored))?;
        Ok(Step { wanted: correction.wanted(), changed: correction.changed()[known..].to_vec() })
    }

    /// Takes back what a correction has changed so far.
    pub(crate) fn cancel(&mut self) {
        if let Kept::Segmented { clip, correction, .. } = self
            && let Some(correction) = correction.take()
        {
            correction.cancel(clip);
        }
    }
}

fn told(error: Error, restored: bool) -> Failure {
    match error {
        Error::OtherFrame { .. } if restored => Failure::option("state", &error.to_string()),
        error => error.into(),
    }
}

fn ended() -> Failure {
    Failure::input("the clip has ended".into())
}
