//! Rough optical flow relative to the dominant motion: the paper's constraint with n = 1 in small windows, coarse to fine.
//!
//! It serves two purposes: derivatives are taken near where each pixel lands (without this, motions of more than a pixel have no
//! usable derivatives), and windows yield proposals.

use crate::frame::Plane;
use crate::frame::filter::{double, gaussian, median5};
use crate::frame::warp::{CHUNK, Footprints};
use crate::lanes::{each_with, whole};
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::view::level::PairLevel;

/// Flow relative to the dominant motion, pixels of the base level, with its certainty.
pub(crate) struct LocalFlow {
    pub(crate) u: Plane,
    pub(crate) v: Plane,
    /// Smaller eigenvalue of the window's weighted structure tensor.
    pub(crate) certainty: Plane,
}

/// Gradients and intensity difference of every pixel along the dominant motion plus the local flow.
pub(crate) struct Samples {
    pub(crate) gx: Plane,
    pub(crate) gy: Plane,
    /// Intensity difference.
    pub(crate) residual: Plane,
}

/// Mean gradients and intensity difference along the dominant motion plus a flow.
pub(crate) fn samples(level: &PairLevel, dominant: &AffineMotion, u: &Plane, v: &Plane) -> Samples {
    let (width, height) = (level.width(), level.height());
    let scaled = level.scaled(dominant);
    let plane = || Plane::filled(width, height, 0.0);
    let mut out = Samples { gx: plane(), gy: plane(), residual: plane() };
    let (mut px, mut py) = ([0.0; CHUNK], [0.0; CHUNK]);
    let (mut flow_u, mut flow_v) = ([0.0; CHUNK], [0.0; CHUNK]);
    let mut seen = [[0.0; CHUNK]; 3];
    let mut at = Footprints::new();
    for y in 0..height {
        for start in (0..width).step_by(CHUNK) {
            let chunk = start..(start + CHUNK).min(width);
            let n = chunk.len();
            let (u, v) = (&u.row(y)[chunk.clone()], &v.row(y)[chunk.clone()]);
            let (u, v) = (whole(u, &mut flow_u), whole(v, &mut flow_v));
            for k in 0..CHUNK {
                let x = (start + k) as u32 as i32;
                let [du, dv] = scaled.flow(f64::from(x), y as f64);
                px[k] = x as f32 + du as f32 + u[k];
                py[k] = y as f32 + dv as f32 + v[k];
            }
            at.place(&px, &py, n, width, height);
            for (seen, plane) in seen.iter_mut().zip([&level.second_dx, &level.second_dy, &level.second]) {
                at.sample(plane.values(), seen);
            }
            let mean = |out: &mut Plane, first: &Plane, second: &[f32; CHUNK]| {
                let out = &mut out.row_mut(y)[chunk.clone()];
                each_with(out, [&first.row(y)[chunk.clone()], second], |_, [a, b]| 0.5 * (a + b));
            };
            mean(&mut out.gx, &level.first_dx, &seen[0]);
            mean(&mut out.gy, &level.first_dy, &seen[1]);
            let residual = &mut out.residual.row_mut(y)[chunk.clone()];
            each_with(residual, [&seen[2], &level.first.row(y)[chunk]], |_, [a, b]| a - b);
        }
    }
    out
}

/// Weighted products of gradients and residual, summed over Gaussian windows.
struct Windows {
    xx: Plane,
    xy: Plane,
    yy: Plane,
    xr: Plane,
    yr: Plane,
}

fn windows(level: &PairLevel, s: &Samples, sigma: f32) -> Windows {
    let noise = level.noise * level.noise;
    let (per_truncation, position) = (1.0 / level.model.truncation_loose, level.model.position_variance());
    let mut weight = s.residual.clone();
    each_with(weight.values_mut(), [level.energy.values()], |r, [energy]| {
        1.0 / (noise + r * r * per_truncation + position * energy)
    });
    let summed = |a: &Plane, b: &Plane| {
        let mut product = weight.clone();
        each_with(product.values_mut(), [a.values(), b.values()], |p, [a, b]| p * (a * b));
        gaussian(&product, sigma)
    };
    Windows {
        xx: summed(&s.gx, &s.gx),
        xy: summed(&s.gx, &s.gy),
        yy: summed(&s.gy, &s.gy),
        xr: summed(&s.gx, &s.residual),
        yr: summed(&s.gy, &s.residual),
    }
}

/// Local flow at level `base`, estimated from the coarsest level down.
pub(crate) fn local_flow(levels: &[PairLevel], dominant: &AffineMotion, base: usize) -> LocalFlow {
    let coarsest = &levels[levels.len() - 1];
    let mut u = Plane::filled(coarsest.width(), coarsest.height(), 0.0);
    let mut v = u.clone();
    let mut certainty = u.clone();
    for (index, level) in levels.iter().enumerate().skip(base).rev() {
        if u.width() != level.width() || u.height() != level.height() {
            for plane in [&mut u, &mut v] {
                *plane = double(plane, level.width(), level.height());
                plane.values_mut().iter_mut().for_each(|f| *f *= 2.0);
            }
        }
        for iteration in 0..level.model.flow_iterations {
            let sigma = if index == base { level.model.flow_window_base() } else { level.model.flow_window };
            let sums = windows(level, &samples(level, dominant, &u, &v), sigma);
            step(&mut u, &mut v, &sums, level.model);
            u = median5(&u);
            v = median5(&v);
            if index == base && iteration + 1 == level.model.flow_iterations {
                certainty = smaller_eigenvalue(&sums);
            }
        }
    }
    LocalFlow { u, v, certainty }
}

fn step(u: &mut Plane, v: &mut Plane, s: &Windows, model: &Model) {
    let flat = model.flow_flat;
    let sums = [&s.xx, &s.xy, &s.yy, &s.xr, &s.yr].map(Plane::values);
    let flows = u.values_mut().chunks_mut(CHUNK).zip(v.values_mut().chunks_mut(CHUNK));
    for (k, (u, v)) in flows.enumerate() {
        let mut space = [[0.0; CHUNK]; 5];
        let [s0, s1, s2, s3, s4] = &mut space;
        let [xx, xy, yy, xr, yr] = sums.map(|sum| &sum[k * CHUNK..]);
        let (xx, xy, yy) = (whole(xx, s0), whole(xy, s1), whole(yy, s2));
        let (xr, yr) = (whole(xr, s3), whole(yr, s4));
        let (mut by_u, mut by_v) = ([0.0; CHUNK], [0.0; CHUNK]);
        for k in 0..CHUNK {
            let (a, c, d) = (xx[k] + flat, xy[k], yy[k] + flat);
            let (p, q) = (xr[k], yr[k]);
            let per_determinant = 1.0 / (a * d - c * c);
            (by_u[k], by_v[k]) = ((c * q - d * p) * per_determinant, (c * p - a * q) * per_determinant);
        }
        each_with(u, [&by_u], |u, [by]| u + by);
        each_with(v, [&by_v], |v, [by]| v + by);
    }
}

fn smaller_eigenvalue(s: &Windows) -> Plane {
    Plane::from_fn(s.xx.width(), s.xx.height(), |x, y| {
        let (a, c, d) = (s.xx.at(x, y), s.xy.at(x, y), s.yy.at(x, y));
        // The smaller root of λ² − (a + d) λ + a d − c² = 0.
        0.5 * (a + d - ((a - d) * (a - d) + 4.0 * c * c).sqrt())
    })
}
