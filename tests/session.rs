//! Promises of a clip from its opening to its closing: its masks, what is locked or accepted, undo, and cancelling.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "test code may panic")]

mod journal;
mod ranges;

use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::LazyLock;

use crate::support::moving::{annotate, frames_of, options, scene_of, thing, whole};
use veronese::clip::{
    Accepted, Annotation, Annotations, Click, Clip, ClipFrame, Command, Content, Declaration, Description, FramePairs,
    OpenOptions, Painted, Prompt, SegmentedClip, Spread, solve_pair,
};
use veronese::{Error, Frame, Quality, Random, SegmentOptions};

const SIZE: [usize; 2] = [128, 96];
const PIXELS: usize = SIZE[0] * SIZE[1];
const COUNT: usize = 6;

/// Seeds of the sequences of commands in which all labels are compared, and the length of each.
const SEEDS: std::ops::Range<u64> = 0..9;
const LENGTH: usize = 14;

/// Three things that cross, of which two move and are found.
struct Scene {
    frames: Vec<Frame>,
    truths: Vec<Vec<usize>>,
    /// The pairs of each frame but the first.
    pairs: Vec<FramePairs>,
    clip: SegmentedClip,
    /// The journal of the segmented clip, whose labels are known.
    saved: Vec<u8>,
}

static SCENE: LazyLock<Scene> = LazyLock::new(|| {
    let things = [
        thing(2, [24.0, 22.0], |t| [6.0 + 7.0 * t as f32, 34.0]),
        thing(3, [26.0, 30.0], |t| [88.0 - 7.0 * t as f32, 38.0]),
        thing(9, [30.0, 20.0], |_| [60.0, 72.0]),
    ];
    let (frames, truths) = scene_of(SIZE, 1, &things, COUNT);
    let pairs: Vec<FramePairs> =
        frames.windows(2).map(|pair| solve_pair(&pair[0], &pair[1], &fast()).unwrap()).collect();
    let clip = whole(&frames, options(Quality::Fast, None));
    let mut opened = Clip::new(COUNT, OpenOptions::default()).unwrap();
    opened.apply(segment(0..COUNT)).unwrap();
    while let Some(wanted) = opened.wanted() {
        let solved = wanted.frame.checked_sub(1).map(|before| &pairs[before]);
        opened.take(wanted.frame, &frames[wanted.frame], solved).unwrap();
    }
    for index in 0..COUNT {
        opened.look_at(index);
        opened.take(index, &frames[index], None).unwrap();
    }
    let saved = opened.save();
    Scene { frames, truths, pairs, clip, saved }
});

fn fast() -> SegmentOptions {
    SegmentOptions::default().with_quality(Quality::Fast)
}

fn segment(frames: std::ops::Range<usize>) -> Command {
    Command::Segment { frames, options: fast() }
}

fn said(frame: usize, content: Content) -> Command {
    Command::Annotate(vec![Annotation::new(frame, content)])
}

fn read(bytes: &[u8]) -> Clip {
    let read = Clip::read(bytes, OpenOptions::default()).unwrap();
    assert_eq!((read.used, read.is_damaged), (bytes.len(), false));
    read.clip
}

/// The segmented clip.
fn start() -> Clip {
    read(&SCENE.saved)
}

/// Takes the frame that is wanted.
fn take(clip: &mut Clip) -> bool {
    let Some(wanted) = clip.wanted() else { return false };
    let solved = wanted.frame.checked_sub(1).map(|before| &SCENE.pairs[before]);
    clip.take(wanted.frame, &SCENE.frames[wanted.frame], solved).unwrap();
    true
}

fn run(clip: &mut Clip) {
    let taken = (0..1000).take_while(|_| take(clip)).count();
    assert!(taken < 1000, "it does not end, but wants {:?}", clip.wanted());
}

/// Gives a command, and goes on until it has settled.
fn settle(clip: &mut Clip, command: Command) -> veronese::Result<()> {
    let step = clip.apply(command)?;
    run(clip);
    let settled = clip.take_events().settled;
    settled.into_iter().find(|of| of.step == step).expect("it has settled").changes.map(drop)
}

/// The labels of all frames with masks.
fn labels(clip: &mut Clip) -> Vec<Option<ClipFrame>> {
    let count = clip.len();
    let of = |index| {
        clip.look_at(index);
        run(clip);
        clip.labels(index)
    };
    (0..count).map(of).collect()
}

fn shown(clip: &mut Clip) -> Vec<Vec<u8>> {
    labels(clip).into_iter().map(|frame| frame.unwrap().labels).collect()
}

/// A hash of everything that can be asked of a clip that has nothing to do.
fn print(clip: &mut Clip) -> u64 {
    let mut hasher = DefaultHasher::new();
    for frame in labels(clip).into_iter().flatten() {
        (frame.index, &frame.labels, format!("{:?} {:?}", frame.objects, frame.background)).hash(&mut hasher);
    }
    summary(clip).hash(&mut hasher);
    hasher.finish()
}

/// Everything that can be asked of a clip but its labels, which follow from the revisions.
fn summary(clip: &Clip) -> String {
    format!("{:?} {:?} {:?} {:?}", clip.size(), clip.frames(), clip.objects(), clip.next_object())
}

fn assert_same(one: &[Option<ClipFrame>], other: &[ClipFrame], what: &str) {
    assert_eq!(one.len(), other.len());
    for (one, other) in one.iter().flatten().zip(other) {
        assert!(one.labels == other.labels, "{what}: frame {}", other.index);
        assert_eq!(
            (&one.objects, &one.background),
            (&other.objects, &other.background),
            "{what}: frame {}",
            other.index
        );
    }
}

fn in_box([left, top, columns, rows]: [usize; 4], inside: u8, outside: u8) -> Vec<u8> {
    let is_in =
        |p: usize| (left..left + columns).contains(&(p % SIZE[0])) && (top..top + rows).contains(&(p / SIZE[0]));
    (0..PIXELS).map(|p| if is_in(p) { inside } else { outside }).collect()
}

fn of_thing(frame: usize, thing: usize, inside: u8, outside: u8) -> Vec<u8> {
    SCENE.truths[frame].iter().map(|&t| if t == thing { inside } else { outside }).collect()
}

/// A label map of things of a frame under some numbers, open elsewhere.
fn numbered(frame: usize, numbers: [(usize, u8); 2]) -> Vec<u8> {
    let number = |thing: &usize| numbers.iter().find(|(of, _)| of == thing).map_or(255, |(_, number)| *number);
    SCENE.truths[frame].iter().map(number).collect()
}

fn renumbered(labels: &[u8], object: u8) -> Vec<u8> {
    labels.iter().map(|&label| if label == 1 { object } else { label }).collect()
}

/// Commands, and annotations that say the same.
fn pairs_of_annotations() -> Vec<(&'static str, Command, Annotations)> {
    let none = Annotations::default;
    let painted = |frame, object, labels, spread| vec![Painted { frame, object, labels, spread }];
    let strokes = in_box([62, 76, 14, 8], 1, 255);
    let mask = of_thing(2, 3, 1, 0);
    let map = numbered(1, [(3, 9), (1, 4)]);
    let eraser = in_box([20, 30, 24, 30], 0, 255);
    let clicks = vec![Click { at: [72, 80], inside: true }];
    let within = Some([58, 70, 34, 24]);
    let forward =
        Annotation { frame: 2, content: Content::Mask { object: 9, labels: mask.clone() }, spread: Spread::Forward };
    vec![
        (
            "strokes",
            said(2, Content::Strokes { object: 9, labels: strokes.clone() }),
            Annotations { corrections: painted(2, Some(9), renumbered(&strokes, 9), Spread::Both), ..none() },
        ),
        (
            "mask",
            Command::Annotate(vec![forward]),
            Annotations { corrections: painted(2, Some(9), renumbered(&mask, 9), Spread::Forward), ..none() },
        ),
        (
            "labels",
            said(1, Content::Labels(map.clone())),
            Annotations { corrections: painted(1, None, map, Spread::Both), ..none() },
        ),
        (
            "eraser",
            said(3, Content::Labels(eraser.clone())),
            Annotations { corrections: painted(3, None, eraser, Spread::Both), ..none() },
        ),
        (
            "given",
            said(4, Content::Given(of_thing(4, 3, 1, 0))),
            Annotations { masks: painted(4, None, of_thing(4, 3, 1, 0), Spread::Both), ..none() },
        ),
        (
            "prompt",
            said(3, Content::Prompt { object: 9, clicks: clicks.clone(), within }),
            Annotations {
                prompts: vec![Prompt { frame: 3, object: 9, clicks, within, spread: Spread::Both }],
                ..none()
            },
        ),
        (
            "accept",
            Command::Accept { frames: vec![4, 1], on: true },
            Annotations { accepted: Some([4, 1].map(|frame| Accepted { frame, labels: None }).into()), ..none() },
        ),
        ("lock", Command::Lock { objects: vec![2], on: true }, Annotations { locked: Some(vec![2]), ..none() }),
        ("merge", Command::Merge(vec![2, 1]), Annotations { numbers: vec![[1, 2]], ..none() }),
        ("delete", Command::Delete(vec![1]), Annotations { numbers: vec![[1, 0]], ..none() }),
    ]
}

#[test]
fn masks_are_those_of_annotations_of_a_segmented_clip() {
    let found = frames_of(&SCENE.clip, &SCENE.frames);
    assert!(found.iter().all(|frame| frame.objects.len() >= 2), "two things are found");
    assert_same(&labels(&mut start()), &found, "found");
    for (what, command, annotations) in pairs_of_annotations() {
        let (mut clip, mut before) = (start(), SCENE.clip.clone());
        settle(&mut clip, command).unwrap();
        annotate(&mut before, &SCENE.frames, annotations);
        assert_same(&labels(&mut clip), &frames_of(&before, &SCENE.frames), what);
    }
}

#[test]
fn annotations_are_returned_as_they_were_given() {
    for (name, command, _) in pairs_of_annotations() {
        let Command::Annotate(given) = &command else { continue };
        let mut clip = start();
        settle(&mut clip, command.clone()).unwrap();
        let Annotation { frame, content, spread } = &given[0];
        let returned = match content {
            Content::Mask { object, labels } => Content::Strokes { object: *object, labels: labels.clone() },
            Content::Given(labels) => Content::Labels(labels.clone()),
            other => other.clone(),
        };
        assert_eq!(
            clip.annotations(*frame),
            [Annotation { frame: *frame, content: returned, spread: *spread }],
            "{name}"
        );
        assert!((0..COUNT).all(|index| index == *frame || clip.annotations(index).is_empty()), "{name}");
        settle(&mut clip, Command::Clear { frame: *frame, object: None }).unwrap();
        assert!(clip.annotations(*frame).is_empty(), "{name}");
    }
}

#[test]
fn a_saved_clip_is_taken_over_as_one_step() {
    let annotated = |content| {
        let mut clip = start();
        settle(&mut clip, said(2, content)).unwrap();
        clip
    };
    let mut other = annotated(Content::Mask { object: 9, labels: of_thing(2, 3, 1, 0) });
    let mut clip = annotated(Content::Labels(in_box([20, 30, 24, 30], 0, 255)));
    let (before, wanted) = (print(&mut clip), print(&mut other));
    let steps = clip.steps()[0];
    let mut journal = clip.save();
    clip.take_events();
    clip.restore(&other.save()).unwrap();
    assert_eq!(clip.annotations(2), other.annotations(2));
    assert_eq!((print(&mut clip), clip.steps()[0]), (wanted, steps + 1));
    journal.extend(clip.take_events().records);
    for mut of in [read(&clip.save()), clip] {
        assert_eq!(print(&mut of), wanted);
        of.undo();
        assert_eq!(print(&mut of), before, "one step takes it back");
        of.redo();
        assert_eq!(print(&mut of), wanted);
    }
    let mut short = Clip::new(COUNT + 1, OpenOptions::default()).unwrap();
    assert!(matches!(short.restore(&other.save()), Err(Error::InvalidOption { name: "saved", .. })));
    assert!(start().restore(&journal[..journal.len() - 1]).is_err(), "what is cut off");
}

#[test]
fn replacing_all_annotations_gives_the_masks_of_these_alone() {
    let strokes = in_box([62, 76, 14, 8], 1, 255);
    let given = numbered(4, [(3, 7), (1, 1)]);
    let all = Declaration {
        annotations: vec![
            Annotation::new(4, Content::Given(given.clone())),
            Annotation::new(2, Content::Strokes { object: 7, labels: strokes.clone() }),
            Annotation::new(1, Content::Prompt { object: 8, clicks: Vec::new(), within: Some([10, 31, 30, 28]) }),
        ],
        locked: vec![2],
        described: vec![(7, Description { name: "a thing".into(), ..Description::default() })],
        merged: vec![vec![8, 1]],
        deleted: Vec::new(),
        accepted: vec![0],
    };
    let painted = |frame, object, labels| Painted { frame, object, labels, spread: Spread::Both };
    let annotations = Annotations {
        masks: vec![painted(4, None, given)],
        corrections: vec![painted(2, Some(7), renumbered(&strokes, 7))],
        prompts: vec![Prompt {
            frame: 1,
            object: 8,
            clicks: Vec::new(),
            within: Some([10, 31, 30, 28]),
            spread: Spread::Both,
        }],
        locked: Some(vec![2]),
        named: Some(vec![7]),
        accepted: Some(vec![Accepted { frame: 0, labels: None }]),
        numbers: vec![[1, 8]],
        ..Annotations::default()
    };
    let mut before = SCENE.clip.clone();
    annotate(&mut before, &SCENE.frames, annotations);
    // Whatever was said before; but an accepted frame keeps the labels that were seen.
    for (what, command, _) in pairs_of_annotations().into_iter().filter(|(what, ..)| *what != "accept") {
        let mut clip = start();
        settle(&mut clip, command).unwrap();
        settle(&mut clip, Command::ReplaceAnnotations(all.clone())).unwrap();
        assert_same(&labels(&mut clip), &frames_of(&before, &SCENE.frames), what);
    }
    let mut clip = start();
    settle(&mut clip, said(0, Content::Mask { object: 1, labels: in_box([0, 0, 9, 9], 1, 255) })).unwrap();
    settle(&mut clip, Command::Accept { frames: vec![0], on: true }).unwrap();
    let seen = shown(&mut clip)[0].clone();
    settle(&mut clip, Command::ReplaceAnnotations(Declaration { accepted: vec![0], ..Declaration::default() }))
        .unwrap();
    assert!(shown(&mut clip)[0] == seen, "an accepted frame keeps its labels");
    assert_same(&labels(&mut clip)[1..], &frames_of(&SCENE.clip, &SCENE.frames)[1..], "the rest");
}

#[test]
fn a_clip_moves_between_threads() {
    fn moves<T: Send>() {}
    moves::<Clip>();
}

/// A clip that is given commands, what is known of it, and the prints of its states.
struct Session {
    clip: Clip,
    labels: Vec<Vec<u8>>,
    random: Random,
    /// Prints of the state before each step that can be undone, and now.
    prints: Vec<u64>,
    /// Pixels that were drawn exactly, by frame.
    exact: Vec<BTreeSet<usize>>,
}

impl Session {
    fn new(seed: u64) -> Session {
        let mut clip = start();
        clip.undo();
        let opened = print(&mut clip);
        clip.redo();
        let (labels, print) = (shown(&mut clip), print(&mut clip));
        let exact = vec![BTreeSet::new(); COUNT];
        Session { clip, labels, random: Random::from_seed(seed), prints: vec![opened, print], exact }
    }

    fn below(&mut self, limit: usize) -> usize {
        self.random.uniform(0.0, limit as f64) as usize
    }

    fn locked(&self, object: u8) -> bool {
        self.clip.objects().iter().any(|of| of.number == object && of.locked)
    }

    /// Objects from which strokes take no pixel: locked, named and merged ones, and those in accepted frames.
    fn kept(&self, is_accepted: &[bool]) -> BTreeSet<u8> {
        let objects = self.clip.objects();
        let is_kept = |of: &&veronese::clip::Object| of.locked || !of.description.name.is_empty();
        let merged = objects.iter().filter(|of| of.became != of.number).map(|of| of.became);
        let own = objects.iter().filter(is_kept).map(|of| of.became).chain(merged);
        own.chain((0..COUNT).filter(|&t| is_accepted[t]).flat_map(|t| self.labels[t].iter().copied()))
            .filter(|k| *k > 0)
            .collect()
    }

    /// A random command, the object that it is about and the pixels that it says something of.
    fn command(&mut self) -> (&'static str, Command, Vec<u8>, usize, Vec<u8>) {
        let (thing, frame, kind) = (1 + self.below(3), self.below(COUNT), self.below(14));
        let seen: Vec<u8> = self.labels[frame].iter().copied().filter(|k| *k > 0).collect();
        let object = match seen.len() {
            n if n > 0 && self.below(2) == 0 => seen[self.below(n)],
            _ => 10 + thing as u8,
        };
        let inside: Vec<usize> = (0..PIXELS).filter(|&p| SCENE.truths[frame][p] == thing).collect();
        let at = inside[self.below(inside.len())];
        let around = [(at % SIZE[0]).saturating_sub(5), (at / SIZE[0]).saturating_sub(4), 11, 9];
        let adds = u8::from(self.below(3) > 0);
        let one = |content| Annotation::new(frame, content);
        let some = |content, spread| Command::Annotate(vec![Annotation { frame, content, spread }]);
        let (none, alone) = (Vec::new, vec![object]);
        match kind {
            0 | 1 => {
                let labels = in_box(around, adds, 255);
                let command = Command::Annotate(vec![one(Content::Strokes { object, labels: labels.clone() })]);
                ("strokes", command, alone, frame, renumbered(&labels, object))
            }
            2 => {
                let labels = of_thing(frame, thing, 1, 0);
                let command = Command::Annotate(vec![one(Content::Mask { object, labels: labels.clone() })]);
                ("a mask", command, alone, frame, renumbered(&labels, object))
            }
            3 | 4 => {
                let labels = in_box(around, adds, 255);
                let content = Content::Strokes { object, labels: labels.clone() };
                ("exact", some(content, Spread::Exact), alone, frame, renumbered(&labels, object))
            }
            5 => {
                let clicks = vec![Click { at: [at % SIZE[0], at / SIZE[0]], inside: true }];
                let spread = [Spread::Both, Spread::Forward, Spread::Backward, Spread::None][self.below(4)];
                ("clicks", some(Content::Prompt { object, clicks, within: None }, spread), alone, frame, none())
            }
            6 => {
                let labels = in_box(around, object * adds, 255);
                let command = Command::Annotate(vec![one(Content::Labels(labels.clone()))]);
                ("labels", command, vec![object, 0], frame, labels)
            }
            7 => ("accept", Command::Accept { frames: vec![frame], on: adds > 0 }, none(), frame, none()),
            8 | 9 => ("lock", Command::Lock { objects: alone, on: adds > 0 }, none(), frame, none()),
            10 => {
                let name = if adds > 0 { "a name" } else { "" };
                let description = Description { name: name.into(), ..Description::default() };
                let command = Command::Describe { object, description, coalesce: self.below(2) == 0 };
                ("describe", command, none(), frame, none())
            }
            11 => {
                let other = seen.get(self.below(seen.len().max(1))).copied().unwrap_or(object);
                ("merge", Command::Merge(vec![object, other]), vec![object, other], frame, none())
            }
            12 => ("delete", Command::Delete(alone.clone()), alone, frame, none()),
            _ => ("clear", Command::Clear { frame, object: (adds > 0).then_some(object) }, alone, frame, none()),
        }
    }

    fn act(&mut self) {
        let (what, command, objects, frame, painted) = self.command();
        let is_accepted: Vec<bool> = self.clip.frames().iter().map(|of| of.accepted).collect();
        let before = self.clip.objects();
        let saved = self.clip.save();
        let locked: Vec<bool> = (0..=255).map(|k| self.locked(k)).collect();
        let kept = self.kept(&is_accepted);
        let describes = matches!(command, Command::Describe { coalesce: true, .. });
        let steps = self.clip.steps();
        let outcome = settle(&mut self.clip, command.clone());
        let context = format!("{what} of {objects:?} in frame {frame}");
        if let Err(error) = &outcome {
            assert!(self.clip.save() == saved, "{context}: what fails changes nothing, {error}");
            match error {
                Error::ObjectLocked { object } => {
                    assert!(locked[usize::from(*object)], "{context}: {object} is not locked")
                }
                Error::InvalidOption { .. } => {}
                _ => panic!("{context}: {error}"),
            }
            return;
        }
        let is_about_locked = objects.iter().any(|k| locked[usize::from(*k)]);
        let is_edit = ["clear", "merge", "delete", "labels"].contains(&what);
        assert!(!is_about_locked || is_edit || saved == self.clip.save(), "{context}: of a locked object");
        let after = shown(&mut self.clip);
        let labels = std::mem::replace(&mut self.labels, after);
        self.compare(&labels, &context, (what, frame, &painted), (&locked, &kept), &is_accepted);
        if ["accept", "lock", "describe"].contains(&what) {
            assert!(labels == self.labels, "{context} changes labels");
        }
        // Numbers stay: none of an object that there was is free again.
        let now = self.clip.objects();
        assert!(before.iter().all(|was| now.iter().any(|is| is.number == was.number)), "{context}: a number is gone");
        for was in before.iter().filter(|of| of.became != of.number) {
            let is = now.iter().find(|is| is.number == was.number).unwrap().became;
            assert!(is != was.number && (was.became > 0 || is == 0), "{context}: {} became {is}", was.number);
            assert!(
                self.labels.iter().flatten().all(|label| *label != was.number),
                "{context}: {} is seen",
                was.number
            );
        }
        if what == "exact" {
            self.exact[frame].extend((0..PIXELS).filter(|&p| painted[p] == self.labels[frame][p]));
        } else if objects.len() < 2 {
            self.exact[frame].retain(|&p| painted.get(p).is_none_or(|label| *label == 255));
        } else {
            self.exact.iter_mut().for_each(BTreeSet::clear);
        }
        // A step that is part of the one before replaces it.
        let [undo, redo, waiting] = self.clip.steps();
        let print = print(&mut self.clip);
        let is_nothing = print == self.prints[steps[0]];
        assert!(waiting == 0 && (redo == 0 || is_nothing && self.clip.steps() == steps), "{context}");
        match undo {
            now if now == steps[0] + 1 => {
                self.prints.truncate(now);
                self.prints.push(print);
            }
            _ if describes && self.prints.last() != Some(&print) => *self.prints.last_mut().unwrap() = print,
            _ => assert_eq!(self.prints[undo], print, "{context}: a change without a step"),
        }
    }

    /// Compares labels before and after a command.
    fn compare(
        &self,
        before: &[Vec<u8>],
        context: &str,
        (what, frame, painted): (&str, usize, &[u8]),
        (locked, kept): (&[bool], &BTreeSet<u8>),
        is_accepted: &[bool],
    ) {
        for (t, (before, after)) in before.iter().zip(&self.labels).enumerate() {
            for p in (0..PIXELS).filter(|&p| before[p] != after[p]) {
                let [was, is] = [before[p], after[p]];
                let context = format!("{context}: in frame {t} pixel {p} was {was}, is {is}");
                let is_locked = |k: u8| locked[usize::from(k)];
                assert!(!is_locked(was) && !is_locked(is), "{context}, and is locked");
                assert!(
                    t == frame || !is_accepted[t] || ["merge", "delete"].contains(&what),
                    "{context}, and is accepted"
                );
                let exact = self.exact[t].contains(&p) && !["merge", "delete", "clear"].contains(&what);
                let is_said = t == frame && painted.get(p).is_some_and(|label| *label != 255);
                assert!(!exact || is_said, "{context}, and was drawn exactly");
                assert!(what != "exact" || is_said, "{context}, and was not drawn");
            }
        }
        for p in (0..painted.len()).filter(|&p| painted[p] != 255) {
            let [was, is] = [before[frame][p], self.labels[frame][p]];
            // Ground of one object is ground for this object alone.
            let object = painted.iter().copied().find(|l| *l > 0 && *l != 255);
            let is_right = if painted[p] > 0 { is == painted[p] } else { object.is_none_or(|object| is != object) };
            let is_covered = self.exact[frame].contains(&p) && painted[p] == 0;
            assert!(
                is_right || kept.contains(&was) || is_covered,
                "{context}: pixel {p} was {was}, is {is}, not {}",
                painted[p]
            );
        }
    }

    /// Undoes some steps, and does them again, or goes on from there.
    fn go_back(&mut self) {
        let [undo, redo, _] = self.clip.steps();
        let count = self.below(undo);
        for k in 1..=count {
            assert!(self.clip.undo());
            assert_eq!(print(&mut self.clip), self.prints[undo - k], "undone {k} of {undo}");
        }
        assert_eq!(self.clip.steps(), [undo - count, redo + count, 0]);
        let again = self.below(count + 1);
        for k in 1..=again {
            assert!(self.clip.redo());
            assert_eq!(print(&mut self.clip), self.prints[undo - count + k], "done again");
        }
        if again < count {
            self.exact.iter_mut().for_each(BTreeSet::clear);
            self.labels = shown(&mut self.clip);
        }
    }
}

#[test]
fn promises_hold_whatever_is_said_and_undone() {
    for seed in SEEDS {
        let mut session = Session::new(seed);
        for k in 0..LENGTH {
            session.act();
            if k % 5 == 4 && k + 1 < LENGTH {
                session.go_back();
            }
        }
        // All states are what they were.
        let [undo, redo, _] = session.clip.steps();
        for k in (0..undo).rev() {
            assert!(session.clip.undo());
            assert_eq!(print(&mut session.clip), session.prints[k], "seed {seed}, state {k}");
        }
        assert!(!session.clip.undo());
        (0..undo + redo).for_each(|_| assert!(session.clip.redo()));
        assert!(!session.clip.redo());
        assert_eq!(print(&mut session.clip), session.prints[undo + redo], "seed {seed}");
    }
}

#[test]
fn a_step_that_is_cancelled_at_any_frame_leaves_the_state_before() {
    let more = [
        ("split", Command::Split { object: 9, frame: 2, new: 200 }, Annotations::default()),
        ("clear", Command::Clear { frame: 2, object: None }, Annotations::default()),
        (
            "all",
            Command::ReplaceAnnotations(Declaration { accepted: vec![3], ..Declaration::default() }),
            Annotations::default(),
        ),
    ];
    let mut clip = start();
    // In two pieces, so that it can be split.
    let labels: Vec<u8> =
        in_box([4, 4, 12, 8], 1, 255).into_iter().zip(in_box([70, 4, 9, 8], 1, 255)).map(|(a, b)| a.min(b)).collect();
    settle(&mut clip, said(2, Content::Strokes { object: 9, labels })).unwrap();
    settle(&mut clip, Command::Accept { frames: vec![5], on: true }).unwrap();
    let (state, saved) = (print(&mut clip), clip.save());
    let mut taken = 0;
    for (what, command, _) in pairs_of_annotations().into_iter().chain(more) {
        for count in 0.. {
            let mut clip = read(&saved);
            let step = clip.apply(command.clone()).unwrap();
            let _ = (0..count).all(|_| take(&mut clip));
            if clip.steps()[2] == 0 {
                break;
            }
            assert!(if count % 2 == 0 { clip.cancel(step) } else { clip.undo() }, "{what}");
            assert!(clip.save() == saved, "{what}, cancelled after {count} frames");
            assert_eq!(print(&mut clip), state, "{what}, cancelled after {count} frames");
            assert!(!clip.cancel(step));
            taken += 1;
        }
    }
    assert!(taken > 40, "steps take frames: {taken}");
}

#[test]
fn labels_that_are_known_are_those_of_a_clip_that_never_knew_them() {
    let mut clip = start();
    for (_, command, _) in pairs_of_annotations() {
        settle(&mut clip, command).ok();
        let saved = clip.save();
        // Without its labels: another option for them makes none known.
        let other = OpenOptions::default().with_mark_unknown(true);
        let mut bare = read(&Clip::read(&saved, other).unwrap().clip.save());
        assert!((0..COUNT).all(|index| bare.labels(index).is_none()));
        assert_eq!(print(&mut bare), print(&mut clip));
    }
}

#[test]
fn a_description_taken_back_in_the_same_step_is_taken_back() {
    let mut clip = start();
    let describe = |name: &str| {
        let description = Description { name: name.into(), ..Description::default() };
        Command::Describe { object: 1, description, coalesce: true }
    };
    let before = print(&mut clip);
    for name in ["b", "bo", "b", ""] {
        settle(&mut clip, describe(name)).unwrap();
        assert_eq!(clip.objects()[0].description.name, name);
        assert_eq!(clip.steps()[0], 2, "one step after the first");
    }
    clip.undo();
    assert_eq!(print(&mut clip), before);
}

#[test]
fn the_oldest_steps_are_forgotten_and_never_the_state() {
    let mut steps = Vec::new();
    for undo in [0, 1500, 6000, 1 << 20] {
        let mut clip = Clip::read(&SCENE.saved, OpenOptions::default().with_undo(undo)).unwrap().clip;
        let mut whole = start();
        for (_, command, _) in pairs_of_annotations() {
            for clip in [&mut clip, &mut whole] {
                settle(clip, command.clone()).ok();
            }
            assert_eq!(print(&mut clip), print(&mut whole));
        }
        steps.push(clip.steps()[0]);
        while clip.undo() {
            whole.undo();
            assert_eq!(print(&mut clip), print(&mut whole));
        }
    }
    assert!(steps.is_sorted() && steps[0] == 0 && steps[1] < steps[2] && steps[2] < steps[3], "{steps:?}");
}

#[test]
fn merged_objects_are_erased_cleared_and_unlocked_as_one() {
    let mut clip = start();
    let [left, right] = [[4, 4, 12, 8], [70, 4, 9, 8]];
    for (object, place) in [(7, left), (9, right)] {
        settle(&mut clip, said(2, Content::Strokes { object, labels: in_box(place, 1, 255) })).unwrap();
    }
    settle(&mut clip, Command::Merge(vec![7, 9])).unwrap();
    let count = |clip: &mut Clip, [x, y, columns, rows]: [usize; 4]| {
        let labels = shown(clip).swap_remove(2);
        let inside = |p: &usize| (x..x + columns).contains(&(p % SIZE[0])) && (y..y + rows).contains(&(p / SIZE[0]));
        (0..PIXELS).filter(|p| inside(p) && labels[*p] == 7).count()
    };
    assert_eq!((count(&mut clip, left), count(&mut clip, right)), (96, 72));
    settle(&mut clip, Command::Lock { objects: vec![7], on: true }).unwrap();
    settle(&mut clip, Command::Lock { objects: vec![9], on: false }).unwrap();
    settle(&mut clip, said(2, Content::Strokes { object: 7, labels: in_box(right, 0, 255) })).unwrap();
    assert_eq!(count(&mut clip, right), 0, "what was object 9 is erased");
    assert!(clip.undo());
    assert_eq!(count(&mut clip, right), 72);
    settle(&mut clip, Command::Clear { frame: 2, object: Some(7) }).unwrap();
    assert_eq!((count(&mut clip, left), count(&mut clip, right)), (0, 0));
    assert!(settle(&mut clip, Command::Merge(vec![7, 9])).is_err(), "they are one already");
}

#[test]
fn exact_drawing_yields_to_what_is_painted_later() {
    let mut clip = start();
    let place = [4, 4, 12, 8];
    let exact = |content| Command::Annotate(vec![Annotation { frame: 2, content, spread: Spread::Exact }]);
    let paint = || said(2, Content::Strokes { object: 7, labels: in_box(place, 1, 255) });
    let has = |clip: &mut Clip, t: usize| shown(clip).swap_remove(t)[5 * SIZE[0] + 5] == 7;
    settle(&mut clip, paint()).unwrap();
    settle(&mut clip, exact(Content::Strokes { object: 7, labels: in_box(place, 0, 255) })).unwrap();
    assert!(!has(&mut clip, 2) && has(&mut clip, 3), "it is erased in its frame alone");
    settle(&mut clip, paint()).unwrap();
    assert!(has(&mut clip, 2), "the same stroke again");
    // An eraser over a label map, over strokes, and over what was drawn exactly.
    for below in [said(2, Content::Labels(in_box(place, 7, 255))), exact(Content::Labels(in_box(place, 7, 255)))] {
        settle(&mut clip, below).unwrap();
        assert!(has(&mut clip, 2));
        settle(&mut clip, said(2, Content::Labels(in_box(place, 0, 255)))).unwrap();
        assert!(!has(&mut clip, 2));
    }
    // What is declared is drawn, also of objects that are locked.
    let annotations = vec![
        Annotation::new(2, Content::Strokes { object: 7, labels: in_box(place, 1, 255) }),
        Annotation {
            frame: 2,
            content: Content::Strokes { object: 7, labels: in_box([4, 4, 3, 3], 0, 255) },
            spread: Spread::Exact,
        },
    ];
    let declared = Declaration { annotations, locked: vec![7], ..Declaration::default() };
    settle(&mut clip, Command::ReplaceAnnotations(declared)).unwrap();
    assert!(!has(&mut clip, 2) && has(&mut clip, 3));
}

#[test]
fn a_host_knows_what_is_under_way() {
    let mut clip = start();
    let before = clip.frames()[2].revision;
    let command = || said(2, Content::Strokes { object: 7, labels: in_box([4, 4, 12, 8], 1, 255) });
    let step = clip.apply(command()).unwrap();
    assert_eq!(
        clip.next_object(),
        Some((1..255).find(|k| *k != 7 && clip.objects().iter().all(|of| of.number != *k)).unwrap())
    );
    clip.look_at(2);
    assert!(take(&mut clip) && take(&mut clip));
    let shown = clip.labels(2).unwrap();
    assert!(shown.labels.contains(&7) && clip.frames()[2].revision != before, "its own frame comes first");
    assert!(clip.cancel(step));
    assert_eq!(clip.frames()[2].revision, before);
    assert_eq!(clip.take_events().cancelled, [step]);
    // What cannot be written in the journal is refused at once.
    let large = vec![255; 4096 * 4096 + 1];
    let mut waiting = Clip::new(COUNT, OpenOptions::default()).unwrap();
    waiting.apply(segment(0..COUNT)).unwrap();
    assert!(waiting.apply(said(2, Content::Labels(large))).is_err());
    assert!(Clip::new(usize::MAX, OpenOptions::default()).is_err());
}
