//! The Veronese map ν_n : R³ → R^{M_n} (7): all monomials of degree n, and its Jacobian.

use nalgebra::{DMatrix, DVector};

use super::monomials::{count, exponents};

/// Powers 0…n of one number.
fn powers(value: f64, degree: usize) -> Vec<f64> {
    let mut all = Vec::with_capacity(degree + 1);
    let mut power = 1.0;
    for _ in 0..=degree {
        all.push(power);
        power *= value;
    }
    all
}

/// ν_n(v), length M_n, in the order of [`exponents`].
pub fn embed(degree: usize, v: [f64; 3]) -> DVector<f64> {
    let [p, q, r] = v.map(|value| powers(value, degree));
    let values = exponents(degree).iter().map(|&[a, b, c]| p[a] * q[b] * r[c]).collect();
    DVector::from_vec(values)
}

/// The Jacobian of ν_n at v, M_n×3: column k holds the derivatives by the k-th variable.
pub fn jacobian(degree: usize, v: [f64; 3]) -> DMatrix<f64> {
    let p = v.map(|value| powers(value, degree));
    let mut result = DMatrix::zeros(count(degree), 3);
    for (row, e) in exponents(degree).iter().enumerate() {
        for k in 0..3 {
            if e[k] > 0 {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                result[(row, k)] = e[k] as f64 * p[k][e[k] - 1] * p[i][e[i]] * p[j][e[j]];
            }
        }
    }
    result
}

/// ν_n of many vectors, column-major: `result[monomial * vectors.len() + j]` belongs to vector j.
pub(super) fn embed_columns(degree: usize, vectors: &[[f64; 3]]) -> Vec<f64> {
    let rows = vectors.len();
    let mut result = vec![0.0; rows * count(degree)];
    let all = exponents(degree);
    for (j, v) in vectors.iter().enumerate() {
        let [p, q, r] = v.map(|value| powers(value, degree));
        for (monomial, &[a, b, c]) in all.iter().enumerate() {
            result[monomial * rows + j] = p[a] * q[b] * r[c];
        }
    }
    result
}

/// The derivatives of ν_n by variable k at many vectors, laid out as in [`embed_columns`].
pub(super) fn derivative_columns(degree: usize, k: usize, vectors: &[[f64; 3]]) -> Vec<f64> {
    let rows = vectors.len();
    let mut result = vec![0.0; rows * count(degree)];
    let all = exponents(degree);
    for (j, v) in vectors.iter().enumerate() {
        let p = v.map(|value| powers(value, degree));
        for (monomial, &e) in all.iter().enumerate() {
            if e[k] > 0 {
                let (a, b) = ((k + 1) % 3, (k + 2) % 3);
                result[monomial * rows + j] = e[k] as f64 * p[k][e[k] - 1] * p[a][e[a]] * p[b][e[b]];
            }
        }
    }
    result
}
