//! A rectangle of `f32` values, row by row: every image quantity of the pipeline.

use crate::lanes::lane_sum;

/// Width × height values, row-major; (0, 0) is the top-left pixel.
#[derive(Debug, PartialEq)]
pub struct Plane {
    width: usize,
    height: usize,
    values: Vec<f32>,
}

// Not inlined: a plane takes long enough to make, and the module would contain eighty copies.
impl Clone for Plane {
    #[inline(never)]
    fn clone(&self) -> Plane {
        Plane { width: self.width, height: self.height, values: self.values.clone() }
    }
}

impl Plane {
    /// A plane of one value.
    #[inline(never)]
    pub fn filled(width: usize, height: usize, value: f32) -> Plane {
        Plane { width, height, values: vec![value; width * height] }
    }

    /// A plane from its values, row by row; cut or filled with zeros where their number is not width × height.
    #[inline(never)]
    pub fn from_vec(width: usize, height: usize, mut values: Vec<f32>) -> Plane {
        debug_assert_eq!(values.len(), width * height);
        values.resize(width * height, 0.0);
        Plane { width, height, values }
    }

    /// A plane computed pixel by pixel from (x, y).
    pub fn from_fn(width: usize, height: usize, mut f: impl FnMut(usize, usize) -> f32) -> Plane {
        let mut values = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                values.push(f(x, y));
            }
        }
        Plane { width, height, values }
    }

    /// Width in pixels.
    #[inline]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    #[inline]
    pub fn height(&self) -> usize {
        self.height
    }

    /// All values, row by row.
    #[inline]
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// All values, row by row.
    #[inline]
    pub fn values_mut(&mut self) -> &mut [f32] {
        &mut self.values
    }

    /// Every `stride`-th pixel of every `stride`-th row.
    pub(crate) fn thinned(&self, stride: usize) -> Plane {
        let (width, height) = (self.width.div_ceil(stride), self.height.div_ceil(stride));
        let mut values = Vec::with_capacity(width * height);
        for row in self.values.chunks_exact(self.width).step_by(stride) {
            values.extend(row.iter().step_by(stride));
        }
        Plane::from_vec(width, height, values)
    }

    /// Sum of all values, in the same order on every platform.
    pub(crate) fn total(&self) -> f64 {
        (0..self.height).map(|y| f64::from(lane_sum(self.row(y)))).sum()
    }

    /// Row y.
    #[inline]
    pub fn row(&self, y: usize) -> &[f32] {
        &self.values[y * self.width..(y + 1) * self.width]
    }

    /// Row y.
    #[inline]
    pub fn row_mut(&mut self, y: usize) -> &mut [f32] {
        &mut self.values[y * self.width..(y + 1) * self.width]
    }

    /// The value of pixel (x, y).
    #[inline]
    pub fn at(&self, x: usize, y: usize) -> f32 {
        self.values[y * self.width + x]
    }
}
