//! Annotations of a clip, in any order and together, and interrupted ones, after which nothing may have changed.
#![no_main]

use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::fuzz_target;
use veronese::clip::{Accepted, Annotations, Click, Painted, Prompt, SegmentedClip, Spread};
use veronese::{Error, Frame};
use veronese_fuzz::{check_clip, known};

#[derive(Arbitrary, Debug)]
enum Action<'a> {
    Say { words: Vec<Word<'a>>, cancel_after: Option<u8> },
    Unknown(bool),
    Save,
}

/// One annotation.
#[derive(Arbitrary, Debug)]
enum Word<'a> {
    Mask(Paint<'a>),
    Correct(Paint<'a>),
    Point { frame: u8, object: u8, clicks: Vec<([u8; 2], bool)>, within: Option<[u8; 4]>, spread: u8 },
    Lock(&'a [u8]),
    Name(&'a [u8]),
    Accept { frames: Vec<u8>, labels: Option<Labels<'a>> },
    Renumber([u8; 2]),
}

#[derive(Arbitrary, Debug)]
struct Paint<'a> {
    frame: u8,
    object: Option<u8>,
    labels: Labels<'a>,
    spread: u8,
}

#[derive(Arbitrary, Debug)]
enum Labels<'a> {
    /// As they are; rarely as many as there are pixels.
    Raw(&'a [u8]),
    /// Rectangles on a frame without labels.
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

impl Paint<'_> {
    fn painted(&self) -> Painted {
        let mut labels = self.labels.pixels();
        if let Some(object) = self.object.filter(|object| object % 8 > 0) {
            // Nearly always as it has to be.
            labels.iter_mut().filter(|label| ![0, 255].contains(*label)).for_each(|label| *label = object);
        }
        Painted { frame: usize::from(self.frame % 4), object: self.object, labels, spread: spread(self.spread) }
    }
}

fn spread(chosen: u8) -> Spread {
    [Spread::Both, Spread::Forward, Spread::Backward, Spread::None][usize::from(chosen % 4)]
}

fn annotations(words: &[Word<'_>]) -> Annotations {
    let mut all = Annotations::default();
    for word in words.iter().take(MOST) {
        match word {
            Word::Mask(paint) => all.masks.push(paint.painted()),
            Word::Correct(paint) => all.corrections.push(paint.painted()),
            Word::Point { frame, object, clicks, within, spread: chosen } => all.prompts.push(Prompt {
                frame: usize::from(frame % 4),
                object: *object,
                clicks: clicks
                    .iter()
                    .take(MOST)
                    .map(|(at, inside)| Click { at: at.map(|place| usize::from(place % 36)), inside: *inside })
                    .collect(),
                within: within.map(|sides| sides.map(|side| usize::from(side % 36))),
                spread: spread(*chosen),
            }),
            Word::Lock(objects) => all.locked = Some(objects.to_vec()),
            Word::Name(objects) => all.named = Some(objects.to_vec()),
            Word::Accept { frames, labels } => {
                let labels = labels.as_ref().map(Labels::pixels);
                let frames = frames.iter().take(MOST);
                let accepted = frames.map(|frame| Accepted { frame: usize::from(frame % 4), labels: labels.clone() });
                all.accepted = Some(accepted.collect());
            }
            Word::Renumber(numbers) => all.numbers.push(*numbers),
        }
    }
    all
}

/// Says something, or takes it back after some frames.
fn say(clip: &mut SegmentedClip, frames: &[Frame], words: &[Word<'_>], cancel_after: Option<u8>) {
    let before = clip.clone();
    let mut job = match clip.annotate(annotations(words)) {
        Ok(job) => job,
        Err(error) => {
            assert!(matches!(error, Error::InvalidOption { .. } | Error::ObjectLocked { .. }), "{error}");
            assert_eq!(clip.to_bytes(), before.to_bytes(), "what is refused changes nothing");
            return;
        }
    };
    let mut taken = 0;
    while let Some(wanted) = job.wanted() {
        if cancel_after == Some(taken) {
            *clip = before;
            return;
        }
        job.take(clip, &frames[wanted]).expect("it is the frame that is wanted");
        taken = taken.saturating_add(1);
    }
    let changed = job.changed();
    assert!(changed.iter().all(|&index| index < frames.len()));
    assert!(job.changes().iter().all(|change| changed.contains(&change.frame) && change.gained + change.lost > 0));
}

fuzz_target!(|actions: Vec<Action<'_>>| {
    let known = known();
    let mut clip = SegmentedClip::from_bytes(&known.state).expect("the state is its own");
    for action in actions.iter().take(MOST) {
        match action {
            Action::Say { words, cancel_after } => say(&mut clip, &known.frames, words, *cancel_after),
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
