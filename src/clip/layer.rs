//! Labels of a frame with their log-odds: those found automatically, and those that annotations lay over them.

use super::pairs::KeptLogOdds;
use super::runs::Runs;
use super::saved::saved;
use crate::frame::Plane;

/// Labels and log-odds.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layer {
    /// The object of each pixel, 0 for the background. Layers of annotations have full size, and 255 where the labels below show.
    pub(super) labels: Runs,
    /// Log-odds of object against background, nats, working size.
    pub(super) log_odds: KeptLogOdds,
}

saved!(Layer { labels, log_odds });

impl Layer {
    pub(super) fn of(labels: &[u8], log_odds: &Plane) -> Layer {
        Layer { labels: Runs::of(labels), log_odds: KeptLogOdds::of(log_odds) }
    }

    /// Whether it has labels for so many pixels, and log-odds for so many working pixels.
    pub(super) fn is_valid(&self, pixels: usize, working: usize) -> bool {
        self.labels.is_valid(pixels) && self.log_odds.is_valid(working)
    }

    /// Whether any pixel has a number.
    pub(super) fn names(&self, object: u8) -> bool {
        self.labels.names(object)
    }
}
