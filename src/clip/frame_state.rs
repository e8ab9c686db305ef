//! A frame of a segmented clip: the labels found automatically, a person's annotation, and the layer that follows from all annotations.

use super::frame_annotation::FrameAnnotation;
use super::layer::Layer;
use super::pairs::KeptLayeredMotion;
use super::saved::saved;
use super::tracker::Tracked;

#[derive(Clone, Debug)]
pub(super) struct FrameState {
    /// As segmented automatically, at the working size.
    pub(super) found: Layer,
    pub(super) annotation: Option<FrameAnnotation>,
    /// Labels over those found automatically.
    pub(super) layer: Option<Layer>,
    /// Whether a person has accepted the frame. Its layer then has all its labels.
    pub(super) accepted: bool,
    /// Motion to the next frame of the scene.
    pub(super) onward: Option<KeptLayeredMotion>,
    /// Motion to the previous frame.
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

    /// Whether the frame was accepted with an object in it.
    pub(super) fn accepts(&self, object: u8) -> bool {
        self.accepted && self.layer.as_ref().is_some_and(|layer| layer.names(object))
    }

    /// Whether the annotated frame is an anchor of an object.
    pub(super) fn anchors(&self, object: u8) -> bool {
        self.annotation.as_ref().is_some_and(|annotation| annotation.anchored.contains(&object))
    }

    /// Whether it fits the numbers of pixels at the working size and at full size.
    pub(super) fn is_valid(&self, pixels: usize, full: usize) -> bool {
        self.found.labels.is_valid(pixels)
            && self.found.log_odds.is_valid(pixels)
            && self.annotation.as_ref().is_none_or(|annotation| annotation.is_valid(full))
            && self.layer.as_ref().is_none_or(|layer| layer.labels.is_valid(full) && layer.log_odds.is_valid(pixels))
            && [&self.onward, &self.back].into_iter().flatten().all(|flow| flow.is_valid(pixels))
    }
}
