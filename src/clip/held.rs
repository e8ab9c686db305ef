//! Frames wait here until it is known whether anything moves soon after them.

use std::collections::VecDeque;
use std::sync::Arc;

use super::pairs::shows_object;
use super::record::Record;
use crate::frame::Plane;

/// A frame at rest does not count as background if anything moves within this many frames of it: a recording may repeat frames, as where
/// its rate was raised, or an object may pause. From 12 to 60 frames a second, the third of five equal frames is this far from the others.
const REACH: usize = 2;

/// The newest frames, with the log-odds of their own pairs.
#[derive(Debug)]
pub(super) struct HeldFrames {
    /// Number of frames that are held back.
    delay: usize,
    frames: VecDeque<(Arc<Record>, Plane)>,
    /// Number of frames since anything moved.
    frames_at_rest: usize,
}

impl HeldFrames {
    pub(super) fn new(delay: usize) -> HeldFrames {
        HeldFrames { delay, frames: VecDeque::new(), frames_at_rest: REACH }
    }

    /// Takes the next frame. Returns one that has been held long enough.
    pub(super) fn push(&mut self, record: Arc<Record>, log_odds: Plane) -> Option<(Arc<Record>, Plane)> {
        self.frames.push_back((record, log_odds));
        if self.frames.len() > self.delay { self.next() } else { None }
    }

    /// Releases the frame that has been held longest. Its log-odds are set to zero if it is a pause.
    pub(super) fn next(&mut self) -> Option<(Arc<Record>, Plane)> {
        let (record, mut log_odds) = self.frames.pop_front()?;
        // A scene begins as if nothing had moved for long.
        let before = if record.back.is_none() { REACH } else { self.frames_at_rest };
        self.frames_at_rest = if record.is_still() { before.saturating_add(1) } else { 0 };
        let mut after = self.frames.iter().take(REACH).take_while(|(record, _)| record.back.is_some());
        let is_near = (1..=REACH).contains(&self.frames_at_rest)
            || self.frames_at_rest > 0 && after.any(|(record, _)| !record.is_still());
        if is_near && !shows_object(&log_odds) {
            log_odds.values_mut().fill(0.0);
        }
        Some((record, log_odds))
    }

    /// The newest frame that is held.
    pub(super) fn newest(&self) -> Option<&Record> {
        self.frames.back().map(|(record, _)| &**record)
    }

    /// The log-odds of the newest frames, at most `count`.
    pub(super) fn newest_log_odds(&mut self, count: usize) -> impl Iterator<Item = &mut Plane> {
        self.frames.iter_mut().rev().take(count).map(|(_, log_odds)| log_odds)
    }
}
