//! Warping: bilinear samples of a plane at x + A x, a row at a time.
//!
//! [`Footprints`] does for [`CHUNK`] pixels what [`Footprint`] does for one, with the same bits. All but the reads of the four
//! neighbours is vectorised.

use super::Plane;
use crate::lanes::LANES;
use crate::motion::AffineMotion;

/// Sampling positions of a row: start and step per pixel, in `f64` up to each chunk of pixels so that errors do not grow along a row.
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

    /// The same positions in pixels a `factor`-th as large.
    pub(crate) fn times(self, factor: f64) -> RowPath {
        RowPath { start: self.start.map(|s| factor * s), step: self.step.map(|s| factor * s) }
    }

    /// Position of the k-th pixel of the row.
    #[inline(always)]
    pub(crate) fn at(&self, k: usize) -> (f32, f32) {
        ((self.start[0] + self.step[0] * k as f64) as f32, (self.start[1] + self.step[1] * k as f64) as f32)
    }
}

/// Where a sample falls in a plane of at least 2 × 2 pixels: index of its upper left pixel, weights of those to the right and below,
/// and whether it lies inside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Footprint {
    index: usize,
    width: usize,
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
        // NaN becomes 0, so that an index is always valid. Comparisons, because `f32::max` is a call in WebAssembly.
        let within = |v: f32, edge: f32| {
            let v = if v > 0.0 { v } else { 0.0 };
            if v < edge { v } else { edge }
        };
        let (cx, cy) = (within(x, right_edge), within(y, lower_edge));
        // The upper left pixel is never on the last column or row: what lies there has the weights 1.
        let (ix, iy) = ((cx as usize).min(width - 2), (cy as usize).min(height - 2));
        Footprint { index: iy * width + ix, width, fx: cx - ix as f32, fy: cy - iy as f32, inside }
    }

    /// The bilinear sample of a plane of the size that the footprint was made for.
    #[inline(always)]
    pub(crate) fn sample(&self, values: &[f32]) -> f32 {
        let window = &values[self.index..self.index + self.width + 2];
        let (a, b, c, d) = (window[0], window[1], window[self.width], window[self.width + 1]);
        let top = a + self.fx * (b - a);
        let bottom = c + self.fx * (d - c);
        top + self.fy * (bottom - top)
    }
}

/// Pixels of a row that are processed together. Rows of most levels are a multiple of it.
pub(crate) const CHUNK: usize = 32;

/// [`Footprint`]s of neighbouring pixels, placed anew as often as needed: up to [`CHUNK`], in whole blocks.
pub(crate) struct Footprints {
    /// Of the upper left pixels.
    index: [u32; CHUNK],
    /// How the indices of each block that is placed follow each other.
    steps: [Step; CHUNK / LANES],
    placed: usize,
    width: usize,
    /// Weights of the right and lower neighbours.
    pub(crate) fx: [f32; CHUNK],
    pub(crate) fy: [f32; CHUNK],
    /// Mask of the positions within the plane, all bits or none. As wide as the weights, so that both vectorise together.
    inside: [u32; CHUNK],
}

/// Distance from each index of a block to the next. If it is constant, the values needed lie in two rows.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Step {
    One,
    Two,
    Uneven,
}

impl Footprints {
    pub(crate) fn new() -> Footprints {
        Footprints {
            index: [0; CHUNK],
            steps: [Step::Uneven; CHUNK / LANES],
            placed: 0,
            width: 0,
            fx: [0.0; CHUNK],
            fy: [0.0; CHUNK],
            inside: [0; CHUNK],
        }
    }

    /// Puts them at `count` pixels from `from` on of a path in a plane of the given size.
    #[inline(never)] // A call costs little for so many pixels, a copy at each of the many call sites a kilobyte.
    pub(crate) fn follow(&mut self, path: &RowPath, from: usize, count: usize, width: usize, height: usize) {
        let (start_x, start_y) = path.at(from);
        let step = path.step.map(|s| s as f32);
        self.put(count, width, height, |k| {
            let k = k as u32 as i32 as f32;
            (start_x + step[0] * k, start_y + step[1] * k)
        });
    }

    /// Puts them at the first `count` of some positions in a plane of the given size.
    #[inline(never)]
    pub(crate) fn place(&mut self, x: &[f32; CHUNK], y: &[f32; CHUNK], count: usize, width: usize, height: usize) {
        self.put(count, width, height, |k| (x[k], y[k]));
    }

    #[inline(always)]
    fn put(&mut self, count: usize, width: usize, height: usize, position: impl Fn(usize) -> (f32, f32)) {
        let (right_edge, lower_edge) = ((width - 1) as f32, (height - 1) as f32);
        let (last_x, last_y) = (right_edge - 1.0, lower_edge - 1.0);
        self.width = width;
        self.placed = count.div_ceil(LANES).min(CHUNK / LANES);
        // All of them, whatever the count: a constant trip count vectorises.
        for k in 0..CHUNK {
            let (x, y) = position(k);
            let (cx, cy) = (clamped(x, right_edge), clamped(y, lower_edge));
            let (left, upper) = (floor(cx, last_x), floor(cy, last_y));
            self.index[k] = whole(upper) * width as u32 + whole(left);
            (self.fx[k], self.fy[k]) = (cx - left, cy - upper);
            self.inside[k] = if (cx == x) & (cy == y) { u32::MAX } else { 0 };
        }
        for (step, index) in self.steps[..self.placed].iter_mut().zip(self.index.as_chunks().0) {
            *step = Step::of(index);
        }
    }

    /// Whether the first `count` positions lie within the plane.
    pub(crate) fn all_inside(&self, count: usize) -> bool {
        self.inside[..count].iter().fold(u32::MAX, |all, inside| all & inside) != 0
    }

    /// How many of the first `count` positions lie within the plane.
    pub(crate) fn count_inside(&self, count: usize) -> usize {
        self.inside[..count].iter().filter(|&&inside| inside != 0).count()
    }

    /// All bits if the k-th position lies within the plane, else none.
    #[inline(always)]
    pub(crate) fn inside(&self, k: usize) -> u32 {
        self.inside[k]
    }

    /// Whether the k-th position lies within the plane.
    #[inline(always)]
    pub(crate) fn is_inside(&self, k: usize) -> bool {
        self.inside[k] != 0
    }

    /// Bilinear samples of a plane of the size that the footprints were placed in.
    #[inline(never)]
    pub(crate) fn sample(&self, values: &[f32], out: &mut [f32; CHUNK]) {
        let weights = self.fx.as_chunks::<LANES>().0.iter().zip(self.fy.as_chunks::<LANES>().0);
        let blocks = self.index.as_chunks::<LANES>().0.iter().zip(&self.steps[..self.placed]);
        for ((out, (index, step)), (fx, fy)) in out.as_chunks_mut::<LANES>().0.iter_mut().zip(blocks).zip(weights) {
            let corners = match step {
                Step::One => in_rows::<1, { LANES + 1 }>(index, values, self.width),
                Step::Two => in_rows::<2, { 2 * LANES }>(index, values, self.width),
                Step::Uneven => anywhere(index, values, self.width),
            };
            let Some([a, b, c, d]) = corners else { return };
            for l in 0..LANES {
                let top = a[l] + fx[l] * (b[l] - a[l]);
                let bottom = c[l] + fx[l] * (d[l] - c[l]);
                out[l] = top + fy[l] * (bottom - top);
            }
        }
    }
}

impl Step {
    #[inline(always)]
    fn of(index: &[u32; LANES]) -> Step {
        let step = index[1].wrapping_sub(index[0]);
        let even = (2..LANES).fold(true, |even, l| even & (index[l].wrapping_sub(index[l - 1]) == step));
        match step {
            1 if even => Step::One,
            2 if even => Step::Two,
            _ => Step::Uneven,
        }
    }
}

/// The upper left, upper right, lower left and lower right neighbours of a block of positions.
type Corners = [[f32; LANES]; 4];

/// Neighbours whose indices are `STEP` apart: they lie within `SPAN` values of each of two rows.
#[inline(always)]
fn in_rows<const STEP: usize, const SPAN: usize>(
    index: &[u32; LANES],
    values: &[f32],
    width: usize,
) -> Option<Corners> {
    let from = index[0] as usize;
    let rows = values.get(from..from + width + SPAN)?;
    let (upper, lower) = (rows.first_chunk::<SPAN>()?, rows.last_chunk::<SPAN>()?);
    let apart = |row: &[f32; SPAN], first: usize| std::array::from_fn(|l| row[first + STEP * l]);
    Some([apart(upper, 0), apart(upper, 1), apart(lower, 0), apart(lower, 1)])
}

#[inline(always)]
fn anywhere(index: &[u32; LANES], values: &[f32], width: usize) -> Option<Corners> {
    let mut corners = [[0.0; LANES]; 4];
    for (l, &index) in index.iter().enumerate() {
        let window = values.get(index as usize..index as usize + width + 2)?;
        for (corner, value) in corners.iter_mut().zip([window[0], window[1], window[width], window[width + 1]]) {
            corner[l] = value;
        }
    }
    Some(corners)
}

/// Between 0 and `edge`; NaN becomes 0.
#[inline(always)]
fn clamped(v: f32, edge: f32) -> f32 {
    let v = if v > 0.0 { v } else { 0.0 };
    if v < edge { v } else { edge }
}

/// 2²³: from here on floats are 1 apart.
const SHIFT: f32 = 8_388_608.0;

/// The largest whole number up to `v`, 0 ≤ v < 2²², and up to `last`. Adding 2²³ leaves no bits for a fraction, so the sum is rounded.
/// The language's own conversion handles special cases and does not vectorise.
#[inline(always)]
fn floor(v: f32, last: f32) -> f32 {
    let rounded = (v + SHIFT) - SHIFT;
    let below = if rounded > v { rounded - 1.0 } else { rounded };
    if below < last { below } else { last }
}

/// A whole number as such: the low bits of the sum with 2²³.
#[inline(always)]
fn whole(v: f32) -> u32 {
    (v + SHIFT).to_bits() & 0x007f_ffff
}

/// Warps a plane by a motion: the value at (x, y) is the sample at (x, y) + A (x, y), replicated outside.
pub(crate) fn warp(plane: &Plane, motion: &AffineMotion) -> Plane {
    let (width, height) = (plane.width(), plane.height());
    let mut out = Plane::filled(width, height, 0.0);
    let (mut samples, mut at) = ([0.0; CHUNK], Footprints::new());
    for y in 0..height {
        let path = RowPath::new(motion, 0, y);
        for (k, out) in out.row_mut(y).chunks_mut(CHUNK).enumerate() {
            at.follow(&path, k * CHUNK, out.len(), width, height);
            at.sample(plane.values(), &mut samples);
            out.copy_from_slice(&samples[..out.len()]);
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
    fn many_footprints_are_those_of_each() {
        let (width, height) = (23, 17);
        let plane = Plane::from_fn(width, height, |x, y| libm::sinf((7 * x + 3 * y * y) as f32) * 100.0);
        let mut random = crate::random::Random::from_seed(5);
        let mut places =
            vec![[0.0, 0.0], [22.0, 16.0], [22.0, 0.0], [21.999_998, 15.999_999], [22.000_002, 3.0], [-1e-9, 0.5]];
        places.extend([[f32::NAN, 2.0], [f32::INFINITY, -f32::INFINITY], [1e30, -1e30], [8_388_607.5, 4.0]]);
        while places.len() < CHUNK {
            places.push([random.uniform(-3.0, 26.0) as f32, random.uniform(-3.0, 20.0) as f32]);
        }
        let (x, y) = (std::array::from_fn(|k| places[k][0]), std::array::from_fn(|k| places[k][1]));
        let mut many = Footprints::new();
        many.place(&x, &y, CHUNK, width, height);
        let mut samples = [0.0; CHUNK];
        many.sample(plane.values(), &mut samples);
        for (k, &[x, y]) in places.iter().enumerate() {
            let one = Footprint::new(x, y, width, height);
            assert_eq!((many.fx[k], many.fy[k], many.is_inside(k)), (one.fx, one.fy, one.inside), "({x}, {y})");
            assert_eq!(samples[k].to_bits(), one.sample(plane.values()).to_bits(), "({x}, {y})");
        }
        assert!(many.steps.iter().all(|step| *step == Step::Uneven));
    }

    #[test]
    fn samples_along_a_path_are_those_of_each_position() {
        let (width, height) = (301, 17);
        let plane = Plane::from_fn(width, height, |x, y| libm::sinf(0.05 * (x + 3 * y) as f32) * 100.0);
        let (mut samples, mut along) = ([0.0; CHUNK], Footprints::new());
        // Beside each other, every second one, with leaps, beyond the border.
        for (stretch, stride) in [(0.0, 1.0), (0.01, 1.0), (-0.02, 2.0), (0.3, 1.0), (0.1, 5.0)] {
            let motion = AffineMotion::new([stretch, 0.2, -4.0, 0.01, 0.05, 1.3]);
            let path = RowPath::new(&motion, 2, 7).times(stride);
            for (from, count) in [(0, CHUNK), (3, 9), (64, 20), (250, CHUNK)] {
                along.follow(&path, from, count, width, height);
                along.sample(plane.values(), &mut samples);
                for k in 0..count {
                    let (x, y) = path.at(from + k);
                    let one = Footprint::new(x, y, width, height);
                    assert!((samples[k] - one.sample(plane.values())).abs() < 1e-2, "({x}, {y})");
                    let near_border = x.abs() < 1e-3 || (x - 300.0).abs() < 1e-3;
                    assert!(along.is_inside(k) == one.inside || near_border, "({x}, {y})");
                }
            }
        }
        for (stride, step) in [(1.0, Step::One), (2.0, Step::Two), (3.0, Step::Uneven)] {
            along.follow(&RowPath::new(&AffineMotion::STATIC, 0, 3).times(stride), 0, CHUNK, width, height);
            assert!(along.steps.iter().all(|s| *s == step));
        }
    }

    #[test]
    fn any_position_is_safe() {
        for x in [f32::NAN, f32::INFINITY, -1e30, 1e30, 0.0, 29.0] {
            let p = Footprint::new(x, x, 30, 20);
            let _ = p.sample(&[1.0; 600]);
        }
    }
}
