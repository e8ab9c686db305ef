//! The vector that a triangle R maps closest to zero, by inverse iteration.

use super::kernels::{normalise, squared_sine};
use super::{RowQr, Triangle};

/// Bound of the inverse iteration; each step gains the factor (σ_m / σ_{m−1})².
const MAX_STEPS: usize = 40;
/// The iteration ends when the unit vector moves by less than this.
const TOLERANCE: f64 = 1e-14;
/// A pivot below this share of the largest counts as zero; also the size of the regularisation of a null space of
/// dimension two or more.
const NEGLIGIBLE: f64 = 1e-14;

/// An (approximate) null vector of a triangle, that is of the matrix it was decomposed from.
#[derive(Clone, Debug)]
pub struct NullVector {
    /// Unit vector v.
    pub vector: Vec<f64>,
    /// |R v|: the smallest singular value where the iteration converged.
    pub residual: f64,
}

impl NullVector {
    /// The right singular vector of the smallest singular value of `triangle`.
    ///
    /// The iteration starts at the last unit vector: where the null space has several dimensions, this gives the projection of
    /// that unit vector, the null vector with the largest last entry. A zero matrix gives the last unit vector itself.
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

/// Inverse iteration with `solver`, residual with `triangle`.
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

/// R of `[R; δI]`: no direction is mapped below δ, so that solving with several zero pivots cannot overflow.
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
