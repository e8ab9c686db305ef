//! Small scenes of boxes that move over a ground, and clips of them.

use std::sync::LazyLock;

use veronese::clip::{Annotations, ClipFrame, ClipOptions, ClipSegmenter, Painted, SegmentedClip, Spread};
use veronese::{Frame, Quality, Random, SegmentOptions};

pub const SIZE: [usize; 2] = [160, 120];

/// A texture: smooth noise in colour, sampled between its pixels.
pub struct Texture(Vec<[f32; 3]>);

impl Texture {
    const SIDE: usize = 64;

    pub fn new(seed: u64) -> Texture {
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
pub struct Thing {
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

pub fn thing(seed: u64, size: [f32; 2], place: fn(usize) -> [f32; 2]) -> Thing {
    Thing { texture: Texture::new(seed), size, place }
}

/// A frame of a scene, and which thing (from 1) is seen at each pixel.
pub fn frame(size: [usize; 2], ground: &Texture, things: &[Thing], t: usize) -> (Frame, Vec<usize>) {
    noisy_frame(size, ground, things, t, 0.0)
}

/// As [`frame`], each pixel with noise of at most so many grey levels, other noise in each frame.
fn noisy_frame(
    [width, height]: [usize; 2],
    ground: &Texture,
    things: &[Thing],
    t: usize,
    noise: f64,
) -> (Frame, Vec<usize>) {
    let mut random = Random::from_seed(t as u64);
    let (mut rgba, mut truth) = (Vec::new(), Vec::new());
    for y in 0..height {
        for x in 0..width {
            let seen = things.iter().rposition(|thing| thing.covers(t, x, y));
            let colour = match seen {
                Some(k) => {
                    let [left, top] = (things[k].place)(t);
                    things[k].texture.at(x as f32 - left, y as f32 - top)
                }
                None => ground.at(x as f32, y as f32),
            };
            let added = random.uniform(-noise, noise) as f32;
            rgba.extend(colour.map(|c| (c + added).clamp(0.0, 255.0) as u8));
            rgba.push(255);
            truth.push(seen.map_or(0, |k| k + 1));
        }
    }
    (Frame::from_rgba(width, height, rgba).unwrap(), truth)
}

pub fn options(quality: Quality, look_ahead: Option<usize>) -> ClipOptions {
    let pair = SegmentOptions::default().with_quality(quality);
    ClipOptions::default().with_pair(pair).with_look_ahead(look_ahead)
}

pub fn whole(frames: &[Frame], options: ClipOptions) -> SegmentedClip {
    let mut segmenter = ClipSegmenter::new(options).unwrap();
    frames.iter().for_each(|frame| drop(segmenter.push(frame.clone()).unwrap()));
    segmenter.conclude()
}

pub fn frames_of(clip: &SegmentedClip, frames: &[Frame]) -> Vec<ClipFrame> {
    frames.iter().enumerate().map(|(t, frame)| clip.frame(t, frame).unwrap()).collect()
}

pub fn scene(ground: u64, things: &[Thing], count: usize) -> (Vec<Frame>, Vec<Vec<usize>>) {
    scene_of(SIZE, ground, things, count)
}

pub fn scene_of(size: [usize; 2], ground: u64, things: &[Thing], count: usize) -> (Vec<Frame>, Vec<Vec<usize>>) {
    let ground = Texture::new(ground);
    (0..count).map(|t| frame(size, &ground, things, t)).unzip()
}

/// A scene as a codec or a camera gives it, with noise of 2 grey levels.
pub fn noisy_scene(ground: u64, things: &[Thing], count: usize) -> (Vec<Frame>, Vec<Vec<usize>>) {
    let ground = Texture::new(ground);
    (0..count).map(|t| noisy_frame(SIZE, &ground, things, t, 2.0)).unzip()
}

/// The label that most pixels of a thing have in a frame, and the IoU of both; none where less than 40 pixels of it are in sight.
pub fn carrier(labels: &[u8], truth: &[usize], thing: usize) -> Option<(u8, f64)> {
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
pub fn one_number(done: &[ClipFrame], truths: &[Vec<usize>], thing: usize, frames: std::ops::Range<usize>) -> u8 {
    let carriers: Vec<(usize, u8, f64)> = frames
        .filter_map(|t| carrier(&done[t].labels, &truths[t], thing).map(|(label, iou)| (t, label, iou)))
        .collect();
    let number = carriers[0].1;
    assert!(number != 0 && carriers.iter().all(|c| c.1 == number), "thing {thing}: {carriers:?}");
    let mean = carriers.iter().map(|c| c.2).sum::<f64>() / carriers.len() as f64;
    assert!(mean > 0.75, "thing {thing}: {carriers:?}");
    number
}

/// A box that moves, and one that rests. Made once, as its clip: many tests begin with them.
pub fn moving_and_resting() -> (Vec<Frame>, Vec<Vec<usize>>) {
    static MADE: LazyLock<(Vec<Frame>, Vec<Vec<usize>>)> = LazyLock::new(|| {
        let things =
            [thing(2, [34.0, 30.0], |t| [10.0 + 4.0 * t as f32, 20.0]), thing(3, [40.0, 26.0], |_| [90.0, 80.0])];
        scene(1, &things, 12)
    });
    MADE.clone()
}

/// The clip of [`moving_and_resting`], in quality fast.
pub fn moving_and_resting_clip() -> SegmentedClip {
    static MADE: LazyLock<SegmentedClip> =
        LazyLock::new(|| whole(&moving_and_resting().0, options(Quality::Fast, None)));
    MADE.clone()
}

/// A label map of a frame: a number for some things, 255 elsewhere.
pub fn mask(truth: &[usize], numbers: &[(usize, u8)]) -> Vec<u8> {
    truth.iter().map(|t| numbers.iter().find(|(thing, _)| thing == t).map_or(255, |(_, number)| *number)).collect()
}

/// Corrects a frame; returns the frames that have changed, in order.
pub fn correct(clip: &mut SegmentedClip, frames: &[Frame], index: usize, labels: &[u8]) -> Vec<usize> {
    correct_some(clip, frames, index, labels, Spread::Both)
}

/// [`correct`], but not to all sides.
pub fn correct_some(
    clip: &mut SegmentedClip,
    frames: &[Frame],
    index: usize,
    labels: &[u8],
    spread: Spread,
) -> Vec<usize> {
    let corrections = vec![Painted { frame: index, object: None, labels: labels.to_vec(), spread }];
    annotate(clip, frames, Annotations { corrections, ..Annotations::default() })
}

/// Says something of a clip. Returns the frames that change, in ascending order.
pub fn annotate(clip: &mut SegmentedClip, frames: &[Frame], annotations: Annotations) -> Vec<usize> {
    let mut job = clip.annotate(annotations).unwrap();
    while let Some(wanted) = job.wanted() {
        job.take(clip, &frames[wanted]).unwrap();
    }
    let mut changed = job.changed().to_vec();
    changed.sort_unstable();
    changed
}

/// Gives an object another number.
pub fn renumber(clip: &mut SegmentedClip, object: u8, number: u8) -> Vec<usize> {
    annotate(clip, &[], Annotations { numbers: vec![[object, number]], ..Annotations::default() })
}
