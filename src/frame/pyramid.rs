//! Image pyramid of the frames, with gradients, for alignment and labelling.

use std::rc::Rc;

use super::Plane;
use super::area::Area;
use super::filter::{gradients, halve};
use super::warp::RowPath;
use crate::motion::AffineMotion;

/// Standard deviation of the blur applied to all frames first, pixels. Bilinear warping averages noise at half-pixel shifts; without
/// the blur such shifts would win in flat areas.
pub(crate) const PRE_BLUR: f32 = 0.5;

/// Correlation of neighbouring pixels' noise after the pre-blur, exp(−1/(4σ²)).
const NOISE_CORRELATION_FULL: f32 = 0.367_879_44;
/// The same on coarser levels, after the 5-tap filter and halving (measured).
const NOISE_CORRELATION_HALVED: f32 = 0.4;

/// A side longer than this is halved even if the other one becomes short …
const LONG: usize = 320;
/// … but not below this.
const NARROW: usize = 4;
/// A sample of a level keeps its shorter side at least this long, pixels.
const SMALLEST_SAMPLE: usize = 8;

/// One size of the frames. Pixel (x, y) lies at (2^index x, 2^index y) of the working frame, times the stride where it is thinned.
#[derive(Clone, Debug)]
pub(crate) struct Level {
    /// 0 for the working size.
    pub(crate) index: u32,
    pub(crate) first: Plane,
    pub(crate) second: Rc<Plane>,
    pub(crate) before: Option<Rc<Plane>>,
    /// Gradients of the first frame, per pixel of the second.
    pub(crate) first_dx: Plane,
    pub(crate) first_dy: Plane,
    /// Gradients of the second frame.
    pub(crate) second_dx: Rc<Plane>,
    pub(crate) second_dy: Rc<Plane>,
    /// Squared gradient length of the first frame.
    pub(crate) energy: Plane,
    /// Standard deviation of the residual of a correct motion in flat areas, grey levels (see `noise`).
    pub(crate) noise: f32,
    /// Distance of the first frame's pixels in pixels of the second: 1, or more where the level is [`thinned`](Level::thinned).
    pub(crate) stride: usize,
}

impl Level {
    fn new(index: u32, first: Plane, second: Plane, before: Option<Plane>) -> Level {
        let (first_dx, first_dy) = gradients(&first);
        let (second_dx, second_dy) = gradients(&second);
        let mut energy = first_dx.clone();
        for (e, dy) in energy.values_mut().iter_mut().zip(first_dy.values()) {
            *e = *e * *e + dy * dy;
        }
        Level {
            index,
            first,
            second: Rc::new(second),
            before: before.map(Rc::new),
            first_dx,
            first_dy,
            second_dx: Rc::new(second_dx),
            second_dy: Rc::new(second_dy),
            energy,
            noise: 4.0,
            stride: 1,
        }
    }

    pub(crate) fn width(&self) -> usize {
        self.first.width()
    }

    pub(crate) fn height(&self) -> usize {
        self.first.height()
    }

    /// All its pixels.
    pub(crate) fn area(&self) -> Area {
        Area::whole(self.width(), self.height())
    }

    /// Size of a pixel in pixels of the working frame.
    pub(crate) fn pixel(&self) -> f64 {
        f64::from(1u32 << self.index) * self.stride as f64
    }

    /// `stride`, or less on a level so small that too few pixels would remain.
    pub(crate) fn thinning(&self, stride: usize) -> usize {
        stride.min(self.width().min(self.height()) / SMALLEST_SAMPLE).max(1)
    }

    /// The level with every `stride`-th pixel of every `stride`-th row of the first frame and the whole second frame: a sample of the
    /// pixels without blur. Small levels keep more pixels ([`thinning`](Self::thinning)).
    pub(crate) fn thinned(&self, stride: usize) -> Level {
        let stride = self.thinning(stride);
        Level {
            index: self.index,
            first: self.first.thinned(stride),
            second: self.second.clone(),
            before: self.before.clone(),
            first_dx: self.first_dx.thinned(stride),
            first_dy: self.first_dy.thinned(stride),
            second_dx: self.second_dx.clone(),
            second_dy: self.second_dy.clone(),
            energy: self.energy.thinned(stride),
            noise: self.noise,
            stride: self.stride * stride,
        }
    }

    /// Where a motion in pixels of this level takes the pixels of row `y` from column `x0` on, in pixels of the second frame.
    pub(crate) fn path(&self, scaled: &AffineMotion, x0: usize, y: usize) -> RowPath {
        RowPath::new(scaled, x0, y).times(self.stride as f64)
    }

    /// A motion of the working frame in pixels of this level.
    pub(crate) fn scaled(&self, motion: &AffineMotion) -> AffineMotion {
        let mut a = motion.matrix;
        a[2] /= self.pixel();
        a[5] /= self.pixel();
        AffineMotion::new(a)
    }

    /// Inverse of [`scaled`](Self::scaled).
    pub(crate) fn unscaled(&self, motion: &AffineMotion) -> AffineMotion {
        let mut a = motion.matrix;
        a[2] *= self.pixel();
        a[5] *= self.pixel();
        AffineMotion::new(a)
    }

    /// Correlation of the noise of neighbouring pixels.
    pub(crate) fn noise_correlation(&self) -> f32 {
        if self.index == 0 { NOISE_CORRELATION_FULL } else { NOISE_CORRELATION_HALVED }
    }
}

/// The levels from the working size down to a shorter side of at least `smallest` pixels, or less while the longer one is long; at least
/// one.
pub(crate) fn build(first: Plane, second: Plane, before: Option<Plane>, smallest: usize) -> Vec<Level> {
    let mut levels = vec![Level::new(0, first, second, before)];
    while let Some(last) = levels.last() {
        let (shorter, longer) = (last.width().min(last.height()), last.width().max(last.height()));
        if shorter < 2 * smallest && !(longer > LONG && shorter >= 2 * NARROW) {
            break;
        }
        let next =
            Level::new(last.index + 1, halve(&last.first), halve(&last.second), last.before.as_deref().map(halve));
        levels.push(next);
    }
    levels
}
