//! The embedded data matrix P̃_n of (9), as a whole for small sizes, and reduced to the triangle R of its QR decomposition.

use nalgebra::DMatrix;

use super::monomials::{kept_pairs, unknowns};
use super::veronese::embed_columns;
use crate::linear::{RowQr, Triangle};
use crate::measurements::Measurements;
use crate::workspace::Buffer;

/// P̃_n of (9): row j is `(ν_n(y_j) ⊗ ν_n(x_j))ᵀ` without the entries that vanish by structure, N × (M_n² − Z_n).
pub fn embedded_matrix(measurements: &Measurements, degree: usize) -> DMatrix<f64> {
    let values = embedded_columns(degree, &homogeneous(measurements.positions()), measurements.derivatives());
    DMatrix::from_vec(measurements.len(), unknowns(degree), values)
}

/// Pixels (x, y) as (x, y, 1).
pub(super) fn homogeneous(positions: &[[f64; 2]]) -> Buffer<[f64; 3]> {
    positions.iter().map(|p| [p[0], p[1], 1.0]).collect()
}

/// Rows of P̃_n, column-major.
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

/// All that the linear step needs of P̃_n: the triangle R with RᵀR = P̃_nᵀP̃_n, never that product itself.
#[derive(Clone, Debug)]
pub struct EmbeddedData {
    degree: usize,
    triangle: Triangle,
}

impl EmbeddedData {
    /// Embeds all measurements and reduces them, 2Nm² operations for N rows and m = M_n² − Z_n columns.
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

    /// Singular values of P̃_n, decreasing (`None` where the size makes them too costly, n > 6).
    pub fn singular_values(&self) -> Option<Vec<f64>> {
        self.triangle.singular_values()
    }

    /// Singular values of P̃_n with its columns scaled to unit length, decreasing (`None` for n > 6).
    pub fn scaled_singular_values(&self) -> Option<Vec<f64>> {
        let mut triangle = self.triangle.clone();
        triangle.scale_columns();
        triangle.singular_values()
    }
}
