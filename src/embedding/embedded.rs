//! The embedded data matrix P̃_n of (9): the dense matrix for small sizes, and the triangle R of its QR decomposition.

use nalgebra::DMatrix;

use super::monomials::{kept_pairs, unknowns};
use super::veronese::embed_columns;
use crate::linear::{RowQr, Triangle};
use crate::measurements::Measurements;

/// P̃_n of (9), N × (M_n² − Z_n): row j is `(ν_n(y_j) ⊗ ν_n(x_j))ᵀ` without the structural zeros of 𝒜.
///
/// ```
/// use veronese::Measurements;
/// use veronese::embedding::embedded_matrix;
///
/// // n = 1: (I_x, I_y, I_t) ⊗ (x, y, 1) without I_t x and I_t y.
/// let data = Measurements::new(vec![[2.0, 3.0]], vec![[5.0, 7.0, 11.0]])?;
/// assert_eq!(embedded_matrix(&data, 1).as_slice(), [10.0, 15.0, 5.0, 14.0, 21.0, 7.0, 11.0]);
/// # Ok::<(), veronese::Error>(())
/// ```
pub fn embedded_matrix(measurements: &Measurements, degree: usize) -> DMatrix<f64> {
    let values = embedded_columns(degree, &homogeneous(measurements.positions()), measurements.derivatives());
    DMatrix::from_vec(measurements.len(), unknowns(degree), values)
}

/// Positions (x, y) as (x, y, 1).
pub(super) fn homogeneous(positions: &[[f64; 2]]) -> Vec<[f64; 3]> {
    positions.iter().map(|p| [p[0], p[1], 1.0]).collect()
}

/// Rows of P̃_n for points x and derivatives y, column-major.
fn embedded_columns(degree: usize, x: &[[f64; 3]], y: &[[f64; 3]]) -> Vec<f64> {
    let (of_y, of_x) = (embed_columns(degree, y), embed_columns(degree, x));
    let rows = x.len();
    let mut block = Vec::with_capacity(rows * unknowns(degree));
    for (row, column) in kept_pairs(degree) {
        let y = &of_y[row * rows..(row + 1) * rows];
        let x = &of_x[column * rows..(column + 1) * rows];
        block.extend(y.iter().zip(x).map(|(a, b)| a * b));
    }
    block
}

/// The triangle R of the QR decomposition of P̃_n, with RᵀR = P̃_nᵀP̃_n.
///
/// The product P̃_nᵀP̃_n, which squares the condition number, is never formed.
///
/// ```
/// use veronese::Measurements;
/// use veronese::embedding::{EmbeddedData, embedded_matrix};
///
/// let positions = vec![[0.5, -1.0], [1.0, 0.25], [-0.75, 0.5], [0.0, 1.0]];
/// let derivatives = vec![[1.0, 0.5, 0.0], [0.0, 1.0, -1.0], [0.5, -0.5, 1.0], [1.0, 1.0, 0.5]];
/// let data = Measurements::new(positions, derivatives)?;
/// let r = EmbeddedData::new(&data, 1).triangle().to_matrix();
/// let p = embedded_matrix(&data, 1);
/// assert!((r.transpose() * r - p.transpose() * p).amax() < 1e-14);
/// # Ok::<(), veronese::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct EmbeddedData {
    degree: usize,
    triangle: Triangle,
}

impl EmbeddedData {
    /// Embeds all measurements and computes R: 2Nm² operations for N measurements and m = M_n² − Z_n columns.
    ///
    /// `measurements` should be normalised; `degree` is the number of motions n.
    pub fn new(measurements: &Measurements, degree: usize) -> Self {
        let mut qr = RowQr::new(unknowns(degree));
        let x = homogeneous(measurements.positions());
        for (x, y) in x.chunks(RowQr::BLOCK_ROWS).zip(measurements.derivatives().chunks(RowQr::BLOCK_ROWS)) {
            let mut block = embedded_columns(degree, x, y);
            qr.absorb(x.len(), &mut block);
        }
        EmbeddedData { degree, triangle: qr.into_triangle() }
    }

    /// The degree n.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The triangle R, m×m.
    pub fn triangle(&self) -> &Triangle {
        &self.triangle
    }

    /// Singular values of P̃_n, decreasing; `None` for n > 6, where they are too costly.
    pub fn singular_values(&self) -> Option<Vec<f64>> {
        self.triangle.singular_values()
    }

    /// Singular values of P̃_n with columns scaled to unit length, decreasing; `None` for n > 6.
    pub fn scaled_singular_values(&self) -> Option<Vec<f64>> {
        let mut triangle = self.triangle.clone();
        triangle.scale_columns();
        triangle.singular_values()
    }
}
