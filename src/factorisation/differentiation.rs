//! The motions by differentiating the multibody polynomial p(x, y) = ν_n(y)ᵀ𝒜ν_n(x) at points: the paper's open problem solved.
//!
//! At a pixel x_0 and a direction (cos θ, sin θ) of the image gradient, p(x_0; cos θ, sin θ, t) is a polynomial in t with leading
//! coefficient 1, whose n roots are the I_t that the n motions predict. At a root of motion i all other factors are constants
//! to first order, so that (with u_i = A_i x_0)
//!
//! * ∂p/∂y is parallel to u_i: divided by its third entry it is the flow (u, v, 1);
//! * at y = (1, 0, −u), which is on motion i again, ∂p/∂x is parallel to A_iᵀy = first row − u·(0, 0, 1), and ∂p/∂I_t gives the
//!   factor, since the third entry of A_i x_0 is 1; likewise (0, 1, −v) for the second row.
//!
//! Both rows come from the same root and with their scales, so nothing has to be associated: equal entries, zero rows, pure
//! translations need no special care. All it takes is that the n flows differ at some x_0.
//!
//! With noise single points are poor (where two flows nearly meet, it divides by almost zero); many points and the choice
//! by residuals ([`choose`]) are what makes it good.

use super::greedy::choose;
use super::roots::roots;
use crate::embedding::monomials::exponents;
use crate::embedding::{MultibodyMotion, taubin_motion};
use crate::error::Result;
use crate::measurements::Measurements;
use crate::motion::AffineMotion;
use crate::random::Random;

/// Number of points for [`motions_from_points`] that we measured to be enough.
pub const POINTS: usize = 60;
/// Largest size of an entry of a hypothesis in normalised coordinates: beyond, a division by almost zero went wrong.
const LARGEST_ENTRY: f64 = 50.0;
/// Measurements on which hypotheses are compared.
const COMPARED: usize = 1500;

/// One hypothesis for each of the n motions, from the pixel `position` and the gradient direction `angle` (radians). Those
/// that are not finite are left out.
pub fn motions_at(multibody: &MultibodyMotion, position: [f64; 2], angle: f64) -> Vec<AffineMotion> {
    let x = [position[0], position[1], 1.0];
    let direction = [libm::cos(angle), libm::sin(angle)];
    let found = roots(&along_direction(multibody, x, direction));
    let motions = found.finite.iter().map(|root| motion_at_root(multibody, x, [direction[0], direction[1], root.re]));
    motions.filter(AffineMotion::is_finite).collect()
}

/// The coefficients of p(x; c, s, t) as a polynomial in t, ascending.
fn along_direction(multibody: &MultibodyMotion, x: [f64; 3], direction: [f64; 2]) -> Vec<f64> {
    let degree = multibody.degree();
    let mut coefficients = vec![0.0; degree + 1];
    let mut powers = vec![[1.0; 2]; degree + 1];
    for k in 1..=degree {
        powers[k] = [powers[k - 1][0] * direction[0], powers[k - 1][1] * direction[1]];
    }
    for ([a, b, c], value) in exponents(degree).into_iter().zip(multibody.multibody_flow(x).iter()) {
        coefficients[c] += value * powers[a][0] * powers[b][1];
    }
    coefficients
}

/// The motion to which the measurement (x, y) belongs.
fn motion_at_root(multibody: &MultibodyMotion, x: [f64; 3], y: [f64; 3]) -> AffineMotion {
    let flow = multibody.gradient_y(x, y);
    let (u, v) = (flow[0] / flow[2], flow[1] / flow[2]);
    let row = |y: [f64; 3], displacement: f64| {
        let factor = multibody.gradient_y(x, y)[2];
        let gradient = multibody.gradient_x(x, y);
        let (a, b) = (gradient[0] / factor, gradient[1] / factor);
        [a, b, displacement - a * x[0] - b * x[1]]
    };
    let first = row([1.0, 0.0, -u], u);
    let second = row([0.0, 1.0, -v], v);
    AffineMotion::new([first[0], first[1], first[2], second[0], second[1], second[2]])
}

/// Hypotheses from `points` random pixels of the measurements, each with a random direction: at most n for each. Those with
/// an entry beyond 50 (normalised coordinates) are left out.
pub fn hypotheses(
    multibody: &MultibodyMotion,
    measurements: &Measurements,
    points: usize,
    random: &mut Random,
) -> Vec<AffineMotion> {
    let mut pool = Vec::with_capacity(points * multibody.degree());
    if measurements.is_empty() {
        return pool;
    }
    for _ in 0..points {
        let position = measurements.positions()[random.below(measurements.len())];
        let angle = random.uniform(0.0, std::f64::consts::PI);
        pool.extend(motions_at(multibody, position, angle));
    }
    pool.retain(|a| a.matrix.iter().all(|entry| entry.abs() <= LARGEST_ENTRY));
    pool
}

/// The n motions of a multibody motion by differentiation at `points` random pixels and the choice of those hypotheses that
/// explain the (normalised) measurements best. Fewer than n where not even n hypotheses were finite.
pub fn motions_from_points(
    multibody: &MultibodyMotion,
    measurements: &Measurements,
    points: usize,
    random: &mut Random,
) -> Vec<AffineMotion> {
    let pool = hypotheses(multibody, measurements, points, random);
    let compared = if measurements.len() > COMPARED {
        measurements.subset(&random.choose(measurements.len(), COMPARED))
    } else {
        measurements.clone()
    };
    let choice = choose(&pool, &compared, multibody.degree(), f64::INFINITY);
    choice.indices.into_iter().map(|k| pool[k]).collect()
}

/// The algebraic start for noisy data: Taubin's multibody motion of degree `motions` and hypotheses from it at `points` pixels
/// ([`POINTS`] is a good number). `measurements` must be normalised; choose among the result with [`choose`].
///
/// # Errors
/// [`Error::TooFewMeasurements`](crate::Error::TooFewMeasurements) where N < M_n² − Z_n − 1.
pub fn algebraic_start(
    measurements: &Measurements,
    motions: usize,
    random: &mut Random,
    points: usize,
) -> Result<Vec<AffineMotion>> {
    let multibody = taubin_motion(measurements, motions)?;
    Ok(hypotheses(&multibody, measurements, points, random))
}
