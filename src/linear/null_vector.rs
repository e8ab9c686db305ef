//! The right singular vector of the smallest singular value of a triangle, by inverse iteration.

use super::kernels::{normalise, squared_sine};
use super::{RowQr, Triangle};

/// Maximum number of inverse iterations. Each reduces the error by the factor (σ_m / σ_{m−1})².
const MAX_STEPS: usize = 40;
/// The iteration ends when the unit vector changes by less than this.
const TOLERANCE: f64 = 1e-14;
/// Pivots below this share of the largest count as zero. A null space of two or more dimensions is regularised by as much.
const NEGLIGIBLE: f64 = 1e-14;

/// An (approximate) null vector of a triangle R, and of the matrix of which R is the QR factor. See the [module example](super).
#[derive(Clone, Debug)]
pub struct NullVector {
    /// Unit vector v.
    pub vector: Vec<f64>,
    /// |R v|, the smallest singular value if the iteration has converged.
    pub residual: f64,
}

impl NullVector {
    /// The right singular vector of the smallest singular value of `triangle`.
    ///
    /// The iteration starts at the last unit vector. If the null space has several dimensions, the result is the projection of that
    /// vector onto it, scaled to unit length: the null vector with the largest last entry. A zero matrix gives the last unit vector.
    pub fn of(triangle: &Triangle) -> NullVector {
        let largest = triangle.largest_pivot();
        let negligible = triangle.pivots().filter(|&p| p <= NEGLIGIBLE * largest).count();
        if negligible > 1 {
            let regular = regularised(triangle, NEGLIGIBLE * largest);
            return iterate(&regular, triangle, NEGLIGIBLE * largest);
        }
        iterate(triangle, triangle, f64::EPSILON * largest)
    }
}

/// Inverse iteration on `solver`; the residual is that of `triangle`.
fn iterate(solver: &Triangle, triangle: &Triangle, floor: f64) -> NullVector {
    let size = triangle.size();
    let mut vector = vec![0.0; size];
    if let Some(last) = vector.last_mut() {
        *last = 1.0;
    }
    if floor > 0.0 {
        for _ in 0..MAX_STEPS {
            let mut next = vector.clone();
            solver.solve_normal(&mut next, floor);
            if !normalise(&mut next) {
                break;
            }
            let moved = squared_sine(&next, &vector);
            vector = next;
            if moved < TOLERANCE * TOLERANCE {
                break;
            }
        }
    }
    let residual = triangle.image_length(&vector);
    NullVector { vector, residual }
}

/// The triangle of `[R; δI]`. No singular value is below δ, so solving with several zero pivots cannot overflow.
fn regularised(triangle: &Triangle, delta: f64) -> Triangle {
    let size = triangle.size();
    let mut qr = RowQr::new(size);
    for first in (0..2 * size).step_by(RowQr::BLOCK_ROWS) {
        let rows = RowQr::BLOCK_ROWS.min(2 * size - first);
        let mut block = Vec::with_capacity(rows * size);
        for column in 0..size {
            block.extend((first..first + rows).map(|row| match row.checked_sub(size) {
                None => triangle.at(row, column),
                Some(row) if row == column => delta,
                Some(_) => 0.0,
            }));
        }
        qr.absorb(rows, &mut block);
    }
    qr.into_triangle()
}
