//! The labels of a frame as they are shown, cached under a hash of their inputs.

use crate::answer::UNLABELLED;
use crate::clip::annotation::ObjectSet;
use crate::clip::description::{ClipFrame, ClipObject};
use crate::clip::runs::Runs;
use crate::clip::saved::{Saved, saved};
use crate::clip::segmented_clip::SegmentedClip;
use crate::hash::hash;
use crate::motion::AffineMotion;

/// Labels and objects of a frame.
#[derive(Clone, Debug)]
pub(super) struct Shown {
    /// The hash of their inputs.
    pub(super) key: u64,
    labels: Runs,
    objects: Vec<ClipObject>,
    background: Option<AffineMotion>,
}

saved!(Shown { key, labels, objects, background });
saved!(ClipObject { id, pixels, bbox, confidence, matrix });

impl Shown {
    pub(super) fn of(frame: &ClipFrame, key: u64) -> Shown {
        let ClipFrame { labels, objects, background, .. } = frame;
        Shown { key, labels: Runs::of(labels), objects: objects.clone(), background: *background }
    }

    pub(super) fn frame(&self, index: usize) -> ClipFrame {
        let Shown { labels, objects, background, .. } = self;
        ClipFrame { index, labels: labels.values(), objects: objects.clone(), background: *background }
    }

    pub(super) fn objects(&self) -> &[ClipObject] {
        &self.objects
    }

    pub(super) fn background(&self) -> Option<AffineMotion> {
        self.background
    }

    /// About how much memory it takes.
    pub(super) fn bytes(&self) -> usize {
        self.labels.bytes() + size_of_val(&self.objects[..])
    }

    /// Whether the labels fill so many pixels.
    pub(super) fn is_valid(&self, pixels: usize) -> bool {
        self.labels.is_valid(pixels)
    }
}

impl SegmentedClip {
    /// A hash of all inputs of the labels of a frame; 0 for a frame that is not segmented.
    pub(super) fn key(&self, index: usize, mark_unknown: bool) -> u64 {
        let frame = &self.frames[index];
        let Some(found) = &frame.found else { return 0 };
        let mut bytes = Vec::new();
        (mark_unknown, found.hash).write(&mut bytes);
        [found.halvings, self.size[0], self.size[1]].write(&mut bytes);
        frame.found_labels().write(&mut bytes);
        found.layer.log_odds.write(&mut bytes);
        found.onward.write(&mut bytes);
        frame.layer.write(&mut bytes);
        frame.exact.write(&mut bytes);
        let mut is_there: ObjectSet = [false; 256];
        frame.mark(&mut is_there);
        let users = self.user_objects_in(index);
        // What is known of each object decides only where masks of some object were given.
        let layer = frame.layer.as_ref();
        let is_given = layer.is_some_and(|layer| layer.labels.any(&|label| self.objects.given[usize::from(label)]));
        let protected = if is_given { self.protected() } else { [false; 256] };
        for k in (1..usize::from(UNLABELLED)).filter(|&k| is_there[k]) {
            let number = self.objects.numbers[k];
            let given = is_given && self.objects.given[k];
            [k as u8, number].write(&mut bytes);
            [users[k], users[usize::from(number)], given, protected[k]].write(&mut bytes);
        }
        // 0 stands for a frame that is not segmented.
        hash(0, &bytes) | 1
    }
}
