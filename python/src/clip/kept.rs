//! A clip, kept in a thread of its own.

use veronese::clip::{
    Annotations, Changed, ClipFrame, ClipJob, ClipOptions, ClipSegmenter, SegmentedClip, StreamSegmenter,
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
        /// The job of annotations, and the clip before.
        job: Option<(ClipJob, SegmentedClip)>,
        /// Whether it was restored from bytes.
        restored: bool,
    },
}

/// A clip of which every frame is known.
pub(crate) struct Summary {
    pub(crate) length: usize,
    pub(crate) size: [usize; 2],
    pub(crate) dropped: usize,
}

/// How far annotations have taken effect.
pub(crate) enum Step {
    /// The frame that is needed next.
    Wants(usize),
    /// The frames that have changed, and what objects have gained and lost.
    Done(Vec<usize>, Vec<Changed>),
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
        *self = Kept::Segmented { clip, job: None, restored };
        summary
    }

    /// Frames that are not those of a restored state are an error of the state.
    pub(crate) fn segmented<R>(
        &mut self,
        work: impl FnOnce(&mut SegmentedClip) -> veronese::Result<R>,
    ) -> Result<R, Failure> {
        match self {
            Kept::Segmented { clip, restored, .. } => work(clip).map_err(|error| failure_of(error, *restored)),
            _ => Err(ended()),
        }
    }

    /// Begins to apply annotations.
    pub(crate) fn annotate(&mut self, annotations: Annotations) -> Result<Step, Failure> {
        match self {
            Kept::Segmented { clip, job, .. } => {
                *job = None;
                let before = clip.clone();
                let (begun, _) = job.insert((clip.annotate(annotations)?, before));
                Ok(step(begun))
            }
            _ => Err(ended()),
        }
    }

    /// Takes the frame that is wanted.
    pub(crate) fn take(&mut self, frame: &Frame) -> Result<Step, Failure> {
        let Kept::Segmented { clip, job: Some((job, _)), restored } = self else { return Err(ended()) };
        job.take(clip, frame).map_err(|error| failure_of(error, *restored))?;
        Ok(step(job))
    }

    /// Ends the last annotations: they are kept or undone.
    pub(crate) fn settle(&mut self, holds: bool) {
        if let Kept::Segmented { clip, job, .. } = self
            && let Some((_, before)) = job.take()
            && !holds
        {
            *clip = before;
        }
    }
}

fn step(job: &ClipJob) -> Step {
    match job.wanted() {
        Some(index) => Step::Wants(index),
        None => Step::Done(job.changed().to_vec(), job.changes()),
    }
}

fn failure_of(error: Error, restored: bool) -> Failure {
    match error {
        Error::OtherFrame { .. } if restored => Failure::option("state", &error.to_string()),
        error => error.into(),
    }
}

fn ended() -> Failure {
    Failure::input("the clip has ended".into())
}
