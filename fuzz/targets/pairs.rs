//! The bytes of pairs that somebody has changed: they are refused, or the clip goes on with them.
//! The sum over the bytes is not checked in this build (see src/clip/saved.rs), or no change would come further.
#![no_main]

use libfuzzer_sys::fuzz_target;
use veronese::clip::{ClipSegmenter, FramePairs};
use veronese_fuzz::{Edit, check_clip, edited, known, known_options};

fuzz_target!(|edits: [Vec<Edit>; 3]| {
    let known = known();
    let mut segmenter = ClipSegmenter::new(known_options()).expect("the options are valid");
    for ((frame, pairs), edits) in known.frames.iter().zip(&known.pairs).zip(&edits) {
        let read = FramePairs::from_bytes(&edited(&pairs.to_bytes(), edits));
        if let Ok(pairs) = &read {
            assert_eq!(FramePairs::from_bytes(&pairs.to_bytes()).map(|again| again.to_bytes()), Ok(pairs.to_bytes()));
        }
        let took = read.is_ok_and(|pairs| segmenter.push_known(frame.clone(), &pairs).is_ok());
        if !took && segmenter.push_known(frame.clone(), pairs).is_err() {
            segmenter.push(frame.clone()).expect("the frame can be pushed after an error");
        }
        drop(segmenter.preview());
    }
    check_clip(&segmenter.conclude(), &known.frames);
});
