//! The multibody affine motion 𝒜 (Lemma 1): the matrix of the multibody constraint, which contains all motions.

use nalgebra::{DMatrix, DVector};

use super::embedded::EmbeddedData;
use super::monomials::{Exponents, count, exponents, index, kept_pairs, unknowns};
use super::veronese::{embed, jacobian};
use crate::error::Result;
use crate::linear::{NullVector, Triangle};
use crate::measurements::Measurements;
use crate::motion::AffineMotion;

/// If the last entry of the null vector is below this share of its length, it counts as zero and cannot be scaled to 1.
const SMALLEST_LAST_ENTRY: f64 = 1e-13;

/// The multibody affine motion 𝒜 ∈ R^{M_n × M_n} of (7): `ν_n(y)ᵀ 𝒜 ν_n(x) = Π_i yᵀA_i x`, with 𝒜(M_n, M_n) = 1.
///
/// ```
/// use veronese::AffineMotion;
/// use veronese::embedding::MultibodyMotion;
///
/// let motions = [AffineMotion::translation(2.0, -1.0), AffineMotion::new([0.5, 0.0, 0.0, 0.0, 0.5, 1.0])];
/// let multibody = MultibodyMotion::from_motions(&motions);
/// assert_eq!((multibody.degree(), multibody.matrix().shape()), (2, (6, 6)));
///
/// let (x, y) = ([0.5, 0.25, 1.0], [1.0, 2.0, -0.5]);
/// let product: f64 = motions.iter().map(|motion| motion.residual([x[0], x[1]], y)).product();
/// assert!((multibody.evaluate(x, y) - product).abs() < 1e-15);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MultibodyMotion {
    degree: usize,
    matrix: DMatrix<f64>,
}

impl MultibodyMotion {
    /// 𝒜 of the given motions, their symmetric tensor product (Lemma 1, Example 1). An empty list gives degree 0 and the matrix (1).
    pub fn from_motions(motions: &[AffineMotion]) -> Self {
        let mut matrix = DMatrix::from_element(1, 1, 1.0);
        for (degree, motion) in motions.iter().enumerate() {
            matrix = times_factor(&matrix, degree, motion);
        }
        MultibodyMotion { degree: motions.len(), matrix }
    }

    /// 𝒜 from ã of (9): M_n² − Z_n coefficients in the order of [`kept_pairs`], known up to scale.
    ///
    /// If the last coefficient vanishes, the scale is undetermined, and the result is the matrix of n static motions.
    ///
    /// ```
    /// use veronese::AffineMotion;
    /// use veronese::embedding::MultibodyMotion;
    ///
    /// let multibody = MultibodyMotion::from_motions(&[AffineMotion::STATIC, AffineMotion::translation(2.0, -1.0)]);
    /// let scaled: Vec<f64> = multibody.coefficients().iter().map(|c| 8.0 * c).collect();
    /// assert_eq!(MultibodyMotion::from_coefficients(2, &scaled), multibody);
    /// ```
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

    /// Solves P̃_n ã = 0 (9) by QR decomposition, scaling of the columns to unit length, and inverse iteration on R.
    ///
    /// `measurements` should be normalised; the result is in their coordinates. [`taubin_motion`](super::taubin_motion) is more accurate
    /// on noisy data.
    ///
    /// # Errors
    /// [`Error::TooFewMeasurements`](crate::Error::TooFewMeasurements) if N < M_n² − Z_n − 1.
    pub fn estimate(measurements: &Measurements, degree: usize) -> Result<Self> {
        measurements.check_number(degree, measurements_needed(degree))?;
        Ok(Self::from_embedded(&EmbeddedData::new(measurements, degree)))
    }

    /// [`estimate`](Self::estimate) from embedded data.
    pub fn from_embedded(data: &EmbeddedData) -> Self {
        Self::from_triangle(data.degree(), data.triangle().clone())
    }

    /// [`estimate`](Self::estimate) from R of the embedded data.
    pub(super) fn from_triangle(degree: usize, mut triangle: Triangle) -> Self {
        let lengths = triangle.scale_columns();
        let mut null = NullVector::of(&triangle).vector;
        for (value, length) in null.iter_mut().zip(&lengths) {
            *value /= length;
        }
        Self::from_coefficients(degree, &null)
    }

    /// The degree n, which is the number of motions.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// 𝒜, M_n × M_n. Rows belong to monomials of y, columns to monomials of x.
    pub fn matrix(&self) -> &DMatrix<f64> {
        &self.matrix
    }

    /// ã of (9): the M_n² − Z_n entries of 𝒜 that are not structural zeros, in the order of [`kept_pairs`].
    pub fn coefficients(&self) -> Vec<f64> {
        kept_pairs(self.degree).iter().map(|&place| self.matrix[place]).collect()
    }

    /// The polynomial p(x, y) = ν_n(y)ᵀ 𝒜 ν_n(x), the left-hand side of (7).
    pub fn evaluate(&self, x: [f64; 3], y: [f64; 3]) -> f64 {
        embed(self.degree, y).dot(&self.multibody_flow(x))
    }

    /// The gradient ∂p/∂y. If the measurement (x, y) belongs to motion i, it is parallel to the flow A_i x.
    ///
    /// ```
    /// use veronese::AffineMotion;
    /// use veronese::embedding::MultibodyMotion;
    ///
    /// let multibody = MultibodyMotion::from_motions(&[AffineMotion::STATIC, AffineMotion::translation(2.0, -1.0)]);
    /// let (x, y) = ([0.5, 0.25, 1.0], [1.0, 1.0, -1.0]); // 1·2 + 1·(−1) − 1 = 0
    /// let g = multibody.gradient_y(x, y);
    /// assert_eq!([g[0] / g[2], g[1] / g[2]], [2.0, -1.0]);
    /// ```
    pub fn gradient_y(&self, x: [f64; 3], y: [f64; 3]) -> [f64; 3] {
        let g = jacobian(self.degree, y).tr_mul(&self.multibody_flow(x));
        [g[0], g[1], g[2]]
    }

    /// The gradient ∂p/∂x. If the measurement (x, y) belongs to motion i, it is parallel to A_iᵀy.
    pub fn gradient_x(&self, x: [f64; 3], y: [f64; 3]) -> [f64; 3] {
        let g = jacobian(self.degree, x).tr_mul(&self.multibody_row(y));
        [g[0], g[1], g[2]]
    }

    /// The multibody optical flow ũ = 𝒜 ν_n(x) of (14), length M_n: the coefficients of Π_i yᵀu_i, u_i = A_i x, as a form in y.
    pub fn multibody_flow(&self, x: [f64; 3]) -> DVector<f64> {
        &self.matrix * embed(self.degree, x)
    }

    /// 𝒜ᵀ ν_n(y) of (15), length M_n: the coefficients of Π_i (A_iᵀy)ᵀx as a form in x.
    pub fn multibody_row(&self, y: [f64; 3]) -> DVector<f64> {
        self.matrix.tr_mul(&embed(self.degree, y))
    }
}

/// M_n² − Z_n − 1, the number of measurements that n motions need (Theorem 1).
pub(crate) const fn measurements_needed(degree: usize) -> usize {
    unknowns(degree) - 1
}

/// The matrix of the product of a polynomial of degree `degree`, given by its matrix, and a factor yᵀA x.
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

/// A monomial multiplied by variable k.
fn raised(mut exponents: Exponents, k: usize) -> Exponents {
    exponents[k] += 1;
    exponents
}
