//! A frame of a clip, with its motions to the neighbouring frames.

use std::sync::Arc;

use super::options::model;
use super::pairs::{LayeredMotion, shows_object};
use crate::frame::palette::Palette;
use crate::frame::pyramid::{Appearance, FramePyramid};
use crate::frame::{Frame, Plane};
use crate::labelling::terms::smoothness::EdgeWeights;
use crate::model::Model;
use crate::pair::frame_motions::{Expected, FrameMotions, frame_motions};
use crate::pair::settings::Settings;
use crate::view::cost::SMALLEST_NOISE;

/// A frame of a clip that waits for its pair with the next one.
#[derive(Clone, Debug)]
pub(crate) struct PendingFrame {
    /// Position in the clip, from 0.
    pub(crate) index: usize,
    pub(crate) frame: Arc<Frame>,
    pub(crate) pyramid: Arc<FramePyramid>,
    /// Whether it repeats the previous frame.
    pub(crate) repeats: bool,
    /// Log-odds and motion of the pair with the previous frame.
    pub(crate) back: Option<(Plane, LayeredMotion)>,
    /// Whether the log-odds are those of the pair with an earlier frame.
    pub(crate) looked_farther: bool,
}

impl PendingFrame {
    /// The frame after `last`.
    pub(crate) fn new(frame: Frame, last: Option<&PendingFrame>, settings: &Settings) -> PendingFrame {
        PendingFrame {
            index: last.map_or(0, |last| last.index + 1),
            pyramid: Arc::new(settings.pyramid(&frame)),
            repeats: last.is_some_and(|last| last.frame.colours() == frame.colours()),
            frame: Arc::new(frame),
            back: None,
            looked_farther: false,
        }
    }

    /// The motions of its pixels to another frame.
    pub(crate) fn motions_to(&self, other: &FramePyramid, settings: &Settings, expected: Expected<'_>) -> FrameMotions {
        frame_motions(&self.frame, &self.pyramid, other, settings, expected)
    }

    /// The record of the frame, and its log-odds by its own pairs: with the next frame, as far as there is one, and with the previous one.
    /// The log-odds of the second frame of a lone pair are zero, because they would repeat the mistakes of the first.
    pub(crate) fn recorded(
        self,
        (onward_log_odds, onward): (Option<Plane>, Option<LayeredMotion>),
        is_second_of_two: bool,
        keeps_frame: bool,
    ) -> (Record, Plane) {
        let (mut back_log_odds, back) = self.back.unzip();
        let onward_log_odds = onward_log_odds.filter(|log_odds| !self.looked_farther || shows_object(log_odds));
        if is_second_of_two {
            back_log_odds.iter_mut().for_each(|log_odds| log_odds.values_mut().fill(0.0));
        }
        let moves = |flow: &Option<LayeredMotion>| flow.as_ref().is_some_and(|flow| !flow.is_still());
        // The mean of both pairs, or the pair in which something moves; zero where there is no pair.
        let log_odds = match (onward_log_odds, back_log_odds) {
            (Some(moving), Some(_)) if moves(&onward) && !moves(&back) => moving,
            (Some(_), Some(moving)) if !moves(&onward) && moves(&back) => moving,
            (Some(mut log_odds), Some(other)) => {
                let share = model().backward;
                log_odds.values_mut().iter_mut().zip(other.values()).for_each(|(o, b)| *o += share * (b - *o));
                log_odds
            }
            (Some(only), None) | (None, Some(only)) => only,
            (None, None) => {
                let [width, height] = self.pyramid.scaling.small;
                Plane::filled(width, height, 0.0)
            }
        };
        let appearance = self.pyramid.appearance(&self.frame);
        let record = Record {
            index: self.index,
            frame: Some(self.frame.clone()).filter(|_| keeps_frame),
            repeats: self.repeats,
            palette: appearance.palette.clone(),
            unit_weights: unit_weights(appearance),
            onward,
            back,
        };
        (record, log_odds)
    }
}

/// A frame with the results of its pairs. The rounds over the clip share it.
#[derive(Debug)]
pub(crate) struct Record {
    /// Position in the clip, from 0.
    pub(crate) index: usize,
    /// Only in a stream, which describes a frame when it leaves.
    pub(crate) frame: Option<Arc<Frame>>,
    /// Whether it repeats the previous frame.
    pub(crate) repeats: bool,
    /// Quantised colour of every working pixel.
    pub(crate) palette: Palette,
    /// Edge weights for a smoothness of 1. They take less memory than the pictures from which they are computed.
    pub(crate) unit_weights: EdgeWeights,
    /// Motion to the next frame; `None` at the end of a scene.
    pub(crate) onward: Option<LayeredMotion>,
    /// Motion to the previous frame; `None` at the beginning of a scene.
    pub(crate) back: Option<LayeredMotion>,
}

impl Record {
    /// Width and height of the working size.
    pub(crate) fn size(&self) -> [usize; 2] {
        self.palette.size()
    }

    /// Whether nothing moves in its pairs.
    pub(crate) fn is_still(&self) -> bool {
        [&self.onward, &self.back].into_iter().flatten().all(LayeredMotion::is_still)
    }

    /// The edge weights for a smoothness.
    pub(crate) fn edge_weights(&self, smoothness: f32) -> EdgeWeights {
        self.unit_weights.times(smoothness)
    }
}

/// The edge weights of a frame for a smoothness of 1.
fn unit_weights(appearance: &Appearance) -> EdgeWeights {
    EdgeWeights::new(&appearance.pictures[0], SMALLEST_NOISE, 1.0, &Model::DEFAULT)
}
