//! The Veronese map ν_n : R³ → R^{M_n} of (7), which takes a vector to all its monomials of degree n, and its Jacobian.

use nalgebra::{DMatrix, DVector};

use super::monomials::{count, exponents};
use crate::options::MAX_MOTIONS;

/// Powers 0…`degree` of a number. Entries beyond `degree` are 1 and have no meaning.
fn powers(value: f64, degree: usize) -> [f64; MAX_MOTIONS + 1] {
    let mut all = [1.0; MAX_MOTIONS + 1];
    for k in 0..degree.min(MAX_MOTIONS) {
        all[k + 1] = all[k] * value;
    }
    all
}

/// ν_n(v), length M_n, in the order of [`exponents`].
///
/// # Panics
/// For a degree above [`MAX_MOTIONS`].
///
/// # Examples
/// ```
/// use veronese::embedding::veronese::embed;
///
/// // x², xy, xz, y², yz, z²
/// assert_eq!(embed(2, [2.0, 3.0, 5.0]).as_slice(), [4.0, 6.0, 10.0, 9.0, 15.0, 25.0]);
/// ```
pub fn embed(degree: usize, v: [f64; 3]) -> DVector<f64> {
    let [p, q, r] = v.map(|value| powers(value, degree));
    DVector::from_iterator(count(degree), exponents(degree).into_iter().map(|[a, b, c]| p[a] * q[b] * r[c]))
}

/// The Jacobian of ν_n at v, M_n × 3: column k holds the derivatives with respect to variable k.
///
/// # Panics
/// For a degree above [`MAX_MOTIONS`].
///
/// # Examples
/// ```
/// use veronese::embedding::veronese::{embed, jacobian};
///
/// // Euler's theorem for homogeneous functions: the Jacobian times v is n times ν_n(v).
/// let v = [2.0, 3.0, 5.0];
/// let product = jacobian(2, v) * nalgebra::Vector3::from(v);
/// assert_eq!(product, 2.0 * embed(2, v));
/// ```
pub fn jacobian(degree: usize, v: [f64; 3]) -> DMatrix<f64> {
    let p = v.map(|value| powers(value, degree));
    let all = exponents(degree);
    DMatrix::from_fn(all.len(), 3, |row, k| {
        let (e, i, j) = (all[row], (k + 1) % 3, (k + 2) % 3);
        match e[k] {
            0 => 0.0,
            power => power as f64 * p[k][power - 1] * p[i][e[i]] * p[j][e[j]],
        }
    })
}

/// ν_n of many vectors, column-major: `result[monomial * vectors.len() + j]` belongs to vector j. Works for any degree, and gives the
/// same bits as [`embed`].
pub(crate) fn embed_columns(degree: usize, vectors: &[[f64; 3]]) -> Vec<f64> {
    let rows = vectors.len();
    // Powers 0…n of each variable, as columns.
    let powers = [0, 1, 2].map(|k| {
        let mut columns = Vec::with_capacity(rows * (degree + 1));
        columns.resize(rows, 1.0);
        for power in 0..degree {
            columns.extend_from_within(power * rows..);
            columns[(power + 1) * rows..].iter_mut().zip(vectors).for_each(|(value, v)| *value *= v[k]);
        }
        columns
    });
    let mut result = Vec::with_capacity(rows * count(degree));
    for e in exponents(degree) {
        let [p, q, r] = [0, 1, 2].map(|k| &powers[k][e[k] * rows..][..rows]);
        result.extend(p.iter().zip(q).zip(r).map(|((p, q), r)| p * q * r));
    }
    result
}
