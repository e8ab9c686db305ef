//! Corrections: what a person says of one frame holds there, and spreads to the frames before and after until they contradict it.
//!
//! ```text
//! E(l) = Σ_p (1 − g) · found(l) + g · carried(l) + colour(l) + borders      at every pixel p of the next frame
//! ```
//! `g`, 0…1, is how far a pixel is governed by the correction: it begins at 1, is carried along the motions with the labels, falls where
//! these do not explain the next frame, and with every frame. Objects that the pairs saw no motion of have theirs estimated on the
//! corrected region. A frame follows the nearest correction.

mod carrying;
mod colours;

use std::rc::Rc;

use super::evidence::Flow;
use super::runs::Runs;
use super::whole::{Corrected, Labelling, NOTHING_SAID, SegmentedClip};
use crate::error::Result;
use crate::frame::filter::gaussian;
use crate::frame::pyramid::{Appearance, FramePyramid};
use crate::frame::{Frame, Plane};
use crate::labelling::solver::{MAX_LABELS, Solver};
use crate::labelling::terms::smoothness::Borders;
use crate::labelling::terms::strokes::add_strokes;
use crate::motion::AffineMotion;
use crate::order::{descending, sort_few};
use crate::workspace;
use carrying::Carried;
use colours::LabelColours;

// The constants below were set by hand, with true masks of one frame as corrections of ten real clips.

/// Share of its hold that a correction loses with every frame.
const HOLD: f32 = 0.95;
/// A correction that governs no pixel by more than this has ended.
const WEAKEST: f32 = 0.1;
/// Frames without any change after which a correction has ended.
const QUIET: usize = 3;
/// Price of a label other than the one found, at full certainty: in the corrected frame, where the person knows better, and in others …
const FOUND: [f32; 2] = [0.5, 1.5];
/// … of one other than what the correction carries here …
const CARRIED: f32 = 3.0;
/// … and weight of the colours, per nat.
const COLOUR_WEIGHT: f32 = 0.5;
/// Weight of a pixel of the corrected frame of which nothing was said when colours are learned.
const UNSAID: f32 = 0.1;
/// Price of a border.
const SMOOTHNESS: f32 = 6.0;
/// Odds, nats, from which a found label is certain …
const CERTAIN: f32 = 4.0;
/// … and those of what a correction says.
const MOST_ODDS: f32 = 8.0;
/// Noise that edges stand out from, grey levels.
const EDGE_NOISE: f32 = 1.0;
/// How far beyond the pixels it governs a correction may change labels: standard deviation, working pixels.
const REACH: f32 = 4.0;
/// Influence below which no label changes.
const NO_INFLUENCE: f32 = 0.05;
/// Share of an object's pixels that must be carried with another number for the object to be that one.
const SAME_OBJECT: f64 = 0.6;
/// What is left of a hold on an object found with another number: which number it has, the frames cannot contradict.
const NUMBER_HOLD: f32 = 0.5;

/// A correction that spreads through a [`SegmentedClip`]. It asks for the frames that it needs:
///
/// ```
/// use veronese::Frame;
/// use veronese::clip::{ClipOptions, ClipSegmenter};
///
/// # fn main() -> veronese::Result<()> {
/// let frames = [(); 3].map(|()| Frame::from_rgba(64, 48, [90; 4 * 64 * 48].as_slice()).expect("a frame"));
/// let mut segmenter = ClipSegmenter::new(ClipOptions::default())?;
/// for frame in &frames {
///     segmenter.push(frame.clone())?;
/// }
/// let mut clip = segmenter.conclude();
///
/// // The left half of frame 1 is object 7; nothing is said of the rest.
/// let labels: Vec<u8> = (0..64 * 48).map(|p| if p % 64 < 32 { 7 } else { 255 }).collect();
/// let mut correction = clip.correct(1, &labels)?;
/// while let Some(index) = correction.wanted() {
///     correction.take(&mut clip, &frames[index])?;
/// }
/// assert!(correction.changed().contains(&1));
/// assert_eq!(clip.frame(1, &frames[1])?.labels[0], 7);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct ClipCorrection {
    index: usize,
    /// What is said of each full-size pixel of the frame.
    said: Runs,
    direction: Direction,
    /// The corrected frame, once it was taken.
    start: Option<Front>,
    /// The frame that the correction has reached.
    front: Option<Front>,
    colours: LabelColours,
    changed: Vec<usize>,
    /// Last frames without change.
    quiet: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Direction {
    Here,
    Onward,
    Back,
    Ended,
}

/// A frame that the correction has reached.
#[derive(Clone, Debug)]
struct Front {
    index: usize,
    pyramid: Rc<FramePyramid>,
    labels: Vec<u8>,
    /// How far each pixel is governed by the correction, 0…1.
    governed: Plane,
    /// Motions that were estimated on the way here, by label.
    motions: Vec<(u8, AffineMotion)>,
}

impl ClipCorrection {
    pub(super) fn new(clip: &mut SegmentedClip, index: usize, labels: &[u8]) -> ClipCorrection {
        let mut changed = Vec::new();
        for (t, frame) in clip.frames.iter_mut().enumerate() {
            if frame.corrected.take_if(|corrected| corrected.origin == index).is_some() {
                changed.push(t);
            }
        }
        // Where nothing is said, an earlier correction is taken back and no more.
        let says = labels.iter().any(|&label| label != NOTHING_SAID);
        ClipCorrection {
            index,
            said: Runs::of(labels),
            direction: if says { Direction::Here } else { Direction::Ended },
            start: None,
            front: None,
            colours: LabelColours::default(),
            changed,
            quiet: 0,
        }
    }

    /// Index of the frame to [`take`](Self::take) next; none when the correction has ended.
    pub fn wanted(&self) -> Option<usize> {
        match (self.direction, &self.front) {
            (Direction::Ended, _) => None,
            (Direction::Onward, Some(front)) => Some(front.index + 1),
            (Direction::Back, Some(front)) => Some(front.index - 1),
            _ => Some(self.index),
        }
    }

    /// The frames changed so far, in ascending order.
    pub fn changed(&self) -> &[usize] {
        &self.changed
    }

    /// Takes the frame that is [`wanted`](Self::wanted).
    ///
    /// # Errors
    /// [`Error::FrameSizeMismatch`](crate::Error::FrameSizeMismatch), [`Error::OtherFrame`](crate::Error::OtherFrame); the correction can
    /// continue with the right frame.
    pub fn take(&mut self, clip: &mut SegmentedClip, frame: &Frame) -> Result<()> {
        let Some(index) = self.wanted() else { return Ok(()) };
        clip.check(index, frame)?;
        let _call = workspace::begin(clip.size());
        let settings = clip.settings();
        let pyramid = Rc::new(settings.pyramid(frame));
        let appearance = pyramid.appearance(frame).clone();
        match self.front.take() {
            None => {
                let front = self.corrected(clip, pyramid, &appearance);
                self.start = Some(front.clone());
                self.turn(clip, front, Direction::Onward);
            }
            Some(last) => {
                let (front, has_changed) = self.spread(clip, &last, index, pyramid, &appearance);
                self.quiet = if has_changed { 0 } else { self.quiet + 1 };
                self.go_on(clip, front);
            }
        }
        Ok(())
    }

    /// Goes on from a frame, or turns round.
    fn go_on(&mut self, clip: &SegmentedClip, front: Front) {
        let weak = front.governed.values().iter().all(|&governed| governed < WEAKEST);
        if weak || self.quiet >= QUIET || !self.may_go(clip, front.index) {
            match (self.direction, self.start.take()) {
                (Direction::Onward, Some(start)) => self.turn(clip, start, Direction::Back),
                _ => self.direction = Direction::Ended,
            }
        } else {
            self.front = Some(front);
        }
    }

    fn turn(&mut self, clip: &SegmentedClip, from: Front, direction: Direction) {
        (self.direction, self.quiet) = (direction, 0);
        self.go_on(clip, from);
    }

    /// Whether the scene goes on beyond a frame, and this correction is the nearest there.
    fn may_go(&self, clip: &SegmentedClip, index: usize) -> bool {
        let next = match self.direction {
            Direction::Onward if index + 1 < clip.len() && clip.back(index + 1).is_some() => index + 1,
            Direction::Back if index > 0 && clip.back(index).is_some() => index - 1,
            _ => return false,
        };
        let nearest = |origin: usize| next.abs_diff(origin) > next.abs_diff(self.index);
        clip.frames[next].corrected.as_ref().is_none_or(|other| nearest(other.origin))
    }

    /// The corrected frame itself: what is said there holds, and takes the region around it along.
    fn corrected(&mut self, clip: &mut SegmentedClip, pyramid: Rc<FramePyramid>, appearance: &Appearance) -> Front {
        let size = clip.working_size();
        let (found, odds) = clip.found(self.index);
        let said = at_working_size(&self.said.values(), clip.size()[0], size, pyramid.reduction);
        let known: Vec<u8> =
            said.iter().zip(&found[..]).map(|(&s, &f)| if s == NOTHING_SAID { f } else { s }).collect();
        let numbers = numbers([&said, &known]);
        self.colours.learn(&appearance.palette, &known, |p| if said[p] == NOTHING_SAID { UNSAID } else { 1.0 });
        let colours = self.colours.prices(&numbers);
        let mut costs = planes(numbers.len(), size, |k, p| {
            FOUND[0] * other_than(known[p], numbers[k], odds.values()[p])
                + COLOUR_WEIGHT * colours[k][appearance.palette.index(p)]
        });
        let set = |label: &u8| numbers.iter().position(|number| number == label).map_or(0, |k| 1 << k);
        let allowed: Vec<u16> = said.iter().map(set).collect();
        let influence = add_strokes(&mut costs, &allowed, &appearance.pictures[0].luminance);
        let solved = borders(appearance).solve(&costs, Solver::BEST);
        let label = |p: usize| match said[p] {
            NOTHING_SAID if influence[p] < NO_INFLUENCE || !numbers.contains(&found[p]) => found[p],
            NOTHING_SAID => numbers[usize::from(solved[p])],
            said => said,
        };
        let labels: Vec<u8> = (0..said.len()).map(label).collect();
        let [width, height] = size;
        let governs = |p: usize| if said[p] != NOTHING_SAID || labels[p] != found[p] { 1.0 } else { influence[p] };
        let governed = Plane::from_buffer(width, height, (0..said.len()).map(governs).collect());
        self.keep(clip, self.index, &labels, odds, &governed, Some(self.said.clone()));
        Front { index: self.index, pyramid, labels, governed, motions: Vec::new() }
    }

    /// Carries a correction from one frame to the next; tells whether it has changed anything there.
    fn spread(
        &mut self,
        clip: &mut SegmentedClip,
        last: &Front,
        index: usize,
        pyramid: Rc<FramePyramid>,
        appearance: &Appearance,
    ) -> (Front, bool) {
        let flow = if self.direction == Direction::Onward { clip.onward(last.index) } else { clip.back(last.index) };
        let (found, odds) = clip.found(index);
        let numbers = numbers([&last.labels, &found]);
        let Carried { labels: carried, mut governed, motions } =
            Carried::new(last, &pyramid, &flow.unwrap_or_else(|| Flow::still(clip.working_size())), &numbers);
        let renamed = renamed(&found, &numbers, &carried);
        for (p, governed) in governed.values_mut().iter_mut().enumerate() {
            *governed *= HOLD;
            if renamed[p] != found[p] {
                *governed = governed.max(NUMBER_HOLD);
            }
        }
        let near = gaussian(&governed, REACH);
        let reach = |p: usize| (2.0 * near.values()[p]).max(governed.values()[p]).min(1.0);
        let colours = self.colours.prices(&numbers);
        let costs = planes(numbers.len(), clip.working_size(), |k, p| {
            let all: f32 = carried.iter().map(|plane| plane.values()[p]).sum();
            let share = if all > 0.0 { carried[k].values()[p] / all } else { 0.0 };
            let g = governed.values()[p];
            (1.0 - g) * FOUND[1] * other_than(renamed[p], numbers[k], odds.values()[p])
                + g * CARRIED * (1.0 - share)
                + reach(p) * COLOUR_WEIGHT * colours[k][appearance.palette.index(p)]
        });
        let solved = borders(appearance).solve(&costs, Solver::FAST);
        let settled = |p: usize| reach(p) < NO_INFLUENCE || !numbers.contains(&renamed[p]);
        let label = |p: usize| if settled(p) { renamed[p] } else { numbers[usize::from(solved[p])] };
        let labels: Vec<u8> = (0..solved.len()).map(label).collect();
        // What grew beyond what was carried is held half as firmly, like what was carried and is not kept.
        let firmest = governed.values().iter().copied().fold(0.0, f32::max);
        for (p, governed) in governed.values_mut().iter_mut().enumerate() {
            if labels[p] != renamed[p] {
                *governed = governed.max(0.5 * firmest);
            } else if carried[usize::from(solved[p])].values()[p] < 0.5 {
                *governed *= 0.5;
            }
        }
        self.colours.learn(&appearance.palette, &labels, |p| governed.values()[p]);
        let has_changed = labels[..] != found[..];
        if has_changed {
            self.keep(clip, index, &labels, odds, &governed, None);
        }
        (Front { index, pyramid, labels, governed, motions }, has_changed)
    }

    /// Keeps the labels of a frame. Their odds are at least as certain as the correction.
    fn keep(
        &mut self,
        clip: &mut SegmentedClip,
        index: usize,
        labels: &[u8],
        mut odds: Plane,
        governed: &Plane,
        said: Option<Runs>,
    ) {
        for ((odds, &label), governed) in odds.values_mut().iter_mut().zip(labels).zip(governed.values()) {
            let certain = MOST_ODDS * governed;
            *odds = if label > 0 { odds.max(certain) } else { odds.min(-certain) };
        }
        let labelling = Labelling::of(labels, &odds);
        clip.frames[index].corrected = Some(Corrected { labelling, origin: self.index, said });
        if let Err(place) = self.changed.binary_search(&index) {
            self.changed.insert(place, index);
        }
    }
}

/// What is said of each working pixel: at its centre, or anywhere in it.
fn at_working_size(said: &[u8], full_width: usize, [width, height]: [usize; 2], step: usize) -> Vec<u8> {
    let mut working = vec![NOTHING_SAID; width * height];
    for (p, &label) in said.iter().enumerate().filter(|(_, label)| **label != NOTHING_SAID) {
        let (x, y) = (p % full_width, p / full_width);
        let here = &mut working[(y / step).min(height - 1) * width + (x / step).min(width - 1)];
        if *here == NOTHING_SAID || (x % step, y % step) == (step / 2, step / 2) {
            *here = label;
        }
    }
    working
}

/// One plane of costs for each label.
fn planes(labels: usize, [width, height]: [usize; 2], cost: impl Fn(usize, usize) -> f32) -> Vec<Plane> {
    let plane = |k| Plane::from_buffer(width, height, (0..width * height).map(|p| cost(k, p)).collect());
    (0..labels).map(plane).collect()
}

/// How certain it is that a pixel has another label than this, 0…1: one was found with some odds.
fn other_than(found: u8, label: u8, odds: f32) -> f32 {
    if found == label { 0.0 } else { (odds.abs() / CERTAIN).min(1.0) }
}

/// The background and the labels of some pixels, those of the first list first, as many as can be solved.
fn numbers(lists: [&[u8]; 2]) -> Vec<u8> {
    let mut numbers = vec![0u8];
    for list in lists {
        let mut counts = [0usize; 256];
        list.iter().for_each(|&label| counts[usize::from(label)] += 1);
        let mut new: Vec<u8> =
            (1..NOTHING_SAID).filter(|&k| counts[usize::from(k)] > 0 && !numbers.contains(&k)).collect();
        sort_few(&mut new, |&j, &k| counts[usize::from(k)].cmp(&counts[usize::from(j)]));
        numbers.extend(new);
    }
    numbers.truncate(MAX_LABELS);
    numbers
}

/// The labels found, with the numbers that the correction carries to the objects as a whole.
fn renamed(labels: &[u8], numbers: &[u8], carried: &[Plane]) -> Vec<u8> {
    let mut votes = vec![vec![0usize; numbers.len()]; 256];
    let mut sizes = [0usize; 256];
    for (p, &label) in labels.iter().enumerate().filter(|(_, label)| **label > 0) {
        let strongest = descending(carried.iter().map(|plane| f64::from(plane.values()[p])))[0];
        votes[usize::from(label)][strongest] += 1;
        sizes[usize::from(label)] += 1;
    }
    let number = |label: u8| {
        let votes = &votes[usize::from(label)];
        let most = (1..numbers.len()).find(|&k| votes[k] as f64 >= SAME_OBJECT * sizes[usize::from(label)] as f64);
        most.map_or(label, |k| numbers[k])
    };
    let numbers: Vec<u8> =
        (0..=u8::MAX).map(|label| if sizes[usize::from(label)] > 0 { number(label) } else { label }).collect();
    labels.iter().map(|&label| numbers[usize::from(label)]).collect()
}

fn borders(appearance: &Appearance) -> Borders {
    Borders::new(&appearance.pictures[0], EDGE_NOISE, SMOOTHNESS)
}
