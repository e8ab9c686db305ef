//! The multibody affine motion 𝒜 (Lemma 1): all motions in one matrix, linear in the embedded data.

use nalgebra::{DMatrix, DVector};

use super::embedded::EmbeddedData;
use super::monomials::{Exponents, count, exponents, index, kept_pairs, structural_zeros};
use super::veronese::{embed, jacobian};
use crate::error::{Error, Result};
use crate::linear::{NullVector, Triangle};
use crate::measurements::Measurements;
use crate::motion::AffineMotion;

/// Where the last entry of the null vector is below this share of its length, it cannot be scaled to 1: the data do not
/// contain I_t in any way that motions explain.
const SMALLEST_LAST_ENTRY: f64 = 1e-13;

/// The multibody affine motion 𝒜 ∈ R^{M_n × M_n} of (7): `ν_n(y)ᵀ 𝒜 ν_n(x) = Π_i yᵀA_i x`, with 𝒜(M_n, M_n) = 1.
#[derive(Clone, Debug, PartialEq)]
pub struct MultibodyMotion {
    degree: usize,
    matrix: DMatrix<f64>,
}

impl MultibodyMotion {
    /// The symmetric tensor product of the motions (Lemma 1, Example 1). No motions give degree 0 and the matrix (1).
    pub fn from_motions(motions: &[AffineMotion]) -> Self {
        let mut matrix = DMatrix::from_element(1, 1, 1.0);
        for (degree, motion) in motions.iter().enumerate() {
            matrix = times_factor(&matrix, degree, motion);
        }
        MultibodyMotion { degree: motions.len(), matrix }
    }

    /// 𝒜 from ã of (9): M_n² − Z_n numbers in the order of [`kept_pairs`], of any scale.
    ///
    /// Where the last number vanishes (data without motion in them) the result is that of n static motions.
    pub fn from_coefficients(degree: usize, coefficients: &[f64]) -> Self {
        let length = coefficients.iter().map(|c| c * c).sum::<f64>().sqrt();
        let last = coefficients.last().copied().unwrap_or(0.0);
        let mut matrix = DMatrix::zeros(count(degree), count(degree));
        if last.abs() > SMALLEST_LAST_ENTRY * length {
            for (&(row, column), value) in kept_pairs(degree).iter().zip(coefficients) {
                matrix[(row, column)] = value / last;
            }
        }
        let corner = count(degree) - 1;
        matrix[(corner, corner)] = 1.0;
        MultibodyMotion { degree, matrix }
    }

    /// Solves P̃_n ã = 0 (9) by QR decomposition with columns scaled to unit length and inverse iteration on R.
    ///
    /// `measurements` should be normalised; the result is in their coordinates.
    ///
    /// # Errors
    /// [`Error::TooFewMeasurements`] where N < M_n² − Z_n − 1.
    pub fn estimate(measurements: &Measurements, degree: usize) -> Result<Self> {
        let needed = measurements_needed(degree);
        if measurements.len() < needed {
            return Err(Error::TooFewMeasurements { motions: degree, needed, found: measurements.len() });
        }
        Ok(Self::from_embedded(&EmbeddedData::new(measurements, degree)))
    }

    /// The same from data already embedded.
    pub fn from_embedded(data: &EmbeddedData) -> Self {
        Self::from_triangle(data.degree(), data.triangle().clone())
    }

    /// The same from R of the embedded data.
    pub(super) fn from_triangle(degree: usize, mut triangle: Triangle) -> Self {
        let lengths = triangle.scale_columns();
        let mut null = NullVector::of(&triangle).vector;
        for (value, length) in null.iter_mut().zip(&lengths) {
            *value /= length;
        }
        Self::from_coefficients(degree, &null)
    }

    /// The degree n: the number of motions.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// 𝒜, M_n×M_n: rows by the monomials of y, columns by those of x.
    pub fn matrix(&self) -> &DMatrix<f64> {
        &self.matrix
    }

    /// ã of (9): the M_n² − Z_n entries that do not vanish by structure, in the order of [`kept_pairs`].
    pub fn coefficients(&self) -> Vec<f64> {
        kept_pairs(self.degree).iter().map(|&place| self.matrix[place]).collect()
    }

    /// ν_n(y)ᵀ 𝒜 ν_n(x), the left side of (7).
    pub fn evaluate(&self, x: [f64; 3], y: [f64; 3]) -> f64 {
        embed(self.degree, y).dot(&self.multibody_flow(x))
    }

    /// Its derivatives by y. Where x and y belong to motion i, they are parallel to the flow A_i x.
    pub fn gradient_y(&self, x: [f64; 3], y: [f64; 3]) -> [f64; 3] {
        let g = jacobian(self.degree, y).tr_mul(&self.multibody_flow(x));
        [g[0], g[1], g[2]]
    }

    /// Its derivatives by x. Where x and y belong to motion i, they are parallel to A_iᵀy.
    pub fn gradient_x(&self, x: [f64; 3], y: [f64; 3]) -> [f64; 3] {
        let g = jacobian(self.degree, x).tr_mul(&self.multibody_row(y));
        [g[0], g[1], g[2]]
    }

    /// The multibody optical flow ũ = 𝒜 ν_n(x) of (14): the coefficients in y of Π yᵀu_i, u_i = A_i x.
    pub fn multibody_flow(&self, x: [f64; 3]) -> DVector<f64> {
        &self.matrix * embed(self.degree, x)
    }

    /// 𝒜ᵀ ν_n(y): the coefficients in x of Π (A_iᵀy)ᵀx (15).
    pub fn multibody_row(&self, y: [f64; 3]) -> DVector<f64> {
        self.matrix.tr_mul(&embed(self.degree, y))
    }
}

/// M_n² − Z_n − 1: the number of measurements that n motions need (Theorem 1).
pub(crate) const fn measurements_needed(degree: usize) -> usize {
    count(degree) * count(degree) - structural_zeros(degree) - 1
}

/// The matrix of degree n + 1 of the product of a polynomial of degree n with one yᵀA x.
fn times_factor(matrix: &DMatrix<f64>, degree: usize, motion: &AffineMotion) -> DMatrix<f64> {
    let a = &motion.matrix;
    let entries = [(0, 0, a[0]), (0, 1, a[1]), (0, 2, a[2]), (1, 0, a[3]), (1, 1, a[4]), (1, 2, a[5]), (2, 2, 1.0)];
    let mut product = DMatrix::zeros(count(degree + 1), count(degree + 1));
    let all = exponents(degree);
    for (row, &y) in all.iter().enumerate() {
        for (column, &x) in all.iter().enumerate() {
            let value = matrix[(row, column)];
            for &(i, j, entry) in &entries {
                product[(index(raised(y, i)), index(raised(x, j)))] += value * entry;
            }
        }
    }
    product
}

/// A monomial times one more of variable k.
fn raised(mut exponents: Exponents, k: usize) -> Exponents {
    exponents[k] += 1;
    exponents
}
