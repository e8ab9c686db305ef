//! Clips whose frames can be read again: segmented once, then asked for any frame, corrected and saved.

use super::annotation::{Accepted, Annotations, Said};
use super::changes::Changes;
use super::description::WorkingFrame;
use super::evidence::{Flow, KeptFlow, KeptOdds, KeptPairs, Pairs};
use super::grouping::Census;
use super::identity::{Identities, Parting};
use super::job::ClipJob;
use super::layer::Layer;
use super::parting::divide;
use super::runs::Runs;
use super::saved::{Format, saved};
use super::tracker::{Latest, Tracked, Tracker};
use super::{ClipFrame, ClipOptions, model};
use crate::error::{Error, Result};
use crate::frame::{Frame, MAX_SIDE, MIN_SIDE, Plane};
use crate::hash::hash;
use crate::options::{MotionCount, Quality, SegmentOptions};
use crate::pair::settings::Settings;

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
    /// Of every frame so far.
    hashes: Vec<u64>,
    /// Of the options.
    options: u64,
    /// Of what the pairs of the newest frame follow from.
    origin: u64,
    /// The objects of the previews, and the index of the last one.
    previews: (Identities, Option<usize>),
}

/// What the pairs of a frame with the one before have told: nearly all the work of [`ClipSegmenter::push`].
///
/// A clip that was interrupted goes on from there: [`ClipSegmenter::push_known`] does not solve the frame's pairs again. Without a look-ahead
/// they follow from the two frames and the options alone, so that several segmenters can each solve a part of a clip for another one.
#[derive(Clone, Debug)]
pub struct FramePairs {
    origin: u64,
    pairs: KeptPairs,
}

saved!(FramePairs { origin, pairs });

/// The bytes of [`FramePairs`] and of a [`SegmentedClip`].
const PAIRS: Format = Format { name: "pairs", mark: concat!("VERPAIR5 ", env!("CARGO_PKG_VERSION"), "\n") };
const CLIP: Format = Format { name: "state", mark: concat!("VERCLIP5 ", env!("CARGO_PKG_VERSION"), "\n") };

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
        // What decides how pairs are solved.
        let ClipOptions { pair: SegmentOptions { motions, quality, .. }, look_ahead } = *tracker.options();
        let motions = if let MotionCount::Given(motions) = motions { motions as u8 } else { 0 };
        let look_ahead = look_ahead.map_or(u8::MAX, |frames| frames as u8);
        let options = hash(0, &[motions, u8::from(quality == Quality::Best), look_ahead]);
        let (frames, hashes, previews) = (Vec::new(), Vec::new(), (Identities::new(), None));
        Ok(ClipSegmenter { tracker, frames, hashes, options, origin: options, previews })
    }

    /// Takes the next frame. What it returns need not be kept.
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
    /// [`Error::FrameSizeMismatch`], and [`Error::InvalidOption`] for pairs that were not solved with these options, of this frame and
    /// the one before it, with a look-ahead all those before it; the frame can be pushed then.
    pub fn push_known(&mut self, frame: Frame, pairs: &FramePairs) -> Result<()> {
        self.take(frame, Some(pairs)).map(|_| ())
    }

    /// The newest frame whose pairs are all solved, with the masks that they tell alone: without the evidence of other frames, and with numbers
    /// that need not be those of the segmented clip. There is none before there are such pairs, and none twice. Asked after each frame,
    /// previews are those of all frames but the last, and objects keep their number from one to the next.
    pub fn preview(&mut self) -> Option<ClipFrame> {
        let Latest { record, frame, odds } = self.tracker.latest()?;
        let (objects, last) = &mut self.previews;
        if last.replace(record.index) != record.index.checked_sub(1) {
            *objects = Identities::new();
        }
        let mask: Vec<u8> = odds.values().iter().map(|&odds| u8::from(odds > 0.0)).collect();
        let labels = objects.assign(&record, &mask);
        let mark_unknown = self.tracker.options().pair.mark_unknown;
        let onward = record.onward.as_ref();
        let preview = WorkingFrame { index: record.index, labels: &labels, odds: &odds, onward, mark_unknown };
        Some(preview.described(frame.luminance()))
    }

    fn take(&mut self, frame: Frame, known: Option<&FramePairs>) -> Result<Pairs> {
        let size = [frame.width(), frame.height()];
        let own = frame.hash();
        // A stream follows what it found in the frames before.
        let before = match (self.tracker.options().look_ahead, self.hashes.last()) {
            (None, Some(last)) => hash(self.options, &last.to_le_bytes()),
            _ => self.origin,
        };
        let origin = hash(before, &own.to_le_bytes());
        let working = self.tracker.options().settings(size).working_size(size);
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
        // With a look-ahead only what a stream knows is used, so that what is said of its objects holds here.
        if look_ahead.is_none() {
            let width = self.tracker.options().settings(size).working_size(size)[0];
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

    /// Divides what was one object before it was two.
    fn part(&mut self, width: usize) {
        for &Parting { frame, from, new } in self.tracker.parted().iter().rev() {
            for t in (0..frame).rev() {
                let [Some(here), Some(later)] = [t, t + 1].map(|t| self.frames.get(t)) else { break };
                let Some(onward) = here.onward.as_ref().map(|flow| flow.flow(width)) else { break };
                let mut labels = here.found.labels();
                if !divide(&mut labels, &later.found.labels(), &onward, from, new) {
                    break;
                }
                self.frames[t].found.labels = Runs::of(&labels);
            }
        }
    }

    /// Gives the objects the numbers that the whole clip tells.
    fn group(&mut self, width: usize) {
        let mut census = Census::new();
        for (index, frame) in self.frames.iter().enumerate() {
            let onward = frame.onward.as_ref().map(|flow| flow.flow(width));
            census.add(index, &frame.found.labels(), width, onward.as_ref(), frame.back.is_none());
        }
        let numbers = census.final_numbers();
        for frame in &mut self.frames {
            frame.found.labels = frame.found.labels.map(|label| numbers[usize::from(label)]);
        }
    }
}

/// A clip whose objects are known in every frame. It keeps some kilobytes per frame and not the frames themselves.
#[derive(Clone, Debug)]
pub struct SegmentedClip {
    /// Width and height of the frames.
    size: [usize; 2],
    mark_unknown: bool,
    /// Whether the quality is the best.
    best: bool,
    /// Whether the clip was segmented as a stream is, with a look-ahead.
    stream: bool,
    dropped: usize,
    /// The number that each object is given, itself unless it was merged or removed.
    numbers: Vec<u8>,
    /// Whether nothing changes the object of a number.
    pub(super) locked: Vec<bool>,
    /// Whether only what is said of itself changes the object of a number.
    pub(super) named: Vec<bool>,
    /// Whether masks with a number were given: the object takes the place of what was found of it.
    pub(super) given: Vec<bool>,
    /// Of every frame as it was segmented.
    hashes: Vec<u64>,
    pub(super) frames: Vec<FrameState>,
}

saved!(SegmentedClip { size, mark_unknown, best, stream, dropped, numbers, locked, named, given, hashes, frames });

/// A frame of a segmented clip.
#[derive(Clone, Debug)]
pub(super) struct FrameState {
    /// As the clip was segmented, working size.
    found: Labelling,
    pub(super) said: Option<Said>,
    pub(super) layer: Option<Layer>,
    /// Whether a person finds the frame right: its layer has all its labels.
    pub(super) accepted: bool,
    /// To the next frame of the scene.
    onward: Option<KeptFlow>,
    /// To the frame before.
    pub(super) back: Option<KeptFlow>,
}

saved!(FrameState { found, said, layer, accepted, onward, back });

/// Labels with their odds.
#[derive(Clone, Debug)]
struct Labelling {
    labels: Runs,
    odds: KeptOdds,
}

saved!(Labelling { labels, odds });

impl FrameState {
    fn new(Tracked { record, labels, odds, goes_on }: Tracked) -> FrameState {
        FrameState {
            found: Labelling::of(&labels, &odds),
            said: None,
            layer: None,
            accepted: false,
            onward: record.onward.as_ref().filter(|_| goes_on).map(KeptFlow::of),
            back: record.back.as_ref().map(KeptFlow::of),
        }
    }

    fn is_valid(&self, pixels: usize, full: usize) -> bool {
        self.found.labels.is_valid(pixels)
            && self.found.odds.is_valid(pixels)
            && self.said.as_ref().is_none_or(|said| said.is_valid(full))
            && self.layer.as_ref().is_none_or(|layer| layer.labels.is_valid(full) && layer.odds.is_valid(pixels))
            && [&self.onward, &self.back].into_iter().flatten().all(|flow| flow.is_valid(pixels))
    }
}

impl Labelling {
    fn of(labels: &[u8], odds: &Plane) -> Labelling {
        Labelling { labels: Runs::of(labels), odds: KeptOdds::of(odds) }
    }

    fn labels(&self) -> Vec<u8> {
        self.labels.values()
    }

    fn odds(&self, [width, height]: [usize; 2]) -> Plane {
        self.odds.odds(width, height)
    }
}

impl SegmentedClip {
    /// Number of frames.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Whether there is no frame.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// Width and height of the frames; 0 if there is none.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Number of objects that were seen when all numbers had been given, and count as background.
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// Whether pixels whose evidence does not decide are to have the label 255 from now on.
    pub fn mark_unknown(&mut self, mark: bool) {
        self.mark_unknown = mark;
    }

    /// Indices of the frames in which an object is, by its number of now.
    pub fn frames_with(&self, object: u8) -> Vec<usize> {
        let is_it = |(label, _): (u8, usize)| self.numbers[usize::from(label)] == object;
        let is_there = |frame: &FrameState| {
            frame.found.labels.each().any(is_it)
                || frame.layer.as_ref().is_some_and(|layer| layer.labels.each().any(is_it))
        };
        (0..self.len()).filter(|&index| is_there(&self.frames[index])).collect()
    }

    /// The labels and objects of a frame, which must be the one that was segmented.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] for an index that is not below [`len`](Self::len), [`Error::FrameSizeMismatch`], [`Error::OtherFrame`].
    pub fn frame(&self, index: usize, frame: &Frame) -> Result<ClipFrame> {
        self.check(index, frame)?;
        let state = &self.frames[index];
        let persons = self.persons_in(index);
        // What a layer must tell apart keeps its number until then.
        let is_persons = |label: u8| persons[usize::from(label)];
        let given = |label: u8| match self.numbers[usize::from(label)] {
            number if is_persons(label) || is_persons(number) => label,
            number => number,
        };
        let mut labels = state.found.labels();
        labels.iter_mut().for_each(|label| *label = given(*label));
        let (mut odds, onward) = (state.found.odds(self.working_size()), self.onward(index));
        let working = |labels: &[u8], odds: &Plane, mark_unknown| {
            WorkingFrame { index, labels, odds, onward: onward.as_ref(), mark_unknown }.described(frame.luminance())
        };
        if state.layer.is_none()
            && labels.iter().all(|&label| self.numbers[usize::from(label)] == label && !is_persons(label))
        {
            return Ok(working(&labels, &odds, self.mark_unknown));
        }
        let found = working(&labels, &odds, false).labels;
        let full: Vec<u8> =
            self.overlaid(index, &found, &persons).into_iter().map(|label| self.numbers[usize::from(label)]).collect();
        let [w, h] = self.working_size();
        let step = self.working_step();
        let layer = state.layer.as_ref().map(|layer| layer.odds.odds(w, h)).zip(self.above(index));
        for p in 0..w * h {
            let q = (p / w * step).min(self.size[1] - 1) * self.size[0] + (p % w * step).min(self.size[0] - 1);
            let odds = &mut odds.values_mut()[p];
            match &layer {
                Some((of_layer, above)) if above[q] != NOTHING_SAID => *odds = of_layer.values()[p],
                _ if full[q] == 0 && found[q] > 0 => *odds = -model().certain,
                _ => {}
            }
            labels[p] = full[q];
        }
        let working = WorkingFrame {
            index,
            labels: &labels,
            odds: &odds,
            onward: onward.as_ref(),
            mark_unknown: self.mark_unknown,
        };
        Ok(working.marked(full, frame.width()))
    }

    /// What was found in a frame, at full size.
    pub(super) fn found_full(&self, index: usize, luminance: &Plane) -> Vec<u8> {
        let (labels, odds) = self.found(index);
        WorkingFrame { index, labels: &labels, odds: &odds, onward: None, mark_unknown: false }.upsampled(luminance)
    }

    /// The labels of a frame with what persons say, without other numbers.
    pub(super) fn layered(&self, index: usize, luminance: &Plane) -> Vec<u8> {
        self.overlaid(index, &self.found_full(index, luminance), &self.persons_in(index))
    }

    /// Full-size labels that were found with the layer of a frame over them. What was found of an object of a person does not show, nor what
    /// is left of one of which an object whose masks were given has most.
    pub(super) fn overlaid(&self, index: usize, found: &[u8], persons: &Numbers) -> Vec<u8> {
        let layer = self.above(index).unwrap_or_else(|| vec![NOTHING_SAID; found.len()]);
        let mut sizes = [[0usize; 2]; 256];
        for (&found, &label) in found.iter().zip(&layer) {
            sizes[usize::from(found)][0] += 1;
            sizes[usize::from(found)][1] += usize::from(self.given[usize::from(label)]);
        }
        let kept = self.kept();
        let hides = |label: u8| {
            let k = usize::from(label);
            persons[k] || !kept[k] && 2 * sizes[k][1] > sizes[k][0]
        };
        let hidden: Vec<bool> = (0..=u8::MAX).map(hides).collect();
        let shown = |(&layer, &found): (&u8, &u8)| match layer {
            NOTHING_SAID if hidden[usize::from(found)] => 0,
            NOTHING_SAID => found,
            label => label,
        };
        layer.iter().zip(found).map(shown).collect()
    }

    /// The labels of the layer of a frame, if it has one. What was found shows again where objects of a person were deleted.
    fn above(&self, index: usize) -> Option<Vec<u8>> {
        let is_gone = |label: u8| label > 0 && label != NOTHING_SAID && self.numbers[usize::from(label)] == 0;
        let mut labels = self.frames[index].layer.as_ref()?.labels.values();
        labels.iter_mut().filter(|label| is_gone(**label)).for_each(|label| *label = NOTHING_SAID);
        Some(labels)
    }

    /// First and last frame of the scene of a frame.
    pub(super) fn scene(&self, index: usize) -> [usize; 2] {
        let (mut first, mut last) = (index, index);
        while self.frames[first].back.is_some() && first > 0 {
            first -= 1;
        }
        while last + 1 < self.len() && self.frames[last + 1].back.is_some() {
            last += 1;
        }
        [first, last]
    }

    /// Numbers of the objects of a person to which what is said of the scene spreads in a frame. Elsewhere they are what was found.
    pub(super) fn persons_in(&self, index: usize) -> Numbers {
        let [first, last] = self.scene(index);
        let mut persons = [false; 256];
        for t in first..=last {
            let Some(said) = &self.frames[t].said else { continue };
            for &label in &said.speaks_of {
                let [forward, backward] = said.spread_of(label).ways();
                persons[usize::from(label)] |= t == index || (t < index && forward) || (t > index && backward);
            }
        }
        persons
    }

    /// Numbers of the objects that a person has spoken of.
    fn persons(&self) -> Numbers {
        let mut persons = [false; 256];
        for said in self.frames.iter().filter_map(|frame| frame.said.as_ref()) {
            said.speaks_of.iter().for_each(|&label| persons[usize::from(label)] = true);
        }
        persons
    }

    /// Numbers of the objects that only what is said of themselves changes: those that a person locked, named, or accepted in some frame.
    pub(super) fn kept(&self) -> Numbers {
        let mut kept: Numbers = std::array::from_fn(|k| self.locked[k] || self.named[k]);
        for layer in self.frames.iter().filter(|frame| frame.accepted).filter_map(|frame| frame.layer.as_ref()) {
            layer.labels.each().for_each(|(label, _)| kept[usize::from(label)] = true);
        }
        kept[0] = false;
        kept
    }

    /// Whether a person accepted a frame with an object in it.
    pub(super) fn accepts(&self, index: usize, number: u8) -> bool {
        let frame = &self.frames[index];
        frame.accepted && frame.layer.as_ref().is_some_and(|layer| layer.labels.names(number))
    }

    /// Whether an object was found in a frame.
    pub(super) fn finds(&self, index: usize, number: u8) -> bool {
        self.frames[index].found.labels.each().any(|(label, _)| label == number)
    }

    /// What was found in a frame, at another size.
    pub(super) fn found_at(&self, index: usize, [width, height]: [usize; 2]) -> Vec<u8> {
        let (labels, [w, h]) = (self.frames[index].found.labels(), self.working_size());
        let place = |p: usize| (p / width * h / height).min(h - 1) * w + (p % width * w / width).min(w - 1);
        (0..width * height).map(|p| labels[place(p)]).collect()
    }

    /// Keeps numbers for objects of a person: what was found automatically under one of them gets the lowest number that is free. Where none
    /// is left it becomes background and counts as [`dropped`](Self::dropped). Objects that a person has spoken of keep theirs. Returns the
    /// indices of the frames that change.
    pub(super) fn reserve(&mut self, numbers: &[u8]) -> Vec<usize> {
        let persons = self.persons();
        let mut is_found = [false; 256];
        for (label, _) in self.frames.iter().flat_map(|frame| frame.found.labels.each()) {
            is_found[usize::from(label)] = true;
        }
        let objects = 1..NOTHING_SAID;
        let is_taken = |k: &u8| is_found[usize::from(*k)] || persons[usize::from(*k)] || numbers.contains(k);
        let mut free = objects.clone().filter(|k| !is_taken(k));
        let mut now: Vec<u8> = (0..=NOTHING_SAID).collect();
        for k in objects.clone().filter(|k| numbers.contains(k) && !persons[usize::from(*k)]) {
            let old = usize::from(k);
            let number = std::mem::replace(&mut self.numbers[old], k);
            if is_found[old] {
                now[old] = free.next().unwrap_or(0);
                match now[old] {
                    0 => self.dropped += 1,
                    new => self.numbers[usize::from(new)] = number,
                }
                self.locked.swap(old, usize::from(now[old]));
                self.named.swap(old, usize::from(now[old]));
            }
        }
        // What was merged into one of them goes along.
        for (_, number) in self.numbers.iter_mut().enumerate().filter(|(k, number)| usize::from(**number) != *k) {
            *number = now[usize::from(*number)];
        }
        let mut changed = Vec::new();
        for (index, frame) in self.frames.iter_mut().enumerate() {
            let labels = frame.found.labels.map(|label| now[usize::from(label)]);
            if let Some(layer) = frame.layer.as_mut().filter(|_| frame.accepted) {
                layer.labels =
                    layer.labels.map(|label| if persons[usize::from(label)] { label } else { now[usize::from(label)] });
            }
            if labels != frame.found.labels {
                frame.found.labels = labels;
                changed.push(index);
            }
        }
        changed
    }

    /// Takes what a person says. It is checked at once, and takes effect as the job takes the frames that it wants.
    ///
    /// Nothing that a person named, painted, gave, prompted, accepted or locked changes when something else is said. An object that was found
    /// automatically changes by the pixels that another one takes from it or gives back.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] for an index that is not below [`len`](Self::len), labels that do not fill the frame, prompts that are not
    /// within the frame, and numbers that are not those of objects; [`Error::ObjectLocked`] for what is said of a locked object. Nothing is
    /// changed then.
    pub fn annotate(&mut self, annotations: Annotations) -> Result<ClipJob> {
        ClipJob::new(self, annotations)
    }

    /// Gives a frame the labels with which a person accepts it; without them those that it has.
    pub(super) fn accept(&mut self, frame: &Frame, Accepted { frame: index, labels }: Accepted, changes: &mut Changes) {
        let shown = self.layered(index, frame.luminance());
        let labels = labels.unwrap_or_else(|| shown.clone());
        let [w, h] = self.working_size();
        let before = self.frames[index].layer.as_ref().map(|layer| (layer.labels.values(), layer.odds.odds(w, h)));
        let found = self.frames[index].found.odds([w, h]);
        let odds = |p: usize, at: usize| match &before {
            Some((labels, odds)) if labels[p] != NOTHING_SAID => odds.values()[at],
            _ => found.values()[at],
        };
        let layer = self.layer_of(&labels, &odds);
        (self.frames[index].layer, self.frames[index].accepted) = (layer, true);
        if labels != shown {
            changes.set(index, &shown, &labels);
        }
    }

    /// Gives every pixel of an object another number for the whole clip. Returns the indices of the frames that change.
    pub(super) fn renumber(&mut self, [object, number]: [u8; 2]) -> Vec<usize> {
        let number = self.numbers[usize::from(number)];
        if number != 0 && self.frames_with(number).is_empty() {
            return Vec::new();
        }
        let changed = self.frames_with(object);
        self.numbers.iter_mut().filter(|given| **given == object).for_each(|given| *given = number);
        changed
    }

    /// The bytes of this clip, for [`from_bytes`](Self::from_bytes) of the same version.
    pub fn to_bytes(&self) -> Vec<u8> {
        CLIP.written(self)
    }

    /// A clip from its bytes.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] for bytes of another version and damaged ones.
    pub fn from_bytes(bytes: &[u8]) -> Result<SegmentedClip> {
        let clip: SegmentedClip = CLIP.read(bytes)?;
        if clip.is_valid() { Ok(clip) } else { Err(CLIP.damaged()) }
    }

    fn is_valid(&self) -> bool {
        let [width, height] = self.size;
        if [self.numbers.len(), self.locked.len(), self.named.len(), self.given.len()] != [256; 4]
            || self.hashes.len() != self.frames.len()
        {
            return false;
        }
        if self.frames.is_empty() {
            return self.size == [0, 0];
        }
        if ![width, height].iter().all(|side| (MIN_SIDE..=MAX_SIDE).contains(side)) {
            return false;
        }
        let [w, h] = self.working_size();
        self.frames.iter().all(|frame| frame.is_valid(w * h, width * height))
    }

    pub(super) fn check_index(&self, index: usize) -> Result<()> {
        let reason = || format!("there is no frame {index} in a clip of {} frames", self.len());
        if index < self.len() { Ok(()) } else { Err(Error::InvalidOption { name: "frame", reason: reason() }) }
    }

    pub(super) fn check(&self, index: usize, frame: &Frame) -> Result<()> {
        self.check_index(index)?;
        let (first, second) = ((self.size[0], self.size[1]), (frame.width(), frame.height()));
        if first != second {
            return Err(Error::FrameSizeMismatch { first, second });
        }
        if frame.hash() == self.hashes[index] { Ok(()) } else { Err(Error::OtherFrame { index }) }
    }

    pub(super) fn settings(&self) -> Settings {
        let quality = if self.best { Quality::Best } else { Quality::Fast };
        let pair = SegmentOptions { quality, ..SegmentOptions::default() };
        ClipOptions { pair, look_ahead: self.stream.then_some(0) }.settings(self.size)
    }

    /// Width and height of the working size.
    pub(super) fn working_size(&self) -> [usize; 2] {
        self.settings().working_size(self.size)
    }

    /// Full-size pixels for each pixel of the working size, along a side.
    pub(super) fn working_step(&self) -> usize {
        self.size[0].div_ceil(self.working_size()[0]).next_power_of_two()
    }

    /// Labels and odds of a frame as the clip was segmented.
    pub(super) fn found(&self, index: usize) -> (Vec<u8>, Plane) {
        let found = &self.frames[index].found;
        (found.labels(), found.odds(self.working_size()))
    }

    /// To the next frame of the scene; after the last one there is none.
    pub(super) fn onward(&self, index: usize) -> Option<Flow> {
        self.frames[index].onward.as_ref().map(|flow| flow.flow(self.working_size()[0]))
    }

    /// To the frame before; before the first one of a scene there is none.
    pub(super) fn back(&self, index: usize) -> Option<Flow> {
        self.frames[index].back.as_ref().map(|flow| flow.flow(self.working_size()[0]))
    }
}

/// A set of numbers of objects.
pub(super) type Numbers = [bool; 256];
/// The label of a pixel of which a correction says nothing.
pub(super) const NOTHING_SAID: u8 = u8::MAX;

fn invalid(name: &'static str, reason: &str) -> Error {
    Error::InvalidOption { name, reason: reason.into() }
}
