//! The cost of a motion at a pixel: a robust function of the intensity difference along it, in units of its standard deviation.
//!
//! ```text
//! r  = I2(x + A x) − I1(x)                           intensity difference along the motion
//! v  = s² q(A, x) + κ² |∇I1|²                         its variance if A is correct: noise, plus a position error of κ pixels
//! ρ  = e / (1 + e/T),  e = r²/v                       Geman-McClure, saturating at T
//! ```
//! `q` corrects for the averaging that bilinear interpolation does to noise: `q = (1 + k(fx) k(fy)) / 2` with
//! `k(f) = 1 − 2 (1 − c) f (1 − f)`, f the fractional shift and c the correlation of neighbouring noise. Without it a
//! half-pixel shift beats the true motion in flat areas.

use super::brightness::{GREY, GainBias};
use crate::frame::Plane;
use crate::frame::area::Area;
use crate::frame::warp::{CHUNK, Footprints};
use crate::lanes::{LANES, each, lower};
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::order::median;
use crate::view::level::PairLevel;

/// Smallest noise, grey levels: rounding both frames makes √(1/12 + 1/12).
pub(crate) const SMALLEST_NOISE: f32 = 0.408;

/// The two constants of the cost.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RobustKernel {
    /// T: the largest cost, of a pixel that the motion does not explain.
    pub(crate) truncation: f32,
    /// κ: standard deviation of the position predicted by a correct motion, pixels.
    pub(crate) position_sigma: f32,
}

impl RobustKernel {
    /// For estimating motions.
    #[inline(always)]
    pub(crate) fn estimation(model: &Model) -> RobustKernel {
        RobustKernel { truncation: model.truncation, position_sigma: model.position_sigma }
    }

    /// For labelling pixels.
    #[inline(always)]
    pub(crate) fn labels(model: &Model) -> RobustKernel {
        RobustKernel { truncation: model.largest_cost(), position_sigma: model.position_sigma }
    }

    #[inline(always)]
    fn of(self, residual: f32, variance: f32) -> f32 {
        // e / (1 + e/T) with a single division by anything but T.
        let square = residual * residual;
        square / (variance + square * (1.0 / self.truncation))
    }

    /// Neutral cost of a pixel whose displaced position lies outside the second frame.
    pub(crate) fn outside(self) -> f32 {
        0.5 * self.truncation
    }
}

/// Noise factor q of interpolation at the fractional shift (fx, fy).
#[inline(always)]
fn interpolation_variance(fx: f32, fy: f32, correlation: f32) -> f32 {
    let c = 2.0 * (1.0 - correlation);
    0.5 * (1.0 + (1.0 - c * fx * (1.0 - fx)) * (1.0 - c * fy * (1.0 - fy)))
}

/// Cost of a motion (of the working frame) at every pixel of a level, between the first frame and the second. A pixel that leaves the
/// second frame has the neutral cost.
pub(crate) fn cost(level: &PairLevel, motion: &AffineMotion, model: RobustKernel) -> Plane {
    cost_within(level, &level.area(), motion, model)
}

/// [`cost`] of every motion.
pub(crate) fn costs(level: &PairLevel, motions: &[AffineMotion], model: RobustKernel) -> Vec<Plane> {
    motions.iter().map(|motion| cost(level, motion, model)).collect()
}

/// [`cost`] at the pixels of an area, as a plane of its size.
#[inline(never)]
pub(crate) fn cost_within(level: &PairLevel, area: &Area, motion: &AffineMotion, model: RobustKernel) -> Plane {
    let mut plane = Comparison::new(level, motion, model).plane(area);
    each(plane.values_mut(), |c| if c.is_finite() { c } else { model.outside() });
    plane
}

/// [`cost`] that is infinite where the displaced position lies outside the second frame.
#[inline(never)]
pub(crate) fn cost_where_seen(level: &PairLevel, motion: &AffineMotion, model: RobustKernel) -> Plane {
    Comparison::new(level, motion, model).plane(&level.area())
}

/// Cost under a change of brightness that has not yet been removed from the second frame.
pub(crate) fn cost_with(level: &PairLevel, motion: &AffineMotion, photometric: GainBias, model: RobustKernel) -> Plane {
    Comparison { photometric, outside: model.outside(), ..Comparison::new(level, motion, model) }.plane(&level.area())
}

/// A level's frames compared along a motion.
pub(crate) struct Comparison<'a> {
    level: &'a PairLevel,
    scaled: AffineMotion,
    photometric: GainBias,
    model: RobustKernel,
    /// Cost of a pixel that leaves the second frame.
    outside: f32,
}

impl<'a> Comparison<'a> {
    /// A comparison in which pixels that leave the second frame have infinite cost.
    pub(crate) fn new(level: &'a PairLevel, motion: &AffineMotion, model: RobustKernel) -> Comparison<'a> {
        let photometric = GainBias::default();
        Comparison { level, scaled: level.scaled(motion), photometric, model, outside: f32::INFINITY }
    }

    fn plane(&self, area: &Area) -> Plane {
        let mut plane = Plane::filled(area.width(), area.height(), 0.0);
        for (k, y) in area.rows.clone().enumerate() {
            self.row(y, area.columns.start, plane.row_mut(k));
        }
        plane
    }

    /// Fills `costs` with those of row y from column `left` on.
    pub(crate) fn row(&self, y: usize, left: usize, costs: &mut [f32]) {
        let level = self.level;
        let (noise, position) = (level.noise * level.noise, self.model.position_sigma * self.model.position_sigma);
        let (bias, gain) = (self.photometric.bias as f32, (self.photometric.gain / GREY) as f32);
        let correlation = level.noise_correlation();
        let path = level.path(&self.scaled, left, y);
        let mut samples = [0.0; CHUNK];
        let mut at = Footprints::new();
        let cost = |sample: f32, first: f32, energy: f32, [fx, fy]: [f32; 2]| {
            let residual = sample - first * (1.0 + gain) - bias;
            let variance = noise * interpolation_variance(fx, fy, correlation) + position * energy;
            self.model.of(residual, variance)
        };
        let columns = left..left + costs.len();
        let rows = level.first.row(y)[columns.clone()].chunks(CHUNK).zip(level.energy.row(y)[columns].chunks(CHUNK));
        for (k, (costs, (first, energy))) in costs.chunks_mut(CHUNK).zip(rows).enumerate() {
            at.follow(&path, k * CHUNK, costs.len(), level.second.width(), level.second.height());
            at.sample(level.second.values(), &mut samples);
            let (blocks, rest) = costs.as_chunks_mut::<LANES>();
            let ((first, first_rest), (energy, energy_rest)) =
                (first.as_chunks::<LANES>(), energy.as_chunks::<LANES>());
            let places = [&samples, &at.fx, &at.fy].map(|values| values.as_chunks::<LANES>().0.iter());
            let [samples_of, fx_of, fy_of] = places;
            let done = blocks.as_flattened().len();
            for (((block, first), energy), ((sample, fx), fy)) in
                blocks.iter_mut().zip(first).zip(energy).zip(samples_of.zip(fx_of).zip(fy_of))
            {
                *block = std::array::from_fn(|l| cost(sample[l], first[l], energy[l], [fx[l], fy[l]]));
            }
            for (k, ((c, first), energy)) in rest.iter_mut().zip(first_rest).zip(energy_rest).enumerate() {
                let k = done + k;
                *c = cost(samples[k], *first, *energy, [at.fx[k], at.fy[k]]);
            }
            if !at.all_inside(costs.len()) {
                let outside = costs.iter_mut().enumerate().filter(|(k, _)| !at.is_inside(*k));
                outside.for_each(|(_, cost)| *cost = self.outside);
            }
        }
    }
}

/// The smallest of the costs at every pixel, at most `most`.
pub(crate) fn cheapest(costs: &[Plane], most: f32) -> Plane {
    let Some(first) = costs.first() else { return Plane::filled(0, 0, 0.0) };
    let mut cheapest = Plane::filled(first.width(), first.height(), most);
    for cost in costs {
        lower(cheapest.values_mut(), cost.values());
    }
    cheapest
}

/// Standard deviation of the intensity difference along a correct motion, grey levels, from the flatter half of the pixels
/// (1.4826 × median absolute deviation), between that of rounding and the largest one of the model.
pub(crate) fn noise(level: &PairLevel, motion: &AffineMotion) -> f32 {
    let level = &level.thinned();
    let scaled = level.scaled(motion);
    let flat = median(level.energy.values()).unwrap_or(0.0);
    let mut residuals = Vec::with_capacity(level.energy.values().len());
    let (mut samples, mut at) = ([0.0; CHUNK], Footprints::new());
    for y in 0..level.height() {
        let path = level.path(&scaled, 0, y);
        let rows = level.first.row(y).chunks(CHUNK).zip(level.energy.row(y).chunks(CHUNK));
        for (k, (first, energy)) in rows.enumerate() {
            at.follow(&path, k * CHUNK, first.len(), level.second.width(), level.second.height());
            at.sample(level.second.values(), &mut samples);
            for x in (0..first.len()).filter(|&x| at.is_inside(x) && energy[x] <= flat) {
                let q = interpolation_variance(at.fx[x], at.fy[x], level.noise_correlation());
                residuals.push((samples[x] - first[x]) / q.sqrt());
            }
        }
    }
    let Some(centre) = median(&residuals) else { return level.model.largest_noise };
    residuals.iter_mut().for_each(|r| *r = (*r - centre).abs());
    // The median distance of a normal variable is its deviation over 1.4826.
    (1.4826 * median(&residuals).unwrap_or(level.model.largest_noise)).clamp(SMALLEST_NOISE, level.model.largest_noise)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::view::level::build;

    fn level() -> PairLevel {
        let mut random = Random::from_seed(5);
        let mut noise = || Plane::from_fn(70, 50, |_, _| random.uniform(0.0, 255.0) as f32);
        let (first, second) = (noise(), noise());
        build(first, second, 64).remove(0)
    }

    const MOTION: AffineMotion = AffineMotion { matrix: [0.02, -0.01, 9.3, 0.03, 0.01, -4.6] };

    #[test]
    fn the_cost_of_an_area_is_that_part_of_the_whole() {
        let level = level();
        let whole = cost(&level, &MOTION, RobustKernel::labels(level.model));
        let area = Area { columns: 3..68, rows: 7..31 };
        let part = cost_within(&level, &area, &MOTION, RobustKernel::labels(level.model));
        assert_eq!((part.width(), part.height()), (65, 24));
        for (k, y) in area.rows.clone().enumerate() {
            for (a, b) in part.row(k).iter().zip(&whole.row(y)[area.columns.clone()]) {
                assert!((a - b).abs() < 1e-3, "row {y}: {a}, {b}");
            }
        }
    }

    #[test]
    fn a_sample_of_the_pixels_costs_what_these_pixels_cost() {
        let level = level();
        let whole = cost(&level, &MOTION, RobustKernel::estimation(level.model));
        let sample = cost(&level.thinned(), &MOTION, RobustKernel::estimation(level.model));
        assert_eq!((sample.width(), sample.height()), (35, 25));
        for (a, b) in sample.values().iter().zip(whole.thinned(2).values()) {
            assert!((a - b).abs() < 1e-3, "{a}, {b}");
        }
    }

    #[test]
    fn costs_of_a_part_of_a_row_are_those_of_the_plane() {
        let frame =
            |shift: f32| Plane::from_fn(150, 20, |x, y| 100.0 + 50.0 * libm::sinf(0.3 * x as f32 + shift + y as f32));
        let levels = build(frame(0.0), frame(0.2), 16);
        let motion = AffineMotion::new([0.01, 0.0, -6.0, 0.0, -0.02, 1.5]);
        let comparison = Comparison::new(&levels[0], &motion, RobustKernel::labels(levels[0].model));
        let plane = comparison.plane(&levels[0].area());
        for (left, count) in [(0, 150), (0, 1), (3, 20), (9, 64), (40, 71), (141, 9)] {
            let mut part = vec![f32::NAN; count];
            comparison.row(7, left, &mut part);
            let near = part.iter().zip(&plane.row(7)[left..]).all(|(a, b)| a == b || (a - b).abs() < 1e-4);
            assert!(near, "{count} from {left} on");
        }
    }
}
