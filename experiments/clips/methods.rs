//! The methods compared.

use std::path::Path;
use std::time::Instant;

use veronese::clip::{ClipOptions, ClipSegmenter};
use veronese::{Frame, Quality, Result, SegmentOptions};

use crate::cases::{Data, labels};
use crate::linking::pair_by_pair;

/// In the order of the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Method {
    /// The clip segmenter.
    Clip,
    /// Each pair by itself, its masks linked.
    Pairs,
    /// The same, fast.
    PairsFast,
    /// OpenCV: DIS flow, the dominant affine motion, a threshold.
    Flow,
    /// OpenCV: background subtraction.
    Mog2,
    Knn,
}

impl Method {
    pub(crate) const ALL: [Method; 6] =
        [Method::Clip, Method::Pairs, Method::PairsFast, Method::Flow, Method::Mog2, Method::Knn];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Method::Clip => "clip",
            Method::Pairs => "pairs",
            Method::PairsFast => "pairs-fast",
            Method::Flow => "flow",
            Method::Mog2 => "mog2",
            Method::Knn => "knn",
        }
    }

    pub(crate) fn title(self) -> &'static str {
        match self {
            Method::Clip => "clip",
            Method::Pairs => "pair by pair",
            Method::PairsFast => "pair by pair, fast",
            Method::Flow => "OpenCV, DIS flow",
            Method::Mog2 => "OpenCV, MOG2",
            Method::Knn => "OpenCV, KNN",
        }
    }
}

/// The labels of a clip, and what they took.
pub(crate) struct Found {
    pub(crate) labels: Vec<Vec<u8>>,
    /// Of one frame; unknown of other programs.
    pub(crate) milliseconds: Option<f64>,
}

/// The clip segmenter's labels of every frame, an object the same number in all.
fn clip_labels(frames: &[Frame]) -> Result<Vec<Vec<u8>>> {
    let mut segmenter = ClipSegmenter::new(ClipOptions::default())?;
    for frame in frames {
        segmenter.push(frame.clone())?;
    }
    let clip = segmenter.conclude();
    frames.iter().enumerate().map(|(index, frame)| Ok(clip.frame(index, frame)?.labels)).collect()
}

/// What a method finds in a clip; `None` if it does not exist here. Labels of other programs are in `peers`, by method and clip.
pub(crate) fn found(
    method: Method,
    name: &str,
    data: &Data,
    peers: &Path,
) -> std::result::Result<Option<Found>, Box<dyn std::error::Error + Send + Sync>> {
    let start = Instant::now();
    let pairs = |quality| pair_by_pair(&data.frames, &SegmentOptions { quality, ..SegmentOptions::default() });
    let own = match method {
        Method::Clip => Some(clip_labels(&data.frames)?),
        Method::Pairs => Some(pairs(Quality::Best)?),
        Method::PairsFast => Some(pairs(Quality::Fast)?),
        Method::Flow | Method::Mog2 | Method::Knn => None,
    };
    if let Some(labels) = own {
        let milliseconds = Some(1e3 * start.elapsed().as_secs_f64() / data.frames.len() as f64);
        return Ok(Some(Found { labels, milliseconds }));
    }
    let theirs = labels(&peers.join(method.name()).join(name), data)?;
    Ok(theirs.map(|labels| Found { labels, milliseconds: None }))
}
