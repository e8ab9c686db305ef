//! Change of brightness, gain and bias, from the first frame to the second.

use std::sync::Arc;

use crate::frame::Plane;
use crate::frame::warp::Footprint;
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::view::level::PairLevel;

/// The grey level at which the effect of a gain is measured, in the middle of the range.
pub(crate) const GREY: f64 = 128.0;

/// Change of brightness between the frames: `I2 ≈ I1 (1 + gain/128) + bias`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct GainBias {
    /// Grey levels.
    pub(crate) bias: f64,
    /// Grey levels at a grey level of 128.
    pub(crate) gain: f64,
}

impl GainBias {
    /// A first guess from the mean and standard deviation of both frames.
    pub(crate) fn from_moments(first: &Plane, second: &Plane, model: &Model) -> GainBias {
        let (first_mean, first_deviation) = mean_and_deviation(first);
        let (second_mean, second_deviation) = mean_and_deviation(second);
        let gain = (second_deviation / first_deviation.max(model.least_deviation.into()))
            .clamp(1.0 / model.largest_gain, model.largest_gain);
        GainBias { bias: second_mean - gain * first_mean, gain: (gain - 1.0) * GREY }
    }

    /// Refined between the two frames under the zero motion.
    pub(crate) fn refined_at_rest(mut self, level: &PairLevel) -> GainBias {
        for _ in 0..level.model.brightness_iterations {
            self = self.step(level, |x, y| Some(level.second.at(x * level.stride, y * level.stride)));
        }
        self
    }

    /// The change along a motion of the working frame.
    pub(crate) fn along(level: &PairLevel, motion: &AffineMotion) -> GainBias {
        GainBias::along_labels(level, &[*motion], |_, _| 0)
    }

    /// The change where each pixel has one of several motions, the one of its `label`.
    pub(crate) fn along_labels(
        level: &PairLevel,
        motions: &[AffineMotion],
        label: impl Fn(usize, usize) -> usize,
    ) -> GainBias {
        let second = &level.second;
        let scaled: Vec<AffineMotion> = motions.iter().map(|motion| level.scaled(motion)).collect();
        let sample = |x: usize, y: usize| {
            let (px, py) = level.path(&scaled[label(x, y)], x, y).at(0);
            let footprint = Footprint::new(px, py, second.width(), second.height());
            footprint.inside.then(|| footprint.sample(second.values()))
        };
        let width = level.width();
        // Computed once: they are the same in every step.
        let samples: Vec<Option<f32>> = (0..level.first.values().len()).map(|p| sample(p % width, p / width)).collect();
        let start = GainBias::from_moments(&level.first, second, level.model);
        (0..level.model.brightness_iterations)
            .fold(start, |photometric, _| photometric.step(level, |x, y| samples[y * width + x]))
    }

    /// One reweighted least squares step between the pixels of the first frame and the samples of the second that belong to them.
    fn step(self, level: &PairLevel, sample: impl Fn(usize, usize) -> Option<f32>) -> GainBias {
        let variance = f64::from(level.noise * level.noise);
        let truncation = f64::from(level.model.truncation);
        let (mut q, mut qi, mut qii, mut qr, mut qir) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for p in 0..level.first.values().len() {
            let (x, y) = (p % level.width(), p / level.width());
            let Some(value) = sample(x, y) else { continue };
            let first = level.first.values()[p];
            let i = f64::from(first) / GREY;
            let r = f64::from(value) - f64::from(first) - self.bias - self.gain * i;
            let robust = truncation / (truncation + r * r / variance);
            let w = robust * robust;
            q += w;
            qi += w * i;
            qii += w * i * i;
            qr += w * r;
            qir += w * i * r;
        }
        let determinant = q * qii - qi * qi;
        if determinant <= 1e-9 * q * qii {
            return GainBias { bias: self.bias + qr / q.max(1e-9), gain: self.gain };
        }
        GainBias {
            bias: self.bias + (qii * qr - qi * qir) / determinant,
            gain: self.gain + (q * qir - qi * qr) / determinant,
        }
    }

    /// Removes the change from the second frame of a level, `(I − bias) / (1 + gain/128)`, and the gain from its gradients.
    pub(crate) fn remove_from(self, level: &mut PairLevel) {
        let (scale, bias) = ((1.0 / (1.0 + self.gain / GREY)) as f32, self.bias as f32);
        let remove = |plane: &mut Arc<Plane>, bias: f32| {
            Arc::make_mut(plane).values_mut().iter_mut().for_each(|v| *v = (*v - bias) * scale);
        };
        remove(&mut level.second, bias);
        remove(&mut level.second_dx, 0.0);
        remove(&mut level.second_dy, 0.0);
    }
}

fn mean_and_deviation(plane: &Plane) -> (f64, f64) {
    let n = plane.values().len() as f64;
    let mean = plane.total() / n;
    let variance = plane.values().iter().map(|&v| (f64::from(v) - mean) * (f64::from(v) - mean)).sum::<f64>() / n;
    (mean, variance.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::filter::gaussian;
    use crate::random::Random;
    use crate::view::level::build;

    #[test]
    fn the_change_is_measured_along_the_motion_despite_other_movers() {
        let mut random = Random::from_seed(3);
        let texture = gaussian(&Plane::from_fn(100, 60, |_, _| random.uniform(-200.0, 450.0) as f32), 1.0);
        let first = Plane::from_fn(80, 60, |x, y| texture.at(x + 10, y));
        // The scene moves by 4 pixels to the left; a fifth of it does something else.
        let second = Plane::from_fn(80, 60, |x, y| if x < 16 { 90.0 } else { texture.at(x + 14, y) * 0.8 + 12.0 });
        let level = &build(first, second, 64)[0];
        let found = GainBias::along(level, &AffineMotion::translation(-4.0, 0.0));
        assert!((found.bias - 12.0).abs() < 0.5, "{found:?}");
        assert!((1.0 + found.gain / 128.0 - 0.8).abs() < 0.01, "{found:?}");
    }
}
