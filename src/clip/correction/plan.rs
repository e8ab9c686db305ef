//! The frames that a correction visits, and what for: a pure function of the annotated frames of each object.

use crate::answer::UNLABELLED;
use crate::clip::annotation::{Direction, ObjectSet, Spread};

/// A frame from whose annotations an object is propagated, and in which directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Anchor {
    pub(super) frame: usize,
    pub(super) spread: Spread,
    /// Whether a person has given the object's whole mask there.
    pub(super) is_whole: bool,
}

impl Direction {
    /// The frame in which the propagation of an object begins, given its anchors in ascending order of frames.
    pub(super) fn first(self, anchors: &[Anchor]) -> Option<usize> {
        let spreads = |anchor: &&Anchor| anchor.spread.goes(self);
        let anchor = match self {
            Direction::Forward => anchors.iter().find(spreads),
            Direction::Backward => anchors.iter().rev().find(spreads),
        };
        anchor.map(|anchor| anchor.frame)
    }
}

/// Objects that are propagated together because they have anchors in the same frames.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Members {
    /// Objects and their anchors.
    pub(super) anchors: Vec<(u8, Vec<Anchor>)>,
    /// The objects that change. The others compete with them for pixels.
    pub(super) changing: Vec<u8>,
}

/// A visit of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Visit {
    pub(super) frame: usize,
    pub(super) task: Task,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Task {
    /// Learn the annotations that spread to all frames, and the appearance of some objects where they were found automatically.
    Learn(Vec<u8>),
    /// Apply the annotations of an anchor that no propagation reaches.
    Anchor,
    /// Propagate to the frame. With `is_kept`, its proposals are kept for the backward pass.
    Propagate { direction: Direction, is_kept: bool },
}

/// Groups the changing objects with those that share anchors with them. Both arguments are indexed by object number.
pub(super) fn groups(changing: &ObjectSet, anchors: &[Vec<Anchor>]) -> Vec<Members> {
    let mut groups: Vec<Members> = Vec::new();
    for object in (1..UNLABELLED).filter(|&object| changing[usize::from(object)]) {
        let of = |object: u8| &anchors[usize::from(object)];
        let of_these = |group: &&mut Members| of(group.changing[0]) == of(object);
        if let Some(group) = groups.iter_mut().find(of_these) {
            group.changing.push(object);
            continue;
        }
        let is_shared = |anchor: &&Anchor| of(object).iter().any(|own| own.frame == anchor.frame);
        let shared = (1..UNLABELLED).map(|other| (other, of(other).iter().filter(is_shared).copied().collect()));
        let members = shared.filter(|(other, anchors): &(u8, Vec<Anchor>)| *other == object || !anchors.is_empty());
        groups.push(Members { anchors: members.collect(), changing: vec![object] });
    }
    groups
}

/// The visits of a scene, in reverse order. `found` gives the frames in which an object was found automatically.
///
/// Frames to learn from come first; then anchors that no propagation reaches; then the forward pass from the first anchor of any object,
/// and the backward pass from the last one. Frames of both passes become final in the backward pass.
pub(super) fn visits([first, last]: [usize; 2], groups: &[Members], found: &dyn Fn(u8) -> Vec<usize>) -> Vec<Visit> {
    let objects: Vec<&(u8, Vec<Anchor>)> = groups.iter().flat_map(|group| &group.anchors).collect();
    let begins = |direction: Direction| objects.iter().filter_map(move |(_, anchors)| direction.first(anchors));
    let (forward, backward) = (begins(Direction::Forward).min(), begins(Direction::Backward).max());
    let tracked = (1..UNLABELLED).filter(|object| objects.iter().any(|(of, _)| of == object));
    let samples: Vec<(u8, Vec<usize>)> = tracked.map(|object| (object, sample(&found(object)))).collect();
    let spreads_to_all = |frame: usize| {
        let anchor = Anchor { frame, spread: Spread::Both, is_whole: false };
        objects.iter().any(|(_, anchors)| anchors.contains(&anchor))
    };
    let mut visits = Vec::new();
    for frame in first..=last {
        let seen = samples.iter().filter(|(_, frames)| frames.contains(&frame)).map(|(object, _)| *object);
        let seen: Vec<u8> = seen.collect();
        if !seen.is_empty() || spreads_to_all(frame) {
            visits.push(Visit { frame, task: Task::Learn(seen) });
        }
    }
    let is_reached =
        |frame: usize| forward.is_some_and(|from| frame >= from) || backward.is_some_and(|from| frame <= from);
    let is_anchor =
        |frame: usize| objects.iter().any(|(_, anchors)| anchors.iter().any(|anchor| anchor.frame == frame));
    let alone = (first..=last).filter(|&frame| is_anchor(frame) && !is_reached(frame));
    visits.extend(alone.map(|frame| Visit { frame, task: Task::Anchor }));
    if let Some(from) = forward {
        let task = |frame| {
            let is_kept = backward.is_some_and(|furthest| frame < furthest);
            Task::Propagate { direction: Direction::Forward, is_kept }
        };
        visits.extend((from..=last).map(|frame| Visit { frame, task: task(frame) }));
    }
    if let Some(furthest) = backward {
        // The last frame of the backward pass became final in the forward pass.
        let end = if forward.is_some_and(|from| from <= furthest) { furthest } else { furthest + 1 };
        let task = Task::Propagate { direction: Direction::Backward, is_kept: false };
        visits.extend((first..end).rev().map(|frame| Visit { frame, task: task.clone() }));
    }
    visits.reverse();
    visits
}

/// A few of the frames, evenly spaced from the last one back.
fn sample(frames: &[usize]) -> Vec<usize> {
    /// Enough to learn the appearance of an object; more would cost time.
    const MOST: usize = 8;
    let count = frames.len().min(MOST);
    (0..count).map(|k| frames[frames.len() - 1 - k * frames.len() / count]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn anchors(frames: &[(usize, Spread)]) -> Vec<Anchor> {
        frames.iter().map(|&(frame, spread)| Anchor { frame, spread, is_whole: false }).collect()
    }

    /// The tasks of the visits as letters: learn, anchor, forward, forward and kept, backward.
    fn order(scene: [usize; 2], members: &[(u8, Vec<Anchor>)], found: &dyn Fn(u8) -> Vec<usize>) -> String {
        let group = Members { anchors: members.to_vec(), changing: vec![members[0].0] };
        let name = |visit: &Visit| match visit.task {
            Task::Learn(_) => 'l',
            Task::Anchor => 'a',
            Task::Propagate { direction: Direction::Forward, is_kept: false } => 'f',
            Task::Propagate { direction: Direction::Forward, is_kept: true } => 'k',
            Task::Propagate { direction: Direction::Backward, .. } => 'b',
        };
        let mut visits = visits(scene, &[group], found);
        visits.reverse();
        visits.iter().map(|visit| format!("{}{}", name(visit), visit.frame)).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn a_scene_is_passed_forward_and_back() {
        let nowhere = |_: u8| Vec::new();
        let one = |frames: &[(usize, Spread)]| order([2, 6], &[(1, anchors(frames))], &nowhere);
        assert_eq!(one(&[(4, Spread::Both)]), "l4 f4 f5 f6 b3 b2");
        assert_eq!(one(&[(3, Spread::Both), (5, Spread::Both)]), "l3 l5 k3 k4 f5 f6 b4 b3 b2");
        assert_eq!(one(&[(4, Spread::Forward)]), "f4 f5 f6");
        assert_eq!(one(&[(4, Spread::Backward)]), "b4 b3 b2");
        assert_eq!(one(&[(4, Spread::None)]), "a4");
        assert_eq!(one(&[(3, Spread::Backward), (4, Spread::None), (5, Spread::Forward)]), "a4 f5 f6 b3 b2");
    }

    #[test]
    fn appearance_is_learnt_in_a_few_frames() {
        let found = |_: u8| (0..40).collect();
        let order = order([0, 39], &[(1, anchors(&[(39, Spread::None)]))], &found);
        assert_eq!(order, "l4 l9 l14 l19 l24 l29 l34 l39 a39");
    }

    #[test]
    fn objects_of_the_same_frames_go_together() {
        let mut of = vec![Vec::new(); 256];
        of[1] = anchors(&[(0, Spread::Both)]);
        of[2] = anchors(&[(0, Spread::Both)]);
        of[3] = anchors(&[(0, Spread::Both), (5, Spread::Both)]);
        of[4] = anchors(&[(5, Spread::Both)]);
        let mut changing = [false; 256];
        [1, 2, 4].into_iter().for_each(|object| changing[object] = true);
        let groups = groups(&changing, &of);
        let zero = anchors(&[(0, Spread::Both)]);
        let five = anchors(&[(5, Spread::Both)]);
        let first = vec![(1, zero.clone()), (2, zero.clone()), (3, zero)];
        let second = vec![(3, five.clone()), (4, five)];
        assert_eq!(groups[0], Members { anchors: first, changing: vec![1, 2] });
        assert_eq!(groups[1], Members { anchors: second, changing: vec![4] });
        assert_eq!(groups.len(), 2);
    }
}
