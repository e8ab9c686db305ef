//! Two frames at several sizes, on which motions and labels are compared.

use std::sync::Arc;

use super::settings::Settings;
use crate::frame::Frame;
use crate::frame::pyramid::{Appearance, FramePyramid};
use crate::frame::scaling::Scaling;
use crate::view::level::{PairLevel, levels};

/// The levels of a pair, from the working size down. The pair of the opposite direction has the frames swapped.
#[derive(Clone)]
pub(crate) struct Pair {
    /// Level 0 is the working size.
    pub(crate) levels: Vec<PairLevel>,
    /// Index of the level on which the dominant motion is found and others are proposed.
    pub(crate) base: usize,
    /// Index of the level on which motions are first selected, the base level or a finer one.
    pub(crate) selection: usize,
    /// Index of the level on which labels are drafted.
    pub(crate) draft: usize,
    /// Pictures and colours that the labels follow, at the sizes of the levels.
    pub(super) appearance: Arc<Appearance>,
    /// Between the frames and the working size.
    pub(crate) scaling: Scaling,
}

impl Pair {
    /// The pair of two frames.
    pub(crate) fn of_frames([first, second]: [&Frame; 2], settings: &Settings) -> Pair {
        let [pyramid, second] = [first, second].map(|frame| settings.pyramid(frame));
        // The pyramids are not used afterwards: the pair owns the planes, and need not copy what it changes.
        Pair::new(first, &pyramid, &second, settings)
    }

    /// The pair of two frames; `pyramid` is that of `first`.
    pub(super) fn new(first: &Frame, pyramid: &FramePyramid, second: &FramePyramid, settings: &Settings) -> Pair {
        let levels = levels(&pyramid.levels, &second.levels, settings.model);
        let within =
            |side: usize| levels.iter().position(|l| l.width().max(l.height()) <= side).unwrap_or(levels.len() - 1);
        let [base, selection, draft] = [settings.base_side, settings.selection_side, settings.draft_side].map(within);
        let appearance = Arc::clone(pyramid.appearance(first));
        Pair { levels, base, selection, draft, appearance, scaling: pyramid.scaling }
    }

    pub(crate) fn finest(&self) -> &PairLevel {
        &self.levels[0]
    }

    /// Between the working size and the level on which labels are drafted.
    pub(super) fn draft_scaling(&self) -> Scaling {
        Scaling::halved(self.scaling.small, self.draft)
    }
}
