//! Factorisation of a homogeneous polynomial in three variables into linear forms (after eq. 14): f(z) = γ Π_i b_iᵀz.
//!
//! The method is that of Vidal, Ma and Sastry, "Generalized Principal Component Analysis" (2002). f(0, z_2, z_3) is a polynomial in
//! z_2 / z_3, whose roots give the second and third entries of all b_i up to scale. The coefficients of the monomials that are linear in
//! z_1 are then linear in the first entries.
//!
//! **Limits.** f must not vanish for z_1 = 0. If two forms have the same ratio b_i2 : b_i3, the linear system does not determine their
//! first entries, and its minimum norm solution is used.

use nalgebra::{DMatrix, DVector};

use super::roots::roots;
use crate::linear::least_squares;

/// Singular values of the linear system below this share of the largest count as zero.
const RANK_TOLERANCE: f64 = 1e-13;

/// The n linear forms b_i whose product is proportional to the form f with the given M_n coefficients, in the order of
/// [`monomials`](crate::embedding::monomials).
///
/// (b_i2, b_i3) has unit length. Of complex roots, which occur with noise, the real parts are used. `None` if the number of
/// coefficients is not M_n, or if f(0, z_2, z_3) vanishes.
///
/// ```
/// use veronese::factorisation::ternary::factorise;
///
/// // (z₁ + z₂) (2z₁ + z₃) = 2z₁² + 2z₁z₂ + z₁z₃ + z₂z₃
/// let mut forms = factorise(&[2.0, 2.0, 1.0, 0.0, 1.0, 0.0], 2).unwrap();
/// forms.sort_by(|a, b| a[0].abs().total_cmp(&b[0].abs()));
/// for (form, expected) in forms.iter().zip([[1.0, 1.0, 0.0], [2.0, 0.0, 1.0]]) {
///     let sign = form[0].signum();
///     assert!(form.iter().zip(expected).all(|(b, e)| (sign * b - e).abs() < 1e-14));
/// }
/// ```
pub fn factorise(coefficients: &[f64], degree: usize) -> Option<Vec<[f64; 3]>> {
    let length = coefficients.len();
    if degree == 0 || length != crate::embedding::monomials::count(degree) {
        return None;
    }
    // The last n + 1 coefficients are those of z_2ⁿ, z_2ⁿ⁻¹z_3, …, z_3ⁿ. The n before them belong to monomials linear in z_1.
    let (rest, binary) = coefficients.split_at(length - degree - 1);
    let linear = &rest[rest.len() - degree..];
    let pairs = binary_factors(binary)?;
    let expansion = expand(&pairs);
    let scale = dot(&expansion, binary) / dot(&expansion, &expansion);
    if scale == 0.0 || !scale.is_finite() {
        return None;
    }
    let system = DMatrix::from_fn(degree, degree, |row, i| {
        let others: Vec<[f64; 2]> = (0..degree).filter(|&j| j != i).map(|j| pairs[j]).collect();
        scale * expand(&others)[row]
    });
    let first = least_squares(&system, &DVector::from_column_slice(linear), RANK_TOLERANCE);
    Some(pairs.iter().zip(first.iter()).map(|(b, &b1)| [b1, b[0], b[1]]).collect())
}

/// The linear forms b_1 s + b_2 t of unit length whose product is proportional to `c[0] sⁿ + c[1] sⁿ⁻¹t + … + c[n] tⁿ`; `None` if all
/// coefficients vanish or one is not finite.
fn binary_factors(c: &[f64]) -> Option<Vec<[f64; 2]>> {
    if c.iter().all(|v| *v == 0.0) || c.iter().any(|v| !v.is_finite()) {
        return None;
    }
    // With t = 1, a root s = r gives the factor s − r t, and a root at infinity the factor t.
    let ascending: Vec<f64> = c.iter().rev().copied().collect();
    let found = roots(&ascending);
    let mut factors: Vec<[f64; 2]> = found
        .finite
        .iter()
        .map(|root| {
            let length = (1.0 + root.re * root.re).sqrt();
            [1.0 / length, -root.re / length]
        })
        .collect();
    factors.extend(std::iter::repeat_n([0.0, 1.0], found.infinite));
    (factors.len() + 1 == c.len()).then_some(factors)
}

/// The coefficients of a product of binary forms, by decreasing powers of the first variable.
fn expand(factors: &[[f64; 2]]) -> Vec<f64> {
    let mut product = vec![1.0];
    for [s, t] in factors {
        let mut next = vec![0.0; product.len() + 1];
        for (k, value) in product.iter().enumerate() {
            next[k] += value * s;
            next[k + 1] += value * t;
        }
        product = next;
    }
    product
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
