//! What has come of all that is said in a frame: the layer that lies over the labels found automatically.

use super::evidence::KeptOdds;
use super::runs::Runs;
use super::saved::saved;

/// Labels over those that were found.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    /// Of each full-size pixel: the number of a person's object, 0 where ground is said, 255 where what was found shows.
    pub(super) labels: Runs,
    /// Odds of object against background, working size.
    pub(super) odds: KeptOdds,
}

saved!(Layer { labels, odds });
