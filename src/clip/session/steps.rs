//! A command that takes effect: on a copy of the state, in phases that ask for the frames that they need.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::Arc;

use super::ranges::{RangeJob, resized};
use crate::answer::UNLABELLED;
use crate::clip::annotation::{Accepted, Annotations, Click, ObjectSet, Painted, Prompt, Spread, is_object};
use crate::clip::changes::{Changed, Changes};
use crate::clip::command::{Annotation, Command, Content, Declaration};
use crate::clip::description::ClipFrame;
use crate::clip::frame_state::FrameState;
use crate::clip::job::ClipJob;
use crate::clip::objects::{Description, Objects};
use crate::clip::runs::Runs;
use crate::clip::segmented_clip::SegmentedClip;
use crate::components::{Connectivity, components};
use crate::error::{Error, Result};
use crate::frame::Frame;
use crate::order::descending;

/// A command under way.
#[derive(Clone, Debug)]
pub(super) struct Running {
    pub(super) step: u32,
    pub(super) clip: SegmentedClip,
    /// The object that the command describes, and whether it is then part of the step before.
    pub(super) describes: Option<(u8, bool)>,
    phases: VecDeque<Phase>,
    job: Option<ClipJob>,
    /// What objects have gained and lost in earlier phases.
    changes: Vec<Changed>,
}

#[derive(Clone, Debug)]
enum Phase {
    Annotate(Annotations),
    /// Draws labels exactly; of one object if there is one.
    Draw { frame: usize, object: Option<u8>, labels: Vec<u8> },
    Split { object: u8, frame: usize },
    /// Restores locks and names that were lifted.
    Restore { locked: ObjectSet, named: ObjectSet },
}

impl Running {
    /// Begins a command on a copy of a state.
    ///
    /// # Errors
    /// [`Error::InvalidOption`], [`Error::ObjectLocked`].
    pub(super) fn new(step: u32, before: &SegmentedClip, command: Command) -> Result<Running> {
        let mut clip = before.clone();
        let describes = match &command {
            Command::Describe { object, coalesce, .. } => Some((*object, *coalesce)),
            _ => None,
        };
        let phases = phases(&mut clip, command)?;
        Running { step, clip, describes, phases, job: None, changes: Vec::new() }.advanced()
    }

    /// Puts a segmented range in its place, and applies the annotations of its scenes again.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] for a range of fewer than two frames.
    pub(super) fn of_range(range: RangeJob, before: &SegmentedClip) -> Result<Running> {
        let step = range.step;
        let (mut clip, scenes) = range.conclude(before)?;
        let phases = repeated(before, &mut clip, scenes).into();
        Running { step, clip, describes: None, phases, job: None, changes: Vec::new() }.advanced()
    }

    /// The frame to [`take`](Self::take) next; `None` when the command has taken effect.
    pub(super) fn wanted(&self) -> Option<usize> {
        self.job.as_ref().and_then(ClipJob::wanted).or_else(|| match self.phases.front()? {
            Phase::Draw { frame, .. } | Phase::Split { frame, .. } => Some(*frame),
            Phase::Annotate(_) | Phase::Restore { .. } => None,
        })
    }

    /// Takes the frame that is wanted.
    ///
    /// # Errors
    /// [`Error::FrameSizeMismatch`], [`Error::OtherFrame`]: the right frame can be taken. Other errors end the command.
    pub(super) fn take(&mut self, frame: &Frame) -> Result<()> {
        if let Some(job) = self.job.as_mut().filter(|job| job.wanted().is_some()) {
            job.take(&mut self.clip, frame)?;
        } else if let Some(index) = self.wanted() {
            let shown = self.clip.frame(index, frame)?;
            match self.phases.pop_front() {
                Some(Phase::Draw { object, labels, .. }) => self.draw(&shown, object, &labels),
                Some(Phase::Split { object, .. }) => {
                    let annotations = split(&self.clip, &shown, object)?;
                    self.phases.push_front(Phase::Annotate(annotations));
                }
                _ => {}
            }
        }
        self.advance()
    }

    /// Whether it has changed a frame.
    pub(super) fn has_changed(&self, index: usize) -> bool {
        self.job.as_ref().is_some_and(|job| job.changed().contains(&index))
            || self.changes.iter().any(|changed| changed.frame == index)
    }

    /// What objects have gained and lost.
    pub(super) fn changes(&self) -> Vec<Changed> {
        let job = self.job.as_ref().map(ClipJob::changes).unwrap_or_default();
        [&self.changes[..], &job[..]].concat()
    }

    fn advanced(mut self) -> Result<Running> {
        self.advance()?;
        Ok(self)
    }

    /// Goes on to the next phase that needs a frame.
    fn advance(&mut self) -> Result<()> {
        while self.wanted().is_none() {
            self.changes = self.changes();
            self.job = None;
            match self.phases.pop_front() {
                Some(Phase::Annotate(annotations)) => self.job = Some(self.clip.annotate(annotations)?),
                Some(Phase::Restore { locked, named }) => {
                    let objects = self.clip.objects_mut();
                    (objects.locked, objects.named) = (locked, named);
                }
                _ => break,
            }
        }
        Ok(())
    }

    /// Draws labels exactly. Pixels of locked objects stay as they are; the ground of one object is ground for this object alone.
    fn draw(&mut self, shown: &ClipFrame, object: Option<u8>, labels: &[u8]) {
        let ClipFrame { index, labels: shown, .. } = shown;
        let frame = &mut self.clip.frames[*index];
        let mut exact = frame.exact.as_ref().map_or_else(|| vec![UNLABELLED; shown.len()], |exact| exact.values());
        let mut now = shown.clone();
        for (p, &label) in labels.iter().enumerate().filter(|(_, label)| **label != UNLABELLED) {
            let was = shown[p];
            let is_others = label == 0 && object.is_some_and(|object| object != was);
            if !self.clip.objects.locked[usize::from(was)] && !is_others {
                (exact[p], now[p]) = (label, label);
            }
        }
        frame.exact = some_labels(&exact);
        let mut changes = Changes::default();
        changes.set(*index, shown, &now);
        self.changes.extend(changes.list());
    }
}

/// Labels as runs; `None` if all are open.
fn some_labels(labels: &[u8]) -> Option<Arc<Runs>> {
    labels.iter().any(|label| *label != UNLABELLED).then(|| Arc::new(Runs::of(labels)))
}

fn invalid<T>(name: &'static str, reason: String) -> Result<T> {
    Err(Error::InvalidOption { name, reason })
}

/// The phases of a command. What needs no frame takes effect at once.
fn phases(clip: &mut SegmentedClip, command: Command) -> Result<VecDeque<Phase>> {
    let annotations = match command {
        Command::Segment { .. } => return Ok(VecDeque::new()),
        Command::Annotate(annotations) => return annotate(clip, annotations),
        Command::ReplaceAnnotations(all) => return replace(clip, all),
        Command::Clear { frame, object } => {
            let object = object.map(|object| current_number(clip, object)).transpose()?;
            uncover(clip, frame, object);
            Annotations { cleared: vec![(frame, object)], accepted: reopened(clip, &[frame]), ..Annotations::default() }
        }
        Command::Accept { frames, on } => {
            let stays = |index: &usize| clip.frames[*index].accepted && (on || !frames.contains(index));
            let mut accepted: Vec<usize> = (0..clip.len()).filter(stays).collect();
            let is_new = |index: &&usize| on && !clip.frames[**index].accepted;
            accepted.extend(frames.iter().filter(is_new).collect::<BTreeSet<_>>());
            Annotations { accepted: Some(accepted_as_shown(accepted)), ..Annotations::default() }
        }
        Command::Lock { objects, on } => {
            let objects = known_objects(clip, &objects)?;
            let is_locked = |object: u8| clip.objects.locked[usize::from(object)];
            let stays = |object: &u8| if objects.contains(object) { on } else { is_locked(*object) };
            Annotations { locked: Some((1..UNLABELLED).filter(stays).collect()), ..Annotations::default() }
        }
        Command::Describe { object, description, .. } => {
            let [object] = known_objects(clip, &[object])?[..] else { return Ok(VecDeque::new()) };
            describe(clip, object, description);
            return Ok(VecDeque::new());
        }
        Command::Merge(objects) => {
            let objects = known_objects(clip, &objects)?;
            Annotations { numbers: merged(&objects), ..Annotations::default() }
        }
        Command::Delete(objects) => {
            let objects = known_objects(clip, &objects)?;
            Annotations { numbers: deleted(&objects), ..Annotations::default() }
        }
        Command::Split { object, frame } => {
            let [object] = known_objects(clip, &[object])?[..] else { return Ok(VecDeque::new()) };
            if clip.objects.locked[usize::from(object)] {
                return Err(Error::ObjectLocked { object });
            }
            return Ok(VecDeque::from([Phase::Split { object, frame }]));
        }
    };
    Ok(VecDeque::from([Phase::Annotate(annotations)]))
}

fn merged(objects: &[u8]) -> Vec<[u8; 2]> {
    let into = objects.first().copied().unwrap_or(0);
    objects.iter().filter(|&&object| object != into).map(|&object| [object, into]).collect()
}

fn deleted(objects: &[u8]) -> Vec<[u8; 2]> {
    objects.iter().map(|&object| [object, 0]).collect()
}

fn accepted_as_shown(frames: Vec<usize>) -> Vec<Accepted> {
    frames.into_iter().map(|frame| Accepted { frame, labels: None }).collect()
}

/// The number under which an object goes on if it was merged.
fn current_number(clip: &SegmentedClip, object: u8) -> Result<u8> {
    if !is_object(object) {
        return invalid("object", format!("{object} is no number of an object: these are 1 to 254"));
    }
    match clip.objects.number(object) {
        0 => invalid("object", format!("object {object} was deleted, and its number is not given again")),
        number => Ok(number),
    }
}

/// The current numbers of objects, each once. All have to be there.
fn known_objects(clip: &SegmentedClip, objects: &[u8]) -> Result<Vec<u8>> {
    let mut known = Vec::new();
    for &object in objects {
        let number = current_number(clip, object)?;
        if !clip.objects.used[usize::from(number)] {
            return invalid("object", format!("there is no object {object}"));
        }
        if !known.contains(&number) {
            known.push(number);
        }
    }
    Ok(known)
}

fn describe(clip: &mut SegmentedClip, object: u8, description: Description) {
    let objects = clip.objects_mut();
    let is_named = !description.name.is_empty();
    match description == Description::default() {
        true => drop(objects.descriptions.remove(&object)),
        false => drop(objects.descriptions.insert(object, description)),
    }
    // An object is named with those that were merged into it.
    for k in (0..objects.named.len()).filter(|&k| k == usize::from(object) || objects.numbers[k] == object) {
        objects.named[k] = is_named;
    }
}

/// The accepted frames without some that are annotated; `None` if none of these is accepted.
fn reopened(clip: &SegmentedClip, annotated: &[usize]) -> Option<Vec<Accepted>> {
    if !annotated.iter().any(|&index| clip.frames[index].accepted) {
        return None;
    }
    let stays = |index: &usize| clip.frames[*index].accepted && !annotated.contains(index);
    Some(accepted_as_shown((0..clip.len()).filter(stays).collect()))
}

/// Removes what was drawn exactly in a frame, of one object or of all.
fn uncover(clip: &mut SegmentedClip, frame: usize, object: Option<u8>) {
    let numbers = clip.objects.numbers;
    let goes = |label: u8| object.is_none_or(|object| numbers[usize::from(label)] == object);
    let frame = &mut clip.frames[frame];
    frame.exact = frame.exact.take().and_then(|exact| {
        let labels: Vec<u8> = exact.values().into_iter().map(|l| if goes(l) { UNLABELLED } else { l }).collect();
        some_labels(&labels)
    });
}

/// The phases of annotations.
fn annotate(clip: &mut SegmentedClip, all: Vec<Annotation>) -> Result<VecDeque<Phase>> {
    let frames: Vec<usize> = all.iter().map(|annotation| annotation.frame).collect();
    let (annotations, draws) = combined(clip, all)?;
    for Painted { frame, object, labels, .. } in &annotations.corrections {
        uncover_under(clip, *frame, *object, labels);
    }
    let annotations = Annotations { accepted: reopened(clip, &frames), ..annotations };
    Ok(std::iter::once(Phase::Annotate(annotations)).chain(draws).collect())
}

/// Annotations with the current numbers of objects. Strokes and label maps lie over those before; what is drawn exactly comes last.
fn combined(clip: &SegmentedClip, all: Vec<Annotation>) -> Result<(Annotations, Vec<Phase>)> {
    let (mut annotations, mut draws) = (Annotations::default(), Vec::new());
    // By frame and object, 0 for label maps; in the order of their last change.
    let mut painted: Vec<Painted> = Vec::new();
    let pixels = clip.size[0] * clip.size[1];
    let fills = |labels: &[u8]| match labels.len() == pixels {
        true => Ok(()),
        false => {
            let ([width, height], count) = (clip.size, labels.len());
            invalid("labels", format!("{count} labels do not fill a frame of {width}×{height} pixels"))
        }
    };
    for Annotation { frame, content, spread } in all {
        let earlier = |painted: &[Painted], object: Option<u8>| {
            let own = painted.iter().find(|of| (of.frame, of.object) == (frame, object)).map(|of| of.labels.clone());
            let before = || clip.frames[frame].annotation.as_ref()?.painted_of(object.unwrap_or(0));
            own.or_else(before)
        };
        let mut paint = |object: Option<u8>, labels: Vec<u8>, painted: &mut Vec<Painted>| {
            if spread == Spread::Exact {
                draws.push(Phase::Draw { frame, object, labels });
                return;
            }
            painted.retain(|of| (of.frame, of.object) != (frame, object));
            painted.push(Painted { frame, object, labels, spread });
        };
        match content {
            Content::Strokes { object, labels } | Content::Mask { object, labels } if labels.iter().any(|l| ![0, 1, 255].contains(l)) => {
                return invalid("labels", format!("those of object {object} alone are 1, 0 and 255"));
            }
            Content::Strokes { object, labels } => {
                fills(&labels)?;
                let (object, now) = own_labels(clip, object, &labels)?;
                let before = if spread == Spread::Exact { None } else { earlier(&painted, Some(object)) };
                paint(Some(object), over(before, now), &mut painted);
            }
            Content::Mask { object, labels } => {
                fills(&labels)?;
                let (object, now) = own_labels(clip, object, &labels)?;
                paint(Some(object), now, &mut painted);
            }
            Content::Labels(labels) => {
                fills(&labels)?;
                let labels = current_labels(clip, &labels)?;
                if spread != Spread::Exact {
                    let names_objects = labels.iter().any(|&label| is_object(label));
                    let strokes = |object: &u8| !clip.objects.locked[usize::from(*object)];
                    for object in (1..UNLABELLED).filter(|_| names_objects).filter(strokes) {
                        let Some(strokes) = earlier(&painted, Some(object)) else { continue };
                        let rest: Vec<u8> = strokes
                            .iter()
                            .zip(&labels)
                            .map(|(&stroke, &label)| if label == UNLABELLED { stroke } else { UNLABELLED })
                            .collect();
                        if rest != strokes {
                            let spread = spread_of(clip, &painted, frame, object);
                            painted.retain(|of| (of.frame, of.object) != (frame, Some(object)));
                            painted.push(Painted { frame, object: Some(object), labels: rest, spread });
                        }
                    }
                }
                let before = if spread == Spread::Exact { None } else { earlier(&painted, None) };
                paint(None, over(before, labels), &mut painted);
            }
            Content::Given(labels) => {
                fills(&labels)?;
                if let Some(&object) = labels.iter().find(|label| clip.objects.locked[usize::from(**label)]) {
                    return Err(Error::ObjectLocked { object });
                }
                annotations.masks.retain(|of| of.frame != frame);
                annotations.masks.push(Painted { frame, object: None, labels, spread });
            }
            Content::Prompt { .. } if spread == Spread::Exact => {
                return invalid("propagate", "clicks and boxes cannot be drawn exactly: draw a mask".into());
            }
            Content::Prompt { object, clicks, within } => {
                let object = current_number(clip, object)?;
                annotations.prompts.retain(|of: &Prompt| (of.frame, of.object) != (frame, object));
                annotations.prompts.push(Prompt { frame, object, clicks, within, spread });
            }
        }
    }
    annotations.corrections = painted;
    // Labels that are drawn exactly are no annotations that could be checked later.
    let locked = draws.iter().find_map(|draw| match draw {
        Phase::Draw { object: Some(object), .. } => Some(*object).filter(|&k| clip.objects.locked[usize::from(k)]),
        _ => None,
    });
    locked.map_or(Ok((annotations, draws)), |object| Err(Error::ObjectLocked { object }))
}

/// The frames to which earlier strokes of an object spread.
fn spread_of(clip: &SegmentedClip, painted: &[Painted], frame: usize, object: u8) -> Spread {
    let own = painted.iter().find(|of| (of.frame, of.object) == (frame, Some(object))).map(|of| of.spread);
    own.or_else(|| Some(clip.frames[frame].annotation.as_ref()?.spread_of(object))).unwrap_or_default()
}

/// The current number of an object, and labels of it with this number in place of 1.
fn own_labels(clip: &SegmentedClip, object: u8, labels: &[u8]) -> Result<(u8, Vec<u8>)> {
    let object = current_number(clip, object)?;
    Ok((object, labels.iter().map(|&label| if label == 1 { object } else { label }).collect()))
}

/// A label map with the current numbers of its objects.
fn current_labels(clip: &SegmentedClip, labels: &[u8]) -> Result<Vec<u8>> {
    let mut numbers: BTreeMap<u8, u8> = [0, UNLABELLED].map(|label| (label, label)).into();
    for &label in labels {
        if !numbers.contains_key(&label) {
            numbers.insert(label, current_number(clip, label)?);
        }
    }
    Ok(labels.iter().map(|label| numbers[label]).collect())
}

/// Labels over those before, where they are not open.
fn over(before: Option<Vec<u8>>, now: Vec<u8>) -> Vec<u8> {
    let Some(before) = before else { return now };
    before.into_iter().zip(now).map(|(before, now)| if now == UNLABELLED { before } else { now }).collect()
}

/// Removes what was drawn exactly under labels that are painted later, except of locked objects. The ground of one object is ground for
/// this object alone.
fn uncover_under(clip: &mut SegmentedClip, frame: usize, object: Option<u8>, labels: &[u8]) {
    let objects = clip.objects.clone();
    let before = clip.frames[frame].annotation.as_ref().and_then(|of| of.painted_of(object.unwrap_or(0)));
    let frame = &mut clip.frames[frame];
    let Some(exact) = frame.exact.take() else { return };
    let mut exact = exact.values();
    for (p, exact) in exact.iter_mut().enumerate().filter(|(p, _)| labels[*p] != UNLABELLED) {
        let is_new = before.as_ref().is_none_or(|before| before[p] != labels[p]);
        let under = objects.number(*exact);
        let is_others = labels[p] == 0 && object.is_some_and(|object| object != under);
        if is_new && !is_others && !objects.locked[usize::from(under)] {
            *exact = UNLABELLED;
        }
    }
    frame.exact = some_labels(&exact);
}

/// The phases that replace all that a person has said.
fn replace(clip: &mut SegmentedClip, all: Declaration) -> Result<VecDeque<Phase>> {
    let Declaration { annotations, locked, described, merged: groups, deleted: gone, accepted } = all;
    let objects = Objects::new(clip.objects.dropped);
    let before = std::mem::replace(&mut clip.objects, Arc::new(objects));
    let mut seen: BTreeMap<usize, Vec<u8>> = BTreeMap::new();
    for (index, frame) in clip.frames.iter_mut().enumerate() {
        let FrameState { layer, accepted: was_accepted, .. } = &*frame;
        if let Some(layer) = layer.as_ref().filter(|_| *was_accepted && accepted.contains(&index)) {
            seen.insert(index, layer.labels.map(|label| before.number(label)).values());
        }
        *frame = FrameState { found: frame.found.take(), ..FrameState::default() };
    }
    let (annotations, draws) = combined(clip, annotations)?;
    for (object, description) in described {
        let object = current_number(clip, object)?;
        describe(clip, object, description);
    }
    let mut numbers: Vec<[u8; 2]> = groups.iter().flat_map(|group| merged(group)).collect();
    numbers.extend(deleted(&gone));
    let accepted = accepted.into_iter().map(|frame| {
        let given = annotations.masks.iter().find(|mask| mask.frame == frame).map(|mask| mask.labels.clone());
        let labels = seen.remove(&frame).map(|seen| over(Some(seen), given.unwrap_or_default()));
        Accepted { frame, labels }
    });
    let accepted = accepted.collect();
    let annotations = Annotations { accepted: Some(accepted), locked: Some(locked), numbers, ..annotations };
    Ok(std::iter::once(Phase::Annotate(annotations)).chain(draws).collect())
}

/// The annotations that make a new object of all pieces of an object but the largest.
fn split(clip: &SegmentedClip, shown: &ClipFrame, object: u8) -> Result<Annotations> {
    let (frame, width) = (shown.index, clip.size[0]);
    let inside: Vec<u8> = shown.labels.iter().map(|&label| u8::from(label == object)).collect();
    let parts = components(&inside, width, Connectivity::Eight);
    let order = descending(parts.list.iter().map(|part| if part.label > 0 { part.size as f64 } else { 0.0 }));
    let largest = order.first().copied().unwrap_or(0);
    let is_other = |p: usize| inside[p] > 0 && parts.of[p] as usize != largest;
    if !(0..inside.len()).any(is_other) {
        return invalid("object", format!("object {object} is in one piece in frame {frame}"));
    }
    let Some(new) = clip.next_object() else {
        return invalid("object", "no number is left for another object".into());
    };
    let labels = |label: u8| (0..inside.len()).map(|p| if is_other(p) { label } else { UNLABELLED }).collect();
    let mut corrections = Vec::new();
    // An object that a person has not spoken of gives way by itself.
    if clip.protected()[usize::from(object)] || clip.frames.iter().any(|frame| frame.anchors(object)) {
        let own = clip.frames[frame].annotation.as_ref().and_then(|of| of.painted_of(object));
        corrections.push(Painted { frame, object: Some(object), labels: over(own, labels(0)), spread: Spread::Both });
    }
    corrections.push(Painted { frame, object: Some(new), labels: labels(new), spread: Spread::Both });
    Ok(Annotations { corrections, accepted: reopened(clip, &[frame]), ..Annotations::default() })
}

/// The phases that apply the annotations of some scenes again, frame by frame, then accept the frames that were accepted, as they were. Locks
/// and names are lifted meanwhile.
fn repeated(before: &SegmentedClip, clip: &mut SegmentedClip, [first, last]: [usize; 2]) -> Vec<Phase> {
    let (mut corrections, mut prompts, mut accepted) = (Vec::new(), Vec::new(), Vec::new());
    let is_resized = before.size != clip.size && before.size != [0, 0];
    let resize = |labels: Vec<u8>| if is_resized { resized(&labels, before.size, clip.size) } else { labels };
    for (index, frame) in before.frames.iter().enumerate().take(last + 1).skip(first) {
        let FrameState { annotation, layer, accepted: is_accepted, .. } = frame;
        let (painted, pointed) = annotation.as_ref().map(|annotation| annotation.given(index)).unwrap_or_default();
        corrections.extend(painted.into_iter().map(|of| Painted { labels: resize(of.labels), ..of }));
        prompts.extend(pointed.into_iter().map(|of| match is_resized {
            true => resized_prompt(of, before.size, clip.size),
            false => of,
        }));
        if let Some(layer) = layer.as_ref().filter(|_| *is_accepted) {
            accepted.push(Accepted { frame: index, labels: Some(resize(layer.labels.values())) });
        }
    }
    if is_resized {
        for frame in &mut clip.frames {
            frame.exact = frame.exact.take().map(|exact| Arc::new(Runs::of(&resize(exact.values()))));
        }
    }
    for frame in &mut clip.frames[first..=last] {
        (frame.annotation, frame.layer, frame.accepted) = (None, None, false);
    }
    if corrections.is_empty() && prompts.is_empty() && accepted.is_empty() {
        return Vec::new();
    }
    let Objects { locked, named, .. } = *clip.objects;
    let objects = clip.objects_mut();
    (objects.locked, objects.named) = ([false; 256], [false; 256]);
    // Frames outside stay accepted.
    let others = (0..clip.len()).filter(|&index| clip.frames[index].accepted).collect();
    let accepted = [accepted_as_shown(others), accepted].concat();
    vec![
        Phase::Annotate(Annotations { corrections, prompts, ..Annotations::default() }),
        Phase::Annotate(Annotations { accepted: Some(accepted), ..Annotations::default() }),
        Phase::Restore { locked, named },
    ]
}

/// A prompt for frames of another size.
fn resized_prompt(prompt: Prompt, before: [usize; 2], now: [usize; 2]) -> Prompt {
    let within = prompt.within.map(|[x, y, width, height]| {
        let span = |at: usize, length: usize, k: usize| {
            let (start, end) = (at * now[k] / before[k], ((at + length) * now[k]).div_ceil(before[k]).min(now[k]));
            (start, end.saturating_sub(start).max(1))
        };
        let ((x, width), (y, height)) = (span(x, width, 0), span(y, height, 1));
        [x, y, width, height]
    });
    let at = |[x, y]: [usize; 2]| {
        let scaled = |at: usize, k: usize| ((2 * at + 1) * now[k] / (2 * before[k])).min(now[k] - 1);
        [scaled(x, 0), scaled(y, 1)]
    };
    let clicks = prompt.clicks.iter().map(|Click { at: place, inside }| Click { at: at(*place), inside: *inside });
    Prompt { clicks: clicks.collect(), within, ..prompt }
}
