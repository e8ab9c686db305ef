//! One affine motion A (eq. 1-5): the flow it gives a pixel, its residual on a measurement, changes of coordinates.

use serde::Serialize;

/// An affine motion `A = [a11 a12 a13; a21 a22 a23; 0 0 1]` of eq. (1): the pixel `(x, y)` of the first frame is displaced by
/// `u = a11·x + a12·y + a13`, `v = a21·x + a22·y + a23` pixels in the second.
///
/// Note that A is a *displacement*: the warp that carries the first frame onto the second is `x ↦ x + A x`.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize)]
#[serde(transparent)]
pub struct AffineMotion {
    /// `[a11, a12, a13, a21, a22, a23]`; the linear part per pixel, the translation in pixels.
    pub matrix: [f64; 6],
}

impl AffineMotion {
    /// No motion at all.
    pub const STATIC: AffineMotion = AffineMotion { matrix: [0.0; 6] };

    /// The motion with the six given entries, row by row.
    pub const fn new(matrix: [f64; 6]) -> Self {
        AffineMotion { matrix }
    }

    /// The same displacement `(u, v)` everywhere.
    pub const fn translation(u: f64, v: f64) -> Self {
        AffineMotion { matrix: [0.0, 0.0, u, 0.0, 0.0, v] }
    }

    /// Flow `(u, v)` of the pixel `(x, y)`: the first two entries of `A x` (eq. 1).
    #[inline]
    pub fn flow(&self, x: f64, y: f64) -> [f64; 2] {
        let a = &self.matrix;
        [a[0] * x + a[1] * y + a[2], a[3] * x + a[4] * y + a[5]]
    }

    /// Residual `yᵀ A x` of the affine constraint (eq. 5) on one measurement: position `(x, y)`, derivatives `(I_x, I_y, I_t)`.
    #[inline]
    pub fn residual(&self, position: [f64; 2], derivatives: [f64; 3]) -> f64 {
        let [u, v] = self.flow(position[0], position[1]);
        derivatives[0] * u + derivatives[1] * v + derivatives[2]
    }

    /// Distance of the derivatives to the plane `{y : yᵀ A x = 0}`: the residual over `|A x| = √(u² + v² + 1)`.
    #[inline]
    pub fn distance(&self, position: [f64; 2], derivatives: [f64; 3]) -> f64 {
        let [u, v] = self.flow(position[0], position[1]);
        (derivatives[0] * u + derivatives[1] * v + derivatives[2]) / (u * u + v * v + 1.0).sqrt()
    }

    /// The same motion where all lengths are `factor` times as many pixels.
    pub(crate) fn scaled(&self, factor: f64) -> AffineMotion {
        let a = &self.matrix;
        AffineMotion::new([a[0], a[1], a[2] * factor, a[3], a[4], a[5] * factor])
    }

    /// The same motion in coordinates `x' = (x − centre) / scale`, flow still in pixels of the old unit.
    pub fn in_normalised(&self, centre: [f64; 2], scale: f64) -> AffineMotion {
        let a = &self.matrix;
        let [u, v] = self.flow(centre[0], centre[1]);
        AffineMotion::new([a[0] * scale, a[1] * scale, u, a[3] * scale, a[4] * scale, v])
    }

    /// Inverse of [`in_normalised`](Self::in_normalised).
    pub fn from_normalised(&self, centre: [f64; 2], scale: f64) -> AffineMotion {
        let a = &self.matrix;
        let (b0, b1, b3, b4) = (a[0] / scale, a[1] / scale, a[3] / scale, a[4] / scale);
        AffineMotion::new([
            b0,
            b1,
            a[2] - b0 * centre[0] - b1 * centre[1],
            b3,
            b4,
            a[5] - b3 * centre[0] - b4 * centre[1],
        ])
    }

    /// Relative distance of two motions, `‖A − B‖ / ‖A‖` in the Frobenius norm of the 3×3 matrices: the error of eq. (20).
    pub fn relative_error(&self, estimate: &AffineMotion) -> f64 {
        let mut difference = 0.0;
        let mut norm = 1.0;
        for (a, b) in self.matrix.iter().zip(&estimate.matrix) {
            difference += (a - b) * (a - b);
            norm += a * a;
        }
        (difference / norm).sqrt()
    }

    /// Whether all six entries are finite.
    #[inline(never)]
    pub fn is_finite(&self) -> bool {
        self.matrix.iter().all(|a| a.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn change_of_coordinates_keeps_the_flow() {
        let a = AffineMotion::new([0.02, -0.01, 3.0, 0.005, 0.03, -1.5]);
        let (centre, scale) = ([160.0, 90.0], 200.0);
        let b = a.in_normalised(centre, scale);
        let [u, v] = a.flow(12.0, 77.0);
        let [p, q] = b.flow((12.0 - 160.0) / 200.0, (77.0 - 90.0) / 200.0);
        assert!((u - p).abs() < 1e-12 && (v - q).abs() < 1e-12);
        assert!(a.relative_error(&b.from_normalised(centre, scale)) < 1e-15);
    }
}
