//! Gram matrices of the embedded data from moments.
//!
//! An entry of the Gram matrix P̃_nᵀ W P̃_n is `Σ_j w_j y_j^(a+b) x_j^(i+k)`, which depends only on the sums of the exponents of its row
//! and its column. The entries are therefore moments of degree 2n, of which there are as many as P̃_2n has columns: 25, 140, 462 for
//! n = 1, 2, 3, instead of 28, 325, 2145 products of columns. Gram matrices of derivatives of P̃_n consist of moments too.
//!
//! **Pitfall.** A Gram matrix squares the condition number. Use it only in normalised coordinates, and for a starting point rather than
//! a result. [`EmbeddedData`](super::EmbeddedData) avoids it.

use super::embedded::homogeneous;
use super::monomials::{Exponents, count, exponents, index, kept_pairs, unknowns};
use super::multibody::MultibodyMotion;
use super::veronese::embed_columns;
use crate::linear::Triangle;
use crate::linear::kernels::{add_multiple, dot};
use crate::measurements::Measurements;

/// Share of its diagonal that is added to a Gram matrix; smaller squares are lost in rounding. Among several null vectors, this chooses
/// the one with the largest last entry, like [`NullVector`](crate::linear::NullVector).
const RIDGE: f64 = 1e-13;

/// `Σ_j w_j y_j^a x_j^i` for all monomials of given degrees.
struct Moments {
    columns: usize,
    values: Vec<f64>,
}

impl Moments {
    /// From the monomials of y and of x, with one weight per measurement. Structural zeros of 𝒜 (a power of z below that of I_t) are
    /// skipped.
    fn new([of_y, of_x]: [&Monomials; 2], weights: &[f64]) -> Self {
        let columns = count(of_x.degree);
        let mut values = vec![0.0; count(of_y.degree) * columns];
        let mut weighted = vec![0.0; weights.len()];
        let x_exponents = exponents(of_x.degree);
        for ((y, e), values) in of_y.columns().zip(exponents(of_y.degree)).zip(values.chunks_exact_mut(columns)) {
            weighted.iter_mut().zip(y).zip(weights).for_each(|((product, y), w)| *product = y * w);
            for ((x, f), value) in of_x.columns().zip(&x_exponents).zip(values) {
                if f[2] >= e[2] {
                    *value = dot(&weighted, x);
                }
            }
        }
        Moments { columns, values }
    }

    fn at(&self, y: Exponents, x: Exponents) -> f64 {
        self.values[index(y) * self.columns + index(x)]
    }
}

fn sum(a: Exponents, b: Exponents) -> Exponents {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// A symmetric matrix over the kept pairs of monomials, column-major; `entry` gives the entry of two pairs `(y, x)`.
fn symmetric(degree: usize, entry: impl Fn([Exponents; 2], [Exponents; 2]) -> f64) -> Vec<f64> {
    let all = exponents(degree);
    let pairs: Vec<[Exponents; 2]> =
        kept_pairs(degree).into_iter().map(|(row, column)| [all[row], all[column]]).collect();
    let size = pairs.len();
    let mut matrix = vec![0.0; size * size];
    for (k, &p) in pairs.iter().enumerate() {
        for (i, &q) in pairs[..=k].iter().enumerate() {
            let value = entry(q, p);
            (matrix[k * size + i], matrix[i * size + k]) = (value, value);
        }
    }
    matrix
}

/// All monomials of one degree at many points, column-major with [`count`] columns.
struct Monomials {
    degree: usize,
    rows: usize,
    values: Vec<f64>,
}

impl Monomials {
    fn new(degree: usize, points: &[[f64; 3]]) -> Self {
        Monomials { degree, rows: points.len(), values: embed_columns(degree, points) }
    }

    fn column(&self, monomial: Exponents) -> &[f64] {
        &self.values[index(monomial) * self.rows..][..self.rows]
    }

    fn columns(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks_exact(self.rows.max(1))
    }
}

/// Σ_k D_kᵀD_k of the derivatives D_k = ∂P̃_n/∂y_k, k = 1, 2, 3, column-major.
pub(super) fn gradient_gram(measurements: &Measurements, degree: usize) -> Vec<f64> {
    let of_y = Monomials::new(2 * (degree - 1), measurements.derivatives());
    let of_x = Monomials::new(2 * degree, &homogeneous(measurements.positions()));
    let moments = Moments::new([&of_y, &of_x], &vec![1.0; measurements.len()]);
    symmetric(degree, |[a, i], [b, k]| {
        let both = sum(a, b);
        let by = |v: usize| {
            let mut lowered = both;
            lowered[v] -= 2;
            (a[v] * b[v]) as f64 * moments.at(lowered, sum(i, k))
        };
        (0..3).filter(|&v| a[v] > 0 && b[v] > 0).map(by).sum()
    })
}

/// Measurements prepared for repeated fits of polynomials of one degree with different weights.
pub(crate) struct Refitting {
    degree: usize,
    derivatives: [Vec<f64>; 3],
    /// Monomials of the derivatives, of degrees n − 1 and 2n.
    of_y: [Monomials; 2],
    /// Monomials of the positions, of degree 2n. They include lower degrees, because the third coordinate is 1.
    of_x: Monomials,
}

/// A polynomial at one measurement: its value, and its gradient ∂p/∂y.
pub(crate) type Reading = [f64; 4];

impl Refitting {
    /// `measurements` should be normalised.
    pub(crate) fn new(measurements: &Measurements, degree: usize) -> Self {
        let y = measurements.derivatives();
        Refitting {
            degree,
            derivatives: [0, 1, 2].map(|k| y.iter().map(|y| y[k]).collect()),
            of_y: [Monomials::new(degree - 1, y), Monomials::new(2 * degree, y)],
            of_x: Monomials::new(2 * degree, &homogeneous(measurements.positions())),
        }
    }

    /// The multibody motion that minimises `Σ_j w_j p(x_j, y_j)²`.
    pub(crate) fn fit(&self, weights: &[f64]) -> MultibodyMotion {
        let moments = Moments::new([&self.of_y[1], &self.of_x], weights);
        let gram = symmetric(self.degree, |[a, i], [b, k]| moments.at(sum(a, b), sum(i, k)));
        MultibodyMotion::from_triangle(self.degree, Triangle::of_gram(unknowns(self.degree), gram, RIDGE))
    }

    /// The polynomial and its gradient ∂p/∂y at every measurement.
    pub(crate) fn read(&self, polynomial: &MultibodyMotion) -> Vec<Reading> {
        let rows = self.of_x.rows;
        let mut gradient = [0, 1, 2].map(|_| vec![0.0; rows]);
        let mut flow = vec![0.0; rows];
        let all = exponents(self.degree);
        for (r, &y) in all.iter().enumerate() {
            // Entry r of the multibody flow 𝒜 ν_n(x).
            flow.fill(0.0);
            for (c, &[i, k, l]) in all.iter().enumerate() {
                if l >= y[2] {
                    add_multiple(&mut flow, polynomial.matrix()[(r, c)], self.of_x.column([i, k, l + self.degree]));
                }
            }
            for (v, sums) in gradient.iter_mut().enumerate().filter(|&(v, _)| y[v] > 0) {
                let mut lowered = y;
                lowered[v] -= 1;
                let monomial = self.of_y[0].column(lowered).iter();
                sums.iter_mut().zip(monomial).zip(&flow).for_each(|((s, m), f)| *s += y[v] as f64 * m * f);
            }
        }
        let of = |j: usize| {
            let g = [0, 1, 2].map(|v| gradient[v][j]);
            // Euler: a form p of degree n in y is yᵀ(∂p/∂y) / n.
            let value: f64 = (0..3).map(|v| self.derivatives[v][j] * g[v]).sum();
            [value / self.degree as f64, g[0], g[1], g[2]]
        };
        (0..rows).map(of).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::embedding::{EmbeddedData, embedded_matrix};
    use crate::motion::AffineMotion;
    use crate::random::Random;

    /// Noisy measurements of `degree` motions.
    fn some(degree: usize) -> Measurements {
        let mut random = Random::from_seed(5);
        let motions: Vec<AffineMotion> =
            (0..degree).map(|_| AffineMotion::new([0; 6].map(|_| random.uniform(-1.0, 1.0)))).collect();
        let (mut positions, mut derivatives) = (Vec::new(), Vec::new());
        for j in 0..200 {
            let [x, y, p, q] = [0; 4].map(|_| random.uniform(-1.0, 1.0));
            let [u, v] = motions[j % degree].flow(x, y);
            positions.push([x, y]);
            derivatives.push([p, q, random.uniform(-0.01, 0.01) - p * u - q * v]);
        }
        Measurements::new(positions, derivatives).unwrap()
    }

    #[test]
    fn the_gram_matrix_from_moments_is_that_of_the_embedded_matrix() {
        for degree in 1..=3 {
            let data = some(degree);
            let weights: Vec<f64> = (0..200).map(|j| 1.0 + f64::from(j % 7)).collect();
            let rows = embedded_matrix(&data, degree);
            let weighted = nalgebra::DMatrix::from_diagonal(&nalgebra::DVector::from_column_slice(&weights)) * &rows;
            let expected = rows.transpose() * weighted;
            let fitting = Refitting::new(&data, degree);
            let moments = Moments::new([&fitting.of_y[1], &fitting.of_x], &weights);
            let gram = symmetric(degree, |[a, i], [b, k]| moments.at(sum(a, b), sum(i, k)));
            for (found, expected) in gram.iter().zip(expected.iter()) {
                assert!((found - expected).abs() < 1e-10, "degree {degree}: {found} for {expected}");
            }
        }
    }

    #[test]
    fn readings_are_values_and_gradients() {
        for degree in 1..=3 {
            let data = some(degree);
            let fitting = Refitting::new(&data, degree);
            let polynomial = fitting.fit(&[1.0; 200]);
            let by_triangle = MultibodyMotion::from_embedded(&EmbeddedData::new(&data, degree));
            let difference = (polynomial.matrix() - by_triangle.matrix()).amax();
            assert!(difference < 1e-9, "degree {degree}: {difference:e}");
            for (&[value, ref gradient @ ..], ([x, y], derivatives)) in
                fitting.read(&polynomial).iter().zip(data.iter())
            {
                let x = [x, y, 1.0];
                assert!((value - polynomial.evaluate(x, derivatives)).abs() < 1e-12);
                for (found, expected) in gradient.iter().zip(polynomial.gradient_y(x, derivatives)) {
                    assert!((found - expected).abs() < 1e-12);
                }
            }
        }
    }
}
