//! The annotations of scenes of which frames were segmented again.

use std::sync::Arc;

use super::phase::{Lifted, Phase};
use super::ranges::resized;
use crate::clip::annotation::{Accepted, Annotations, Click, Painted, Prompt};
use crate::clip::frame_state::FrameState;
use crate::clip::objects::Objects;
use crate::clip::runs::Runs;
use crate::clip::segmented_clip::SegmentedClip;

/// The phases that apply the annotations of some scenes again, frame by frame, then accept the frames that were accepted, as they were. Locks,
/// names and merges are lifted meanwhile: they protect from what is said later.
pub(super) fn repeated(before: &SegmentedClip, clip: &mut SegmentedClip, [first, last]: [usize; 2]) -> Vec<Phase> {
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
    let Objects { locked, named, numbers, .. } = *clip.objects;
    let objects = clip.objects_mut();
    (objects.locked, objects.named) = ([false; 256], [false; 256]);
    for (k, number) in objects.numbers.iter_mut().enumerate().filter(|(_, number)| **number > 0) {
        *number = k as u8;
    }
    // Frames outside stay accepted.
    let others = (0..clip.len()).filter(|&index| clip.frames[index].accepted).collect();
    let accepted = [Accepted::as_shown(others), accepted].concat();
    vec![
        Phase::Annotate(Annotations { corrections, prompts, ..Annotations::default() }),
        Phase::Annotate(Annotations { accepted: Some(accepted), ..Annotations::default() }),
        Phase::Restore(Box::new(Lifted { locked, named, numbers })),
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
