//! The motions by differentiating the multibody polynomial p(x, y) = ν_n(y)ᵀ𝒜ν_n(x) at points. This solves the problem that the paper
//! leaves open: motions with equal entries in the third column.
//!
//! At a pixel x_0 and a direction (cos θ, sin θ) of the image gradient, p(x_0; cos θ, sin θ, t) is a polynomial in t with leading
//! coefficient 1. Its n roots are the temporal derivatives I_t that the n motions predict. At a root of motion i, only the factor of
//! motion i vanishes, so with u_i = A_i x_0:
//!
//! * ∂p/∂y is parallel to u_i. Divided by its third entry it is the flow (u, v, 1).
//! * y = (1, 0, −u) satisfies the constraint of motion i too. There, ∂p/∂x is parallel to A_iᵀy = first row − u·(0, 0, 1). The factor is
//!   ∂p/∂I_t, because the third entry of A_i x_0 is 1. Likewise, y = (0, 1, −v) gives the second row.
//!
//! Both rows come from the same root and have their scales, so there is nothing to associate. Equal entries, zero rows and pure
//! translations are no special cases, as long as the n flows differ in both components at some x_0.
//!
//! **Limit.** If two motions have the same first row (the same u everywhere), both satisfy the constraint at y = (1, 0, −u); the gradients
//! vanish there, and the row is a quotient of rounding errors, wrong by about 1 % even without noise. The same holds for the second row.
//! Two horizontal translations are an example. [`fit_motions`](crate::fit_motions) refines such hypotheses and is not affected.
//!
//! **Pitfall.** On noisy data, single points are unreliable: where two flows nearly agree, the method divides by almost zero. Use many
//! points, and [`choose`] the motions with the smallest residuals.
//!
//! ```
//! use veronese::embedding::MultibodyMotion;
//! use veronese::factorisation::differentiation::{POINTS, motions_from_points};
//! # use veronese::Measurements;
//! use veronese::{AffineMotion, Random};
//!
//! # fn main() -> veronese::Result<()> {
//! let truth = [AffineMotion::translation(0.3, 0.5), AffineMotion::new([0.1, -0.2, 0.3, 0.2, 0.1, -0.5])]; // equal (1,3) entries
//! let mut random = Random::from_seed(1);
//! # let positions: Vec<_> = (0..300).map(|_| [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)]).collect();
//! # let derivative = |(j, &[x, y]): (usize, &[f64; 2])| {
//! #     let ([u, v], [ix, iy]) = (truth[j % 2].flow(x, y), [random.normal(), random.normal()]);
//! #     [ix, iy, -ix * u - iy * v]
//! # };
//! # let derivatives = positions.iter().enumerate().map(derivative).collect();
//! # let data = Measurements::new(positions, derivatives)?;
//! // `data` are 300 measurements of the two motions, without noise.
//! let multibody = MultibodyMotion::estimate(&data, 2)?;
//! let found = motions_from_points(&multibody, &data, POINTS, &mut random);
//! for motion in &truth {
//!     assert!(found.iter().any(|a| motion.relative_error(a) < 1e-9));
//! }
//! # Ok(())
//! # }
//! ```

use super::greedy::choose;
use super::roots::roots;
use crate::embedding::monomials::exponents;
use crate::embedding::{MultibodyMotion, taubin_motion};
use crate::error::Result;
use crate::measurements::Measurements;
use crate::motion::AffineMotion;
use crate::random::Random;

/// Recommended number of points for [`motions_from_points`]. More do not improve the measured accuracy.
pub const POINTS: usize = 60;
/// Largest absolute entry of a hypothesis in normalised coordinates. Larger entries come from divisions by almost zero.
const LARGEST_ENTRY: f64 = 50.0;
/// Largest number of measurements on which hypotheses are compared.
const COMPARED: usize = 1500;

/// A hypothesis for each of the n motions, from the pixel `position` and the gradient direction `angle` (radians). Hypotheses that are
/// not finite are left out.
///
/// ```
/// use veronese::AffineMotion;
/// use veronese::embedding::MultibodyMotion;
/// use veronese::factorisation::motions_at;
///
/// let truth = [AffineMotion::STATIC, AffineMotion::new([0.1, -0.2, 0.5, 0.2, 0.1, -0.3])];
/// let found = motions_at(&MultibodyMotion::from_motions(&truth), [0.3, -0.4], 0.7);
/// assert_eq!(found.len(), 2);
/// assert!(truth.iter().all(|motion| found.iter().any(|a| motion.relative_error(a) < 1e-12)));
/// ```
pub fn motions_at(multibody: &MultibodyMotion, position: [f64; 2], angle: f64) -> Vec<AffineMotion> {
    let x = [position[0], position[1], 1.0];
    let direction = [libm::cos(angle), libm::sin(angle)];
    let found = roots(&along_direction(multibody, x, direction));
    let motions = found.finite.iter().map(|root| motion_at_root(multibody, x, [direction[0], direction[1], root.re]));
    motions.filter(AffineMotion::is_finite).collect()
}

/// The coefficients of p(x; c, s, t) as a polynomial in t, lowest power first.
#[doc(hidden)]
pub fn along_direction(multibody: &MultibodyMotion, x: [f64; 3], direction: [f64; 2]) -> Vec<f64> {
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

/// Hypotheses from [`motions_at`] for `points` random positions among the measurements, each with a random direction: at most n per
/// position. Those with an entry of absolute value above 50 are left out; `measurements` should be normalised.
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

/// The n motions of a multibody motion: [`hypotheses`] at `points` random positions ([`POINTS`] is recommended), of which [`choose`]
/// selects those that explain the measurements best. `measurements` should be normalised. Empty if no hypothesis is usable.
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

/// Hypotheses for n = `motions` motions from noisy data: [`hypotheses`] at `points` random positions ([`POINTS`] is recommended) from
/// the multibody motion of [`taubin_motion`]. `measurements` should be normalised. Select from the result with [`choose`].
///
/// # Errors
/// [`Error::TooFewMeasurements`](crate::Error::TooFewMeasurements) if N < M_n² − Z_n − 1.
pub fn algebraic_start(
    measurements: &Measurements,
    motions: usize,
    random: &mut Random,
    points: usize,
) -> Result<Vec<AffineMotion>> {
    let multibody = taubin_motion(measurements, motions)?;
    Ok(hypotheses(&multibody, measurements, points, random))
}
