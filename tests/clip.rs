//! Clips: objects keep their number while they move, stop, cross and hide, and the stream keeps its promises.
#![allow(clippy::unwrap_used, reason = "test code may panic")]

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use veronese::clip::{
    ClipFrame, ClipOptions, ClipSegmenter, FramePairs, MAX_LOOK_AHEAD, SegmentedClip, Spread, StreamSegmenter,
};
use veronese::{Error, Frame, MotionCount, Quality, Random, SegmentOptions};

const SIZE: [usize; 2] = [160, 120];

/// A texture: smooth noise in colour, sampled between its pixels.
struct Texture(Vec<[f32; 3]>);

impl Texture {
    const SIDE: usize = 64;

    fn new(seed: u64) -> Texture {
        let mut random = Random::from_seed(seed);
        let base: [f64; 3] = std::array::from_fn(|_| random.uniform(60.0, 190.0));
        let pixel = |_| std::array::from_fn(|c| (base[c] + 45.0 * random.uniform(-1.0, 1.0)) as f32);
        Texture((0..Self::SIDE * Self::SIDE).map(pixel).collect())
    }

    fn at(&self, x: f32, y: f32) -> [f32; 3] {
        // Two pixels of the frame for one of the texture: smooth enough for sub-pixel motion.
        let (x, y) = (0.5 * x + 640.0, 0.5 * y + 640.0);
        let pixel_of = |i: usize, j: usize| self.0[(j % Self::SIDE) * Self::SIDE + i % Self::SIDE];
        let (i, j, f, g) = (x as usize, y as usize, x.fract(), y.fract());
        let (a, b, c, d) = (pixel_of(i, j), pixel_of(i + 1, j), pixel_of(i, j + 1), pixel_of(i + 1, j + 1));
        std::array::from_fn(|k| (1.0 - g) * ((1.0 - f) * a[k] + f * b[k]) + g * ((1.0 - f) * c[k] + f * d[k]))
    }
}

/// A box with its own texture. Later boxes cover earlier ones.
struct Thing {
    texture: Texture,
    size: [f32; 2],
    /// Upper left corner in each frame.
    place: fn(usize) -> [f32; 2],
}

impl Thing {
    fn covers(&self, t: usize, x: usize, y: usize) -> bool {
        let [left, top] = (self.place)(t);
        let (u, v) = (x as f32 - left, y as f32 - top);
        (0.0..self.size[0]).contains(&u) && (0.0..self.size[1]).contains(&v)
    }
}

fn thing(seed: u64, size: [f32; 2], place: fn(usize) -> [f32; 2]) -> Thing {
    Thing { texture: Texture::new(seed), size, place }
}

/// A frame of a scene, and which thing (from 1) is seen at each pixel.
fn frame(ground: u64, things: &[Thing], t: usize) -> (Frame, Vec<usize>) {
    let ground = Texture::new(ground);
    let (mut rgba, mut truth) = (Vec::new(), Vec::new());
    for y in 0..SIZE[1] {
        for x in 0..SIZE[0] {
            let seen = things.iter().rposition(|thing| thing.covers(t, x, y));
            let colour = match seen {
                Some(k) => {
                    let [left, top] = (things[k].place)(t);
                    things[k].texture.at(x as f32 - left, y as f32 - top)
                }
                None => ground.at(x as f32, y as f32),
            };
            rgba.extend(colour.map(|c| c.clamp(0.0, 255.0) as u8));
            rgba.push(255);
            truth.push(seen.map_or(0, |k| k + 1));
        }
    }
    (Frame::from_rgba(SIZE[0], SIZE[1], rgba).unwrap(), truth)
}

fn options(quality: Quality, look_ahead: Option<usize>) -> ClipOptions {
    ClipOptions { pair: SegmentOptions { quality, ..SegmentOptions::default() }, look_ahead }
}

fn whole(frames: &[Frame], options: ClipOptions) -> SegmentedClip {
    let mut segmenter = ClipSegmenter::new(options).unwrap();
    frames.iter().for_each(|frame| drop(segmenter.push(frame.clone()).unwrap()));
    segmenter.conclude()
}

fn frames_of(clip: &SegmentedClip, frames: &[Frame]) -> Vec<ClipFrame> {
    frames.iter().enumerate().map(|(t, frame)| clip.frame(t, frame).unwrap()).collect()
}

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

/// The label that most pixels of a thing have in a frame, and the IoU of both; none where less than 40 pixels of it are in sight.
fn carrier(labels: &[u8], truth: &[usize], thing: usize) -> Option<(u8, f64)> {
    let of_thing: Vec<usize> = (0..truth.len()).filter(|&p| truth[p] == thing).collect();
    if of_thing.len() < 40 {
        return None;
    }
    let count = |label: u8| of_thing.iter().filter(|&&p| labels[p] == label).count();
    let label = (0..=255u8).max_by_key(|&label| count(label)).unwrap();
    let all = labels.iter().filter(|&&l| l == label).count();
    Some((label, count(label) as f64 / (of_thing.len() + all - count(label)) as f64))
}

/// Asserts that a thing has one number, which is not that of the background, in the frames asked for; returns it.
fn one_number(done: &[ClipFrame], truths: &[Vec<usize>], thing: usize, frames: std::ops::Range<usize>) -> u8 {
    let carriers: Vec<(usize, u8, f64)> = frames
        .filter_map(|t| carrier(&done[t].labels, &truths[t], thing).map(|(label, iou)| (t, label, iou)))
        .collect();
    let number = carriers[0].1;
    assert!(number != 0 && carriers.iter().all(|c| c.1 == number), "thing {thing}: {carriers:?}");
    let mean = carriers.iter().map(|c| c.2).sum::<f64>() / carriers.len() as f64;
    assert!(mean > 0.75, "thing {thing}: {carriers:?}");
    number
}

fn scene(ground: u64, things: &[Thing], count: usize) -> (Vec<Frame>, Vec<Vec<usize>>) {
    (0..count).map(|t| frame(ground, things, t)).unzip()
}

#[cfg_attr(target_arch = "wasm32", ignore = "npm run soak")]
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

#[cfg_attr(target_arch = "wasm32", ignore = "npm run soak")]
#[test]
fn one_that_was_covered_by_another_gets_its_number_back() {
    let things = [
        thing(2, [26.0, 24.0], |t| [10.0 + 5.0 * t as f32, 46.0]),
        thing(3, [38.0, 40.0], |t| [110.0 - 5.0 * t as f32, 38.0]),
    ];
    assert_covered_and_back(things, 20);
}

#[cfg_attr(target_arch = "wasm32", ignore = "npm run soak")]
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

/// As where the rate of frames was raised.
#[cfg_attr(target_arch = "wasm32", ignore = "npm run soak")]
#[test]
fn what_moves_is_seen_in_repeated_frames_too() {
    let things = [thing(2, [34.0, 30.0], |t| [20.0 + 4.0 * (t / 2) as f32, 44.0])];
    let (frames, truths) = scene(1, &things, 20);
    for (quality, look_ahead) in [(Quality::Best, None), (Quality::Best, Some(0)), (Quality::Fast, Some(0))] {
        let done = segment(&frames, options(quality, look_ahead));
        one_number(&done, &truths, 1, 4..20);
    }
}

#[cfg_attr(target_arch = "wasm32", ignore = "npm run soak")]
#[test]
fn one_that_stops_is_still_itself() {
    let things = [thing(2, [34.0, 30.0], |t| [20.0 + 4.0 * if t < 6 { t } else { (t - 4).max(6) } as f32, 44.0])];
    let (frames, truths) = scene(1, &things, 16);
    for look_ahead in [None, Some(0), Some(4)] {
        let done = segment(&frames, options(Quality::Best, look_ahead));
        one_number(&done, &truths, 1, 2..16);
    }
}

#[cfg_attr(target_arch = "wasm32", ignore = "npm run soak")]
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

#[cfg_attr(target_arch = "wasm32", ignore = "npm run soak")]
#[test]
fn parts_that_move_together_are_one_object() {
    // A post of the background stands before it in all frames: it is never in sight as a whole.
    let things = [thing(2, [70.0, 30.0], |t| [20.0 + 2.0 * t as f32, 44.0]), thing(4, [12.0, 120.0], |_| [74.0, 0.0])];
    let (frames, truths) = scene(1, &things, 12);
    let done = segment(&frames, options(Quality::Best, None));
    one_number(&done, &truths, 1, 0..12);
    assert!(done.iter().all(|frame| frame.objects.len() == 1), "one object and no other");
}

#[cfg_attr(target_arch = "wasm32", ignore = "npm run soak")]
#[test]
fn a_cut_ends_all_objects() {
    let one = [thing(2, [34.0, 30.0], |t| [20.0 + 4.0 * t as f32, 44.0])];
    let other = [thing(6, [34.0, 30.0], |t| [20.0 + 4.0 * t as f32, 50.0])];
    let (mut frames, mut truths) = scene(1, &one, 8);
    let (after, after_truths) = scene(5, &other, 16);
    frames.extend(after.into_iter().skip(8));
    truths.extend(after_truths.into_iter().skip(8));
    for look_ahead in [None, Some(2)] {
        let done = segment(&frames, options(Quality::Best, look_ahead));
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
    assert!(matches!(
        clip.correct(2, &[255; 160 * 120], Spread::Both),
        Err(Error::InvalidOption { name: "frame", .. })
    ));
    assert!(matches!(clip.correct(0, &[255; 12], Spread::Both), Err(Error::InvalidOption { name: "corrections", .. })));
    assert!(matches!(clip.renumber(0, 3), Err(Error::InvalidOption { name: "objects", .. })));
    let mut correction = clip.correct(0, &[0; 160 * 120], Spread::Both).unwrap();
    assert!(matches!(correction.take(&mut clip, &small), Err(Error::FrameSizeMismatch { .. })));
    assert_eq!(correction.wanted(), Some(0), "it waits for the right frame");
}

/// Corrects a frame; returns the frames that have changed.
fn correct(clip: &mut SegmentedClip, frames: &[Frame], index: usize, labels: &[u8]) -> Vec<usize> {
    let mut correction = clip.correct(index, labels, Spread::Both).unwrap();
    while let Some(wanted) = correction.wanted() {
        correction.take(clip, &frames[wanted]).unwrap();
    }
    correction.changed().to_vec()
}

/// A box that moves before, between and after frames in which it rests, and one that always rests.
fn in_order(mut indices: Vec<usize>) -> Vec<usize> {
    indices.sort_unstable();
    indices
}

fn moving_and_resting() -> (Vec<Frame>, Vec<Vec<usize>>) {
    let things = [thing(2, [34.0, 30.0], |t| [10.0 + 4.0 * t as f32, 20.0]), thing(3, [40.0, 26.0], |_| [90.0, 80.0])];
    scene(1, &things, 12)
}

#[cfg_attr(target_arch = "wasm32", ignore = "npm run soak")]
#[test]
fn a_corrected_mask_holds_and_spreads_both_ways() {
    let (frames, truths) = moving_and_resting();
    let mut clip = whole(&frames, options(Quality::Fast, None));
    let before = frames_of(&clip, &frames);
    assert_eq!(carrier(&before[5].labels, &truths[5], 2).unwrap().0, 0, "what rests is background");
    let moving = one_number(&before, &truths, 1, 0..12);

    let mask: Vec<u8> = truths[5].iter().map(|&t| [0, moving, 9][t]).collect();
    let changed = correct(&mut clip, &frames, 5, &mask);
    assert!(changed.len() > 8, "{changed:?}");
    let after = frames_of(&clip, &frames);
    assert_eq!(after[5].labels, mask, "the mask holds to the pixel");
    assert_eq!(one_number(&after, &truths, 2, 1..11), 9);
    assert_eq!(one_number(&after, &truths, 1, 0..12), moving);

    // Nothing said in the same frame takes it all back.
    let restored = correct(&mut clip, &frames, 5, &[255; 160 * 120]);
    assert_eq!(in_order(restored), in_order(changed));
    for (restored, before) in frames_of(&clip, &frames).iter().zip(&before) {
        assert_eq!(restored.labels, before.labels);
    }
}

#[cfg_attr(target_arch = "wasm32", ignore = "npm run soak")]
#[test]
fn a_stroke_takes_the_region_around_it_along() {
    let (frames, truths) = moving_and_resting();
    let mut clip = whole(&frames, options(Quality::Fast, None));
    let stroke = |p: usize| (95..125).contains(&(p % SIZE[0])) && (88..96).contains(&(p / SIZE[0]));
    let ground = |p: usize| p / SIZE[0] == 116 || p / SIZE[0] == 72 || p % SIZE[0] == 84 || p % SIZE[0] == 138;
    let said = |p: usize| {
        if stroke(p) {
            7
        } else if ground(p) {
            0
        } else {
            255
        }
    };
    correct(&mut clip, &frames, 6, &(0..SIZE[0] * SIZE[1]).map(said).collect::<Vec<u8>>());
    let done = frames_of(&clip, &frames);
    for t in [3, 6, 9] {
        let (label, iou) = carrier(&done[t].labels, &truths[t], 2).unwrap();
        assert!(label == 7 && iou > 0.6, "frame {t}: {label}, {iou}");
    }
}

#[cfg_attr(target_arch = "wasm32", ignore = "npm run soak")]
#[test]
fn a_new_number_of_an_object_lasts() {
    let (frames, truths) = moving_and_resting();
    let mut clip = whole(&frames, options(Quality::Fast, None));
    let mask: Vec<u8> = truths[2].iter().map(|&t| if t == 1 { 40 } else { 255 }).collect();
    correct(&mut clip, &frames, 2, &mask);
    assert_eq!(one_number(&frames_of(&clip, &frames), &truths, 1, 0..12), 40);
}

#[cfg_attr(target_arch = "wasm32", ignore = "npm run soak")]
#[test]
fn objects_can_be_merged_and_removed() {
    let (frames, truths) = moving_and_resting();
    let mut clip = whole(&frames, options(Quality::Fast, None));
    let resting: Vec<u8> = truths[5].iter().map(|&t| if t == 2 { 30 } else { 255 }).collect();
    correct(&mut clip, &frames, 5, &resting);
    let moving = one_number(&frames_of(&clip, &frames), &truths, 1, 0..12);
    let all: Vec<usize> = (0..12).collect();
    let with_resting = clip.frames_with(30);
    assert!(clip.frames_with(moving) == all && with_resting.contains(&5));
    for (object, number) in [(moving, 31), (31, moving), (31, 0), (31, 32)] {
        assert!(clip.renumber(object, number).unwrap().is_empty(), "no object has the number 31 or 32");
    }
    assert_eq!((clip.frames_with(moving), clip.frames_with(30)), (all.clone(), with_resting));
    assert_eq!(clip.renumber(moving, 30).unwrap(), all);
    assert_eq!((clip.frames_with(moving), clip.frames_with(30)), (vec![], all.clone()));
    let merged = frames_of(&clip, &frames);
    assert!(merged.iter().all(|frame| frame.objects.iter().map(|object| object.id).eq([30])));
    assert!(merged[5].labels.iter().zip(&truths[5]).all(|(&label, &thing)| thing != 2 || label == 30));
    assert_eq!(clip.renumber(30, 0).unwrap(), all);
    assert!(
        frames_of(&clip, &frames).iter().all(|frame| frame.labels.iter().all(|&label| label != moving && label != 30))
    );
}

#[test]
fn a_saved_clip_is_the_same_and_a_damaged_one_is_refused() {
    let (frames, truths) = moving_and_resting();
    let mut clip = whole(&frames, options(Quality::Fast, None));
    let mask: Vec<u8> = truths[5].iter().map(|&t| if t == 2 { 9 } else { 255 }).collect();
    correct(&mut clip, &frames, 5, &mask);
    let bytes = clip.to_bytes();
    let again = SegmentedClip::from_bytes(&bytes).unwrap();
    for (one, other) in frames_of(&clip, &frames).iter().zip(frames_of(&again, &frames)) {
        assert_eq!((&one.labels, &one.objects), (&other.labels, &other.objects));
    }
    let refused = |bytes: &[u8]| {
        assert!(matches!(SegmentedClip::from_bytes(bytes), Err(Error::InvalidOption { name: "state", .. })));
    };
    damaged(&bytes).iter().for_each(|damaged| refused(damaged));
    let old = [b"VERCLIP2", &bytes[MARK..bytes.len() - 8]].concat();
    assert!(SegmentedClip::from_bytes(&old).unwrap_err().to_string().contains("not of this version"));
}

/// Length of the mark before what is kept.
const MARK: usize = concat!("VERCLIP3 ", env!("CARGO_PKG_VERSION"), "\n").len();

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
    let mut clip = whole(&frames, options(Quality::Fast, None));
    let mut correction = clip.correct(3, &[1; 160 * 120], Spread::Both).unwrap();
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
    let two = SegmentOptions { motions: MotionCount::Given(2), ..own.pair };
    let marked = SegmentOptions { mark_unknown: true, ..own.pair };
    assert!(takes(&known[1]) && takes(&pairs_of(ClipOptions { pair: marked, ..own }, &frames[..2])[1]));
    assert!(!takes(&known[0]) && !takes(&known[2]) && !takes(&pairs_of(own, &frames[1..4])[1]));
    for other in [options(Quality::Fast, Some(1)), options(Quality::Best, None), ClipOptions { pair: two, ..own }] {
        assert!(!takes(&pairs_of(other, &frames[..2])[1]));
    }
}

#[cfg_attr(target_arch = "wasm32", ignore = "npm run soak")]
#[test]
fn undecided_pixels_are_marked_when_asked() {
    let (frames, _) = moving_and_resting();
    let marked = ClipOptions {
        pair: SegmentOptions { mark_unknown: true, ..options(Quality::Fast, None).pair },
        ..options(Quality::Fast, None)
    };
    let clip = whole(&frames, marked);
    let plain = whole(&frames, options(Quality::Fast, None));
    let (mut unknown, mut all) = (0, 0);
    for (marked, plain) in frames_of(&clip, &frames).iter().zip(frames_of(&plain, &frames)) {
        assert!(marked.labels.iter().zip(&plain.labels).all(|(&m, &p)| m == 255 || m == p));
        assert!(marked.objects.iter().all(|object| object.id != 255));
        unknown += marked.labels.iter().filter(|&&label| label == 255).count();
        all += marked.labels.len();
    }
    assert!(unknown > 0 && unknown < all / 10, "{unknown} of {all}");
}

#[test]
fn the_same_bits_on_every_target() {
    let things = [
        thing(2, [36.0, 30.0], |t| [10.0 + 5.3 * t as f32, 40.0]),
        thing(3, [30.0, 34.0], |t| [115.0 - 4.6 * t as f32, 62.0]),
    ];
    let (frames, _) = scene(1, &things, 5);
    let hash = |look_ahead| {
        let mut hash = 0xcbf2_9ce4_8422_2325u64;
        let mut add = |value: u64| hash = (hash ^ value).wrapping_mul(0x0000_0100_0000_01b3);
        for frame in segment(&frames, options(Quality::Fast, look_ahead)) {
            frame.labels.iter().for_each(|&label| add(u64::from(label)));
            for object in &frame.objects {
                add(object.confidence.to_bits());
                object.matrix.iter().flat_map(|motion| motion.matrix).for_each(|entry| add(entry.to_bits()));
            }
        }
        hash
    };
    assert_eq!([hash(None), hash(Some(1))], [4_489_319_569_541_349_816, 9_588_751_157_850_698_864]);
}

#[test]
fn reserved_numbers_are_free_for_objects_of_a_person() {
    let (frames, truths) = moving_and_resting();
    let mut clip = whole(&frames, options(Quality::Fast, None));
    let found = frames_of(&clip, &frames);
    let (number, _) = carrier(&found[3].labels, &truths[3], 1).unwrap();
    let ids: Vec<u8> = (1..255).filter(|&id| !clip.frames_with(id).is_empty()).collect();
    assert!(number != 0 && ids.contains(&number));
    let in_frames = clip.frames_with(number);
    // The lowest number that is neither found nor reserved.
    let free = (1..255).find(|id| !ids.contains(id) && *id != 77).unwrap();
    assert_eq!(clip.reserve(&[0, number, 77, 255, number]), in_frames);
    assert_eq!((clip.frames_with(number), clip.frames_with(free)), (vec![], in_frames));
    for (before, after) in found.iter().zip(frames_of(&clip, &frames)) {
        let renumbered: Vec<u8> =
            before.labels.iter().map(|&label| if label == number { free } else { label }).collect();
        assert_eq!(after.labels, renumbered);
    }
    // A person's object has its number for good; what was found under it before has another.
    let mask: Vec<u8> = truths[3].iter().map(|&t| if t == 2 { number } else { 255 }).collect();
    correct(&mut clip, &frames, 3, &mask);
    assert_eq!(clip.reserve(&[number]), Vec::<usize>::new());
    assert!(clip.frames_with(number).contains(&3));
    let said = clip.frame(3, &frames[3]).unwrap().labels;
    assert!(mask.iter().zip(&said).all(|(&said, &label)| said != number || label == number));
    // A number that was merged away or deleted before is a new one, and what was merged into it goes along.
    let mut clip = whole(&frames, options(Quality::Fast, None));
    clip.renumber(number, 0).unwrap();
    clip.reserve(&[number]);
    assert_eq!((clip.frames_with(number), clip.frames_with(free)), (vec![], vec![]));
    correct(&mut clip, &frames, 3, &mask);
    assert!(clip.frames_with(number).contains(&3));
    // Where no number is left there is nothing to give.
    let mut clip = whole(&frames, options(Quality::Fast, None));
    clip.reserve(&(0..=255).collect::<Vec<u8>>());
    assert_eq!(clip.dropped(), ids.len());
    assert!(frames_of(&clip, &frames).iter().all(|frame| frame.labels.iter().all(|&label| label == 0)));
}
