//! Proposals from the multibody affine constraint (eq. 6-9) on the pixels that the dominant motion does not explain.
//!
//! The dominant motion is a known factor of the polynomial, so it is divided out by weights: a pixel counts by how badly the
//! dominant motion explains it (the paper leaves out pixels with a small |I_t| to the same end). The measurements are
//! recentred: derivatives are taken where the local flow d lands, `y = (g, r − gᵀd)`, so that they stay linear for motions of
//! many pixels. For every degree the flow of each pixel is read off the polynomial by differentiation, `u = ∂p/∂I_x / ∂p/∂I_t`,
//! which needs no factorisation, and the flows are gathered into translations relative to the dominant motion.

use super::clustering::{Point, k_means};
use super::local_flow::{LocalFlow, samples};
use super::translated;
use crate::embedding::{MultibodyMotion, Refitting, monomials};
use crate::frame::Plane;
use crate::frame::warp::{CHUNK, Footprints, RowPath};
use crate::measurements::Measurements;
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::order::median_f64;
use crate::view::level::PairLevel;

/// Entries of a motion; groups of fewer pixels propose none.
const ENTRIES: usize = 6;

/// The measurements that the dominant motion does not explain. Positions are in units of half the width, from the middle of the level.
pub(crate) struct Unexplained {
    pub(crate) measurements: Measurements,
    /// How badly the dominant motion explains each, 0…1.
    pub(crate) weights: Vec<f64>,
}

/// Motions found by polynomials of degree 1 to `degrees` on at most `most` unexplained pixels.
pub(crate) fn from_algebra(
    level: &PairLevel,
    dominant: &AffineMotion,
    flow: &LocalFlow,
    degrees: usize,
    most: usize,
) -> Vec<AffineMotion> {
    let Some(data) = unexplained(level, dominant, flow, most) else { return Vec::new() };
    let mut motions = Vec::new();
    for degree in 1..=degrees {
        if data.measurements.len() < 2 * monomials::unknowns(degree) {
            break;
        }
        for [u, v] in flows_of_degree(&data, degree, level.model) {
            motions.push(translated(dominant, u * level.pixel(), v * level.pixel()));
        }
    }
    motions
}

/// At most `most` pixels to which [`from_algebra`] fits polynomials; none where they are too few.
pub(crate) fn unexplained(
    level: &PairLevel,
    dominant: &AffineMotion,
    flow: &LocalFlow,
    most: usize,
) -> Option<Unexplained> {
    let (width, height) = (level.width(), level.height());
    let model = level.model;
    let position_variance = model.position_variance();
    let local = samples(level, dominant, &flow.u, &flow.v);
    let scaled = level.scaled(dominant);
    let mut places = Vec::with_capacity(width * height);
    let mut weights = Vec::with_capacity(width * height);
    let (mut seen, mut at) = ([0.0; CHUNK], Footprints::new());
    for y in 0..height {
        let path = RowPath::new(&scaled, 0, y);
        for start in (0..width).step_by(CHUNK) {
            let chunk = start..(start + CHUNK).min(width);
            at.follow(&path, start, chunk.len(), width, height);
            at.sample(level.second.values(), &mut seen);
            for (k, (x, seen)) in chunk.zip(&seen).enumerate() {
                let (gx, gy) = (local.gx.at(x, y), local.gy.at(x, y));
                if !at.is_inside(k) || gx * gx + gy * gy <= model.algebra_gradient * model.algebra_gradient {
                    continue;
                }
                let r = seen - level.first.at(x, y);
                let e = r * r / (level.noise * level.noise + position_variance * level.energy.at(x, y));
                if e > model.truncation {
                    let weight = e / (e + model.truncation);
                    places.push(y * width + x);
                    weights.push(weight);
                }
            }
        }
    }
    if places.len() < 2 * monomials::unknowns(1) {
        return None;
    }
    let count = most.min(places.len());
    let chosen = (0..count).map(|k| k * places.len() / count);
    let half = 0.5 * width as f64;
    let position = |x: usize, y: usize| [x as f64 / half - 1.0, (y as f64 - 0.5 * height as f64) / half];
    // From twice the shortest gradient on, measurements have about the same length.
    let flat = f64::from(model.algebra_gradient);
    let derivatives = |x: usize, y: usize| {
        let at = |plane: &Plane| f64::from(plane.at(x, y));
        let (gx, gy) = (at(&local.gx), at(&local.gy));
        let temporal = at(&local.residual) - gx * at(&flow.u) - gy * at(&flow.v);
        // (2 g)² under the root.
        let length = (gx * gx + gy * gy + 4.0 * flat * flat).sqrt();
        [gx / length, gy / length, temporal / (length * model.algebra_unit)]
    };
    let points = || chosen.clone().map(|k| (places[k] % width, places[k] / width));
    let measurements = Measurements::new(
        points().map(|(x, y)| position(x, y)).collect(),
        points().map(|(x, y)| derivatives(x, y)).collect(),
    );
    Some(Unexplained {
        measurements: measurements.ok()?,
        weights: chosen.clone().map(|k| f64::from(weights[k])).collect(),
    })
}

/// The flows (pixels of the level) that a polynomial of one degree gives, one per group of pixels.
fn flows_of_degree(data: &Unexplained, degree: usize, model: &Model) -> Vec<[f64; 2]> {
    let refitting = Refitting::new(&data.measurements, degree);
    let mut weights = data.weights.clone();
    let mut readings = Vec::new();
    let mut close = 0.0;
    for _ in 0..model.algebra_iterations {
        // A weight belongs to a row; only their ratios count.
        let largest = weights.iter().fold(0.0, |m: f64, w| m.max(*w));
        weights.iter_mut().for_each(|w| *w = (*w / largest) * (*w / largest));
        readings = read_off(&refitting, &refitting.fit(&weights));
        let distances: Vec<f64> = readings.iter().map(|r| r.distance).collect();
        // The deviation of a normal variable whose median distance this is.
        close = 1.4826 * median_f64(&distances).unwrap_or(0.0) + 1e-9;
        let mean = readings.iter().map(|r| r.slope).sum::<f64>() / readings.len() as f64;
        for ((w, r), given) in weights.iter_mut().zip(&readings).zip(&data.weights) {
            let relative = r.distance / close;
            *w = given / ((r.slope + f64::from(model.least_slope) * mean).max(1e-300) * (1.0 + relative * relative));
        }
    }
    group(&readings, data.measurements.positions(), close, 2 * degree + 1, model)
}

/// The flow at a measurement, read off the polynomial by differentiation.
#[derive(Clone, Copy, Default)]
struct Reading {
    /// The flow of the factor that vanishes there, in units of `algebra_unit` pixels.
    flow: [f64; 2],
    /// |∂p/∂y|.
    slope: f64,
    /// |p| / |∂p/∂y|: to first order the distance to the nearest factor.
    distance: f64,
}

fn read_off(refitting: &Refitting, polynomial: &MultibodyMotion) -> Vec<Reading> {
    let all = refitting.read(polynomial);
    all.iter()
        .map(|[value, g @ ..]| {
            let slope = (g[0] * g[0] + g[1] * g[1] + g[2] * g[2]).sqrt();
            Reading { flow: [g[0] / g[2], g[1] / g[2]], slope, distance: value.abs() / (slope + 1e-9) }
        })
        .collect()
}

/// Median flows of clusters of pixels that are similar in flow and position.
fn group(readings: &[Reading], positions: &[[f64; 2]], close: f64, groups: usize, model: &Model) -> Vec<[f64; 2]> {
    // Four units.
    let largest = 4.0 * model.algebra_unit;
    let sensible = |(r, p): (&Reading, &[f64; 2])| {
        let [u, v] = r.flow.map(|f| f * model.algebra_unit);
        let sensible = u * u + v * v < largest * largest && r.distance < close;
        sensible.then_some([u, v, p[0], p[1]])
    };
    let points: Vec<Point> = readings.iter().zip(positions).filter_map(sensible).collect();
    let assignment = k_means(&points, groups);
    (0..groups)
        .filter_map(|g| {
            let member = || points.iter().zip(&assignment).filter(move |&(_, &a)| a == g).map(|(p, _)| p);
            let median = |k: usize| {
                let values: Vec<f64> = member().map(|p| p[k]).collect();
                median_f64(&values).unwrap_or(0.0)
            };
            (member().count() >= ENTRIES).then(|| [median(0), median(1)])
        })
        .collect()
}
