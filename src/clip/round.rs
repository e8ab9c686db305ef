//! One round over a clip: evidence is carried along the motions from both sides, colours are learned from the frames around each frame,
//! and its foreground is cut.
//!
//! ```text
//! past(t)   = odds(t) + d · carried past(t − 1)          future(t) likewise from t + 1
//! z(t)      = past(t) + future(t) − odds(t)
//! E(l)      = Σ_p l_p ≠ object · (w_z z + w_c colour)(p) + borders
//! ```
//! Carried evidence saturates, and decays with every frame. That of ground counts less: an object that rests in one pair looks like ground
//! there, while ground seldom looks like an object. A frame leaves the round when the frames it waits for have come.

use std::collections::VecDeque;
use std::rc::Rc;

use super::carry::carried;
use super::colours::ColourCounts;
use super::record::Record;
use crate::frame::Plane;
use crate::labelling::solver::Solver;

/// Share of a frame's evidence that is left a frame later. Of ten real clips, .9 for the first round and .85 for the second change J by less
/// than .001; of fourteen, .7 for the second changes one by .022, the others by less than .01.
const DECAY: f32 = 0.8;
/// Carried evidence beyond this many nats is no more certain. Chosen with the decay on ten real clips; 8 costs .003 J.
const SATURATION: f32 = 6.0;
/// Share of carried evidence of ground that counts. Chosen on thirty real clips: J .659 with 1, .667 with .7, .665 with .5, less than a standard
/// error apart. Less is better for people and animals, and worse where water or roads become objects.
const GROUND: f32 = 0.7;
/// Odds beyond this many nats count no more in a cut; 8 costs .001 J.
const MOST_ODDS: f32 = 5.0;
/// Weight of the odds in the cut; a nat is too much, as neighbours and frames share their mistakes.
const ODDS_WEIGHT: f32 = 0.5;
/// Weight of the colours. Chosen on ten real clips: .5 costs .005 J, .9 costs .014, as colours then take ground of like colour.
const COLOUR_WEIGHT: f32 = 0.7;
/// Price of a border in a cut. Chosen on ten real clips: 4 costs .001 J.
const SMOOTHNESS: f32 = 6.0;
/// Frames before and after from which colours are learned. Chosen on ten real clips: 8 costs .002 J.
const COLOUR_REACH: usize = 16;

/// A round in progress.
#[derive(Debug)]
pub(crate) struct Round {
    /// Share of the evidence that is left after a frame.
    pub(super) decay: f32,
    /// Frames that each frame waits for.
    delay: usize,
    solver: Solver,
    /// Weight of the colours.
    pub(super) colours_weight: f32,
    waiting: VecDeque<Waiting>,
    /// Evidence of the newest frame with that of the frames before it.
    past: Option<Plane>,
    /// Colours of the frames that have left, the last ones.
    colours: VecDeque<ColourCounts>,
}

#[derive(Debug)]
struct Waiting {
    record: Rc<Record>,
    odds: Plane,
    past: Plane,
}

/// A frame that leaves a round.
pub(crate) struct Foreground {
    pub(crate) record: Rc<Record>,
    /// The odds that it came with.
    pub(crate) own: Plane,
    /// Odds of object against background with the evidence of other frames, nats.
    pub(crate) odds: Plane,
    /// 1 where the frame shows an object, else 0.
    pub(crate) mask: Vec<u8>,
}

impl Round {
    pub(crate) fn new(delay: usize, solver: Solver) -> Round {
        let (decay, colours_weight) = (DECAY, COLOUR_WEIGHT);
        Round { decay, delay, solver, colours_weight, waiting: VecDeque::new(), past: None, colours: VecDeque::new() }
    }

    /// Takes the next frame with its own odds; returns one that has waited long enough.
    pub(crate) fn push(&mut self, record: Rc<Record>, odds: Plane) -> Option<Foreground> {
        let past = match (&self.past, &record.back) {
            (Some(past), Some(back)) => self.joined(&odds, &carried(past, back)),
            _ => odds.clone(),
        };
        self.past = Some(past.clone());
        self.waiting.push_back(Waiting { record, odds, past });
        if self.waiting.len() > self.delay { self.next() } else { None }
    }

    /// The record of the frame that has waited longest.
    pub(crate) fn oldest(&self) -> Option<&Record> {
        self.waiting.front().map(|waiting| &*waiting.record)
    }

    /// The frame that has waited longest leaves.
    pub(crate) fn next(&mut self) -> Option<Foreground> {
        let (odds, own_colours, mut colours) = self.with_future()?;
        let Waiting { record, odds: own, .. } = self.waiting.pop_front()?;
        if record.back.is_none() {
            self.colours.clear();
        }
        colours.add(&own_colours);
        self.colours.iter().for_each(|counts| colours.add(counts));
        self.colours.push_back(own_colours);
        if self.colours.len() > COLOUR_REACH {
            self.colours.pop_front();
        }
        let ratios = colours.ratios();
        let price = |(p, odds): (usize, &f32)| {
            ODDS_WEIGHT * odds.clamp(-MOST_ODDS, MOST_ODDS) + self.colours_weight * ratios[record.palette.index(p)]
        };
        let [width, height] = record.size();
        let ground = Plane::from_buffer(width, height, odds.values().iter().enumerate().map(price).collect());
        let mask = record.borders(SMOOTHNESS).solve(&[ground, Plane::filled(width, height, 0.0)], self.solver).to_vec();
        Some(Foreground { record, own, odds, mask })
    }

    /// The evidence of the frame that has waited longest with that of all others, its colours by that evidence, and those of the waiting
    /// frames of its scene by theirs.
    fn with_future(&self) -> Option<(Plane, ColourCounts, ColourCounts)> {
        let of_scene = self.waiting.iter().skip(1).take_while(|waiting| waiting.record.back.is_some());
        let last_of_colours = of_scene.count().min(COLOUR_REACH);
        let mut colours = ColourCounts::none();
        let mut future: Option<Plane> = None;
        for (k, Waiting { record, odds, past }) in self.waiting.iter().enumerate().rev() {
            let with_future = match (&future, &record.onward) {
                (Some(future), Some(onward)) => self.joined(odds, &carried(future, onward)),
                _ => odds.clone(),
            };
            if k <= last_of_colours {
                let mut both = past.clone();
                let pixels = both.values_mut().iter_mut().zip(with_future.values()).zip(odds.values());
                pixels.for_each(|((both, future), own)| *both += future - own);
                let counts = ColourCounts::of(&record.palette, &both);
                if k == 0 {
                    return Some((both, counts, colours));
                }
                colours.add(&counts);
            }
            future = Some(with_future);
        }
        None
    }

    /// A frame's own evidence and that of another one, carried to it.
    fn joined(&self, own: &Plane, carried: &Plane) -> Plane {
        let mut joined = own.clone();
        let pixels = joined.values_mut().iter_mut().zip(carried.values());
        pixels.for_each(|(own, carried)| {
            let share = if *carried < 0.0 { GROUND } else { 1.0 };
            *own += self.decay * share * carried.clamp(-SATURATION, SATURATION);
        });
        joined
    }
}
