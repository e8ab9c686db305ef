//! Affine maps of the plane: where an object is at one time, as seen from another.

use veronese::AffineMotion;

/// `[a, b, c, d, e, f]` takes (x, y) to (a x + b y + c, d x + e y + f).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Warp(pub(super) [f64; 6]);

impl Warp {
    pub(super) const IDENTITY: Warp = Warp([1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);

    /// x ↦ x + A x.
    pub(super) fn of(motion: &AffineMotion) -> Warp {
        let a = &motion.matrix;
        Warp([1.0 + a[0], a[1], a[2], a[3], 1.0 + a[4], a[5]])
    }

    /// Turns the origin by `angle` radians, from x to y, magnifies it and takes it to `place`.
    pub(super) fn similarity(place: [f64; 2], angle: f64, scale: f64) -> Warp {
        let (c, s) = (scale * libm::cos(angle), scale * libm::sin(angle));
        Warp([c, -s, place[0], s, c, place[1]])
    }

    #[inline]
    pub(super) fn at(&self, x: f64, y: f64) -> [f64; 2] {
        let [a, b, c, d, e, f] = self.0;
        [a * x + b * y + c, d * x + e * y + f]
    }

    /// The identity where there is no inverse.
    pub(super) fn inverse(&self) -> Warp {
        let [a, b, c, d, e, f] = self.0;
        let determinant = a * e - b * d;
        if determinant.abs() < 1e-9 {
            return Warp::IDENTITY;
        }
        let (a, b, d, e) = (e / determinant, -b / determinant, -d / determinant, a / determinant);
        Warp([a, b, -(a * c + b * f), d, e, -(d * c + e * f)])
    }

    /// `first`, then this one.
    pub(super) fn after(&self, first: &Warp) -> Warp {
        let [a, b, _, d, e, _] = self.0;
        let [p, q, r, s, t, u] = first.0;
        let [x, y] = self.at(r, u);
        Warp([a * p + b * s, a * q + b * t, x, d * p + e * s, d * q + e * t, y])
    }

    /// The motion A with x ↦ x + A x, the inverse of [`of`](Warp::of).
    pub(super) fn motion(&self) -> AffineMotion {
        let [a, b, c, d, e, f] = self.0;
        AffineMotion::new([a - 1.0, b, c, d, e - 1.0, f])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warp_and_its_inverse_leave_a_point_where_it_is() {
        let warp = Warp::similarity([7.0, -3.0], 0.4, 1.5).after(&Warp([1.1, 0.2, 3.0, -0.1, 0.9, 5.0]));
        let [x, y] = warp.inverse().after(&warp).at(12.0, 34.0);
        assert!((x - 12.0).abs() < 1e-12 && (y - 34.0).abs() < 1e-12);
        let [x, y] = Warp::of(&warp.motion()).at(2.0, 1.0);
        let [u, v] = warp.at(2.0, 1.0);
        assert!((x - u).abs() < 1e-12 && (y - v).abs() < 1e-12);
    }
}
