//! A homogeneous polynomial in three variables into linear forms (after eq. 14): f(z) = γ Π_i b_iᵀz.
//!
//! Following Vidal, Ma, Sastry, "Generalized Principal Component Analysis" (2002): f(0, z_2, z_3) is a polynomial in one
//! ratio, whose roots give the second and third entries of every b_i up to scale; the coefficients of the monomials with
//! z_1 to the power 1 are then linear in the first entries.
//!
//! **Limits**: f must not vanish for z_1 = 0, and the pairs (b_i2, b_i3) must differ between factors, or the linear
//! system does not determine the first entries (the solution of least length is taken).

use nalgebra::{DMatrix, DVector};

use super::roots::roots;
use crate::linear::least_squares;

/// Singular values of the linear system below this share of the largest count as zero.
const RANK_TOLERANCE: f64 = 1e-13;

/// The n linear forms b_i whose product is proportional to the form with the given M_n coefficients (in the monomial
/// order of [`monomials`](crate::embedding::monomials)). (b_i2, b_i3) has unit length. Roots that noise made complex
/// enter with their real parts. `None` where f(0, z_2, z_3) vanishes: then the method does not apply.
pub fn factorise(coefficients: &[f64], degree: usize) -> Option<Vec<[f64; 3]>> {
    let length = coefficients.len();
    if degree == 0 || length != crate::embedding::monomials::count(degree) {
        return None;
    }
    // The last n + 1 coefficients are those of z_2ⁿ, z_2ⁿ⁻¹z_3, …, z_3ⁿ; the n before them have z_1 to the power 1.
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

/// The linear forms b_1 s + b_2 t, of unit length, whose product is proportional to
/// `c[0] sⁿ + c[1] sⁿ⁻¹t + … + c[n] tⁿ`; `None` where all coefficients vanish.
fn binary_factors(c: &[f64]) -> Option<Vec<[f64; 2]>> {
    if c.iter().all(|v| *v == 0.0) || c.iter().any(|v| !v.is_finite()) {
        return None;
    }
    // With t = 1 a root s = r gives the factor s − r t; a root at infinity gives t.
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
