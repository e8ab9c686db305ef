//! The Veronese map of points, and the polynomial that vanishes on them (eq. 7).

use crate::{MOST, within};
use veronese::embedding::monomials::{Exponents, count, exponents};
use veronese::embedding::rank::{KAPPA, numerical_rank};
use veronese::embedding::veronese::embed;
use veronese::factorisation::roots::roots;
use veronese::linear::{NullVector, RowQr, Triangle};
use veronese::{Error, Result};

/// Largest degree.
const LARGEST_DEGREE: usize = 6;
/// Residuals below this share of the largest singular value are rounding.
const ROUNDING: f64 = 1e-12;
/// Largest absolute value of a coordinate.
const LARGEST: f64 = 1e12;

/// The result of [`veronese_map`].
#[derive(Clone, Debug)]
pub struct VeroneseMap {
    /// The powers of the variables in each monomial, in the paper's order. Those of a third variable are 0 if there are two.
    pub exponents: Vec<Exponents>,
    /// The embedded points, row by row: one row per point, one column per monomial.
    pub matrix: Vec<f64>,
    /// Number of points.
    pub rows: usize,
    /// Number of monomials: n + 1 of two variables, (n + 1)(n + 2)/2 of three.
    pub columns: usize,
    /// Singular values of the matrix, decreasing, as many as there are columns: with fewer rows the last are 0.
    pub singular_values: Vec<f64>,
    /// Its rank by the paper's footnote 4, with [`KAPPA`].
    pub rank: usize,
    /// The right singular vector of the smallest singular value, of length 1: the coefficients of the polynomial that vanishes on the
    /// points, up to sign. If there are several, one of them.
    pub null_vector: Vec<f64>,
    /// With two variables: the lines through the origin on which the polynomial vanishes, as unit normals (a, b) of a x + b y = 0.
    pub lines: Vec<[f64; 2]>,
    /// The number of factors that are no real lines, in conjugate pairs.
    pub complex: usize,
}

/// The Veronese map of degree n = `degree`, 1 to 6, of points with two or three coordinates each.
///
/// Points on n lines through the origin of the plane, or on n planes through that of space, satisfy one equation of degree n: the product
/// of those of the lines. It is found before any point is assigned to a line.
///
/// # Errors
/// [`Error::InvalidOption`] for `variables`, `degree` or a number of `points` out of range; [`Error::NotFinite`].
pub fn veronese_map(points: &[f64], variables: usize, degree: usize) -> Result<VeroneseMap> {
    within("variables", variables, [2, 3])?;
    within("degree", degree, [1, LARGEST_DEGREE])?;
    if !points.len().is_multiple_of(variables) {
        let reason = format!("must hold {variables} numbers each, found {}", points.len());
        return Err(Error::InvalidOption { name: "points", reason });
    }
    let rows = points.len() / variables;
    if rows == 0 || rows > MOST {
        let reason = format!("must be 1 to {MOST} in number, not {rows}");
        return Err(Error::InvalidOption { name: "points", reason });
    }
    let usable = |value: &f64| value.is_finite() && value.abs() <= LARGEST;
    if let Some(index) = points.iter().position(|value| !usable(value)) {
        return Err(Error::NotFinite { what: "point", index: index / variables });
    }
    let homogeneous: Vec<[f64; 3]> = points
        .chunks_exact(variables)
        .map(|point| [point[0], point[1], point.get(2).copied().unwrap_or(0.0)])
        .collect();
    // A form in two variables is one in three without the third.
    let of_variables = |(powers, _): &(Exponents, Vec<f64>)| variables == 3 || powers[2] == 0;
    let all = exponents(degree).into_iter().zip(columns_of(degree, &homogeneous));
    let (exponents, columns): (Vec<Exponents>, Vec<Vec<f64>>) = all.filter(of_variables).unzip();
    let triangle = triangle_of(&columns);
    let singular_values = triangle.singular_values().unwrap_or_default();
    let null_vector = null_vector(&triangle, singular_values.first().copied().unwrap_or(0.0));
    let (lines, complex) = if variables == 2 { lines(&null_vector) } else { (Vec::new(), 0) };
    Ok(VeroneseMap {
        exponents,
        matrix: (0..rows).flat_map(|row| columns.iter().map(move |column| column[row])).collect(),
        rows,
        columns: columns.len(),
        rank: numerical_rank(&singular_values, KAPPA),
        singular_values,
        null_vector,
        lines,
        complex,
    })
}

/// Embedded vectors as columns, one for each monomial.
pub(crate) fn columns_of(degree: usize, vectors: &[[f64; 3]]) -> Vec<Vec<f64>> {
    let rows: Vec<_> = vectors.iter().map(|&vector| embed(degree, vector)).collect();
    (0..count(degree)).map(|k| rows.iter().map(|row| row[k]).collect()).collect()
}

/// The triangle R of a matrix that is given by its columns.
pub(crate) fn triangle_of(columns: &[Vec<f64>]) -> Triangle {
    let rows = columns[0].len();
    let mut qr = RowQr::new(columns.len());
    for first in (0..rows).step_by(RowQr::BLOCK_ROWS) {
        let part = first..rows.min(first + RowQr::BLOCK_ROWS);
        let mut block: Vec<f64> = columns.iter().flat_map(|column| column[part.clone()].iter().copied()).collect();
        qr.absorb(part.len(), &mut block);
    }
    qr.into_triangle()
}

/// The right singular vector of the smallest singular value of a triangle.
///
/// [`NullVector`] starts at the last unit vector and never leaves its complement where entries are exactly 0, as for points on the line
/// x = 0. So every column takes its turn as the last one; another than the last itself is taken if that makes the residual smaller.
fn null_vector(triangle: &Triangle, largest: f64) -> Vec<f64> {
    let (size, matrix) = (triangle.size(), triangle.to_matrix());
    let rounding = ROUNDING * largest;
    let mut best = NullVector::of(triangle);
    for turn in 0..size - 1 {
        let order: Vec<usize> = (0..size).filter(|&k| k != turn).chain([turn]).collect();
        let columns: Vec<Vec<f64>> = order.iter().map(|&k| matrix.column(k).iter().copied().collect()).collect();
        let found = NullVector::of(&triangle_of(&columns));
        if found.residual.max(rounding) < 0.5 * best.residual {
            let mut vector = vec![0.0; size];
            order.iter().zip(&found.vector).for_each(|(&k, value)| vector[k] = *value);
            best = NullVector { vector, residual: found.residual };
        }
    }
    best.vector
}

/// The normals of the real lines on which the form `c[0] xⁿ + c[1] xⁿ⁻¹y + … + c[n] yⁿ` vanishes, and the number of its other factors.
pub(crate) fn lines(c: &[f64]) -> (Vec<[f64; 2]>, usize) {
    // With y = 1, a root x = r gives the factor x − r y, and a root at infinity the factor y.
    let ascending: Vec<f64> = c.iter().rev().copied().collect();
    let found = roots(&ascending);
    let real = found.finite.iter().filter(|root| root.im == 0.0).map(|root| {
        let length = (1.0 + root.re * root.re).sqrt();
        [1.0 / length, -root.re / length]
    });
    let lines: Vec<[f64; 2]> = real.chain(std::iter::repeat_n([0.0, 1.0], found.infinite)).collect();
    let complex = found.finite.iter().filter(|root| root.im != 0.0).count();
    (lines, complex)
}
