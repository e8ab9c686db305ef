//! The foreground of each frame, found in two rounds. A round carries log-odds along the motions from past and future frames, learns
//! colours from neighbouring frames, and cuts the foreground. The second round starts from the log-odds and the cut of the first.
//!
//! ```text
//! past(t)   = log-odds(t) + d · carried past(t − 1)          future(t) likewise from t + 1
//! z(t)      = past(t) + future(t) − log-odds(t)
//! E(l)      = Σ_p l_p ≠ object · w (z + colour)(p) + edges
//! ```
//! Carried log-odds are clamped, and decay with every frame. Negative ones count less: an object that rests in one pair looks like
//! background there, while background seldom looks like an object. A frame leaves a round when the frames for which it waits have come.

use crate::clip::options::model;
use std::collections::VecDeque;
use std::sync::Arc;

use super::carry::carried;
use super::colours::ColourCounts;
use super::record::Record;
use crate::frame::Plane;
use crate::labelling::solver::Solver;

/// Number of frames on each side whose colours count.
const COLOUR_FRAMES: usize = 16;

/// One round over the frames.
#[derive(Debug)]
pub(crate) struct Round {
    /// Number of later frames for which each frame waits.
    delay: usize,
    solver: Solver,
    waiting: VecDeque<Waiting>,
    /// Log-odds of the newest frame joined with those of the frames before it.
    past: Option<Plane>,
    /// Colours of the last frames that have left.
    colours: VecDeque<ColourCounts>,
}

#[derive(Debug)]
struct Waiting {
    record: Arc<Record>,
    log_odds: Plane,
    past: Plane,
}

/// A frame that leaves a round.
pub(crate) struct Foreground {
    pub(crate) record: Arc<Record>,
    /// The log-odds with which it came.
    own: Plane,
    /// Log-odds of object against background, joined with those of other frames, nats.
    pub(crate) log_odds: Plane,
    /// 1 where the frame shows an object, else 0.
    pub(crate) mask: Vec<u8>,
}

impl Foreground {
    /// The frame's record and its log-odds for the second round, which contain the cut of the first.
    pub(crate) fn for_second_round(self) -> (Arc<Record>, Plane) {
        let Foreground { record, own: mut log_odds, mask, .. } = self;
        for (log_odds, &object) in log_odds.values_mut().iter_mut().zip(&mask) {
            let cut = if object > 0 { model().first_cut } else { -model().first_cut };
            *log_odds = model().first_log_odds * *log_odds + cut;
        }
        (record, log_odds)
    }
}

impl Round {
    pub(crate) fn new(delay: usize, solver: Solver) -> Round {
        Round { delay, solver, waiting: VecDeque::new(), past: None, colours: VecDeque::new() }
    }

    /// Takes the next frame with its own log-odds; returns one that has waited long enough.
    pub(crate) fn push(&mut self, record: Arc<Record>, log_odds: Plane) -> Option<Foreground> {
        let past = match (&self.past, &record.back) {
            (Some(past), Some(back)) => self.joined(&log_odds, &carried(past, back)),
            _ => log_odds.clone(),
        };
        self.past = Some(past.clone());
        self.waiting.push_back(Waiting { record, log_odds, past });
        if self.waiting.len() > self.delay { self.next() } else { None }
    }

    /// The record of the frame that has waited longest.
    pub(crate) fn oldest(&self) -> Option<&Record> {
        self.waiting.front().map(|waiting| &*waiting.record)
    }

    /// The frame that has waited longest leaves.
    pub(crate) fn next(&mut self) -> Option<Foreground> {
        let (log_odds, own_colours, mut colours) = self.with_future()?;
        let Waiting { record, log_odds: own, .. } = self.waiting.pop_front()?;
        if record.back.is_none() {
            self.colours.clear();
        }
        colours.add(&own_colours);
        self.colours.iter().for_each(|counts| colours.add(counts));
        self.colours.push_back(own_colours);
        if self.colours.len() > COLOUR_FRAMES {
            self.colours.pop_front();
        }
        let ratios = colours.ratios();
        let penalty = |(p, log_odds): (usize, &f32)| {
            model().automatic * (log_odds.clamp(-model().certain, model().certain) + ratios[record.palette.index(p)])
        };
        let [width, height] = record.size();
        let ground = Plane::from_vec(width, height, log_odds.values().iter().enumerate().map(penalty).collect());
        let mask =
            record.edge_weights(model().smoothness).solve(&[ground, Plane::filled(width, height, 0.0)], self.solver);
        Some(Foreground { record, own, log_odds, mask })
    }

    /// The joined log-odds of the frame that has waited longest, its colours by these, and the colours of the waiting frames of its scene.
    fn with_future(&self) -> Option<(Plane, ColourCounts, ColourCounts)> {
        let of_scene = self.waiting.iter().skip(1).take_while(|waiting| waiting.record.back.is_some());
        let last_of_colours = of_scene.count().min(COLOUR_FRAMES);
        let mut colours = ColourCounts::none();
        let mut future: Option<Plane> = None;
        for (k, Waiting { record, log_odds, past }) in self.waiting.iter().enumerate().rev() {
            let with_future = match (&future, &record.onward) {
                (Some(future), Some(onward)) => self.joined(log_odds, &carried(future, onward)),
                _ => log_odds.clone(),
            };
            if k <= last_of_colours {
                let mut both = past.clone();
                let pixels = both.values_mut().iter_mut().zip(with_future.values()).zip(log_odds.values());
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

    /// A frame's own log-odds plus those carried to it from a neighbour.
    fn joined(&self, own: &Plane, carried: &Plane) -> Plane {
        let mut joined = own.clone();
        let pixels = joined.values_mut().iter_mut().zip(carried.values());
        pixels.for_each(|(own, carried)| {
            let share = if *carried < 0.0 { model().ground } else { 1.0 };
            *own += model().decay * share * carried.clamp(-model().certain, model().certain);
        });
        joined
    }
}
