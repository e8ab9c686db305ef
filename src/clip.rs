//! Clips: objects that keep their number from their first frame to their last.
//!
//! 1. Each frame is prepared once and solved in pairs with the next frame and the one before (`clip/evidence.rs`).
//! 2. Two rounds carry the evidence along the motions, learn colours and cut the foreground (`clip/round.rs`). The second starts from the
//!    first one's cut.
//! 3. The foreground of each frame is handed to the objects of the frame before, or to new ones (`clip/identity.rs`).
//! 4. Labels are upsampled along the edges of the full frame.

mod carry;
mod colours;
mod evidence;
mod identity;
mod record;
mod round;

use std::rc::Rc;

use serde::Serialize;

use crate::error::{Error, Result};
use crate::frame::pyramid::FramePyramid;
use crate::frame::{Frame, Plane};
use crate::labelling::BACKGROUND;
use crate::labelling::resolution::upsampling::upsample;
use crate::motion::AffineMotion;
use crate::options::SegmentOptions;
use crate::pair::settings::Settings;
use crate::pair::solution::{Prior, Solution, solve};
use crate::workspace;
use evidence::{Flow, flow, odds};
use identity::Identities;
use record::Record;
use round::{Foreground, Round};

/// Frames that a frame of a whole clip waits for, half of them in each round. Evidence from eight frames away has decayed to a sixth in
/// the first round and to a seventeenth in the second.
const WHOLE_CLIP: usize = 16;
/// Largest look-ahead of a stream, frames.
pub const MAX_LOOK_AHEAD: usize = 8;
/// Share of a frame's evidence that is left a frame later, in each round. Of ten real clips, .9 for the first and .85 for the second
/// change J by less than .001.
const DECAYS: [f32; 2] = [0.8, 0.7];
/// Weight of the pairs' odds in the second round; on ten real clips .8 costs .003 J, …
const SECOND_ROUND_ODDS: f32 = 0.5;
/// … and what the cut of the first round adds for or against an object, nats; 2.5 costs .003.
const FIRST_CUT: f32 = 1.5;

/// Options of a [`ClipSegmenter`].
#[derive(Clone, Copy, Debug, Default)]
pub struct ClipOptions {
    /// Options of each pair. `mark_unknown` and `confidence` have no effect.
    pub pair: SegmentOptions,
    /// Frames that each frame waits for, 0…[`MAX_LOOK_AHEAD`]. None stands for a whole clip: frames wait for as many as can matter.
    pub look_ahead: Option<usize>,
}

/// One frame of a clip, segmented.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ClipFrame {
    /// Position in the clip, from 0.
    pub index: usize,
    /// One label per pixel, row by row: 0 for the background, else the number of an object.
    #[serde(skip)]
    pub labels: Vec<u8>,
    /// The objects in sight, by number.
    pub objects: Vec<ClipObject>,
    /// Motion of the background to the next frame, pixels; none where there is no next frame of the same scene. In a stream, the motion with
    /// which it came to this frame.
    pub background: Option<AffineMotion>,
}

/// An object in one frame of a clip.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ClipObject {
    /// Its number, 1…254, the same in all frames.
    pub id: u8,
    /// Number of its pixels.
    pub pixels: usize,
    /// Bounding box of its pixels: x, y, width, height.
    pub bbox: [usize; 4],
    /// Mean probability, 0…1, that its pixels belong to an object.
    pub confidence: f64,
    /// Motion of its largest part, as [`ClipFrame::background`].
    pub matrix: Option<AffineMotion>,
}

/// Segments a clip frame by frame. Frames go in one after another and come out, in order, with labels that last.
///
/// ```
/// use veronese::clip::{ClipOptions, ClipSegmenter};
/// use veronese::scene::{self, SceneOptions};
///
/// # fn main() -> veronese::Result<()> {
/// let scene = scene::generate(&SceneOptions { width: 160, height: 120, objects: 1, ..SceneOptions::default() })?;
/// let mut clip = ClipSegmenter::new(ClipOptions { look_ahead: Some(0), ..ClipOptions::default() })?;
/// let mut frames = Vec::new();
/// for frame in [scene.first(), scene.second()] {
///     frames.extend(clip.push(frame.clone())?);
/// }
/// frames.extend(clip.finish());
/// assert_eq!(frames.len(), 2);
/// assert!(frames.iter().all(|frame| frame.labels.len() == 160 * 120));
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct ClipSegmenter {
    options: ClipOptions,
    /// Frames so far.
    count: usize,
    last: Option<Newest>,
    /// Whether the newest frame waits for its pair with the next one.
    waits: bool,
    /// What is expected of the next pair.
    prior: Option<Prior>,
    rounds: [Round; 2],
    identities: Identities,
}

/// The newest frame.
#[derive(Clone, Debug)]
struct Newest {
    frame: Rc<Frame>,
    pyramid: Rc<FramePyramid>,
    /// Odds and flow of the pair with the frame before.
    back: Option<(Plane, Flow)>,
}

impl ClipSegmenter {
    /// A segmenter for one clip.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] for a look-ahead above [`MAX_LOOK_AHEAD`] or a number of motions out of range.
    pub fn new(options: ClipOptions) -> Result<ClipSegmenter> {
        options.pair.motions.validate()?;
        if options.look_ahead.is_some_and(|frames| frames > MAX_LOOK_AHEAD) {
            let reason = format!("must be 0 to {MAX_LOOK_AHEAD}");
            return Err(Error::InvalidOption { name: "lookAhead", reason });
        }
        // A stream has its frames' future in the first round alone.
        let delays = options.look_ahead.map_or([WHOLE_CLIP / 2; 2], |frames| [frames, 0]);
        let solver = Settings::solver(options.pair.quality);
        let rounds = [0, 1].map(|k| Round::new(DECAYS[k], delays[k], solver));
        let identities = Identities::new();
        Ok(ClipSegmenter { options, count: 0, last: None, waits: false, prior: None, rounds, identities })
    }

    /// Takes the next frame. Returns a frame that has waited long enough, if there is one.
    ///
    /// # Errors
    /// [`Error::FrameSizeMismatch`]; the clip may go on with another frame.
    pub fn push(&mut self, frame: Frame) -> Result<Option<ClipFrame>> {
        let size = [frame.width(), frame.height()];
        if let Some(last) = &self.last
            && [last.frame.width(), last.frame.height()] != size
        {
            let first = (last.frame.width(), last.frame.height());
            return Err(Error::FrameSizeMismatch { first, second: (size[0], size[1]) });
        }
        let _call = workspace::begin(size);
        let settings = Settings::new(&self.options.pair, size);
        let pyramid = Rc::new(settings.pyramid(&frame));
        let newest = Newest { frame: Rc::new(frame), pyramid, back: None };
        match (self.options.look_ahead, self.last.take()) {
            (None, last) => Ok(self.push_with_both(last, newest, &settings)),
            (Some(_), last) => Ok(self.push_with_back(last, newest, &settings)),
        }
    }

    /// In a whole clip a frame has two pairs: it waits for the next frame.
    fn push_with_both(&mut self, last: Option<Newest>, newest: Newest, settings: &Settings) -> Option<ClipFrame> {
        self.waits = true;
        let Some(last) = last else {
            self.last = Some(newest);
            return None;
        };
        let onward = self.solve(&last, &newest, self.prior.as_ref(), settings);
        let back = self.solve(&newest, &last, Some(&onward.reversed()), settings);
        self.prior = Some(back.reversed());
        let [onward, back] = if onward.is_cut() && back.is_cut() {
            self.prior = None;
            [None, None]
        } else {
            [onward, back].map(|solution| Some((odds(&solution), flow(solution))))
        };
        self.last = Some(Newest { back, ..newest });
        self.advance(last, onward)
    }

    /// In a stream a frame has its pair with the frame before, near what was found there, and is expected to go on as it came. Only the
    /// first frame may wait for the next.
    fn push_with_back(&mut self, last: Option<Newest>, mut newest: Newest, settings: &Settings) -> Option<ClipFrame> {
        let Some(last) = last else {
            self.waits = self.options.look_ahead != Some(0);
            self.last = Some(newest.clone());
            return if self.waits { None } else { self.advance(newest, None) };
        };
        let back = self.solve(&newest, &last, self.prior.as_ref(), settings);
        if self.waits {
            let onward = (!back.is_cut()).then(|| self.solve(&last, &newest, None, settings));
            // With a look-ahead it does not come out yet.
            self.advance(last, onward.map(|solution| (odds(&solution), flow(solution))));
            self.waits = false;
        }
        self.prior = (!back.is_cut()).then(|| back.prior());
        newest.back = (!back.is_cut()).then(|| (odds(&back), flow(back)));
        self.last = Some(newest.clone());
        let onward = newest.back.as_ref().map(|(_, back)| back.continued());
        self.advance_with(newest, None, onward)
    }

    fn solve(&self, first: &Newest, second: &Newest, prior: Option<&Prior>, settings: &Settings) -> Solution {
        solve(&first.frame, &first.pyramid, &second.pyramid, settings, prior, self.options.pair.seed)
    }

    /// The frames that still wait. The segmenter is then ready for another clip, whose objects get new numbers.
    pub fn finish(&mut self) -> Vec<ClipFrame> {
        let Some(last) = self.last.take() else { return Vec::new() };
        let _call = workspace::begin([last.frame.width(), last.frame.height()]);
        let mut frames = Vec::new();
        if std::mem::take(&mut self.waits) {
            frames.extend(self.advance(last, None));
        }
        while let Some(foreground) = self.rounds[0].next() {
            frames.extend(self.second_round(foreground));
        }
        while let Some(foreground) = self.rounds[1].next() {
            frames.push(self.labelled(foreground));
        }
        (self.count, self.prior) = (0, None);
        frames
    }

    /// Number of objects that were seen when all numbers had been given, and count as background.
    pub fn dropped(&self) -> usize {
        self.identities.dropped
    }

    fn advance(&mut self, newest: Newest, onward: Option<(Plane, Flow)>) -> Option<ClipFrame> {
        let (odds, onward) = onward.unzip();
        self.advance_with(newest, odds, onward)
    }

    /// Hands a frame to the rounds, with what is known of its way to the next one.
    fn advance_with(
        &mut self,
        Newest { frame, pyramid, back }: Newest,
        onward_odds: Option<Plane>,
        onward: Option<Flow>,
    ) -> Option<ClipFrame> {
        let (back_odds, back) = back.unzip();
        let odds = match (onward_odds, back_odds) {
            (Some(mut odds), Some(other)) => {
                odds.values_mut().iter_mut().zip(other.values()).for_each(|(o, b)| *o = 0.5 * (*o + b));
                odds
            }
            (Some(only), None) | (None, Some(only)) => only,
            (None, None) => {
                let finest = &pyramid.levels[0].luminance;
                Plane::filled(finest.width(), finest.height(), 0.0)
            }
        };
        // The pyramid's levels have told all they can.
        let (appearance, reduction) = (pyramid.appearance(&frame).clone(), pyramid.reduction);
        let record = Rc::new(Record { index: self.count, frame, appearance, reduction, odds, onward, back });
        self.count += 1;
        let odds = record.odds.clone();
        let foreground = self.rounds[0].push(record, odds)?;
        self.second_round(foreground)
    }

    /// The second round starts from the pairs' odds and the first round's cut.
    fn second_round(&mut self, Foreground { record, mask, .. }: Foreground) -> Option<ClipFrame> {
        let mut odds = record.odds.clone();
        for (odds, &object) in odds.values_mut().iter_mut().zip(&mask) {
            let cut = if object > 0 { FIRST_CUT } else { -FIRST_CUT };
            *odds = SECOND_ROUND_ODDS * *odds + cut;
        }
        let foreground = self.rounds[1].push(record, odds)?;
        Some(self.labelled(foreground))
    }

    fn labelled(&mut self, Foreground { record, odds, mask }: Foreground) -> ClipFrame {
        let working = self.identities.assign(&record, &mask);
        let of = working.iter().max().map_or(1, |&most| usize::from(most) + 1);
        let labels = upsample(&working, record.size(), of, record.frame.luminance());
        let scale = |motion: &AffineMotion| motion.scaled(record.reduction as f64);
        let background = record.onward.as_ref().map(|onward| scale(&onward.motions[BACKGROUND]));
        let mut objects = boxes(&labels, record.frame.width());
        for object in &mut objects {
            object.confidence = confidence(&odds, &working, object.id);
            object.matrix =
                record.onward.as_ref().map(|onward| scale(&onward.motions[largest(onward, &working, object.id)]));
        }
        ClipFrame { index: record.index, labels, objects, background }
    }
}

/// Pixels and bounding box of every object of some labels.
fn boxes(labels: &[u8], width: usize) -> Vec<ClipObject> {
    let mut corners = [[usize::MAX, usize::MAX, 0, 0]; 256];
    let mut pixels = [0usize; 256];
    for (p, &label) in labels.iter().enumerate() {
        let (k, x, y) = (usize::from(label), p % width, p / width);
        let [left, top, right, bottom] = corners[k];
        corners[k] = [left.min(x), top.min(y), right.max(x + 1), bottom.max(y + 1)];
        pixels[k] += 1;
    }
    let described = |k: u8| {
        let ([left, top, right, bottom], pixels) = (corners[usize::from(k)], pixels[usize::from(k)]);
        let bbox = [left, top, right.wrapping_sub(left), bottom.wrapping_sub(top)];
        (pixels > 0).then_some(ClipObject { id: k, pixels, bbox, confidence: 0.0, matrix: None })
    };
    (1..=u8::MAX).filter_map(described).collect()
}

/// Mean probability of an object over the working pixels of one.
fn confidence(odds: &Plane, labels: &[u8], id: u8) -> f64 {
    let probability = |odds: f32| f64::from(1.0 / (1.0 + libm::expf(-odds)));
    let of_object = odds.values().iter().zip(labels).filter(|(_, label)| **label == id);
    let (sum, count) = of_object.fold((0.0, 0usize), |(sum, count), (odds, _)| (sum + probability(*odds), count + 1));
    sum / count.max(1) as f64
}

/// The motion that most of an object's working pixels have.
fn largest(onward: &Flow, labels: &[u8], id: u8) -> usize {
    let mut counts = vec![0usize; onward.motions.len()];
    labels
        .iter()
        .zip(&onward.labels)
        .filter(|(label, _)| **label == id)
        .for_each(|(_, &k)| counts[usize::from(k)] += 1);
    (0..counts.len()).rev().max_by_key(|&k| counts[k]).unwrap_or(BACKGROUND)
}
