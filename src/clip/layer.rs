//! What a person has said of a frame, and what has come of it there: the layer that lies over the labels found automatically.

use super::evidence::KeptOdds;
use super::runs::Runs;
use super::saved::{Saved, saved};

/// Where a correction spreads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spread {
    /// To the frames before and after.
    #[default]
    Both,
    /// To the frames after.
    Forward,
    /// To the frames before.
    Backward,
    /// Nowhere: it holds in its frame alone.
    None,
}

impl Spread {
    /// Forward, backward.
    pub(super) fn ways(self) -> [bool; 2] {
        [matches!(self, Spread::Both | Spread::Forward), matches!(self, Spread::Both | Spread::Backward)]
    }
}

impl Saved for Spread {
    fn write(&self, bytes: &mut Vec<u8>) {
        bytes.push(*self as u8);
    }

    fn read(bytes: &mut &[u8]) -> Option<Spread> {
        let all = [Spread::Both, Spread::Forward, Spread::Backward, Spread::None];
        all.get(usize::from(u8::read(bytes)?)).copied()
    }
}

/// What a person has said of a frame.
#[derive(Clone, Debug)]
pub(super) struct SaidFrame {
    /// Of each full-size pixel: a label, or 255 for nothing.
    pub(super) labels: Runs,
    pub(super) spread: Spread,
    /// Objects that it speaks of: they are followed from here.
    pub(super) speaks_of: Vec<u8>,
    /// Other objects of a person that it takes pixels from.
    pub(super) takes_from: Vec<u8>,
}

saved!(SaidFrame { labels, spread, speaks_of, takes_from });

/// What has come of it in a frame.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    /// Of each full-size pixel: the number of a person's object, 0 where ground is said, 255 where what was found shows.
    pub(super) labels: Runs,
    /// Odds of object against background, working size.
    pub(super) odds: KeptOdds,
}

saved!(Layer { labels, odds });
