//! How a frame of a clip is paired with the previous one.

use super::carry::continued_labels;
use super::pairs::{LayeredMotion, Pairs, layered_motion, log_odds};
use super::record::PendingFrame;
use crate::frame::Plane;
use crate::options::SegmentOptions;
use crate::pair::frame_motions::{Expected, FrameMotions, Prior};
use crate::pair::settings::Settings;

/// In a whole clip, a frame is solved in pairs with both neighbours.
pub(super) fn of_whole_clip(last: &PendingFrame, newest: &PendingFrame, settings: &Settings) -> Pairs {
    let onward = last.motions_to(&newest.pyramid, settings, Expected::Nothing);
    let inverse = layered_motion(onward.clone()).continued();
    let labels = continued_labels(&inverse);
    let back = newest.motions_to(&last.pyramid, settings, Expected::Inverse { motions: &inverse.motions, labels });
    if onward.is_cut() && back.is_cut() {
        return Pairs::default();
    }
    Pairs { onward: Some(log_odds_and_motion(onward)), back: Some(log_odds_and_motion(back)), prior: None }
}

/// The only two frames of a clip are solved more thoroughly, as a pair is.
pub(super) fn of_lone_pair(first: &PendingFrame, last: &PendingFrame, options: &SegmentOptions) -> Pairs {
    of_whole_clip(first, last, &Settings::of_lone_pair(options, first.pyramid.scaling.full))
}

/// In a stream, a frame is solved in a pair with the previous frame; a fast stream starts from what was found there. The first frame may
/// wait for its pair with the next one.
pub(super) fn of_stream(
    last: &PendingFrame,
    newest: &PendingFrame,
    prior: Option<&Prior>,
    waits: bool,
    settings: &Settings,
) -> Pairs {
    let labels = last.back.as_ref().map(|(_, flow)| continued_labels(flow));
    let expected = match (prior, labels) {
        (Some(prior), Some(labels)) => Expected::Labels(prior, labels),
        _ => Expected::Nothing,
    };
    let back = newest.motions_to(&last.pyramid, settings, expected);
    if back.is_cut() {
        return Pairs::default();
    }
    let onward = waits.then(|| log_odds_and_motion(last.motions_to(&newest.pyramid, settings, Expected::Nothing)));
    let prior = back.prior();
    Pairs { onward, back: Some(log_odds_and_motion(back)), prior }
}

/// A repeated frame, as where the frame rate was raised, has no motion, and log-odds of zero, because it does not show what moves. The
/// expectation for the next pair stays as it is.
pub(super) fn of_repeated(newest: &PendingFrame, prior: Option<&Prior>, waits: bool) -> Pairs {
    let size @ [width, height] = newest.pyramid.scaling.small;
    let still = || (Plane::filled(width, height, 0.0), LayeredMotion { measured: true, ..LayeredMotion::still(size) });
    Pairs { onward: waits.then(still), back: Some(still()), prior: prior.cloned() }
}

fn log_odds_and_motion(solution: FrameMotions) -> (Plane, LayeredMotion) {
    (log_odds(&solution), layered_motion(solution))
}
