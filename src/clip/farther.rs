//! Slow things: where neighbours show no object, a frame is compared with an earlier one, twice as far each time, until one shows.
//!
//! What moves by less than a pair can tell moves by more in a longer time. The flow between neighbours stays that of the background: what is
//! so slow is carried along it as well.

use std::collections::VecDeque;
use std::rc::Rc;

use super::evidence::{log_odds, shows_object};
use super::options::model;
use super::record::PendingFrame;
use crate::frame::Plane;
use crate::frame::pyramid::FramePyramid;
use crate::pair::frame_motions::Expected;
use crate::pair::settings::Settings;

/// Frames to the nearest one with which a frame is compared beside its neighbour …
const NEAREST: usize = 2;
/// … and to the farthest: what moves by an eighth of what neighbours tell is then seen. Farther ones have less in common.
pub(super) const FARTHEST: usize = 8;

/// The frames with which the next one may be compared.
#[derive(Debug)]
pub(super) struct Farther {
    /// Those since an object was seen to move between neighbours, the newest last.
    earlier: VecDeque<Rc<FramePyramid>>,
    /// How far back the next frame looks.
    reach: usize,
}

/// What an earlier frame tells.
pub(super) struct FartherPair {
    /// Of object against background, nats.
    pub(super) log_odds: Plane,
    /// How many frames earlier it is.
    pub(super) reach: usize,
}

impl Farther {
    pub(super) fn new() -> Farther {
        Farther { earlier: VecDeque::new(), reach: NEAREST }
    }

    /// What the newest frame and an earlier one tell, if they have something to tell that the newest frame and the last one have not.
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
        // It shows what the last one does.
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
        // Where nothing moves, few frames look so far.
        if self.reach == FARTHEST {
            self.earlier.clear();
        }
        self.reach = (2 * self.reach).min(FARTHEST);
        None
    }
}
