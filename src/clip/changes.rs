//! What annotations change: the frames, and how many pixels of which objects.

use super::runs::Runs;

/// Numbers of pixels that an object has gained and lost in a frame.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Changed {
    /// Index of the frame.
    pub frame: usize,
    /// Number of the object; 0 for the background.
    pub object: u8,
    /// Pixels that the object has now and did not have before.
    pub gained: usize,
    /// Pixels that the object had before and does not have now.
    pub lost: usize,
}

/// The changed frames, in the order of their first change.
#[derive(Clone, Debug, Default)]
pub(super) struct Changes {
    frames: Vec<usize>,
    /// In ascending order of frames: index, labels before the first change, and the pixels that objects have gained and lost since.
    labels: Vec<(usize, Runs, Vec<Changed>)>,
}

impl Changes {
    pub(super) fn frames(&self) -> &[usize] {
        &self.frames
    }

    /// Adds a frame without counting pixels.
    pub(super) fn add(&mut self, frame: usize) {
        if !self.frames.contains(&frame) {
            self.frames.push(frame);
        }
    }

    /// Sets the labels of a frame, and counts the pixels that have changed since the first call.
    pub(super) fn set(&mut self, frame: usize, before: &[u8], now: &[u8]) {
        self.add(frame);
        let at = self.labels.partition_point(|(of, ..)| *of < frame);
        if self.labels.get(at).is_none_or(|(of, ..)| *of != frame) {
            self.labels.insert(at, (frame, Runs::of(before), Vec::new()));
        }
        let (_, first, changed) = &mut self.labels[at];
        let mut counts = [[0usize; 2]; 256];
        for (before, &now) in first.values().into_iter().zip(now).filter(|(before, now)| before != *now) {
            counts[usize::from(now)][0] += 1;
            counts[usize::from(before)][1] += 1;
        }
        changed.clear();
        for (object, [gained, lost]) in (0..=u8::MAX).zip(counts).filter(|(_, [gained, lost])| gained + lost > 0) {
            changed.push(Changed { frame, object, gained, lost });
        }
    }

    /// All changes, by frame, then by object.
    pub(super) fn list(&self) -> Vec<Changed> {
        self.labels.iter().flat_map(|(.., changed)| changed.iter().copied()).collect()
    }
}
