//! Promises to a person who annotates a clip, in whatever order: what was named, painted, given,
//! prompted, accepted or locked stays as it is while something is said of another object.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "test code may panic")]

use std::collections::BTreeSet;
use std::ops::Range;

use crate::support::moving::{
    SIZE as FRAME, annotate, carrier, frames_of, moving_and_resting, moving_and_resting_clip, options, scene_of, thing,
    whole,
};
use veronese::clip::{Accepted, Annotations, Click, Painted, Prompt, SegmentedClip, Spread};
use veronese::{Error, Frame, Quality, Random};

const SIZE: [usize; 2] = [128, 96];
const PIXELS: usize = SIZE[0] * SIZE[1];

/// Three things that cross, of which two move and are found, in eight frames.
struct Scene {
    frames: Vec<Frame>,
    truths: Vec<Vec<usize>>,
    clip: SegmentedClip,
}

fn scene() -> Scene {
    let things = [
        thing(2, [24.0, 22.0], |t| [6.0 + 7.0 * t as f32, 34.0]),
        thing(3, [26.0, 30.0], |t| [88.0 - 7.0 * t as f32, 38.0]),
        thing(9, [30.0, 20.0], |_| [60.0, 72.0]),
    ];
    let (frames, truths) = scene_of(SIZE, 1, &things, 8);
    let clip = whole(&frames, options(Quality::Fast, None));
    Scene { frames, truths, clip }
}

/// A clip of which things are said one after another, and what was said.
struct Session<'a> {
    scene: &'a Scene,
    clip: SegmentedClip,
    labels: Vec<Vec<u8>>,
    random: Random,
    /// Objects that a person spoke of, by what.
    spoken: BTreeSet<u8>,
    named: BTreeSet<u8>,
    locked: BTreeSet<u8>,
    accepted: BTreeSet<usize>,
    /// Label maps and strokes in frames, of which later ones are parts.
    strokes: std::collections::BTreeMap<(usize, u8), Vec<u8>>,
}

impl Session<'_> {
    fn below(&mut self, limit: usize) -> usize {
        self.random.uniform(0.0, limit as f64) as usize
    }

    fn shown(&self) -> Vec<Vec<u8>> {
        frames_of(&self.clip, &self.scene.frames).into_iter().map(|frame| frame.labels).collect()
    }

    /// Objects that nobody but themselves changes.
    fn kept(&self) -> BTreeSet<u8> {
        let in_accepted = self.accepted.iter().flat_map(|&t| self.labels[t].iter().copied());
        self.spoken
            .iter()
            .chain(&self.named)
            .chain(&self.locked)
            .copied()
            .chain(in_accepted)
            .filter(|k| *k > 0)
            .collect()
    }

    /// Says something of an object, in a frame, and looks at everything.
    fn say(&mut self, what: &str, object: u8, frame: usize, annotations: Annotations, painted: &[u8]) {
        let kept = self.kept();
        let is_locked = self.locked.contains(&object);
        match self.clip.annotate(annotations.clone()) {
            Err(Error::ObjectLocked { object: locked }) => {
                assert!(is_locked && locked == object, "{what}: {locked} is not locked");
                return;
            }
            job => drop(job.unwrap()),
        }
        let clip = self.clip.clone();
        annotate(&mut self.clip, &self.scene.frames, annotations);
        assert!(!is_locked || self.clip.to_bytes() == clip.to_bytes(), "{what}: of a locked object");
        let after = self.shown();
        let before = std::mem::replace(&mut self.labels, after);
        for (t, (before, after)) in before.iter().zip(&self.labels).enumerate() {
            for p in (0..PIXELS).filter(|&p| before[p] != after[p]) {
                let [was, is] = [before[p], after[p]];
                let by_hand = t == frame && painted.get(p).is_some_and(|label| *label == is);
                let context = format!("{what} of {object} in frame {frame}: in frame {t} pixel {p} was {was}, is {is}");
                assert!(!self.locked.contains(&was) && !self.locked.contains(&is), "{context}, and is locked");
                assert!(t == frame || !self.accepted.contains(&t), "{context}, and is accepted");
                assert!(was == object || !kept.contains(&was) || by_hand, "{context}");
                assert!(is == object || was == object, "{context}");
                assert!(is == object || !kept.contains(&is), "{context}");
            }
        }
        self.spoken.insert(object);
    }

    /// The number of a thing: a new one, or that of what was found.
    fn number(&mut self, thing: usize) -> u8 {
        let new = 100 + thing as u8;
        let frame = self.below(self.labels.len());
        let inside = (0..PIXELS).filter(|&p| self.scene.truths[frame][p] == thing);
        let found = inside.map(|p| self.labels[frame][p]).find(|label| *label > 0);
        if self.below(3) == 0 { found.unwrap_or(new) } else { new }
    }

    fn act(&mut self) {
        let (thing, frame) = (1 + self.below(3), self.below(self.labels.len()));
        let object = self.number(thing);
        let inside: Vec<usize> = (0..PIXELS).filter(|&p| self.scene.truths[frame][p] == thing).collect();
        let Some(&somewhere) = inside.get(self.below(inside.len().max(1))) else { return };
        let at = |p: usize| [p % SIZE[0], p / SIZE[0]];
        let mut said = Annotations::default();
        match self.below(12) {
            0 | 1 => {
                let (x, y) = (inside.iter().map(|&p| at(p)[0]), inside.iter().map(|&p| at(p)[1]));
                let [left, top] = [x.clone().min().unwrap(), y.clone().min().unwrap()];
                let sides = [left, top, x.max().unwrap() + 1 - left, y.max().unwrap() + 1 - top];
                said.prompts =
                    vec![Prompt { frame, object, clicks: Vec::new(), within: Some(sides), spread: Spread::Both }];
                self.say("a box", object, frame, said, &[]);
            }
            2 | 3 => {
                let other = self.below(PIXELS);
                let mut clicks = vec![Click { at: at(somewhere), inside: true }];
                clicks.extend(
                    (self.below(2) == 0)
                        .then_some(Click { at: at(other), inside: false })
                        .filter(|_| other != somewhere),
                );
                said.prompts = vec![Prompt { frame, object, clicks, within: None, spread: Spread::Both }];
                self.say("clicks", object, frame, said, &[]);
            }
            4 | 5 => {
                // A stroke that adds, or one that takes away, beside those before.
                let adds = self.below(2) == 0;
                let from = if adds { somewhere } else { self.below(PIXELS) };
                let before = self.strokes.get(&(frame, object)).cloned().unwrap_or_else(|| vec![255; PIXELS]);
                let near = |p: usize| at(p)[0].abs_diff(at(from)[0]) < 6 && at(p)[1].abs_diff(at(from)[1]) < 4;
                let drawn = |p: usize| near(p) && (adds || self.labels[frame][p] == object);
                let labels: Vec<u8> =
                    (0..PIXELS).map(|p| if drawn(p) { if adds { object } else { 0 } } else { before[p] }).collect();
                said.corrections =
                    vec![Painted { frame, object: Some(object), labels: labels.clone(), spread: Spread::Both }];
                let own: BTreeSet<usize> = (0..PIXELS).filter(|&p| self.labels[frame][p] == object).collect();
                let changed = labels != before;
                self.say("a stroke", object, frame, said, &labels);
                if !changed || self.locked.contains(&object) {
                    return;
                }
                self.strokes.insert((frame, object), labels);
                let now: BTreeSet<usize> = (0..PIXELS).filter(|&p| self.labels[frame][p] == object).collect();
                let first = before.iter().all(|label| *label == 255);
                assert!(!first || !adds || own.is_subset(&now), "a stroke that adds takes away");
                assert!(!first || adds || now.is_subset(&own), "a stroke that takes away adds");
            }
            6 => {
                let labels: Vec<u8> =
                    self.scene.truths[frame].iter().map(|&t| if t == thing { object } else { 0 }).collect();
                if self.strokes.keys().any(|(t, _)| *t == frame) {
                    return;
                }
                said.corrections =
                    vec![Painted { frame, object: Some(object), labels: labels.clone(), spread: Spread::Both }];
                self.say("a mask", object, frame, said, &labels);
                self.strokes.insert((frame, object), labels);
            }
            7 => {
                let objects: Vec<u8> = self.labels[frame]
                    .iter()
                    .copied()
                    .filter(|k| *k > 0)
                    .collect::<BTreeSet<_>>()
                    .into_iter()
                    .collect();
                let Some(&one) = objects.get(self.below(objects.len().max(1))) else { return };
                let set = if self.below(2) == 0 { &mut self.locked } else { &mut self.named };
                if !set.remove(&one) {
                    set.insert(one);
                }
                said.locked = Some(self.locked.iter().copied().collect());
                said.named = Some(self.named.iter().copied().collect());
                annotate(&mut self.clip, &self.scene.frames, said);
                assert!(self.shown() == self.labels, "locks and names change nothing");
            }
            8 => {
                if !self.accepted.remove(&frame) {
                    self.accepted.insert(frame);
                }
                said.accepted = Some(self.accepted.iter().map(|&frame| Accepted { frame, labels: None }).collect());
                annotate(&mut self.clip, &self.scene.frames, said);
                assert!(self.shown() == self.labels, "to accept a frame changes nothing");
            }
            9 => {
                // Two that are seen become one.
                let seen: BTreeSet<u8> = self.labels[frame].iter().copied().filter(|k| *k > 0).collect();
                let seen: Vec<u8> = seen.into_iter().collect();
                let pick = [self.below(seen.len().max(1)), self.below(seen.len().max(1))];
                let [Some(&from), Some(&into)] = pick.map(|at| seen.get(at)) else { return };
                if from == into {
                    return;
                }
                said.numbers = vec![[from, into]];
                if self.locked.contains(&from) || self.locked.contains(&into) {
                    assert!(matches!(self.clip.annotate(said), Err(Error::ObjectLocked { .. })));
                    return;
                }
                annotate(&mut self.clip, &self.scene.frames, said);
                self.labels.iter_mut().flatten().filter(|label| **label == from).for_each(|label| *label = into);
                assert!(self.shown() == self.labels, "to merge {from} into {into} changes their number alone");
                self.spoken.insert(into);
                self.named.remove(&from);
            }
            10 => {
                // One that is found automatically is deleted.
                let seen: Vec<u8> = self.labels[frame].iter().copied().filter(|k| *k > 0).collect();
                let Some(&one) = seen.get(self.below(seen.len().max(1))).filter(|k| !self.kept().contains(k)) else {
                    return;
                };
                said.numbers = vec![[one, 0]];
                annotate(&mut self.clip, &self.scene.frames, said);
                self.labels.iter_mut().flatten().filter(|label| **label == one).for_each(|label| *label = 0);
                assert!(self.shown() == self.labels, "to delete {one} changes nothing else");
            }
            _ => {
                let bytes = self.clip.to_bytes();
                self.clip = SegmentedClip::from_bytes(&bytes).unwrap();
                assert!(self.shown() == self.labels && self.clip.to_bytes() == bytes);
            }
        }
    }
}

#[test]
fn what_is_right_stays_right_whatever_is_said() {
    assert_kept(0..3);
}

#[test]
#[ignore = "npm run soak"]
fn what_is_right_stays_right_whatever_is_said_many_times() {
    assert_kept(3..10);
}

/// The pixels of some that hang together with others, which are in reach of it by so many pixels.
fn connected(differs: &[bool], others: &[bool], reach: usize) -> Vec<bool> {
    let [width, height] = FRAME;
    let around = |p: usize, reach: usize| {
        let [x, y] = [p % width, p / width];
        let rows = y.saturating_sub(reach)..(y + reach + 1).min(height);
        rows.flat_map(move |v| (x.saturating_sub(reach)..(x + reach + 1).min(width)).map(move |u| v * width + u))
    };
    let mut is_in = vec![false; differs.len()];
    let mut waiting: Vec<usize> =
        (0..differs.len()).filter(|&p| differs[p] && around(p, reach).any(|q| others[q])).collect();
    while let Some(p) = waiting.pop() {
        if !std::mem::replace(&mut is_in[p], true) {
            waiting.extend(around(p, 1).filter(|&q| differs[q] && !is_in[q]));
        }
    }
    is_in
}

#[test]
fn a_correction_changes_an_object_only_where_it_was_said_and_where_that_went() {
    let (frames, truths) = moving_and_resting();
    let start = moving_and_resting_clip();
    let shown = |clip: &SegmentedClip| -> Vec<Vec<u8>> {
        frames_of(clip, &frames).into_iter().map(|frame| frame.labels).collect()
    };
    let before = shown(&start);
    let (object, _) = carrier(&before[5], &truths[5], 1).unwrap();
    // The thing is at column 10 + 4 t and row 20, of 34 × 30 pixels.
    let (mut random, mut elsewhere) = (Random::from_seed(11), 0);
    for k in 0..8 {
        let (frame, adds) = (random.uniform(0.0, 12.0) as usize, k % 2 == 0);
        let [side, row] = [random.uniform(0.0, 2.0) as usize, 20 + random.uniform(0.0, 22.0) as usize];
        // Ground beside it, or a part of it at its border.
        let column = 10 + 4 * frame + if side == 0 { 0 } else { 26 };
        let column = if adds { if side == 0 { column - 8 } else { column + 8 } } else { column };
        let is_in =
            |p: usize| (column..column + 8).contains(&(p % FRAME[0])) && (row..row + 8).contains(&(p / FRAME[0]));
        let label = if adds { object } else { 0 };
        let labels = (0..FRAME[0] * FRAME[1]).map(|p| if is_in(p) { label } else { 255 }).collect();
        let corrections = vec![Painted { frame, object: Some(object), labels, spread: Spread::Both }];
        let mut clip = start.clone();
        annotate(&mut clip, &frames, Annotations { corrections, ..Annotations::default() });
        let after = shown(&clip);
        let differs = |t: usize| -> Vec<bool> {
            before[t].iter().zip(&after[t]).map(|(b, a)| (*b == object) != (*a == object)).collect()
        };
        let said = differs(frame);
        assert!(said.contains(&true));
        for t in (0..frames.len()).filter(|t| *t != frame) {
            // What was said of the thing goes with it, and what was said of the ground rests.
            let step = 4 * t as isize - 4 * frame as isize;
            let went = |p: usize| {
                let from = (p % FRAME[0]) as isize - step;
                (0..FRAME[0] as isize).contains(&from) && said[p / FRAME[0] * FRAME[0] + from as usize]
            };
            let carried: Vec<bool> = (0..said.len()).map(|p| said[p] || went(p)).collect();
            let (differs, reach) = (differs(t), 3);
            let connected = connected(&differs, &carried, reach);
            let alone = differs.iter().zip(&connected).filter(|(differs, is_in)| **differs && !**is_in).count();
            assert_eq!(
                alone, 0,
                "stroke {k} in frame {frame}: pixels of frame {t} that hang together with nothing said"
            );
            elsewhere += differs.iter().filter(|differs| **differs).count();
        }
    }
    assert!(elsewhere > 0, "corrections go through the clip");
}

fn assert_kept(seeds: Range<u64>) {
    let scene = scene();
    for seed in seeds {
        let clip = scene.clip.clone();
        let labels = frames_of(&clip, &scene.frames).into_iter().map(|frame| frame.labels).collect();
        let random = Random::from_seed(seed);
        let mut session = Session {
            scene: &scene,
            clip,
            labels,
            random,
            spoken: BTreeSet::new(),
            named: BTreeSet::new(),
            locked: BTreeSet::new(),
            accepted: BTreeSet::new(),
            strokes: Default::default(),
        };
        (0..12).for_each(|_| session.act());
    }
}
