//! What annotations change: in which frames, and of which objects how many pixels.

use std::collections::BTreeMap;

use super::runs::Runs;

/// Pixels that an object has gained and lost in a frame.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Changed {
    /// Index of the frame.
    pub frame: usize,
    /// Number of the object; 0 for the background.
    pub object: u8,
    /// Pixels that it has now, and had not.
    pub gained: usize,
    /// Pixels that it had, and has no more.
    pub lost: usize,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Changes {
    /// In the order in which they changed first.
    frames: Vec<usize>,
    /// The labels of each at first, and what it lost and gained since.
    of_frames: BTreeMap<usize, (Runs, Vec<Changed>)>,
}

impl Changes {
    pub(super) fn frames(&self) -> &[usize] {
        &self.frames
    }

    /// A frame changes somehow.
    pub(super) fn add(&mut self, frame: usize) {
        if !self.frames.contains(&frame) {
            self.frames.push(frame);
        }
    }

    /// The labels of a frame change.
    pub(super) fn set(&mut self, frame: usize, before: &[u8], now: &[u8]) {
        self.add(frame);
        let (first, changed) = self.of_frames.entry(frame).or_insert_with(|| (Runs::of(before), Vec::new()));
        let mut counts = [[0usize; 2]; 256];
        for (before, &now) in first.values().into_iter().zip(now).filter(|(before, now)| before != *now) {
            counts[usize::from(now)][0] += 1;
            counts[usize::from(before)][1] += 1;
        }
        let of = |object: u8| {
            let [gained, lost] = counts[usize::from(object)];
            (gained + lost > 0).then_some(Changed { frame, object, gained, lost })
        };
        *changed = (0..=u8::MAX).filter_map(of).collect();
    }

    /// By frame, then by object.
    pub(super) fn list(&self) -> Vec<Changed> {
        self.of_frames.values().flat_map(|(_, changed)| changed.iter().copied()).collect()
    }
}
