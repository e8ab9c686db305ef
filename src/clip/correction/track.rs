//! One object, from everything that is said of it: a sweep forward from the first frame that speaks of it, one backward from the last, and
//! between them both, by nearness.

use super::look::Look;
use super::sweep::{Claim, Expected, Given, Sweep};
use crate::clip::annotation::{Seed, Spread};

/// A frame that speaks of an object, and where that spreads.
pub(super) type Start = (usize, Spread);

/// A direction through the frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    Forward,
    Backward,
}

#[derive(Clone, Debug)]
pub(super) struct Track {
    pub(super) number: u8,
    /// In ascending order.
    starts: Vec<Start>,
    forward: Sweep,
    backward: Sweep,
    /// Claims of the forward sweep that the backward sweep joins, by frame.
    kept: Vec<Option<Claim>>,
}

impl Track {
    pub(super) fn new(number: u8, starts: Vec<Start>, frames: usize) -> Track {
        Track { number, starts, forward: Sweep::default(), backward: Sweep::default(), kept: vec![None; frames] }
    }

    /// The first frame that spreads forward, or the last one that spreads backward.
    pub(super) fn first(&self, way: Way) -> Option<usize> {
        let spreads = |(_, spread): &&Start| spread.ways()[way as usize];
        let start = match way {
            Way::Forward => self.starts.iter().find(spreads),
            Way::Backward => self.starts.iter().rev().find(spreads),
        };
        start.map(|(t, _)| *t)
    }

    pub(super) fn speaks(&self, t: usize) -> bool {
        self.starts.iter().any(|(start, _)| *start == t)
    }

    /// Whether a frame speaks of it for all frames.
    pub(super) fn is_for_all(&self, t: usize) -> bool {
        self.starts.contains(&(t, Spread::Both))
    }

    /// Takes what a frame shows of the object for what it looks like.
    pub(super) fn know(&mut self, look: &Look, now: &[u8]) {
        self.forward.know(look, &|p| now[p] == self.number);
    }

    /// Learns from a frame in which the object was found automatically.
    pub(super) fn survey(&mut self, look: &Look, found: &[u8]) {
        for sweep in [&mut self.forward, &mut self.backward] {
            sweep.survey(look, &|p| found[p] == self.number);
        }
    }

    /// Learns what is said for all frames, before any sweep begins.
    pub(super) fn hear(&mut self, look: &Look, seeds: &[Seed], found: &[u8]) {
        for sweep in [&mut self.forward, &mut self.backward] {
            sweep.hear(look, seeds, found, self.number);
        }
    }

    fn sweep(&mut self, way: Way) -> &mut Sweep {
        match way {
            Way::Forward => &mut self.forward,
            Way::Backward => &mut self.backward,
        }
    }

    /// The sweep that comes to a frame, if it has begun. The one backward may have turned in a frame that it has yet to come to again,
    /// because other objects are followed from later ones.
    pub(super) fn coming(&mut self, t: usize, way: Way) -> Option<&mut Sweep> {
        let is_ahead = way == Way::Backward && self.first(way).is_none_or(|last| t >= last);
        if is_ahead { None } else { Some(self.sweep(way)) }
    }

    /// The object's claim in a frame.
    pub(super) fn visit(
        &mut self,
        t: usize,
        way: Way,
        look: &Look,
        given: &Given<'_>,
        expected: Option<Expected>,
    ) -> Option<Claim> {
        let number = self.number;
        let begins = self.first(way) == Some(t) && !self.sweep(way).has_begun();
        let own = match expected {
            Some(expected) => Some(self.sweep(way).step(look, given, expected)),
            None if begins => Some(self.sweep(way).begin(look, given, number)),
            None => None,
        };
        // A frame whose correction does not spread speaks for itself.
        let speaks = self.speaks(t);
        let alone = || speaks.then(|| Sweep::default().begin(look, given, number));
        match way {
            Way::Forward => {
                if self.first(Way::Backward) == Some(t) && self.forward.has_begun() {
                    self.backward = self.forward.turned(look, given.found);
                }
                own.or_else(alone)
            }
            Way::Backward => match (self.kept.get_mut(t).and_then(Option::take), own) {
                (Some(forward), Some(backward)) => Some(self.joined(t, look, &forward, &backward)),
                (forward, backward) => backward.or(forward).or_else(alone),
            },
        }
    }

    /// Keeps a claim until the backward sweep comes.
    pub(super) fn keep(&mut self, t: usize, claim: Option<Claim>) {
        self.kept[t] = claim;
    }

    /// Both sweeps, by nearness of the frames that speak of the object.
    fn joined(&self, t: usize, look: &Look, forward: &Claim, backward: &Claim) -> Claim {
        let distance = |start: Option<&Start>| start.map_or(0.0, |(start, _)| start.abs_diff(t) as f32);
        let since = distance(self.starts.iter().rev().find(|(start, spread)| *start <= t && spread.ways()[0]));
        let until = distance(self.starts.iter().find(|(start, spread)| *start >= t && spread.ways()[1]));
        Claim::joined(look, [forward, backward], [until + 0.5, since + 0.5])
    }
}
