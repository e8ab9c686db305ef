//! Clips: objects that keep their number from their first frame to their last.
//!
//! 1. Each frame is prepared once and solved in pairs with the next frame and the one before (`clip/tracker.rs`, `clip/evidence.rs`).
//! 2. Two rounds carry the evidence along the motions, learn colours and cut the foreground (`clip/round.rs`). The second starts from the
//!    first one's cut.
//! 3. The foreground of each frame is handed to the objects of the frame before, or to new ones (`clip/identity.rs`).
//! 4. Of a whole clip, objects that part are followed back to where they were one (`clip/parting.rs`), parts that move together are joined, and what lasted a few frames is dropped (`clip/grouping.rs`).
//! 5. Labels are upsampled along the edges of the full frame (`clip/description.rs`).
//!
//! A [`StreamSegmenter`] does all this frame by frame. A [`ClipSegmenter`] keeps the labels of the working size, and its
//! [`SegmentedClip`] gives any frame, as often as it is asked, takes corrections and can be saved.

mod annotation;
mod carry;
mod changes;
mod colours;
mod correction;
mod description;
mod evidence;
mod grouping;
mod identity;
mod job;
mod layer;
mod parting;
mod record;
mod round;
mod runs;
mod saved;
mod stream;
mod tracker;
mod whole;

use serde::Serialize;

use crate::model::ClipModel;
use crate::motion::AffineMotion;
use crate::options::SegmentOptions;
use crate::pair::settings::Settings;

pub use annotation::{Accepted, Annotations, Click, Painted, Prompt, Spread};
pub use changes::Changed;
#[doc(hidden)]
pub use correction::{Correction, MAX_CORRECTED, Relabelling, relabel};
pub use job::ClipJob;
pub use stream::StreamSegmenter;
pub use whole::{ClipSegmenter, FramePairs, SegmentedClip};

/// Largest look-ahead of a stream, frames.
pub const MAX_LOOK_AHEAD: usize = 8;

#[cfg(feature = "ablation")]
thread_local! {
    static VARIED: std::cell::Cell<ClipModel> = const { std::cell::Cell::new(ClipModel::DEFAULT) };
}

/// The constants of clips; with the feature `ablation` those that this thread was told to use.
#[inline(always)]
pub(crate) fn model() -> ClipModel {
    #[cfg(feature = "ablation")]
    return VARIED.get();
    #[cfg(not(feature = "ablation"))]
    ClipModel::DEFAULT
}

/// Sets the constants for this thread, for the programs that vary and fit them.
#[cfg(feature = "ablation")]
#[doc(hidden)]
pub fn vary(model: ClipModel) {
    VARIED.set(model);
}

/// Options of a [`ClipSegmenter`] or a [`StreamSegmenter`].
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default)]
pub struct ClipOptions {
    /// Options of each pair. With `mark_unknown`, pixels whose evidence does not tell an object from the background get the label 255;
    /// `confidence` has no effect.
    pub pair: SegmentOptions,
    /// Frames whose evidence each frame waits for, 0…[`MAX_LOOK_AHEAD`]; a frame is then compared with the one before it alone. None
    /// stands for as many as can matter, and for comparisons with both neighbours.
    pub look_ahead: Option<usize>,
}

impl ClipOptions {
    /// The same with other options of each [`pair`](Self::pair).
    #[must_use]
    pub const fn with_pair(self, pair: SegmentOptions) -> ClipOptions {
        ClipOptions { pair, ..self }
    }

    /// The same with another [`look_ahead`](Self::look_ahead).
    #[must_use]
    pub const fn with_look_ahead(self, look_ahead: Option<usize>) -> ClipOptions {
        ClipOptions { look_ahead, ..self }
    }

    /// The settings for the pairs of frames of the given width and height.
    fn settings(&self, size: [usize; 2]) -> Settings {
        match self.look_ahead {
            Some(_) => Settings::of_stream(&self.pair, size),
            None => Settings::of_clip(&self.pair, size),
        }
    }
}

/// One frame of a clip, segmented.
#[non_exhaustive]
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ClipFrame {
    /// Position in the clip, from 0.
    pub index: usize,
    /// One label per pixel, row by row: 0 for the background, 255 for a pixel that is marked as unknown, else the number of an object.
    #[serde(skip)]
    pub labels: Vec<u8>,
    /// The objects in sight, by number.
    pub objects: Vec<ClipObject>,
    /// Motion of the background to the next frame, pixels; none where there is no next frame of the same scene. With a look-ahead, the
    /// motion with which it came to this frame.
    pub background: Option<AffineMotion>,
}

/// An object in one frame of a clip.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ClipObject {
    /// Its number, 1…254, the same in all frames.
    pub id: u8,
    /// Number of its pixels.
    pub pixels: usize,
    /// Bounding box of its pixels: x, y, width, height.
    pub bbox: [usize; 4],
    /// Mean probability, 0…1, that its pixels belong to an object.
    pub confidence: f64,
    /// Motion of its largest part, as [`ClipFrame::background`].
    pub matrix: Option<AffineMotion>,
}
