//! Options of clips, and the constants that they use.

use crate::frame::scaling::Scaling;
use crate::model::ClipModel;
use crate::options::{Quality, SegmentOptions};
use crate::pair::settings::Settings;

/// Largest look-ahead of a stream, frames.
pub const MAX_LOOK_AHEAD: usize = 8;

#[cfg(feature = "ablation")]
thread_local! {
    static VARIED: std::cell::Cell<ClipModel> = const { std::cell::Cell::new(ClipModel::DEFAULT) };
}

/// The constants of clips; with the feature `ablation` those set for this thread.
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

/// The working size with each quality, of a whole clip and of a stream.
pub(super) fn working_sizes(size: [usize; 2]) -> [Scaling; 4] {
    let options =
        |quality, look_ahead| ClipOptions { pair: SegmentOptions { quality, ..SegmentOptions::default() }, look_ahead };
    let all = [(Quality::Best, None), (Quality::Best, Some(0)), (Quality::Fast, None), (Quality::Fast, Some(0))];
    all.map(|(quality, look_ahead)| options(quality, look_ahead).settings(size).scaling(size))
}

/// Options of a [`ClipSegmenter`](super::ClipSegmenter) or a [`StreamSegmenter`](super::StreamSegmenter).
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default)]
pub struct ClipOptions {
    /// Options of each pair. With `mark_unknown`, pixels whose log-odds do not decide between object and background get the label 255;
    /// `confidence` has no effect.
    pub pair: SegmentOptions,
    /// Number of later frames for which each frame waits, 0…[`MAX_LOOK_AHEAD`]; a frame is then compared with the previous frame alone.
    /// `None` stands for as many as can matter, and for comparisons with both neighbours.
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
    pub(super) fn settings(&self, size: [usize; 2]) -> Settings {
        match self.look_ahead {
            Some(_) => Settings::of_stream(&self.pair, size),
            None => Settings::of_clip(&self.pair, size),
        }
    }
}
