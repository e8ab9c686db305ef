//! The precision of a motion: the covariance of its entries, and the rank of their constraints.

use nalgebra::Matrix6;

use super::mixture::{Normal, cholesky};
use super::samples::Samples;

/// A direction in the space of the six entries is determined if the mean squared gradient along it exceeds this multiple of σ² …
const ABOVE_NOISE: f64 = 2.0;
/// … plus this constant, for data without noise (derivatives have unit root mean square length).
const ABOVE_ROUNDING: f64 = 1e-9;
/// Positions are collinear if their second moment in some direction is below this share of the total.
const IN_LINE: f64 = 1e-10;
/// Sweeps of Jacobi's method. Convergence is quadratic; 6 × 6 matrices need about five.
const SWEEPS: usize = 12;

/// `σ² H⁻¹` with `H = Σ w J Jᵀ`, the covariance of the entries with the labels taken as known. Directions that are not determined have a
/// large but finite variance.
pub(crate) fn covariance(normal: &Normal, sigma: f64) -> Matrix6<f64> {
    cholesky(normal.ridged()).inverse() * (sigma * sigma)
}

/// The numerical rank of the constraints on the six entries, 0 to 6. The eigenvalues of H relative to the flow energy `Σ X Xᵀ`,
/// X = (x, y, 1), at the positions of the motion's measurements `own` are mean squared gradients, which are compared with the noise.
pub(crate) fn determined(normal: &Normal, samples: &Samples, own: impl Iterator<Item = usize>, sigma: f64) -> usize {
    let mut energy = [[0.0; 3]; 3];
    for j in own {
        let [x, y] = samples.position(j);
        let position = [x, y, 1.0];
        (0..3).for_each(|r| (0..3).for_each(|c| energy[r][c] += position[r] * position[c]));
    }
    let (values, vectors) = eigen(energy);
    let trace: f64 = values.iter().sum();
    let mut whitening = [[0.0; 3]; 3];
    for k in (0..3).filter(|&k| values[k] > IN_LINE * trace) {
        (0..3).for_each(|r| whitening[r][k] = vectors[r][k] / values[k].sqrt());
    }
    let mut ratio = [[0.0; 6]; 6];
    for (r, row) in ratio.iter_mut().enumerate() {
        for (c, entry) in row.iter_mut().enumerate() {
            for p in 0..3 {
                for q in 0..3 {
                    let between = normal.matrix[(r / 3 * 3 + p, c / 3 * 3 + q)];
                    *entry += whitening[p][r % 3] * between * whitening[q][c % 3];
                }
            }
        }
    }
    let threshold = ABOVE_NOISE * sigma * sigma + ABOVE_ROUNDING;
    eigen(ratio).0.iter().filter(|&&value| value > threshold).count()
}

/// Eigenvalues and eigenvectors (columns) of a symmetric matrix by Jacobi's method.
fn eigen<const N: usize>(mut a: [[f64; N]; N]) -> ([f64; N], [[f64; N]; N]) {
    let mut vectors = [[0.0; N]; N];
    (0..N).for_each(|k| vectors[k][k] = 1.0);
    for _ in 0..SWEEPS {
        for p in 0..N {
            for q in p + 1..N {
                if a[p][q] == 0.0 {
                    continue;
                }
                let half = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let tangent = half.signum() / (half.abs() + (half * half + 1.0).sqrt());
                let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
                let sine = tangent * cosine;
                for k in 0..N {
                    (a[k][p], a[k][q]) = (cosine * a[k][p] - sine * a[k][q], sine * a[k][p] + cosine * a[k][q]);
                }
                for k in 0..N {
                    (a[p][k], a[q][k]) = (cosine * a[p][k] - sine * a[q][k], sine * a[p][k] + cosine * a[q][k]);
                }
                for row in &mut vectors {
                    (row[p], row[q]) = (cosine * row[p] - sine * row[q], sine * row[p] + cosine * row[q]);
                }
            }
        }
    }
    (std::array::from_fn(|k| a[k][k]), vectors)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvectors_reconstruct_the_matrix() {
        let matrix: [[f64; 4]; 4] =
            std::array::from_fn(|r| std::array::from_fn(|c| 1.0 / (1.0 + (r + c) as f64) + f64::from(r == c)));
        let (values, vectors) = eigen(matrix);
        for r in 0..4 {
            for c in 0..4 {
                let sum: f64 = (0..4).map(|k| vectors[r][k] * values[k] * vectors[c][k]).sum();
                assert!((sum - matrix[r][c]).abs() < 1e-14);
            }
        }
    }
}
