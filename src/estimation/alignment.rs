//! Refinement of one motion on the intensities of its pixels: iteratively reweighted Gauss-Newton (the direct method).
//!
//! Each iteration linearises `r(A + dA) ≈ r + gᵀ dA x` with the mean of both frames' gradients along the motion (it makes
//! the step second-order accurate) and solves the weighted normal equations in coordinates centred on the support. The
//! sums are gathered per row as moments `Σ w, Σ w x, Σ w x²` of five products, since y is constant along a row.

use nalgebra::{SMatrix, SVector};

use crate::frame::Plane;
use crate::frame::filter::gaussian;
use crate::frame::warp::{CHUNK, Footprints};
use crate::lanes::{lane_sum, whole};
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::view::brightness::{GREY, GainBias};
use crate::view::level::PairLevel;

/// Which entries of the motion are free.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Freedom {
    Translation,
    Affine,
}

/// The entries that must converge before the iterations end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Convergence {
    /// The translation. The prior slows the linear terms down, so they may not have converged.
    Translation,
    /// Every entry, for which there are twice as many iterations.
    Every,
}

/// How to align.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Alignment {
    pub(crate) freedom: Freedom,
    pub(crate) iterations: usize,
    pub(crate) convergence: Convergence,
    /// Squared residual, in variances, at which a pixel's weight has fallen to a quarter.
    pub(crate) truncation: f32,
    /// Prior against linear terms, as a share of the translation's information.
    pub(crate) ridge: f64,
    /// Whether gain and bias are estimated with the motion.
    pub(crate) photometric: bool,
}

impl Alignment {
    /// A motion refined on the pixels of its region, with known brightness.
    pub(crate) fn of_region(iterations: usize, ridge: f64, model: &Model) -> Alignment {
        Alignment {
            freedom: Freedom::Affine,
            iterations,
            convergence: Convergence::Translation,
            truncation: model.truncation,
            ridge,
            photometric: false,
        }
    }

    /// The same alignment until the given entries have converged.
    pub(crate) fn until(self, convergence: Convergence) -> Alignment {
        Alignment { convergence, ..self }
    }
}

/// Ridge prior for the motion of a label's region; label 0 is the dominant motion.
pub(crate) fn ridge_of_label(label: usize, model: &Model) -> f64 {
    if label > 0 { model.ridge_object } else { model.ridge_background }
}

/// A region whose border is softened by half a pixel.
pub(crate) fn softened(region: &Plane) -> Plane {
    gaussian(region, 0.5)
}

/// Steps are measured at this distance from the centre, as a share of the width and height of the support together: halfway to its border.
const DISTANCE: f64 = 0.125;
/// Below this sum of support weights a motion is left as it is: two pixels for each of its six entries.
const SMALLEST_SUPPORT: f64 = 12.0;

/// Unknowns: the six entries of A (in centred coordinates), bias, gain.
const UNKNOWNS: usize = 8;
type Normal = SMatrix<f64, UNKNOWNS, UNKNOWNS>;
type Right = SVector<f64, UNKNOWNS>;

/// The pixels that a motion is fitted to, with their weights and extent.
pub(crate) struct Support<'a> {
    weights: Option<&'a Plane>,
    columns: std::ops::Range<usize>,
    rows: std::ops::Range<usize>,
    centre: [f64; 2],
    sum: f64,
}

impl<'a> Support<'a> {
    /// Every pixel of a level.
    pub(crate) fn everything(level: &PairLevel) -> Support<'static> {
        let (w, h) = (level.width(), level.height());
        Support {
            weights: None,
            columns: 0..w,
            rows: 0..h,
            centre: [0.5 * (w - 1) as f64, 0.5 * (h - 1) as f64],
            sum: (w * h) as f64,
        }
    }

    /// The pixels of positive weight.
    pub(crate) fn weighted(weights: &'a Plane, model: &Model) -> Support<'a> {
        let (mut left, mut right) = (usize::MAX, 0);
        let (mut top, mut bottom) = (usize::MAX, 0);
        let (mut sum, mut sx, mut sy) = (0.0, 0.0, 0.0);
        for y in 0..weights.height() {
            for (x, &w) in weights.row(y).iter().enumerate() {
                if w > model.smallest_weight {
                    (left, right) = (left.min(x), right.max(x + 1));
                    (top, bottom) = (top.min(y), y + 1);
                    let w = f64::from(w);
                    sum += w;
                    sx += w * x as f64;
                    sy += w * y as f64;
                }
            }
        }
        let n = sum.max(1e-9);
        let (columns, rows) = (left.min(right)..right, top.min(bottom)..bottom);
        Support { weights: Some(weights), columns, rows, centre: [sx / n, sy / n], sum }
    }
}

/// Aligns a motion (of the working frame) on a level. Returns it unchanged if its pixels do not determine it.
pub(crate) fn align(
    level: &PairLevel,
    motion: &AffineMotion,
    support: &Support<'_>,
    photometric: &mut GainBias,
    how: Alignment,
) -> AffineMotion {
    if support.sum < SMALLEST_SUPPORT {
        return *motion;
    }
    let scale = 0.5 * level.width().max(level.height()) as f64;
    let mut scaled = level.scaled(motion);
    let mut rows = RowBuffers::new(support.columns.len());
    let (iterations, distance) = match how.convergence {
        Convergence::Translation => (how.iterations, 0.0),
        // In the units of the linear terms.
        Convergence::Every => {
            (2 * how.iterations, DISTANCE * (support.columns.len() + support.rows.len()) as f64 / scale)
        }
    };
    for _ in 0..iterations {
        let (mut normal, right) = rows.normal_equations(level, &scaled, support, *photometric, how, scale);
        constrain(&mut normal, how);
        let Some(cholesky) = normal.cholesky() else { return *motion };
        let step = cholesky.solve(&-right);
        if !step.iter().all(|s| s.is_finite()) {
            return *motion;
        }
        photometric.bias -= step[6];
        photometric.gain -= step[7];
        apply(&mut scaled, &step, support.centre, scale);
        if [0, 1, 3, 4].into_iter().any(|k| scaled.matrix[k].abs() > level.model.largest_linear) {
            return *motion;
        }
        // A fiftieth of the position error of a correct motion.
        if length(&step, distance) < 0.02 * f64::from(level.model.position_sigma) {
            break;
        }
    }
    level.unscaled(&scaled)
}

/// Length of a step in centred coordinates, pixels: of the translation and, at this distance from the centre, of the linear terms.
fn length(step: &Right, distance: f64) -> f64 {
    let squares = |entries: [usize; 2]| entries.into_iter().map(|k| step[k] * step[k]).sum::<f64>();
    (squares([2, 5]) + distance * distance * (squares([0, 1]) + squares([3, 4]))).sqrt()
}

/// Adds the prior, and replaces the equations of unknowns that are not free by "the step is zero".
fn constrain(normal: &mut Normal, how: Alignment) {
    let linear = [0, 1, 3, 4];
    let ridge = how.ridge;
    for (i, of) in linear.into_iter().zip([2, 2, 5, 5]) {
        normal[(i, i)] += ridge * normal[(of, of)];
    }
    let floor = 1e-9 * normal.trace() + 1e-12;
    for i in 0..UNKNOWNS {
        normal[(i, i)] += floor;
    }
    let mut fix = |i: usize| {
        normal.row_mut(i).fill(0.0);
        normal.column_mut(i).fill(0.0);
        normal[(i, i)] = 1.0;
    };
    if how.freedom == Freedom::Translation {
        linear.into_iter().for_each(&mut fix);
    }
    if !how.photometric {
        fix(6);
        fix(7);
    }
}

/// Adds a step in centred coordinates to a motion.
fn apply(motion: &mut AffineMotion, step: &Right, centre: [f64; 2], scale: f64) {
    for row in 0..2 {
        let (a, b, c) = (step[3 * row] / scale, step[3 * row + 1] / scale, step[3 * row + 2]);
        motion.matrix[3 * row] += a;
        motion.matrix[3 * row + 1] += b;
        motion.matrix[3 * row + 2] += c - a * centre[0] - b * centre[1];
    }
}

/// A row's values in whole chunks. Values past the end of the row have no weight.
type Row = Vec<[f32; CHUNK]>;

/// Buffers for one row, reused for every row.
struct RowBuffers {
    x: Row,
    gx: Row,
    gy: Row,
    residual: Row,
    weight: Row,
}

impl RowBuffers {
    fn new(length: usize) -> RowBuffers {
        let row = || vec![[0.0; CHUNK]; length.div_ceil(CHUNK)];
        RowBuffers { x: row(), gx: row(), gy: row(), residual: row(), weight: row() }
    }

    fn normal_equations(
        &mut self,
        level: &PairLevel,
        motion: &AffineMotion,
        support: &Support<'_>,
        photometric: GainBias,
        how: Alignment,
        scale: f64,
    ) -> (Normal, Right) {
        let (mut normal, mut right) = (Normal::zeros(), Right::zeros());
        for (k, x) in support.columns.clone().enumerate() {
            self.x[k / CHUNK][k % CHUNK] = ((x as f64 - support.centre[0]) / scale) as f32;
        }
        for y in support.rows.clone() {
            self.measure(level, motion, support, photometric, how, y);
            let ny = (y as f64 - support.centre[1]) / scale;
            self.accumulate(&mut normal, &mut right, ny);
            if how.photometric {
                let first = &level.first.row(y)[support.columns.clone()];
                self.accumulate_photometric(&mut normal, &mut right, ny, first);
            }
        }
        normal.fill_upper_triangle_with_lower_triangle();
        (normal, right)
    }

    /// Residuals, gradients and robust weights of a row.
    fn measure(
        &mut self,
        level: &PairLevel,
        motion: &AffineMotion,
        support: &Support<'_>,
        photometric: GainBias,
        how: Alignment,
        y: usize,
    ) {
        let (width, height) = (level.second.width(), level.second.height());
        let noise = level.noise * level.noise;
        let (truncation, smallest) = (how.truncation, level.model.smallest_weight);
        let position = level.model.position_variance();
        let (bias, gain) = (photometric.bias as f32, (photometric.gain / GREY) as f32);
        // The mean of both gradients, per pixel of this level.
        let half = 0.5 * level.stride as f32;
        let columns = support.columns.clone();
        let path = level.path(motion, columns.start, y);
        let first = &level.first.row(y)[columns.clone()];
        let energy = &level.energy.row(y)[columns.clone()];
        let (dx, dy) = (&level.first_dx.row(y)[columns.clone()], &level.first_dy.row(y)[columns.clone()]);
        let weights = support.weights.map(|w| &w.row(y)[columns]);
        let (mut second, mut at) = ([0.0; CHUNK], Footprints::new());
        let (mut second_dx, mut second_dy) = ([0.0; CHUNK], [0.0; CHUNK]);
        let mut space = [[0.0; CHUNK]; 4];
        let [space_first, space_energy, space_dx, space_dy] = &mut space;
        let gradients = self.gx.iter_mut().zip(&mut self.gy);
        let buffers = self.weight.iter_mut().zip(&mut self.residual).zip(gradients);
        for (k, ((weight, residuals), (gx, gy))) in buffers.enumerate() {
            let chunk = k * CHUNK..((k + 1) * CHUNK).min(first.len());
            let n = chunk.len();
            let mut given = [0.0; CHUNK];
            match weights {
                Some(weights) => given[..n].copy_from_slice(&weights[chunk.clone()]),
                None => given[..n].fill(1.0),
            }
            if given.iter().all(|&weight| weight <= smallest) {
                // Nothing counts in this chunk, as in much of the box around a region.
                (*weight, *residuals, *gx, *gy) = ([0.0; CHUNK], [0.0; CHUNK], [0.0; CHUNK], [0.0; CHUNK]);
                continue;
            }
            at.follow(&path, chunk.start, n, width, height);
            at.sample(level.second.values(), &mut second);
            at.sample(level.second_dx.values(), &mut second_dx);
            at.sample(level.second_dy.values(), &mut second_dy);
            let (first, energy) =
                (whole(&first[chunk.clone()], space_first), whole(&energy[chunk.clone()], space_energy));
            let (dx, dy) = (whole(&dx[chunk.clone()], space_dx), whole(&dy[chunk], space_dy));
            // Local arrays: the compiler knows that they do not alias the inputs.
            let mut row = [[0.0; CHUNK]; 4];
            let [weights_of, residuals_of, gx_of, gy_of] = &mut row;
            for k in 0..CHUNK {
                let residual = second[k] - first[k] * (1.0 + gain) - bias;
                let information = 1.0 / (noise + position * energy[k]);
                let robust = truncation / (truncation + residual * residual * information);
                let counts = at.inside(k) & if given[k] > smallest { u32::MAX } else { 0 };
                let counted = |value: f32| f32::from_bits(value.to_bits() & counts);
                weights_of[k] = counted(given[k] * information * robust * robust);
                gx_of[k] = counted(half * (dx[k] + second_dx[k]));
                gy_of[k] = counted(half * (dy[k] + second_dy[k]));
                residuals_of[k] = counted(residual);
            }
            [*weight, *residuals, *gx, *gy] = row;
        }
    }

    /// The blocks `Σ w g gᵀ ⊗ (x, y, 1)(x, y, 1)ᵀ` and the right side of a row at height `y`.
    fn accumulate(&mut self, normal: &mut Normal, right: &mut Right, y: f64) {
        let RowBuffers { x, gx, gy, residual, weight } = self;
        for (row, column, a, b) in [(0, 0, &*gx, &*gx), (3, 0, gy, gx), (3, 3, gy, gy)] {
            let [s0, s1, s2] = moments(weight, a, b, x);
            let block = [[s2, s1 * y, s1], [s1 * y, s0 * y * y, s0 * y], [s1, s0 * y, s0]];
            for i in 0..3 {
                for j in 0..3 {
                    normal[(row + i, column + j)] += block[i][j];
                }
            }
        }
        for (row, g) in [(0, &*gx), (3, gy)] {
            let [s0, s1, _] = moments(weight, g, residual, x);
            right[row] += s1;
            right[row + 1] += s0 * y;
            right[row + 2] += s0;
        }
    }

    /// Rows of bias and gain: the derivative of the modelled residual with respect to them is (1, I1/128).
    fn accumulate_photometric(&mut self, normal: &mut Normal, right: &mut Right, y: f64, first: &[f32]) {
        let mut sums = [[0.0f64; 2]; 4];
        let (mut q, mut qi, mut qii, mut qr, mut qir) = (0.0f64, 0.0, 0.0, 0.0, 0.0);
        let RowBuffers { x, gx, gy, residual, weight } = self;
        let [x, gx, gy, residual, weight] = [x, gx, gy, residual, weight].map(|row| row.as_flattened());
        for k in 0..first.len() {
            let (w, i) = (f64::from(weight[k]), f64::from(first[k]) / GREY);
            let (gx, gy, r, x) = (f64::from(gx[k]), f64::from(gy[k]), f64::from(residual[k]), f64::from(x[k]));
            for (sum, p) in sums.iter_mut().zip([w * gx, w * gx * i, w * gy, w * gy * i]) {
                sum[0] += p;
                sum[1] += p * x;
            }
            q += w;
            qi += w * i;
            qii += w * i * i;
            qr += w * r;
            qir += w * i * r;
        }
        for (k, [s0, s1]) in sums.into_iter().enumerate() {
            let (row, column) = (6 + k % 2, 3 * (k / 2));
            normal[(row, column)] += s1;
            normal[(row, column + 1)] += s0 * y;
            normal[(row, column + 2)] += s0;
        }
        normal[(6, 6)] += q;
        normal[(7, 6)] += qi;
        normal[(7, 7)] += qii;
        right[6] += qr;
        right[7] += qir;
    }
}

/// Moments `Σ p, Σ p x, Σ p x²` of the products `p = weight · a · b`, with one accumulator per lane of a chunk.
fn moments(weight: &Row, a: &Row, b: &Row, x: &Row) -> [f64; 3] {
    let (mut s0, mut s1, mut s2) = ([0.0f32; CHUNK], [0.0f32; CHUNK], [0.0f32; CHUNK]);
    for ((weight, x), (a, b)) in weight.iter().zip(x).zip(a.iter().zip(b)) {
        for k in 0..CHUNK {
            let p = weight[k] * a[k] * b[k];
            s0[k] += p;
            s1[k] += p * x[k];
            s2[k] += p * x[k] * x[k];
        }
    }
    [s0, s1, s2].map(|sums| f64::from(lane_sum(&sums)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::level::build;

    /// Slow enough that bilinear samples lose no contrast, which would pass for a gain.
    fn texture(x: f64, y: f64) -> f32 {
        let waves =
            50.0 * libm::sin(0.15 * x + 0.06 * y) + 40.0 * libm::sin(0.08 * x - 0.14 * y) + 20.0 * libm::cos(0.2 * y);
        (128.0 + waves) as f32
    }

    #[test]
    fn an_affine_motion_with_a_change_of_brightness_is_recovered() {
        let truth = AffineMotion::new([0.01, -0.004, 1.3, 0.006, -0.008, -0.9]);
        let back = truth.inverse().unwrap();
        let first = Plane::from_fn(96, 80, |x, y| texture(x as f64, y as f64));
        let second = Plane::from_fn(96, 80, |x, y| {
            let [u, v] = back.flow(x as f64, y as f64);
            1.03 * texture(x as f64 + u, y as f64 + v) - 2.0
        });
        let levels = build(first, second, 64);
        let level = &levels[0];
        let mut photometric = GainBias::default();
        let how = Alignment { truncation: 9.0, photometric: true, ..Alignment::of_region(30, 0.0, &Model::DEFAULT) };
        let found = align(level, &AffineMotion::STATIC, &Support::everything(level), &mut photometric, how);
        for (x, y) in [(5.0, 5.0), (90.0, 10.0), (40.0, 75.0)] {
            let ([u, v], [p, q]) = (truth.flow(x, y), found.flow(x, y));
            assert!((u - p).abs() < 0.03 && (v - q).abs() < 0.03, "({u}, {v}) against ({p}, {q})");
        }
        assert!((photometric.gain / 128.0 - 0.03).abs() < 0.005 && (photometric.bias + 2.0).abs() < 0.6);
    }

    #[test]
    fn linear_terms_that_the_prior_slows_down_converge_too() {
        // A zoom about the centre: there is no translation to wait for.
        let truth = AffineMotion::new([0.02, 0.0, -0.95, 0.0, 0.02, -0.79]);
        let back = truth.inverse().unwrap();
        let first = Plane::from_fn(96, 80, |x, y| texture(x as f64, y as f64));
        let second = Plane::from_fn(96, 80, |x, y| {
            let [u, v] = back.flow(x as f64, y as f64);
            texture(x as f64 + u, y as f64 + v)
        });
        let level = &build(first, second, 64)[0];
        let error = |convergence| {
            let how = Alignment { convergence, ..Alignment::of_region(30, 1.0, &Model::DEFAULT) };
            let found = align(level, &AffineMotion::STATIC, &Support::everything(level), &mut GainBias::default(), how);
            (found.matrix[0] - truth.matrix[0]).abs() + (found.matrix[4] - truth.matrix[4]).abs()
        };
        assert!(error(Convergence::Every) < 0.2 * error(Convergence::Translation));
    }

    #[test]
    fn flat_frames_leave_the_motion_as_it_was() {
        let level = &build(Plane::filled(40, 40, 9.0), Plane::filled(40, 40, 9.0), 32)[0];
        let start = AffineMotion::translation(0.5, 0.0);
        let found = align(
            level,
            &start,
            &Support::everything(level),
            &mut GainBias::default(),
            Alignment::of_region(5, 1e-3, &Model::DEFAULT),
        );
        assert!(found.is_finite());
        assert!(start.relative_error(&found) < 1e-9);
    }
}
