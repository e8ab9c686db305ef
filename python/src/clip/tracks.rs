//! The tracks of a clip's objects, collected frame by frame.

use std::collections::{BTreeMap, BTreeSet};

use pyo3::prelude::*;
use veronese::AffineMotion;
use veronese::clip::{ClipFrame, ClipObject};

use crate::results::{class, matrix, sighting};

#[derive(Default)]
pub(crate) struct Tracks {
    /// The objects of each frame that was returned.
    frames: BTreeMap<usize, (Vec<ClipObject>, Option<AffineMotion>)>,
    /// Frames that were returned, and have changed since.
    stale: BTreeSet<usize>,
    pub(crate) dropped: usize,
}

impl Tracks {
    pub(crate) fn add(&mut self, frame: &ClipFrame) {
        self.stale.remove(&frame.index);
        self.frames.insert(frame.index, (frame.objects.clone(), frame.background));
    }

    /// Marks frames that have changed.
    pub(crate) fn changed(&mut self, frames: &[usize]) {
        self.stale.extend(frames.iter().filter(|frame| self.frames.contains_key(frame)));
    }

    /// Frames that must be read again.
    pub(crate) fn stale(&self) -> Vec<usize> {
        self.stale.iter().copied().collect()
    }

    /// Ends a stream: no object moves on from its last frame.
    pub(crate) fn end(&mut self) {
        if let Some(mut last) = self.frames.last_entry() {
            let (objects, background) = last.get_mut();
            objects.iter_mut().for_each(|object| object.matrix = None);
            *background = None;
        }
    }

    /// As `ClipTracks`.
    pub(crate) fn value<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let mut seen: BTreeMap<u8, Vec<(usize, &ClipObject)>> = BTreeMap::new();
        for (&index, (objects, _)) in &self.frames {
            for object in objects {
                seen.entry(object.id).or_default().push((index, object));
            }
        }
        let mut objects = Vec::new();
        for (id, seen) in seen {
            let sightings = seen.iter().map(|(frame, object)| sighting(py, *frame, object));
            let (first, last) = (seen.first().map(|(frame, _)| *frame), seen.last().map(|(frame, _)| *frame));
            objects.push(class(py, "ClipTrack")?.call1((id, first, last, sightings.collect::<PyResult<Vec<_>>>()?))?);
        }
        let mut background = Vec::new();
        for (&index, (_, motion)) in &self.frames {
            if let Some(motion) = motion {
                background.push(class(py, "BackgroundMotion")?.call1((index, matrix(py, motion)))?);
            }
        }
        class(py, "ClipTracks")?.call1((objects, background, self.dropped))
    }
}
