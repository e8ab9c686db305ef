//! The phases of each command, and what needs no frame, at once.

use std::collections::VecDeque;
use std::sync::Arc;

use super::combined::{Combined, over, uncover, uncover_under};
use super::phase::{Phase, invalid};
use crate::answer::UNLABELLED;
use crate::clip::annotation::{Accepted, Annotations, Painted, Spread, is_object};
use crate::clip::command::{Annotation, Command, Declaration};
use crate::clip::description::ClipFrame;
use crate::clip::frame_state::FrameState;
use crate::clip::objects::{Description, Objects};
use crate::clip::segmented_clip::SegmentedClip;
use crate::components::{Connectivity, components};
use crate::error::{Error, Result};
use crate::order::descending;

/// The phases of a command. What needs no frame takes effect at once.
pub(super) fn phases(clip: &mut SegmentedClip, command: Command) -> Result<VecDeque<Phase>> {
    let annotations = match command {
        Command::Segment { .. } => return Ok(VecDeque::new()),
        Command::Annotate(annotations) => return annotate(clip, annotations),
        Command::ReplaceAnnotations(all) => return replace(clip, all),
        Command::Clear { frame, object } => {
            let object = object.map(|object| clip.objects.current(object)).transpose()?;
            if let Some(object) = locked_above(clip, frame, object) {
                return Err(Error::ObjectLocked { object });
            }
            uncover(clip, frame, object);
            // What was merged into the object is part of it.
            let is_it = |k: &u8| object == Some(clip.objects.number(*k));
            let merged = (1..UNLABELLED).filter(is_it).map(|k| (frame, Some(k)));
            let cleared = if object.is_none() { vec![(frame, None)] } else { merged.collect() };
            Annotations { cleared, accepted: reopened(clip, &[frame]), ..Annotations::default() }
        }
        Command::Accept { frames, on } => {
            let stays = |index: &usize| clip.frames[*index].accepted && (on || !frames.contains(index));
            let mut accepted: Vec<usize> = (0..clip.len()).filter(stays).collect();
            let is_new = |index: &usize| on && !clip.frames[*index].accepted && frames.contains(index);
            accepted.extend((0..clip.len()).filter(is_new));
            Annotations { accepted: Some(Accepted::as_shown(accepted)), ..Annotations::default() }
        }
        Command::Lock { objects, on } => {
            let objects = known_objects(clip, &objects)?;
            let is_locked = |object: u8| clip.objects.locked[usize::from(object)];
            let stays = |&k: &u8| if objects.contains(&clip.objects.number(k)) { on } else { is_locked(k) };
            Annotations { locked: Some((1..UNLABELLED).filter(stays).collect()), ..Annotations::default() }
        }
        Command::Describe { object, description, .. } => {
            let object = known_object(clip, object)?;
            describe(clip, object, description);
            return Ok(VecDeque::new());
        }
        Command::Merge(objects) => {
            let objects = known_objects(clip, &objects)?;
            match objects[..] {
                [into, _, ..] if !clip.frames_with(into).is_empty() => {}
                [into, _, ..] => {
                    return invalid("objects", format!("object {into} has no pixel: nothing is merged into it"));
                }
                _ => return invalid("objects", "there is nothing to merge".into()),
            }
            Annotations { numbers: merged(&objects), ..Annotations::default() }
        }
        Command::Delete(objects) => {
            let objects = known_objects(clip, &objects)?;
            Annotations { numbers: deleted(&objects), ..Annotations::default() }
        }
        Command::Split { object, frame, new } => {
            let object = known_object(clip, object)?;
            if clip.objects.locked[usize::from(object)] {
                return Err(Error::ObjectLocked { object });
            }
            if !is_object(new) || clip.objects.used[usize::from(new)] {
                return invalid("new", format!("{new} is no number of a new object"));
            }
            return Ok(VecDeque::from([Phase::Split { object, frame, new }]));
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

/// The current numbers of objects, each once. All have to be there.
fn known_objects(clip: &SegmentedClip, objects: &[u8]) -> Result<Vec<u8>> {
    let mut known = Vec::new();
    for &object in objects {
        let number = known_object(clip, object)?;
        if !known.contains(&number) {
            known.push(number);
        }
    }
    Ok(known)
}

fn known_object(clip: &SegmentedClip, object: u8) -> Result<u8> {
    match clip.objects.current(object)? {
        number if clip.objects.used[usize::from(number)] => Ok(number),
        _ => invalid("object", format!("there is no object {object}")),
    }
}

fn describe(clip: &mut SegmentedClip, object: u8, description: Description) {
    let objects = clip.objects_mut();
    let is_named = !description.name.is_empty();
    objects.describe(object, description);
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
    Some(Accepted::as_shown((0..clip.len()).filter(stays).collect()))
}

/// A locked object that was drawn exactly in a frame, among all or only the given one.
fn locked_above(clip: &SegmentedClip, frame: usize, object: Option<u8>) -> Option<u8> {
    let labels = clip.frames[frame].exact.as_ref()?.values();
    let is_locked = |label: u8| clip.objects.locked[usize::from(label)];
    let mut numbers = labels.into_iter().filter(|&label| is_locked(label)).map(|label| clip.objects.number(label));
    numbers.find(|number| object.is_none_or(|object| object == *number))
}

/// The phases of annotations.
fn annotate(clip: &mut SegmentedClip, all: Vec<Annotation>) -> Result<VecDeque<Phase>> {
    let frames: Vec<usize> = all.iter().map(|annotation| annotation.frame).collect();
    let Combined { masks, painted, prompts, draws, covers, .. } = Combined::new(clip, all)?;
    for (frame, object, labels) in covers {
        uncover_under(clip, frame, object, &labels);
    }
    let accepted = reopened(clip, &frames);
    let annotations = Annotations { masks, corrections: painted, prompts, accepted, ..Annotations::default() };
    Ok(std::iter::once(Phase::Annotate(annotations)).chain(draws).collect())
}

/// The phases that replace all annotations, descriptions, merges and acceptances.
fn replace(clip: &mut SegmentedClip, all: Declaration) -> Result<VecDeque<Phase>> {
    let Declaration { annotations, locked, described, merged: groups, deleted: gone, accepted } = all;
    let objects = Objects::new(clip.objects.dropped);
    let before = std::mem::replace(&mut clip.objects, Arc::new(objects));
    let mut seen: Vec<Option<Vec<u8>>> = vec![None; clip.len()];
    for (index, frame) in clip.frames.iter_mut().enumerate() {
        let FrameState { layer, exact, accepted: was_accepted, .. } = &*frame;
        if let Some(layer) = layer.as_ref().filter(|_| *was_accepted && accepted.contains(&index)) {
            let labels = layer.labels.values();
            let labels = match exact {
                Some(exact) => over(Some(labels), exact.values()),
                None => labels,
            };
            seen[index] = Some(labels.into_iter().map(|label| before.number(label)).collect());
        }
        *frame = FrameState { found: frame.found.take(), ..FrameState::default() };
    }
    let Combined { masks, painted, prompts, draws, .. } = Combined::new(clip, annotations)?;
    let grouped = groups.concat();
    for &object in grouped.iter().chain(&gone).chain(&locked) {
        clip.objects.current(object)?;
    }
    for (object, _) in &described {
        clip.objects.current(*object)?;
    }
    if let Some(object) = grouped.iter().find(|object| gone.contains(object)) {
        return invalid("deleted", format!("object {object} cannot be merged and deleted"));
    }
    for (object, description) in described {
        let is_named = !description.name.is_empty();
        describe(clip, object, description);
        // What this command merges into the object is named with it.
        for &part in groups.iter().filter(|group| group.first() == Some(&object)).flatten() {
            clip.objects_mut().named[usize::from(part)] |= is_named;
        }
    }
    let mut numbers = Vec::new();
    groups.iter().for_each(|group| numbers.append(&mut merged(group)));
    numbers.append(&mut deleted(&gone));
    let accepted = accepted.into_iter().map(|frame| {
        let mask = masks.iter().find(|mask| mask.frame == frame);
        let labels = match (seen[frame].take(), mask) {
            (Some(seen), Some(mask)) => Some(under_mask(seen, &mask.labels)),
            (seen, _) => seen,
        };
        Accepted { frame, labels }
    });
    let accepted = Some(accepted.collect());
    let annotations = Annotations {
        masks,
        corrections: painted,
        prompts,
        accepted,
        locked: Some(locked.clone()),
        numbers,
        ..Annotations::default()
    };
    // Exact drawing may be that of objects that were locked later.
    let mut phases = VecDeque::from([Phase::Annotate(annotations), Phase::Lock(Vec::new())]);
    phases.extend(draws);
    phases.push_back(Phase::Lock(locked));
    Ok(phases)
}

/// Accepted labels under a given mask, which is about the objects that it names: its zeros take away no others.
fn under_mask(seen: Vec<u8>, mask: &[u8]) -> Vec<u8> {
    let mut is_named = [false; 256];
    mask.iter().for_each(|&label| is_named[usize::from(label)] = true);
    let is_about = |seen: u8, label: u8| label != UNLABELLED && (label > 0 || is_named[usize::from(seen)]);
    seen.into_iter().zip(mask).map(|(seen, &label)| if is_about(seen, label) { label } else { seen }).collect()
}

/// The annotations that make a new object of all pieces of an object but the largest.
pub(super) fn split(clip: &mut SegmentedClip, shown: &ClipFrame, object: u8, new: u8) -> Result<Annotations> {
    let (frame, width) = (shown.index, clip.size[0]);
    let inside: Vec<u8> = shown.labels.iter().map(|&label| u8::from(label == object)).collect();
    let parts = components(&inside, width, Connectivity::Eight);
    let order = descending(parts.list.iter().map(|part| if part.label > 0 { part.size as f64 } else { 0.0 }));
    let largest = order.first().copied().unwrap_or(0);
    let is_other = |p: usize| inside[p] > 0 && parts.of[p] as usize != largest;
    if !(0..inside.len()).any(is_other) {
        let pieces = if inside.contains(&1) { "in one piece" } else { "not" };
        return invalid("object", format!("object {object} is {pieces} in frame {frame}"));
    }
    let labels = |label: u8, elsewhere: u8| {
        (0..inside.len()).map(|p| if is_other(p) { label } else { elsewhere }).collect::<Vec<u8>>()
    };
    uncover_under(clip, frame, None, &labels(new, UNLABELLED));
    let mut corrections = Vec::new();
    // An object that a person has neither annotated nor named gives way by itself.
    let protected = clip.protected();
    let is_it = |&k: &u8| clip.objects.number(k) == object;
    let gives_way = |k: u8| !protected[usize::from(k)] && !clip.frames.iter().any(|frame| frame.anchors(k));
    for part in (1..UNLABELLED).filter(is_it).filter(|&k| !gives_way(k)) {
        let own = clip.frames[frame].annotation.as_ref().and_then(|of| of.painted_of(part));
        corrections.push(Painted {
            frame,
            object: Some(part),
            labels: over(own, labels(0, UNLABELLED)),
            spread: Spread::Both,
        });
    }
    corrections.push(Painted { frame, object: Some(new), labels: labels(new, 0), spread: Spread::Both });
    Ok(Annotations { corrections, accepted: reopened(clip, &[frame]), ..Annotations::default() })
}
