//! Minimum norm least squares for small systems, by a one-sided Jacobi singular value decomposition.
//!
//! Library decompositions may call `hypot`, whose last bit differs between platforms. This one uses + − × ÷ √ only.

use nalgebra::{DMatrix, DVector};

use super::kernels::{add_multiple, dot};

/// Maximum number of sweeps. Convergence is quadratic; small matrices need 4 to 8.
const MAX_SWEEPS: usize = 40;
/// Two columns count as orthogonal if the cosine of the angle between them is below this.
const ORTHOGONAL: f64 = 1e-15;

/// The minimum norm solution x of the least squares problem min |A x − b|, with singular values below `tolerance` times the largest
/// taken as zero.
///
/// A is m × n, b has length m; both must be finite. It is meant for n ≤ 10.
///
/// Hestenes' method: rotations V from the right make the columns of A V orthogonal, and their lengths are the singular values.
///
/// ```
/// use nalgebra::{DMatrix, DVector};
/// use veronese::linear::least_squares;
///
/// // One equation, x + 2y = 5: the solution nearest to the origin is (1, 2).
/// let x = least_squares(&DMatrix::from_row_slice(1, 2, &[1.0, 2.0]), &DVector::from_vec(vec![5.0]), 1e-12);
/// assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 2.0).abs() < 1e-15);
/// ```
pub fn least_squares(matrix: &DMatrix<f64>, right: &DVector<f64>, tolerance: f64) -> DVector<f64> {
    let n = matrix.ncols();
    let mut columns: Vec<Vec<f64>> = matrix.column_iter().map(|c| c.iter().copied().collect()).collect();
    let mut rotation: Vec<Vec<f64>> =
        (0..n).map(|k| (0..n).map(|i| if i == k { 1.0 } else { 0.0 }).collect()).collect();
    for _ in 0..MAX_SWEEPS {
        let mut rotated = false;
        for q in 1..n {
            for p in 0..q {
                if let Some((cosine, sine)) = orthogonalising(&columns[p], &columns[q]) {
                    rotate(&mut columns, p, q, cosine, sine);
                    rotate(&mut rotation, p, q, cosine, sine);
                    rotated = true;
                }
            }
        }
        if !rotated {
            break;
        }
    }
    let squares: Vec<f64> = columns.iter().map(|c| dot(c, c)).collect();
    let smallest = tolerance * tolerance * squares.iter().copied().fold(0.0, f64::max);
    let mut solution = vec![0.0; n];
    for k in 0..n {
        if squares[k] > smallest {
            add_multiple(&mut solution, dot(&columns[k], right.as_slice()) / squares[k], &rotation[k]);
        }
    }
    DVector::from_vec(solution)
}

/// Cosine and sine of the rotation that makes two columns orthogonal; `None` if they already are.
fn orthogonalising(a: &[f64], b: &[f64]) -> Option<(f64, f64)> {
    let (alpha, beta, gamma) = (dot(a, a), dot(b, b), dot(a, b));
    if gamma.abs() <= ORTHOGONAL * (alpha * beta).sqrt() {
        return None;
    }
    let zeta = (beta - alpha) / (2.0 * gamma);
    let tangent = zeta.signum() / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
    let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
    Some((cosine, cosine * tangent))
}

fn rotate(columns: &mut [Vec<f64>], p: usize, q: usize, cosine: f64, sine: f64) {
    let (left, right) = columns.split_at_mut(q);
    for (a, b) in left[p].iter_mut().zip(right[0].iter_mut()) {
        (*a, *b) = (cosine * *a - sine * *b, sine * *a + cosine * *b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn the_solution_is_that_of_the_pseudoinverse() {
        let mut random = Random::from_seed(12);
        for (rows, columns, rank) in [(1, 1, 1), (4, 4, 4), (7, 3, 3), (6, 6, 3), (3, 3, 0), (10, 10, 9)] {
            let left = DMatrix::from_fn(rows, rank, |_, _| random.uniform(-1.0, 1.0));
            let matrix = left * DMatrix::from_fn(rank, columns, |_, _| random.uniform(-1.0, 1.0));
            let right = DVector::from_fn(rows, |_, _| random.uniform(-1.0, 1.0));
            let found = least_squares(&matrix, &right, 1e-10);
            let expected = matrix.clone().svd(true, true).solve(&right, 1e-10).unwrap();
            assert!((found - &expected).amax() < 1e-9 * (1.0 + expected.amax()), "{rows}×{columns}, rank {rank}");
        }
    }
}
