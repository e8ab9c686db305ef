//! The bytes of a clip that somebody has changed: they are refused, or there is a clip that gives frames and takes corrections.
//! The sum over the bytes is not checked in this build (see src/clip/saved.rs), or no change would come further.
#![no_main]

use libfuzzer_sys::fuzz_target;
use veronese::clip::{Prompt, SegmentedClip, Spread};
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
    drop(clip.outline(index, &known.frames[index], Prompt::Click([12, 12]), 1));
    let mut labels = vec![255; width * height];
    labels.iter_mut().take(width * height / 3).for_each(|label| *label = 7);
    if let Ok(mut correction) = clip.correct(1, &labels, Spread::Both) {
        while let Some(frame) = correction.wanted().and_then(|wanted| known.frames.get(wanted)) {
            if correction.take(&mut clip, frame).is_err() {
                break;
            }
        }
    }
    drop(clip.renumber(7, 1));
    clip.reserve(&[1, 7]);
    check_clip(&clip, &known.frames);
});
