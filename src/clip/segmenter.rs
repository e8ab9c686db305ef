//! Segmentation of a whole clip, frame by frame.

use std::sync::Arc;

use super::description::{ClipFrame, WorkingFrame};
use super::frame_state::{Found, FrameState};
use super::grouping::Census;
use super::identity::{Identities, Parting};
use super::objects::Objects;
use super::options::ClipOptions;
use super::pairing;
use super::pairs::{KeptPairs, Pairs};
use super::parting::divide;
use super::record::PendingFrame;
use super::runs::Runs;
use super::saved::{Format, saved};
use super::segmented_clip::SegmentedClip;
use super::tracker::{PreviewSource, Tracked, Tracker};
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
    found: Vec<Found>,
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
        let (options, subject) = (origin_of_options(tracker.options()), tracker.options().pair.subject);
        let (found, hashes, previews) = (Vec::new(), Vec::new(), (Identities::new(subject), None));
        Ok(ClipSegmenter { tracker, found, hashes, options, origin: options, previews })
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

    /// Whether these are the pairs of the next frame.
    pub(super) fn knows(&self, frame: &Frame, pairs: &FramePairs) -> bool {
        let [width, height] = self.working_size(frame);
        pairs.origin == self.origin_of(frame) && pairs.pairs.is_valid(width * height)
    }

    /// Width and height of the frames; `None` before the first.
    pub(super) fn size(&self) -> Option<[usize; 2]> {
        self.tracker.size()
    }

    fn working_size(&self, frame: &Frame) -> [usize; 2] {
        let size = [frame.width(), frame.height()];
        self.tracker.options().settings(size).scaling(size).small
    }

    /// The hash of everything that determines the pairs of the next frame.
    fn origin_of(&self, frame: &Frame) -> u64 {
        // In a stream, pairs depend on all earlier frames.
        match (self.tracker.options().look_ahead, self.hashes.last()) {
            (None, Some(last)) => origin(self.options, *last, frame.hash()),
            _ => hash(self.origin, &frame.hash().to_le_bytes()),
        }
    }

    fn take(&mut self, frame: Frame, known: Option<&FramePairs>) -> Result<Pairs> {
        let (own, origin, working) = (frame.hash(), self.origin_of(&frame), self.working_size(&frame));
        if !known.is_none_or(|known| self.knows(&frame, known)) {
            return Err(invalid("pairs", "they are of other frames or options"));
        }
        let size = [frame.width(), frame.height()];
        let (tracked, pairs) = self.tracker.push(frame, known.map(|known| known.pairs.pairs(working)))?;
        self.hashes.push(own);
        self.keep(tracked, size);
        self.origin = origin;
        Ok(pairs)
    }

    /// Keeps frames whose objects are known.
    fn keep(&mut self, tracked: impl IntoIterator<Item = Tracked>, size: [usize; 2]) {
        let halvings = self.tracker.options().settings(size).scaling(size).halvings();
        for tracked in tracked {
            let hash = self.hashes[tracked.record.index];
            self.found.push(Found::new(tracked, halvings, hash));
        }
    }

    /// The clip of the frames so far.
    pub fn conclude(mut self) -> SegmentedClip {
        let size = self.tracker.size().unwrap_or_default();
        let ClipOptions { pair: options, look_ahead } = *self.tracker.options();
        let dropped = self.tracker.dropped();
        let rest = self.tracker.finish();
        self.keep(rest, size);
        if let Some(last) = self.found.last_mut() {
            last.onward = None;
        }
        // With a look-ahead, the numbers stay those that a stream gives.
        if look_ahead.is_none() {
            let width = self.tracker.options().settings(size).scaling(size).small[0];
            self.part(width);
            self.group(width);
        }
        let objects = Arc::new(Objects::new(dropped));
        let frames = self.found.into_iter().map(FrameState::of).collect();
        SegmentedClip { size, mark_unknown: options.mark_unknown, objects, frames }
    }

    /// Divides objects that have parted in the earlier frames as well.
    fn part(&mut self, width: usize) {
        for &Parting { frame, from, new } in self.tracker.parted().iter().rev() {
            for t in (0..frame).rev() {
                let [Some(here), Some(later)] = [t, t + 1].map(|t| self.found.get(t)) else { break };
                let Some(onward) = here.onward.as_ref().map(|flow| flow.layered_motion(width)) else { break };
                let mut labels = here.layer.labels.values();
                if !divide(&mut labels, &later.layer.labels.values(), &onward, from, new) {
                    break;
                }
                self.found[t].layer.labels = Runs::of(&labels);
            }
        }
    }

    /// Renumbers the objects by what the whole clip shows.
    fn group(&mut self, width: usize) {
        let mut census = Census::new();
        for frame in &self.found {
            let onward = frame.onward.as_ref().map(|flow| flow.layered_motion(width));
            census.add(&frame.layer.labels.values(), width, onward.as_ref(), frame.back.is_none());
        }
        let numbers = census.final_numbers();
        for frame in &mut self.found {
            frame.layer.labels = frame.layer.labels.map(|label| numbers[usize::from(label)]);
        }
    }
}

/// Solves the pairs of a frame with the previous one, for [`ClipSegmenter::push_known`] and [`Clip::take`](super::Clip::take): any thread or
/// machine can solve pairs of a clip.
///
/// # Errors
/// [`Error::FrameSizeMismatch`], and [`Error::InvalidOption`] for a number of motions out of range.
pub fn solve_pair(before: &Frame, frame: &Frame, options: &SegmentOptions) -> Result<FramePairs> {
    options.motions.validate()?;
    let [first, second] = [before, frame].map(|frame| (frame.width(), frame.height()));
    if first != second {
        return Err(Error::FrameSizeMismatch { first, second });
    }
    let of_options = origin_of_options(&ClipOptions::default().with_pair(*options));
    let origin = origin(of_options, before.hash(), frame.hash());
    Ok(FramePairs { origin, pairs: solved(before, frame, options).kept() })
}

/// The pairs of a frame of a whole clip with the previous one.
pub(super) fn solved(before: &Frame, frame: &Frame, options: &SegmentOptions) -> Pairs {
    let settings = ClipOptions::default().with_pair(*options).settings([frame.width(), frame.height()]);
    let last = PendingFrame::new(before.clone(), None, &settings);
    let newest = PendingFrame::new(frame.clone(), Some(&last), &settings);
    match newest.repeats {
        true => pairing::of_repeated(&newest, None, true),
        false => pairing::of_whole_clip(&last, &newest, &settings),
    }
}

/// A hash of the options that determine how pairs are solved.
fn origin_of_options(options: &ClipOptions) -> u64 {
    let ClipOptions { pair: SegmentOptions { motions, quality, subject, .. }, look_ahead } = *options;
    let motions = if let MotionCount::Given(motions) = motions { motions as u8 } else { 0 };
    let look_ahead = look_ahead.map_or(u8::MAX, |frames| frames as u8);
    hash(0, &[motions, u8::from(quality == Quality::Best), u8::from(subject), look_ahead])
}

/// A hash of everything that determines the pairs of two frames of a whole clip.
fn origin(options: u64, before: u64, frame: u64) -> u64 {
    hash(hash(options, &before.to_le_bytes()), &frame.to_le_bytes())
}

fn invalid(name: &'static str, reason: &str) -> Error {
    Error::InvalidOption { name, reason: reason.into() }
}
