//! An outline is its object: a mask that a person has drawn as a whole is the object's in its frame, to the pixel. And a deleted object claims
//! nothing: what is drawn again is as if it had never been.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "test code may panic")]

use crate::support::moving::{
    SIZE, annotate, carrier, frames_of, mask, moving_and_resting, moving_and_resting_clip, renumber,
};
use veronese::clip::{Accepted, Annotations, Click, Painted, Prompt, SegmentedClip, Spread};
use veronese::{Frame, Random};

const PIXELS: usize = SIZE[0] * SIZE[1];

fn painted(frame: usize, object: u8, labels: Vec<u8>) -> Annotations {
    let corrections = vec![Painted { frame, object: Some(object), labels, spread: Spread::Both }];
    Annotations { corrections, ..Annotations::default() }
}

fn boxed(frame: usize, object: u8, within: [usize; 4]) -> Annotations {
    let prompts = vec![Prompt { frame, object, clicks: Vec::new(), within: Some(within), spread: Spread::Both }];
    Annotations { prompts, ..Annotations::default() }
}

/// An object where something is, and nowhere else.
fn outline(object: u8, inside: impl Fn(usize) -> bool) -> Vec<u8> {
    (0..PIXELS).map(|p| if inside(p) { object } else { 0 }).collect()
}

/// A stroke, with nothing said elsewhere.
fn stroke(label: u8, [x, y, width, height]: [usize; 4]) -> Vec<u8> {
    (0..PIXELS).map(|p| if is_in(p, [x, y, width, height]) { label } else { 255 }).collect()
}

fn is_in(p: usize, [x, y, width, height]: [usize; 4]) -> bool {
    (x..x + width).contains(&(p % SIZE[0])) && (y..y + height).contains(&(p / SIZE[0]))
}

/// The pixels of a frame that are in a polygon of so many random corners.
fn polygon(random: &mut Random, corners: usize) -> Vec<bool> {
    let corner = |_| SIZE.map(|side| random.uniform(0.0, side as f64));
    let corners: Vec<[f64; 2]> = (0..corners).map(corner).collect();
    let is_inside = |p: usize| {
        let [x, y] = [p % SIZE[0], p / SIZE[0]].map(|at| at as f64);
        let crosses = |k: usize| {
            let ([x0, y0], [x1, y1]) = (corners[k], corners[(k + 1) % corners.len()]);
            (y0 <= y) != (y1 <= y) && x0 + (y - y0) * (x1 - x0) / (y1 - y0) <= x
        };
        (0..corners.len()).filter(|&k| crosses(k)).count() % 2 == 1
    };
    (0..PIXELS).map(is_inside).collect()
}

fn labels_of(clip: &SegmentedClip, frames: &[Frame]) -> Vec<Vec<u8>> {
    frames_of(clip, frames).into_iter().map(|frame| frame.labels).collect()
}

#[test]
fn an_outline_is_the_object_to_the_pixel() {
    let (frames, truths) = moving_and_resting();
    let start = moving_and_resting_clip();
    let (found, _) = carrier(&labels_of(&start, &frames)[5], &truths[5], 1).unwrap();
    let mut random = Random::from_seed(1);
    for k in 0..12 {
        let mut clip = start.clone();
        // What was found, and a new one; after strokes, a box, or another outline of the same object in the frame.
        let object = [found, 60][k % 2];
        match k % 4 {
            0 => drop(annotate(&mut clip, &frames, painted(5, object, stroke(object, [20, 24, 60, 8])))),
            1 => drop(annotate(&mut clip, &frames, boxed(5, object, [20, 14, 50, 44]))),
            2 => drop(annotate(&mut clip, &frames, painted(5, object, outline(object, |p| p < 40 * SIZE[0])))),
            _ => {}
        }
        let inside = polygon(&mut random, 3 + k % 5);
        annotate(&mut clip, &frames, painted(5, object, outline(object, |p| inside[p])));
        let wrong = |clip: &SegmentedClip, is_its: &dyn Fn(usize) -> bool| {
            let labels = clip.frame(5, &frames[5]).unwrap().labels;
            (0..PIXELS).filter(|&p| (labels[p] == object) != is_its(p)).count()
        };
        assert_eq!(wrong(&clip, &|p| inside[p]), 0, "outline {k}");
        // Also when it is said again in another frame, or something of another one.
        annotate(&mut clip, &frames, painted(8, object, stroke(object, [60, 30, 6, 6])));
        annotate(&mut clip, &frames, boxed(4, 70, [85, 75, 50, 36]));
        assert_eq!(wrong(&clip, &|p| inside[p]), 0, "outline {k} later");
        // Strokes that lie over it change it where they are.
        let over = [30, 60, 40, 30];
        let label = if k % 3 == 0 { 0 } else { object };
        let labels = (0..PIXELS).map(|p| if is_in(p, over) { label } else { object * u8::from(inside[p]) }).collect();
        annotate(&mut clip, &frames, painted(5, object, labels));
        assert_eq!(
            wrong(&clip, &|p| if is_in(p, over) { label > 0 } else { inside[p] }),
            0,
            "strokes over outline {k}"
        );
    }
}

#[test]
fn around_an_outline_and_where_it_is_erased_an_object_takes_nothing_of_what_was_found() {
    let (frames, truths) = moving_and_resting();
    let start = moving_and_resting_clip();
    let found = labels_of(&start, &frames)[5].clone();
    let (number, _) = carrier(&found, &truths[5], 1).unwrap();
    let is_found = |x: usize, y: usize| found[y * SIZE[0] + x] == number;
    let inner = |p: usize| {
        let [x, y] = [p % SIZE[0], p / SIZE[0]];
        (1..SIZE[0] - 1).contains(&x)
            && (1..SIZE[1] - 1).contains(&y)
            && [[x - 1, y], [x + 1, y], [x, y - 1], [x, y + 1]].into_iter().all(|[x, y]| is_found(x, y))
    };
    let erased = |p: usize| if found[p] == number && !inner(p) { 0 } else { 255 };
    let both = (0..PIXELS).map(|p| if inner(p) { 60 } else { erased(p) }).collect();
    for (what, labels) in [("an outline", outline(60, inner)), ("strokes", both)] {
        let mut clip = start.clone();
        annotate(&mut clip, &frames, painted(5, 60, labels));
        let labels = clip.frame(5, &frames[5]).unwrap().labels;
        let taken = (0..PIXELS).filter(|&p| labels[p] == 60 && erased(p) == 0).count();
        assert_eq!(taken, 0, "{what}: pixels of the rim");
        assert!((0..PIXELS).all(|p| !inner(p) || labels[p] == 60), "{what}");
    }
}

#[test]
fn painting_over_an_object_as_a_whole_means_what_is_painted() {
    let (frames, _) = moving_and_resting();
    let mut start = moving_and_resting_clip();
    // Half of what moves: the other half looks and moves alike.
    let half = |t: usize| [10 + 4 * t, 20, 17, 30];
    annotate(&mut start, &frames, painted(2, 60, outline(60, |p| is_in(p, half(2)))));
    for t in [3, 5, 9] {
        let before = start.clone().frame(t, &frames[t]).unwrap().labels;
        for [left, top, right, bottom] in [[0, 0, 0, 0], [4, 0, 0, 0], [0, 5, 2, 3]] {
            let [x, y, width, height] = half(t);
            let sides = [x - left, y - top, width + left + right, height + top + bottom];
            let mut clip = start.clone();
            annotate(&mut clip, &frames, painted(t, 60, stroke(60, sides)));
            let labels = clip.frame(t, &frames[t]).unwrap().labels;
            let is_right = |p: usize| (labels[p] == 60) == (is_in(p, sides) || before[p] == 60);
            assert_eq!((0..PIXELS).filter(|&p| !is_right(p)).count(), 0, "{sides:?} in frame {t}");
        }
    }
}

#[test]
fn a_deleted_object_claims_nothing() {
    let (frames, truths) = moving_and_resting();
    let start = moving_and_resting_clip();
    let thing = |t: usize, object: u8| outline(object, |p| truths[t][p] == 1);
    let anew = |t: usize| painted(t, 61, thing(t, 61));
    let accepted = |t: usize| {
        let accepted = Some(vec![Accepted { frame: t, labels: None }]);
        Annotations { accepted, ..Annotations::default() }
    };
    let click = Click { at: [40, 34], inside: true };
    let clicked = Prompt { frame: 5, object: 60, clicks: vec![click], within: None, spread: Spread::Both };
    let said: Vec<(&str, Vec<Annotations>)> = vec![
        ("an outline", vec![painted(5, 60, outline(60, |p| is_in(p, [20, 10, 70, 60])))]),
        ("strokes", vec![painted(5, 60, stroke(60, [20, 24, 60, 8]))]),
        ("a mask elsewhere", vec![painted(8, 60, thing(8, 60))]),
        ("a box", vec![boxed(5, 60, [20, 10, 60, 50])]),
        ("a click", vec![Annotations { prompts: vec![clicked], ..Annotations::default() }]),
        (
            "a named one",
            vec![painted(5, 60, thing(5, 60)), Annotations { named: Some(vec![60]), ..Annotations::default() }],
        ),
        (
            "one merged into another",
            vec![
                painted(5, 60, thing(5, 60)),
                painted(5, 62, stroke(62, [20, 40, 70, 30])),
                Annotations { numbers: vec![[62, 60]], ..Annotations::default() },
            ],
        ),
    ];
    for (what, said) in said {
        for t in [5, 6] {
            let mut expected = start.clone();
            annotate(&mut expected, &frames, anew(t));
            let expected = labels_of(&expected, &frames);
            let mut clip = start.clone();
            said.iter().for_each(|said| drop(annotate(&mut clip, &frames, said.clone())));
            let mut at_once = clip.clone();
            renumber(&mut clip, 60, 0);
            let clean = SegmentedClip::from_bytes(&clip.to_bytes()).unwrap();
            for mut clip in [clip, clean] {
                annotate(&mut clip, &frames, anew(t));
                assert!(labels_of(&clip, &frames) == expected, "{what}, deleted, and drawn again in frame {t}");
            }
            let both = Annotations { numbers: vec![[60, 0]], ..anew(t) };
            annotate(&mut at_once, &frames, both);
            assert!(labels_of(&at_once, &frames) == expected, "{what}, deleted and drawn again in frame {t} at once");
        }
    }
    // Said and deleted together.
    let mut expected = start.clone();
    annotate(&mut expected, &frames, anew(6));
    let mut clip = start.clone();
    let mut all = anew(6);
    all.corrections.insert(0, Painted { frame: 5, object: Some(60), labels: thing(5, 60), spread: Spread::Both });
    all.prompts = boxed(7, 60, [20, 10, 80, 60]).prompts;
    all.numbers = vec![[60, 0]];
    annotate(&mut clip, &frames, all);
    assert!(labels_of(&clip, &frames) == labels_of(&expected, &frames), "said and deleted together");
    // An accepted frame shows it no more, and another one can be drawn there.
    let mut clip = start;
    annotate(&mut clip, &frames, painted(5, 60, mask(&truths[5], &[(2, 60), (0, 0), (1, 0)])));
    annotate(&mut clip, &frames, accepted(6));
    renumber(&mut clip, 60, 0);
    annotate(&mut clip, &frames, painted(6, 61, outline(61, |p| truths[6][p] == 2)));
    let labels = labels_of(&clip, &frames);
    assert!((0..PIXELS).all(|p| (labels[6][p] == 61) == (truths[6][p] == 2)));
    assert!((0..PIXELS).filter(|&p| truths[7][p] == 2 && labels[7][p] == 61).count() > 800);
}
