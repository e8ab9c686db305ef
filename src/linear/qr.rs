//! QR decomposition of a tall matrix that arrives in blocks of rows; only the triangle R is kept.
//!
//! A block B of rows is appended below the current R, and `[R; B]` is made triangular again by Householder reflectors `H = I − τ v vᵀ`.
//! Because R is triangular, v has a single entry outside B (a 1 in row k of R). The reflectors of [`PANEL`] columns at a time are combined
//! in the compact form `H_1⋯H_p = I − V T Vᵀ` (Schreiber and Van Loan, SIAM J. Sci. Stat. Comput. 10(1), 1989), so most of the work is
//! products of small matrices that stay in the cache. The cost is 2Nm² operations for N rows and m columns, and memory for R and one
//! block.
//!
//! R has the singular values of the whole matrix. The Gram matrix, which would square the condition number, is never formed.

use super::Triangle;
use super::kernels::{add_multiple, dot, dot_four_by_two, subtract_four_by_two};

/// Columns of a panel, a multiple of 4.
const PANEL: usize = 32;

/// A QR decomposition in progress: R of all rows absorbed so far. See the [module example](super).
#[derive(Clone, Debug)]
pub struct RowQr {
    triangle: Triangle,
}

/// The reflectors of a panel: its columns, and T of the compact form. V takes the place of the columns in the block.
struct Panel {
    /// First column of the panel.
    first: usize,
    /// Number of columns, at most [`PANEL`].
    width: usize,
    /// Upper triangle T, `t[i][k]` for i ≤ k.
    t: [[f64; PANEL]; PANEL],
}

impl RowQr {
    /// Recommended number of rows of a block: large enough to amortise the panels, small enough for the cache. Even.
    pub const BLOCK_ROWS: usize = 256;

    /// The decomposition of a matrix with the given number of columns and no rows.
    pub fn new(columns: usize) -> Self {
        RowQr { triangle: Triangle::zeros(columns) }
    }

    /// Appends rows. `block` is `rows` × columns, column-major, and is overwritten. It is cut or filled with zeros to that length.
    pub fn absorb(&mut self, rows: usize, block: &mut Vec<f64>) {
        let columns = self.triangle.size();
        block.resize(rows * columns, 0.0);
        if rows == 0 {
            return;
        }
        // The kernels process two rows at a time.
        if rows % 2 == 1 {
            let mut padded = Vec::with_capacity((rows + 1) * columns);
            for column in block.chunks_exact(rows) {
                padded.extend_from_slice(column);
                padded.push(0.0);
            }
            *block = padded;
        }
        let rows = rows + rows % 2;
        let mut first = 0;
        while first < columns {
            let width = PANEL.min(columns - first);
            let (head, trailing) = block.split_at_mut((first + width) * rows);
            let v = &mut head[first * rows..];
            let panel = self.factor_panel(first, width, rows, v);
            self.update_trailing(&panel, rows, v, trailing);
            first += width;
        }
    }

    /// The triangle R of all rows.
    pub fn into_triangle(self) -> Triangle {
        self.triangle
    }

    /// The reflectors that eliminate the panel's columns of the block. `v` holds these columns and is overwritten by V.
    fn factor_panel(&mut self, first: usize, width: usize, rows: usize, v: &mut [f64]) -> Panel {
        let mut panel = Panel { first, width, t: [[0.0; PANEL]; PANEL] };
        for k in 0..width {
            let (left, right) = v.split_at_mut((k + 1) * rows);
            let (done, column) = left.split_at_mut(k * rows);
            let diagonal = self.triangle.at(first + k, first + k);
            let (tau, beta) = reflector(diagonal, column);
            self.triangle.set(first + k, first + k, beta);
            for (j, other) in right.chunks_exact_mut(rows).enumerate() {
                let place = (first + k, first + k + 1 + j);
                let w = tau * (self.triangle.at(place.0, place.1) + dot(column, other));
                self.triangle.set(place.0, place.1, self.triangle.at(place.0, place.1) - w);
                add_multiple(other, -w, column);
            }
            // The new column of T is −τ T (Vᵀ v). In R, the reflectors are different unit vectors, so these contribute nothing to Vᵀ v.
            let mut products = [0.0; PANEL];
            for (i, earlier) in done.chunks_exact(rows).enumerate() {
                products[i] = dot(earlier, column);
            }
            for i in 0..k {
                panel.t[i][k] = -tau * dot(&panel.t[i][i..k], &products[i..k]);
            }
            panel.t[k][k] = tau;
        }
        panel
    }

    /// Applies the panel's reflectors to the columns right of it: `W = Tᵀ(R + VᵀB)`, `R ← R − W`, `B ← B − V W`.
    fn update_trailing(&mut self, panel: &Panel, rows: usize, v: &[f64], trailing: &mut [f64]) {
        let start = panel.first + panel.width;
        for (pair, columns) in trailing.chunks_mut(2 * rows).enumerate() {
            let place = start + 2 * pair;
            if columns.len() == 2 * rows && panel.width == PANEL {
                self.update_two(panel, rows, v, columns, place);
            } else {
                for (j, column) in columns.chunks_exact_mut(rows).enumerate() {
                    self.update_one(panel, rows, v, column, place + j);
                }
            }
        }
    }

    /// The update of two columns by a panel of full width, which takes most of the time.
    fn update_two(&mut self, panel: &Panel, rows: usize, v: &[f64], columns: &mut [f64], place: usize) {
        let v = v.as_chunks::<2>().0;
        let half = rows / 2;
        let quad = |i: usize| [0, 1, 2, 3].map(|k| &v[(i + k) * half..(i + k + 1) * half]);
        let (p, q) = columns.as_chunks_mut::<2>().0.split_at_mut(half);
        let mut sums = [[0.0; 2]; PANEL];
        for i in (0..PANEL).step_by(4) {
            sums[i..i + 4].copy_from_slice(&dot_four_by_two(quad(i), [p, q]));
        }
        for j in 0..2 {
            let r = self.triangle.column_part_mut(place + j, panel.first, PANEL);
            let mut w = [0.0; PANEL];
            for i in 0..PANEL {
                sums[i][j] += r[i];
                for k in i..PANEL {
                    w[k] += panel.t[i][k] * sums[i][j];
                }
            }
            for i in 0..PANEL {
                r[i] -= w[i];
                sums[i][j] = w[i];
            }
        }
        for i in (0..PANEL).step_by(4) {
            subtract_four_by_two([p, q], quad(i), [sums[i], sums[i + 1], sums[i + 2], sums[i + 3]]);
        }
    }

    /// The update of one column.
    fn update_one(&mut self, panel: &Panel, rows: usize, v: &[f64], column: &mut [f64], place: usize) {
        let r = self.triangle.column_part_mut(place, panel.first, panel.width);
        let mut w = [0.0; PANEL];
        for (i, reflector) in v.chunks_exact(rows).enumerate() {
            let sum = r[i] + dot(reflector, column);
            for k in i..panel.width {
                w[k] += panel.t[i][k] * sum;
            }
        }
        for (i, reflector) in v.chunks_exact(rows).enumerate() {
            r[i] -= w[i];
            add_multiple(column, -w[i], reflector);
        }
    }
}

/// The reflector that maps `(diagonal, column)` to `(β, 0)`. Returns τ and β; `column` is overwritten by v without its leading 1.
fn reflector(diagonal: f64, column: &mut [f64]) -> (f64, f64) {
    let below = dot(column, column);
    if below == 0.0 {
        return (0.0, diagonal);
    }
    // The sign of β is opposite to that of the diagonal entry, which avoids cancellation.
    let length = (diagonal * diagonal + below).sqrt();
    let beta = if diagonal > 0.0 { -length } else { length };
    let scale = 1.0 / (diagonal - beta);
    for value in column.iter_mut() {
        *value *= scale;
    }
    ((beta - diagonal) / beta, beta)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use nalgebra::DMatrix;

    /// RᵀR = AᵀA, for sizes around all block boundaries.
    #[test]
    fn the_triangle_has_the_gram_matrix_of_the_rows() {
        let mut random = Random::from_seed(3);
        for (rows, columns) in [(1, 1), (7, 3), (40, 31), (33, 32), (97, 33), (300, 70), (20, 70), (513, 101)] {
            let a = DMatrix::from_fn(rows, columns, |_, _| random.uniform(-1.0, 1.0));
            let mut qr = RowQr::new(columns);
            for start in (0..rows).step_by(RowQr::BLOCK_ROWS) {
                let count = RowQr::BLOCK_ROWS.min(rows - start);
                let mut block = a.rows(start, count).clone_owned().as_slice().to_vec();
                qr.absorb(count, &mut block);
            }
            let r = qr.into_triangle().to_matrix();
            assert!((r.transpose() * &r - a.transpose() * &a).amax() < 1e-12 * rows as f64, "{rows}×{columns}");
        }
    }
}
