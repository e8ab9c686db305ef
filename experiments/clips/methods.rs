//! The methods compared.

use std::fs;
use std::path::Path;
use std::time::Instant;

use veronese::clip::{ClipOptions, ClipSegmenter, StreamSegmenter};
use veronese::{Frame, Quality, SegmentOptions};

use super::cases::{Data, labels};
use crate::Result;

/// In the order of the tables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// The clip segmenter.
    Clip,
    /// The same, for the main subject.
    Subject,
    /// The stream segmenter with a look-ahead.
    Stream(Quality, usize),
    /// OpenCV: DIS flow, the dominant affine motion, a threshold.
    LayeredMotion,
    /// OpenCV: background subtraction.
    Mog2,
    Knn,
}

impl Method {
    pub const ALL: [Method; 8] = [
        Method::Clip,
        Method::Subject,
        Method::Stream(Quality::Best, 4),
        Method::Stream(Quality::Fast, 4),
        Method::Stream(Quality::Fast, 0),
        Method::LayeredMotion,
        Method::Mog2,
        Method::Knn,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Method::Clip => "clip",
            Method::Subject => "subject",
            Method::Stream(Quality::Best, _) => "stream",
            Method::Stream(_, 0) => "live",
            Method::Stream(..) => "stream-fast",
            Method::LayeredMotion => "flow",
            Method::Mog2 => "mog2",
            Method::Knn => "knn",
        }
    }

    pub fn title(self) -> &'static str {
        match self {
            Method::Clip => "clip",
            Method::Subject => "clip, main subject",
            Method::Stream(Quality::Best, _) => "stream, look-ahead 4",
            Method::Stream(_, 0) => "stream, fast, look-ahead 0",
            Method::Stream(..) => "stream, fast, look-ahead 4",
            Method::LayeredMotion => "OpenCV, DIS flow",
            Method::Mog2 => "OpenCV, MOG2",
            Method::Knn => "OpenCV, KNN",
        }
    }
}

/// The labels of a clip, and what they took.
pub struct Found {
    pub labels: Vec<Vec<u8>>,
    /// Of one frame; unknown of other programs.
    pub milliseconds: Option<f64>,
}

/// The clip segmenter's labels of every frame, an object the same number in all. What the pairs told is kept in a folder, if there is one.
pub fn clip_labels(mut segmenter: ClipSegmenter, frames: &[Frame], kept: Option<&Path>) -> Result<Vec<Vec<u8>>> {
    for (index, frame) in frames.iter().enumerate() {
        let told = segmenter.push(frame.clone())?;
        if let Some(folder) = kept {
            fs::create_dir_all(folder)?;
            fs::write(folder.join(index.to_string()), told.to_bytes())?;
        }
    }
    let clip = segmenter.conclude();
    frames.iter().enumerate().map(|(index, frame)| Ok(clip.frame(index, frame)?.labels)).collect()
}

/// The same of the stream segmenter.
fn stream_labels(quality: Quality, look_ahead: usize, frames: &[Frame]) -> Result<Vec<Vec<u8>>> {
    let pair = SegmentOptions::default().with_quality(quality);
    let mut segmenter = StreamSegmenter::new(ClipOptions::default().with_pair(pair).with_look_ahead(Some(look_ahead)))?;
    let mut found = Vec::new();
    for frame in frames {
        found.extend(segmenter.push(frame.clone())?);
    }
    found.extend(segmenter.finish());
    Ok(found.into_iter().map(|frame| frame.labels).collect())
}

/// What a method finds in a clip; `None` if it does not exist here. Labels of other programs are in `peers`, by method and clip; `kept` is as
/// of [`clip_labels`].
pub fn found(method: Method, name: &str, data: &Data, peers: &Path, kept: Option<&Path>) -> Result<Option<Found>> {
    let start = Instant::now();
    let own = match method {
        Method::Clip => Some(clip_labels(ClipSegmenter::new(ClipOptions::default())?, &data.frames, kept)?),
        Method::Subject => {
            let options = ClipOptions::default().with_pair(SegmentOptions::default().with_subject(true));
            Some(clip_labels(ClipSegmenter::new(options)?, &data.frames, None)?)
        }
        Method::Stream(quality, look_ahead) => Some(stream_labels(quality, look_ahead, &data.frames)?),
        Method::LayeredMotion | Method::Mog2 | Method::Knn => None,
    };
    if let Some(labels) = own {
        let milliseconds = Some(1e3 * start.elapsed().as_secs_f64() / data.frames.len() as f64);
        return Ok(Some(Found { labels, milliseconds }));
    }
    let theirs = labels(&peers.join(method.name()).join(name), data)?;
    Ok(theirs.map(|labels| Found { labels, milliseconds: None }))
}
