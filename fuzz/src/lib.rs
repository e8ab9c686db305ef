//! Inputs of several targets: small frames with something that moves, options, and clips of three frames.

use std::sync::OnceLock;

use libfuzzer_sys::arbitrary::{self, Arbitrary};
use veronese::clip::{
    Annotation, Clip, ClipOptions, ClipSegmenter, Command, Content, FramePairs, OpenOptions, SegmentedClip, Spread,
};
use veronese::{Frame, MotionCount, Quality, SegmentOptions};

/// A film: a texture that moves, and a box of it that moves otherwise.
#[derive(Arbitrary, Debug)]
pub struct Film<'a> {
    size: [u8; 2],
    ground: [i8; 2],
    thing: [i8; 2],
    place: [u8; 4],
    texture: &'a [u8],
}

impl Film<'_> {
    /// Width and height, 16 to 48 pixels.
    pub fn size(&self) -> [usize; 2] {
        self.size.map(|side| 16 + usize::from(side) % 33)
    }

    /// The frame at a time.
    pub fn frame(&self, time: i64) -> Frame {
        let [width, height] = self.size();
        let moved = |speed: [i8; 2]| speed.map(|v| time * i64::from(v % 8));
        let ([gx, gy], [tx, ty]) = (moved(self.ground), moved(self.thing));
        let [left, top, wide, high] = self.place.map(|p| i64::from(p % 48));
        let grey = |x: i64, y: i64| match self.texture.len() as i64 {
            0 => 128,
            n => self.texture[(31 * y + x).rem_euclid(n) as usize],
        };
        let pixel = |x: i64, y: i64| {
            let inside = (0..wide).contains(&(x - left - tx)) && (0..high).contains(&(y - top - ty));
            let value = if inside { 255 - grey(x - tx, y - ty) } else { grey(x - gx, y - gy) };
            [value, value.rotate_left(1), value, 255]
        };
        let rgba: Vec<u8> = (0..height as i64).flat_map(|y| (0..width as i64).flat_map(move |x| pixel(x, y))).collect();
        Frame::from_rgba(width, height, rgba).expect("the size is supported")
    }
}

/// Options of a pair and of a clip, some of which are refused.
#[derive(Arbitrary, Debug)]
pub struct Choices {
    motions: Option<u8>,
    best: bool,
    mark_unknown: bool,
    confidence: bool,
    look_ahead: Option<u8>,
}

impl Choices {
    /// The number of motions; 0 and those above 10 are refused.
    pub fn motions(&self) -> MotionCount {
        self.motions.map_or(MotionCount::Auto, |n| MotionCount::Given(usize::from(n % 13)))
    }

    /// Options of a pair.
    pub fn pair(&self) -> SegmentOptions {
        SegmentOptions::default()
            .with_motions(self.motions())
            .with_quality(if self.best { Quality::Best } else { Quality::Fast })
            .with_mark_unknown(self.mark_unknown)
            .with_confidence(self.confidence)
    }

    /// Options of a clip; a look-ahead above 8 is refused.
    pub fn clip(&self) -> ClipOptions {
        ClipOptions::default().with_pair(self.pair()).with_look_ahead(self.look_ahead.map(|n| usize::from(n % 10)))
    }
}

/// A clip that is always the same: a box of 12 × 10 pixels moves over a ground of 32 × 24.
pub struct Known {
    pub frames: Vec<Frame>,
    /// The pairs of each frame with those before it.
    pub pairs: Vec<FramePairs>,
    /// The journal of the segmented clip: two steps after that, one undone, and one that has not taken effect.
    pub journal: Vec<u8>,
}

/// Options of [`known`].
pub fn known_options() -> ClipOptions {
    ClipOptions::default().with_pair(SegmentOptions::default().with_quality(Quality::Fast))
}

/// The [`Known`] clip, segmented once.
pub fn known() -> &'static Known {
    static KNOWN: OnceLock<Known> = OnceLock::new();
    KNOWN.get_or_init(|| {
        let texture: Vec<u8> = (0..997_u32).map(|k| (k.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
        let film = Film { size: [16, 8], ground: [0, 0], thing: [3, 1], place: [6, 6, 12, 10], texture: &texture };
        let frames: Vec<Frame> = (0..3).map(|t| film.frame(t)).collect();
        let mut segmenter = ClipSegmenter::new(known_options()).expect("the options are valid");
        let pairs =
            frames.iter().map(|frame| segmenter.push(frame.clone()).expect("the frames have one size")).collect();
        let mut clip = Clip::new(frames.len(), OpenOptions::default()).expect("the clip is short");
        let labels: Vec<u8> = (0..32 * 24).map(|p| if p % 32 < 9 { 1 } else { 255 }).collect();
        let content = Content::Strokes { object: 7, labels };
        let exact = Annotation { frame: 0, content: content.clone(), spread: Spread::Exact };
        let segment = Command::Segment { frames: 0..frames.len(), options: known_options().pair };
        let annotate = Command::Annotate(vec![Annotation::new(1, content)]);
        for command in [segment.clone(), annotate.clone(), Command::Annotate(vec![exact])] {
            clip.apply(command).expect("the command is valid");
            run(&mut clip, &frames);
        }
        clip.undo();
        clip.apply(segment).expect("the range is valid");
        clip.take(0, &frames[0], None).expect("it is a frame of the clip");
        clip.apply(annotate).expect("the command is valid");
        Known { frames, pairs, journal: clip.take_events().records }
    })
}

/// Gives a clip the frames that it wants, as far as there are such; steps that cannot go on are cancelled.
pub fn run(clip: &mut Clip, frames: &[Frame]) {
    for _ in 0..500 {
        let Some(wanted) = clip.wanted() else { return };
        let taken = frames.get(wanted.frame).map(|frame| clip.take(wanted.frame, frame, None).is_ok());
        if taken != Some(true) {
            match wanted.step {
                Some(step) => assert!(clip.cancel(step), "a step under way can be cancelled"),
                None => clip.look_at(usize::MAX),
            }
        }
    }
    panic!("a clip of few frames ends");
}

/// Asks an opened clip for all that can be asked: every frame, and its own bytes back.
pub fn check_opened(clip: &mut Clip, frames: &[Frame]) {
    run(clip, frames);
    let [width, height] = clip.size();
    for index in 0..clip.len() {
        clip.look_at(index);
        run(clip, frames);
        if let Some(found) = clip.labels(index) {
            assert_eq!(found.labels.len(), width * height);
        }
    }
    drop((clip.tracks(), clip.next_object()));
    let saved = clip.save();
    let mut again = Clip::read(&saved, OpenOptions::default()).expect("a clip reads what it has written");
    assert!(again.used == saved.len() && !again.is_damaged);
    assert_eq!((again.clip.frames(), again.clip.objects()), (clip.frames(), clip.objects()));
    while clip.undo() {
        assert!(again.clip.undo());
        assert_eq!((again.clip.frames(), again.clip.objects()), (clip.frames(), clip.objects()));
    }
}

/// Asks a clip for all that can be asked: every frame, and its own bytes back.
pub fn check_clip(clip: &SegmentedClip, frames: &[Frame]) {
    let [width, height] = clip.size();
    for (index, frame) in frames.iter().enumerate() {
        if let Ok(found) = clip.frame(index, frame) {
            assert_eq!(found.labels.len(), width * height);
            for object in &found.objects {
                assert_eq!(object.pixels, found.labels.iter().filter(|&&label| label == object.id).count());
            }
        }
    }
    for object in 0..=255 {
        assert!(clip.frames_with(object).iter().all(|&index| index < clip.len()));
    }
    let bytes = clip.to_bytes();
    let again = SegmentedClip::from_bytes(&bytes).expect("a clip reads what it has written");
    assert_eq!(again.to_bytes(), bytes);
}

/// One change of some bytes.
#[derive(Arbitrary, Debug)]
pub enum Edit {
    Set { at: u16, value: u8 },
    Word { at: u16, value: u32 },
    Number { at: u16, value: f64 },
    Cut { at: u16, count: u8 },
    Insert { at: u16, value: u8, count: u8 },
}

/// The bytes with changes. Where they are past the end, they begin again.
pub fn edited(bytes: &[u8], edits: &[Edit]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let overwrite = |bytes: &mut Vec<u8>, at: u16, value: &[u8]| {
        let start = usize::from(at) % bytes.len().max(1);
        bytes.iter_mut().skip(start).zip(value).for_each(|(byte, value)| *byte = *value);
    };
    for edit in edits {
        match *edit {
            Edit::Set { at, value } => overwrite(&mut bytes, at, &[value]),
            Edit::Word { at, value } => overwrite(&mut bytes, at, &value.to_le_bytes()),
            Edit::Number { at, value } => overwrite(&mut bytes, at, &value.to_le_bytes()),
            Edit::Cut { at, count } => {
                let start = usize::from(at) % bytes.len().max(1);
                let end = bytes.len().min(start + usize::from(count));
                bytes.drain(start..end);
            }
            Edit::Insert { at, value, count } => {
                let start = usize::from(at) % bytes.len().max(1);
                bytes.splice(start..start, std::iter::repeat_n(value, usize::from(count)));
            }
        }
    }
    bytes
}
