//! Frames in, objects of the working size out.

use std::collections::VecDeque;
use std::rc::Rc;

use super::carry::continued_labels;
use super::evidence::{Flow, Pairs, flow, odds};
use super::farther::{FARTHEST, Farther, Told, shows_object};
use super::identity::{Identities, Parting};
use super::options::{ClipOptions, MAX_LOOK_AHEAD, model};
use super::record::{Newest, Record, unit_borders};
use super::round::{Foreground, Round};
use crate::error::{Error, Result};
use crate::frame::{Frame, Plane};
use crate::options::Quality;
use crate::pair::frame_motions::{Expected, Prior};
use crate::pair::settings::Settings;

/// A frame in which nothing moves is no evidence of ground if something moves in one so near to it: frames may be shown several times, as
/// where the rate was raised, or what moves stops for a moment. From 12 to 60 frames a second the third of five is this far from the others.
const REACH: usize = 2;

/// Follows objects through a clip.
#[derive(Debug)]
pub(crate) struct Tracker {
    options: ClipOptions,
    /// Whether frames are kept until they leave, to be described then.
    keeps_frames: bool,
    /// Width and height of the frames, once there is one.
    size: Option<[usize; 2]>,
    /// Frames so far.
    count: usize,
    last: Option<Newest>,
    /// The first frame of a whole clip, until there are three.
    first: Option<Newest>,
    /// Whether the newest frame waits for its pair with the next one.
    waits: bool,
    /// The expectation of a fast stream for the next pair.
    prior: Option<Prior>,
    /// The newest frames of a whole clip, which wait for what moves after them, and the odds of their own pairs.
    held: VecDeque<(Rc<Record>, Plane)>,
    farther: Farther,
    /// Frames since something moved.
    still: usize,
    rounds: [Round; 2],
    identities: Identities,
    /// The frame that went to the rounds last.
    latest: Option<Latest>,
}

/// A frame with what its own pairs tell.
#[derive(Debug)]
pub(crate) struct Latest {
    pub(crate) record: Rc<Record>,
    pub(crate) frame: Rc<Frame>,
    /// Odds of object against background, nats.
    pub(crate) odds: Plane,
}

/// A frame whose objects are known.
#[derive(Debug)]
pub(crate) struct Tracked {
    pub(crate) record: Rc<Record>,
    /// The object of every working pixel, 0 for the background.
    pub(crate) labels: Vec<u8>,
    /// Odds of object against background with the evidence of other frames, nats.
    pub(crate) odds: Plane,
    /// Whether the clip goes on with a frame of the same scene, as far as that is known.
    pub(crate) goes_on: bool,
}

impl Tracker {
    /// A tracker that keeps frames until they leave, or only what it needs of them.
    pub(crate) fn new(options: ClipOptions, keeps_frames: bool) -> Result<Tracker> {
        options.pair.motions.validate()?;
        if options.look_ahead.is_some_and(|frames| frames > MAX_LOOK_AHEAD) {
            let reason = format!("must be 0 to {MAX_LOOK_AHEAD}");
            return Err(Error::InvalidOption { name: "lookAhead", reason });
        }
        // A stream has its frames' future in the first round alone.
        let delays = options.look_ahead.map_or([MAX_LOOK_AHEAD; 2], |frames| [frames, 0]);
        let solver = Settings::solver(options.pair.quality);
        let rounds = [0, 1].map(|k| Round::new(delays[k], solver));
        let identities = Identities::new(options.pair.subject);
        Ok(Tracker {
            options,
            keeps_frames,
            size: None,
            count: 0,
            last: None,
            first: None,
            waits: false,
            prior: None,
            held: VecDeque::new(),
            farther: Farther::new(),
            still: REACH,
            rounds,
            identities,
            latest: None,
        })
    }

    pub(crate) fn options(&self) -> &ClipOptions {
        &self.options
    }

    /// Width and height of the frames, once there is one.
    pub(crate) fn size(&self) -> Option<[usize; 2]> {
        self.size
    }

    /// Takes the next frame. Returns a frame that has waited long enough, if there is one, and what the new frame's pairs have told.
    /// `known` has been told before by the same frames: nothing is solved again.
    pub(crate) fn push(&mut self, frame: Frame, known: Option<Pairs>) -> Result<(Option<Tracked>, Pairs)> {
        let size = [frame.width(), frame.height()];
        if let Some([width, height]) = self.size
            && [width, height] != size
        {
            return Err(Error::FrameSizeMismatch { first: (width, height), second: (size[0], size[1]) });
        }
        self.size = Some(size);
        let settings = self.options.settings(size);
        let pyramid = Rc::new(settings.pyramid(&frame));
        let mut newest = Newest { frame: Rc::new(frame), pyramid, repeats: false, back: None, looked_farther: false };
        let Some(last) = self.last.take() else {
            self.waits = self.options.look_ahead != Some(0);
            self.last = Some(newest.clone());
            self.first = Some(newest.clone()).filter(|_| self.options.look_ahead.is_none());
            let tracked = if self.waits { None } else { self.advance(newest, None, None) };
            return Ok((tracked, Pairs::default()));
        };
        if self.count > 0 {
            self.first = None;
        }
        newest.repeats = last.frame.colours() == newest.frame.colours();
        let pairs = known.unwrap_or_else(|| match self.options.look_ahead {
            _ if newest.repeats => self.repeated(&newest),
            None => both_ways(&last, &newest, &settings),
            Some(_) => self.backward(&last, &newest, &settings),
        });
        Ok((self.take(last, newest, pairs.clone(), &settings), pairs))
    }

    /// A frame that is repeated, as where the rate of frames was raised, has the flow of a scene at rest but says nothing of what moves. The
    /// next pair is expected to be like the last one.
    fn repeated(&self, newest: &Newest) -> Pairs {
        let size @ [width, height] = newest.pyramid.scaling.small;
        let told = || (Plane::filled(width, height, 0.0), Flow { measured: true, ..Flow::still(size) });
        let onward = (self.options.look_ahead.is_none() || self.waits).then(told);
        Pairs { onward, back: Some(told()), prior: self.prior.clone() }
    }

    /// In a stream a frame has its pair with the frame before; a fast one follows what was found there. Only the first frame may wait for the
    /// next.
    fn backward(&self, last: &Newest, newest: &Newest, settings: &Settings) -> Pairs {
        let labels = last.back.as_ref().map(|(_, flow)| continued_labels(flow));
        let expected = match (&self.prior, labels) {
            (Some(prior), Some(labels)) => Expected::Labels(prior, labels),
            _ => Expected::Nothing,
        };
        let back = newest.motions_to(&last.pyramid, settings, expected);
        if back.is_cut() {
            return Pairs::default();
        }
        let onward = self.waits.then(|| last.motions_to(&newest.pyramid, settings, Expected::Nothing));
        let prior = back.prior();
        let [onward, back] = [onward, Some(back)].map(|view| view.map(|solution| (odds(&solution), flow(solution))));
        Pairs { onward, back, prior }
    }

    /// Goes on with what the pairs of the last frame and the newest one have told.
    fn take(&mut self, mut last: Newest, newest: Newest, pairs: Pairs, settings: &Settings) -> Option<Tracked> {
        let Pairs { mut onward, back, prior } = pairs;
        self.prior = prior;
        let mut newest = Newest { back, ..newest };
        if let Some(Told { odds, reach }) = self.farther.look(&last, &newest, settings) {
            // Frames between in which nothing was seen are no evidence of ground.
            let of_last = [&mut last.back, &mut onward].into_iter().flatten().map(|(odds, _)| odds);
            let between = self.held.iter_mut().rev().take(reach - 1).map(|(_, odds)| odds).chain(of_last);
            between.filter(|odds| !shows_object(odds)).for_each(|odds| odds.values_mut().fill(0.0));
            if let Some((near, _)) = &mut newest.back {
                *near = odds;
            }
            newest.looked_farther = true;
        }
        self.last = Some(newest.clone());
        if self.options.look_ahead.is_none() {
            let (odds, onward) = onward.unzip();
            return self.advance(last, odds, onward);
        }
        if std::mem::take(&mut self.waits) {
            // With a look-ahead it does not come out yet.
            let (odds, onward) = onward.unzip();
            self.advance(last, odds, onward);
        }
        // The newest frame is expected to go on as it came.
        let expected = newest.back.as_ref().map(|(_, back)| back.continued());
        self.advance(newest, None, expected)
    }

    /// The frames that still wait, in order. The tracker is then ready for another clip, whose objects get new numbers.
    pub(crate) fn finish(&mut self) -> Vec<Tracked> {
        let Some(mut last) = self.last.take() else { return Vec::new() };
        // Two frames alone are looked at more closely, as those of a pair are; with quality fast neither are.
        let closely = self.options.pair.quality == Quality::Best && last.back.is_some() && !last.repeats;
        if let Some(first) = self.first.take().filter(|_| closely) {
            let settings = Settings::of_lone_pair(&self.options.pair, [last.frame.width(), last.frame.height()]);
            let Pairs { onward, back, .. } = both_ways(&first, &last, &settings);
            last.back = back;
            self.held.clear();
            self.count = 0;
            let (odds, onward) = onward.unzip();
            self.advance(first, odds, onward);
        }
        let mut frames = Vec::new();
        if self.waits {
            frames.extend(self.advance(last, None, None));
        }
        while !self.held.is_empty() {
            frames.extend(self.release());
        }
        while let Some(foreground) = self.rounds[0].next() {
            frames.extend(self.second_round(foreground));
        }
        while let Some(foreground) = self.rounds[1].next() {
            frames.push(self.tracked(foreground));
        }
        self.latest = None;
        (self.count, self.size, self.waits, self.prior, self.still) = (0, None, false, None, REACH);
        self.farther = Farther::new();
        frames
    }

    /// The frame that went to the rounds last, once.
    pub(crate) fn latest(&mut self) -> Option<Latest> {
        self.latest.take()
    }

    /// Number of objects that were seen when all numbers had been given, and count as background.
    pub(crate) fn dropped(&self) -> usize {
        self.identities.dropped
    }

    /// Objects that were parts of others at first, in order.
    pub(crate) fn parted(&self) -> &[Parting] {
        &self.identities.parted
    }

    /// Hands a frame to the rounds, with what is known of its way to the next one.
    fn advance(
        &mut self,
        Newest { frame, pyramid, repeats, back, looked_farther }: Newest,
        onward_odds: Option<Plane>,
        onward: Option<Flow>,
    ) -> Option<Tracked> {
        let (mut back_odds, back) = back.unzip();
        let onward_odds = onward_odds.filter(|odds| !looked_farther || shows_object(odds));
        // Both views of a lone pair make the same mistakes: the second one tells nothing new.
        if onward.is_none() && self.held.back().is_some_and(|(record, _)| record.back.is_none()) {
            back_odds.iter_mut().for_each(|odds| odds.values_mut().fill(0.0));
        }
        let moves = |flow: &Option<Flow>| flow.as_ref().is_some_and(|flow| !flow.is_still());
        // Of object against background from the frame's pairs, or from the one in which something moves; zero where there is no pair.
        let odds = match (onward_odds, back_odds) {
            (Some(moving), Some(_)) if moves(&onward) && !moves(&back) => moving,
            (Some(_), Some(moving)) if !moves(&onward) && moves(&back) => moving,
            (Some(mut odds), Some(other)) => {
                let share = model().backward;
                odds.values_mut().iter_mut().zip(other.values()).for_each(|(o, b)| *o += share * (b - *o));
                odds
            }
            (Some(only), None) | (None, Some(only)) => only,
            (None, None) => {
                let finest = &pyramid.levels[0].luminance;
                Plane::filled(finest.width(), finest.height(), 0.0)
            }
        };
        // The pyramid's levels have told all they can.
        let appearance = pyramid.appearance(&frame);
        let (palette, unit_borders) = (appearance.palette.clone(), unit_borders(appearance));
        let kept = Some(frame.clone()).filter(|_| self.keeps_frames);
        let record = Rc::new(Record { index: self.count, frame: kept, repeats, palette, unit_borders, onward, back });
        self.count += 1;
        self.latest = Some(Latest { record: record.clone(), frame, odds: odds.clone() });
        self.held.push_back((record, odds));
        let holds = if self.options.look_ahead.is_none() { FARTHEST } else { 0 };
        if self.held.len() > holds { self.release() } else { None }
    }

    /// The frame that is held longest goes to the rounds.
    fn release(&mut self) -> Option<Tracked> {
        let (record, mut odds) = self.held.pop_front()?;
        // A scene begins as if nothing had moved for long.
        let before = if record.back.is_none() { REACH } else { self.still };
        self.still = if record.is_still() { before.saturating_add(1) } else { 0 };
        let mut after = self.held.iter().take(REACH).take_while(|(record, _)| record.back.is_some());
        let is_near =
            (1..=REACH).contains(&self.still) || self.still > 0 && after.any(|(record, _)| !record.is_still());
        if is_near && !shows_object(&odds) {
            odds.values_mut().fill(0.0);
        }
        let foreground = self.rounds[0].push(record, odds)?;
        self.second_round(foreground)
    }

    /// The second round starts from the pairs' odds and the first round's cut.
    fn second_round(&mut self, first: Foreground) -> Option<Tracked> {
        // Without frames to wait for, a second look tells little that the first does not: .0015 J on ten real clips.
        let live = self.options.pair.quality == Quality::Fast && self.options.look_ahead == Some(0);
        if live || model().rounds < 2 {
            return Some(self.tracked(first));
        }
        let Foreground { record, own: mut odds, mask, .. } = first;
        for (odds, &object) in odds.values_mut().iter_mut().zip(&mask) {
            let cut = if object > 0 { model().first_cut } else { -model().first_cut };
            *odds = model().trust * *odds + cut;
        }
        let foreground = self.rounds[1].push(record, odds)?;
        Some(self.tracked(foreground))
    }

    fn tracked(&mut self, Foreground { record, odds, mask, .. }: Foreground) -> Tracked {
        let labels = self.identities.assign(&record, &mask);
        let goes_on = match &record.onward {
            None => false,
            Some(onward) if onward.measured => true,
            // A stream knows the frames that it has looked ahead to.
            Some(_) => match self.rounds[0].oldest() {
                Some(next) => next.back.is_some(),
                None => self.last.is_some() && self.options.look_ahead == Some(0),
            },
        };
        Tracked { record, labels, odds, goes_on }
    }
}

/// In a whole clip a frame has a pair with each of its neighbours.
fn both_ways(last: &Newest, newest: &Newest, settings: &Settings) -> Pairs {
    let onward = last.motions_to(&newest.pyramid, settings, Expected::Nothing);
    let inverse = flow(onward.clone()).continued();
    let labels = continued_labels(&inverse);
    let back = newest.motions_to(&last.pyramid, settings, Expected::Inverse { motions: &inverse.motions, labels });
    if onward.is_cut() && back.is_cut() {
        return Pairs::default();
    }
    let [onward, back] = [onward, back].map(|solution| Some((odds(&solution), flow(solution))));
    Pairs { onward, back, prior: None }
}
