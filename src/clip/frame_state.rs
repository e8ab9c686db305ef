//! A frame of a clip: what was found in it automatically, a person's annotations, and the layer that follows from all annotations. States of
//! a clip share these parts.

use std::sync::Arc;

use super::annotation::ObjectSet;
use super::frame_annotation::FrameAnnotation;
use super::layer::Layer;
use super::pairs::KeptLayeredMotion;
use super::runs::Runs;
use super::saved::saved;
use super::tracker::Tracked;
use crate::frame::scaling::Scaling;

/// What was found in a frame automatically.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Found {
    /// Labels and their log-odds, working size.
    pub(super) layer: Layer,
    /// Motion to the next frame of the scene.
    pub(super) onward: Option<KeptLayeredMotion>,
    /// Motion to the previous frame.
    pub(super) back: Option<KeptLayeredMotion>,
    /// How often the frame was halved to its working size.
    pub(super) halvings: usize,
    /// The hash of the frame.
    pub(super) hash: u64,
}

saved!(Found { layer, onward, back, halvings, hash });

impl Found {
    pub(super) fn new(Tracked { record, labels, log_odds, goes_on }: Tracked, halvings: usize, hash: u64) -> Found {
        Found {
            layer: Layer::of(&labels, &log_odds),
            onward: record.onward.as_ref().filter(|_| goes_on).map(KeptLayeredMotion::of),
            back: record.back.as_ref().map(KeptLayeredMotion::of),
            halvings,
            hash,
        }
    }

    fn is_valid(&self, pixels: usize) -> bool {
        self.layer.is_valid(pixels, pixels)
            && [&self.onward, &self.back].into_iter().flatten().all(|flow| flow.is_valid(pixels))
    }
}

/// A frame.
#[derive(Clone, Debug, Default)]
pub(super) struct FrameState {
    /// `None` before the frame is segmented.
    pub(super) found: Option<Arc<Found>>,
    /// The labels found automatically, where numbers that a person reserved have changed them.
    pub(super) renumbered: Option<Arc<Runs>>,
    pub(super) annotation: Option<Arc<FrameAnnotation>>,
    /// Labels over those found automatically.
    pub(super) layer: Option<Arc<Layer>>,
    /// Labels drawn exactly, over all others; 255 where nothing was drawn.
    pub(super) exact: Option<Arc<Runs>>,
    /// Whether a person has accepted the frame. Its layer then has all its labels.
    pub(super) accepted: bool,
}

saved!(FrameState { found, renumbered, annotation, layer, exact, accepted });

impl FrameState {
    /// A frame that was segmented.
    pub(super) fn of(found: Found) -> FrameState {
        FrameState { found: Some(Arc::new(found)), ..FrameState::default() }
    }

    /// The labels found automatically, working size. There are none before the frame is segmented.
    pub(super) fn found_labels(&self) -> &Runs {
        const NOTHING: &Runs = &Runs::EMPTY;
        let found = self.found.as_ref().map_or(NOTHING, |found| &found.layer.labels);
        self.renumbered.as_deref().unwrap_or(found)
    }

    /// Whether the previous frame belongs to the same scene.
    pub(super) fn goes_on(&self) -> bool {
        self.found.as_ref().is_some_and(|found| found.back.is_some())
    }

    /// Marks the objects found in the frame or shown by its layers.
    pub(super) fn mark(&self, is_there: &mut ObjectSet) {
        self.found_labels().mark(is_there);
        if let Some(layer) = &self.layer {
            layer.labels.mark(is_there);
        }
        if let Some(exact) = &self.exact {
            exact.mark(is_there);
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

    /// Whether it fits frames of a width and height.
    pub(super) fn is_valid(&self, [width, height]: [usize; 2]) -> bool {
        let Some(found) = &self.found else {
            let Self { renumbered, annotation, layer, exact, accepted, .. } = self;
            return renumbered.is_none() && annotation.is_none() && layer.is_none() && exact.is_none() && !accepted;
        };
        // No frame is halved more often than its sides have bits.
        let [w, h] = Scaling::halved([width, height], found.halvings.min(15)).small;
        let (full, pixels) = (width * height, w * h);
        found.is_valid(pixels)
            && self.renumbered.as_ref().is_none_or(|labels| labels.is_valid(pixels))
            && self.annotation.as_ref().is_none_or(|annotation| annotation.is_valid(full))
            && self.layer.as_ref().is_none_or(|layer| layer.is_valid(full, pixels))
            && self.exact.as_ref().is_none_or(|labels| labels.is_valid(full))
    }
}
