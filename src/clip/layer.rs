//! Labels of a frame with their odds: those found automatically, and those that annotations lay over them.

use super::evidence::KeptOdds;
use super::runs::Runs;
use super::saved::saved;
use crate::frame::Plane;

/// Labels and odds.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    /// The object of each pixel, 0 for the background. Those of annotations have the full size, and 255 where the labels below show.
    pub(super) labels: Runs,
    /// Odds of object against background, nats, working size.
    pub(super) odds: KeptOdds,
}

saved!(Layer { labels, odds });

impl Layer {
    pub(super) fn of(labels: &[u8], odds: &Plane) -> Layer {
        Layer { labels: Runs::of(labels), odds: KeptOdds::of(odds) }
    }

    /// Whether a number labels any pixel.
    pub(super) fn names(&self, object: u8) -> bool {
        self.labels.names(object)
    }
}
