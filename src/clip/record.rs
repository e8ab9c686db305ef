//! A frame of a clip, and its motions to the frames beside it.

use std::rc::Rc;

use super::evidence::Flow;
use crate::frame::palette::Palette;
use crate::frame::pyramid::{Appearance, FramePyramid};
use crate::frame::{Frame, Plane};
use crate::labelling::terms::smoothness::Borders;
use crate::model::Model;
use crate::pair::frame_motions::{Expected, FrameMotions, frame_motions};
use crate::pair::settings::Settings;
use crate::view::cost::SMALLEST_NOISE;

/// The newest frame of a clip.
#[derive(Clone, Debug)]
pub(crate) struct Newest {
    pub(crate) frame: Rc<Frame>,
    pub(crate) pyramid: Rc<FramePyramid>,
    /// Whether it shows the frame before again.
    pub(crate) repeats: bool,
    /// Odds and flow of the pair with the frame before.
    pub(crate) back: Option<(Plane, Flow)>,
    /// Whether the odds are those of the pair with an earlier frame.
    pub(crate) looked_farther: bool,
}

impl Newest {
    /// The motions of its pixels to another frame.
    pub(crate) fn motions_to(&self, other: &FramePyramid, settings: &Settings, expected: Expected<'_>) -> FrameMotions {
        frame_motions(&self.frame, &self.pyramid, other, settings, expected)
    }
}

/// A frame with the evidence of its pairs. Rounds over the clip share it.
#[derive(Debug)]
pub(crate) struct Record {
    /// Position in the clip, from 0.
    pub(crate) index: usize,
    /// In a stream, which describes a frame when it leaves.
    pub(crate) frame: Option<Rc<Frame>>,
    /// Whether it shows the frame before again.
    pub(crate) repeats: bool,
    /// Quantised colour of every working pixel.
    pub(crate) palette: Palette,
    /// Prices of borders between labels, in units of the smoothness. They take less memory than the pictures whose edges they follow.
    pub(crate) unit_borders: Borders,
    /// To the next frame; none at the end of a scene.
    pub(crate) onward: Option<Flow>,
    /// To the frame before; none at the beginning of a scene.
    pub(crate) back: Option<Flow>,
}

impl Record {
    /// Width and height of the working size.
    pub(crate) fn size(&self) -> [usize; 2] {
        self.palette.size()
    }

    /// Whether nothing moves in its pairs.
    pub(crate) fn is_still(&self) -> bool {
        [&self.onward, &self.back].into_iter().flatten().all(Flow::is_still)
    }

    /// Prices of borders between labels.
    pub(crate) fn borders(&self, smoothness: f32) -> Borders {
        self.unit_borders.times(smoothness)
    }
}

/// Prices of borders along the edges of a frame, in units of the smoothness.
pub(crate) fn unit_borders(appearance: &Appearance) -> Borders {
    Borders::new(&appearance.pictures[0], SMALLEST_NOISE, 1.0, &Model::DEFAULT)
}
