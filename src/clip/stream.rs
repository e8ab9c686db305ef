//! Streams: clips whose frames come once.

use super::description::ClipFrame;
use super::description::WorkingFrame;
use super::options::{ClipOptions, MAX_LOOK_AHEAD};
use super::tracker::{Tracked, Tracker};
use crate::error::Result;
use crate::frame::Frame;

/// Segments a stream, a clip whose frames come once, as from a camera. Frames are pushed one after another and returned in order, with
/// labels that stay the same.
///
/// ```
/// use veronese::clip::{ClipOptions, StreamSegmenter};
///
/// # fn main() -> veronese::Result<()> {
/// # let scene = scenes::generate(&scenes::SceneOptions { width: 160, height: 120, objects: 1, ..Default::default() })?;
/// # let (first, second) = (scene.first(), scene.second());
/// let mut stream = StreamSegmenter::new(ClipOptions::default().with_look_ahead(Some(0)))?;
/// let mut frames = Vec::new();
/// for frame in [first, second] {
///     frames.extend(stream.push(frame.clone())?);
/// }
/// frames.extend(stream.finish());
/// assert_eq!(frames.len(), 2);
/// assert!(frames.iter().all(|frame| frame.labels.len() == 160 * 120));
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct StreamSegmenter {
    tracker: Tracker,
}

impl StreamSegmenter {
    /// A segmenter for one stream. Without a look-ahead, each frame waits for [`MAX_LOOK_AHEAD`] later ones.
    ///
    /// # Errors
    /// [`Error::InvalidOption`](crate::Error::InvalidOption) for a look-ahead above [`MAX_LOOK_AHEAD`] or a number of motions out of
    /// range.
    pub fn new(options: ClipOptions) -> Result<StreamSegmenter> {
        let look_ahead = Some(options.look_ahead.unwrap_or(MAX_LOOK_AHEAD));
        Ok(StreamSegmenter { tracker: Tracker::new(ClipOptions { look_ahead, ..options }, true)? })
    }

    /// Takes the next frame. Returns a frame that has waited long enough, if there is one.
    ///
    /// # Errors
    /// [`Error::FrameSizeMismatch`](crate::Error::FrameSizeMismatch); the stream may go on with another frame.
    pub fn push(&mut self, frame: Frame) -> Result<Option<ClipFrame>> {
        let (tracked, _) = self.tracker.push(frame, None)?;
        Ok(tracked.and_then(|tracked| self.described(&tracked)))
    }

    /// The frames that still wait. The segmenter is then ready for another stream, whose objects get new numbers.
    pub fn finish(&mut self) -> Vec<ClipFrame> {
        let rest = self.tracker.finish();
        rest.iter().filter_map(|tracked| self.described(tracked)).collect()
    }

    /// Number of objects for which no number was left; they count as background.
    pub fn dropped(&self) -> usize {
        self.tracker.dropped()
    }

    fn described(&self, Tracked { record, labels, log_odds, goes_on }: &Tracked) -> Option<ClipFrame> {
        let working = WorkingFrame {
            index: record.index,
            labels,
            log_odds,
            onward: record.onward.as_ref().filter(|_| *goes_on),
            mark_unknown: self.tracker.options().pair.mark_unknown,
        };
        record.frame.as_ref().map(|frame| working.described(frame.luminance()))
    }
}
