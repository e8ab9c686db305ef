//! The bytes of a clip that somebody has changed: they are refused, or there is a clip that gives frames and takes annotations.
//! The sum over the bytes is not checked in this build (see src/clip/saved.rs), or no change would come further.
#![no_main]

use libfuzzer_sys::fuzz_target;
use veronese::clip::{Accepted, Annotations, Click, Painted, Prompt, SegmentedClip, Spread};
use veronese_fuzz::{Edit, check_clip, edited, known};

fuzz_target!(|edits: Vec<Edit>| {
    let known = known();
    let Ok(mut clip) = SegmentedClip::from_bytes(&edited(&known.state, &edits)) else { return };
    let [width, height] = clip.size();
    if width * height > 48 * 48 {
        return;
    }
    // One of three frames: all take long.
    let index = edits.len() % known.frames.len();
    drop(clip.frame(index, &known.frames[index]));
    let mut labels = vec![255; width * height];
    labels.iter_mut().take(width * height / 3).for_each(|label| *label = 7);
    let clicks = vec![Click { at: [12, 12], inside: true }];
    let annotations = Annotations {
        masks: vec![Painted { frame: 0, object: None, labels: labels.clone(), spread: Spread::Forward }],
        corrections: vec![Painted { frame: 1, object: Some(7), labels, spread: Spread::Both }],
        prompts: vec![Prompt { frame: index, object: 1, clicks, within: None, spread: Spread::Both }],
        accepted: (edits.len() % 2 == 0).then(|| vec![Accepted { frame: 2, labels: None }]),
        numbers: vec![[7, 1]],
        ..Annotations::default()
    };
    if let Ok(mut job) = clip.annotate(annotations) {
        while let Some(frame) = job.wanted().and_then(|wanted| known.frames.get(wanted)) {
            if job.take(&mut clip, frame).is_err() {
                break;
            }
        }
        assert!(job.changed().iter().all(|&index| index < clip.len()));
    }
    check_clip(&clip, &known.frames);
});
