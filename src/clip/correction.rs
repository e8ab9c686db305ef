//! Corrections: what a person says of some frames is certain there, and goes through the whole scene.
//!
//! Each object is followed on its own, from everything that is said of it and nothing else: the order of corrections does not matter, and
//! what is said of one object changes no other. Where two objects of a person claim a pixel, the one that had it keeps it.
//!
//! 1. The corrected frame tells which objects it speaks of, or takes pixels from.
//! 2. What all frames say of an object is learnt, and how it looks where it was found.
//! 3. Each is followed forward from the first frame that speaks of it, and backward from the last (`correction/track.rs`).
//! 4. The claims of a frame become its layer over the labels found automatically (`clip/layer.rs`).

mod evidence;
mod look;
mod memory;
mod outline;
mod pair;
mod placing;
mod still;
mod sweep;
mod track;
mod view;
mod world;

use super::evidence::{Flow, KeptOdds};
use super::layer::{Layer, SaidFrame, Spread};
use super::runs::Runs;
use super::whole::{NOTHING_SAID, SegmentedClip};
use super::{MAX_LOOK_AHEAD, model};
use crate::error::Result;
use crate::frame::{Frame, Plane};
use crate::labelling::resolution::upsampling::upsample;
use crate::model::Model;
use crate::order::sort_few;
use look::Look;
pub use outline::Prompt;
pub(super) use outline::outline;
pub use pair::{Correction, MAX_CORRECTED, Relabelling, relabel};
use sweep::Claim;
use track::{Start, Track, Way};
use world::{Known, World};

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
    /// First and last frame of the scene.
    scene: [usize; 2],
    worlds: Vec<World>,
    /// The frame that is wanted, and what for.
    next: Option<(usize, Pass)>,
    /// Frames that are still to be surveyed, and for which object that was found, or for what is said there.
    survey: Vec<(usize, Option<u8>)>,
    /// Frames that speak for themselves.
    alone: Vec<usize>,
    /// Whether the layer of each frame of the scene is up to date.
    done: Vec<bool>,
    /// What there was of each frame of the scene.
    before: Vec<(Option<SaidFrame>, Option<Layer>)>,
    changed: Vec<usize>,
}

/// What a frame is wanted for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pass {
    /// To learn what objects look like, as they were found automatically and as is said.
    Survey,
    /// Because it speaks of an object, and no sweep comes to it.
    Alone,
    Sweep(Way),
}

impl ClipCorrection {
    pub(super) fn new(clip: &SegmentedClip, index: usize, labels: &[u8], spread: Spread) -> ClipCorrection {
        let scene @ [first, last] = clip.scene(index);
        ClipCorrection {
            index,
            said: Some((Runs::of(labels), spread)),
            scene,
            worlds: Vec::new(),
            next: Some((index, Pass::Sweep(Way::Forward))),
            survey: Vec::new(),
            alone: Vec::new(),
            done: vec![false; last + 1 - first],
            before: clip.frames[first..=last].iter().map(|frame| (frame.said.clone(), frame.layer.clone())).collect(),
            changed: Vec::new(),
        }
    }

    /// Index of the frame to [`take`](Self::take) next; none when the correction has spread.
    pub fn wanted(&self) -> Option<usize> {
        self.next.map(|(index, _)| index)
    }

    /// The frames changed so far, in the order in which they changed: first the corrected one.
    pub fn changed(&self) -> &[usize] {
        &self.changed
    }

    /// Takes everything back that the correction has changed so far.
    pub fn cancel(self, clip: &mut SegmentedClip) {
        for (frame, (said, layer)) in clip.frames[self.scene[0]..].iter_mut().zip(self.before) {
            (frame.said, frame.layer) = (said, layer);
        }
    }

    /// Takes the frame that is [`wanted`](Self::wanted).
    ///
    /// # Errors
    /// [`Error::FrameSizeMismatch`](crate::Error::FrameSizeMismatch), [`Error::OtherFrame`](crate::Error::OtherFrame); the correction can
    /// continue with the right frame.
    pub fn take(&mut self, clip: &mut SegmentedClip, frame: &Frame) -> Result<()> {
        let Some((index, pass)) = self.next else { return Ok(()) };
        clip.check(index, frame)?;
        let look = Look::new(frame);
        let mut pass = Some(pass);
        if let Some((said, spread)) = self.said.take() {
            let is_new = clip.frames[index].said.as_ref().is_none_or(|before| before.labels != said);
            let now = self.begin(clip, frame, said, spread);
            if is_new {
                self.at_once(clip, frame, &look, &now);
            }
            self.next = self.after_survey();
            // The frame is here already.
            pass = self.next.filter(|(wanted, _)| *wanted == index).map(|(_, pass)| pass);
        }
        // A frame may be wanted for several things after one another.
        while let Some(now) = pass {
            match now {
                Pass::Survey => {
                    let found = clip.found_at(index, look.size);
                    let said = clip.said_at(index, look.size, look.step);
                    while let Some((_, number)) = self.survey.pop_if(|(t, _)| *t == index) {
                        for track in self.worlds.iter_mut().flat_map(|world| &mut world.tracks) {
                            match (number, &said) {
                                (Some(number), _) if track.number == number => track.survey(&look, &found),
                                (None, Some((said, _))) if track.is_for_all(index) => {
                                    track.hear(&look, said, &found);
                                }
                                _ => {}
                            }
                        }
                    }
                    self.next = self.after_survey();
                }
                Pass::Alone => {
                    // Nothing is followed yet.
                    self.visit(clip, frame, &look, index, Way::Backward);
                    self.next = self.after_survey();
                }
                Pass::Sweep(way) => {
                    self.visit(clip, frame, &look, index, way);
                    self.next = self.after(index, way);
                }
            }
            pass = self.next.filter(|(wanted, _)| *wanted == index).map(|(_, pass)| pass);
        }
        if self.next.is_none() {
            self.finish(clip);
        }
        Ok(())
    }

    /// Which objects the correction is about, and what is said of each. Returns what the frame shows before.
    fn begin(&mut self, clip: &mut SegmentedClip, frame: &Frame, said: Runs, spread: Spread) -> Vec<u8> {
        let [first, last] = self.scene;
        let values = said.values();
        let says = values.iter().any(|&label| label != NOTHING_SAID);
        let mut touched = [false; 256];
        let mut touch = |number: u8| touched[usize::from(number)] = true;
        values.iter().for_each(|&label| touch(label));
        let persons = clip.persons_in(self.index);
        let now = clip.layered(self.index, frame.luminance());
        let mut loses = [false; 256];
        for (&said, &now) in values.iter().zip(&now) {
            loses[usize::from(now)] |= said != NOTHING_SAID && said != now;
        }
        let takes = |k: &u8| persons[usize::from(*k)] && loses[usize::from(*k)] && !clip.locked[usize::from(*k)];
        let takes_from: Vec<u8> = (1..NOTHING_SAID).filter(takes).collect();
        takes_from.iter().for_each(|&number| touch(number));
        if let Some(before) = &clip.frames[self.index].said {
            before.speaks_of.iter().chain(&before.takes_from).for_each(|&number| touch(number));
        }
        let starts_before: Vec<Vec<Start>> = (0..NOTHING_SAID).map(|number| self.starts(clip, number)).collect();
        clip.frames[self.index].said =
            says.then_some(SaidFrame { labels: said, spread, speaks_of: Vec::new(), takes_from });
        self.speak(clip);
        let starts: Vec<Vec<Start>> = (0..NOTHING_SAID).map(|number| self.starts(clip, number)).collect();
        let is_touched = |k: &u8| touched[usize::from(*k)] || starts[usize::from(*k)] != starts_before[usize::from(*k)];
        for number in (1..NOTHING_SAID).filter(is_touched) {
            let frames: Vec<usize> = starts[usize::from(number)].iter().map(|(t, _)| *t).collect();
            let of_these = |world: &&mut World| {
                world.decides.first().is_some_and(|&other| starts[usize::from(other)] == starts[usize::from(number)])
            };
            if let Some(world) = self.worlds.iter_mut().find(of_these) {
                world.decides.push(number);
                continue;
            }
            let mut tracks = Vec::new();
            for other in 1..NOTHING_SAID {
                let own: Vec<Start> =
                    starts[usize::from(other)].iter().copied().filter(|(t, _)| frames.contains(t)).collect();
                if other == number || !own.is_empty() {
                    tracks.push(Track::new(other, own, last + 1));
                }
            }
            self.worlds.push(World { tracks, decides: vec![number] });
        }
        // Each object in frames of its own: which others are followed makes no difference to it.
        for number in 1..NOTHING_SAID {
            if !self.worlds.iter().flat_map(|world| &world.tracks).any(|track| track.number == number) {
                continue;
            }
            let there: Vec<usize> = (first..=last).rev().filter(|&t| clip.finds(t, number)).collect();
            let count = there.len().min(MAX_LOOK_AHEAD);
            self.survey.extend((0..count).map(|k| (there[k * there.len() / count], Some(number))));
        }
        let tracks = || self.worlds.iter().flat_map(|world| &world.tracks);
        self.survey.extend((first..=last).filter(|&t| tracks().any(|track| track.is_for_all(t))).map(|t| (t, None)));
        sort_few(&mut self.survey, |(one, _), (other, _)| other.cmp(one));
        let [forward, backward] = [Way::Forward, Way::Backward].map(|way| self.first(way));
        let is_swept = |t: usize| forward.is_some_and(|from| t >= from) || backward.is_some_and(|from| t <= from);
        let speaks = |t: usize| self.worlds.iter().flat_map(|world| &world.tracks).any(|track| track.speaks(t));
        self.alone = (first..=last).filter(|&t| speaks(t) && !is_swept(t)).collect();
        now
    }

    /// The frames of the scene that speak of an object.
    fn starts(&self, clip: &SegmentedClip, number: u8) -> Vec<Start> {
        let start = |t: usize| {
            let said = clip.frames[t].said.as_ref()?;
            said.speaks_of.contains(&number).then_some((t, said.spread))
        };
        (self.scene[0]..=self.scene[1]).filter_map(start).collect()
    }

    /// Which objects each frame of the scene speaks of: those named there, and those found automatically of which part is said to be ground.
    /// Of one that another object takes over in some frame nothing needs to be said.
    fn speak(&self, clip: &mut SegmentedClip) {
        let size @ [width, height] = clip.working_size();
        let step = clip.working_step();
        let mut named: Vec<[bool; 256]> = Vec::new();
        let mut erased: Vec<[bool; 256]> = Vec::new();
        let mut taken = [false; 256];
        for t in self.scene[0]..=self.scene[1] {
            let (mut names, mut erases) = ([false; 256], [false; 256]);
            if let Some(said) = &clip.frames[t].said {
                said.labels.each().for_each(|(label, _)| names[usize::from(label)] = true);
                let values = at_size(&said.labels.values(), clip.size()[0], size, step);
                let (found, _) = clip.found(t);
                let mut sizes = [[0usize; 3]; 256];
                for p in 0..width * height {
                    let [all, ground, other] = &mut sizes[usize::from(found[p])];
                    *all += 1;
                    *ground += usize::from(values[p] == 0);
                    *other += usize::from(values[p] != 0 && values[p] != NOTHING_SAID && values[p] != found[p]);
                }
                for (label, &[all, ground, other]) in sizes.iter().enumerate().skip(1) {
                    taken[label] |= 2 * other > all;
                    // A lock that came later takes nothing back.
                    let is_free = !clip.locked[label] || said.speaks_of.contains(&(label as u8));
                    erases[label] = ground > 0 && ground + other < all && is_free;
                }
            }
            named.push(names);
            erased.push(erases);
        }
        let is_named = |label: usize| named.iter().any(|names| names[label]);
        for (k, t) in (self.scene[0]..=self.scene[1]).enumerate() {
            let speaks = |label: usize| named[k][label] || erased[k][label] && (!taken[label] || is_named(label));
            if let Some(said) = &mut clip.frames[t].said {
                said.speaks_of = (1..NOTHING_SAID).filter(|&label| speaks(usize::from(label))).collect();
            }
        }
    }

    /// The corrected frame at once, from what it shows now.
    fn at_once(&mut self, clip: &mut SegmentedClip, frame: &Frame, look: &Look, now: &[u8]) {
        let now = at_size(now, clip.size()[0], look.size, look.step);
        let said = clip.said_at(self.index, look.size, look.step);
        let known =
            Known { said: said.as_ref().map(|(said, spread)| (&said[..], spread.ways())), found: &now, flows: None };
        let mut claims = Vec::new();
        for &number in self.worlds.iter().flat_map(|world| &world.decides) {
            let mut alone = Track::new(number, vec![(self.index, Spread::Both)], self.index + 1);
            alone.know(look, &now);
            let mut world = World { tracks: vec![alone], decides: vec![number] };
            claims.append(&mut world.visit(self.index, Way::Forward, false, look, &known));
        }
        self.compose(clip, frame, look, self.index, &claims);
    }

    fn after_survey(&mut self) -> Option<(usize, Pass)> {
        if let Some((t, _)) = self.survey.last() {
            return Some((*t, Pass::Survey));
        }
        if let Some(t) = self.alone.pop() {
            return Some((t, Pass::Alone));
        }
        let forward = self.first(Way::Forward).map(|t| (t, Pass::Sweep(Way::Forward)));
        forward.or(self.first(Way::Backward).map(|t| (t, Pass::Sweep(Way::Backward))))
    }

    fn first(&self, way: Way) -> Option<usize> {
        let firsts = self.worlds.iter().filter_map(|world| world.first(way));
        if way == Way::Forward { firsts.min() } else { firsts.max() }
    }

    fn visit(&mut self, clip: &mut SegmentedClip, frame: &Frame, look: &Look, t: usize, way: Way) {
        let [first, last] = self.scene;
        let found = clip.found_at(t, look.size);
        let flow = |kept: Option<Flow>| kept.map(|flow| flow.enlarged(look.size));
        let [to, from] = match way {
            Way::Forward => [flow(clip.back(t)), if t > first { flow(clip.onward(t - 1)) } else { None }],
            Way::Backward => [flow(clip.onward(t)), if t < last { flow(clip.back(t + 1)) } else { None }],
        };
        let said = clip.said_at(t, look.size, look.step);
        let known = Known {
            said: said.as_ref().map(|(said, spread)| (&said[..], spread.ways())),
            found: &found,
            flows: to.as_ref().zip(from.as_ref()).map(|(to, from)| [to, from]),
        };
        let again = way == Way::Forward && self.first(Way::Backward).is_some_and(|furthest| t < furthest);
        let mut claims = Vec::new();
        for world in &mut self.worlds {
            claims.append(&mut world.visit(t, way, again, look, &known));
        }
        if !again {
            self.compose(clip, frame, look, t, &claims);
            self.done[t - first] = true;
        }
    }

    /// What comes after a frame of a sweep.
    fn after(&self, t: usize, way: Way) -> Option<(usize, Pass)> {
        let [first, last] = self.scene;
        let furthest = self.first(Way::Backward);
        let backward = |t: usize| (t, Pass::Sweep(Way::Backward));
        match way {
            Way::Backward => (t > first).then(|| backward(t - 1)),
            Way::Forward if t < last => Some((t + 1, Pass::Sweep(Way::Forward))),
            // The last frame that both sweeps need may have been composed on the way.
            Way::Forward => furthest.and_then(|furthest| match self.done[furthest - first] {
                true => (furthest > first).then(|| backward(furthest - 1)),
                false => Some(backward(furthest)),
            }),
        }
    }

    /// In frames that no sweep has come to, nothing is left of objects that nothing is said of any more.
    fn finish(&mut self, clip: &mut SegmentedClip) {
        let decided: Vec<u8> = self.worlds.iter().flat_map(|world| world.decides.clone()).collect();
        for t in self.scene[0]..=self.scene[1] {
            let speaks_of = clip.frames[t].said.as_ref().map_or(&[][..], |said| &said.speaks_of);
            let is_gone = |label: u8| decided.contains(&label) && !speaks_of.contains(&label);
            let Some(layer) = clip.frames[t].layer.as_ref().filter(|_| !self.done[t - self.scene[0]]) else { continue };
            if layer.labels.each().any(|(label, _)| is_gone(label)) {
                let mut labels = layer.labels.values();
                labels.iter_mut().filter(|label| is_gone(**label)).for_each(|label| *label = NOTHING_SAID);
                let [width, height] = clip.working_size();
                let odds = layer.odds.odds(width, height);
                let layer = clip.layer_of(&labels, &|_, p| odds.values()[p]);
                self.put(clip, t, layer);
            }
        }
    }

    /// Puts the claims of a frame over what was found.
    fn compose(
        &mut self,
        clip: &mut SegmentedClip,
        frame: &Frame,
        look: &Look,
        t: usize,
        claims: &[(u8, Option<Claim>)],
    ) {
        let [width, height] = clip.size();
        let before = clip.frames[t].layer.clone();
        let mut labels = match &before {
            Some(layer) => layer.labels.values(),
            None => vec![NOTHING_SAID; width * height],
        };
        let decided = |label: u8| claims.iter().any(|(number, _)| *number == label);
        let persons = clip.persons_in(t);
        let shown = labels.clone();
        // The objects of a person that the correction is not about keep what they have.
        let mut held: Vec<bool> = labels.iter().map(|&label| persons[usize::from(label)] && !decided(label)).collect();
        labels.iter_mut().zip(&held).filter(|(_, held)| !**held).for_each(|(label, _)| *label = NOTHING_SAID);
        if clip.locked.contains(&true) {
            let found = clip.found_full(t, frame.luminance());
            for (p, held) in held.iter_mut().enumerate() {
                // What was taken from it before it was locked stays taken.
                let found = usize::from(found[p]);
                *held |= shown[p] == NOTHING_SAID && clip.locked[found] && !persons[found];
            }
        }
        let mut best = vec![0.0f32; width * height];
        for (number, claim) in claims {
            let Some(claim) = claim.as_ref().filter(|claim| claim.mask.contains(&1)) else { continue };
            let mut mask = vec![0u8; look.pixels()];
            claim.area.pixels(look.size[0]).zip(&claim.mask).for_each(|(p, &inside)| mask[p] = inside);
            let full = upsample(&mask, look.size, 2, frame.luminance(), &Model::DEFAULT);
            for p in (0..full.len()).filter(|&p| full[p] > 0 && !held[p]) {
                let odds = claim.at(look.pixel(p, width), look.size[0]).max(f32::MIN_POSITIVE);
                if odds > best[p] {
                    (best[p], labels[p]) = (odds, *number);
                }
            }
        }
        if let Some(said) = &clip.frames[t].said {
            let said = said.labels.values();
            for p in (0..said.len()).filter(|&p| said[p] != NOTHING_SAID && !held[p]) {
                (best[p], labels[p]) = (2.0 * model().certain, said[p]);
            }
        }
        let [w, h] = clip.working_size();
        let old = before.map(|layer| layer.odds.odds(w, h));
        let layer = clip.layer_of(&labels, &|p, at| match held[p] {
            true => old.as_ref().map_or(0.0, |old| old.values()[at]),
            false => best[p].min(2.0 * model().certain),
        });
        self.put(clip, t, layer);
    }

    fn put(&mut self, clip: &mut SegmentedClip, t: usize, layer: Option<Layer>) {
        let labels = |layer: &Option<Layer>| layer.as_ref().map(|layer| layer.labels.clone());
        if labels(&clip.frames[t].layer) != labels(&layer) && !self.changed.contains(&t) {
            self.changed.push(t);
        }
        clip.frames[t].layer = layer;
    }
}

impl SegmentedClip {
    /// A layer of full-size labels, if they say anything. `odds` has those of a full-size pixel, and of the working pixel that it is the
    /// corner of.
    fn layer_of(&self, labels: &[u8], odds: &dyn Fn(usize, usize) -> f32) -> Option<Layer> {
        let ([width, height], [w, h]) = (self.size(), self.working_size());
        let step = self.working_step();
        labels.iter().any(|&label| label != NOTHING_SAID).then(|| {
            let odds = Plane::from_fn(w, h, |x, y| {
                let p = (y * step).min(height - 1) * width + (x * step).min(width - 1);
                match labels[p] {
                    NOTHING_SAID => 0.0,
                    0 => -2.0 * model().certain,
                    _ => odds(p, y * w + x),
                }
            });
            Layer { labels: Runs::of(labels), odds: KeptOdds::of(&odds) }
        })
    }

    /// What is said of a frame at a working size.
    fn said_at(&self, t: usize, size: [usize; 2], step: usize) -> Option<(Vec<u8>, Spread)> {
        let said = self.frames[t].said.as_ref()?;
        Some((at_size(&said.labels.values(), self.size()[0], size, step), said.spread))
    }
}

/// Labels of full size at a working size: what is said at the centre of each pixel, or anywhere in it.
fn at_size(said: &[u8], full_width: usize, [width, height]: [usize; 2], step: usize) -> Vec<u8> {
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
