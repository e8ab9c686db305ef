//! What is known of one frame of a clip.

use std::rc::Rc;

use super::evidence::Flow;
use crate::frame::pyramid::Appearance;
use crate::frame::{Frame, Plane};
use crate::labelling::terms::smoothness::Borders;

/// A frame with the evidence of its pairs. Rounds over the clip share it.
#[derive(Debug)]
pub(crate) struct Record {
    /// Position in the clip, from 0.
    pub(crate) index: usize,
    /// In a stream, which describes a frame when it leaves.
    pub(crate) frame: Option<Rc<Frame>>,
    pub(crate) appearance: Rc<Appearance>,
    /// Log-odds of object against background from the frame's pairs, nats; zero where there is no pair.
    pub(crate) odds: Plane,
    /// To the next frame; none at the end of a scene.
    pub(crate) onward: Option<Flow>,
    /// To the frame before; none at the beginning of a scene.
    pub(crate) back: Option<Flow>,
}

impl Record {
    /// Width and height of the working size.
    pub(crate) fn size(&self) -> [usize; 2] {
        [self.odds.width(), self.odds.height()]
    }

    /// Prices of borders between labels.
    pub(crate) fn borders(&self, smoothness: f32) -> Borders {
        Borders::new(&self.appearance.pictures[0], EDGE_NOISE, smoothness)
    }
}

/// Noise that the edges of a frame stand out from, grey levels. Frames of clips are compressed more often than noisy. Not varied.
const EDGE_NOISE: f32 = 1.0;
