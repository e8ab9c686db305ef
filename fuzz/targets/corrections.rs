//! Commands to a clip, in any order: what fails or is cancelled changes nothing, and what was saved at any time goes on.
#![no_main]

use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::fuzz_target;
use veronese::clip::{Annotation, Click, Clip, Command, Content, Declaration, Description, OpenOptions, Spread};
use veronese::{Error, Frame};
use veronese_fuzz::{Choices, check_opened, known, run};

#[derive(Arbitrary, Debug)]
enum Action<'a> {
    Give { word: Word<'a>, cancel_after: Option<u8> },
    Take(u8),
    Undo,
    Redo,
    Finish,
    Look(u8),
    Save,
}

/// One command.
#[derive(Arbitrary, Debug)]
enum Word<'a> {
    Segment { frames: [u8; 2], choices: Choices },
    Annotate(Vec<Part<'a>>),
    Clear { frame: u8, object: Option<u8> },
    Accept { frames: Vec<u8>, on: bool },
    Lock { objects: &'a [u8], on: bool },
    Describe { object: u8, name: &'a str, coalesce: bool },
    Merge(&'a [u8]),
    Delete(&'a [u8]),
    Split { object: u8, frame: u8, new: u8 },
    Replace { annotations: Vec<Part<'a>>, locked: &'a [u8], merged: &'a [u8], deleted: &'a [u8], accepted: Vec<u8> },
}

/// One annotation.
#[derive(Arbitrary, Debug)]
struct Part<'a> {
    frame: u8,
    object: u8,
    spread: u8,
    kind: Kind<'a>,
}

#[derive(Arbitrary, Debug)]
enum Kind<'a> {
    Strokes(Labels<'a>),
    Mask(Labels<'a>),
    Map(Labels<'a>),
    Given(Labels<'a>),
    Prompt { clicks: Vec<([u8; 2], bool)>, within: Option<[u8; 4]> },
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

    /// Of one object; nearly always as they have to be.
    fn of_one(&self, object: u8) -> Vec<u8> {
        let mut labels = self.pixels();
        if object % 8 > 0 {
            labels.iter_mut().filter(|label| ![0, 255].contains(*label)).for_each(|label| *label = 1);
        }
        labels
    }
}

/// A frame; one of four is not there.
fn frame(chosen: u8) -> usize {
    usize::from(chosen % 4)
}

fn frames(chosen: &[u8]) -> Vec<usize> {
    chosen.iter().take(MOST).map(|chosen| frame(*chosen)).collect()
}

fn objects(chosen: &[u8]) -> Vec<u8> {
    chosen.iter().copied().take(MOST).collect()
}

fn annotations(parts: &[Part<'_>]) -> Vec<Annotation> {
    let annotation = |Part { frame: chosen, object, spread, kind }: &Part<'_>| {
        let object = *object;
        let content = match kind {
            Kind::Strokes(labels) => Content::Strokes { object, labels: labels.of_one(object) },
            Kind::Mask(labels) => Content::Mask { object, labels: labels.of_one(object) },
            Kind::Map(labels) => Content::Labels(labels.pixels()),
            Kind::Given(labels) => Content::Given(labels.pixels()),
            Kind::Prompt { clicks, within } => {
                let click = |(at, inside): &([u8; 2], bool)| Click {
                    at: at.map(|place| usize::from(place % 36)),
                    inside: *inside,
                };
                let within = within.map(|sides| sides.map(|side| usize::from(side % 36)));
                Content::Prompt { object, clicks: clicks.iter().take(MOST).map(click).collect(), within }
            }
        };
        let all = [Spread::Both, Spread::Forward, Spread::Backward, Spread::None, Spread::Exact];
        Annotation { frame: frame(*chosen), content, spread: all[usize::from(spread % 5)] }
    };
    parts.iter().take(MOST).map(annotation).collect()
}

fn command(word: &Word<'_>) -> Command {
    match word {
        Word::Segment { frames: [start, end], choices } => {
            Command::Segment { frames: frame(*start)..frame(*end), options: choices.pair() }
        }
        Word::Annotate(parts) => Command::Annotate(annotations(parts)),
        Word::Clear { frame: chosen, object } => Command::Clear { frame: frame(*chosen), object: *object },
        Word::Accept { frames: chosen, on } => Command::Accept { frames: frames(chosen), on: *on },
        Word::Lock { objects: chosen, on } => Command::Lock { objects: objects(chosen), on: *on },
        Word::Describe { object, name, coalesce } => {
            let description = Description { name: (*name).into(), ..Description::default() };
            Command::Describe { object: *object, description, coalesce: *coalesce }
        }
        Word::Merge(chosen) => Command::Merge(objects(chosen)),
        Word::Delete(chosen) => Command::Delete(objects(chosen)),
        Word::Split { object, frame: chosen, new } => {
            Command::Split { object: *object, frame: frame(*chosen), new: *new }
        }
        Word::Replace { annotations: parts, locked, merged, deleted, accepted } => {
            Command::ReplaceAnnotations(Declaration {
                annotations: annotations(parts),
                locked: objects(locked),
                described: Vec::new(),
                merged: vec![objects(merged)],
                deleted: objects(deleted),
                accepted: frames(accepted),
            })
        }
    }
}

/// Takes so many frames.
fn take(clip: &mut Clip, frames: &[Frame], count: u8) {
    for _ in 0..count {
        let Some(wanted) = clip.wanted() else { return };
        clip.take(wanted.frame, &frames[wanted.frame], None).expect("it is the frame that is wanted");
    }
}

/// Gives a command, or takes it back after some frames.
fn give(clip: &mut Clip, frames: &[Frame], word: &Word<'_>, cancel_after: Option<u8>) {
    let is_idle = clip.steps()[2] == 0;
    let before = (clip.frames(), clip.objects(), clip.steps());
    let step = match clip.apply(command(word)) {
        Ok(step) => step,
        Err(error) => {
            assert!(matches!(error, Error::InvalidOption { .. } | Error::ObjectLocked { .. }), "{error}");
            assert_eq!((clip.frames(), clip.objects(), clip.steps()), before, "what is refused changes nothing");
            return;
        }
    };
    if let Some(count) = cancel_after {
        take(clip, frames, count);
        if clip.cancel(step) && is_idle {
            assert_eq!((clip.frames(), clip.objects(), clip.steps()), before, "what is cancelled changes nothing");
        }
    }
}

fuzz_target!(|actions: Vec<Action<'_>>| {
    let known = known();
    let read = |bytes: &[u8]| Clip::read(bytes, OpenOptions::default()).expect("the journal is its own").clip;
    let mut clip = read(&known.journal);
    for action in actions.iter().take(2 * MOST) {
        match action {
            Action::Give { word, cancel_after } => give(&mut clip, &known.frames, word, *cancel_after),
            Action::Take(count) => take(&mut clip, &known.frames, *count),
            Action::Undo => _ = clip.undo(),
            Action::Redo => _ = clip.redo(),
            Action::Finish => {
                if let Some(step) = clip.wanted().and_then(|wanted| wanted.step) {
                    clip.finish(step);
                }
            }
            Action::Look(index) => clip.look_at(usize::from(index % 4)),
            Action::Save => clip = read(&clip.save()),
        }
    }
    run(&mut clip, &known.frames);
    check_opened(&mut clip, &known.frames);
});
