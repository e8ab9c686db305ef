//! The monomials of degree n in three variables, their order, and the entries of 𝒜 that cannot vanish (Appendix A).
//!
//! The paper's order is xⁿ, xⁿ⁻¹y, xⁿ⁻¹z, xⁿ⁻²y², …, zⁿ: decreasing powers of the first variable, then of the second.

use crate::options::MAX_MOTIONS;

/// Powers of the three variables in one monomial; their sum is the degree.
pub type Exponents = [usize; 3];

/// M_n = (n + 1)(n + 2)/2, the number of monomials of degree `degree` (7): the length of the Veronese map.
pub const fn count(degree: usize) -> usize {
    (degree + 1) * (degree + 2) / 2
}

/// Z_n = n(n + 1)(n + 2)(3n + 5)/24, the number of entries of 𝒜 that are zero whatever the motions are (Appendix A).
pub const fn structural_zeros(degree: usize) -> usize {
    degree * (degree + 1) * (degree + 2) * (3 * degree + 5) / 24
}

/// M_n² − Z_n, the number of unknowns in ã of (9): 7, 25, 65, 140, 266, 462, 750, 1155, 1705, 2431 for n = 1…10.
pub const fn unknowns(degree: usize) -> usize {
    count(degree) * count(degree) - structural_zeros(degree)
}

/// All monomials of degree `degree`, in the paper's order.
pub fn exponents(degree: usize) -> Vec<Exponents> {
    let mut all = Vec::with_capacity(count(degree));
    for a in (0..=degree).rev() {
        for b in (0..=degree - a).rev() {
            all.push([a, b, degree - a - b]);
        }
    }
    all
}

/// The place of a monomial in [`exponents`] of its degree.
pub const fn index(exponents: Exponents) -> usize {
    // Before it stand the monomials with a larger power of the first variable, 1 + 2 + … + (b + c) of them.
    let rest = exponents[1] + exponents[2];
    rest * (rest + 1) / 2 + exponents[2]
}

/// The (row, column) places of 𝒜 that do not vanish, row by row: the order of ã in (9). The last is (M_n, M_n), whose value
/// is 1.
///
/// A row belongs to a monomial of y, a column to one of x. Every factor yᵀA_i x that contributes I_t contributes z as well,
/// so an entry is kept exactly where the power of z is at least that of I_t (Appendix A).
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
