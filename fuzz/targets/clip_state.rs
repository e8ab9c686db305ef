//! The journal of a clip that somebody has changed: it is refused, or read to the damage, and there is a clip that gives labels, takes
//! commands and goes back. The sums over records are not checked in this build (see src/clip/session/log.rs), or no change would come
//! further.
#![no_main]

use libfuzzer_sys::fuzz_target;
use veronese::clip::{Annotation, Click, Clip, Command, Content, OpenOptions, Spread};
use veronese_fuzz::{Edit, check_opened, edited, known, known_options, run};

fuzz_target!(|edits: Vec<Edit>| {
    let known = known();
    let bytes = edited(&known.journal, &edits);
    let Ok(read) = Clip::read(&bytes, OpenOptions::default()) else { return };
    assert!(read.used <= bytes.len());
    let mut clip = read.clip;
    let [width, height] = clip.size();
    // More take long, and show no more.
    if clip.len() > 16 || width * height > 48 * 48 {
        return;
    }
    run(&mut clip, &known.frames);
    let index = edits.len() % known.frames.len();
    let [width, height] = clip.size();
    let labels: Vec<u8> = (0..width * height).map(|p| if 3 * p < width * height { 1 } else { 255 }).collect();
    let clicks = vec![Click { at: [12, 12], inside: true }];
    let one = |content| Annotation::new(index, content);
    let commands = [
        Command::Annotate(vec![one(Content::Strokes { object: 7, labels: labels.clone() })]),
        Command::Annotate(vec![Annotation {
            spread: Spread::Exact,
            ..one(Content::Mask { object: 1, labels: labels.clone() })
        }]),
        Command::Annotate(vec![one(Content::Given(labels)), one(Content::Prompt { object: 1, clicks, within: None })]),
        Command::Accept { frames: vec![2], on: true },
        Command::Merge(vec![7, 1]),
        Command::Segment { frames: 0..known.frames.len(), options: known_options().pair },
    ];
    // One after another, or all at once.
    for command in commands {
        drop(clip.apply(command));
        if edits.len() % 2 == 0 {
            run(&mut clip, &known.frames);
        }
    }
    clip.undo();
    check_opened(&mut clip, &known.frames);
});
