//! The pyramid of one frame. Nothing in it depends on another frame: a frame of a clip is prepared once and shared by its pairs.

use std::sync::Arc;
use std::sync::OnceLock;

use super::filter::{gaussian, gradients, halve};
use super::palette::Palette;
use super::picture::{Picture, colours};
use super::scaling::Scaling;
use super::{Frame, Plane};
use crate::lanes::each_with;

/// Standard deviation of the blur applied to all frames first, pixels. Bilinear warping averages noise at half-pixel shifts; without
/// the blur such shifts would win in flat areas. Chosen on generated scenes.
const PRE_BLUR: f32 = 0.5;
/// A side longer than this is halved even if the other one becomes short, pixels: the working size of quality `fast`.
const LONG: usize = 320;
/// Smallest side that such a halving leaves, pixels. Not varied: only very narrow frames reach it.
const NARROW: usize = 4;

/// One size of a frame. Immutable; pairs share its planes.
#[derive(Clone, Debug)]
pub(crate) struct FrameLevel {
    pub(crate) luminance: Arc<Plane>,
    /// Gradients, grey levels per pixel of this level.
    pub(crate) dx: Arc<Plane>,
    pub(crate) dy: Arc<Plane>,
    energy: OnceLock<Arc<Plane>>,
}

impl FrameLevel {
    fn new(luminance: Plane) -> FrameLevel {
        let (dx, dy) = gradients(&luminance);
        let [luminance, dx, dy] = [luminance, dx, dy].map(Arc::new);
        FrameLevel { luminance, dx, dy, energy: OnceLock::new() }
    }

    /// Squared gradient length, computed when it is first needed.
    pub(crate) fn energy(&self) -> Arc<Plane> {
        let squares = || {
            let mut energy = (*self.dx).clone();
            each_with(energy.values_mut(), [self.dy.values()], |dx, [dy]| dx * dx + dy * dy);
            Arc::new(energy)
        };
        self.energy.get_or_init(squares).clone()
    }
}

/// The levels of a luminance down to a shorter side of at least `smallest` pixels, or less while the longer one is long; at least one.
pub(crate) fn levels_of(luminance: Plane, smallest: usize) -> Vec<FrameLevel> {
    let mut levels = vec![FrameLevel::new(luminance)];
    while let Some(last) = levels.last().map(|level| &level.luminance) {
        let (shorter, longer) = (last.width().min(last.height()), last.width().max(last.height()));
        if shorter < 2 * smallest && !(longer > LONG && shorter >= 2 * NARROW) {
            break;
        }
        let next = FrameLevel::new(halve(last));
        levels.push(next);
    }
    levels
}

/// A frame prepared for comparison with others.
#[derive(Clone, Debug)]
pub(crate) struct FramePyramid {
    /// From the working size down.
    pub(crate) levels: Vec<FrameLevel>,
    /// From the frame to the working size.
    pub(crate) scaling: Scaling,
    /// Luminance of the working size without blur.
    unblurred: Plane,
    appearance: OnceLock<Arc<Appearance>>,
}

/// Pictures and colours of the first frame of a pair, which labels follow.
#[derive(Clone, Debug)]
pub(crate) struct Appearance {
    /// The frame without blur, from the working size down.
    pub(crate) pictures: Vec<Picture>,
    /// Quantised colour of every working pixel.
    pub(crate) palette: Palette,
}

impl FramePyramid {
    /// The pyramid of a frame that is halved `halvings` times to the working size. Its coarsest level keeps the shorter side at least
    /// `smallest` pixels long.
    pub(crate) fn new(frame: &Frame, halvings: usize, smallest: usize) -> FramePyramid {
        let mut unblurred = frame.luminance().clone();
        (0..halvings).for_each(|_| unblurred = halve(&unblurred));
        let levels = levels_of(gaussian(&unblurred, PRE_BLUR), smallest);
        let scaling = Scaling::halved([frame.width(), frame.height()], halvings);
        FramePyramid { levels, scaling, unblurred, appearance: OnceLock::new() }
    }

    /// The appearance of the frame, which must be the one from which the pyramid was made. It is computed once.
    pub(crate) fn appearance(&self, frame: &Frame) -> &Arc<Appearance> {
        self.appearance.get_or_init(|| {
            let palette = Palette::new(frame, &self.scaling);
            let colours = colours(frame, self.scaling.small[0]);
            let mut pictures = vec![Picture { luminance: self.unblurred.clone(), colours }];
            while pictures.len() < self.levels.len() {
                let half = pictures[pictures.len() - 1].halved();
                pictures.push(half);
            }
            Arc::new(Appearance { pictures, palette })
        })
    }
}
