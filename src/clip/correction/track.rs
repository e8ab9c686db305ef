//! One object, from everything that is said of it: a sweep forward from the first frame that speaks of it, one backward from the last, and
//! between them both, by nearness.

use std::collections::BTreeMap;

use super::constants::Constants;
use super::look::Look;
use super::sweep::{Claim, Given, NOWHERE, Said, Sweep, beginning, cut};
use crate::clip::evidence::Flow;
use crate::clip::layer::Spread;

/// A frame that speaks of an object, and where that spreads.
pub(super) type Start = (usize, Spread);

#[derive(Clone, Debug)]
pub(super) struct Track {
    pub(super) number: u8,
    /// In ascending order.
    pub(super) starts: Vec<Start>,
    forward: Sweep,
    backward: Sweep,
    /// Claims of the forward sweep that the backward sweep joins.
    kept: BTreeMap<usize, Claim>,
}

/// What is known of a frame.
pub(super) struct Scene<'a> {
    pub(super) look: &'a Look,
    pub(super) found: &'a [u8],
    pub(super) onward: Option<&'a Flow>,
    pub(super) back: Option<&'a Flow>,
    /// Of the neighbours: from the frame before to this, from the frame after to this.
    pub(super) from_before: Option<&'a Flow>,
    pub(super) from_after: Option<&'a Flow>,
}

impl Track {
    pub(super) fn new(number: u8, starts: Vec<Start>) -> Track {
        Track {
            number,
            starts,
            forward: Sweep::default(),
            backward: Sweep::default(),
            kept: BTreeMap::new(),
        }
    }

    /// Learns from a frame in which the object was found automatically.
    pub(super) fn survey(&mut self, look: &Look, found: &[u8], constants: &Constants) {
        for sweep in [&mut self.forward, &mut self.backward] {
            sweep.own = Some(self.number);
            sweep.survey(look, &|p| found[p] == self.number, constants);
        }
    }

    /// The first frame that spreads forward.
    pub(super) fn first(&self) -> Option<usize> {
        self.starts.iter().find(|(_, spread)| spread.forward()).map(|(t, _)| *t)
    }

    /// The last frame that spreads backward.
    pub(super) fn last(&self) -> Option<usize> {
        self.starts.iter().rev().find(|(_, spread)| spread.backward()).map(|(t, _)| *t)
    }

    fn start(&self, t: usize) -> Option<Spread> {
        self.starts.iter().find(|(start, _)| *start == t).map(|(_, spread)| *spread)
    }

    /// A frame of the forward sweep. `again`: the backward sweep will come here.
    pub(super) fn onward(&mut self, t: usize, scene: &Scene<'_>, said: Option<&[Said]>, again: bool, constants: &Constants) -> Option<Claim> {
        let flows = scene.back.zip(scene.from_before).map(|(to, from)| [to, from]);
        let given = Given { said, found: scene.found, flows, speaks: self.start(t).is_some() };
        let learns = self.start(t).is_none_or(Spread::forward);
        let claim = if self.forward.has_begun() {
            self.forward.step(scene.look, &given, learns, constants)
        } else if self.first() == Some(t) {
            Some(self.forward.begin(scene.look, &given, &self.unsaid(scene.found), constants))
        } else {
            self.alone(t, scene, said, constants)
        };
        if self.last() == Some(t) {
            self.backward = self.forward.turned(scene.look, scene.found, constants);
        } else if again && let Some(claim) = &claim {
            self.kept.insert(t, claim.clone());
        }
        claim
    }

    /// A frame of the backward sweep.
    pub(super) fn backward(&mut self, t: usize, scene: &Scene<'_>, said: Option<&[Said]>, constants: &Constants) -> Option<Claim> {
        let flows = scene.onward.zip(scene.from_after).map(|(to, from)| [to, from]);
        let given = Given { said, found: scene.found, flows, speaks: self.start(t).is_some() };
        let forward = self.kept.remove(&t);
        if self.last() == Some(t) {
            // The forward sweep has not come here.
            let claim = self.backward.begin(scene.look, &given, &self.unsaid(scene.found), constants);
            return Some(claim);
        }
        if !self.backward.has_begun() {
            return forward.or_else(|| self.alone(t, scene, said, constants));
        }
        let learns = self.start(t).is_none_or(Spread::backward);
        let backward = self.backward.step(scene.look, &given, learns, constants);
        match (forward, backward) {
            (Some(forward), Some(backward)) => Some(self.joined(t, scene.look, &forward, &backward, constants)),
            (forward, backward) => backward.or(forward),
        }
    }

    /// The object in the corrected frame, from what it shows now.
    pub(super) fn at_once(&self, look: &Look, now: &[u8], said: Option<&[Said]>, constants: &Constants) -> Option<Claim> {
        let given = Given { said, found: now, flows: None, speaks: true };
        Some(Sweep::default().begin(look, &given, &self.unsaid(now), constants))
    }

    /// What one frame says for itself.
    fn alone(&self, t: usize, scene: &Scene<'_>, said: Option<&[Said]>, constants: &Constants) -> Option<Claim> {
        self.start(t)?;
        let given = Given { said, found: scene.found, flows: None, speaks: true };
        Some(Sweep::default().begin(scene.look, &given, &self.unsaid(scene.found), constants))
    }

    /// Odds where nothing is said in the first frame.
    fn unsaid<'a>(&self, found: &'a [u8]) -> impl Fn(usize) -> f32 + use<'a> {
        let number = self.number;
        let is_found = found.contains(&number);
        move |p| if is_found { beginning(found[p] == number) } else { NOWHERE }
    }

    /// Both sweeps, by nearness of the frames that speak of the object.
    fn joined(&self, t: usize, look: &Look, forward: &Claim, backward: &Claim, constants: &Constants) -> Claim {
        let before = self.starts.iter().rev().find(|(start, spread)| *start <= t && spread.forward());
        let after = self.starts.iter().find(|(start, spread)| *start >= t && spread.backward());
        let distance = |start: Option<&Start>| start.map_or(0.0, |(start, _)| start.abs_diff(t) as f32);
        let (since, until) = (distance(before), distance(after));
        let area = forward.area.with(&backward.area);
        let width = look.size[0];
        let mut odds = Vec::with_capacity(area.width() * area.height());
        for y in area.rows.clone() {
            for x in area.columns.clone() {
                let p = y * width + x;
                let both = forward.at(p, width) * (until + 0.5) + backward.at(p, width) * (since + 0.5);
                odds.push(both / (since + until + 1.0));
            }
        }
        let mask = cut(look, &area, &odds, constants);
        Claim { area, odds, mask }
    }
}
