//! Segmentation of a whole clip, frame by frame.

use super::description::{ClipFrame, WorkingFrame};
use super::frame_state::FrameState;
use super::grouping::Census;
use super::identity::{Identities, Parting};
use super::options::ClipOptions;
use super::pairs::{KeptPairs, Pairs};
use super::parting::divide;
use super::runs::Runs;
use super::saved::{Format, saved};
use super::segmented_clip::SegmentedClip;
use super::tracker::{PreviewSource, Tracker};
use crate::error::{Error, Result};
use crate::frame::Frame;
use crate::hash::hash;
use crate::options::{MotionCount, Quality, SegmentOptions};

/// Segments a whole clip. Frames go in one after another; [`conclude`](Self::conclude) gives the segmented clip.
///
/// ```
/// use veronese::clip::{ClipOptions, ClipSegmenter};
///
/// # fn main() -> veronese::Result<()> {
/// # let scene = scenes::generate(&scenes::SceneOptions { width: 160, height: 120, objects: 1, ..Default::default() })?;
/// # let frames = [scene.first(), scene.second()];
/// let mut segmenter = ClipSegmenter::new(ClipOptions::default())?;
/// for frame in frames {
///     segmenter.push(frame.clone())?;
/// }
/// let clip = segmenter.conclude();
/// let first = clip.frame(0, frames[0])?;
/// assert_eq!(first.labels.len(), 160 * 120);
/// assert_eq!(first.objects[0].id, 1);
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct ClipSegmenter {
    tracker: Tracker,
    frames: Vec<FrameState>,
    /// The hash of every frame so far.
    hashes: Vec<u64>,
    /// The hash of the options.
    options: u64,
    /// The hash of everything that determines the pairs of the newest frame.
    origin: u64,
    /// The objects of the previews, and the index of the last one.
    previews: (Identities, Option<usize>),
}

/// The solved pairs of a frame with the previous one: nearly all the work of [`ClipSegmenter::push`].
///
/// An interrupted clip can be continued: [`ClipSegmenter::push_known`] does not solve the frame's pairs again. Without a look-ahead, pairs
/// depend only on the two frames and the options, so that several segmenters can each solve a part of a clip for another one.
#[derive(Clone, Debug)]
pub struct FramePairs {
    origin: u64,
    pairs: KeptPairs,
}

saved!(FramePairs { origin, pairs });

const PAIRS: Format = Format { name: "pairs", mark: concat!("VERPAIR5 ", env!("CARGO_PKG_VERSION"), "\n") };

impl FramePairs {
    /// The bytes of these pairs, for [`from_bytes`](Self::from_bytes) of the same version.
    pub fn to_bytes(&self) -> Vec<u8> {
        PAIRS.written(self)
    }

    /// Pairs from their bytes.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] for bytes of another version and damaged ones.
    pub fn from_bytes(bytes: &[u8]) -> Result<FramePairs> {
        PAIRS.read(bytes)
    }
}

impl ClipSegmenter {
    /// A segmenter for one clip.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] for a look-ahead above [`MAX_LOOK_AHEAD`](super::MAX_LOOK_AHEAD) or a number of motions out of range.
    pub fn new(options: ClipOptions) -> Result<ClipSegmenter> {
        let tracker = Tracker::new(options, false)?;
        // The options that determine how pairs are solved.
        let ClipOptions { pair: SegmentOptions { motions, quality, subject, .. }, look_ahead } = *tracker.options();
        let motions = if let MotionCount::Given(motions) = motions { motions as u8 } else { 0 };
        let look_ahead = look_ahead.map_or(u8::MAX, |frames| frames as u8);
        let options = hash(0, &[motions, u8::from(quality == Quality::Best), u8::from(subject), look_ahead]);
        let (frames, hashes, previews) = (Vec::new(), Vec::new(), (Identities::new(subject), None));
        Ok(ClipSegmenter { tracker, frames, hashes, options, origin: options, previews })
    }

    /// Takes the next frame. The returned pairs need not be kept.
    ///
    /// # Errors
    /// [`Error::FrameSizeMismatch`]; the clip may go on with another frame.
    pub fn push(&mut self, frame: Frame) -> Result<FramePairs> {
        let pairs = self.take(frame, None)?;
        Ok(FramePairs { origin: self.origin, pairs: pairs.kept() })
    }

    /// Takes the next frame, whose pairs were solved before by [`push`](Self::push).
    ///
    /// # Errors
    /// [`Error::FrameSizeMismatch`], and [`Error::InvalidOption`] for pairs that were solved with other options or frames: they depend on
    /// this frame and the previous one or, with a look-ahead, on all frames before. The frame can then be pushed.
    pub fn push_known(&mut self, frame: Frame, pairs: &FramePairs) -> Result<()> {
        self.take(frame, Some(pairs)).map(|_| ())
    }

    /// The newest frame whose pairs are all solved, with masks from these pairs alone and numbers that may differ from those of the
    /// segmented clip. `None` if there is no such frame, or if it was returned already. If it is called after each frame, all frames but
    /// the last have a preview, and objects keep their numbers from one to the next.
    pub fn preview(&mut self) -> Option<ClipFrame> {
        let PreviewSource { record, frame, log_odds } = self.tracker.preview()?;
        let SegmentOptions { subject, mark_unknown, .. } = self.tracker.options().pair;
        let (objects, last) = &mut self.previews;
        if last.replace(record.index) != record.index.checked_sub(1) {
            *objects = Identities::new(subject);
        }
        let mask: Vec<u8> = log_odds.values().iter().map(|&log_odds| u8::from(log_odds > 0.0)).collect();
        let labels = objects.assign(&record, &mask);
        let onward = record.onward.as_ref();
        let preview = WorkingFrame { index: record.index, labels: &labels, log_odds: &log_odds, onward, mark_unknown };
        Some(preview.described(frame.luminance()))
    }

    fn take(&mut self, frame: Frame, known: Option<&FramePairs>) -> Result<Pairs> {
        let size = [frame.width(), frame.height()];
        let own = frame.hash();
        // In a stream, pairs depend on all earlier frames.
        let before = match (self.tracker.options().look_ahead, self.hashes.last()) {
            (None, Some(last)) => hash(self.options, &last.to_le_bytes()),
            _ => self.origin,
        };
        let origin = hash(before, &own.to_le_bytes());
        let working = self.tracker.options().settings(size).scaling(size).small;
        let is_of_these = |known: &FramePairs| known.origin == origin && known.pairs.is_valid(working[0] * working[1]);
        if !known.is_none_or(is_of_these) {
            return Err(invalid("pairs", "they are of other frames or options"));
        }
        let (tracked, pairs) = self.tracker.push(frame, known.map(|known| known.pairs.pairs(working)))?;
        self.frames.extend(tracked.map(FrameState::new));
        self.hashes.push(own);
        self.origin = origin;
        Ok(pairs)
    }

    /// The clip of the frames so far.
    pub fn conclude(mut self) -> SegmentedClip {
        let size = self.tracker.size().unwrap_or_default();
        let ClipOptions { pair: options, look_ahead } = *self.tracker.options();
        let dropped = self.tracker.dropped();
        self.frames.extend(self.tracker.finish().into_iter().map(FrameState::new));
        if let Some(last) = self.frames.last_mut() {
            last.onward = None;
        }
        // With a look-ahead, the numbers stay those that a stream gives.
        if look_ahead.is_none() {
            let width = self.tracker.options().settings(size).scaling(size).small[0];
            self.part(width);
            self.group(width);
        }
        let numbers = (0..=u8::MAX).collect();
        let (mark_unknown, best) = (options.mark_unknown, options.quality == Quality::Best);
        let stream = look_ahead.is_some();
        let ClipSegmenter { hashes, frames, .. } = self;
        let [locked, named, given] = [(); 3].map(|()| vec![false; 256]);
        SegmentedClip { size, mark_unknown, best, stream, dropped, numbers, locked, named, given, hashes, frames }
    }

    /// Divides objects that have parted in the earlier frames as well.
    fn part(&mut self, width: usize) {
        for &Parting { frame, from, new } in self.tracker.parted().iter().rev() {
            for t in (0..frame).rev() {
                let [Some(here), Some(later)] = [t, t + 1].map(|t| self.frames.get(t)) else { break };
                let Some(onward) = here.onward.as_ref().map(|flow| flow.layered_motion(width)) else { break };
                let mut labels = here.found.labels.values();
                if !divide(&mut labels, &later.found.labels.values(), &onward, from, new) {
                    break;
                }
                self.frames[t].found.labels = Runs::of(&labels);
            }
        }
    }

    /// Renumbers the objects by what the whole clip shows.
    fn group(&mut self, width: usize) {
        let mut census = Census::new();
        for frame in &self.frames {
            let onward = frame.onward.as_ref().map(|flow| flow.layered_motion(width));
            census.add(&frame.found.labels.values(), width, onward.as_ref(), frame.back.is_none());
        }
        let numbers = census.final_numbers();
        for frame in &mut self.frames {
            frame.found.labels = frame.found.labels.map(|label| numbers[usize::from(label)]);
        }
    }
}

fn invalid(name: &'static str, reason: &str) -> Error {
    Error::InvalidOption { name, reason: reason.into() }
}
