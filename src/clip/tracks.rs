//! The tracks of a clip's objects, collected frame by frame.

use std::collections::BTreeMap;

use super::description::ClipObject;
use crate::motion::AffineMotion;

/// The objects of a clip, each with its frames.
#[non_exhaustive]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClipTracks {
    /// The objects, by number.
    pub objects: Vec<ClipTrack>,
    /// Indices of frames, and the motion of the background to the next frame.
    pub background: Vec<(usize, AffineMotion)>,
    /// Number of objects for which no number was left; they count as background.
    pub dropped: usize,
}

/// One object through a clip.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct ClipTrack {
    /// Number of the object.
    pub id: u8,
    /// Indices of the frames that show the object, in ascending order, with the object there.
    pub frames: Vec<(usize, ClipObject)>,
}

/// Collects tracks.
#[derive(Clone, Debug, Default)]
pub(super) struct Tracks {
    objects: BTreeMap<u8, Vec<(usize, ClipObject)>>,
    background: Vec<(usize, AffineMotion)>,
}

impl Tracks {
    /// Adds a frame, in ascending order.
    pub(super) fn add(&mut self, index: usize, objects: &[ClipObject], background: Option<AffineMotion>) {
        for object in objects {
            self.objects.entry(object.id).or_default().push((index, object.clone()));
        }
        self.background.extend(background.map(|motion| (index, motion)));
    }

    pub(super) fn value(self, dropped: usize) -> ClipTracks {
        let Tracks { objects, background } = self;
        let objects = objects.into_iter().map(|(id, frames)| ClipTrack { id, frames }).collect();
        ClipTracks { objects, background, dropped }
    }
}
