//! Two frames at one size, with gradients, as alignment and labelling compare them.

use std::sync::Arc;

use crate::frame::area::Area;
use crate::frame::pyramid::FrameLevel;
#[cfg(test)]
use crate::frame::pyramid::levels_of;
use crate::frame::warp::RowPath;
use crate::frame::{MIN_SIDE, Plane};
use crate::model::Model;
use crate::motion::AffineMotion;

/// Correlation of neighbouring pixels' noise after the pre-blur, exp(−1/(4σ²)).
const NOISE_CORRELATION_FULL: f32 = 0.367_879_44;
/// The same of halved levels, after the filter h = [1 4 6 4 1]/16: Σ h(k) h(k + 2) / Σ h(k)² = 28/70.
const NOISE_CORRELATION_HALVED: f32 = 28.0 / 70.0;

/// One size of the frames. Pixel (x, y) lies at (2^index x, 2^index y) of the working frame, times the stride where it is thinned.
#[derive(Clone, Debug)]
pub(crate) struct PairLevel {
    /// 0 for the working size.
    pub(crate) index: u32,
    pub(crate) first: Arc<Plane>,
    pub(crate) second: Arc<Plane>,
    /// Gradients of the first frame, per pixel of the second.
    pub(crate) first_dx: Arc<Plane>,
    pub(crate) first_dy: Arc<Plane>,
    /// Gradients of the second frame.
    pub(crate) second_dx: Arc<Plane>,
    pub(crate) second_dy: Arc<Plane>,
    /// Squared gradient length of the first frame.
    pub(crate) energy: Arc<Plane>,
    /// Standard deviation of the residual of a correct motion in flat areas, grey levels (see `noise`).
    pub(crate) noise: f32,
    /// Distance of the first frame's pixels in pixels of the second: 1, or more where the level is [`thinned`](PairLevel::thinned).
    pub(crate) stride: usize,
    pub(crate) model: &'static Model,
}

impl PairLevel {
    fn new(index: u32, first: &FrameLevel, second: &FrameLevel, model: &'static Model) -> PairLevel {
        PairLevel {
            index,
            first: first.luminance.clone(),
            second: second.luminance.clone(),
            first_dx: first.dx.clone(),
            first_dy: first.dy.clone(),
            second_dx: second.dx.clone(),
            second_dy: second.dy.clone(),
            energy: first.energy(),
            noise: 0.5 * model.largest_noise,
            stride: 1,
            model,
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

    /// The stride of a sample of the pixels: 2, or 1 on a level so small that too few would remain.
    pub(crate) fn thinning(&self) -> usize {
        if self.width().min(self.height()) < MIN_SIDE { 1 } else { 2 }
    }

    /// The level with a sample of the pixels of the first frame, every second one of every second row, and the whole second frame; all of
    /// them on a small level.
    pub(crate) fn thinned(&self) -> PairLevel {
        let stride = self.thinning();
        let sample = |plane: &Arc<Plane>| if stride == 1 { plane.clone() } else { Arc::new(plane.thinned(stride)) };
        PairLevel {
            index: self.index,
            first: sample(&self.first),
            second: self.second.clone(),
            first_dx: sample(&self.first_dx),
            first_dy: sample(&self.first_dy),
            second_dx: self.second_dx.clone(),
            second_dy: self.second_dy.clone(),
            energy: sample(&self.energy),
            noise: self.noise,
            stride: self.stride * stride,
            model: self.model,
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

/// The levels of a pair, from the working size down. All pyramids are those of frames of one size.
pub(crate) fn levels(first: &[FrameLevel], second: &[FrameLevel], model: &'static Model) -> Vec<PairLevel> {
    first.iter().zip(second).zip(0..).map(|((first, second), k)| PairLevel::new(k, first, second, model)).collect()
}

/// [`levels`] of planes of luminance that need no blur.
#[cfg(test)]
pub(crate) fn build(first: Plane, second: Plane, smallest: usize) -> Vec<PairLevel> {
    let [first, second] = [first, second].map(|plane| levels_of(plane, smallest));
    levels(&first, &second, &Model::DEFAULT)
}
