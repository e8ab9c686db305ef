//! A clip from its opening to its closing.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "test code may panic")]

use crate::support::moving::{SIZE, annotate, frames_of, moving_and_resting, options, whole};
use veronese::clip::{
    Annotation, Annotations, Clip, ClipFrame, Command, Content, OpenOptions, Painted, Spread,
};
use veronese::{Frame, Quality, SegmentOptions};

fn run(clip: &mut Clip, frames: &[Frame]) {
    while let Some(wanted) = clip.wanted() {
        clip.take(wanted.frame, &frames[wanted.frame], None).unwrap();
    }
}

fn labels(clip: &mut Clip, frames: &[Frame]) -> Vec<ClipFrame> {
    let of = |index| {
        clip.look_at(index);
        run(clip, frames);
        clip.labels(index).unwrap()
    };
    (0..frames.len()).map(of).collect()
}

fn segmented(frames: &[Frame]) -> Clip {
    let mut clip = Clip::new(frames.len(), OpenOptions::default());
    let options = SegmentOptions::default().with_quality(Quality::Fast);
    clip.apply(Command::Segment { frames: 0..frames.len(), options }).unwrap();
    run(&mut clip, frames);
    clip
}

#[test]
fn a_clip_gives_the_masks_of_a_segmented_clip() {
    let frames = moving_and_resting().0;
    let mut clip = segmented(&frames);
    let mut before = whole(&frames, options(Quality::Fast, None));
    let same = |one: Vec<ClipFrame>, other: Vec<ClipFrame>| {
        for (one, other) in one.iter().zip(&other) {
            assert_eq!(one.labels, other.labels);
            assert_eq!((&one.objects, &one.background), (&other.objects, &other.background));
        }
    };
    same(labels(&mut clip, &frames), frames_of(&before, &frames));
    let strokes: Vec<u8> = (0..SIZE[0] * SIZE[1]).map(|p| if p % SIZE[0] < 30 && p / SIZE[0] > 60 { 1 } else { 255 }).collect();
    let painted = strokes.iter().map(|&label| if label == 1 { 9 } else { 255 }).collect();
    clip.apply(Command::Annotate(vec![Annotation::new(2, Content::Strokes { object: 9, labels: strokes })])).unwrap();
    run(&mut clip, &frames);
    let corrections = vec![Painted { frame: 2, object: Some(9), labels: painted, spread: Spread::Both }];
    annotate(&mut before, &frames, Annotations { corrections, ..Annotations::default() });
    same(labels(&mut clip, &frames), frames_of(&before, &frames));
    let saved = clip.save();
    let mut again = Clip::read(&saved, OpenOptions::default()).unwrap();
    assert_eq!((again.used, again.is_damaged), (saved.len(), false));
    assert_eq!(again.clip.wanted(), None);
    assert!((0..frames.len()).all(|index| again.clip.labels(index).is_some()));
    assert!(again.clip.undo());
    same(labels(&mut again.clip, &frames), frames_of(&whole(&frames, options(Quality::Fast, None)), &frames));
}

#[test]
fn what_is_drawn_exactly_changes_no_other_pixel() {
    let frames = moving_and_resting().0;
    let mut clip = segmented(&frames);
    let before = labels(&mut clip, &frames);
    let corner: Vec<u8> =
        (0..SIZE[0] * SIZE[1]).map(|p| if p % SIZE[0] < 9 && p / SIZE[0] < 9 { 1 } else { 255 }).collect();
    let content = Content::Strokes { object: 9, labels: corner.clone() };
    let annotation = Annotation { spread: Spread::Exact, ..Annotation::new(2, content) };
    clip.apply(Command::Annotate(vec![annotation])).unwrap();
    assert_eq!(clip.wanted().map(|wanted| wanted.frame), Some(2));
    clip.take(2, &frames[2], None).unwrap();
    assert_eq!(clip.wanted(), None, "it is done");
    for (index, (before, now)) in before.iter().zip(labels(&mut clip, &frames)).enumerate() {
        let drawn = |(p, &label): (usize, &u8)| if index == 2 && corner[p] == 1 { 9 } else { label };
        assert!(before.labels.iter().enumerate().map(drawn).eq(now.labels.iter().copied()), "frame {index}");
    }
}

#[test]
fn a_range_that_ends_before_its_first_frame_fails() {
    let frames = moving_and_resting().0;
    let mut clip = Clip::new(frames.len(), OpenOptions::default());
    let segment = |frames| Command::Segment { frames, options: SegmentOptions::default().with_quality(Quality::Fast) };
    let first = clip.apply(segment(0..2)).unwrap();
    run(&mut clip, &frames);
    let second = clip.apply(segment(2..4)).unwrap();
    assert_eq!(clip.wanted().map(|wanted| wanted.frame), Some(1), "the frame beside it");
    clip.finish();
    assert_eq!(clip.wanted(), None);
    let settled = clip.take_events().settled;
    assert!(settled.iter().any(|of| of.step == second && of.changes.is_err()));
    assert_eq!(clip.last_step(), Some(first));
}
