//! Ranges of frames that are segmented together, and their place in the clip: the numbers of their objects, and the pairs with the frames
//! beside them.

use std::ops::Range;
use std::sync::Arc;

use crate::answer::UNLABELLED;
use crate::clip::description::ClipFrame;
use crate::clip::frame_state::{Found, FrameState};
use crate::clip::options::ClipOptions;
use crate::clip::pairs::{KeptLayeredMotion, Pairs};
use crate::clip::segmented_clip::SegmentedClip;
use crate::clip::segmenter::{ClipSegmenter, FramePairs, solved};
use crate::error::{Error, Result};
use crate::frame::Frame;
use crate::options::SegmentOptions;
use crate::order::descending;

/// Objects are the same if the intersection of their pixels is at least this share of the union.
const LEAST_SHARE: f64 = 0.1;

/// A range that is being segmented. At its end the frames beside it are taken as well, if they have masks of the same working size.
#[derive(Debug)]
pub(super) struct RangeJob {
    pub(super) step: u32,
    /// The frames of the range.
    pub(super) frames: Range<usize>,
    options: SegmentOptions,
    segmenter: ClipSegmenter,
    /// The next frame of the range.
    next: usize,
    /// How often it was ended early.
    finished: usize,
    /// Whether all frames have been in: it takes effect before any command that was given later.
    pub(super) is_complete: bool,
    /// The first and the last frame of the range, if there are frames beside them.
    ends: [Option<Frame>; 2],
    /// The pairs of the first frame with the one before the range, and of the frame after the range with the last one; each with the hash of
    /// the frame beside the range.
    beside: [Option<(u64, Pairs)>; 2],
}

impl RangeJob {
    /// # Errors
    /// [`Error::InvalidOption`] for a range of fewer than two frames and for options out of range.
    pub(super) fn new(step: u32, frames: Range<usize>, options: SegmentOptions, length: usize) -> Result<RangeJob> {
        if frames.end > length || frames.start.saturating_add(2) > frames.end {
            let Range { start, end } = frames;
            let reason = format!("{start}..{end} is no range of at least two of the {length} frames");
            return Err(Error::InvalidOption { name: "frames", reason });
        }
        let segmenter = ClipSegmenter::new(ClipOptions::default().with_pair(options))?;
        let next = frames.start;
        let (ends, beside) = ([None, None], [None, None]);
        Ok(RangeJob { step, frames, options, segmenter, next, finished: 0, is_complete: false, ends, beside })
    }

    /// The frame to take next; `None` when all are in.
    pub(super) fn wanted(&self, clip: &SegmentedClip) -> Option<usize> {
        if self.frames.contains(&self.next) {
            return Some(self.next);
        }
        // Which frames are beside it can change until the end: undo and redo go on meanwhile.
        (0..2).find_map(|side| {
            self.beside(clip, side).filter(|_| self.finished + side < 2 && self.solved(clip, side).is_none())
        })
    }

    /// The frame before the range, or the one after it, if it has masks of the working size of the range.
    fn beside(&self, clip: &SegmentedClip, side: usize) -> Option<usize> {
        let Range { start, end } = self.frames;
        let beside = if side == 0 { start.checked_sub(1)? } else { end };
        if self.segmenter.size() != Some(clip.size) {
            return None;
        }
        let halvings = ClipOptions::default().with_pair(self.options).settings(clip.size).scaling(clip.size).halvings();
        let found = clip.frames.get(beside)?.found.as_ref()?;
        (found.halvings == halvings && self.ends[side].is_some()).then_some(beside)
    }

    /// The pairs with the frame before the range, or after it, if they were solved.
    fn solved(&self, clip: &SegmentedClip, side: usize) -> Option<&Pairs> {
        let found = clip.frames[self.beside(clip, side)?].found.as_ref()?;
        self.beside[side].as_ref().filter(|(hash, _)| *hash == found.hash).map(|(_, pairs)| pairs)
    }

    /// Takes the frame that is [`wanted`](Self::wanted), with pairs that others have solved or that were solved before. Returns its pairs if
    /// they are new.
    ///
    /// # Errors
    /// [`Error::FrameSizeMismatch`], [`Error::OtherFrame`] for another frame beside the range; another frame can be taken.
    pub(super) fn take(
        &mut self,
        clip: &SegmentedClip,
        frame: &Frame,
        of_others: Option<&FramePairs>,
        known: Option<&FramePairs>,
    ) -> Result<Option<(usize, FramePairs)>> {
        let Some(index) = self.wanted(clip) else { return Ok(None) };
        if !self.frames.contains(&index) {
            clip.check(index, frame)?;
            let side = usize::from(index >= self.frames.end);
            let pairs = match &self.ends {
                [Some(first), _] if side == 0 => solved(frame, first, &self.options),
                [_, Some(last)] => solved(last, frame, &self.options),
                _ => return Ok(None),
            };
            self.beside[side] = Some((frame.hash(), pairs));
            return Ok(None);
        }
        self.check_size(clip, [frame.width(), frame.height()])?;
        let knows = |pairs: &&FramePairs| self.segmenter.knows(frame, pairs);
        let new = match (known.filter(knows), of_others.filter(knows)) {
            (Some(known), _) => self.segmenter.push_known(frame.clone(), known).map(|()| None)?,
            (_, Some(solved)) => self.segmenter.push_known(frame.clone(), solved).map(|()| Some(solved.clone()))?,
            _ => Some(self.segmenter.push(frame.clone())?),
        };
        let is_end = [index == self.frames.start && index > 0, index + 1 == self.frames.end && index + 1 < clip.len()];
        for (end, _) in self.ends.iter_mut().zip(is_end).filter(|(_, is_end)| *is_end) {
            *end = Some(frame.clone());
        }
        self.next = index + 1;
        Ok(new.map(|pairs| (index, pairs)))
    }

    /// A range of frames of another size has to contain all frames that have masks.
    fn check_size(&self, clip: &SegmentedClip, size: [usize; 2]) -> Result<()> {
        let is_outside = |t: usize| !self.frames.contains(&t) && clip.frames[t].found.is_some();
        let [first, second] = [clip.size, size].map(|[width, height]| (width, height));
        match first != second && (0..clip.len()).any(is_outside) {
            true => Err(Error::FrameSizeMismatch { first, second }),
            false => Ok(()),
        }
    }

    /// Ends the range before a frame, or after the frames that are in. The frame after it is not wanted any more; nor is the one before it,
    /// if the range was ended before. Returns where it ends.
    pub(super) fn finish(&mut self, end: Option<usize>) -> usize {
        self.frames.end = end.unwrap_or(self.next).clamp(self.frames.start, self.frames.end);
        self.finished += 1;
        self.frames.end
    }

    /// A draft of the newest frame.
    pub(super) fn preview(&mut self) -> Option<ClipFrame> {
        let mut preview = self.segmenter.preview()?;
        preview.index += self.frames.start;
        Some(preview)
    }

    /// The clip with the masks of this range in place of those before. It has no annotations yet in the scenes of the range; these scenes are
    /// returned as well, from the first frame to the last.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] for a range that was ended before its second frame, [`Error::FrameSizeMismatch`] for one of another size than
    /// masks outside.
    pub(super) fn conclude(self, before: &SegmentedClip) -> Result<(SegmentedClip, [usize; 2])> {
        let Range { start, end } = self.frames;
        if start + 2 > end {
            let reason = format!("a range needs two frames, there are {}", end - start);
            return Err(Error::InvalidOption { name: "frames", reason });
        }
        let is_solved = [0, 1].map(|side| self.solved(before, side).is_some());
        let size = self.segmenter.size().unwrap_or(before.size);
        // The frames outside may have got masks of another size meanwhile.
        self.check_size(before, size)?;
        let run = self.segmenter.conclude();
        let mut clip = before.clone();
        clip.size = run.size;
        let numbers = numbers_of(&run, before, start, &mut clip);
        let [first, last] = [start, end - 1].map(|t| before.scene(t));
        for (frame, now) in run.frames.into_iter().zip(&mut clip.frames[start..end]) {
            let mut found = frame.found;
            if let Some(found) = found.as_mut().map(Arc::make_mut) {
                found.layer.labels = found.layer.labels.map(|label| numbers[usize::from(label)]);
            }
            *now = FrameState { found, exact: now.exact.take(), ..FrameState::default() };
        }
        let pairs = |side: usize| self.beside[side].as_ref().filter(|_| is_solved[side]).map(|(_, pairs)| pairs);
        if start > 0 {
            clip.join(start, pairs(0), before);
        }
        if end < clip.len() {
            clip.join(end, pairs(1), before);
        }
        let [now_first, now_last] = [start, end - 1].map(|t| clip.scene(t));
        Ok((clip, [first[0].min(now_first[0]), last[1].max(now_last[1])]))
    }
}

impl SegmentedClip {
    /// Sets the motions between a frame and the previous one. Without solved pairs they stay as they were before, if the working size is the
    /// same.
    fn join(&mut self, index: usize, pairs: Option<&Pairs>, before: &SegmentedClip) {
        let kept = |pair: &Option<(_, _)>| pair.as_ref().map(|(_, motion)| KeptLayeredMotion::of(motion));
        let halvings = |clip: &SegmentedClip| {
            let found = |t: usize| clip.frames[t].found.as_ref().map(|found| found.halvings);
            [found(index - 1), found(index)]
        };
        let old = |t: usize| before.frames[t].found.as_deref().filter(|_| halvings(before) == halvings(self));
        let (onward, back) = match pairs {
            Some(Pairs { onward, back, .. }) => (kept(onward), kept(back)),
            None => (old(index - 1).and_then(|of| of.onward.clone()), old(index).and_then(|of| of.back.clone())),
        };
        let set = |found: Option<&mut Arc<Found>>, set: &dyn Fn(&mut Found)| {
            if let Some(found) = found {
                set(Arc::make_mut(found));
            }
        };
        set(self.frames[index - 1].found.as_mut(), &|found| found.onward = onward.clone());
        set(self.frames[index].found.as_mut(), &|found| found.back = back.clone());
    }
}

/// The numbers of the objects of a run in the clip: each object keeps the number of the one that it overlaps most, compared with what was
/// found before, then with what a person made. Another object gets its own number if it is free, or else the lowest free one; without any,
/// it becomes background.
fn numbers_of(run: &SegmentedClip, before: &SegmentedClip, start: usize, now: &mut SegmentedClip) -> [u8; 256] {
    let mut numbers: [Option<u8>; 256] = [None; 256];
    (numbers[0], numbers[usize::from(UNLABELLED)]) = (Some(0), Some(UNLABELLED));
    let mut is_matched = [false; 256];
    for is_layer in [false, true] {
        for (was, is) in overlaps(run, before, start, is_layer) {
            if was > 0 && was != UNLABELLED && numbers[usize::from(is)].is_none() && !is_matched[usize::from(was)] {
                numbers[usize::from(is)] = Some(was);
                is_matched[usize::from(was)] = true;
            }
        }
    }
    let objects = now.objects_mut();
    objects.dropped += run.objects.dropped;
    std::array::from_fn(|k| {
        let own = k as u8;
        numbers[k].unwrap_or_else(|| {
            let is_there = run.frames.iter().any(|frame| frame.found_labels().names(own));
            if !is_there {
                return 0;
            }
            let mut free = std::iter::once(own).chain(1..UNLABELLED).filter(|&k| !objects.used[usize::from(k)]);
            let number = free.next().unwrap_or(0);
            match number {
                0 => objects.dropped += 1,
                number => objects.used[usize::from(number)] = true,
            }
            number
        })
    })
}

/// Pairs of a label before and an object of a run that overlap, those with the largest share in common first. A frame without masks is
/// compared with its neighbour outside the run.
fn overlaps(run: &SegmentedClip, before: &SegmentedClip, start: usize, is_layer: bool) -> Vec<(u8, u8)> {
    let mut common = vec![[0usize; 256]; 256];
    let mut areas = [[0usize; 256]; 2];
    for (k, frame) in run.frames.iter().enumerate() {
        let known = |t: usize| before.frames.get(t).is_some_and(|frame| frame.found.is_some());
        let (index, end) = (start + k, start + run.len());
        let neighbour = match index {
            index if known(index) => Some(index),
            index if index == start && start > 0 && known(start - 1) => Some(start - 1),
            index if index + 1 == end && known(end) => Some(end),
            _ => None,
        };
        let Some(neighbour) = neighbour else { continue };
        let size = run.scaling(k).small;
        let Some(labels) = before.labels_at(neighbour, size, is_layer) else { continue };
        for (was, is) in labels.into_iter().zip(frame.found_labels().values()) {
            areas[0][usize::from(was)] += 1;
            areas[1][usize::from(is)] += 1;
            common[usize::from(was)][usize::from(is)] += 1;
        }
    }
    let (mut pairs, mut shares) = (Vec::new(), Vec::new());
    for (was, row) in (0..=u8::MAX).zip(common) {
        for (is, pixels) in (0..=u8::MAX).zip(row).filter(|(_, pixels)| *pixels > 0) {
            let share = pixels as f64 / (areas[0][usize::from(was)] + areas[1][usize::from(is)] - pixels) as f64;
            if share >= LEAST_SHARE {
                pairs.push((was, is));
                shares.push(share);
            }
        }
    }
    descending(shares).into_iter().map(|k| pairs[k]).collect()
}

impl SegmentedClip {
    /// The labels found in a frame or, with `is_layer`, those of its layer, at some size: each pixel has that of the nearest one.
    fn labels_at(&self, index: usize, size: [usize; 2], is_layer: bool) -> Option<Vec<u8>> {
        let frame = &self.frames[index];
        let (labels, before) = match is_layer {
            true => (frame.layer.as_ref()?.labels.values(), self.size),
            false => (frame.found_labels().values(), self.scaling(index).small),
        };
        Some(resized(&labels, before, size))
    }
}

/// A label image at another size: each pixel has the label of the nearest one.
pub(super) fn resized(labels: &[u8], [w, h]: [usize; 2], [width, height]: [usize; 2]) -> Vec<u8> {
    (0..width * height).map(|p| labels[(p / width * h / height) * w + p % width * w / width]).collect()
}
