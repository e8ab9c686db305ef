//! The layer of a frame, composed from the proposals of its objects.
//!
//! Precedence: locked objects, then what a person painted in this frame, then objects that do not change, then proposals, of which the one
//! with the highest log-odds gets the pixel.

use std::sync::Arc;

use super::features::FrameFeatures;
use super::proposal::Proposal;
use super::strokes;
use crate::answer::UNLABELLED;
use crate::clip::annotation::{ObjectSet, Seed};
use crate::clip::frame_annotation::FrameAnnotation;
use crate::clip::layer::Layer;
use crate::clip::options::model;
use crate::clip::segmented_clip::SegmentedClip;
use crate::frame::Frame;
use crate::labelling::upsampling::upsample;
use crate::model::Model;

/// A frame whose layer is composed anew.
pub(super) struct Composition<'a> {
    pub(super) clip: &'a SegmentedClip,
    pub(super) index: usize,
    pub(super) frame: &'a Frame,
    pub(super) features: &'a FrameFeatures,
    /// The objects that change, each with its proposal if it has one.
    pub(super) proposals: &'a [(u8, Option<Proposal>)],
    /// Objects whose annotations were only added to, never taken back.
    pub(super) extended: &'a ObjectSet,
    /// Full-size labels found automatically.
    pub(super) found: &'a [u8],
    /// Full-size labels that the frame has shown so far.
    pub(super) before: &'a [u8],
}

/// What no proposal may change.
struct Rules {
    annotation: FrameAnnotation,
    /// Full-size painted labels; empty if there are none.
    painted: Vec<u8>,
    /// Labels of the layer so far.
    layer: Vec<u8>,
    /// Annotated objects that reach this frame.
    users: ObjectSet,
    /// Objects that change only by annotations of themselves.
    protected: ObjectSet,
    is_accepted: bool,
}

/// The layer under construction, at full size.
struct Draft {
    labels: Vec<u8>,
    /// Log-odds of the object that has each pixel, nats.
    log_odds: Vec<f32>,
    /// Whether each pixel keeps its object.
    is_held: Vec<bool>,
}

impl Composition<'_> {
    /// The layer; `None` if it has no label.
    pub(super) fn layer(&self) -> Option<Arc<Layer>> {
        let (clip, state) = (self.clip, &self.clip.frames[self.index]);
        let annotation = state.annotation.as_deref().cloned().unwrap_or_default();
        let layer = state.layer.as_ref();
        let rules = Rules {
            painted: annotation.painted_labels().unwrap_or_default(),
            annotation,
            layer: clip.layer_labels(self.index).unwrap_or_else(|| vec![UNLABELLED; self.found.len()]),
            users: clip.user_objects_in(self.index),
            protected: clip.protected(),
            is_accepted: state.accepted,
        };
        let mut draft = self.held(&rules);
        self.propose(&rules, &mut draft);
        self.absorb_rims(&rules, &mut draft);
        self.paint(&rules, &mut draft);
        self.give_nothing_back(&rules, &mut draft);
        let (old, most) = (layer.map(|layer| clip.log_odds_of(self.index, layer)), 2.0 * model().certain);
        clip.layer_of(self.index, &draft.labels, &|p, at| match draft.is_held[p] {
            true => old.as_ref().map_or(0.0, |old| old.values()[at]),
            false => draft.log_odds[p].min(most),
        })
    }

    /// Whether an object is among those that change.
    fn changes(&self, object: u8) -> bool {
        self.proposals.iter().any(|(of, _)| *of == object)
    }

    /// Annotated objects that do not change keep their pixels; in an accepted frame all objects keep theirs.
    fn held(&self, rules: &Rules) -> Draft {
        let Rules { layer, users, protected, is_accepted, .. } = rules;
        let holds = |label: u8| {
            let k = usize::from(label);
            (users[k] || protected[k] || *is_accepted) && !self.changes(label)
        };
        // A pixel that was taken from an object before the object was protected stays taken.
        let holds_found = |p: usize| layer[p] == UNLABELLED && self.is_protected_below(rules, p);
        let is_held = |(p, &label): (usize, &u8)| match label {
            0 => false,
            UNLABELLED => holds_found(p),
            label => holds(label),
        };
        let is_held: Vec<bool> = layer.iter().enumerate().map(is_held).collect();
        let label = |(&label, &is_held): (&u8, &bool)| match label {
            label if is_held => label,
            label if *is_accepted && !self.changes(label) => 0,
            _ => UNLABELLED,
        };
        let labels = layer.iter().zip(&is_held).map(label).collect();
        Draft { labels, log_odds: vec![0.0; layer.len()], is_held }
    }

    /// Whether the object found at a pixel is protected and does not change.
    fn is_protected_below(&self, rules: &Rules, p: usize) -> bool {
        let below = self.found[p];
        rules.protected[usize::from(below)] && !rules.users[usize::from(below)] && !self.changes(below)
    }

    /// Gives each pixel that is not held to the proposing object with the highest log-odds.
    fn propose(&self, rules: &Rules, draft: &mut Draft) {
        for (object, proposal) in self.proposals {
            let mask = self.mask(rules, *object, proposal.as_ref());
            let log_odds = |p: usize| {
                let log_odds = |of: &Proposal| of.log_odds_at(self.pixel(p), self.features.size[0]);
                proposal.as_ref().map_or(0.0, log_odds).max(f32::MIN_POSITIVE)
            };
            // The ground of a label map stays ground, except for objects that were there.
            let is_free =
                |p: usize| !draft.is_held[p] && (rules.painted.get(p) != Some(&0) || rules.layer[p] == *object);
            for p in (0..mask.len()).filter(|&p| mask[p] > 0 && is_free(p)) {
                let log_odds = log_odds(p);
                if log_odds > draft.log_odds[p] {
                    (draft.log_odds[p], draft.labels[p]) = (log_odds, *object);
                }
            }
        }
    }

    /// The full-size mask that an object proposes: 1 inside.
    fn mask(&self, rules: &Rules, object: u8, proposal: Option<&Proposal>) -> Vec<u8> {
        let (features, width) = (self.features, self.frame.width());
        let mut mask = vec![0; self.found.len()];
        if let Some(proposal) = proposal.filter(|proposal| proposal.mask.contains(&1)) {
            mask = upsample(&proposal.inside(features), &features.scaling, 2, self.frame.luminance(), &Model::DEFAULT);
        }
        if let Some(mut seeds) = rules.annotation.seeds(object) {
            let base = rules.annotation.base(object);
            // In this frame, strokes are compared with the mask that was shown, not with the one that was found.
            let painted_over = base.as_ref().filter(|base| strokes::paints_over(base, 1, &seeds));
            if let Some(base) = painted_over {
                strokes::fill(&mut seeds, base, 1);
            }
            for (inside, seed) in mask.iter_mut().zip(&seeds).filter(|(_, seed)| **seed != Seed::Nothing) {
                *inside = u8::from(*seed == Seed::Object);
            }
            if let Some(base) = &base {
                strokes::keep(&mut mask, base, &seeds, width);
            }
        } else if let Some((proposal, known)) = proposal.and_then(|of| Some((of, self.known(object)?))) {
            let pixels = self.features.pixels();
            let looks = proposal.signs.looks.values(pixels);
            let looks = |p: usize| looks[self.pixel(p)];
            let change = proposal.signs.change.as_ref().map(|change| change.values(pixels));
            let change = change.as_ref().map(|change| |p: usize| change[self.pixel(p)]);
            let change = change.as_ref().map(|change| change as &dyn Fn(usize) -> f32);
            strokes::settle(&mut mask, &known, &looks, change, width);
        }
        mask
    }

    /// The mask of an object in a frame without annotations of it: where it was found or, if it was not found, where it has been so far,
    /// provided that none of its annotations was taken back. 1 inside.
    fn known(&self, object: u8) -> Option<Vec<u8>> {
        let objects = self.clip.objects_of_found();
        let is_found = |label: &u8| u8::from(objects[usize::from(*label)] == object);
        let found: Vec<u8> = self.found.iter().map(is_found).collect();
        if found.contains(&1) {
            return Some(found);
        }
        let is_there = self.extended[usize::from(object)] && self.before.contains(&object);
        is_there.then(|| self.before.iter().map(|label| u8::from(*label == object)).collect())
    }

    /// Gives the rim that is left of a found object to the object that has taken most of it, except where that one is painted as ground.
    fn absorb_rims(&self, rules: &Rules, draft: &mut Draft) {
        let width = self.frame.width();
        let takes = |from: u8, other: u8| {
            let k = usize::from(from);
            from != 0 && from != other && self.changes(other) && !rules.users[k] && !rules.protected[k]
        };
        let is_open = |p: usize| {
            let is_painted = rules.painted.get(p).is_some_and(|label| *label != UNLABELLED);
            !is_painted && rules.annotation.is_within([p % width, p / width])
        };
        strokes::absorb_rims(&mut draft.labels, self.found, (&is_open, &takes), width, 2 * self.features.scaling.step);
        for (object, _) in self.proposals {
            let painted = rules.annotation.painted_of(*object).unwrap_or_default();
            for (label, _) in
                draft.labels.iter_mut().zip(painted).filter(|(label, painted)| *painted == 0 && **label == *object)
            {
                *label = UNLABELLED;
            }
        }
    }

    /// Gives painted pixels to their object, also those of other annotated objects; those of protected objects only in an accepted frame,
    /// and those of locked and named ones never.
    fn paint(&self, rules: &Rules, draft: &mut Draft) {
        let erases = rules.annotation.names_no_object();
        for (p, &label) in rules.painted.iter().enumerate().filter(|(_, label)| **label != UNLABELLED) {
            let below = usize::from(if rules.layer[p] == UNLABELLED { self.found[p] } else { rules.layer[p] });
            let is_named = self.clip.objects.locked[below] || self.clip.objects.named[below];
            let is_kept = draft.is_held[p] && (is_named || rules.protected[below] && !rules.is_accepted);
            // The ground of a label map applies only to the objects that it names.
            let is_others = match label {
                0 => draft.labels[p] != UNLABELLED && !erases,
                label => !self.changes(label),
            };
            if !is_kept && !is_others {
                (draft.log_odds[p], draft.labels[p], draft.is_held[p]) = (2.0 * model().certain, label, false);
            }
        }
    }

    /// A protected object does not get back pixels that it had lost.
    fn give_nothing_back(&self, rules: &Rules, draft: &mut Draft) {
        for (p, label) in draft.labels.iter_mut().enumerate().filter(|(_, label)| **label == UNLABELLED) {
            if rules.layer[p] != UNLABELLED && self.is_protected_below(rules, p) {
                *label = 0;
            }
        }
    }

    /// The working-size pixel that contains a full-size pixel.
    fn pixel(&self, p: usize) -> usize {
        self.features.scaling.small_pixel(p)
    }
}
