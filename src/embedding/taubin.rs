//! The multibody motion for noisy data: Taubin's fit, which minimises the algebraic error relative to the squared gradient.

use super::embedded::EmbeddedData;
use super::moments::gradient_gram;
use super::multibody::{MultibodyMotion, measurements_needed};
use crate::error::Result;
use crate::linear::Triangle;
use crate::linear::kernels::{dot, normalise, squared_sine};
use crate::measurements::Measurements;

/// Maximum number of inverse iterations.
const MAX_STEPS: usize = 30;
/// The iteration ends when the unit vector changes by less than this. A starting point needs no more.
const TOLERANCE: f64 = 1e-7;
/// Multiple of the identity added to the scaled gradient matrix, Taubin's own remedy for directions without gradient.
const REGULARISATION: f64 = 1e-12;
/// Pivots of the scaled triangle are raised to this share of the largest.
const SMALLEST_PIVOT: f64 = 1e-15;

/// The multibody motion ã that minimises Σ_j p(x_j, y_j)² / Σ_j |∂p/∂y (x_j, y_j)|² (Taubin, IEEE PAMI 13(11), 1991): the eigenvector of
/// the smallest generalised eigenvalue of (EᵀE, Σ_k D_kᵀD_k), E = P̃_n, D_k = ∂E/∂y_k.
///
/// Unlike the null vector of [`MultibodyMotion::estimate`], it does not favour polynomials that are flat at the data, and its motions are
/// more accurate on noisy data. Without noise both agree. It is computed by inverse iteration `ã ← (RᵀR)⁻¹ (Σ_k D_kᵀD_k) ã` on the
/// triangle R of E, with columns scaled by the lengths of those of D; the Gram matrix of E is never formed.
///
/// `measurements` should be normalised.
///
/// ```
/// use veronese::embedding::{MultibodyMotion, taubin_motion};
/// # use veronese::{Measurements, Random};
/// use veronese::AffineMotion;
///
/// # fn main() -> veronese::Result<()> {
/// let truth = [AffineMotion::STATIC, AffineMotion::new([0.1, -0.2, 0.5, 0.2, 0.1, -0.3])];
/// # let mut random = Random::from_seed(1);
/// # let positions: Vec<_> = (0..300).map(|_| [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)]).collect();
/// # let derivative = |(j, &[x, y]): (usize, &[f64; 2])| {
/// #     let ([u, v], [ix, iy]) = (truth[j % 2].flow(x, y), [random.normal(), random.normal()]);
/// #     [ix, iy, -ix * u - iy * v + 0.02 * random.normal()]
/// # };
/// # let derivatives = positions.iter().enumerate().map(derivative).collect();
/// # let data = Measurements::new(positions, derivatives)?;
/// // `data` are 300 noisy measurements of the two motions.
/// let objective = |fit: &MultibodyMotion| {
///     let (mut error, mut gradient) = (0.0, 0.0);
///     for ([x, y], derivatives) in data.iter() {
///         error += fit.evaluate([x, y, 1.0], derivatives).powi(2);
///         gradient += fit.gradient_y([x, y, 1.0], derivatives).iter().map(|g| g * g).sum::<f64>();
///     }
///     error / gradient
/// };
/// let taubin = taubin_motion(&data, 2)?;
/// assert!(objective(&taubin) < objective(&MultibodyMotion::estimate(&data, 2)?));
/// assert!((taubin.matrix() - MultibodyMotion::from_motions(&truth).matrix()).amax() < 0.05);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`Error::TooFewMeasurements`](crate::Error::TooFewMeasurements) if N < M_n² − Z_n − 1.
pub fn taubin_motion(measurements: &Measurements, degree: usize) -> Result<MultibodyMotion> {
    measurements.check_number(degree, measurements_needed(degree))?;
    let data = EmbeddedData::new(measurements, degree);
    let start = MultibodyMotion::from_embedded(&data).coefficients();
    let gradients = gradient_gram(measurements, degree);
    let squares = gradients.iter().step_by(start.len() + 1);
    let scale: Vec<f64> = squares.map(|s| if *s > 0.0 { 1.0 / s.sqrt() } else { 1.0 }).collect();
    let triangle = data.triangle().with_columns_times(&scale);
    let mut vector: Vec<f64> = start.iter().zip(&scale).map(|(c, s)| c / s).collect();
    normalise(&mut vector);
    for _ in 0..MAX_STEPS {
        let Some(next) = step(&triangle, &gradients, &scale, &vector) else { break };
        let moved = squared_sine(&next, &vector);
        vector = next;
        if moved < TOLERANCE * TOLERANCE {
            break;
        }
    }
    for (value, s) in vector.iter_mut().zip(&scale) {
        *value *= s;
    }
    Ok(MultibodyMotion::from_coefficients(degree, &vector))
}

/// One step of the inverse iteration in scaled coordinates; `None` if the result is not finite.
fn step(triangle: &Triangle, gradients: &[f64], scale: &[f64], vector: &[f64]) -> Option<Vec<f64>> {
    let unscaled: Vec<f64> = vector.iter().zip(scale).map(|(v, s)| v * s).collect();
    let mut next: Vec<f64> = gradients.chunks_exact(scale.len()).map(|column| dot(column, &unscaled)).collect();
    for ((value, s), v) in next.iter_mut().zip(scale).zip(vector) {
        *value = *value * s + REGULARISATION * v;
    }
    triangle.solve_normal(&mut next, SMALLEST_PIVOT * triangle.largest_pivot());
    normalise(&mut next).then_some(next)
}
