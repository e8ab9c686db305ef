//! A frame of a segmented clip: the labels found automatically, a person's annotation of it, and the layer that comes of all annotations.

use super::evidence::KeptLayeredMotion;
use super::frame_annotation::FrameAnnotation;
use super::layer::Layer;
use super::saved::saved;
use super::tracker::Tracked;

#[derive(Clone, Debug)]
pub(super) struct FrameState {
    /// As the clip was segmented, working size.
    pub(super) found: Layer,
    pub(super) annotation: Option<FrameAnnotation>,
    /// Lies over the labels found automatically.
    pub(super) layer: Option<Layer>,
    /// Whether a person finds the frame right: its layer has all its labels.
    pub(super) accepted: bool,
    /// To the next frame of the scene.
    pub(super) onward: Option<KeptLayeredMotion>,
    /// To the frame before.
    pub(super) back: Option<KeptLayeredMotion>,
}

saved!(FrameState { found, annotation, layer, accepted, onward, back });

impl FrameState {
    pub(super) fn new(Tracked { record, labels, log_odds, goes_on }: Tracked) -> FrameState {
        FrameState {
            found: Layer::of(&labels, &log_odds),
            annotation: None,
            layer: None,
            accepted: false,
            onward: record.onward.as_ref().filter(|_| goes_on).map(KeptLayeredMotion::of),
            back: record.back.as_ref().map(KeptLayeredMotion::of),
        }
    }

    /// Whether a person accepted the frame with an object in it.
    pub(super) fn accepts(&self, object: u8) -> bool {
        self.accepted && self.layer.as_ref().is_some_and(|layer| layer.names(object))
    }

    /// Whether annotations of the frame are anchors of an object.
    pub(super) fn anchors(&self, object: u8) -> bool {
        self.annotation.as_ref().is_some_and(|annotation| annotation.anchored.contains(&object))
    }

    /// Whether it fits the numbers of pixels of the working size and of the full size.
    pub(super) fn is_valid(&self, pixels: usize, full: usize) -> bool {
        self.found.labels.is_valid(pixels)
            && self.found.log_odds.is_valid(pixels)
            && self.annotation.as_ref().is_none_or(|annotation| annotation.is_valid(full))
            && self.layer.as_ref().is_none_or(|layer| layer.labels.is_valid(full) && layer.log_odds.is_valid(pixels))
            && [&self.onward, &self.back].into_iter().flatten().all(|flow| flow.is_valid(pixels))
    }
}
