//! The monomials of degree n in three variables, their order, and the structural zeros of 𝒜 (Appendix A of the paper).
//!
//! The order is that of the paper: xⁿ, xⁿ⁻¹y, xⁿ⁻¹z, xⁿ⁻²y², …, zⁿ, by decreasing power of the first variable, then of the second.
//!
//! ```
//! use veronese::embedding::monomials::{count, exponents, index, kept_pairs, structural_zeros, unknowns};
//!
//! assert_eq!(exponents(2), [[2, 0, 0], [1, 1, 0], [1, 0, 1], [0, 2, 0], [0, 1, 1], [0, 0, 2]]);
//! assert_eq!(index([0, 1, 1]), 4);
//! assert_eq!((count(2), structural_zeros(2), unknowns(2)), (6, 11, 25));
//! // n = 1: A has the zeros (3, 1) and (3, 2), and the last entry is 1.
//! assert_eq!(kept_pairs(1), [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (2, 2)]);
//! ```

use crate::options::MAX_MOTIONS;

/// Powers of the three variables in a monomial; their sum is the degree.
pub type Exponents = [usize; 3];

/// M_n = (n + 1)(n + 2)/2, the number of monomials of degree n and the length of the Veronese map (7).
pub const fn count(degree: usize) -> usize {
    (degree + 1) * (degree + 2) / 2
}

/// Z_n = n(n + 1)(n + 2)(3n + 5)/24, the number of entries of 𝒜 that are zero for all motions (Appendix A).
pub const fn structural_zeros(degree: usize) -> usize {
    degree * (degree + 1) * (degree + 2) * (3 * degree + 5) / 24
}

/// M_n² − Z_n, the length of ã in (9): 7, 25, 65, 140, 266, 462, 750, 1155, 1705, 2431 for n = 1…10.
pub const fn unknowns(degree: usize) -> usize {
    count(degree) * count(degree) - structural_zeros(degree)
}

/// All monomials of the given degree, in the paper's order.
pub fn exponents(degree: usize) -> Vec<Exponents> {
    let mut all = Vec::with_capacity(count(degree));
    for a in (0..=degree).rev() {
        for b in (0..=degree - a).rev() {
            all.push([a, b, degree - a - b]);
        }
    }
    all
}

/// The index of a monomial in [`exponents`] of its degree.
pub const fn index(exponents: Exponents) -> usize {
    // It is preceded by 1 + 2 + … + (b + c) monomials with a larger power of the first variable.
    let rest = exponents[1] + exponents[2];
    rest * (rest + 1) / 2 + exponents[2]
}

/// The (row, column) indices, from 0, of the entries of 𝒜 that are not structural zeros, row by row: the order of ã in (9). The last is
/// (M_n − 1, M_n − 1), whose value is 1.
///
/// Rows belong to monomials of y, columns to monomials of x. Every factor yᵀA_i x that contributes I_t contributes z as well, so an
/// entry is kept if and only if the power of z is at least that of I_t (Appendix A).
pub fn kept_pairs(degree: usize) -> Vec<(usize, usize)> {
    debug_assert!(degree <= MAX_MOTIONS);
    let all = exponents(degree);
    let mut pairs = Vec::with_capacity(unknowns(degree));
    for (row, y) in all.iter().enumerate() {
        for (column, x) in all.iter().enumerate() {
            if x[2] >= y[2] {
                pairs.push((row, column));
            }
        }
    }
    pairs
}
