//! The states of a clip, one after each step: undo and redo choose among them. States share all parts in which they do not differ.

use std::sync::Arc;

use super::shown::Shown;
use crate::clip::frame_annotation::FrameAnnotation;
use crate::clip::frame_state::{Found, FrameState};
use crate::clip::layer::Layer;
use crate::clip::objects::Objects;
use crate::clip::runs::Runs;
use crate::clip::saved::saved;
use crate::clip::segmented_clip::SegmentedClip;

/// What is known of each frame.
pub(super) type ByFrame<T> = Vec<Option<Arc<T>>>;

/// A state, and the step that has led to it.
#[derive(Clone, Debug)]
pub(super) struct State {
    /// The step; 0 for the clip as it was opened.
    pub(super) step: u32,
    pub(super) clip: SegmentedClip,
    /// The labels of frames as they are shown.
    pub(super) remembered: ByFrame<Shown>,
    /// Whether a description can be part of the step, which has segmented no range.
    pub(super) is_open: bool,
    /// Bytes of what differs from the state before.
    bytes: usize,
}

/// The states that can be returned to.
#[derive(Clone, Debug)]
pub(super) struct History {
    states: Vec<State>,
    /// Index of the current state.
    current: usize,
}

impl History {
    /// The clip as it was opened.
    pub(super) fn new(clip: SegmentedClip) -> History {
        let remembered = vec![None; clip.len()];
        let opened = State { step: 0, clip, remembered, is_open: false, bytes: 0 };
        History { states: vec![opened], current: 0 }
    }

    /// With an oldest state.
    pub(super) fn first(state: State) -> History {
        History { states: vec![state], current: 0 }
    }

    pub(super) fn current(&self) -> &State {
        &self.states[self.current]
    }

    pub(super) fn current_mut(&mut self) -> &mut State {
        &mut self.states[self.current]
    }

    /// The state before the current one, which a step that is part of the last one follows.
    pub(super) fn before(&self) -> Option<&State> {
        self.states.get(self.current.checked_sub(1)?)
    }

    /// All states, the oldest first.
    pub(super) fn states(&self) -> &[State] {
        &self.states
    }

    /// The state after a step.
    pub(super) fn after(&self, step: u32) -> Option<&State> {
        self.states.iter().find(|state| state.step == step)
    }

    /// Numbers of steps that can be undone and redone.
    pub(super) fn steps(&self) -> [usize; 2] {
        [self.current, self.states.len() - 1 - self.current]
    }

    /// Adds the state that follows another one, in place of all that followed it before.
    pub(super) fn push(&mut self, parent: u32, state: State) {
        let at = self.states.iter().position(|of| of.step == parent).unwrap_or(self.current);
        self.states.truncate(at + 1);
        self.states.push(state);
        self.current = at + 1;
    }

    /// Bytes of all states, without what they share.
    pub(super) fn bytes(&self) -> usize {
        self.states.iter().map(|state| state.bytes).sum()
    }

    /// Forgets the oldest states if the differences of all take more than so many bytes.
    pub(super) fn forget(&mut self, budget: usize) {
        let bytes = |k: usize| self.states[k].bytes + self.states[k].labels_unlike(&self.states[k - 1]);
        let mut bytes: Vec<usize> = (1..self.states.len()).map(bytes).collect();
        let mut count = 0;
        while count < self.current && bytes.iter().sum::<usize>() > budget {
            bytes[count] = 0;
            count += 1;
        }
        self.states.drain(..count);
        self.current -= count;
    }

    /// Makes the state after a step the current one. Returns whether it is known.
    pub(super) fn go_to(&mut self, step: u32) -> bool {
        let at = self.states.iter().position(|state| state.step == step);
        self.current = at.unwrap_or(self.current);
        at.is_some()
    }

    /// The step that undo, or redo, would return to.
    pub(super) fn beside(&self, is_undo: bool) -> Option<u32> {
        let at = if is_undo { self.current.checked_sub(1)? } else { self.current + 1 };
        self.states.get(at).map(|state| state.step)
    }
}

impl State {
    /// Bytes of the labels that another state remembers and this one does not.
    fn labels_unlike(&self, before: &State) -> usize {
        let mut bytes = 0;
        for (own, shown) in self.remembered.iter().zip(&before.remembered) {
            if let Some(shown) = shown
                && !own.as_ref().is_some_and(|own| Arc::ptr_eq(own, shown))
            {
                bytes += shown.bytes();
            }
        }
        bytes
    }

    pub(super) fn new(
        step: u32,
        clip: SegmentedClip,
        remembered: ByFrame<Shown>,
        is_open: bool,
        bytes: usize,
    ) -> State {
        // A state holds pointers to its parts.
        let bytes = bytes + size_of_val(&clip.frames[..]);
        State { step, clip, remembered, is_open, bytes }
    }
}

/// How a state differs from another one: the parts that it does not share with it.
#[derive(Clone, Debug)]
pub(super) struct Difference {
    size: [usize; 2],
    objects: Option<Arc<Objects>>,
    frames: Vec<(usize, FrameDifference)>,
}

saved!(Difference { size, objects, frames });

/// The parts of a frame that differ; a part may be gone.
#[derive(Clone, Debug)]
struct FrameDifference {
    found: Option<Option<Arc<Found>>>,
    renumbered: Option<Option<Arc<Runs>>>,
    annotation: Option<Option<Arc<FrameAnnotation>>>,
    layer: Option<Option<Arc<Layer>>>,
    exact: Option<Option<Arc<Runs>>>,
    accepted: Option<bool>,
}

saved!(FrameDifference { found, renumbered, annotation, layer, exact, accepted });

impl FrameDifference {
    fn is_empty(&self) -> bool {
        let FrameDifference { found, renumbered, annotation, layer, exact, accepted } = self;
        found.is_none()
            && renumbered.is_none()
            && annotation.is_none()
            && layer.is_none()
            && exact.is_none()
            && accepted.is_none()
    }
}

impl Difference {
    /// The difference of a state from one before. Equal parts become shared.
    pub(super) fn between(before: &SegmentedClip, now: &mut SegmentedClip) -> Difference {
        let objects = differing(&before.objects, &mut now.objects);
        let mut frames = Vec::new();
        for (index, (before, now)) in before.frames.iter().zip(&mut now.frames).enumerate() {
            let difference = FrameDifference {
                found: part(&before.found, &mut now.found),
                renumbered: part(&before.renumbered, &mut now.renumbered),
                annotation: part(&before.annotation, &mut now.annotation),
                layer: part(&before.layer, &mut now.layer),
                exact: part(&before.exact, &mut now.exact),
                accepted: (before.accepted != now.accepted).then_some(now.accepted),
            };
            if !difference.is_empty() {
                frames.push((index, difference));
            }
        }
        Difference { size: now.size, objects, frames }
    }

    /// Whether there is none.
    pub(super) fn is_empty(&self) -> bool {
        self.objects.is_none() && self.frames.is_empty()
    }

    /// The frames that were segmented.
    pub(super) fn segmented(&self) -> impl Iterator<Item = usize> + '_ {
        self.frames.iter().filter(|(_, frame)| frame.found.is_some()).map(|(index, _)| *index)
    }

    /// The state that differs so from another one; `None` if that is not valid.
    pub(super) fn applied(self, before: &SegmentedClip) -> Option<SegmentedClip> {
        let mut clip = before.clone();
        clip.size = self.size;
        if let Some(objects) = self.objects {
            clip.objects = objects;
        }
        for (index, of) in self.frames {
            let frame = clip.frames.get_mut(index)?;
            *frame = FrameState {
                found: of.found.unwrap_or_else(|| frame.found.clone()),
                renumbered: of.renumbered.unwrap_or_else(|| frame.renumbered.clone()),
                annotation: of.annotation.unwrap_or_else(|| frame.annotation.clone()),
                layer: of.layer.unwrap_or_else(|| frame.layer.clone()),
                exact: of.exact.unwrap_or_else(|| frame.exact.clone()),
                accepted: of.accepted.unwrap_or(frame.accepted),
            };
        }
        clip.is_valid().then_some(clip)
    }
}

/// The part if it differs. An equal one is replaced by the one before, so that both states share it.
fn differing<T: PartialEq>(before: &Arc<T>, now: &mut Arc<T>) -> Option<Arc<T>> {
    if !Arc::ptr_eq(before, now) && before == now {
        *now = before.clone();
    }
    (!Arc::ptr_eq(before, now)).then(|| now.clone())
}

fn part<T: PartialEq>(before: &Option<Arc<T>>, now: &mut Option<Arc<T>>) -> Option<Option<Arc<T>>> {
    match (before, now) {
        (None, None) => None,
        (Some(before), Some(now)) => differing(before, now).map(Some),
        (_, now) => Some(now.clone()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn history(bytes: &[usize]) -> History {
        let clip = || SegmentedClip {
            size: [0, 0],
            mark_unknown: false,
            objects: Arc::new(Objects::new(0)),
            frames: Vec::new(),
        };
        let mut history = History::new(clip());
        for (parent, &bytes) in bytes.iter().enumerate() {
            history.push(parent as u32, State::new(parent as u32 + 1, clip(), Vec::new(), false, bytes));
        }
        history
    }

    #[test]
    fn the_oldest_states_are_forgotten_and_neither_the_current_one_nor_what_was_undone() {
        let steps = |undone: usize, budget: usize| {
            let mut history = history(&[10, 20, 30, 40]);
            (0..undone).for_each(|_| assert!(history.beside(true).is_some_and(|step| history.go_to(step))));
            history.forget(budget);
            (history.steps(), history.current().step)
        };
        assert_eq!(steps(0, 100), ([4, 0], 4));
        assert_eq!(steps(0, 90), ([3, 0], 4));
        assert_eq!(steps(0, 89), ([2, 0], 4));
        assert_eq!(steps(0, 0), ([0, 0], 4));
        assert_eq!(steps(2, 0), ([0, 2], 2));
    }

    #[test]
    fn a_step_takes_the_place_of_what_was_undone() {
        let mut history = history(&[1, 1, 1]);
        assert!(history.go_to(1) && !history.go_to(9));
        assert_eq!((history.beside(true), history.beside(false)), (Some(0), Some(2)));
        let state = State { step: 7, ..history.current().clone() };
        history.push(1, state);
        assert_eq!((history.steps(), history.current().step, history.beside(false)), ([2, 0], 7, None));
        assert!(history.after(2).is_none() && history.after(3).is_none());
    }
}
