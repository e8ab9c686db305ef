//! Singular values of a square matrix by reduction to bidiagonal form and bisection.
//!
//! The symmetric tridiagonal matrix with zero diagonal and the entries of the bidiagonal matrix B alternating next to it has the
//! eigenvalues ±σ (the Golub–Kahan form). Bisection on its Sturm counts always converges, uses + − × ÷ only, and is accurate to
//! rounding of the largest singular value.

use nalgebra::DMatrix;
use nalgebra::linalg::Bidiagonal;

/// Bisection steps: enough for the last bit of the largest value.
const HALVINGS: usize = 54;

/// All singular values, decreasing, in O(m³).
pub(super) fn singular_values(matrix: DMatrix<f64>) -> Vec<f64> {
    let size = matrix.nrows();
    if size == 0 {
        return Vec::new();
    }
    let bidiagonal = Bidiagonal::new(matrix);
    let (diagonal, beside) = (bidiagonal.diagonal(), bidiagonal.off_diagonal());
    let mut squares = Vec::with_capacity(2 * size);
    for k in 0..size {
        squares.push(diagonal[k] * diagonal[k]);
        if k + 1 < size {
            squares.push(beside[k] * beside[k]);
        }
    }
    // Gershgorin: no singular value exceeds twice the largest entry.
    let bound = 2.0 * squares.iter().copied().fold(0.0, f64::max).sqrt();
    (0..size).map(|rank| bisected(&squares, size, rank, bound)).collect()
}

/// The singular value of index `rank`, counted from the largest.
fn bisected(squares: &[f64], size: usize, rank: usize, bound: f64) -> f64 {
    let (mut low, mut high) = (0.0, bound);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        // Of the 2m eigenvalues ±σ, those at or above `middle` > 0 are singular values.
        if 2 * size - below(squares, middle) > rank { low = middle } else { high = middle }
    }
    // A singular value of 0 is exactly 0, because the lower end never moves.
    low
}

/// Number of eigenvalues below x of the symmetric tridiagonal matrix with zero diagonal and the given squared off-diagonal entries.
fn below(squares: &[f64], x: f64) -> usize {
    // A zero pivot is perturbed by less than rounding, and counts with the sign it then has. The count is that of a nearby matrix.
    let safe = |pivot: f64| if pivot.abs() < f64::MIN_POSITIVE { -f64::MIN_POSITIVE } else { pivot };
    let mut pivot = safe(-x);
    let mut count = usize::from(pivot < 0.0);
    for square in squares {
        pivot = safe(-x - square / pivot);
        count += usize::from(pivot < 0.0);
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn singular_values_agree_with_nalgebra() {
        let mut random = Random::from_seed(13);
        for size in [1, 2, 3, 10, 65] {
            let mut matrix = DMatrix::from_fn(size, size, |_, _| random.uniform(-1.0, 1.0));
            if size > 2 {
                let twice = 2.0 * matrix.column(0);
                matrix.set_column(1, &twice);
            }
            let mut expected: Vec<f64> = matrix.clone().singular_values().iter().copied().collect();
            expected.sort_by(|a, b| b.total_cmp(a));
            for (a, b) in singular_values(matrix).iter().zip(&expected) {
                assert!((a - b).abs() < 1e-13 * expected[0], "{a} for {b}, size {size}");
            }
        }
        assert_eq!(singular_values(DMatrix::zeros(3, 3)), [0.0; 3]);
    }

    #[test]
    fn a_pivot_that_vanishes_is_counted() {
        // The first bisection step meets the largest entry, and a pivot of exactly zero.
        let found = singular_values(DMatrix::from_row_slice(2, 2, &[1.0, 0.8, 0.0, 0.6]));
        assert!((found[0] - 1.8f64.sqrt()).abs() < 1e-15 && (found[1] - 0.2f64.sqrt()).abs() < 1e-15, "{found:?}");
    }
}
