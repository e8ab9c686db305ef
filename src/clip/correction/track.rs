//! An object in both directions: forward from its first anchor and backward from its last; between them, the mean weighted by distance.

use super::appearance::Source;
use super::features::FrameFeatures;
use super::plan::Anchor;
use super::propagator::{Observation, Prediction, Propagator};
use super::proposal::Proposal;
use crate::clip::annotation::{Direction, Seed};
use crate::clip::options::model;

#[derive(Clone, Debug)]
pub(super) struct Track {
    pub(super) object: u8,
    /// In ascending order of frames.
    anchors: Vec<Anchor>,
    forward: Propagator,
    backward: Propagator,
    /// By frame: forward proposals that are kept for the backward pass.
    kept: Vec<Option<Proposal>>,
}

impl Track {
    /// A track of an object in a clip of so many frames.
    pub(super) fn new(object: u8, anchors: Vec<Anchor>, frames: usize) -> Track {
        let [forward, backward] = [(); 2].map(|()| Propagator::default());
        Track { object, anchors, forward, backward, kept: vec![None; frames] }
    }

    pub(super) fn anchor(&self, frame: usize) -> Option<&Anchor> {
        self.anchors.iter().find(|anchor| anchor.frame == frame)
    }

    /// Learns the appearance of the object where a frame shows it.
    pub(super) fn learn_shown(&mut self, features: &FrameFeatures, shown: &[u8]) {
        self.forward.learn(features, Source::Recent, 1.0, &|p| shown[p] == self.object);
    }

    /// Learns the appearance of the object where it was found automatically.
    pub(super) fn learn_found(&mut self, features: &FrameFeatures, found: &[u8]) {
        for propagator in [&mut self.forward, &mut self.backward] {
            propagator.learn(features, Source::Found, model().automatic, &|p| found[p] == self.object);
        }
    }

    /// Learns an annotation that spreads to all frames, before any propagation begins.
    pub(super) fn learn_seeds(&mut self, features: &FrameFeatures, seeds: &[Seed], found: &[u8]) {
        for propagator in [&mut self.forward, &mut self.backward] {
            propagator.learn_seeds(features, seeds, found, self.object);
        }
    }

    /// The propagator that reaches a frame. Backward there is none from the object's last anchor on, even if other objects have later
    /// anchors.
    pub(super) fn coming(&mut self, frame: usize, direction: Direction) -> Option<&mut Propagator> {
        match direction {
            Direction::Forward => Some(&mut self.forward),
            Direction::Backward if direction.first(&self.anchors).is_none_or(|last| frame >= last) => None,
            Direction::Backward => Some(&mut self.backward),
        }
    }

    /// The object's proposal for a frame.
    pub(super) fn visit(
        &mut self,
        frame: usize,
        direction: Direction,
        of: &Observation<'_>,
        prediction: Option<Prediction>,
    ) -> Option<Proposal> {
        let propagator = match direction {
            Direction::Forward => &mut self.forward,
            Direction::Backward => &mut self.backward,
        };
        let begins = direction.first(&self.anchors) == Some(frame) && !propagator.has_begun();
        let own = match prediction {
            Some(prediction) => Some(propagator.update(of, prediction, self.object)),
            None if begins => Some(propagator.begin(of, self.object)),
            None => None,
        };
        if direction == Direction::Forward
            && Direction::Backward.first(&self.anchors) == Some(frame)
            && self.forward.has_begun()
        {
            self.backward = self.forward.turned(of.features, of.found);
        }
        let forward = if direction == Direction::Backward { self.kept[frame].take() } else { None };
        match (forward, own) {
            (Some(forward), Some(backward)) => Some(self.joined(frame, of.features, &forward, &backward)),
            // An annotation that does not spread holds in its own frame.
            (forward, own) => own
                .or(forward)
                .or_else(|| self.anchor(frame).is_some().then(|| Propagator::default().begin(of, self.object))),
        }
    }

    /// Keeps a proposal for the backward pass.
    pub(super) fn keep(&mut self, frame: usize, proposal: Option<Proposal>) {
        self.kept[frame] = proposal;
    }

    /// Both directions, weighted by the nearness of their anchors.
    fn joined(&self, frame: usize, features: &FrameFeatures, forward: &Proposal, backward: &Proposal) -> Proposal {
        let distance = |anchor: Option<&Anchor>| anchor.map_or(0.0, |anchor| anchor.frame.abs_diff(frame) as f32);
        let spreads = |anchor: &Anchor, direction| anchor.spread.goes(direction);
        let is_before = |anchor: &&Anchor| anchor.frame <= frame && spreads(anchor, Direction::Forward);
        let is_after = |anchor: &&Anchor| anchor.frame >= frame && spreads(anchor, Direction::Backward);
        let since = distance(self.anchors.iter().rev().find(is_before));
        let until = distance(self.anchors.iter().find(is_after));
        Proposal::joined(features, [forward, backward], [until + 0.5, since + 0.5])
    }
}
