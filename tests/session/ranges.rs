//! Ranges of a clip: beside, inside and over each other, with annotations in and around them.

use super::{
    COUNT, SCENE, SIZE, assert_same, fast, in_box, labels, of_thing, pairs_of_annotations, print, read, run, said,
    segment, settle, shown, start, summary, take,
};
use crate::support::moving::{scene_of, thing};
use veronese::clip::{Annotation, Clip, ClipStage, Command, Content, Description, OpenOptions, Spread, solve_pair};
use veronese::{Error, Frame};

/// A clip whose frames from 0 to `end` are segmented.
fn first(end: usize) -> Clip {
    let mut clip = Clip::new(COUNT, OpenOptions::default()).unwrap();
    settle(&mut clip, segment(0..end)).unwrap();
    clip
}

/// The numbers that most pixels of the two things that move have in a frame.
fn numbers(labels: &[u8], frame: usize) -> [u8; 2] {
    [1, 2].map(|thing| {
        let count = |k: u8| (0..labels.len()).filter(|&p| SCENE.truths[frame][p] == thing && labels[p] == k).count();
        (0..255).max_by_key(|k| count(*k)).unwrap()
    })
}

fn strokes(object: u8) -> Content {
    Content::Strokes { object, labels: in_box([62, 76, 14, 8], 1, 255) }
}

fn labels_in(clip: &mut Clip, frame: usize) -> Vec<u8> {
    clip.look_at(frame);
    while clip.labels(frame).is_none() {
        assert!(take(clip));
    }
    clip.labels(frame).unwrap().labels
}

#[test]
fn ranges_beside_each_other_keep_numbers_and_pass_annotations_on() {
    for (one, other) in [(0..3, 3..COUNT), (3..COUNT, 0..3)] {
        let mut clip = Clip::new(COUNT, OpenOptions::default()).unwrap();
        settle(&mut clip, segment(one.clone())).unwrap();
        let of_one = labels_in(&mut clip, one.start);
        settle(&mut clip, segment(other.clone())).unwrap();
        let labels = shown(&mut clip);
        assert!(labels[one.start] == of_one, "masks do not follow from the range beside them");
        assert_eq!(numbers(&labels[2], 2), numbers(&labels[3], 3));
        // Across the border, both ways.
        for frame in [1, 4] {
            let mut clip = read(&clip.save());
            settle(&mut clip, said(frame, strokes(9))).unwrap();
            assert!(shown(&mut clip).iter().all(|labels| labels.contains(&9)));
        }
    }
}

#[test]
fn a_range_without_a_frame_beside_it_ends_a_scene() {
    let mut clip = first(2);
    settle(&mut clip, segment(3..COUNT)).unwrap();
    settle(&mut clip, said(4, strokes(9))).unwrap();
    let has: Vec<bool> =
        labels(&mut clip).iter().map(|of| of.as_ref().is_some_and(|of| of.labels.contains(&9))).collect();
    assert_eq!(has, [false, false, false, true, true, true]);
    // The frame between them joins them.
    settle(&mut clip, segment(2..COUNT)).unwrap();
    assert!(shown(&mut clip).iter().all(|labels| labels.contains(&9)));
}

#[test]
fn ranges_inside_and_over_each_other_keep_numbers_and_annotations() {
    for (what, command, _) in pairs_of_annotations() {
        let mut clip = start();
        settle(&mut clip, command).unwrap();
        let (before, known) = (labels(&mut clip), clip.objects());
        // With the same options, everything is found as it was.
        settle(&mut clip, segment(0..COUNT)).unwrap();
        let before: Vec<_> = before.into_iter().flatten().collect();
        assert_same(&labels(&mut clip), &before, what);
        assert_eq!(clip.objects(), known, "{what}");
        for range in [1..4, 0..3, 4..COUNT] {
            settle(&mut clip, segment(range.clone())).unwrap();
            let now = shown(&mut clip);
            let is_kept = |k: u8| (0..COUNT).all(|t| before[t].labels.contains(&k) == now[t].contains(&k));
            assert!(what == "eraser" || is_kept(9), "{what} in {range:?}");
            let used = clip.objects().len();
            assert!(used >= known.len(), "{what}: no number is forgotten");
            if what == "accept" {
                assert!([1, 4].iter().all(|&t| now[t] == before[t].labels && clip.frames()[t].accepted), "{range:?}");
            }
            if what == "delete" {
                assert!(now.iter().flatten().all(|label| *label != 1), "a deleted number is not given again");
            }
        }
        clip.undo();
        clip.undo();
        clip.undo();
        assert_same(&labels(&mut clip), &before, what);
    }
}

#[test]
fn what_was_painted_before_objects_were_merged_named_and_locked_is_there_when_they_are_segmented_again() {
    let mut clip = start();
    let found = shown(&mut clip);
    let objects = numbers(&found[2], 2);
    // Over one of them.
    settle(&mut clip, said(2, Content::Strokes { object: 9, labels: of_thing(2, 1, 1, 255) })).unwrap();
    settle(&mut clip, Command::Merge(objects.into())).unwrap();
    let description = Description { name: "one".into(), ..Description::default() };
    settle(&mut clip, Command::Describe { object: objects[0], description, coalesce: false }).unwrap();
    settle(&mut clip, Command::Lock { objects: vec![objects[0]], on: true }).unwrap();
    let (before, known) = (shown(&mut clip), clip.objects());
    assert!(before.iter().all(|labels| labels.contains(&9)));
    settle(&mut clip, segment(0..COUNT)).unwrap();
    assert!(shown(&mut clip) == before);
    assert_eq!(clip.objects(), known);
}

#[test]
fn commands_go_before_a_range_and_those_that_need_it_wait() {
    // Frames 4 and 5 are being segmented.
    let mut clip = first(4);
    let range = clip.apply(segment(4..COUNT)).unwrap();
    assert!(take(&mut clip));
    let before = clip.apply(said(1, strokes(9))).unwrap();
    let waits = clip.apply(said(5, strokes(8))).unwrap();
    let behind = clip.apply(Command::Lock { objects: vec![9], on: true }).unwrap();
    let refused = clip.apply(said(COUNT, strokes(8)));
    assert!(matches!(refused, Err(Error::InvalidOption { .. })));
    assert_eq!(clip.wanted().unwrap().step, Some(before));
    assert_eq!(clip.steps()[2], 4);
    run(&mut clip);
    let settled: Vec<_> = clip.take_events().settled.into_iter().map(|of| (of.step, of.changes.is_ok())).collect();
    assert_eq!(settled, [(before, true), (range, true), (waits, true), (behind, true)]);
    let (state, labels) = (print(&mut clip), shown(&mut clip));
    assert!(labels.iter().all(|labels| labels.contains(&9) && labels.contains(&8)));
    // The same, one after another.
    let mut other = first(4);
    for command in
        [said(1, strokes(9)), segment(4..COUNT), said(5, strokes(8)), Command::Lock { objects: vec![9], on: true }]
    {
        settle(&mut other, command).unwrap();
    }
    assert_eq!(print(&mut other), state);
    // Without the range, what waits for it fails.
    let mut clip = first(4);
    let range = clip.apply(segment(4..COUNT)).unwrap();
    let waits = clip.apply(said(5, strokes(8))).unwrap();
    let before = summary(&clip);
    clip.take_events();
    assert!(clip.cancel(range));
    let settled = clip.take_events().settled;
    assert!(settled[0].step == waits && settled[0].changes.is_err() && settled.len() == 1);
    assert_eq!((summary(&clip), clip.wanted()), (before, None));
}

#[test]
fn a_range_that_is_ended_early_has_the_frames_that_were_in() {
    for count in 0..=COUNT {
        let mut clip = Clip::new(COUNT, OpenOptions::default()).unwrap();
        let range = clip.apply(segment(0..COUNT)).unwrap();
        let _ = (0..count).all(|_| take(&mut clip));
        clip.finish(range);
        run(&mut clip);
        let settled = clip.take_events().settled;
        assert_eq!((settled[0].step, settled[0].changes.is_ok()), (range, count > 1), "{count}");
        assert_eq!(clip.frames().iter().filter(|of| of.has_masks).count(), if count > 1 { count } else { 0 });
        if count > 1 {
            assert_eq!(print(&mut clip), print(&mut first(count)), "{count}");
        }
    }
    // Behind other masks it is joined to them, unless it is ended once more.
    for (ends, count) in [(1, COUNT), (2, 3)] {
        let mut clip = first(3);
        let range = clip.apply(segment(3..COUNT)).unwrap();
        (0..3).for_each(|_| assert!(take(&mut clip)));
        (0..ends).for_each(|_| clip.finish(range));
        run(&mut clip);
        settle(&mut clip, said(1, strokes(9))).unwrap();
        let has = shown(&mut clip).iter().filter(|labels| labels.contains(&9)).count();
        assert_eq!(has, count, "ended {ends} times");
    }
    let mut clip = first(3);
    let range = clip.apply(segment(3..COUNT)).unwrap();
    clip.finish(range);
    assert_eq!((clip.wanted(), clip.steps()[2]), (None, 0), "no frame was in");
}

#[test]
fn solved_pairs_of_a_cancelled_range_are_kept() {
    let mut clip = Clip::new(COUNT, OpenOptions::default()).unwrap();
    let range = clip.apply(segment(0..COUNT)).unwrap();
    for index in 0..4 {
        clip.take(index, &SCENE.frames[index], None).unwrap();
    }
    clip.cancel(range);
    let journal = clip.take_events().records;
    // Also by a clip that is read again.
    for mut clip in [clip, read(&journal)] {
        clip.apply(segment(0..COUNT)).unwrap();
        clip.take_events();
        for index in 0..4 {
            clip.take(index, &SCENE.frames[index], None).unwrap();
            assert!(clip.take_events().records.is_empty(), "the pairs of frame {index} are known");
        }
        run(&mut clip);
        assert_eq!(print(&mut clip), print(&mut start()));
        settle(&mut clip, said(1, strokes(9))).unwrap();
    }
}

#[test]
fn pairs_of_others_give_the_same_bits() {
    let mut alone = Clip::new(COUNT, OpenOptions::default()).unwrap();
    alone.apply(segment(0..COUNT)).unwrap();
    let mut segmenter =
        veronese::clip::ClipSegmenter::new(crate::support::moving::options(veronese::Quality::Fast, None)).unwrap();
    for (index, frame) in SCENE.frames.iter().enumerate() {
        let pushed = segmenter.push(frame.clone()).unwrap();
        if index > 0 {
            assert_eq!(pushed.to_bytes(), SCENE.pairs[index - 1].to_bytes());
        }
        alone.take(index, frame, None).unwrap();
    }
    let records = alone.take_events().records;
    // Of some frames, of all, and of other frames or options, which are not used.
    for kind in 0..4 {
        let mut clip = Clip::new(COUNT, OpenOptions::default()).unwrap();
        clip.apply(segment(0..COUNT)).unwrap();
        for (index, frame) in SCENE.frames.iter().enumerate() {
            let solved = match kind {
                0 => index.checked_sub(1).map(|before| &SCENE.pairs[before]),
                1 => index.checked_sub(1).filter(|before| before % 2 == 0).map(|before| &SCENE.pairs[before]),
                2 => SCENE.pairs.get(index),
                _ => SCENE.pairs.first(),
            };
            clip.take(index, frame, solved).unwrap();
        }
        assert!(clip.take_events().records == records, "kind {kind}");
        assert_eq!(print(&mut clip), print(&mut alone));
    }
    let best = fast().with_quality(veronese::Quality::Best);
    let other = solve_pair(&SCENE.frames[0], &SCENE.frames[1], &best).unwrap();
    assert_ne!(other.to_bytes(), SCENE.pairs[0].to_bytes());
}

/// The scene in frames of twice the size.
fn larger() -> Vec<Frame> {
    let things = [
        thing(2, [48.0, 44.0], |t| [12.0 + 14.0 * t as f32, 68.0]),
        thing(3, [52.0, 60.0], |t| [176.0 - 14.0 * t as f32, 76.0]),
        thing(9, [60.0, 40.0], |_| [120.0, 144.0]),
    ];
    scene_of(SIZE.map(|side| 2 * side), 1, &things, COUNT).0
}

#[test]
fn frames_of_another_size_cover_all_masks_and_scale_what_was_said() {
    let larger = larger();
    let mut clip = start();
    let exact =
        |labels: Vec<u8>| Annotation { frame: 2, content: Content::Mask { object: 8, labels }, spread: Spread::Exact };
    settle(&mut clip, said(1, strokes(9))).unwrap();
    settle(&mut clip, Command::Annotate(vec![exact(in_box([4, 4, 20, 10], 1, 255))])).unwrap();
    settle(&mut clip, said(4, Content::Prompt { object: 7, clicks: Vec::new(), within: Some([60, 72, 30, 20]) }))
        .unwrap();
    settle(&mut clip, Command::Accept { frames: vec![3], on: true }).unwrap();
    let (state, before) = (print(&mut clip), shown(&mut clip));
    // A part of the clip cannot have another size.
    let part = clip.apply(segment(0..3)).unwrap();
    assert!(matches!(clip.take(0, &larger[0], None), Err(Error::FrameSizeMismatch { .. })));
    assert!(clip.cancel(part));
    assert_eq!(print(&mut clip), state);
    // Nor can what is left of the whole when it ends early.
    let whole = clip.apply(segment(0..COUNT)).unwrap();
    (0..3).for_each(|index| clip.take(index, &larger[index], None).unwrap());
    clip.finish(whole);
    let settled = clip.take_events().settled;
    assert!(matches!(settled[..], [ref of] if of.step == whole && of.changes.is_err()));
    assert_eq!(print(&mut clip), state);
    // The whole can.
    clip.apply(segment(0..COUNT)).unwrap();
    let mut again = 0;
    while let Some(wanted) = clip.wanted() {
        clip.take(wanted.frame, &larger[wanted.frame], None).unwrap();
        again += usize::from(wanted.stage == ClipStage::Annotations);
    }
    assert!(again > 0, "annotations are applied again");
    assert_eq!(clip.size(), [2 * SIZE[0], 2 * SIZE[1]]);
    for (index, frame) in larger.iter().enumerate() {
        clip.look_at(index);
        clip.take(index, frame, None).unwrap();
        let labels = clip.labels(index).unwrap().labels;
        let at = |p: usize| labels[2 * (p / SIZE[0]) * 2 * SIZE[0] + 2 * (p % SIZE[0])];
        let differ = (0..before[index].len()).filter(|&p| at(p) != before[index][p]);
        let count = differ.clone().count();
        match index {
            3 => assert_eq!(count, 0, "accepted"),
            2 => assert!(differ.clone().all(|p| before[2][p] != 8) && count < 1000, "drawn exactly: {count}"),
            _ => assert!(count < 1000, "{index}: {count}"),
        }
        assert!([(4, 7), (2, 8), (1, 9)].iter().all(|(t, k)| *t != index || labels.contains(k)), "{index}");
    }
    clip.undo();
    assert_eq!(clip.size(), SIZE);
    assert_eq!(print(&mut clip), state);
}

#[test]
fn undo_while_a_range_is_segmented_decides_what_is_beside_it() {
    // The frames beside the range have masks when it begins, but not when it ends; or the other way round.
    for is_there in [false, true] {
        // Once all frames are in and none is wanted beside them, the range has taken effect.
        for count in 0..COUNT - 1 - usize::from(is_there) {
            let mut clip = first(2);
            let mut other = first(2);
            if is_there {
                assert!(clip.undo());
            } else {
                assert!(other.undo());
            }
            clip.apply(segment(2..COUNT)).unwrap();
            let _ = (0..count).all(|_| take(&mut clip));
            assert!(if is_there { clip.redo() } else { clip.undo() });
            run(&mut clip);
            settle(&mut other, segment(2..COUNT)).unwrap();
            assert_eq!(summary(&clip), summary(&other), "{is_there}, {count}");
            settle(&mut clip, said(3, strokes(9))).unwrap();
        }
    }
}

#[test]
fn a_look_at_a_frame_whose_masks_are_undone_asks_for_nothing() {
    let mut clip = read(&start().save());
    settle(&mut clip, said(1, strokes(9))).unwrap();
    clip.look_at(1);
    assert_eq!(clip.wanted().unwrap().stage, ClipStage::Labels);
    assert!(clip.undo() && clip.undo());
    assert_eq!(clip.wanted(), None);
}
