//! What is known of one frame of a clip.

use std::rc::Rc;

use super::evidence::Evidence;
use crate::frame::pyramid::{Appearance, FramePyramid};
use crate::frame::{Frame, Plane};
use crate::labelling::terms::smoothness::Borders;

/// A frame with the evidence of its pairs. Rounds over the clip share it.
#[derive(Debug)]
pub(crate) struct Record {
    /// Position in the clip, from 0.
    pub(crate) index: usize,
    pub(crate) frame: Frame,
    pub(crate) pyramid: Rc<FramePyramid>,
    /// Evidence of the pair with the next frame; none at the end of a scene.
    pub(crate) onward: Option<Evidence>,
    /// Evidence of the pair with the frame before; none at the beginning of a scene.
    pub(crate) back: Option<Evidence>,
}

impl Record {
    /// Width and height of the working size.
    pub(crate) fn size(&self) -> [usize; 2] {
        let finest = &self.pyramid.levels[0].luminance;
        [finest.width(), finest.height()]
    }

    /// Log-odds of object against background from both pairs: their mean, or those of the only one. Zero where there is none.
    pub(crate) fn odds(&self) -> Plane {
        match (&self.onward, &self.back) {
            (Some(onward), Some(back)) => {
                let mut odds = onward.odds.clone();
                odds.values_mut().iter_mut().zip(back.odds.values()).for_each(|(o, b)| *o = 0.5 * (*o + b));
                odds
            }
            (Some(only), None) | (None, Some(only)) => only.odds.clone(),
            (None, None) => Plane::filled(self.size()[0], self.size()[1], 0.0),
        }
    }

    pub(crate) fn appearance(&self) -> &Appearance {
        self.pyramid.appearance(&self.frame, 1)
    }

    /// Prices of borders between labels.
    pub(crate) fn borders(&self, smoothness: f32) -> Borders {
        Borders::new(&self.appearance().pictures[0], EDGE_NOISE, smoothness)
    }
}

/// Noise that the edges of a frame stand out from, grey levels. Frames of clips are compressed more often than noisy.
const EDGE_NOISE: f32 = 1.0;
