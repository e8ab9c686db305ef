//! An affine motion A (eq. 1–5): its flow at a pixel, its residual on a measurement, changes of coordinates.

use serde::Serialize;

/// An affine motion `A = [a11 a12 a13; a21 a22 a23; 0 0 1]` of eq. (1): the pixel `(x, y)` of the first frame is displaced by
/// `u = a11·x + a12·y + a13`, `v = a21·x + a22·y + a23` pixels in the second.
///
/// A is a *displacement*: the warp from the first frame to the second is `x ↦ x + A x`, and no motion is all zeros.
///
/// ```
/// use veronese::AffineMotion;
///
/// // A zoom by 1 % about the pixel (100, 50).
/// let zoom = AffineMotion::new([0.01, 0.0, -1.0, 0.0, 0.01, -0.5]);
/// assert_eq!(zoom.flow(100.0, 50.0), [0.0, 0.0]);
/// assert_eq!(zoom.flow(200.0, 50.0), [1.0, 0.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize)]
#[serde(transparent)]
pub struct AffineMotion {
    /// `[a11, a12, a13, a21, a22, a23]`; the translation (a13, a23) in pixels, the linear part dimensionless.
    pub matrix: [f64; 6],
}

impl AffineMotion {
    /// Zero displacement everywhere.
    pub const STATIC: AffineMotion = AffineMotion { matrix: [0.0; 6] };

    /// The motion with the six given entries, in row-major order.
    pub const fn new(matrix: [f64; 6]) -> Self {
        AffineMotion { matrix }
    }

    /// The same displacement `(u, v)` everywhere, pixels.
    ///
    /// ```
    /// use veronese::AffineMotion;
    ///
    /// assert_eq!(AffineMotion::translation(2.0, -1.0).flow(17.0, 4.0), [2.0, -1.0]);
    /// ```
    pub const fn translation(u: f64, v: f64) -> Self {
        AffineMotion { matrix: [0.0, 0.0, u, 0.0, 0.0, v] }
    }

    /// The flow `(u, v)` at the pixel `(x, y)`, pixels: the first two entries of `A x` (eq. 1).
    #[inline]
    pub fn flow(&self, x: f64, y: f64) -> [f64; 2] {
        let a = &self.matrix;
        [a[0] * x + a[1] * y + a[2], a[3] * x + a[4] * y + a[5]]
    }

    /// The residual `yᵀ A x` of the affine constraint (eq. 5) on one measurement: position `(x, y)`, derivatives `(I_x, I_y, I_t)`. It
    /// has the unit of the derivatives.
    ///
    /// ```
    /// use veronese::AffineMotion;
    ///
    /// let motion = AffineMotion::translation(2.0, -1.0);
    /// let (ix, iy) = (3.0, 4.0);
    /// let it = -(ix * 2.0 + iy * -1.0); // brightness constancy, eq. 3
    /// assert_eq!(motion.residual([17.0, 4.0], [ix, iy, it]), 0.0);
    /// assert_eq!(AffineMotion::STATIC.residual([17.0, 4.0], [ix, iy, it]), it);
    /// ```
    #[inline]
    pub fn residual(&self, position: [f64; 2], derivatives: [f64; 3]) -> f64 {
        let [u, v] = self.flow(position[0], position[1]);
        derivatives[0] * u + derivatives[1] * v + derivatives[2]
    }

    /// The signed distance of the derivatives from the plane `{y : yᵀ A x = 0}`: the residual divided by `|A x| = √(u² + v² + 1)`.
    ///
    /// ```
    /// use veronese::AffineMotion;
    ///
    /// let motion = AffineMotion::translation(2.0, 2.0); // |A x| = 3
    /// assert_eq!(motion.distance([0.0, 0.0], [1.0, 0.5, 0.0]), 1.0);
    /// ```
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

    /// The displacement that undoes the motion: `(I + A)⁻¹ − I`; `None` if the motion is singular.
    #[inline(never)]
    pub(crate) fn inverse(&self) -> Option<AffineMotion> {
        let a = &self.matrix;
        let (p, q, r, s) = (1.0 + a[0], a[1], a[3], 1.0 + a[4]);
        let determinant = p * s - q * r;
        if determinant.abs() < 1e-6 {
            return None;
        }
        let (ip, iq, ir, is) = (s / determinant, -q / determinant, -r / determinant, p / determinant);
        Some(AffineMotion::new([ip - 1.0, iq, -(ip * a[2] + iq * a[5]), ir, is - 1.0, -(ir * a[2] + is * a[5])]))
    }

    /// The same motion in coordinates `x' = (x − centre) / scale`. The flow keeps its unit.
    ///
    /// ```
    /// use veronese::AffineMotion;
    ///
    /// let motion = AffineMotion::new([0.02, -0.01, 3.0, 0.0, 0.03, -1.5]);
    /// let normalised = motion.in_normalised([160.0, 120.0], 160.0);
    /// let ([u, v], [p, q]) = (motion.flow(320.0, 120.0), normalised.flow(1.0, 0.0));
    /// assert!((u - p).abs() < 1e-12 && (v - q).abs() < 1e-12);
    /// assert!(motion.relative_error(&normalised.from_normalised([160.0, 120.0], 160.0)) < 1e-15);
    /// ```
    pub fn in_normalised(&self, centre: [f64; 2], scale: f64) -> AffineMotion {
        let a = &self.matrix;
        let [u, v] = self.flow(centre[0], centre[1]);
        AffineMotion::new([a[0] * scale, a[1] * scale, u, a[3] * scale, a[4] * scale, v])
    }

    /// The inverse of [`in_normalised`](Self::in_normalised).
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

    /// The relative error of an estimate B of this motion A, `‖A − B‖ / ‖A‖` in the Frobenius norm of the 3×3 matrices (eq. 20).
    ///
    /// ```
    /// use veronese::AffineMotion;
    ///
    /// let truth = AffineMotion::STATIC; // its matrix has norm 1
    /// assert_eq!(truth.relative_error(&AffineMotion::translation(0.3, 0.4)), 0.5);
    /// ```
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

    #[test]
    fn the_inverse_motion_leads_back() {
        let a = AffineMotion::new([0.03, -0.02, 4.0, 0.01, 0.05, -2.0]);
        let back = a.inverse().unwrap();
        let [u, v] = a.flow(13.0, 40.0);
        let [p, q] = back.flow(13.0 + u, 40.0 + v);
        assert!((u + p).abs() < 1e-12 && (v + q).abs() < 1e-12);
        assert!(AffineMotion::new([-1.0, 0.0, 0.0, 0.0, -1.0, 0.0]).inverse().is_none());
    }
}
