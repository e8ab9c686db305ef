//! From frames to objects at the working size: each frame is paired with its neighbours, held back, cut, and divided into objects.

use std::sync::Arc;

use super::farther::{FARTHEST, Farther, FartherPair};
use super::foreground::{Foreground, Round};
use super::held::HeldFrames;
use super::identity::{Identities, Parting};
use super::options::{ClipOptions, MAX_LOOK_AHEAD, model};
use super::pairing;
use super::pairs::{LayeredMotion, Pairs, shows_object};
use super::record::{PendingFrame, Record};
use crate::error::{Error, Result};
use crate::frame::{Frame, Plane};
use crate::options::Quality;
use crate::pair::frame_motions::Prior;
use crate::pair::settings::Settings;

/// Follows objects through a clip.
#[derive(Debug)]
pub(crate) struct Tracker {
    options: ClipOptions,
    /// Whether frames are kept until they leave, in order to describe them.
    keeps_frames: bool,
    /// Width and height of the frames, once there is one.
    size: Option<[usize; 2]>,
    /// The first frame of a whole clip, until there are three.
    first: Option<PendingFrame>,
    /// The newest frame.
    last: Option<PendingFrame>,
    /// Number of frames whose pairs are solved. If the newest frame is not among them, it waits for its pair with the next one.
    paired: usize,
    /// What a fast stream expects of the next pair.
    prior: Option<Prior>,
    farther: Farther,
    held: HeldFrames,
    rounds: [Round; 2],
    identities: Identities,
    /// The last frame whose pairs were solved.
    preview: Option<PreviewSource>,
}

/// A frame with the results of its own pairs.
#[derive(Debug)]
pub(crate) struct PreviewSource {
    pub(crate) record: Arc<Record>,
    pub(crate) frame: Arc<Frame>,
    /// Log-odds of object against background, nats.
    pub(crate) log_odds: Plane,
}

/// A frame whose objects are known.
#[derive(Debug)]
pub(crate) struct Tracked {
    pub(crate) record: Arc<Record>,
    /// The object of every working pixel, 0 for the background.
    pub(crate) labels: Vec<u8>,
    /// Log-odds of object against background, joined with those of other frames, nats.
    pub(crate) log_odds: Plane,
    /// Whether a frame of the same scene follows, as far as that is known.
    pub(crate) goes_on: bool,
}

impl Tracker {
    /// A tracker that keeps whole frames until they leave, or only what it needs of them.
    pub(crate) fn new(options: ClipOptions, keeps_frames: bool) -> Result<Tracker> {
        options.pair.motions.validate()?;
        if options.look_ahead.is_some_and(|frames| frames > MAX_LOOK_AHEAD) {
            let reason = format!("must be 0 to {MAX_LOOK_AHEAD}");
            return Err(Error::InvalidOption { name: "lookAhead", reason });
        }
        let identities = Identities::new(options.pair.subject);
        Ok(Tracker::empty(options, keeps_frames, identities))
    }

    fn empty(options: ClipOptions, keeps_frames: bool, identities: Identities) -> Tracker {
        let solver = Settings::solver(options.pair.quality);
        Tracker {
            options,
            keeps_frames,
            size: None,
            first: None,
            last: None,
            paired: 0,
            prior: None,
            farther: Farther::new(),
            // A stream knows no frame after the newest one whose pairs are solved.
            held: HeldFrames::new(if options.look_ahead.is_none() { FARTHEST } else { 0 }),
            // In a stream only the first round waits for later frames.
            rounds: options
                .look_ahead
                .map_or([MAX_LOOK_AHEAD; 2], |frames| [frames, 0])
                .map(|delay| Round::new(delay, solver)),
            identities,
            preview: None,
        }
    }

    pub(crate) fn options(&self) -> &ClipOptions {
        &self.options
    }

    /// Width and height of the frames, once there is one.
    pub(crate) fn size(&self) -> Option<[usize; 2]> {
        self.size
    }

    /// Takes the next frame. Returns a frame that has waited long enough, if there is one, and the solved pairs of the new frame. `known`
    /// are its pairs if they were solved before.
    pub(crate) fn push(&mut self, frame: Frame, known: Option<Pairs>) -> Result<(Option<Tracked>, Pairs)> {
        let size = [frame.width(), frame.height()];
        if let Some([width, height]) = self.size
            && [width, height] != size
        {
            return Err(Error::FrameSizeMismatch { first: (width, height), second: (size[0], size[1]) });
        }
        self.size = Some(size);
        let settings = self.options.settings(size);
        let last = self.last.take();
        let newest = PendingFrame::new(frame, last.as_ref(), &settings);
        let Some(last) = last else {
            self.first = Some(newest.clone()).filter(|_| self.options.look_ahead.is_none());
            self.last = Some(newest.clone());
            let waits = self.options.look_ahead != Some(0);
            let tracked = if waits { None } else { self.go_on(newest, (None, None)) };
            return Ok((tracked, Pairs::default()));
        };
        if newest.index > 1 {
            self.first = None;
        }
        let (prior, waits) = (self.prior.as_ref(), last.index == self.paired);
        let pairs = known.unwrap_or_else(|| match self.options.look_ahead {
            _ if newest.repeats => pairing::of_repeated(&newest, prior, waits),
            None => pairing::of_whole_clip(&last, &newest, &settings),
            Some(_) => pairing::of_stream(&last, &newest, prior, waits, &settings),
        });
        Ok((self.take(last, newest, pairs.clone(), &settings), pairs))
    }

    /// Continues with the solved pairs of the last frame and the newest one.
    fn take(
        &mut self,
        mut last: PendingFrame,
        mut newest: PendingFrame,
        pairs: Pairs,
        settings: &Settings,
    ) -> Option<Tracked> {
        let Pairs { mut onward, back, prior } = pairs;
        self.prior = prior;
        newest.back = back;
        if let Some(FartherPair { log_odds, reach }) = self.farther.look(&last, &newest, settings) {
            // Frames in between that show no object do not count as background.
            let of_last = [&mut last.back, &mut onward].into_iter().flatten().map(|(log_odds, _)| log_odds);
            let between = self.held.newest_log_odds(reach - 1).chain(of_last);
            between.filter(|log_odds| !shows_object(log_odds)).for_each(|log_odds| log_odds.values_mut().fill(0.0));
            if let Some((near, _)) = &mut newest.back {
                *near = log_odds;
            }
            newest.looked_farther = true;
        }
        self.last = Some(newest.clone());
        let tracked = if last.index == self.paired { self.go_on(last, onward.unzip()) } else { None };
        if self.options.look_ahead.is_none() {
            return tracked;
        }
        // In a stream, the newest frame is expected to keep its motion.
        let expected = newest.back.as_ref().map(|(_, back)| back.continued());
        self.go_on(newest, (None, expected))
    }

    /// The frames that still wait, in order. The tracker is then ready for another clip, whose objects get new numbers.
    pub(crate) fn finish(&mut self) -> Vec<Tracked> {
        let Some(mut last) = self.last.take() else { return Vec::new() };
        // With the quality `Fast`, two frames alone are not solved more thoroughly either.
        let closely = self.options.pair.quality == Quality::Best && last.back.is_some() && !last.repeats;
        if let Some(first) = self.first.take().filter(|_| closely) {
            let Pairs { onward, back, .. } = pairing::of_lone_pair(&first, &last, &self.options.pair);
            last.back = back;
            self.held = HeldFrames::new(FARTHEST);
            self.paired = 0;
            self.go_on(first, onward.unzip());
        }
        let mut frames = Vec::new();
        if last.index == self.paired {
            frames.extend(self.go_on(last, (None, None)));
        }
        while let Some((record, log_odds)) = self.held.next() {
            frames.extend(self.cut(record, log_odds));
        }
        while let Some(foreground) = self.rounds[0].next() {
            frames.extend(self.second_round(foreground));
        }
        while let Some(foreground) = self.rounds[1].next() {
            frames.push(self.tracked(foreground));
        }
        let identities = std::mem::replace(&mut self.identities, Identities::new(self.options.pair.subject));
        *self = Tracker::empty(self.options, self.keeps_frames, identities);
        frames
    }

    /// The last frame whose pairs were solved, once.
    pub(crate) fn preview(&mut self) -> Option<PreviewSource> {
        self.preview.take()
    }

    /// Number of objects for which no number was left; they count as background.
    pub(crate) fn dropped(&self) -> usize {
        self.identities.dropped
    }

    /// Objects that were parts of others at first, in order of frames.
    pub(crate) fn parted(&self) -> &[Parting] {
        &self.identities.parted
    }

    /// Continues with a frame whose pairs are solved, as far as they will be.
    fn go_on(&mut self, pending: PendingFrame, onward: (Option<Plane>, Option<LayeredMotion>)) -> Option<Tracked> {
        let is_second_of_two = onward.1.is_none() && self.held.newest().is_some_and(|record| record.back.is_none());
        let frame = pending.frame.clone();
        let (record, log_odds) = pending.recorded(onward, is_second_of_two, self.keeps_frames);
        let record = Arc::new(record);
        self.paired += 1;
        self.preview = Some(PreviewSource { record: record.clone(), frame, log_odds: log_odds.clone() });
        let (record, log_odds) = self.held.push(record, log_odds)?;
        self.cut(record, log_odds)
    }

    fn cut(&mut self, record: Arc<Record>, log_odds: Plane) -> Option<Tracked> {
        let foreground = self.rounds[0].push(record, log_odds)?;
        self.second_round(foreground)
    }

    fn second_round(&mut self, first: Foreground) -> Option<Tracked> {
        // Without later frames, a second round gains little: .0015 J on ten real clips.
        let is_live = self.options.pair.quality == Quality::Fast && self.options.look_ahead == Some(0);
        if is_live || model().cuts_twice == 0 {
            return Some(self.tracked(first));
        }
        let (record, log_odds) = first.for_second_round();
        let foreground = self.rounds[1].push(record, log_odds)?;
        Some(self.tracked(foreground))
    }

    fn tracked(&mut self, Foreground { record, log_odds, mask, .. }: Foreground) -> Tracked {
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
        Tracked { record, labels, log_odds, goes_on }
    }
}
