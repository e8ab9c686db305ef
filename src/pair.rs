//! The image pipeline: from two frames to masks. A pair passes through the files in this order:
//!
//! 1. [`frames`]: two frames at several sizes;
//! 2. [`dominant`]: the dominant motion, which is that of the background, and the change of brightness;
//! 3. [`hypotheses`]: the background moves with the dominant motion, or is at rest, each with the [`motions`] of its objects;
//! 4. [`labels`]: the motion of every working pixel;
//! 5. [`groups`]: motions that are parts of one thing, and [`figure`]: which of them are objects;
//! 6. [`report`]: masks at full size, statistics and scores.
//!
//! [`frame_motions`] solves the pairs of clips, [`settings`] depend on options and size, and an [`observer`] gets intermediate results.

mod dominant;
pub(crate) mod figure;
pub(crate) mod frame_motions;
pub(crate) mod frames;
mod groups;
mod hypotheses;
mod labels;
mod motions;
pub(crate) mod observer;
mod planar_flow;
mod report;
pub(crate) mod settings;

pub use report::{Junction, PairEvidence, Segmentation, SegmentedMotion};

use crate::error::Result;
use crate::frame::Frame;
use crate::model::Model;
use crate::options::SegmentOptions;
use crate::progress::{Progress, Stages};
use frames::Pair;
use observer::Observer;
use settings::Settings;

/// The stages of [`segment_pair`], in order.
const STAGES: &[&str] =
    &["frames", "dominant", "measurements", "algebra", "selection", "refinement", "labels", "masks"];

/// Segments two frames: estimates how many motions there are, each motion, and the pixels that follow it.
///
/// Labels are those of the pixels of `first`; they number the motions from 0 by decreasing number of pixels. A motion gives the
/// displacement (u, v) of the pixel (x, y) to `second`, in pixels of the full-size frame; (0, 0) is the centre of the top-left pixel, x
/// points right, y down. Motions of one thing share a [`group`](SegmentedMotion::group); group 0 is the background. `progress` is called at
/// the beginning of every stage.
///
/// # Errors
/// [`Error::InvalidOption`](crate::Error::InvalidOption) for a number of motions outside 1 to [`MAX_MOTIONS`](crate::MAX_MOTIONS),
/// [`Error::FrameSizeMismatch`](crate::Error::FrameSizeMismatch) for frames of different sizes.
pub fn segment_pair(
    first: &Frame,
    second: &Frame,
    options: &SegmentOptions,
    progress: Progress<'_>,
) -> Result<Segmentation> {
    segment_observed([first, second], options, &Model::DEFAULT, &mut Stages::new(STAGES, progress))
}

/// [`segment_pair`] with other constants, for studies and fits.
///
/// # Errors
/// As [`segment_pair`].
#[cfg(feature = "ablation")]
#[doc(hidden)]
pub fn segment_pair_with(
    model: &'static Model,
    first: &Frame,
    second: &Frame,
    options: &SegmentOptions,
) -> Result<Segmentation> {
    segment_observed([first, second], options, model, &mut ())
}

/// [`segment_pair`] with other constants and an observer of its stages.
pub(crate) fn segment_observed(
    [first, second]: [&Frame; 2],
    options: &SegmentOptions,
    model: &'static Model,
    observer: &mut dyn Observer,
) -> Result<Segmentation> {
    options.motions.validate()?;
    first.check_size_of(second)?;
    let size = [first.width(), first.height()];
    let settings = Settings::new(options, size, model);
    let detail = settings.of_detail(options, size);
    let rounds = 1 + usize::from(detail.is_some());
    observer.round_begins(0, rounds);
    let pair = Pair::of_frames([first, second], &settings);
    let mut labelled = hypotheses::solve(pair, &[], &settings, observer);
    if let Some(settings) = detail {
        observer.round_begins(1, rounds);
        let pair = Pair::of_frames([first, second], &settings);
        labelled = hypotheses::carry_on(labelled, pair, &settings, observer);
    }
    labels::return_shadows(&mut labelled, &settings);
    observer.finished(&labelled.pair, &labelled.motions, &labelled.labels);
    observer.stage_begins("masks");
    Ok(report::report(labelled, &settings, [first, second], options))
}
