//! Looking at a plane along a motion: bilinear samples at x + A x, a row at a time.

use super::Plane;
use crate::motion::AffineMotion;

/// A row's sampling positions: start and step per pixel, kept as `f64` until the pixel so that no error grows along a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowPath {
    start: [f64; 2],
    step: [f64; 2],
}

impl RowPath {
    /// The positions x + A x of the pixels (x0, y), (x0 + 1, y), …
    pub(crate) fn new(motion: &AffineMotion, x0: usize, y: usize) -> RowPath {
        let a = &motion.matrix;
        let [u, v] = motion.flow(x0 as f64, y as f64);
        RowPath { start: [x0 as f64 + u, y as f64 + v], step: [1.0 + a[0], a[3]] }
    }

    /// Position of the k-th pixel of the row.
    #[inline(always)]
    pub(crate) fn at(&self, k: usize) -> (f32, f32) {
        ((self.start[0] + self.step[0] * k as f64) as f32, (self.start[1] + self.step[1] * k as f64) as f32)
    }
}

/// Where a sample falls: index of its upper left pixel, steps to the right and lower neighbours, weights, and whether it lies inside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Footprint {
    index: usize,
    right: usize,
    down: usize,
    fx: f32,
    fy: f32,
    /// Whether the position lies within the plane.
    pub(crate) inside: bool,
}

impl Footprint {
    /// The footprint of (x, y) in a plane of the given size, moved to the border where it lies outside.
    #[inline(always)]
    pub(crate) fn new(x: f32, y: f32, width: usize, height: usize) -> Footprint {
        let (right_edge, lower_edge) = ((width - 1) as f32, (height - 1) as f32);
        let inside = x >= 0.0 && y >= 0.0 && x <= right_edge && y <= lower_edge;
        // max before min: NaN becomes 0, so that an index is always valid.
        let (cx, cy) = (x.max(0.0).min(right_edge), y.max(0.0).min(lower_edge));
        let (ix, iy) = (cx as usize, cy as usize);
        Footprint {
            index: iy * width + ix,
            right: usize::from(ix + 1 < width),
            down: if iy + 1 < height { width } else { 0 },
            fx: cx - ix as f32,
            fy: cy - iy as f32,
            inside,
        }
    }

    /// Fractional parts of the position: the weights of the right and lower neighbours.
    #[inline(always)]
    pub(crate) fn fractions(&self) -> (f32, f32) {
        (self.fx, self.fy)
    }

    /// The bilinear sample of a plane of the size that the footprint was made for.
    #[inline(always)]
    pub(crate) fn sample(&self, values: &[f32]) -> f32 {
        let (a, b) = (values[self.index], values[self.index + self.right]);
        let (c, d) = (values[self.index + self.down], values[self.index + self.down + self.right]);
        let top = a + self.fx * (b - a);
        let bottom = c + self.fx * (d - c);
        top + self.fy * (bottom - top)
    }
}

/// The plane seen along the motion: value at (x, y) is the sample at (x, y) + A (x, y), replicated outside.
pub(crate) fn warp(plane: &Plane, motion: &AffineMotion) -> Plane {
    let (width, height) = (plane.width(), plane.height());
    let mut out = Plane::filled(width, height, 0.0);
    for y in 0..height {
        let path = RowPath::new(motion, 0, y);
        for (k, o) in out.row_mut(y).iter_mut().enumerate() {
            let (px, py) = path.at(k);
            *o = Footprint::new(px, py, width, height).sample(plane.values());
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warp_reads_at_the_displaced_position() {
        let ramp = Plane::from_fn(30, 20, |x, y| 2.0 * x as f32 + 5.0 * y as f32);
        let moved = warp(&ramp, &AffineMotion::translation(1.5, -0.25));
        assert!((moved.at(10, 10) - (2.0 * 11.5 + 5.0 * 9.75)).abs() < 1e-4);
        assert_eq!(warp(&ramp, &AffineMotion::STATIC), ramp);
    }

    #[test]
    fn any_position_is_safe() {
        for x in [f32::NAN, f32::INFINITY, -1e30, 1e30, 0.0, 29.0] {
            let p = Footprint::new(x, x, 30, 20);
            let _ = p.sample(&[1.0; 600]);
        }
    }
}
