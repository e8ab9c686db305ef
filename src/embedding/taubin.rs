//! The multibody motion for noisy data: the polynomial with the smallest algebraic error per squared gradient.

use super::embedded::EmbeddedData;
use super::moments::gradient_gram;
use super::multibody::{MultibodyMotion, measurements_needed};
use crate::error::{Error, Result};
use crate::linear::Triangle;
use crate::linear::kernels::{dot, normalise, squared_sine};
use crate::measurements::Measurements;

/// Bound of the inverse iteration.
const MAX_STEPS: usize = 30;
/// The iteration ends when the unit vector moves by less than this: the eigenvector is a start, no result.
const TOLERANCE: f64 = 1e-7;
/// Weight of the identity beside the scaled gradient matrix, as in Taubin's own remedy for directions without gradient.
const REGULARISATION: f64 = 1e-12;
/// A pivot of the scaled triangle below this share of the largest is raised to it.
const SMALLEST_PIVOT: f64 = 1e-15;

/// The multibody motion ã that minimises Σ_j p(x_j, y_j)² / Σ_j |∂p/∂y (x_j, y_j)|² (Taubin, IEEE PAMI 13(11), 1991): the
/// smallest generalised eigenvector of (EᵀE, Σ_k D_kᵀD_k), E = P̃_n, D_k = ∂E/∂y_k.
///
/// Unlike the plain null vector it does not favour polynomials that are flat at the data: with noise its motions are nearer to
/// the truth, without noise both agree. Inverse iteration `ã ← (RᵀR)⁻¹ (Σ_k D_kᵀD_k) ã` on the triangle R of E, columns scaled
/// by the lengths of those of D: no Gram matrix of E is formed.
///
/// `measurements` should be normalised.
///
/// # Errors
/// [`Error::TooFewMeasurements`] where N < M_n² − Z_n − 1.
pub fn taubin_motion(measurements: &Measurements, degree: usize) -> Result<MultibodyMotion> {
    let needed = measurements_needed(degree);
    if measurements.len() < needed {
        return Err(Error::TooFewMeasurements { motions: degree, needed, found: measurements.len() });
    }
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

/// One step of the inverse iteration in scaled coordinates; `None` where the result is not finite.
fn step(triangle: &Triangle, gradients: &[f64], scale: &[f64], vector: &[f64]) -> Option<Vec<f64>> {
    let unscaled: Vec<f64> = vector.iter().zip(scale).map(|(v, s)| v * s).collect();
    let mut next: Vec<f64> = gradients.chunks_exact(scale.len()).map(|column| dot(column, &unscaled)).collect();
    for ((value, s), v) in next.iter_mut().zip(scale).zip(vector) {
        *value = *value * s + REGULARISATION * v;
    }
    triangle.solve_normal(&mut next, SMALLEST_PIVOT * triangle.largest_pivot());
    normalise(&mut next).then_some(next)
}
