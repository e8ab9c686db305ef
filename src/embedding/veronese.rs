//! The Veronese map ν_n : R³ → R^{M_n} (7): all monomials of degree n, and its Jacobian.

use nalgebra::{DMatrix, DVector};

use super::monomials::{count, each};
use crate::options::MAX_MOTIONS;

/// Powers 0…n of one number; those beyond n are not meant.
fn powers(value: f64, degree: usize) -> [f64; MAX_MOTIONS + 1] {
    let mut all = [1.0; MAX_MOTIONS + 1];
    for k in 0..degree.min(MAX_MOTIONS) {
        all[k + 1] = all[k] * value;
    }
    all
}

/// ν_n(v), length M_n, in the order of [`exponents`](super::monomials::exponents).
pub fn embed(degree: usize, v: [f64; 3]) -> DVector<f64> {
    let mut values = vec![0.0; count(degree)];
    embed_into(degree, v, &mut values);
    DVector::from_vec(values)
}

/// [`embed`] into a place of length M_n.
pub(super) fn embed_into(degree: usize, v: [f64; 3], values: &mut [f64]) {
    let [p, q, r] = v.map(|value| powers(value, degree));
    for (value, [a, b, c]) in values.iter_mut().zip(each(degree)) {
        *value = p[a] * q[b] * r[c];
    }
}

/// The Jacobian of ν_n at v, M_n×3: column k holds the derivatives by the k-th variable.
pub fn jacobian(degree: usize, v: [f64; 3]) -> DMatrix<f64> {
    let mut result = DMatrix::zeros(count(degree), 3);
    for (k, mut column) in result.column_iter_mut().enumerate() {
        derivatives_into(degree, k, v, column.as_mut_slice());
    }
    result
}

/// Column k of [`jacobian`] into a place of length M_n.
pub(super) fn derivatives_into(degree: usize, k: usize, v: [f64; 3], values: &mut [f64]) {
    let p = v.map(|value| powers(value, degree));
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    for (value, e) in values.iter_mut().zip(each(degree)) {
        *value = match e[k] {
            0 => 0.0,
            power => power as f64 * p[k][power - 1] * p[i][e[i]] * p[j][e[j]],
        };
    }
}

/// ν_n of many vectors, column-major: `result[monomial * vectors.len() + j]` belongs to vector j.
pub(super) fn embed_columns(degree: usize, vectors: &[[f64; 3]]) -> Vec<f64> {
    columns(degree, vectors, |v, values| embed_into(degree, v, values))
}

/// The derivatives of ν_n by variable k at many vectors, laid out as in [`embed_columns`].
pub(super) fn derivative_columns(degree: usize, k: usize, vectors: &[[f64; 3]]) -> Vec<f64> {
    columns(degree, vectors, |v, values| derivatives_into(degree, k, v, values))
}

/// What `of` says of each vector, M_n values, as columns over all vectors.
fn columns(degree: usize, vectors: &[[f64; 3]], of: impl Fn([f64; 3], &mut [f64])) -> Vec<f64> {
    let rows = vectors.len();
    let mut result = vec![0.0; rows * count(degree)];
    let mut values = vec![0.0; count(degree)];
    for (j, v) in vectors.iter().enumerate() {
        of(*v, &mut values);
        for (column, value) in result.chunks_exact_mut(rows).zip(&values) {
            column[j] = *value;
        }
    }
    result
}
