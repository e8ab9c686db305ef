//! Slow objects: where neighbouring frames show no object, a frame is compared with earlier frames, twice as far back each time, until an
//! object shows.
//!
//! An object that moves too little within a pair moves more over a longer time. The motion between neighbours stays that of the background,
//! along which slow objects are carried as well.

use std::collections::VecDeque;
use std::sync::Arc;

use super::options::model;
use super::pairs::{log_odds, shows_object};
use super::record::PendingFrame;
use crate::frame::Plane;
use crate::frame::pyramid::FramePyramid;
use crate::pair::frame_motions::Expected;
use crate::pair::settings::Settings;

/// Distance of the nearest frame with which a frame is compared besides its neighbour, frames.
const NEAREST: usize = 2;
/// Distance of the farthest, frames: objects that move by an eighth of what neighbours show are then found. Frames farther apart have less
/// in common.
pub(super) const FARTHEST: usize = 8;

/// The frames with which the next one may be compared.
#[derive(Debug)]
pub(super) struct Farther {
    /// The frames since neighbours last showed an object, the newest last.
    earlier: VecDeque<Arc<FramePyramid>>,
    /// Distance of the frame with which the next one is compared, frames.
    reach: usize,
}

/// The pair with an earlier frame.
pub(super) struct FartherPair {
    /// Log-odds of object against background, nats.
    pub(super) log_odds: Plane,
    /// How many frames earlier that frame is.
    pub(super) reach: usize,
}

impl Farther {
    pub(super) fn new() -> Farther {
        Farther { earlier: VecDeque::new(), reach: NEAREST }
    }

    /// Compares the newest frame with an earlier one. Returns their pair if it shows an object and the pair with the last frame does not.
    pub(super) fn look(
        &mut self,
        last: &PendingFrame,
        newest: &PendingFrame,
        settings: &Settings,
    ) -> Option<FartherPair> {
        if model().looks_farther == 0 || newest.back.as_ref().is_none_or(|(near, _)| shows_object(near)) {
            *self = Farther::new();
            return None;
        }
        // A repeated frame shows nothing new.
        if newest.repeats {
            return None;
        }
        self.earlier.push_back(last.pyramid.clone());
        if self.earlier.len() > FARTHEST {
            self.earlier.pop_front();
        }
        let earlier = &self.earlier[self.earlier.len().checked_sub(self.reach)?];
        let view = newest.motions_to(earlier, settings, Expected::Nothing);
        let pair = FartherPair { log_odds: log_odds(&view), reach: self.reach };
        if !view.is_cut() && shows_object(&pair.log_odds) {
            return Some(pair);
        }
        // Where nothing moves, the farthest comparison is made for few frames.
        if self.reach == FARTHEST {
            self.earlier.clear();
        }
        self.reach = (2 * self.reach).min(FARTHEST);
        None
    }
}
