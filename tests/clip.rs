//! Clips: objects keep their number while they move, stop, cross and hide, and the stream keeps its promises.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "test code may panic")]

use crate::support::moving::{
    Thing, correct, frames_of, mask, moving_and_resting, moving_and_resting_clip, noisy_scene, one_number, options,
    scene, thing, whole,
};
use veronese::clip::{
    Annotations, ClipFrame, ClipOptions, ClipSegmenter, FramePairs, MAX_LOOK_AHEAD, Painted, SegmentedClip, Spread,
    StreamSegmenter,
};
use veronese::{Error, Frame, MotionCount, Quality};

/// As a stream if there is a look-ahead.
fn segment(frames: &[Frame], options: ClipOptions) -> Vec<ClipFrame> {
    let done = if options.look_ahead.is_some() {
        let mut stream = StreamSegmenter::new(options).unwrap();
        let mut done: Vec<ClipFrame> = frames.iter().filter_map(|frame| stream.push(frame.clone()).unwrap()).collect();
        done.extend(stream.finish());
        done
    } else {
        frames_of(&whole(frames, options), frames)
    };
    assert_eq!(done.iter().map(|frame| frame.index).collect::<Vec<_>>(), (0..frames.len()).collect::<Vec<_>>());
    for frame in &done {
        for object in &frame.objects {
            assert_eq!(object.pixels, frame.labels.iter().filter(|&&label| label == object.id).count());
            assert!((0.0..=1.0).contains(&object.confidence));
        }
        let known = |label: &u8| *label == 0 || frame.objects.iter().any(|object| object.id == *label);
        assert!(frame.labels.iter().all(known));
    }
    done
}

#[test]
fn two_that_cross_keep_their_numbers() {
    let things = [
        thing(2, [36.0, 30.0], |t| [10.0 + 5.0 * t as f32, 40.0]),
        thing(3, [30.0, 34.0], |t| [115.0 - 5.0 * t as f32, 52.0]),
    ];
    let (frames, truths) = scene(1, &things, 20);
    let done = segment(&frames, options(Quality::Best, None));
    assert_ne!(one_number(&done, &truths, 1, 0..20), one_number(&done, &truths, 2, 0..20));
}

#[test]
fn the_main_subject_is_one_object() {
    let things = [
        thing(2, [36.0, 30.0], |t| [10.0 + 5.0 * t as f32, 30.0]),
        thing(3, [30.0, 34.0], |t| [115.0 - 5.0 * t as f32, 72.0]),
    ];
    let (frames, truths) = scene(1, &things, 8);
    for (quality, look_ahead) in [(Quality::Best, None), (Quality::Fast, Some(2))] {
        let all = options(quality, look_ahead);
        let done = segment(&frames, all.with_pair(all.pair.with_subject(true)));
        let seen = done.iter().zip(&truths).filter(|(frame, truth)| {
            let overlap = frame.labels.iter().zip(*truth).filter(|(label, thing)| **label == 1 && **thing > 0).count();
            frame.objects.iter().map(|object| object.id).eq([1]) && 10 * overlap > 9 * frame.objects[0].pixels
        });
        assert!(seen.count() >= 7, "{look_ahead:?}");
        let usual = segment(&frames, all);
        assert!(usual.iter().any(|frame| frame.objects.len() == 2), "{look_ahead:?}");
    }
}

/// Two that cross, the first of which is wholly behind the other for a while: checks that it has the same number again.
fn assert_covered_and_back(things: [Thing; 2], count: usize) {
    let (frames, truths) = scene(1, &things, count);
    let hidden: Vec<usize> = (0..count).filter(|&t| !truths[t].contains(&1)).collect();
    let done = segment(&frames, options(Quality::Best, None));
    let in_front = one_number(&done, &truths, 2, 0..count);
    let before = one_number(&done, &truths, 1, 0..hidden[0] - 1);
    assert_ne!(before, in_front);
    // The first strip of it that comes out may be too small to have a motion.
    assert_eq!(one_number(&done, &truths, 1, hidden[hidden.len() - 1] + 3..count), before);
}

#[test]
fn one_that_was_covered_by_another_gets_its_number_back() {
    let things = [
        thing(2, [26.0, 24.0], |t| [10.0 + 5.0 * t as f32, 46.0]),
        thing(3, [38.0, 40.0], |t| [110.0 - 5.0 * t as f32, 38.0]),
    ];
    assert_covered_and_back(things, 20);
}

#[test]
fn repeated_frames_do_not_stop_what_is_covered() {
    // Frame 7 repeats frame 6 and frame 12 repeats frame 11, where the one is hidden.
    fn moment(t: usize) -> f32 {
        (t - usize::from(t > 6) - usize::from(t > 11)) as f32
    }
    let things = [
        thing(2, [26.0, 24.0], |t| [10.0 + 5.0 * moment(t), 46.0]),
        thing(3, [38.0, 40.0], |t| [110.0 - 5.0 * moment(t), 38.0]),
    ];
    assert_covered_and_back(things, 22);
}

/// As where the rate of frames was raised, from 30 to 60 or from 24 to 60; a codec changes the frames that it repeats.
fn assert_seen_in_repeated(doubled: &[(Quality, Option<usize>)], three_two: &[(Quality, Option<usize>)]) {
    let two = thing(2, [34.0, 30.0], |t| [20.0 + 4.0 * (t / 2) as f32, 44.0]);
    let three = thing(2, [34.0, 30.0], |t| [20.0 + 4.0 * ((2 * t + 1) / 5) as f32, 44.0]);
    for ((frames, truths), asked) in [(scene(1, &[two], 20), doubled), (noisy_scene(1, &[three], 20), three_two)] {
        for &(quality, look_ahead) in asked {
            one_number(&segment(&frames, options(quality, look_ahead)), &truths, 1, 4..20);
        }
    }
}

#[test]
fn what_moves_is_seen_in_repeated_frames_too() {
    assert_seen_in_repeated(&[(Quality::Fast, Some(0))], &[(Quality::Best, None)]);
}

#[test]
#[ignore = "npm run soak"]
fn what_moves_is_seen_in_repeated_frames_in_all_ways() {
    let best = [(Quality::Best, None), (Quality::Best, Some(0))];
    assert_seen_in_repeated(&best, &[(Quality::Best, Some(0)), (Quality::Fast, Some(0))]);
}

fn assert_seen_farther_apart(asked: &[(Quality, Option<usize>)]) {
    let things = [thing(2, [34.0, 30.0], |t| [50.0 + 0.1 * t as f32, 44.0])];
    let (frames, truths) = noisy_scene(1, &things, 24);
    for &(quality, look_ahead) in asked {
        let from = if look_ahead.is_some() { 16 } else { 0 };
        one_number(&segment(&frames, options(quality, look_ahead)), &truths, 1, from..24);
    }
}

#[test]
fn what_neighbours_do_not_show_is_seen_in_frames_farther_apart() {
    assert_seen_farther_apart(&[(Quality::Best, None), (Quality::Fast, Some(0))]);
}

#[test]
#[ignore = "npm run soak"]
fn what_neighbours_do_not_show_is_seen_in_all_streams() {
    assert_seen_farther_apart(&[(Quality::Best, Some(0)), (Quality::Fast, Some(4))]);
}

#[test]
fn two_frames_alone_are_a_clip() {
    let things = [thing(2, [34.0, 30.0], |t| [50.0 + 3.0 * t as f32, 44.0])];
    let (frames, truths) = noisy_scene(1, &things, 2);
    for quality in [Quality::Best, Quality::Fast] {
        let done = segment(&frames, options(quality, None));
        one_number(&done, &truths, 1, 0..2);
        let [mut first, mut again] = [(); 2].map(|()| ClipSegmenter::new(options(quality, None)).unwrap());
        for frame in &frames {
            let pairs = first.push(frame.clone()).unwrap();
            again.push_known(frame.clone(), &pairs).unwrap();
        }
        let labels = |clip: &SegmentedClip| frames_of(clip, &frames).into_iter().map(|frame| frame.labels).collect();
        let all: [Vec<Vec<u8>>; 2] = [first, again].map(|segmenter| labels(&segmenter.conclude()));
        assert!(all.iter().flatten().zip(done.iter().chain(&done)).all(|(labels, frame)| *labels == frame.labels));
    }
}

#[test]
fn one_that_stops_is_still_itself() {
    let things = [thing(2, [34.0, 30.0], |t| [20.0 + 4.0 * if t < 6 { t } else { (t - 4).max(6) } as f32, 44.0])];
    let (frames, truths) = scene(1, &things, 16);
    for (quality, look_ahead) in [(Quality::Best, None), (Quality::Fast, Some(0)), (Quality::Best, Some(4))] {
        let done = segment(&frames, options(quality, look_ahead));
        one_number(&done, &truths, 1, 2..16);
    }
}

#[test]
fn one_that_was_hidden_gets_its_number_back() {
    // Behind a post that belongs to the background.
    let things = [thing(2, [24.0, 26.0], |t| [6.0 + 6.0 * t as f32, 46.0]), thing(4, [30.0, 120.0], |_| [64.0, 0.0])];
    let (frames, truths) = scene(1, &things, 20);
    assert!((0..20).any(|t| !truths[t].contains(&1)), "it is out of sight for a while");
    let done = segment(&frames, options(Quality::Best, None));
    let before = one_number(&done, &truths, 1, 0..8);
    assert_eq!(one_number(&done, &truths, 1, 17..20), before);
}

#[test]
fn parts_that_move_together_are_one_object() {
    // A post of the background stands before it in all frames: it is never in sight as a whole.
    let things = [thing(2, [70.0, 30.0], |t| [20.0 + 2.0 * t as f32, 44.0]), thing(4, [12.0, 120.0], |_| [74.0, 0.0])];
    let (frames, truths) = scene(1, &things, 12);
    let done = segment(&frames, options(Quality::Best, None));
    one_number(&done, &truths, 1, 0..12);
    assert!(done.iter().all(|frame| frame.objects.len() == 1), "one object and no other");
}

#[test]
fn a_cut_ends_all_objects() {
    let one = [thing(2, [34.0, 30.0], |t| [20.0 + 4.0 * t as f32, 44.0])];
    let other = [thing(6, [34.0, 30.0], |t| [20.0 + 4.0 * t as f32, 50.0])];
    let (mut frames, mut truths) = scene(1, &one, 8);
    let (after, after_truths) = scene(5, &other, 16);
    frames.extend(after.into_iter().skip(8));
    truths.extend(after_truths.into_iter().skip(8));
    for (quality, look_ahead) in [(Quality::Best, None), (Quality::Fast, Some(2))] {
        let done = segment(&frames, options(quality, look_ahead));
        let first = one_number(&done, &truths, 1, 2..8);
        assert_ne!(one_number(&done, &truths, 1, 10..16), first);
        assert!(look_ahead.is_some() || done[7].background.is_none(), "the last frame of a scene has no next one");
    }
}

#[test]
fn a_stream_gives_every_frame_after_its_look_ahead() {
    let things = [thing(2, [34.0, 30.0], |t| [20.0 + 4.0 * t as f32, 44.0])];
    let (frames, _) = scene(1, &things, 6);
    for look_ahead in [0, 1, 3] {
        let mut clip = StreamSegmenter::new(options(Quality::Fast, Some(look_ahead))).unwrap();
        for (t, frame) in frames.iter().enumerate() {
            let done = clip.push(frame.clone()).unwrap().map(|frame| frame.index);
            assert_eq!(done, t.checked_sub(look_ahead), "frame {t}, look-ahead {look_ahead}");
        }
        assert_eq!(clip.finish().len(), look_ahead);
        assert!(clip.finish().is_empty());
        // Another clip begins at 0 again.
        let again = clip.push(frames[0].clone()).unwrap().into_iter().chain(clip.finish());
        assert_eq!(again.map(|frame| frame.index).collect::<Vec<_>>(), [0]);
    }
}

#[test]
fn few_frames_and_frames_where_nothing_moves_have_no_objects() {
    let (frames, _) = scene(1, &[], 1);
    for look_ahead in [None, Some(0), Some(2)] {
        assert!(segment(&[], options(Quality::Fast, look_ahead)).is_empty());
        for count in [1, 2, 4] {
            let same = vec![frames[0].clone(); count];
            let done = segment(&same, options(Quality::Fast, look_ahead));
            assert!(done.iter().all(|frame| frame.objects.is_empty() && frame.labels.iter().all(|&l| l == 0)));
        }
    }
}

#[test]
fn mistakes_have_a_code_and_the_clip_goes_on() {
    let mistaken = ClipSegmenter::new(options(Quality::Fast, Some(MAX_LOOK_AHEAD + 1)));
    assert!(matches!(mistaken, Err(Error::InvalidOption { name: "lookAhead", .. })));
    let (frames, _) = scene(1, &[], 3);
    let small = Frame::from_rgba(32, 32, vec![0u8; 4 * 32 * 32]).unwrap();
    let mut stream = StreamSegmenter::new(options(Quality::Fast, Some(0))).unwrap();
    assert!(stream.push(frames[0].clone()).unwrap().is_some());
    assert!(matches!(stream.push(small.clone()), Err(Error::FrameSizeMismatch { .. })));
    assert_eq!(stream.push(frames[1].clone()).unwrap().unwrap().index, 1);

    let mut segmenter = ClipSegmenter::new(options(Quality::Fast, None)).unwrap();
    segmenter.push(frames[0].clone()).unwrap();
    assert!(matches!(segmenter.push(small.clone()), Err(Error::FrameSizeMismatch { .. })));
    segmenter.push(frames[1].clone()).unwrap();
    let mut clip = segmenter.conclude();
    assert_eq!(clip.len(), 2);
    assert!(matches!(clip.frame(2, &frames[2]), Err(Error::InvalidOption { name: "frame", .. })));
    assert!(matches!(clip.frame(0, &small), Err(Error::FrameSizeMismatch { .. })));
    let painted = |frame, labels: &[u8]| Annotations {
        corrections: vec![Painted { frame, object: None, labels: labels.to_vec(), spread: Spread::Both }],
        ..Annotations::default()
    };
    let option = |clip: &mut SegmentedClip, said| match clip.annotate(said) {
        Err(Error::InvalidOption { name, .. }) => name,
        other => panic!("{other:?}"),
    };
    assert_eq!(option(&mut clip, painted(2, &[255; 160 * 120])), "frame");
    assert_eq!(option(&mut clip, painted(0, &[255; 12])), "corrections");
    assert_eq!(option(&mut clip, Annotations { numbers: vec![[0, 3]], ..Annotations::default() }), "objects");
    let mut correction = clip.annotate(painted(0, &[0; 160 * 120])).unwrap();
    assert!(matches!(correction.take(&mut clip, &small), Err(Error::FrameSizeMismatch { .. })));
    assert_eq!(correction.wanted(), Some(0), "it waits for the right frame");
}

#[test]
fn a_saved_clip_is_the_same_and_a_damaged_one_is_refused() {
    let (frames, truths) = moving_and_resting();
    let mut clip = moving_and_resting_clip();
    correct(&mut clip, &frames, 5, &mask(&truths[5], &[(2, 9)]));
    let bytes = clip.to_bytes();
    let again = SegmentedClip::from_bytes(&bytes).unwrap();
    for (one, other) in frames_of(&clip, &frames).iter().zip(frames_of(&again, &frames)) {
        assert_eq!((&one.labels, &one.objects), (&other.labels, &other.objects));
    }
    let refused = |bytes: &[u8]| {
        assert!(matches!(SegmentedClip::from_bytes(bytes), Err(Error::InvalidOption { name: "state", .. })));
    };
    damaged(&bytes).iter().for_each(|damaged| refused(damaged));
    let old = [b"VERCLIP4", &bytes[MARK..bytes.len() - 8]].concat();
    assert!(SegmentedClip::from_bytes(&old).unwrap_err().to_string().contains("not of this version"));
}

/// Length of the mark before what is kept.
const MARK: usize = concat!("VERCLIP6 ", env!("CARGO_PKG_VERSION"), "\n").len();

/// Bytes with one bit changed, cut off, left out, added.
fn damaged(bytes: &[u8]) -> Vec<Vec<u8>> {
    let mut all = vec![bytes[1..].to_vec(), Vec::new(), [bytes, &[0]].concat(), [bytes, bytes].concat()];
    for place in (0..bytes.len()).step_by(bytes.len() / 200 + 1) {
        let mut flipped = bytes.to_vec();
        flipped[place] ^= 1 << (place % 8);
        all.extend([flipped, bytes[..place].to_vec(), [&bytes[..place], &bytes[place + 1..]].concat()]);
    }
    all
}

#[test]
fn a_clip_knows_its_frames() {
    let (frames, _) = moving_and_resting();
    let mut clip = moving_and_resting_clip();
    let corrections = vec![Painted { frame: 3, object: None, labels: vec![1; 160 * 120], spread: Spread::Both }];
    let mut correction = clip.annotate(Annotations { corrections, ..Annotations::default() }).unwrap();
    assert!(matches!(clip.frame(3, &frames[4]), Err(Error::OtherFrame { index: 3 })));
    assert!(matches!(correction.take(&mut clip, &frames[4]), Err(Error::OtherFrame { index: 3 })));
    correction.take(&mut clip, &frames[3]).unwrap();
    clip.frame(3, &frames[3]).unwrap();
}

#[test]
fn a_clip_goes_on_from_known_pairs_to_the_same_labels() {
    let (frames, _) = moving_and_resting();
    for look_ahead in [None, Some(1)] {
        let options = options(Quality::Fast, look_ahead);
        let mut segmenter = ClipSegmenter::new(options).unwrap();
        let known: Vec<Vec<u8>> =
            frames.iter().map(|frame| segmenter.push(frame.clone()).unwrap().to_bytes()).collect();
        let straight = segmenter.conclude().to_bytes();
        let mut segmenter = ClipSegmenter::new(options).unwrap();
        for (t, frame) in frames.iter().enumerate() {
            if t < 7 {
                let pairs = FramePairs::from_bytes(&known[t]).unwrap();
                segmenter.push_known(frame.clone(), &pairs).unwrap();
            } else {
                segmenter.push(frame.clone()).unwrap();
            }
        }
        assert!(straight == segmenter.conclude().to_bytes());
    }
}

#[test]
fn previews_show_what_pairs_tell_and_change_nothing() {
    let things = [
        thing(2, [36.0, 30.0], |t| [10.0 + 5.0 * t as f32, 12.0]),
        thing(3, [30.0, 34.0], |t| [115.0 - 5.0 * t as f32, 70.0]),
    ];
    let (frames, truths) = scene(1, &things, 8);
    let options = options(Quality::Fast, None);
    let mut segmenter = ClipSegmenter::new(options).unwrap();
    assert!(segmenter.preview().is_none());
    let mut previews = Vec::new();
    for frame in &frames {
        segmenter.push(frame.clone()).unwrap();
        previews.extend(segmenter.preview());
        assert!(segmenter.preview().is_none(), "none comes twice");
    }
    assert_eq!(previews.iter().map(|frame| frame.index).collect::<Vec<_>>(), (0..7).collect::<Vec<_>>());
    assert_ne!(one_number(&previews, &truths, 1, 0..7), one_number(&previews, &truths, 2, 0..7));
    assert!(segmenter.conclude().to_bytes() == whole(&frames, options).to_bytes());
}

#[test]
fn pairs_of_a_whole_clip_follow_from_their_two_frames_alone() {
    let (frames, _) = moving_and_resting();
    // Also a frame that is repeated, and a cut.
    let mut frames = frames[..5].to_vec();
    frames.insert(2, frames[2].clone());
    frames.extend(scene(9, &[thing(4, [34.0, 30.0], |t| [20.0 + 4.0 * t as f32, 44.0])], 2).0);
    for quality in [Quality::Fast, Quality::Best] {
        let options = options(quality, None);
        let mut segmenter = ClipSegmenter::new(options).unwrap();
        let told: Vec<Vec<u8>> = frames.iter().map(|frame| segmenter.push(frame.clone()).unwrap().to_bytes()).collect();
        let straight = segmenter.conclude().to_bytes();
        // Each pair by a segmenter of its own, the last one first.
        let mut known: Vec<FramePairs> = (1..frames.len())
            .rev()
            .map(|t| {
                let mut segmenter = ClipSegmenter::new(options).unwrap();
                segmenter.push(frames[t - 1].clone()).unwrap();
                segmenter.push(frames[t].clone()).unwrap()
            })
            .collect();
        known.push(ClipSegmenter::new(options).unwrap().push(frames[0].clone()).unwrap());
        known.reverse();
        let mut segmenter = ClipSegmenter::new(options).unwrap();
        for ((frame, pairs), told) in frames.iter().zip(&known).zip(&told) {
            assert!(pairs.to_bytes() == *told);
            segmenter.push_known(frame.clone(), pairs).unwrap();
        }
        assert!(straight == segmenter.conclude().to_bytes());
    }
}

#[test]
fn pairs_are_known_for_their_frames_and_options_alone() {
    let (frames, _) = moving_and_resting();
    let pairs_of = |options: ClipOptions, frames: &[Frame]| -> Vec<FramePairs> {
        let mut segmenter = ClipSegmenter::new(options).unwrap();
        frames.iter().map(|frame| segmenter.push(frame.clone()).unwrap()).collect()
    };
    let own = options(Quality::Fast, None);
    let known = pairs_of(own, &frames[..3]);
    let bytes = known[1].to_bytes();
    assert_eq!(FramePairs::from_bytes(&bytes).unwrap().to_bytes(), bytes);
    for damaged in damaged(&bytes) {
        assert!(matches!(FramePairs::from_bytes(&damaged), Err(Error::InvalidOption { name: "pairs", .. })));
    }
    let takes = |pairs: &FramePairs| {
        let mut segmenter = ClipSegmenter::new(own).unwrap();
        segmenter.push(frames[0].clone()).unwrap();
        match segmenter.push_known(frames[1].clone(), pairs) {
            Err(Error::InvalidOption { name: "pairs", .. }) => {
                segmenter.push(frames[1].clone()).unwrap();
                false
            }
            pushed => pushed.is_ok(),
        }
    };
    let two = own.pair.with_motions(MotionCount::Given(2));
    let marked = own.pair.with_mark_unknown(true);
    assert!(takes(&known[1]) && takes(&pairs_of(own.with_pair(marked), &frames[..2])[1]));
    assert!(!takes(&known[0]) && !takes(&known[2]) && !takes(&pairs_of(own, &frames[1..4])[1]));
    let subject = own.pair.with_subject(true);
    for other in
        [options(Quality::Fast, Some(1)), options(Quality::Best, None), own.with_pair(two), own.with_pair(subject)]
    {
        assert!(!takes(&pairs_of(other, &frames[..2])[1]));
    }
}

#[test]
fn undecided_pixels_are_marked_when_asked() {
    let (frames, _) = moving_and_resting();
    let marked = options(Quality::Fast, None).with_pair(options(Quality::Fast, None).pair.with_mark_unknown(true));
    let clip = whole(&frames, marked);
    let plain = moving_and_resting_clip();
    let (mut unknown, mut all) = (0, 0);
    for (marked, plain) in frames_of(&clip, &frames).iter().zip(frames_of(&plain, &frames)) {
        assert!(marked.labels.iter().zip(&plain.labels).all(|(&m, &p)| m == 255 || m == p));
        assert!(marked.objects.iter().all(|object| object.id != 255));
        unknown += marked.labels.iter().filter(|&&label| label == 255).count();
        all += marked.labels.len();
    }
    assert!(unknown > 0 && unknown < all / 10, "{unknown} of {all}");
}
