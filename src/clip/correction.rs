//! Corrections: what a person says of an object in one frame is certain there, and goes through the whole scene.
//!
//! Each object is followed on its own, from everything that is said of it and nothing else. Where two objects of a person claim a pixel, the
//! one that had it keeps it.
//!
//! 1. The corrected frame tells which objects it speaks of.
//! 2. What all frames say of an object is learnt, and how it looks where it was found.
//! 3. Each is followed forward from the first frame that speaks of it, and backward from the last (`correction/track.rs`).
//! 4. The claims of a frame become its layer over the labels found automatically (`clip/layer.rs`).

mod evidence;
mod local;
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

use super::annotation::{Change, Said, Seed, Spread};
use super::changes::Changes;
use super::evidence::{Flow, KeptOdds};
use super::layer::Layer;
use super::runs::Runs;
use super::whole::{NOTHING_SAID, Numbers, SegmentedClip};
use super::{MAX_LOOK_AHEAD, model};
use crate::error::Result;
use crate::frame::{Frame, Plane};
use crate::labelling::resolution::upsampling::upsample;
use crate::model::Model;
use crate::order::sort_few;
use look::Look;
pub(super) use outline::check;
use outline::outline;
pub use pair::{Correction, MAX_CORRECTED, Relabelling, relabel};
use sweep::Claim;
use track::{Start, Track, Way};
use world::{Known, World};

/// A correction of one frame that spreads through a [`SegmentedClip`]. It asks for the frames that it needs.
#[derive(Clone, Debug)]
pub(super) struct FrameCorrection {
    index: usize,
    /// What is said, until the frame has come.
    change: Option<Change>,
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
    /// What the corrected frame showed before.
    before: Runs,
    /// Which objects of each frame of the scene were a person's.
    persons: Vec<Numbers>,
    /// Of which objects something was added to what was said, and nothing taken back.
    extends: Numbers,
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

impl FrameCorrection {
    pub(super) fn new(clip: &SegmentedClip, index: usize, change: Change) -> FrameCorrection {
        let scene @ [first, last] = clip.scene(index);
        FrameCorrection {
            index,
            change: Some(change),
            scene,
            worlds: Vec::new(),
            next: Some((index, Pass::Sweep(Way::Forward))),
            survey: Vec::new(),
            alone: Vec::new(),
            done: vec![false; last + 1 - first],
            before: Default::default(),
            persons: (first..=last).map(|t| clip.persons_in(t)).collect(),
            extends: [true; 256],
        }
    }

    /// Index of the frame to [`take`](Self::take) next; none when the correction has spread.
    pub(super) fn wanted(&self) -> Option<usize> {
        self.next.map(|(index, _)| index)
    }

    /// Takes the frame that is [`wanted`](Self::wanted).
    ///
    /// # Errors
    /// [`Error::FrameSizeMismatch`](crate::Error::FrameSizeMismatch), [`Error::OtherFrame`](crate::Error::OtherFrame); the correction can
    /// continue with the right frame.
    pub(super) fn take(&mut self, clip: &mut SegmentedClip, frame: &Frame, changes: &mut Changes) -> Result<()> {
        let Some((index, pass)) = self.next else { return Ok(()) };
        clip.check(index, frame)?;
        let look = Look::new(frame);
        let mut pass = Some(pass);
        if let Some(change) = self.change.take() {
            let is_new = self.begin(clip, frame, &look, change);
            if is_new {
                self.at_once(clip, frame, &look, changes);
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
                    while let Some((_, number)) = self.survey.pop_if(|(t, _)| *t == index) {
                        for track in self.worlds.iter_mut().flat_map(|world| &mut world.tracks) {
                            match number {
                                Some(number) if track.number == number => track.survey(&look, &found),
                                None if track.is_for_all(index) => {
                                    if let Some((seeds, _)) = clip.seeds_at(index, track.number, &look) {
                                        track.hear(&look, &seeds, &found);
                                    }
                                }
                                _ => {}
                            }
                        }
                    }
                    self.next = self.after_survey();
                }
                Pass::Alone => {
                    // Nothing is followed yet.
                    self.visit(clip, frame, &look, (index, Way::Backward), changes);
                    self.next = self.after_survey();
                }
                Pass::Sweep(way) => {
                    self.visit(clip, frame, &look, (index, way), changes);
                    self.next = self.after(index, way);
                }
            }
            pass = self.next.filter(|(wanted, _)| *wanted == index).map(|(_, pass)| pass);
        }
        if self.next.is_none() {
            self.finish(clip, changes);
        }
        Ok(())
    }

    /// Which objects the correction is about. Tells whether the frame says anything else than before.
    #[inline(never)]
    fn begin(&mut self, clip: &mut SegmentedClip, frame: &Frame, look: &Look, change: Change) -> bool {
        let [first, last] = self.scene;
        let before = clip.frames[self.index].said.clone().unwrap_or_default();
        let now = clip.layered(self.index, frame.luminance());
        let mut said = before.clone();
        match change {
            Change::Painted(painted) => painted.iter().for_each(|painted| said.paint(painted)),
            Change::Prompt(prompt) => {
                let labels = outline(clip, self.index, frame, look, &now, &prompt);
                said.point(prompt, &labels);
            }
        }
        said.drop_pieces(&before, &now, clip.size()[0]);
        said.keep_bases(&now);
        let persons = clip.persons_in(self.index);
        let mut touched = [false; 256];
        let mut touch = |number: u8| touched[usize::from(number)] = true;
        (1..NOTHING_SAID).filter(|&number| !said.agrees(&before, number)).for_each(&mut touch);
        if !said.agrees(&before, 0) {
            // Labels that name no object say of those under them that they are not there.
            before.takes_from.iter().copied().for_each(&mut touch);
            let mut loses = [false; 256];
            if said.names_none() {
                let hand = said.by_hand().unwrap_or_default();
                hand.iter().zip(&now).for_each(|(&hand, &now)| loses[usize::from(now)] |= hand == 0);
            }
            said.takes_from = (1..NOTHING_SAID)
                .filter(|&k| persons[usize::from(k)] && loses[usize::from(k)] && !clip.locked[usize::from(k)])
                .collect();
            said.takes_from.iter().copied().for_each(&mut touch);
        }
        let starts_before: Vec<Vec<Start>> = (0..NOTHING_SAID).map(|number| self.starts(clip, number)).collect();
        for number in (1..NOTHING_SAID).filter(|&number| !said.agrees(&before, number)) {
            let now = said.seeds(number).unwrap_or_default();
            let is_kept = |(p, seed): (usize, &Seed)| *seed == Seed::Nothing || now.get(p) == Some(seed);
            self.extends[usize::from(number)] =
                before.seeds(number).unwrap_or_default().iter().enumerate().all(is_kept);
        }
        let is_new = !said.is_same(&before);
        clip.frames[self.index].said = (!said.is_empty()).then_some(said);
        self.before = Runs::of(&now);
        self.speak(clip);
        let starts: Vec<Vec<Start>> = (0..NOTHING_SAID).map(|number| self.starts(clip, number)).collect();
        let is_touched = |k: &u8| {
            let k = usize::from(*k);
            (touched[k] || starts[k] != starts_before[k]) && !clip.locked[k]
        };
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
        is_new
    }

    /// The frames of the scene that speak of an object, and if there are any those with it that a person accepted.
    #[inline(never)]
    fn starts(&self, clip: &SegmentedClip, number: u8) -> Vec<Start> {
        let is_said = |t: usize| clip.frames[t].said.as_ref().is_some_and(|said| said.speaks_of.contains(&number));
        let frames = self.scene[0]..=self.scene[1];
        if !frames.clone().any(is_said) {
            return Vec::new();
        }
        let start = |t: usize| match &clip.frames[t].said {
            Some(said) if said.speaks_of.contains(&number) => Some((t, said.spread_of(number))),
            _ => clip.accepts(t, number).then_some((t, Spread::Both)),
        };
        frames.filter_map(start).collect()
    }

    /// Which objects each frame of the scene speaks of: those named there, and those found automatically of which part is not where labels
    /// that name no object say so. Of one that another object takes over in some frame nothing needs to be said.
    #[inline(never)]
    fn speak(&self, clip: &mut SegmentedClip) {
        let scene = self.scene[0]..=self.scene[1];
        let mut taken = [false; 256];
        let mut erased: Vec<[bool; 256]> = Vec::new();
        for t in scene.clone() {
            let mut erases = [false; 256];
            if let Some(said) = &clip.frames[t].said {
                let sizes = clip.said_of_found(t, said);
                for (label, &[all, ground, other]) in sizes.iter().enumerate().skip(1) {
                    taken[label] |= 2 * other > all;
                    // A lock that came later takes nothing back.
                    let is_free = !clip.locked[label] || said.speaks_of.contains(&(label as u8));
                    erases[label] = ground > 0 && ground + other < all && is_free;
                }
            }
            erased.push(erases);
        }
        let names = |clip: &SegmentedClip, t: usize, label: u8| {
            clip.frames[t].said.as_ref().is_some_and(|said| said.names(label))
        };
        let mut named = [false; 256];
        for label in 1..NOTHING_SAID {
            named[usize::from(label)] = scene.clone().any(|t| names(clip, t, label));
        }
        for (erases, t) in erased.iter().zip(scene) {
            let speaks = |&label: &u8| {
                let k = usize::from(label);
                names(clip, t, label) || erases[k] && (!taken[k] || named[k])
            };
            let speaks_of = (1..NOTHING_SAID).filter(speaks).collect();
            if let Some(said) = &mut clip.frames[t].said {
                said.speaks_of = speaks_of;
            }
        }
    }

    /// The corrected frame at once, from what it shows now.
    #[inline(never)]
    fn at_once(&mut self, clip: &mut SegmentedClip, frame: &Frame, look: &Look, changes: &mut Changes) {
        let now = at_size(&self.before.values(), NOTHING_SAID, clip.size()[0], look);
        let seeds = |number: u8| clip.seeds_at(self.index, number, look);
        let known = Known { seeds: &seeds, found: &now, flows: None };
        let mut claims = Vec::new();
        for &number in self.worlds.iter().flat_map(|world| &world.decides) {
            let mut alone = Track::new(number, vec![(self.index, Spread::Both)], self.index + 1);
            alone.know(look, &now);
            let mut world = World { tracks: vec![alone], decides: vec![number] };
            claims.append(&mut world.visit(self.index, Way::Forward, false, look, &known));
        }
        self.compose(clip, frame, look, (self.index, &claims), changes);
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

    fn visit(
        &mut self,
        clip: &mut SegmentedClip,
        frame: &Frame,
        look: &Look,
        (t, way): (usize, Way),
        changes: &mut Changes,
    ) {
        let [first, last] = self.scene;
        let found = clip.found_at(t, look.size);
        let flow = |kept: Option<Flow>| kept.map(|flow| flow.enlarged(look.size));
        let [to, from] = match way {
            Way::Forward => [flow(clip.back(t)), if t > first { flow(clip.onward(t - 1)) } else { None }],
            Way::Backward => [flow(clip.onward(t)), if t < last { flow(clip.back(t + 1)) } else { None }],
        };
        let seeds = |number: u8| clip.seeds_at(t, number, look);
        let known =
            Known { seeds: &seeds, found: &found, flows: to.as_ref().zip(from.as_ref()).map(|(to, from)| [to, from]) };
        let again = way == Way::Forward && self.first(Way::Backward).is_some_and(|furthest| t < furthest);
        let mut claims = Vec::new();
        for world in &mut self.worlds {
            claims.append(&mut world.visit(t, way, again, look, &known));
        }
        if !again {
            self.compose(clip, frame, look, (t, &claims), changes);
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
    fn finish(&mut self, clip: &mut SegmentedClip, changes: &mut Changes) {
        let decided: Vec<u8> = self.worlds.iter().flat_map(|world| world.decides.clone()).collect();
        for t in self.scene[0]..=self.scene[1] {
            let speaks_of = clip.frames[t].said.as_ref().map_or(&[][..], |said| &said.speaks_of);
            let is_gone = |label: u8| decided.contains(&label) && !speaks_of.contains(&label);
            let is_open = !self.done[t - self.scene[0]] && !clip.frames[t].accepted;
            let Some(layer) = clip.frames[t].layer.as_ref().filter(|_| is_open) else { continue };
            if layer.labels.each().any(|(label, _)| is_gone(label)) {
                let mut labels = layer.labels.values();
                labels.iter_mut().filter(|label| is_gone(**label)).for_each(|label| *label = NOTHING_SAID);
                let [width, height] = clip.working_size();
                let odds = layer.odds.odds(width, height);
                changes.add(t);
                clip.frames[t].layer = clip.layer_of(&labels, &|_, p| odds.values()[p]);
            }
        }
    }

    /// Puts the claims of a frame over what was found: what is locked, what a person painted here, what others hold, what is claimed, in
    /// this order.
    #[inline(never)]
    fn compose(
        &mut self,
        clip: &mut SegmentedClip,
        frame: &Frame,
        look: &Look,
        (t, claims): (usize, &[(u8, Option<Claim>)]),
        changes: &mut Changes,
    ) {
        let is_accepted = clip.frames[t].accepted;
        if is_accepted && t != self.index {
            return;
        }
        let [width, height] = clip.size();
        let before = clip.frames[t].layer.clone();
        let mut labels = match &before {
            Some(layer) => layer.labels.values(),
            None => vec![NOTHING_SAID; width * height],
        };
        let decided = |label: u8| claims.iter().any(|(number, _)| *number == label);
        let persons = clip.persons_in(t);
        let kept = clip.kept();
        let shown = labels.clone();
        // The objects of a person that the correction is not about keep what they have.
        let holds =
            |label: u8| (persons[usize::from(label)] || kept[usize::from(label)] || is_accepted) && !decided(label);
        let mut held: Vec<bool> =
            labels.iter().map(|&label| label != 0 && label != NOTHING_SAID && holds(label)).collect();
        for (label, _) in labels.iter_mut().zip(&held).filter(|(_, held)| !**held) {
            *label = if is_accepted && !decided(*label) { 0 } else { NOTHING_SAID };
        }
        let found = clip.found_full(t, frame.luminance());
        if kept.contains(&true) {
            for (p, held) in held.iter_mut().enumerate() {
                // What was taken from it before it was locked stays taken.
                let found = found[p];
                *held |= shown[p] == NOTHING_SAID
                    && kept[usize::from(found)]
                    && !persons[usize::from(found)]
                    && !decided(found);
            }
        }
        let said = clip.frames[t].said.clone().unwrap_or_default();
        let hand = said.by_hand().unwrap_or_default();
        let was = clip.overlaid(t, &found, &self.persons[t - self.scene[0]]);
        let mut best = vec![0.0f32; width * height];
        for (number, claim) in claims {
            let claim = claim.as_ref().filter(|claim| claim.mask.contains(&1));
            let (base, seeds) = (said.base(*number), said.seeds(*number));
            let mut full = vec![0; width * height];
            if let Some(claim) = claim {
                let mut mask = vec![0u8; look.pixels()];
                claim.area.pixels(look.size[0]).zip(&claim.mask).for_each(|(p, &inside)| mask[p] = inside);
                full = upsample(&mask, look.size, 2, frame.luminance(), &Model::DEFAULT);
            } else if seeds.is_none() {
                continue;
            }
            for (inside, seed) in full.iter_mut().zip(seeds.iter().flatten()) {
                match seed {
                    Seed::Nothing => {}
                    Seed::Other | Seed::Dropped => *inside = 0,
                    Seed::Object => *inside = 1,
                }
            }
            if let Some((base, seeds)) = base.zip(seeds.as_ref()) {
                local::keep(&mut full, &base, seeds, width);
            }
            if seeds.is_none() && self.extends[usize::from(*number)] {
                let was: Vec<u8> = was.iter().map(|label| u8::from(label == number)).collect();
                let looks = |p: usize| claim.map_or(0.0, |claim| claim.looks_at(look.pixel(p, width)));
                local::settle(&mut full, &was, &looks, width);
            }
            // What a label map says to be ground stays it, but for objects that were there.
            let is_free = |p: usize| !held[p] && (hand.get(p) != Some(&0) || shown[p] == *number);
            for p in (0..full.len()).filter(|&p| full[p] > 0 && is_free(p)) {
                let odds =
                    claim.map_or(0.0, |claim| claim.at(look.pixel(p, width), look.size[0])).max(f32::MIN_POSITIVE);
                if odds > best[p] {
                    (best[p], labels[p]) = (odds, *number);
                }
            }
        }
        let takes = |from: u8, other: u8| {
            from != 0 && from != other && decided(other) && !persons[usize::from(from)] && !kept[usize::from(from)]
        };
        let is_open =
            |p: usize| hand.get(p).is_none_or(|hand| *hand == NOTHING_SAID) && said.is_within([p % width, p / width]);
        local::absorb_rims(&mut labels, &found, (&is_open, &takes), width, 2 * look.step);
        let certain = 2.0 * model().certain;
        let erases = said.names_none();
        for (p, hand) in hand.into_iter().enumerate() {
            // Of what a person painted or pointed to, the hand takes pixels; of what is kept it takes none, but in a frame that was accepted.
            let below = usize::from(if shown[p] == NOTHING_SAID { found[p] } else { shown[p] });
            let is_locked = held[p] && (clip.locked[below] || clip.named[below] || kept[below] && !is_accepted);
            // Ground of a label map is that of the objects that it names.
            let is_others = if hand == 0 { labels[p] != NOTHING_SAID && !erases } else { !decided(hand) };
            if hand == NOTHING_SAID || is_locked || is_others {
                continue;
            }
            (best[p], labels[p], held[p]) = (certain, hand, false);
        }
        for (p, label) in labels.iter_mut().enumerate().filter(|(_, label)| **label == NOTHING_SAID) {
            let below = usize::from(found[p]);
            if shown[p] != NOTHING_SAID && kept[below] && !persons[below] && !decided(found[p]) {
                // Nothing is given back to what is kept as it is.
                *label = 0;
            }
        }
        let [w, h] = clip.working_size();
        let old = before.map(|layer| layer.odds.odds(w, h));
        let layer = clip.layer_of(&labels, &|p, at| match held[p] {
            true => old.as_ref().map_or(0.0, |old| old.values()[at]),
            false => best[p].min(certain),
        });
        let of = |layer: &Option<Layer>| layer.as_ref().map(|layer| layer.labels.clone());
        let is_same = of(&clip.frames[t].layer) == of(&layer);
        clip.frames[t].layer = layer;
        if !is_same {
            changes.set(t, &was, &clip.overlaid(t, &found, &persons));
        }
    }
}

impl SegmentedClip {
    /// A layer of full-size labels, if they say anything. `odds` has those of a full-size pixel, and of the working pixel that it is the
    /// corner of.
    pub(super) fn layer_of(&self, labels: &[u8], odds: &dyn Fn(usize, usize) -> f32) -> Option<Layer> {
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

    /// What is said of a frame about an object at the size of a look, and where that spreads.
    #[inline(never)]
    fn seeds_at(&self, t: usize, number: u8, look: &Look) -> Option<(Vec<Seed>, Spread)> {
        let width = self.size()[0];
        let frame = &self.frames[t];
        let of_said = frame.said.as_ref().and_then(|said| Some((said.seeds(number)?, said.spread_of(number))));
        let accepted = || {
            let labels = frame.layer.as_ref().filter(|_| frame.accepted)?.labels.values();
            let seed = |label: u8| if label == number { Seed::Object } else { Seed::Other };
            Some((labels.into_iter().map(seed).collect(), Spread::Both))
        };
        let (seeds, spread) = of_said.or_else(accepted)?;
        Some((at_size(&seeds, Seed::Nothing, width, look), spread))
    }

    /// Of what was found under each number in a frame: all its pixels, those that are said to be nothing, and those said to be another's.
    #[inline(never)]
    fn said_of_found(&self, t: usize, said: &Said) -> [[usize; 3]; 256] {
        let size @ [width, height] = self.working_size();
        let hand = said.by_hand().unwrap_or_else(|| vec![NOTHING_SAID; self.size()[0] * self.size()[1]]);
        let ground = said.names_none();
        let values = at_working_size(&hand, NOTHING_SAID, self.size()[0], size, self.working_step());
        let (found, _) = self.found(t);
        let mut sizes = [[0usize; 3]; 256];
        for p in 0..width * height {
            let of = &mut sizes[usize::from(found[p])];
            of[0] += 1;
            of[1] += usize::from(values[p] == 0 && ground);
            of[2] += usize::from(values[p] != 0 && values[p] != NOTHING_SAID && values[p] != found[p]);
        }
        for (number, outline) in said.outlines() {
            let outline = at_working_size(&outline, NOTHING_SAID, self.size()[0], size, self.working_step());
            for p in (0..width * height).filter(|&p| outline[p] == number && found[p] != number) {
                sizes[usize::from(found[p])][2] += usize::from(values[p] == NOTHING_SAID);
            }
        }
        sizes
    }
}

/// What is said of full-size pixels at the size of a look: at the centre of each pixel, or anywhere in it.
fn at_size<T: Copy + PartialEq>(said: &[T], nothing: T, full_width: usize, look: &Look) -> Vec<T> {
    at_working_size(said, nothing, full_width, look.size, look.step)
}

#[inline(never)]
fn at_working_size<T: Copy + PartialEq>(
    said: &[T],
    nothing: T,
    full_width: usize,
    [width, height]: [usize; 2],
    step: usize,
) -> Vec<T> {
    let mut working = vec![nothing; width * height];
    for (p, &label) in said.iter().enumerate().filter(|(_, label)| **label != nothing) {
        let (x, y) = (p % full_width, p / full_width);
        let here = &mut working[(y / step).min(height - 1) * width + (x / step).min(width - 1)];
        if *here == nothing || (x % step, y % step) == (step / 2, step / 2) {
            *here = label;
        }
    }
    working
}
