//! An upper triangular matrix, R of a QR decomposition: column scaling, solving, singular values.

use nalgebra::DMatrix;

use super::kernels::{add_multiple, dot};
use super::singular_values::singular_values;

/// An upper triangular m × m matrix, stored column-major including its zeros.
///
/// ```
/// use veronese::linear::RowQr;
///
/// let mut qr = RowQr::new(2);
/// qr.absorb(3, &mut vec![1.0, 0.0, 2.0, 0.0, 3.0, 4.0]); // the columns (1, 0, 2) and (0, 3, 4)
/// let mut triangle = qr.into_triangle();
/// let values = triangle.singular_values().unwrap();
/// assert!((values[0] * values[1] - 61.0_f64.sqrt()).abs() < 1e-12); // √det(AᵀA)
///
/// assert_eq!(triangle.scale_columns().len(), 2); // the lengths √5 and 5
/// let gram = triangle.to_matrix().transpose() * triangle.to_matrix();
/// assert!((gram[(0, 0)] - 1.0).abs() < 1e-14 && (gram[(1, 1)] - 1.0).abs() < 1e-14);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Triangle {
    size: usize,
    values: Vec<f64>,
}

impl Triangle {
    /// Largest m for which [`singular_values`](Self::singular_values) are computed; the cost grows with m³. m = 462 for n = 6.
    pub const LARGEST_DECOMPOSED: usize = 500;

    pub(super) fn zeros(size: usize) -> Self {
        Triangle { size, values: vec![0.0; size * size] }
    }

    /// The Cholesky factor R with RᵀR = `gram` + a ridge of `ridge` times the diagonal of `gram`. `gram` is column-major, and only its
    /// upper triangle is read. Squared pivots are raised to the ridge.
    pub(crate) fn of_gram(size: usize, mut gram: Vec<f64>, ridge: f64) -> Self {
        for k in 0..size {
            let (done, rest) = gram.split_at_mut(k * size);
            let (column, below) = rest[..size].split_at_mut(k);
            for (i, other) in done.chunks_exact(size).enumerate() {
                column[i] = (column[i] - dot(&other[..i], &column[..i])) / other[i];
            }
            let added = (ridge * below[0]).max(f64::MIN_POSITIVE);
            below[0] = (below[0] + added - dot(column, column)).max(added).sqrt();
            below[1..].fill(0.0);
        }
        Triangle { size, values: gram }
    }

    /// Number of rows and columns, m.
    pub fn size(&self) -> usize {
        self.size
    }

    #[inline]
    pub(super) fn at(&self, row: usize, column: usize) -> f64 {
        self.values[column * self.size + row]
    }

    #[inline]
    pub(super) fn set(&mut self, row: usize, column: usize, value: f64) {
        self.values[column * self.size + row] = value;
    }

    /// Rows `first..first + count` of one column.
    #[inline]
    pub(super) fn column_part_mut(&mut self, column: usize, first: usize, count: usize) -> &mut [f64] {
        let start = column * self.size + first;
        &mut self.values[start..start + count]
    }

    /// A column down to its diagonal entry.
    #[inline]
    fn column(&self, column: usize) -> &[f64] {
        &self.values[column * self.size..column * self.size + column + 1]
    }

    /// The dense matrix, m × m.
    pub fn to_matrix(&self) -> DMatrix<f64> {
        DMatrix::from_column_slice(self.size, self.size, &self.values)
    }

    /// Scales every column to unit length and returns the lengths (1 for a zero column). They are the lengths of the columns of the
    /// decomposed matrix, so the result is R of that matrix with columns scaled to unit length.
    pub fn scale_columns(&mut self) -> Vec<f64> {
        let size = self.size;
        let mut lengths = Vec::with_capacity(size);
        for k in 0..size {
            let length = dot(self.column(k), self.column(k)).sqrt();
            let length = if length > 0.0 { length } else { 1.0 };
            for value in self.column_part_mut(k, 0, k + 1) {
                *value /= length;
            }
            lengths.push(length);
        }
        lengths
    }

    /// Singular values, decreasing; `None` if m exceeds [`LARGEST_DECOMPOSED`](Self::LARGEST_DECOMPOSED).
    pub fn singular_values(&self) -> Option<Vec<f64>> {
        (self.size <= Self::LARGEST_DECOMPOSED).then(|| singular_values(self.to_matrix()))
    }

    /// The triangle with each column multiplied by its factor.
    pub(crate) fn with_columns_times(&self, factors: &[f64]) -> Triangle {
        let mut result = self.clone();
        for (column, factor) in result.values.chunks_exact_mut(self.size.max(1)).zip(factors) {
            column.iter_mut().for_each(|value| *value *= factor);
        }
        result
    }

    /// Largest absolute diagonal entry.
    pub(crate) fn largest_pivot(&self) -> f64 {
        self.pivots().fold(0.0, f64::max)
    }

    /// Absolute values of the diagonal entries.
    pub(super) fn pivots(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.size).map(|k| self.at(k, k).abs())
    }

    /// Solves RᵀR z = b in place, with pivots of absolute value below `floor` replaced by `floor`.
    pub(crate) fn solve_normal(&self, b: &mut [f64], floor: f64) {
        let pivot = |k: usize| {
            let r = self.at(k, k);
            if r.abs() >= floor { r } else { floor }
        };
        for k in 0..self.size {
            b[k] = (b[k] - dot(&self.column(k)[..k], &b[..k])) / pivot(k);
        }
        for k in (0..self.size).rev() {
            b[k] /= pivot(k);
            let (above, value) = (&self.column(k)[..k], b[k]);
            add_multiple(&mut b[..k], -value, above);
        }
    }

    /// |R v|.
    pub(super) fn image_length(&self, v: &[f64]) -> f64 {
        let mut image = vec![0.0; self.size];
        for k in 0..self.size {
            add_multiple(&mut image, v[k], self.column(k));
        }
        dot(&image, &image).sqrt()
    }
}
