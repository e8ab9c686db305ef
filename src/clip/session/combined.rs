//! Annotations that are given together, over those that were given before.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use super::phase::{Phase, invalid, some_labels};
use crate::answer::UNLABELLED;
use crate::clip::annotation::{Annotations, Painted, Prompt, Spread, is_object};
use crate::clip::command::{Annotation, Content};
use crate::clip::segmented_clip::SegmentedClip;
use crate::error::{Error, Result};

/// Annotations with the current numbers of objects. Strokes and label maps lie over those before; what is drawn exactly comes last.
pub(super) fn combined(clip: &SegmentedClip, all: Vec<Annotation>) -> Result<(Annotations, Vec<Phase>)> {
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
        if spread == Spread::Exact && matches!(content, Content::Given(_) | Content::Prompt { .. }) {
            return invalid("propagate", "clicks, boxes and given masks cannot be drawn exactly: draw a mask".into());
        }
        match content {
            Content::Strokes { object, labels } | Content::Mask { object, labels }
                if labels.iter().any(|l| ![0, 1, 255].contains(l)) =>
            {
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
                current_labels(clip, &labels)?;
                annotations.masks.retain(|of| of.frame != frame);
                annotations.masks.push(Painted { frame, object: None, labels, spread });
            }
            Content::Prompt { object, clicks, within } => {
                let object = clip.objects.current(object)?;
                annotations.prompts.retain(|of: &Prompt| (of.frame, of.object) != (frame, object));
                annotations.prompts.push(Prompt { frame, object, clicks, within, spread });
            }
        }
    }
    annotations.corrections = painted;
    // Labels that are drawn exactly are no annotations that could be checked later.
    let is_locked = |object: &u8| clip.objects.locked[usize::from(*object)];
    let locked = draws.iter().find_map(|draw| match draw {
        Phase::Draw { object: Some(object), .. } => Some(*object).filter(is_locked),
        Phase::Draw { labels, .. } => labels.iter().copied().find(is_locked),
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
    let object = clip.objects.current(object)?;
    Ok((object, labels.iter().map(|&label| if label == 1 { object } else { label }).collect()))
}

/// A label map with the current numbers of its objects.
fn current_labels(clip: &SegmentedClip, labels: &[u8]) -> Result<Vec<u8>> {
    let mut numbers: BTreeMap<u8, u8> = [0, UNLABELLED].map(|label| (label, label)).into();
    for &label in labels {
        if let Entry::Vacant(number) = numbers.entry(label) {
            number.insert(clip.objects.current(label)?);
        }
    }
    Ok(labels.iter().map(|label| numbers[label]).collect())
}

/// Labels over those before, where they are not open.
pub(super) fn over(before: Option<Vec<u8>>, now: Vec<u8>) -> Vec<u8> {
    let Some(before) = before else { return now };
    before.into_iter().zip(now).map(|(before, now)| if now == UNLABELLED { before } else { now }).collect()
}

/// Removes what was drawn exactly under labels that are painted later, except of locked objects. The ground of one object is ground for
/// this object alone.
pub(super) fn uncover_under(clip: &mut SegmentedClip, frame: usize, object: Option<u8>, labels: &[u8]) {
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

/// Removes what was drawn exactly in a frame, of one object or of all.
pub(super) fn uncover(clip: &mut SegmentedClip, frame: usize, object: Option<u8>) {
    let numbers = clip.objects.numbers;
    let goes = |label: u8| object.is_none_or(|object| numbers[usize::from(label)] == object);
    let frame = &mut clip.frames[frame];
    frame.exact = frame.exact.take().and_then(|exact| {
        let labels: Vec<u8> = exact.values().into_iter().map(|l| if goes(l) { UNLABELLED } else { l }).collect();
        some_labels(&labels)
    });
}
