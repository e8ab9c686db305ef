//! What a person does with a clip, in any order: corrections, outlines, renumbering, reserved numbers, locks.
#![no_main]

use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::fuzz_target;
use veronese::clip::{Prompt, SegmentedClip, Spread};
use veronese_fuzz::{check_clip, known};

#[derive(Arbitrary, Debug)]
enum Action<'a> {
    Correct {
        frame: u8,
        spread: u8,
        labels: Labels<'a>,
        cancel_after: Option<u8>,
    },
    /// Takes what an outline says as a correction.
    Outline {
        frame: u8,
        prompt: [u8; 4],
        boxed: bool,
        number: u8,
    },
    Renumber {
        object: u8,
        number: u8,
    },
    Reserve(&'a [u8]),
    Lock(&'a [u8]),
    Unknown(bool),
    Save,
}

#[derive(Arbitrary, Debug)]
enum Labels<'a> {
    /// As they are; rarely as many as there are pixels.
    Raw(&'a [u8]),
    /// Rectangles on a frame of which nothing is said.
    Boxes(Vec<([u8; 4], u8)>),
}

const SIZE: [usize; 2] = [32, 24];
/// More take long, and show no more.
const MOST: usize = 5;

impl Labels<'_> {
    fn pixels(&self) -> Vec<u8> {
        let boxes = match self {
            Labels::Raw(bytes) => return bytes.to_vec(),
            Labels::Boxes(boxes) => boxes,
        };
        let mut labels = vec![255; SIZE[0] * SIZE[1]];
        for ([x, y, wide, high], label) in boxes {
            let (left, top) = (usize::from(*x) % SIZE[0], usize::from(*y) % SIZE[1]);
            for row in top..SIZE[1].min(top + usize::from(*high) % 32) {
                labels[row * SIZE[0]..][left..SIZE[0].min(left + usize::from(*wide) % 32)].fill(*label);
            }
        }
        labels
    }
}

fn correct(clip: &mut SegmentedClip, index: usize, labels: &[u8], spread: Spread, cancel_after: Option<u8>) {
    let frames = &known().frames;
    let Ok(mut correction) = clip.correct(index, labels, spread) else { return };
    let mut taken = 0;
    while let Some(wanted) = correction.wanted() {
        if cancel_after == Some(taken) {
            correction.cancel(clip);
            return;
        }
        correction.take(clip, &frames[wanted]).expect("it is the frame that is wanted");
        taken += 1;
    }
    assert!(correction.changed().iter().all(|&index| index < frames.len()));
}

fuzz_target!(|actions: Vec<Action<'_>>| {
    let known = known();
    let mut clip = SegmentedClip::from_bytes(&known.state).expect("the state is its own");
    for action in actions.iter().take(MOST) {
        match action {
            Action::Correct { frame, spread, labels, cancel_after } => {
                let spread = [Spread::Both, Spread::Forward, Spread::Backward, Spread::None][usize::from(spread % 4)];
                correct(&mut clip, usize::from(frame % 4), &labels.pixels(), spread, *cancel_after);
            }
            Action::Outline { frame, prompt, boxed, number } => {
                let [x, y, wide, high] = prompt.map(|p| usize::from(p % 36));
                let prompt = if *boxed { Prompt::Box([x, y, wide, high]) } else { Prompt::Click([x, y]) };
                let index = usize::from(frame % 3);
                if let Ok(labels) = clip.outline(index, &known.frames[index], prompt, *number) {
                    correct(&mut clip, index, &labels, Spread::Both, None);
                }
            }
            Action::Renumber { object, number } => drop(clip.renumber(*object, *number)),
            Action::Reserve(numbers) => drop(clip.reserve(numbers)),
            Action::Lock(numbers) => clip.lock(numbers),
            Action::Unknown(mark) => clip.mark_unknown(*mark),
            Action::Save => {
                clip = SegmentedClip::from_bytes(&clip.to_bytes()).expect("a clip reads what it has written");
            }
        }
    }
    for (index, frame) in known.frames.iter().enumerate() {
        clip.frame(index, frame).expect("it is a frame of the clip");
    }
    check_clip(&clip, &known.frames);
});
