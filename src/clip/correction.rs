//! Corrections: what a person says of some frames is certain there, and goes through the whole scene.
//!
//! Each object is followed on its own, from everything that is said of it and nothing else: the order of corrections does not matter, and
//! what is said of one object changes no other. Where two objects of a person claim a pixel, the one that had it keeps it.
//!
//! 1. The corrected frame tells which objects it speaks of, or takes pixels from.
//! 2. Each is followed forward from the first frame that speaks of it, and backward from the last (`correction/track.rs`).
//! 3. The claims of a frame become its layer over the labels found automatically (`clip/layer.rs`).

mod constants;
mod evidence;
mod look;
mod memory;
mod placing;
mod sweep;
mod track;

use std::collections::BTreeMap;

use super::evidence::{Flow, KeptOdds};
use super::layer::{Layer, SaidFrame, Spread};
use super::runs::Runs;
use super::whole::{NOTHING_SAID, SegmentedClip};
use crate::error::Result;
use crate::frame::{Frame, Plane};
use crate::labelling::resolution::upsampling::upsample;
use crate::workspace::{self, Buffer};
use constants::Constants;
use look::Look;
use sweep::{Claim, Said};
use track::{Scene, Start, Track};

/// Odds of what is said, nats.
const CERTAIN: f32 = 8.0;

/// A correction that spreads through a [`SegmentedClip`]. It asks for the frames that it needs:
///
/// ```
/// use veronese::Frame;
/// use veronese::clip::{ClipOptions, ClipSegmenter, Spread};
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
/// let mut correction = clip.correct(1, &labels, Spread::Both)?;
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
    /// What is said, until the frame has come.
    said: Option<(Runs, Spread)>,
    /// Frames of the scene.
    scene: [usize; 2],
    tracks: Vec<Track>,
    /// The frame that is wanted, and what for.
    next: Option<(usize, Pass)>,
    /// Frames that are still to be surveyed.
    survey: Vec<usize>,
    /// Frames whose layer is up to date.
    done: Vec<bool>,
    /// What there was before, of every frame that has changed.
    before: BTreeMap<usize, Option<Layer>>,
    said_before: Option<SaidFrame>,
    changed: Vec<usize>,
}

/// What a frame is wanted for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pass {
    /// To learn what objects look like that were found automatically.
    Survey,
    Forward,
    Backward,
}

/// Frames that are surveyed at most.
const SURVEYED: usize = 8;

impl ClipCorrection {
    pub(super) fn new(clip: &mut SegmentedClip, index: usize, labels: &[u8], spread: Spread) -> ClipCorrection {
        let (mut first, mut last) = (index, index);
        while clip.frames[first].back.is_some() && first > 0 {
            first -= 1;
        }
        while last + 1 < clip.len() && clip.frames[last + 1].back.is_some() {
            last += 1;
        }
        ClipCorrection {
            index,
            said: Some((Runs::of(labels), spread)),
            scene: [first, last],
            tracks: Vec::new(),
            next: Some((index, Pass::Forward)),
            survey: Vec::new(),
            done: vec![false; last + 1 - first],
            before: BTreeMap::new(),
            said_before: clip.frames[index].said.clone(),
            changed: Vec::new(),
        }
    }

    /// Index of the frame to [`take`](Self::take) next; none when the correction has spread.
    pub fn wanted(&self) -> Option<usize> {
        self.next.map(|(index, _)| index)
    }

    /// The frames changed so far, in the order in which they changed.
    pub fn changed(&self) -> &[usize] {
        &self.changed
    }

    /// Number of frames that are still to be taken, and of those that there were.
    pub fn progress(&self) -> [usize; 2] {
        let done = self.done.iter().filter(|done| **done).count();
        [done, self.done.len()]
    }

    /// Takes the frame that is [`wanted`](Self::wanted).
    ///
    /// # Errors
    /// [`Error::FrameSizeMismatch`](crate::Error::FrameSizeMismatch), [`Error::OtherFrame`](crate::Error::OtherFrame); the correction can
    /// continue with the right frame.
    pub fn take(&mut self, clip: &mut SegmentedClip, frame: &Frame) -> Result<()> {
        let Some((index, pass)) = self.next else { return Ok(()) };
        clip.check(index, frame)?;
        let _call = workspace::begin(clip.size());
        let constants = Constants::current();
        let look = Look::new(frame);
        if let Some((said, spread)) = self.said.take() {
            self.begin(clip, frame, said, spread);
            self.first_look(clip, frame, &look, &constants);
            self.survey = self.surveyed(clip);
            self.next = self.after_survey();
            if self.next != Some((index, pass)) {
                self.finish_if_done(clip);
                return Ok(());
            }
        }
        if pass == Pass::Survey {
            let found = clip.found_at(index, look.size);
            self.tracks.iter_mut().filter(|track| found.contains(&track.number)).for_each(|track| track.survey(&look, &found, &constants));
            self.next = self.after_survey();
        } else {
            self.visit(clip, frame, &look, index, pass == Pass::Backward, &constants);
        }
        self.finish_if_done(clip);
        Ok(())
    }

    /// Frames in which objects were found that a person speaks of now, in even steps.
    fn surveyed(&self, clip: &SegmentedClip) -> Vec<usize> {
        let [first, last] = self.scene;
        let shows = |t: &usize| clip.finds_any(*t, &|label| self.tracks.iter().any(|track| track.number == label));
        let there: Vec<usize> = (first..=last).rev().filter(shows).collect();
        let count = there.len().min(SURVEYED);
        (0..count).map(|k| there[k * there.len() / count]).collect()
    }

    fn after_survey(&mut self) -> Option<(usize, Pass)> {
        if let Some(t) = self.survey.pop() {
            return Some((t, Pass::Survey));
        }
        let first = self.tracks.iter().filter_map(Track::first).min();
        let last = self.tracks.iter().filter_map(Track::last).max();
        first.map(|t| (t, Pass::Forward)).or(last.map(|t| (t, Pass::Backward)))
    }

    /// Takes everything back that the correction has changed so far.
    pub fn cancel(self, clip: &mut SegmentedClip) {
        for (index, layer) in self.before {
            clip.frames[index].layer = layer;
        }
        clip.frames[self.index].said = self.said_before;
    }

    /// Which objects the correction is about.
    fn begin(&mut self, clip: &mut SegmentedClip, frame: &Frame, said: Runs, spread: Spread) {
        let values = said.values();
        let now = clip.layered(self.index, frame.luminance());
        let mut sizes = [0usize; 256];
        let mut ground = [0usize; 256];
        let mut others = [0usize; 256];
        let mut named = [false; 256];
        for (&said, &now) in values.iter().zip(&now) {
            let now = usize::from(now);
            sizes[now] += 1;
            if said != NOTHING_SAID {
                named[usize::from(said)] = true;
                if usize::from(said) != now {
                    others[now] += 1;
                    ground[now] += usize::from(said == 0);
                }
            }
        }
        let persons = clip.persons();
        let speaks_of: Vec<u8> = (1..NOTHING_SAID)
            .filter(|&k| {
                let n = usize::from(k);
                // Part of an object found automatically is taken from it: the rest is what it is.
                named[n] || (!persons.contains(&k) && !clip.locked[n] && ground[n] > 0 && others[n] < sizes[n])
            })
            .collect();
        let takes_from: Vec<u8> =
            persons.iter().copied().filter(|&k| others[usize::from(k)] > 0 && !speaks_of.contains(&k)).collect();
        let mut touched: Vec<u8> = speaks_of.iter().chain(&takes_from).copied().collect();
        if let Some(before) = &clip.frames[self.index].said {
            touched.extend(before.speaks_of.iter().chain(&before.takes_from));
        }
        touched.sort_unstable();
        touched.dedup();
        let says = values.iter().any(|&label| label != NOTHING_SAID);
        clip.frames[self.index].said = says.then_some(SaidFrame { labels: said, spread, speaks_of, takes_from });
        let [first, last] = self.scene;
        self.tracks = touched
            .into_iter()
            .map(|number| {
                let starts: Vec<Start> = (first..=last)
                    .filter_map(|t| {
                        let said = clip.frames[t].said.as_ref()?;
                        said.speaks_of.contains(&number).then_some((t, said.spread))
                    })
                    .collect();
                Track::new(number, starts)
            })
            .collect();
    }

    /// The corrected frame at once, from what it shows now.
    fn first_look(&mut self, clip: &mut SegmentedClip, frame: &Frame, look: &Look, constants: &Constants) {
        let said = clip.frames[self.index].said.as_ref().map(|said| said.labels.values());
        let now = at_working_size(&clip.layered(self.index, frame.luminance()), clip.size()[0], look);
        let claims: Vec<Option<Claim>> = self
            .tracks
            .iter()
            .map(|track| {
                let said = said.as_ref().map(|said| of_object(said, track.number, clip.size()[0], look));
                track.at_once(look, &now, said.as_deref(), constants)
            })
            .collect();
        self.compose(clip, frame, look, self.index, &claims);
    }

    fn visit(&mut self, clip: &mut SegmentedClip, frame: &Frame, look: &Look, t: usize, backward: bool, constants: &Constants) {
        let found = clip.found_at(t, look.size);
        let flow = |kept: Option<Flow>| kept.map(|flow| flow.enlarged(look.size));
        let [first, last] = self.scene;
        let [onward, back] = [flow(clip.onward(t)), flow(clip.back(t))];
        let from_before = if t > first { flow(clip.onward(t - 1)) } else { None };
        let from_after = if t < last { flow(clip.back(t + 1)) } else { None };
        let scene = Scene {
            look,
            found: &found,
            onward: onward.as_ref(),
            back: back.as_ref(),
            from_before: from_before.as_ref(),
            from_after: from_after.as_ref(),
        };
        let said = clip.frames[t].said.as_ref().map(|said| said.labels.values());
        let furthest = self.tracks.iter().filter_map(Track::last).max();
        let again = furthest.is_some_and(|last| t < last);
        let mut claims = Vec::with_capacity(self.tracks.len());
        for track in &mut self.tracks {
            let said = said.as_ref().map(|said| of_object(said, track.number, clip.size()[0], look));
            claims.push(if backward {
                track.backward(t, &scene, said.as_deref(), constants)
            } else {
                track.onward(t, &scene, said.as_deref(), again, constants)
            });
        }
        if backward || !again {
            self.compose(clip, frame, look, t, &claims);
            self.done[t - first] = true;
        }
        self.next = if backward {
            (t > first).then(|| (t - 1, Pass::Backward))
        } else if t < last {
            Some((t + 1, Pass::Forward))
        } else {
            furthest.and_then(|furthest| {
                // The last frame that both sweeps need was composed on the way.
                let from = if self.done[furthest - first] { furthest.checked_sub(1)? } else { furthest };
                (from >= first).then_some((from, Pass::Backward))
            })
        };
    }

    /// In frames that no sweep has come to, nothing is left of objects that nothing is said of any more.
    fn finish_if_done(&mut self, clip: &mut SegmentedClip) {
        if self.next.is_some() {
            return;
        }
        let [first, last] = self.scene;
        for t in first..=last {
            let speaks = |number: u8| {
                clip.frames[t].said.as_ref().is_some_and(|said| said.speaks_of.contains(&number))
            };
            let gone: Vec<u8> = self.tracks.iter().map(|track| track.number).filter(|&number| !speaks(number)).collect();
            let Some(layer) = clip.frames[t].layer.clone().filter(|_| !self.done[t - first]) else { continue };
            if layer.labels.each().any(|(label, _)| gone.contains(&label)) {
                let labels = layer.labels.map(|label| if gone.contains(&label) { NOTHING_SAID } else { label });
                let layer = Layer { labels, odds: layer.odds };
                self.put(clip, t, Some(layer));
            }
        }
    }

    /// Puts the claims of a frame over what was found.
    fn compose(&mut self, clip: &mut SegmentedClip, frame: &Frame, look: &Look, t: usize, claims: &[Option<Claim>]) {
        let [width, height] = clip.size();
        let before = clip.frames[t].layer.clone();
        let mut labels = match &before {
            Some(layer) => layer.labels.values(),
            None => Buffer::filled(width * height, NOTHING_SAID),
        };
        let said = clip.frames[t].said.as_ref().map(|said| said.labels.values());
        let touched = |label: u8| self.tracks.iter().any(|track| track.number == label);
        let persons = clip.persons();
        let held: Vec<bool> =
            labels.iter().map(|&label| label != NOTHING_SAID && label != 0 && !touched(label) && persons.contains(&label)).collect();
        for (label, _) in labels.iter_mut().zip(&held).filter(|(_, held)| !**held) {
            *label = NOTHING_SAID;
        }
        let mut best = vec![0.0f32; width * height];
        for (track, claim) in self.tracks.iter().zip(claims) {
            let Some(claim) = claim.as_ref().filter(|claim| claim.mask.contains(&1)) else { continue };
            let mut mask = vec![0u8; look.size[0] * look.size[1]];
            claim.pixels(look.size[0]).for_each(|(p, k)| mask[p] = claim.mask[k]);
            let full = upsample(&mask, look.size, 2, frame.luminance());
            for (p, _) in full.iter().enumerate().filter(|&(p, inside)| *inside > 0 && !held[p]) {
                let odds = claim.at(look.pixel(p, width), look.size[0]).max(0.01);
                if odds > best[p] {
                    (best[p], labels[p]) = (odds, track.number);
                }
            }
        }
        if let Some(said) = &said {
            for (p, &said) in said.iter().enumerate().filter(|&(p, said)| *said != NOTHING_SAID && !held[p]) {
                labels[p] = said;
                best[p] = CERTAIN;
            }
        }
        if clip.locked.contains(&true) {
            let found = clip.found_full(t, frame.luminance());
            for (p, label) in labels.iter_mut().enumerate() {
                let f = usize::from(found[p]);
                if clip.locked[f] && !persons.contains(&found[p]) && !touched(found[p]) {
                    *label = NOTHING_SAID;
                }
            }
        }
        let layer = labels.iter().any(|&label| label != NOTHING_SAID).then(|| {
            let [w, h] = clip.working_size();
            let step = width.div_ceil(w).next_power_of_two();
            let old = before.map(|layer| layer.odds.odds(w, h));
            let odds = Plane::from_fn(w, h, |x, y| {
                let p = (y * step).min(height - 1) * width + (x * step).min(width - 1);
                match labels[p] {
                    NOTHING_SAID => 0.0,
                    0 => -CERTAIN,
                    _ if held[p] => old.as_ref().map_or(0.0, |old| old.at(x, y)),
                    _ => best[p].min(CERTAIN),
                }
            });
            Layer { labels: Runs::of(&labels), odds: KeptOdds::of(&odds) }
        });
        self.put(clip, t, layer);
    }

    fn put(&mut self, clip: &mut SegmentedClip, t: usize, layer: Option<Layer>) {
        let now = &mut clip.frames[t].layer;
        let same = match (&*now, &layer) {
            (Some(one), Some(other)) => one.labels == other.labels,
            (None, None) => true,
            _ => false,
        };
        if !same && !self.changed.contains(&t) {
            self.changed.push(t);
        }
        let old = std::mem::replace(now, layer);
        self.before.entry(t).or_insert(old);
    }
}

/// What is said of each working pixel about an object.
fn of_object(said: &[u8], number: u8, full_width: usize, look: &Look) -> Vec<Said> {
    at_working_size(said, full_width, look)
        .iter()
        .map(|&label| match label {
            NOTHING_SAID => Said::Nothing,
            label if label == number => Said::Object,
            _ => Said::Other,
        })
        .collect()
}

/// What is said of each working pixel: at its centre, or anywhere in it.
fn at_working_size(said: &[u8], full_width: usize, look: &Look) -> Vec<u8> {
    let ([width, height], step) = (look.size, look.step);
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
