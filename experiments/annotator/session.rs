//! A clip that is corrected, and what that takes.
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use experiments::Failure;
use veronese::clip::{
    Accepted, Annotations, ClipJob, ClipOptions, ClipSegmenter, FramePairs, Painted, Prompt, SegmentedClip, Spread,
};
use veronese::{Frame, Quality, Result, SegmentOptions};

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
    /// The clip as it is segmented when nothing is said. What its pairs told is kept in the folder `pairs`, and taken from there if it is
    /// of these frames and this version: it takes minutes, all the rest seconds.
    pub(crate) fn open(
        frames: &'a [Frame],
        quality: Quality,
        pairs: &Path,
    ) -> std::result::Result<Session<'a>, Failure> {
        let pair = SegmentOptions::default().with_quality(quality);
        let mut segmenter = ClipSegmenter::new(ClipOptions::default().with_pair(pair))?;
        fs::create_dir_all(pairs)?;
        for (index, frame) in frames.iter().enumerate() {
            let file = pairs.join(index.to_string());
            let known = fs::read(&file).ok().and_then(|bytes| FramePairs::from_bytes(&bytes).ok());
            if known.is_none_or(|known| segmenter.push_known(frame.clone(), &known).is_err()) {
                fs::write(file, segmenter.push(frame.clone())?.to_bytes())?;
            }
        }
        let mut session = Session { frames, clip: segmenter.conclude(), labels: Vec::new(), effort: Effort::default() };
        session.look()?;
        Ok(session)
    }

    fn look(&mut self) -> Result<()> {
        let labels = |(index, frame)| Ok(self.clip.frame(index, frame)?.labels);
        self.labels = self.frames.iter().enumerate().map(labels).collect::<Result<_>>()?;
        Ok(())
    }

    /// Paints a frame, and lets that spread through the clip.
    pub(crate) fn paint(&mut self, frame: usize, labels: &[u8]) -> Result<()> {
        let painted = Painted { frame, object: None, labels: labels.to_vec(), spread: Spread::Both };
        let start = Instant::now();
        let job = self.clip.annotate(Annotations { corrections: vec![painted], ..Annotations::default() })?;
        self.effort.time += start.elapsed();
        self.spread(job)
    }

    /// Accepts frames as they are.
    pub(crate) fn accept(&mut self, frames: &[usize]) -> Result<()> {
        let accepted = Some(frames.iter().map(|&frame| Accepted { frame, labels: None }).collect());
        let job = self.clip.annotate(Annotations { accepted, ..Annotations::default() })?;
        self.spread(job)
    }

    /// Points to an object, and lets that spread through the clip. Returns what the frame shows at once, and how long that took.
    pub(crate) fn point(&mut self, prompt: Prompt) -> Result<(Vec<u8>, Duration)> {
        let index = prompt.frame;
        let start = Instant::now();
        let mut job = self.clip.annotate(Annotations { prompts: vec![prompt], ..Annotations::default() })?;
        if job.wanted() == Some(index) {
            job.take(&mut self.clip, &self.frames[index])?;
        }
        let took = start.elapsed();
        self.effort.time += took;
        let labels = self.clip.frame(index, &self.frames[index])?.labels;
        self.spread(job)?;
        Ok((labels, took))
    }

    fn spread(&mut self, mut job: ClipJob) -> Result<()> {
        let start = Instant::now();
        while let Some(wanted) = job.wanted() {
            job.take(&mut self.clip, &self.frames[wanted])?;
        }
        self.effort.time += start.elapsed();
        self.effort.frames += job.changed().len();
        self.look()
    }
}
