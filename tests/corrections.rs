//! Corrections of a clip: what a person says of a frame holds there, follows each object, and disturbs nothing else.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "test code may panic")]

use std::sync::LazyLock;

use crate::support::moving::{
    Thing, annotate, carrier, correct, correct_some, frames_of, mask, moving_and_resting, moving_and_resting_clip,
    one_number, options, renumber, scene_of, thing, whole,
};
use veronese::clip::{Annotations, Click, Painted, Prompt, SegmentedClip, Spread};
use veronese::{Error, Frame, Quality, Random};

/// A small scene, and the clip of it.
#[derive(Clone)]
struct Shot {
    size: [usize; 2],
    frames: Vec<Frame>,
    truths: Vec<Vec<usize>>,
    clip: SegmentedClip,
}

/// Where a prompt points to.
#[derive(Clone, Copy, Debug)]
enum Point {
    Click([usize; 2]),
    Box([usize; 4]),
}

fn prompt(frame: usize, point: Point, object: u8) -> Prompt {
    let (clicks, within) = match point {
        Point::Click(at) => (vec![Click { at, inside: true }], None),
        Point::Box(sides) => (Vec::new(), Some(sides)),
    };
    Prompt { frame, object, clicks, within, spread: Spread::Both }
}

/// A label map of a frame.
type Said = (usize, Vec<u8>, Spread);

impl Shot {
    fn new(size: [usize; 2], things: &[Thing], count: usize) -> Shot {
        let (frames, truths) = scene_of(size, 1, things, count);
        let clip = whole(&frames, options(Quality::Fast, None));
        Shot { size, frames, truths, clip }
    }

    fn correct(&mut self, index: usize, labels: &[u8]) -> Vec<usize> {
        correct(&mut self.clip, &self.frames, index, labels)
    }

    fn say(&mut self, (index, labels, spread): &Said) -> Vec<usize> {
        correct_some(&mut self.clip, &self.frames, *index, labels, *spread)
    }

    /// A label map that is certain of a thing and the ground, and leaves other things open.
    fn mask(&self, index: usize, thing: usize, number: u8) -> Vec<u8> {
        mask(&self.truths[index], &[(0, 0), (thing, number)])
    }

    /// Says a thing's mask in a frame, and nothing of the rest.
    fn give(&mut self, index: usize, thing: usize, number: u8) -> Vec<usize> {
        self.correct(index, &mask(&self.truths[index], &[(thing, number)]))
    }

    fn nothing(&self) -> Vec<u8> {
        vec![255; self.size[0] * self.size[1]]
    }

    /// A filled rectangle.
    fn stroke(&self, number: u8, [x, y, width, height]: [usize; 4]) -> Vec<u8> {
        let inside =
            |p: usize| (x..x + width).contains(&(p % self.size[0])) && (y..y + height).contains(&(p / self.size[0]));
        (0..self.size[0] * self.size[1]).map(|p| if inside(p) { number } else { 255 }).collect()
    }

    /// Points to an object. Returns the frames that change.
    fn point(&mut self, index: usize, point: Point, number: u8) -> Vec<usize> {
        let prompts = vec![prompt(index, point, number)];
        annotate(&mut self.clip, &self.frames, Annotations { prompts, ..Annotations::default() })
    }

    fn lock(&mut self, objects: &[u8]) {
        let locked = Some(objects.to_vec());
        annotate(&mut self.clip, &self.frames, Annotations { locked, ..Annotations::default() });
    }

    fn renumber(&mut self, object: u8, number: u8) {
        renumber(&mut self.clip, object, number);
    }

    /// The smallest rectangle around what is seen of a thing: first column, first row, width, height.
    fn around(&self, index: usize, thing: usize) -> [usize; 4] {
        let of_thing = || (0..self.truths[index].len()).filter(|&p| self.truths[index][p] == thing);
        let [columns, rows] = [0, 1].map(|k| {
            let at = |p: usize| [p % self.size[0], p / self.size[0]][k];
            [of_thing().map(at).min().unwrap(), of_thing().map(at).max().unwrap()]
        });
        [columns[0], rows[0], columns[1] + 1 - columns[0], rows[1] + 1 - rows[0]]
    }

    fn labels(&self) -> Vec<Vec<u8>> {
        frames_of(&self.clip, &self.frames).into_iter().map(|frame| frame.labels).collect()
    }

    /// The number of what moves, as it was found.
    fn found(&self, thing: usize) -> u8 {
        let middle = self.frames.len() / 2;
        let (number, _) = carrier(&self.labels()[middle], &self.truths[middle], thing).unwrap();
        assert_ne!(number, 0, "thing {thing} is found");
        number
    }

    /// Intersection over union of a number and a thing, of each frame in which the thing is seen.
    fn overlaps(&self, thing: usize, number: u8) -> Vec<f64> {
        let iou = |(labels, truth): (Vec<u8>, &Vec<usize>)| {
            let both = labels.iter().zip(truth).map(|(&l, &t)| (l == number, t == thing));
            let (mut all, mut common) = (0, 0);
            both.for_each(|(one, other)| {
                all += usize::from(one || other);
                common += usize::from(one && other);
            });
            truth.contains(&thing).then(|| f64::from(common as u32) / f64::from(all as u32))
        };
        self.labels().into_iter().zip(&self.truths).filter_map(iou).collect()
    }

    /// Everything that is shown and kept.
    fn state(&self) -> (Vec<Vec<u8>>, Vec<String>, Vec<u8>) {
        let frames = frames_of(&self.clip, &self.frames);
        let objects = frames.iter().map(|frame| format!("{:?}", frame.objects)).collect();
        (frames.into_iter().map(|frame| frame.labels).collect(), objects, self.clip.to_bytes())
    }
}

/// One that moves and is found (1), and two that rest (2, 3), so unlike that no pixel could be of two of them.
fn three() -> Shot {
    static MADE: LazyLock<Shot> = LazyLock::new(|| {
        let things = [
            thing(26, [32.0, 26.0], |t| [6.0 + 4.0 * t as f32, 8.0]),
            thing(3, [34.0, 26.0], |_| [86.0, 62.0]),
            thing(14, [28.0, 30.0], |_| [10.0, 60.0]),
        ];
        Shot::new([128, 96], &things, 7)
    });
    MADE.clone()
}

/// Asserts that corrections give the same in any order but for a hundredth of each object: what is there holds unless it looks otherwise.
/// Each is said first once, so that any two are said in both orders.
fn assert_any_order(shot: &Shot, said: &[Said]) {
    let after = |first: usize| {
        let mut shot = shot.clone();
        said[first..].iter().chain(&said[..first]).for_each(|said| drop(shot.say(said)));
        shot.labels().concat()
    };
    let labels = after(0);
    assert_ne!(labels, shot.labels().concat());
    for first in 1..said.len() {
        let other = after(first);
        let (mut common, mut all) = ([0; 256], [0; 256]);
        for (&one, &other) in labels.iter().zip(&other) {
            common[usize::from(one)] += usize::from(one == other);
            all[usize::from(one)] += 1;
            all[usize::from(other)] += usize::from(one != other);
        }
        for (number, (common, all)) in common.iter().zip(all).enumerate() {
            assert!(100 * common >= 99 * all, "{first} is said first: {common} of {all} pixels of {number}");
        }
    }
}

#[test]
fn masks_and_strokes_of_one_object_in_any_order() {
    let shot = three();
    let said = [
        (1, shot.mask(1, 2, 9), Spread::Both),
        (4, shot.stroke(9, [92, 66, 12, 8]), Spread::Both),
        (6, shot.stroke(0, [60, 80, 30, 2]), Spread::Both),
    ];
    assert_any_order(&shot, &said);
}

#[test]
fn two_separate_objects_in_any_order() {
    let shot = three();
    let said = [
        (1, shot.mask(1, 2, 9), Spread::Both),
        (5, shot.mask(5, 3, 11), Spread::Both),
        (3, shot.stroke(11, [16, 66, 10, 10]), Spread::Forward),
    ];
    assert_any_order(&shot, &said);
}

#[test]
fn ground_said_of_a_found_object_and_a_mask_that_takes_it_over_in_any_order() {
    let shot = three();
    let said = [
        (2, shot.stroke(0, [14, 10, 14, 8]), Spread::Both),
        (5, mask(&shot.truths[5], &[(1, 20)]), Spread::Both),
        (3, mask(&shot.truths[3], &[(2, 9)]), Spread::Both),
    ];
    assert_any_order(&shot, &said[..2]);
    assert_any_order(&shot, &said);
}

#[test]
fn a_correction_replaces_the_one_before_in_its_frame_and_can_be_taken_back() {
    let mut shot = three();
    let moving = shot.found(1);
    let found = shot.state();
    // Of one that was found, and of it and an object of one's own.
    for numbers in [&[(1, 30)][..], &[(0, 0), (1, moving), (2, 9)]] {
        let said = mask(&shot.truths[3], numbers);
        let changed = shot.correct(3, &said);
        let once = shot.state();
        assert_eq!(shot.correct(3, &said), [0; 0], "{numbers:?}: the same again");
        assert_eq!(shot.state(), once);
        shot.give(3, 3, 12);
        assert!(shot.clip.frames_with(9).is_empty() && shot.clip.frames_with(30).is_empty(), "{numbers:?}: replaced");
        shot.correct(3, &said);
        let again = shot.state();
        assert_eq!((again.0, again.1), (once.0, once.1), "{numbers:?}: said again after something else");
        assert_eq!(shot.correct(3, &shot.nothing()), changed, "{numbers:?}: taken back");
        let back = shot.state();
        assert_eq!(back.0, found.0, "{numbers:?}: labels");
        assert_eq!(back.1, found.1, "{numbers:?}: objects");
        assert!(back.2 == found.2, "{numbers:?}: bytes");
    }
    // With other corrections of the object and of others before and after.
    shot.correct(1, &shot.mask(1, 2, 9));
    shot.correct(6, &shot.mask(6, 3, 12));
    let before = shot.state();
    for said in [
        mask(&shot.truths[4], &[(2, 9), (3, 12), (1, 40)]),
        shot.stroke(0, [86, 62, 10, 10]),
        shot.stroke(12, [60, 40, 9, 9]),
    ] {
        shot.correct(4, &said);
        assert!(shot.state().0 != before.0);
        shot.correct(4, &shot.nothing());
        let back = shot.state();
        assert_eq!(differing(&back.0, &before.0), [0; 0]);
        assert_eq!(back.1, before.1);
        assert!(back.2 == before.2);
    }
}

#[test]
fn what_is_said_together_spreads_in_one_pass_in_any_order() {
    let shot = three();
    let painted = |frame: usize, object: u8, labels: Vec<u8>| {
        let labels = labels.into_iter().map(|label| if label == 0 || label == object { label } else { 255 }).collect();
        Painted { frame, object: Some(object), labels, spread: Spread::Both }
    };
    let moving = shot.found(1);
    let corrections = [
        painted(1, 9, mask(&shot.truths[1], &[(2, 9)])),
        painted(3, moving, shot.stroke(0, [14, 8, 12, 10])),
        painted(5, 9, shot.stroke(9, [92, 66, 12, 8])),
    ];
    let prompts = [(2, 3), (6, 3)].map(|(frame, thing)| prompt(frame, prompts_of(&shot, frame, thing)[0], 40));
    let said = |turn: usize| {
        let (mut corrections, mut prompts) = (corrections.to_vec(), prompts.to_vec());
        corrections.rotate_left(turn);
        prompts.rotate_left(turn % 2);
        let mut shot = shot.clone();
        let mut job = shot.clip.annotate(Annotations { corrections, prompts, ..Annotations::default() }).unwrap();
        let mut taken = 0;
        while let Some(wanted) = job.wanted() {
            job.take(&mut shot.clip, &shot.frames[wanted]).unwrap();
            taken += 1;
        }
        // The annotated frames, then each frame to learn from it and on the ways forward and back.
        assert!(taken <= 5 + 3 * shot.frames.len(), "{taken} frames");
        shot.labels()
    };
    let labels = said(0);
    assert_ne!(labels, shot.labels());
    for turn in 1..3 {
        assert_eq!(differing(&said(turn), &labels), [0; 0], "{turn}");
    }
}

/// Two of a person that cross, close to one that was found and to one another.
fn crossing() -> Shot {
    static MADE: LazyLock<Shot> = LazyLock::new(|| {
        let things = [
            thing(2, [24.0, 22.0], |t| [6.0 + 7.0 * t as f32, 34.0]),
            thing(3, [26.0, 30.0], |t| [88.0 - 7.0 * t as f32, 38.0]),
            thing(7, [30.0, 22.0], |t| [40.0 + 2.0 * t as f32, 10.0]),
            thing(9, [30.0, 20.0], |_| [60.0, 74.0]),
            thing(11, [24.0, 20.0], |_| [90.0, 74.0]),
        ];
        Shot::new([128, 96], &things, 8)
    });
    MADE.clone()
}

#[test]
fn other_objects_of_a_person_keep_every_pixel() {
    let start = crossing();
    // Crossing ones, and adjacent ones that rest.
    for (one, other) in [(1, 2), (5, 4), (3, 1)] {
        for spread in if one == 1 { &[Spread::Both, Spread::None][..] } else { &[Spread::Both] } {
            let mut shot = start.clone();
            shot.give(1, one, 100);
            let before = shot.labels();
            for (t, number) in [(6, 101), (2, 101), (0, 102)] {
                // Of what is the first one's in that frame already, nothing is said.
                let mut said = mask(&shot.truths[t], &[(other, number)]);
                said.iter_mut().zip(&before[t]).filter(|(_, l)| **l == 100).for_each(|(said, _)| *said = 255);
                shot.say(&(t, said, *spread));
                for (t, (before, after)) in before.iter().zip(shot.labels()).enumerate() {
                    let differ = before.iter().zip(&after).filter(|(a, b)| (**a == 100) != (**b == 100)).count();
                    assert_eq!(differ, 0, "{one} while {other} is corrected, {spread:?}, frame {t}");
                }
            }
        }
    }
}

#[test]
fn one_that_loses_a_pixel_to_another_is_still_followed_from_where_it_was_said() {
    let things = [
        thing(26, [28.0, 24.0], |t| [6.0 + 6.0 * t as f32, 10.0]),
        thing(3, [28.0, 24.0], |t| [90.0 - 5.0 * t as f32, 60.0]),
    ];
    let mut shot = Shot::new([128, 96], &things, 8);
    shot.correct(2, &shot.mask(2, 1, 50));
    let before = shot.labels();
    // The corner of the first one, and the second one.
    let mut said = shot.mask(6, 2, 51);
    let corner = (0..said.len()).find(|&p| shot.truths[6][p] == 1).unwrap();
    said[corner] = 51;
    shot.correct(6, &said);
    for (t, (before, after)) in before.iter().zip(shot.labels()).enumerate().take(6) {
        let same = |(&b, &a): (&u8, &u8)| (b == 50) == (a == 50) || a == 51;
        assert!(before.iter().zip(&after).all(same), "frame {t}");
    }
    let overlaps = [shot.overlaps(1, 50), shot.overlaps(2, 51)];
    assert!(overlaps.iter().flatten().all(|&iou| iou > 0.9), "{overlaps:.3?}");
}

#[test]
fn found_objects_change_by_pixels_taken_and_given_back_and_locked_ones_not_at_all() {
    let mut shot = crossing();
    let found = shot.labels();
    let number = shot.found(3);
    let objects = shot.clip.objects();
    // A corner of what was found, and something beside it.
    let said = |shot: &Shot| shot.stroke(200, [46, 24, 40, 14]);
    shot.correct(4, &said(&shot));
    for (before, after) in found.iter().zip(shot.labels()) {
        // The rest of an object of which the other one has most is none any more.
        let mut sizes = [[0; 2]; 256];
        for (&b, &a) in before.iter().zip(&after) {
            sizes[usize::from(b)][0] += 1;
            sizes[usize::from(b)][1] += usize::from(a == 200);
        }
        let yields = |label: u8| 2 * sizes[usize::from(label)][1] > sizes[usize::from(label)][0];
        assert!(before.iter().zip(&after).all(|(&b, &a)| a == b || a == 200 || a == 0 && yields(b)));
    }
    shot.correct(4, &shot.nothing());
    assert_eq!(shot.labels(), found);
    shot.lock(&objects);
    for labels in [said(&shot), mask(&shot.truths[4], &[(3, 200)]), vec![200; 128 * 96], vec![0; 128 * 96]] {
        shot.correct(4, &labels);
        for (before, after) in found.iter().zip(shot.labels()) {
            assert!(before.iter().zip(&after).all(|(b, a)| *b == 0 || a == b));
        }
    }
    // The annotation holds where nothing locked is.
    shot.correct(4, &vec![200; 128 * 96]);
    assert!(found[4].iter().zip(&shot.labels()[4]).all(|(b, a)| *b != 0 || *a == 200));
    // Unlocked, it can be taken.
    shot.lock(&[]);
    shot.give(4, 3, 201);
    assert!(!shot.labels()[4].contains(&number));
}

#[test]
fn one_that_is_locked_together_with_its_mask_has_the_mask() {
    let mut shot = crossing();
    let corrections = vec![Painted { frame: 0, object: None, labels: shot.mask(0, 1, 1), spread: Spread::Both }];
    let mut unlocked = shot.clone();
    annotate(
        &mut unlocked.clip,
        &unlocked.frames,
        Annotations { corrections: corrections.clone(), ..Annotations::default() },
    );
    annotate(
        &mut shot.clip,
        &shot.frames,
        Annotations { corrections, locked: Some(vec![1]), ..Annotations::default() },
    );
    assert_eq!(shot.labels(), unlocked.labels());
    // From now on it is locked.
    let more = vec![Painted { frame: 1, object: None, labels: shot.mask(1, 1, 1), spread: Spread::Both }];
    let error = shot.clip.annotate(Annotations { corrections: more, ..Annotations::default() }).unwrap_err();
    assert!(matches!(error, Error::ObjectLocked { object: 1 }), "{error}");
    // It does not grow by another one either.
    let other = (2..255).find(|&k| !shot.clip.frames_with(k).is_empty()).unwrap();
    let error = shot.clip.annotate(Annotations { numbers: vec![[other, 1]], ..Annotations::default() }).unwrap_err();
    assert!(matches!(error, Error::ObjectLocked { object: 1 }), "{error}");
}

#[test]
fn deleting_gives_back_what_was_found_and_merging_keeps_both() {
    let start = three();
    let (number, found) = (start.found(1), start.state());
    // One of the ground, and one over what was found.
    for thing in [2, 1] {
        let mut shot = start.clone();
        shot.give(3, thing, 60);
        assert_ne!(shot.labels(), found.0);
        shot.renumber(60, 0);
        let after = shot.state();
        assert_eq!(after.0, found.0, "thing {thing}: labels");
        assert_eq!(after.1, found.1, "thing {thing}: objects");
    }
    // Also of part of what was found.
    for (from, into) in [(60, number), (number, 60)] {
        for said in
            [start.stroke(60, [14, 8, 20, 10]), mask(&start.truths[3], &[(2, 60)]), start.stroke(60, [20, 9, 40, 22])]
        {
            let mut shot = start.clone();
            shot.correct(3, &said);
            let before = shot.labels();
            shot.renumber(from, into);
            for (t, (before, after)) in before.iter().zip(shot.labels()).enumerate() {
                let merged: Vec<u8> = before.iter().map(|&l| if l == from { into } else { l }).collect();
                assert!(merged == after, "{from} into {into}, frame {t}");
            }
        }
    }
}

#[test]
fn merged_objects_are_one_to_what_is_said_of_them() {
    // Two that are found go together from now on; a dab on one of them says nothing of where both are.
    let start = crossing();
    let (one, other) = (start.found(1), start.found(3));
    let mut shot = start.clone();
    shot.renumber(other, one);
    let before = shot.labels();
    let [x, y, width, height] = shot.around(2, 3);
    shot.correct(2, &shot.stroke(one, [x + width / 4, y + height / 4, width / 2, height / 2]));
    for (t, (before, after)) in before.iter().zip(shot.labels()).enumerate() {
        let [kept, lost] = [true, false]
            .map(|is_kept| before.iter().zip(&after).filter(|(b, a)| **b == one && (**a == one) == is_kept).count());
        assert!(100 * lost <= kept, "frame {t}: {lost} pixels are lost, {kept} are kept");
    }
}

/// One that moves, in large and in small frames of odd sides.
fn full_and_small() -> [Shot; 2] {
    static MADE: LazyLock<[Shot; 2]> = LazyLock::new(|| {
        let things = [thing(2, [80.0, 70.0], |t| [20.0 + 6.0 * t as f32, 16.0])];
        [[963, 541], [131, 97]].map(|size| Shot::new(size, &things, 2))
    });
    MADE.clone()
}

#[test]
fn exact_pixels_stay_exact_at_full_size() {
    for mut shot in full_and_small() {
        let size = shot.size;
        let mut random = Random::from_seed(5);
        // Single pixels, also those of the last column and row, and blocks.
        let said: Vec<u8> = (0..size[0] * size[1])
            .map(|p| {
                let block = (p % size[0] / 37 + p / size[0] / 23) % 3;
                let any = [0, 5, 9, 255][random.uniform(0.0, 4.0) as usize];
                [any, 255, 9][block]
            })
            .collect();
        shot.correct(0, &said);
        assert!(shot.labels()[0].iter().zip(&said).all(|(label, said)| *said == 255 || label == said), "{size:?}");
        let whole: Vec<u8> = said.iter().map(|&l| if l == 255 { 7 } else { l }).collect();
        shot.correct(1, &whole);
        assert_eq!(shot.labels()[1], whole);
        assert!(shot.labels()[0].iter().zip(&said).all(|(label, said)| *said == 255 || label == said), "{size:?}");
    }
}

/// A box with some room around each thing, and a click in its middle.
fn prompts_of(shot: &Shot, index: usize, thing: usize) -> [Point; 2] {
    let [x, y, width, height] = shot.around(index, thing);
    let [left, top] = [x, y].map(|from| from.saturating_sub(3));
    let [right, bottom] = [(x + width + 3).min(shot.size[0]), (y + height + 3).min(shot.size[1])];
    [Point::Box([left, top, right - left, bottom - top]), Point::Click([x + width / 2, y + height / 2])]
}

#[test]
fn a_box_and_a_click_give_what_was_found_and_what_was_not_and_these_follow_it() {
    let start = three();
    for thing in [1, 2, 3] {
        for prompt in prompts_of(&start, 3, thing) {
            let mut shot = start.clone();
            let before = shot.labels();
            shot.point(3, prompt, 90);
            // Other objects are left as they are.
            let same = |(now, label): (&u8, &u8)| label == now || *label == 90;
            let pixels = before.iter().flatten().zip(shot.labels().into_iter().flatten().collect::<Vec<_>>());
            for (now, label) in pixels {
                assert!(same((now, &label)), "thing {thing}, {prompt:?}: {now} became {label}");
            }
            let overlaps = shot.overlaps(thing, 90);
            assert!(overlaps.iter().all(|&iou| iou > 0.85), "thing {thing}, {prompt:?}: {overlaps:.3?}");
        }
    }
}

#[test]
fn what_was_found_elsewhere_stays_at_full_size() {
    let things = [
        thing(26, [110.0, 90.0], |t| [20.0 + 8.0 * t as f32, 24.0]),
        thing(3, [120.0, 90.0], |_| [300.0, 190.0]),
        thing(14, [100.0, 100.0], |t| [330.0 - 8.0 * t as f32, 40.0]),
    ];
    let start = Shot::new([480, 320], &things, 5);
    let before = start.labels();
    // A box around one that rests, and a click on one of two that move.
    for (thing, kind, others) in [(2, 0, &[1, 3][..]), (3, 1, &[1])] {
        let prompt = prompts_of(&start, 2, thing)[kind];
        let mut shot = start.clone();
        shot.point(2, prompt, 90);
        assert!(shot.overlaps(thing, 90).iter().all(|&iou| iou > 0.85), "thing {thing}, {prompt:?}");
        for number in others.iter().map(|&other| start.found(other)) {
            for (t, (before, after)) in before.iter().zip(shot.labels()).enumerate() {
                let stays = before.iter().zip(&after).all(|(b, a)| (*b == number) == (*a == number) || *a == 90);
                assert!(stays, "thing {thing}, {prompt:?}, frame {t}: object {number}");
            }
        }
    }
}

#[test]
fn a_box_holds_its_object_and_a_click_is_in_its_own_at_full_size() {
    for shot in full_and_small() {
        let size = shot.size;
        let mut random = Random::from_seed(8);
        let mut below = |limit: usize| random.uniform(0.0, limit as f64) as usize;
        let [width, height] = size;
        // Single pixels, corners and the whole frame, and any others.
        let mut boxes = vec![[0, 0, width, height], [width - 1, height - 1, 1, 1], [0, 3, 1, height - 3], [7, 7, 1, 1]];
        boxes.extend([(); 4].map(|()| {
            let [x, y] = [below(width), below(height)];
            [x, y, 1 + below(width - x), 1 + below(height - y)]
        }));
        let first = |t: usize, point: Point| {
            let mut shot = shot.clone();
            shot.point(t, point, 7);
            shot.clip.frame(t, &shot.frames[t]).unwrap().labels
        };
        for [x, y, columns, rows] in boxes {
            let labels = first(1, Point::Box([x, y, columns, rows]));
            let inside = |p: usize| (x..x + columns).contains(&(p % width)) && (y..y + rows).contains(&(p / width));
            assert!((0..labels.len()).all(|p| labels[p] != 7 || inside(p)), "{size:?}, box {x} {y} {columns} {rows}");
            assert!(labels.contains(&7), "{size:?}, box {x} {y} {columns} {rows}");
        }
        for [x, y] in [[0, 0], [width - 1, height - 1], [below(width), below(height)], [below(width), below(height)]] {
            assert_eq!(first(0, Point::Click([x, y]))[y * width + x], 7, "{size:?}, click {x} {y}");
        }
    }
}

#[test]
fn clicks_and_a_box_describe_one_object() {
    // Two patches of one colour in a box; a click says that the second, separate one is not meant, another that it is after all.
    let things = [thing(5, [26.0, 26.0], |_| [14.0, 30.0]), thing(5, [24.0, 24.0], |_| [70.0, 32.0])];
    let start = Shot::new([128, 96], &things, 4);
    let middle = |thing: usize| {
        let [x, y, width, height] = start.around(1, thing);
        [x + width / 2, y + height / 2]
    };
    let of = |clicks: &[(usize, bool)], within: Option<[usize; 4]>| {
        let mut shot = start.clone();
        let clicks = clicks.iter().map(|&(thing, inside)| Click { at: middle(thing), inside }).collect();
        let prompts = vec![Prompt { frame: 1, object: 9, clicks, within, spread: Spread::Both }];
        annotate(&mut shot.clip, &shot.frames, Annotations { prompts, ..Annotations::default() });
        [1, 2].map(|thing| {
            let count = |(labels, truth): (&Vec<u8>, &Vec<usize>)| {
                let own: Vec<u8> = labels.iter().zip(truth).filter(|(_, t)| **t == thing).map(|(l, _)| *l).collect();
                own.iter().filter(|label| **label == 9).count() as f64 / own.len() as f64
            };
            let shares: Vec<f64> = shot.labels().iter().zip(&shot.truths).map(count).collect();
            shares.iter().sum::<f64>() / shares.len() as f64
        })
    };
    let within = Some([4, 20, 100, 46]);
    let [one, two] = of(&[(1, true)], None);
    assert!(one > 0.9 && two < 0.1, "{one} {two}");
    let [one, two] = of(&[(1, true), (2, true)], None);
    assert!(one > 0.9 && two > 0.9, "{one} {two}");
    let [one, two] = of(&[(1, true), (2, false)], within);
    assert!(one > 0.9 && two < 0.1, "{one} {two}");
    let [one, two] = of(&[(1, true), (2, true)], within);
    assert!(one > 0.9 && two > 0.9, "{one} {two}");
    // Taken back, nothing is left.
    let mut shot = start.clone();
    let before = shot.state();
    shot.point(1, Point::Click(middle(1)), 9);
    assert!(shot.state() != before);
    let prompts = vec![Prompt { frame: 1, object: 9, clicks: Vec::new(), within: None, spread: Spread::Both }];
    annotate(&mut shot.clip, &shot.frames, Annotations { prompts, ..Annotations::default() });
    assert!(shot.state() == before);
}

#[test]
fn a_click_changes_only_what_it_says() {
    // One thing before another, and clicks all over the frame after one on the first.
    let things = [thing(5, [40.0, 40.0], |_| [20.0, 24.0]), thing(6, [36.0, 30.0], |_| [54.0, 40.0])];
    let start = Shot::new([128, 96], &things, 2);
    let first = Click { at: [34, 40], inside: true };
    let masked = |clicks: Vec<Click>| -> Vec<bool> {
        let mut shot = start.clone();
        let prompts = vec![Prompt { frame: 0, object: 9, clicks, within: None, spread: Spread::Both }];
        annotate(&mut shot.clip, &shot.frames, Annotations { prompts, ..Annotations::default() });
        shot.labels()[0].iter().map(|&label| label == 9).collect()
    };
    let before = masked(vec![first]);
    let mut changes = [0, 0];
    for at in [[24, 30], [50, 60], [70, 55], [85, 66], [110, 20], [10, 85]] {
        let p = at[1] * 128 + at[0];
        let now = masked(vec![first, Click { at, inside: !before[p] }]);
        assert_eq!(now[p], !before[p], "{at:?}");
        assert!((0..now.len()).all(|k| now[k] == before[k] || now[k] != before[p]), "{at:?}");
        let parts = components_of(&now, &before);
        assert_eq!(parts, 1, "{at:?}");
        changes[usize::from(before[p])] += 1;
        assert_eq!(masked(vec![first, Click { at, inside: before[p] }]), before, "{at:?}");
    }
    assert!(changes.iter().all(|count| *count > 0), "{changes:?}");
}

/// Number of connected parts in which two masks that are 128 wide differ.
fn components_of(one: &[bool], other: &[bool]) -> usize {
    let mut differs: Vec<bool> = one.iter().zip(other).map(|(a, b)| a != b).collect();
    let mut count = 0;
    while let Some(start) = differs.iter().position(|differs| *differs) {
        count += 1;
        let mut waiting = vec![start];
        while let Some(p) = waiting.pop() {
            if std::mem::take(&mut differs[p]) {
                let near =
                    [p.checked_sub(128), Some(p + 128), (p % 128 > 0).then(|| p - 1), (p % 128 < 127).then(|| p + 1)];
                waiting.extend(near.into_iter().flatten().filter(|q| *q < differs.len()));
            }
        }
    }
    count
}

#[test]
fn an_eraser_through_a_separate_piece_removes_the_piece_and_gives_it_back() {
    let things = [thing(5, [40.0, 30.0], |_| [8.0, 30.0]), thing(9, [26.0, 20.0], |_| [70.0, 32.0])];
    let mut shot = Shot::new([128, 96], &things, 4);
    shot.correct(0, &mask(&shot.truths[0], &[(0, 0), (1, 9), (2, 9)]));
    let before = shot.labels();
    let [x, y, width, height] = shot.around(2, 2);
    let strip = shot.stroke(0, [x, y + height / 2, width, 2]);
    let erase = |shot: &mut Shot, labels: Vec<u8>| {
        let corrections = vec![Painted { frame: 2, object: Some(9), labels, spread: Spread::Both }];
        annotate(&mut shot.clip, &shot.frames, Annotations { corrections, ..Annotations::default() });
        shot.labels()
    };
    let erased = erase(&mut shot, strip);
    let is_piece = |p: usize| p % 128 >= 60;
    let left = (0..128 * 96).filter(|&p| is_piece(p) && erased[2][p] == 9).count();
    let other = (0..128 * 96).filter(|&p| !is_piece(p) && erased[2][p] != before[2][p]).count();
    assert_eq!([left, other], [0, 0], "pixels of the piece that are left, and others that have changed");
    assert_eq!(erased[0], before[0], "the mask that was given stays");
    assert!(erase(&mut shot, vec![255; 128 * 96]) == before);
}

#[test]
fn frames_from_which_an_object_that_was_found_is_erased_as_a_whole_have_changed() {
    let mut shot = three();
    let before = shot.labels();
    let object = *before[2].iter().find(|label| (1..255).contains(*label)).unwrap();
    let labels = before[2].iter().map(|&label| if label == object { 0 } else { 255 }).collect();
    let corrections = vec![Painted { frame: 2, object: Some(object), labels, spread: Spread::Both }];
    let changed = annotate(&mut shot.clip, &shot.frames, Annotations { corrections, ..Annotations::default() });
    let now = shot.labels();
    assert!(!now[2].contains(&object));
    let silent: Vec<usize> = (0..now.len()).filter(|t| now[*t] != before[*t] && !changed.contains(t)).collect();
    assert!(silent.is_empty(), "frames {silent:?} have changed, besides {changed:?}");
}

#[test]
fn a_prompt_takes_nothing_from_other_objects_of_a_person_and_must_be_within_the_frame() {
    let mut shot = three();
    let prompts = prompts_of(&shot, 2, 3);
    // One that is said in the same frame, within the other, and one that comes from another frame; both are not locked.
    shot.correct(2, &shot.stroke(30, [10, 60, 12, 12]));
    shot.correct(5, &shot.mask(5, 2, 31));
    let now = shot.labels();
    for prompt in prompts {
        let mut shot = shot.clone();
        shot.point(2, prompt, 9);
        for (t, (before, after)) in now.iter().zip(shot.labels()).enumerate() {
            let keeps = before.iter().zip(&after).all(|(b, a)| ![30, 31].contains(b) || a == b);
            assert!(keeps, "{prompt:?}, frame {t}");
        }
    }

    let mut fails = |index, point, number| {
        let prompts = vec![prompt(index, point, number)];
        match shot.clip.annotate(Annotations { prompts, ..Annotations::default() }) {
            Err(Error::InvalidOption { name, .. }) => name,
            other => panic!("{other:?}"),
        }
    };
    for sides in [[0, 0, 0, 5], [0, 0, 5, 0], [128, 0, 1, 1], [0, 95, 1, 2], [100, 0, 29, 5], [1, 1, usize::MAX, 1]] {
        assert_eq!(fails(0, Point::Box(sides), 9), "box", "{sides:?}");
    }
    for at in [[128, 0], [0, 96], [usize::MAX, usize::MAX]] {
        assert_eq!(fails(0, Point::Click(at), 9), "click", "{at:?}");
    }
    for number in [0, 255] {
        assert_eq!(fails(0, prompts[0], number), "label");
    }
    assert_eq!(fails(7, prompts[0], 9), "frame");
}

/// Frames whose labels differ.
fn differing(one: &[Vec<u8>], other: &[Vec<u8>]) -> Vec<usize> {
    (0..one.len()).filter(|&t| one[t] != other[t]).collect()
}

#[test]
fn corrections_spread_where_they_are_told_to() {
    let start = three();
    let (number, found) = (start.found(1), start.labels());
    let [erased, part] = [start.stroke(0, [20, 8, 12, 12]), start.stroke(number, [30, 20, 40, 20])];
    for said in [mask(&start.truths[3], &[(2, 9)]), mask(&start.truths[3], &[(1, 9)]), erased, part] {
        for (spread, frames) in
            [(Spread::None, 3..4), (Spread::Forward, 3..7), (Spread::Backward, 0..4), (Spread::Both, 0..7)]
        {
            let mut shot = start.clone();
            let changed = shot.say(&(3, said.clone(), spread));
            let differ = differing(&found, &shot.labels());
            assert!(differ.iter().all(|t| frames.contains(t)), "{spread:?}: {differ:?}");
            assert!(differ.contains(&3));
            // Of a frame that looks the same, the confidences may have changed.
            assert!(differ.iter().all(|t| changed.contains(t)) && changed.iter().all(|t| frames.contains(t)));
        }
    }
}

#[test]
fn two_frames_with_different_spreads() {
    let mut shot = three();
    let truths = shot.truths.clone();
    let said = |t: usize, spread| (t, mask(&truths[t], &[(2, 9)]), spread);
    shot.say(&said(2, Spread::Backward));
    assert_eq!(shot.clip.frames_with(9), [0, 1, 2]);
    shot.say(&said(5, Spread::None));
    assert_eq!(shot.clip.frames_with(9), [0, 1, 2, 5]);
    let before = shot.labels();
    shot.say(&said(4, Spread::Forward));
    assert_eq!(shot.clip.frames_with(9), [0, 1, 2, 4, 5, 6]);
    let differ = differing(&before, &shot.labels());
    assert!(differ.iter().all(|t| [4, 5, 6].contains(t)), "{differ:?}");
    shot.say(&(4, shot.nothing(), Spread::Both));
    assert_eq!(shot.labels(), before);
}

#[test]
fn nothing_crosses_a_cut() {
    let size = [128, 96];
    let one = [thing(2, [32.0, 26.0], |t| [6.0 + 4.0 * t as f32, 8.0]), thing(3, [34.0, 26.0], |_| [86.0, 62.0])];
    let (mut frames, mut truths) = scene_of(size, 1, &one, 5);
    let (after, after_truths) = scene_of(size, 5, &[thing(6, [36.0, 30.0], |t| [4.0 + 4.0 * t as f32, 40.0])], 10);
    frames.extend(after.into_iter().skip(5));
    truths.extend(after_truths.into_iter().skip(5));
    let clip = whole(&frames, options(Quality::Fast, None));
    let mut shot = Shot { size, frames, truths, clip };
    let found = shot.labels();
    for (t, scene) in [(2, 0..5), (4, 0..5), (5, 5..10), (8, 5..10)] {
        for said in [vec![9; size[0] * size[1]], shot.stroke(9, [20, 20, 40, 40]), vec![0; size[0] * size[1]]] {
            shot.correct(t, &said);
            let differ = differing(&found, &shot.labels());
            assert!(differ.contains(&t) && differ.iter().all(|t| scene.contains(t)), "said of {t}: {differ:?}");
            shot.correct(t, &shot.nothing());
            assert_eq!(shot.labels(), found);
        }
    }
}

#[test]
fn a_given_mask_follows_what_moves() {
    let things = [
        thing(2, [32.0, 26.0], |t| [6.0 + 4.0 * t as f32, 8.0]),
        thing(3, [30.0, 28.0], |t| [90.0 - 3.0 * t as f32, 60.0 - 2.0 * t as f32]),
    ];
    let start = Shot::new([128, 96], &things, 9);
    for t in [0, 4, 8] {
        let mut shot = start.clone();
        shot.correct(t, &shot.mask(t, 1, 50));
        let overlaps = shot.overlaps(1, 50);
        assert!(overlaps.iter().all(|&iou| iou >= 0.9), "said of {t}: {overlaps:.3?}");
    }
}

#[test]
fn strokes_alone_make_an_object_that_is_followed() {
    let mut shot = three();
    let mut said = shot.stroke(9, [92, 68, 20, 12]);
    said.iter_mut().zip(shot.stroke(0, [70, 50, 8, 44])).filter(|(_, s)| *s == 0).for_each(|(said, _)| *said = 0);
    said.iter_mut().zip(shot.stroke(0, [70, 50, 56, 6])).filter(|(_, s)| *s == 0).for_each(|(said, _)| *said = 0);
    shot.correct(3, &said);
    let overlaps = shot.overlaps(2, 9);
    assert!(overlaps.len() == 7 && overlaps.iter().all(|&iou| iou > 0.85), "{overlaps:.3?}");
}

#[test]
fn one_that_is_hidden_for_some_frames_keeps_its_number() {
    let things = [
        thing(2, [24.0, 22.0], |t| [6.0 + 6.0 * t as f32, 36.0]),
        thing(3, [34.0, 40.0], |t| [86.0 - 5.0 * t as f32, 28.0]),
    ];
    let mut shot = Shot::new([128, 96], &things, 14);
    let hidden: Vec<usize> = (0..14).filter(|&t| shot.truths[t].iter().filter(|&&l| l == 1).count() < 40).collect();
    assert!(!hidden.is_empty() && hidden[0] > 1 && hidden[hidden.len() - 1] < 11, "{hidden:?}");
    shot.correct(0, &mask(&shot.truths[0], &[(1, 50), (2, 51)]));
    let labels = shot.labels();
    for t in (0..hidden[0] - 1).chain(hidden[hidden.len() - 1] + 3..14) {
        for (thing, number) in [(1, 50), (2, 51)] {
            let (label, iou) = carrier(&labels[t], &shot.truths[t], thing).unwrap();
            assert!(label == number && iou > 0.7, "frame {t}, thing {thing}: {label}, {iou:.3}");
        }
    }
}

#[test]
fn extremes_are_taken_as_they_are() {
    let size @ [width, height] = [16, 16];
    let things = [thing(2, [7.0, 6.0], |t| [2.0 + t as f32, 4.0])];
    let pixels = width * height;
    let at = |p: usize, number: u8| {
        let mut said = vec![255; pixels];
        said[p] = number;
        said
    };
    let numbers: Vec<u8> = (0..pixels).map(|p| (p * 254 / pixels) as u8 + 1).collect();
    let said = [
        vec![255; pixels],
        at(0, 1),
        at(pixels - 1, 254),
        at(pixels / 2, 0),
        vec![254; pixels],
        vec![0; pixels],
        numbers,
        (0..pixels).map(|p| p as u8).collect(),
    ];
    let start = Shot::new(size, &things, 2);
    let mut kept = start.clone();
    for (k, said) in said.iter().enumerate() {
        // Alone, and after all that was said before.
        let mut shot = start.clone();
        shot.correct(1, said);
        // More frames with all numbers would take long.
        if k < 7 {
            kept.correct(k % 2, said);
        }
        for labels in [&shot.labels()[1], &kept.labels()[k % 2]].into_iter().take(if k < 7 { 2 } else { 1 }) {
            assert!(labels.iter().zip(said).all(|(label, said)| *said == 255 || label == said), "{k}");
        }
    }
    // Of a clip of one frame.
    let mut shot = Shot::new([16, 16], &[], 1);
    assert_eq!(shot.correct(0, &[254; 256]), [0]);
    assert_eq!(shot.labels()[0], [254; 256]);
}

#[test]
fn a_restored_clip_goes_on_with_the_same_bits() {
    let mut shot = three();
    let number = shot.found(1);
    shot.lock(&[number]);
    shot.give(1, 2, 9);
    shot.say(&(4, shot.stroke(12, [16, 66, 10, 10]), Spread::Forward));
    let clip = SegmentedClip::from_bytes(&shot.clip.to_bytes()).unwrap();
    let mut again = Shot { clip, ..shot.clone() };
    for shot in [&mut shot, &mut again] {
        shot.correct(5, &mask(&shot.truths[5], &[(2, 9), (0, 0)]));
        shot.correct(1, &shot.nothing());
        shot.renumber(12, 9);
    }
    assert!(shot.state() == again.state());
}

#[test]
fn a_corrected_mask_holds_and_spreads_both_ways() {
    let (frames, truths) = moving_and_resting();
    let mut clip = moving_and_resting_clip();
    let before = frames_of(&clip, &frames);
    assert_eq!(carrier(&before[5].labels, &truths[5], 2).unwrap().0, 0, "what rests is background");
    let moving = one_number(&before, &truths, 1, 0..12);

    let mask = mask(&truths[5], &[(0, 0), (1, moving), (2, 9)]);
    let changed = correct(&mut clip, &frames, 5, &mask);
    assert!(changed.len() > 8, "{changed:?}");
    let after = frames_of(&clip, &frames);
    assert_eq!(after[5].labels, mask, "the mask holds to the pixel");
    assert_eq!(one_number(&after, &truths, 2, 1..11), 9);
    assert_eq!(one_number(&after, &truths, 1, 0..12), moving);

    // Nothing said in the same frame takes it all back.
    let restored = correct(&mut clip, &frames, 5, &[255; 160 * 120]);
    assert_eq!(restored, changed);
    for (restored, before) in frames_of(&clip, &frames).iter().zip(&before) {
        assert_eq!(restored.labels, before.labels);
    }
}

#[test]
fn objects_can_be_merged_and_removed() {
    let (frames, truths) = moving_and_resting();
    let mut clip = moving_and_resting_clip();
    correct(&mut clip, &frames, 5, &mask(&truths[5], &[(2, 30)]));
    let moving = one_number(&frames_of(&clip, &frames), &truths, 1, 0..12);
    let all: Vec<usize> = (0..12).collect();
    let with_resting = clip.frames_with(30);
    assert!(clip.frames_with(moving) == all && with_resting.contains(&5));
    for (object, number) in [(moving, 31), (31, moving), (31, 0), (31, 32)] {
        assert!(renumber(&mut clip, object, number).is_empty(), "no object has the number 31 or 32");
    }
    assert_eq!((clip.frames_with(moving), clip.frames_with(30)), (all.clone(), with_resting));
    assert_eq!(renumber(&mut clip, moving, 30), all);
    assert_eq!((clip.frames_with(moving), clip.frames_with(30)), (vec![], all.clone()));
    let merged = frames_of(&clip, &frames);
    assert!(merged.iter().all(|frame| frame.objects.iter().map(|object| object.id).eq([30])));
    assert!(merged[5].labels.iter().zip(&truths[5]).all(|(&label, &thing)| thing != 2 || label == 30));
    assert_eq!(renumber(&mut clip, 30, 0), all);
    assert!(
        frames_of(&clip, &frames).iter().all(|frame| frame.labels.iter().all(|&label| label != moving && label != 30))
    );
}

/// Keeps numbers free for masks that are not given yet. Returns the frames that change.
fn reserve(clip: &mut SegmentedClip, numbers: &[u8]) -> Vec<usize> {
    let [width, height] = clip.size();
    let labels = (0..width * height).map(|p| numbers.get(p).copied().unwrap_or(255)).collect();
    let masks = vec![Painted { frame: 0, object: None, labels, spread: Spread::Both }];
    clip.annotate(Annotations { masks, ..Annotations::default() }).unwrap().changed().to_vec()
}

#[test]
fn reserved_numbers_are_free_for_objects_of_a_person() {
    let (frames, truths) = moving_and_resting();
    let mut clip = moving_and_resting_clip();
    let found = frames_of(&clip, &frames);
    let (number, _) = carrier(&found[3].labels, &truths[3], 1).unwrap();
    let ids: Vec<u8> = (1..255).filter(|&id| !clip.frames_with(id).is_empty()).collect();
    assert!(number != 0 && ids.contains(&number));
    let in_frames = clip.frames_with(number);
    // The lowest number that is neither found nor reserved.
    let free = (1..255).find(|id| !ids.contains(id) && *id != 77).unwrap();
    assert_eq!(reserve(&mut clip, &[0, number, 77, 255, number]), in_frames);
    assert_eq!((clip.frames_with(number), clip.frames_with(free)), (vec![], in_frames));
    for (before, after) in found.iter().zip(frames_of(&clip, &frames)) {
        let renumbered: Vec<u8> =
            before.labels.iter().map(|&label| if label == number { free } else { label }).collect();
        assert_eq!(after.labels, renumbered);
    }
    // A person's object has its number for good; what was found under it before has another.
    let mask = mask(&truths[3], &[(2, number)]);
    correct(&mut clip, &frames, 3, &mask);
    assert_eq!(reserve(&mut clip, &[number]), Vec::<usize>::new());
    assert!(clip.frames_with(number).contains(&3));
    let said = clip.frame(3, &frames[3]).unwrap().labels;
    assert!(mask.iter().zip(&said).all(|(&said, &label)| said != number || label == number));
    // A number that was merged away or deleted before is a new one, and what was merged into it goes along.
    let mut clip = moving_and_resting_clip();
    renumber(&mut clip, number, 0);
    reserve(&mut clip, &[number]);
    assert_eq!((clip.frames_with(number), clip.frames_with(free)), (vec![], vec![]));
    correct(&mut clip, &frames, 3, &mask);
    assert!(clip.frames_with(number).contains(&3));
    // Where no number is left there is nothing to give.
    let mut clip = moving_and_resting_clip();
    reserve(&mut clip, &(0..=255).collect::<Vec<u8>>());
    assert_eq!(clip.dropped(), ids.len());
    assert!(frames_of(&clip, &frames).iter().all(|frame| frame.labels.iter().all(|&label| label == 0)));
}

#[test]
fn the_corrected_frame_is_nearly_right_at_once() {
    let shot = three();
    let moving = shot.found(1);
    let strokes = [
        ("added at the edge", moving, shot.stroke(moving, [44, 14, 4, 10])),
        ("added inside", moving, shot.stroke(moving, [28, 18, 4, 4])),
        ("erased", moving, shot.stroke(0, [18, 8, 6, 26])),
        ("new", 9, shot.stroke(9, [92, 66, 20, 16])),
    ];
    for (what, number, said) in strokes {
        let mut shot = shot.clone();
        let pixels = |shot: &Shot| {
            let frame = shot.clip.frame(3, &shot.frames[3]).unwrap();
            frame.labels.iter().map(|&label| label == number).collect::<Vec<_>>()
        };
        let corrections = vec![Painted { frame: 3, object: None, labels: said, spread: Spread::Both }];
        let mut job = shot.clip.annotate(Annotations { corrections, ..Annotations::default() }).unwrap();
        job.take(&mut shot.clip, &shot.frames[3]).unwrap();
        let first = pixels(&shot);
        while let Some(t) = job.wanted() {
            job.take(&mut shot.clip, &shot.frames[t]).unwrap();
        }
        let last = pixels(&shot);
        let count = |of: fn(bool, bool) -> bool| first.iter().zip(&last).filter(|&(&a, &b)| of(a, b)).count();
        let overlap = count(|a, b| a && b) as f64 / count(|a, b| a || b) as f64;
        println!("{what}: {overlap:.2}, {} and {}", count(|a, _| a), count(|_, b| b));
        assert!(overlap > 0.8, "{what}: {overlap:.2}");
    }
}

#[test]
fn one_of_the_grounds_own_colours_is_followed_by_its_motion() {
    let [width, height] = [96, 64];
    let inside = |x: usize, y: usize, t: usize| (30 + 2 * t..60 + 2 * t).contains(&x) && (20..44).contains(&y);
    let grey = |x: usize, y: usize, t: usize| {
        let [u, v] = if inside(x, y, t) { [x + 300 - 2 * t, y + 90] } else { [x, y] }.map(|at| at as f64);
        (128.0 + 60.0 * (0.5 * u + 0.2 * v).sin() + 50.0 * (0.4 * v - 0.15 * u).cos()) as u8
    };
    let frame = |t: usize| {
        let rgba = |p: usize| [[grey(p % width, p / width, t); 3].as_slice(), &[255]].concat();
        Frame::from_rgba(width, height, (0..width * height).flat_map(rgba).collect::<Vec<u8>>()).unwrap()
    };
    let frames: Vec<Frame> = (0..6).map(frame).collect();
    let mut clip = whole(&frames, options(Quality::Fast, None));
    let truth = |t: usize| (0..width * height).map(move |p| inside(p % width, p / width, t));
    correct(&mut clip, &frames, 0, &truth(0).map(|inside| if inside { 9 } else { 0 }).collect::<Vec<u8>>());
    for (t, found) in frames_of(&clip, &frames).iter().enumerate() {
        let pixels = truth(t).zip(&found.labels);
        let [both, either] = pixels.fold([0, 0], |[both, either], (inside, &label)| {
            [both + usize::from(inside && label == 9), either + usize::from(inside || label == 9)]
        });
        assert!(10 * both > 8 * either, "frame {t}: {both} of {either}");
    }
}

#[test]
fn a_second_stroke_in_a_frame_is_taken_back_exactly() {
    let mut shot = crossing();
    let first = shot.stroke(9, [46, 24, 30, 10]);
    let second = shot.stroke(9, [70, 60, 20, 12]);
    let both: Vec<u8> = first.iter().zip(&second).map(|(&one, &other)| one.min(other)).collect();
    shot.correct(4, &first);
    let before = shot.labels();
    shot.correct(4, &both);
    assert!(shot.labels() != before);
    shot.correct(4, &first);
    assert!(shot.labels() == before, "{:?} differ", differing(&before, &shot.labels()));
}
