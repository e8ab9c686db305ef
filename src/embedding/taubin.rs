//! The multibody motion for noisy data: the polynomial with the smallest algebraic error per squared gradient.

use super::embedded::{EmbeddedData, homogeneous, products};
use super::monomials::{kept_pairs, unknowns};
use super::multibody::{MultibodyMotion, measurements_needed};
use super::veronese::{derivative_columns, embed_columns};
use crate::error::{Error, Result};
use crate::linear::Triangle;
use crate::linear::kernels::{add_multiple, dot, normalise, squared_sine};
use crate::measurements::Measurements;

/// Bound of the inverse iteration.
const MAX_STEPS: usize = 30;
/// The iteration ends when the unit vector moves by less than this: the eigenvector is a start, no result.
const TOLERANCE: f64 = 1e-7;
/// Weight of the identity beside the scaled gradient matrix, as in Taubin's own remedy for directions without gradient.
const REGULARISATION: f64 = 1e-12;
/// Rows worked on together.
const BLOCK: usize = 128;
/// A pivot of the scaled triangle below this share of the largest is raised to it.
const SMALLEST_PIVOT: f64 = 1e-15;

/// The multibody motion ã that minimises Σ_j p(x_j, y_j)² / Σ_j |∂p/∂y (x_j, y_j)|² (Taubin, IEEE PAMI 13(11), 1991): the
/// smallest generalised eigenvector of (EᵀE, Σ_k D_kᵀD_k), E = P̃_n, D_k = ∂E/∂y_k.
///
/// Unlike the plain null vector it does not favour polynomials that are flat at the data: with noise its motions are nearer to
/// the truth, without noise both agree. Inverse iteration `ã ← (RᵀR)⁻¹ Σ_k D_kᵀ(D_k ã)` on the triangle R of E, columns scaled
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
    let gradients = Gradients::new(measurements, degree);
    let scale: Vec<f64> = gradients.squares().iter().map(|s| if *s > 0.0 { 1.0 / s.sqrt() } else { 1.0 }).collect();
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
fn step(triangle: &Triangle, gradients: &Gradients, scale: &[f64], vector: &[f64]) -> Option<Vec<f64>> {
    let unscaled: Vec<f64> = vector.iter().zip(scale).map(|(v, s)| v * s).collect();
    let mut next = gradients.apply(&unscaled);
    for ((value, s), v) in next.iter_mut().zip(scale).zip(vector) {
        *value = *value * s + REGULARISATION * v;
    }
    triangle.solve_normal(&mut next, SMALLEST_PIVOT * triangle.largest_pivot());
    normalise(&mut next).then_some(next)
}

/// The matrices D_k = ∂P̃_n/∂y_k, k = 1, 2, 3, in blocks of rows, column-major.
struct Gradients {
    columns: usize,
    blocks: Vec<(usize, Vec<f64>)>,
}

impl Gradients {
    fn new(measurements: &Measurements, degree: usize) -> Self {
        let pairs = kept_pairs(degree);
        let x = homogeneous(measurements.positions());
        let mut blocks = Vec::new();
        for (x, y) in x.chunks(BLOCK).zip(measurements.derivatives().chunks(BLOCK)) {
            let of_x = embed_columns(degree, x);
            for k in 0..3 {
                blocks.push((x.len(), products(&pairs, x.len(), &derivative_columns(degree, k, y), &of_x)));
            }
        }
        Gradients { columns: unknowns(degree), blocks }
    }

    /// The diagonal of Σ D_kᵀD_k.
    fn squares(&self) -> Vec<f64> {
        let mut squares = vec![0.0; self.columns];
        for (rows, block) in &self.blocks {
            for (sum, column) in squares.iter_mut().zip(block.chunks_exact(*rows)) {
                *sum += dot(column, column);
            }
        }
        squares
    }

    /// Σ D_kᵀ(D_k v).
    fn apply(&self, v: &[f64]) -> Vec<f64> {
        let mut result = vec![0.0; self.columns];
        for (rows, block) in &self.blocks {
            let mut image = vec![0.0; *rows];
            for (column, factor) in block.chunks_exact(*rows).zip(v) {
                add_multiple(&mut image, *factor, column);
            }
            for (sum, column) in result.iter_mut().zip(block.chunks_exact(*rows)) {
                *sum += dot(column, &image);
            }
        }
        result
    }
}
