//! Corrections: an annotation is exact in its own frame, and is propagated through its scene.
//!
//! Annotations of several frames that are given together are propagated in one pass. Each object is propagated from its own annotations
//! alone. Where two annotated objects propose the same pixel, the object that had it keeps it.
//!
//! 1. The annotations of all frames determine the objects that change, and the frames from which each is propagated, its anchors
//!    (`correction/anchors.rs`).
//! 2. A plan lists the frames to visit (`correction/plan.rs`). The first visits learn the appearance of the objects
//!    (`correction/appearance.rs`).
//! 3. Objects are propagated forward and backward (`correction/propagator.rs`, `correction/track.rs`), and compete for pixels
//!    (`correction/group.rs`).
//! 4. Their proposals become the layer of each frame over the labels found automatically (`correction/compose.rs`).

mod anchors;
mod appearance;
mod compose;
mod features;
mod group;
mod label_ratios;
mod placement;
mod plan;
mod prompt;
mod propagator;
mod proposal;
mod strokes;
mod template;
mod trace;
mod track;

use std::collections::VecDeque;
use std::sync::Arc;

use super::annotation::{Direction, ObjectSet, Spread};
use super::changes::Changes;
use super::frame_annotation::{Change, FrameAnnotation};
use super::layer::Layer;
use super::pairs::LayeredMotion;
use super::segmented_clip::SegmentedClip;
use crate::answer::UNLABELLED;
use crate::error::Result;
use crate::frame::Frame;

use compose::Composition;
use features::FrameFeatures;
use group::{Group, Scene};
use plan::{Anchor, Task, Visit, groups, visits};
use prompt::outline;
use proposal::Proposal;
use track::Track;

/// Annotations of frames of one scene that spread through a [`SegmentedClip`] together. It asks for the frames that it needs.
#[derive(Clone, Debug)]
pub(super) struct SceneCorrection {
    /// Indices of the annotated frames.
    annotated: Vec<usize>,
    /// Annotations that still wait for their frame, with its index.
    waiting: VecDeque<(usize, Change)>,
    /// First and last frame of the scene.
    scene: [usize; 2],
    /// Objects that the annotations change.
    changing: ObjectSet,
    /// For each object, its anchors after the annotations taken so far.
    anchors: Vec<Vec<Anchor>>,
    groups: Vec<Group>,
    /// Frames to visit, the next one last.
    visits: Vec<Visit>,
    /// Whether the layer of each frame of the scene is up to date.
    is_done: Vec<bool>,
    /// For each frame of the scene, the annotated objects that reach it.
    users: Vec<ObjectSet>,
    /// Objects whose annotations were only added to, never taken back.
    extended: ObjectSet,
}

impl SceneCorrection {
    /// A correction by at least one annotation; all annotated frames are in one scene.
    pub(super) fn new(clip: &SegmentedClip, waiting: VecDeque<(usize, Change)>) -> SceneCorrection {
        let annotated: Vec<usize> = waiting.iter().map(|(index, _)| *index).collect();
        let scene @ [first, last] = clip.scene(annotated[0]);
        SceneCorrection {
            annotated,
            waiting,
            scene,
            changing: [false; 256],
            anchors: clip.anchors(scene),
            groups: Vec::new(),
            visits: Vec::new(),
            is_done: vec![false; last + 1 - first],
            users: (first..=last).map(|t| clip.user_objects_in(t)).collect(),
            extended: [true; 256],
        }
    }

    /// Index of the frame to [`take`](Self::take) next; `None` when the annotations have spread.
    pub(super) fn wanted(&self) -> Option<usize> {
        let waiting = self.waiting.front().map(|(index, _)| *index);
        waiting.or_else(|| self.visits.last().map(|visit| visit.frame))
    }

    /// Takes the frame that is [`wanted`](Self::wanted).
    ///
    /// # Errors
    /// [`Error::FrameSizeMismatch`](crate::Error::FrameSizeMismatch), [`Error::OtherFrame`](crate::Error::OtherFrame); the correction can
    /// continue with the right frame.
    pub(super) fn take(&mut self, clip: &mut SegmentedClip, frame: &Frame, changes: &mut Changes) -> Result<()> {
        let Some(index) = self.wanted() else { return Ok(()) };
        clip.check(index, frame)?;
        let arrived = Arrived { index, frame, features: &FrameFeatures::new(frame) };
        while self.waiting.front().is_some_and(|(own, _)| *own == index)
            && let Some((_, change)) = self.waiting.pop_front()
        {
            self.begin(clip, &arrived, change, changes);
            if self.waiting.is_empty() {
                self.plan(clip);
            }
        }
        // One frame may be wanted for several tasks in a row.
        while let Some(visit) = self.visits.pop_if(|visit| visit.frame == index) {
            match &visit.task {
                Task::Learn(objects) => self.learn(clip, &arrived, objects),
                Task::Anchor => self.propagate(clip, &arrived, Direction::Backward, false, changes),
                Task::Propagate { direction, is_kept } => {
                    self.propagate(clip, &arrived, *direction, *is_kept, changes);
                }
            }
        }
        if self.waiting.is_empty() && self.visits.is_empty() {
            self.finish(clip, changes);
        }
        Ok(())
    }

    /// Takes an annotation, and updates its own frame at once if the annotation is new.
    #[inline(never)]
    fn begin(&mut self, clip: &mut SegmentedClip, arrived: &Arrived<'_>, change: Change, changes: &mut Changes) {
        let (index, users) = (arrived.index, arrived.index - self.scene[0]);
        let before = clip.frames[index].annotation.as_deref().cloned().unwrap_or_default();
        let shown = clip.overlaid(index, &clip.found_full(index, arrived.frame.luminance()), &self.users[users]);
        let mut now = before.clone();
        match change {
            Change::Painted(painted) => painted.iter().for_each(|painted| now.paint(painted)),
            Change::Clear(object) => now.clear(object),
            Change::Prompt(prompt) => {
                let labels = outline(clip, index, arrived.frame, arrived.features, &shown, &prompt);
                now.point(prompt, &labels);
            }
        }
        now.forget(&clip.objects.numbers);
        now.drop_pieces(&before, &shown, clip.size()[0]);
        now.keep_bases(&shown);
        let mut changing: ObjectSet = std::array::from_fn(|k| k > 0 && !now.agrees(&before, k as u8));
        if !now.agrees(&before, 0) {
            // A label map without object numbers erases the objects under its zeros.
            now.takes_from = taken_from(clip, &now, &shown, &self.users[users]);
            before.takes_from.iter().chain(&now.takes_from).for_each(|&object| changing[usize::from(object)] = true);
        }
        self.extended.iter_mut().enumerate().skip(1).for_each(|(k, of)| *of &= now.extends(&before, k as u8));
        let is_new = !now.is_same(&before);
        clip.frames[index].annotation = (!now.is_empty()).then(|| Arc::new(now));
        clip.update_anchors(self.scene);
        let anchors_before = std::mem::replace(&mut self.anchors, clip.anchors(self.scene));
        for (object, changes) in changing.iter_mut().enumerate().take(anchors_before.len()) {
            *changes |= self.anchors[object] != anchors_before[object];
            *changes &= !clip.objects.locked[object] && clip.objects.numbers[object] > 0;
        }
        if is_new {
            self.at_once(clip, arrived, &shown, &changing, changes);
            let labels = clip.frames[index].layer.as_ref().map(|layer| layer.labels.values()).unwrap_or_default();
            if let Some(annotation) = &mut clip.frames[index].annotation {
                Arc::make_mut(annotation).keep_seen(&labels, &changing);
            }
        }
        self.users[users] = clip.user_objects_in(index);
        self.changing.iter_mut().zip(changing).for_each(|(all, now)| *all |= now);
    }

    /// Plans the visits by which the annotations spread.
    fn plan(&mut self, clip: &SegmentedClip) {
        let members = groups(&self.changing, &self.anchors);
        let [first, last] = self.scene;
        let found = |object: u8| (first..=last).filter(|&t| clip.is_found_in(t, object)).collect();
        self.visits = visits(self.scene, &members, &found);
        self.groups = members.into_iter().map(|members| Group::new(members, last + 1)).collect();
    }

    /// Updates the annotated frame at once. Each object is compared with its mask before any stroke was drawn, so that the order of strokes
    /// does not matter.
    #[inline(never)]
    fn at_once(
        &mut self,
        clip: &mut SegmentedClip,
        arrived: &Arrived<'_>,
        shown: &[u8],
        changing: &ObjectSet,
        changes: &mut Changes,
    ) {
        let Arrived { index, features, .. } = *arrived;
        let seeds = |object: u8| clip.seeds_at(index, object, features);
        let annotation = clip.frames[index].annotation.as_deref().cloned().unwrap_or_default();
        let mut proposals = Vec::new();
        for object in (1..UNLABELLED).filter(|&object| changing[usize::from(object)]) {
            let is_shown = || shown.iter().map(|&label| u8::from(label == object)).collect();
            let own: Vec<u8> = annotation.base(object).unwrap_or_else(is_shown);
            let own: Vec<u8> = own.into_iter().map(|inside| object * inside).collect();
            let own = features.scaling.gathered(&own, UNLABELLED);
            let scene = Scene { features, seeds: &seeds, seen: &|_| None, found: &own, flows: None };
            let anchor = Anchor { frame: index, spread: Spread::Both, is_whole: false };
            let mut track = Track::new(object, vec![anchor], index + 1);
            track.learn_shown(features, &own);
            let mut group = Group { tracks: vec![track], changing: vec![object] };
            proposals.append(&mut group.visit(index, Direction::Forward, false, &scene));
        }
        self.compose(clip, arrived, &proposals, changes);
    }

    /// Learns from annotations that spread to all frames, and the appearance of objects where they were found automatically.
    fn learn(&mut self, clip: &SegmentedClip, arrived: &Arrived<'_>, objects: &[u8]) {
        let Arrived { index, features, .. } = *arrived;
        let found = clip.found_at(index, features.size);
        for track in self.groups.iter_mut().flat_map(|group| &mut group.tracks) {
            if track.anchor(index).is_some_and(|anchor| anchor.spread == Spread::Both)
                && let Some((seeds, _)) = clip.seeds_at(index, track.object, features)
            {
                track.learn_seeds(features, &seeds, &found);
            }
            if objects.contains(&track.object) {
                track.learn_found(features, &found);
            }
        }
    }

    fn propagate(
        &mut self,
        clip: &mut SegmentedClip,
        arrived: &Arrived<'_>,
        direction: Direction,
        is_kept: bool,
        changes: &mut Changes,
    ) {
        let (Arrived { index: t, features, .. }, [first, last]) = (*arrived, self.scene);
        let found = clip.found_at(t, features.size);
        let flow = |kept: Option<LayeredMotion>| kept.map(|flow| flow.enlarged(features.size));
        let [to, from] = match direction {
            Direction::Forward => [flow(clip.back(t)), if t > first { flow(clip.onward(t - 1)) } else { None }],
            Direction::Backward => [flow(clip.onward(t)), if t < last { flow(clip.back(t + 1)) } else { None }],
        };
        let seeds = |object: u8| clip.seeds_at(t, object, features);
        let flows = to.as_ref().zip(from.as_ref()).map(|(to, from)| [to, from]);
        let seen = |object: u8| clip.seen_at(t, object, features);
        let scene = Scene { features, seeds: &seeds, seen: &seen, found: &found, flows };
        let mut proposals = Vec::new();
        for group in &mut self.groups {
            proposals.append(&mut group.visit(t, direction, is_kept, &scene));
        }
        if !is_kept {
            self.compose(clip, arrived, &proposals, changes);
            self.is_done[t - first] = true;
        }
    }

    /// Gives a frame its layer. An accepted frame changes only by its own annotations.
    #[inline(never)]
    fn compose(
        &mut self,
        clip: &mut SegmentedClip,
        &Arrived { index, frame, features }: &Arrived<'_>,
        proposals: &[(u8, Option<Proposal>)],
        changes: &mut Changes,
    ) {
        if clip.frames[index].accepted && !self.annotated.contains(&index) {
            return;
        }
        let found = &clip.found_full(index, frame.luminance());
        let before = &clip.overlaid(index, found, &self.users[index - self.scene[0]]);
        let composition =
            Composition { clip, index, frame, features, proposals, extended: &self.extended, found, before };
        let layer = composition.layer();
        let labels = |layer: &Option<Arc<Layer>>| layer.as_ref().map(|layer| layer.labels.clone());
        let is_same = labels(&clip.frames[index].layer) == labels(&layer);
        clip.frames[index].layer = layer;
        let now = clip.overlaid(index, found, &clip.user_objects_in(index));
        // An object that was found and is erased completely leaves no layer.
        if !is_same || *before != now {
            changes.set(index, before, &now);
        }
    }

    /// In frames that the propagation did not reach, removes the labels of objects that have no annotation any more.
    fn finish(&mut self, clip: &mut SegmentedClip, changes: &mut Changes) {
        let changing: Vec<u8> = self.groups.iter().flat_map(|group| group.changing.clone()).collect();
        for t in self.scene[0]..=self.scene[1] {
            let state = &clip.frames[t];
            let is_gone = |label: u8| changing.contains(&label) && !state.anchors(label);
            let is_open = !self.is_done[t - self.scene[0]] && !state.accepted;
            let Some(layer) = state.layer.as_ref().filter(|_| is_open) else { continue };
            if layer.labels.any(&is_gone) {
                let labels = layer.labels.map(|label| if is_gone(label) { UNLABELLED } else { label });
                let log_odds = clip.log_odds_of(t, layer);
                changes.add(t);
                clip.frames[t].layer = clip.layer_of(t, &labels.values(), &|_, at| log_odds.values()[at]);
            }
        }
    }
}

/// Annotated objects from which a label map without object numbers takes pixels.
fn taken_from(clip: &SegmentedClip, annotation: &FrameAnnotation, shown: &[u8], users: &ObjectSet) -> Vec<u8> {
    if !annotation.names_no_object() {
        return Vec::new();
    }
    let mut loses = [false; 256];
    let painted = annotation.painted_labels().unwrap_or_default();
    painted.iter().zip(shown).for_each(|(&painted, &shown)| loses[usize::from(shown)] |= painted == 0);
    let is_taken = |k: usize| users[k] && loses[k] && !clip.objects.locked[k];
    (1..UNLABELLED).filter(|&object| is_taken(usize::from(object))).collect()
}

/// A frame that was handed in.
#[derive(Clone, Copy)]
struct Arrived<'a> {
    index: usize,
    frame: &'a Frame,
    features: &'a FrameFeatures,
}
