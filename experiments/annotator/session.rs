//! A clip that is corrected, and what that takes.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use veronese::clip::{ClipOptions, ClipSegmenter, SegmentedClip};
use veronese::{Frame, Quality, Result, SegmentOptions};

use crate::Failure;

/// A segmented clip at hand, with the labels of every frame as they are now.
#[derive(Clone)]
pub(crate) struct Session<'a> {
    frames: &'a [Frame],
    clip: SegmentedClip,
    pub(crate) labels: Vec<Vec<u8>>,
    /// What corrections took so far.
    pub(crate) effort: Effort,
}

/// Work of the segmenter on corrections.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Effort {
    pub(crate) time: Duration,
    /// Frames changed, counted for each correction.
    pub(crate) frames: usize,
}

impl Effort {
    /// Milliseconds of a frame that changed.
    pub(crate) fn per_frame(&self) -> f64 {
        1e3 * self.time.as_secs_f64() / self.frames.max(1) as f64
    }
}

impl<'a> Session<'a> {
    /// The clip as it is segmented when nothing is said. It is kept in the file `state`, and taken from there if it is of these frames
    /// and this version, because it takes minutes where corrections take seconds.
    pub(crate) fn open(
        frames: &'a [Frame],
        quality: Quality,
        state: &Path,
    ) -> std::result::Result<Session<'a>, Failure> {
        let kept =
            fs::read(state).ok().and_then(|bytes| Session::of(frames, SegmentedClip::from_bytes(&bytes).ok()?).ok());
        if let Some(session) = kept {
            return Ok(session);
        }
        let pair = SegmentOptions { quality, ..SegmentOptions::default() };
        let mut segmenter = ClipSegmenter::new(ClipOptions { pair, ..ClipOptions::default() })?;
        for frame in frames {
            segmenter.push(frame.clone())?;
        }
        let clip = segmenter.conclude();
        fs::write(state, clip.to_bytes())?;
        Ok(Session::of(frames, clip)?)
    }

    fn of(frames: &'a [Frame], clip: SegmentedClip) -> Result<Session<'a>> {
        let mut session = Session { frames, clip, labels: Vec::new(), effort: Effort::default() };
        session.look()?;
        Ok(session)
    }

    fn look(&mut self) -> Result<()> {
        let labels = |(index, frame)| Ok(self.clip.frame(index, frame)?.labels);
        self.labels = self.frames.iter().enumerate().map(labels).collect::<Result<_>>()?;
        Ok(())
    }

    /// Corrects a frame and lets that spread through the clip.
    pub(crate) fn correct(&mut self, index: usize, said: &[u8]) -> Result<()> {
        let start = Instant::now();
        let mut correction = self.clip.correct(index, said, veronese::clip::Spread::Both)?;
        while let Some(wanted) = correction.wanted() {
            correction.take(&mut self.clip, &self.frames[wanted])?;
        }
        self.effort.time += start.elapsed();
        self.effort.frames += correction.changed().len();
        self.look()
    }
}
