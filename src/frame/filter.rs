//! Separable filters with replicated borders: blur, halving, gradients, median.

use super::Plane;
use super::lanes::{LANES, each_with};

/// Weights of a normalised Gaussian, from the centre outwards, cut at 3σ.
fn gaussian_weights(sigma: f32) -> Vec<f32> {
    let radius = libm::ceilf(3.0 * sigma).max(1.0) as usize;
    let mut weights: Vec<f32> =
        (0..=radius).map(|k| libm::expf(-0.5 * (k as f32 / sigma) * (k as f32 / sigma))).collect();
    let sum = weights[0] + 2.0 * weights[1..].iter().sum::<f32>();
    weights.iter_mut().for_each(|w| *w /= sum);
    weights
}

/// Gaussian blur of standard deviation `sigma` pixels; a plain copy for σ ≤ 0.
pub(crate) fn gaussian(plane: &Plane, sigma: f32) -> Plane {
    if sigma <= 0.0 { plane.clone() } else { symmetric(plane, &gaussian_weights(sigma)) }
}

/// Separable symmetric filter; `weights[k]` belongs to the two neighbours at distance k.
fn symmetric(plane: &Plane, weights: &[f32]) -> Plane {
    let mut out = Vec::with_capacity(plane.values().len());
    let mut filter = RowFilter::new(plane.width(), weights);
    for y in 0..plane.height() {
        filter.append_row(plane, y, &mut out);
    }
    Plane::from_vec(plane.width(), plane.height(), out)
}

/// A separable symmetric filter, a row at a time.
struct RowFilter<'a> {
    weights: &'a [f32],
    /// Where the values at distance k on both sides begin.
    places: Vec<[usize; 2]>,
    /// A row after the vertical filter, continued on both sides.
    padded: Vec<f32>,
}

impl<'a> RowFilter<'a> {
    fn new(width: usize, weights: &'a [f32]) -> Self {
        let radius = weights.len() - 1;
        RowFilter { weights, places: vec![[0; 2]; radius], padded: Vec::with_capacity(width + 2 * radius) }
    }

    /// Appends row y of the filtered plane.
    fn append_row(&mut self, plane: &Plane, y: usize, out: &mut Vec<f32>) {
        let (width, height, radius) = (plane.width(), plane.height(), self.weights.len() - 1);
        for (k, place) in self.places.iter_mut().enumerate() {
            *place = [y.saturating_sub(k + 1) * width, (y + k + 1).min(height - 1) * width];
        }
        self.padded.clear();
        self.padded.resize(radius, 0.0);
        append_sums(plane.values(), y * width, &self.places, self.weights, width, &mut self.padded);
        let (first, last) = (self.padded[radius], self.padded[radius + width - 1]);
        self.padded[..radius].fill(first);
        self.padded.resize(width + 2 * radius, last);
        for (k, place) in self.places.iter_mut().enumerate() {
            *place = [radius - k - 1, radius + k + 1];
        }
        append_sums(&self.padded, radius, &self.places, self.weights, width, out);
    }
}

/// Appends `weights[0] v[centre + x] + Σ_k weights[k] (v[places[k−1][0] + x] + v[places[k−1][1] + x])` for `count` x from 0 on,
/// summed in that order.
fn append_sums(
    values: &[f32],
    centre: usize,
    places: &[[usize; 2]],
    weights: &[f32],
    count: usize,
    out: &mut Vec<f32>,
) {
    let whole = count - count % BLOCK;
    for x in (0..whole).step_by(BLOCK) {
        out.extend_from_slice(&weighted_block::<BLOCK>(values, centre + x, x, places, weights));
    }
    for x in whole..count {
        out.extend_from_slice(&weighted_block::<1>(values, centre + x, x, places, weights));
    }
}

/// Values summed together: as many as fit the registers with room for their terms.
const BLOCK: usize = 16;

#[inline(always)]
fn weighted_block<const N: usize>(
    values: &[f32],
    centre: usize,
    x: usize,
    places: &[[usize; 2]],
    weights: &[f32],
) -> [f32; N] {
    let mut sums = [0.0; N];
    for (s, v) in sums.iter_mut().zip(&values[centre..centre + N]) {
        *s = weights[0] * v;
    }
    for (&[a, b], w) in places.iter().zip(&weights[1..]) {
        let pairs = values[a + x..a + x + N].iter().zip(&values[b + x..b + x + N]);
        for (s, (a, b)) in sums.iter_mut().zip(pairs) {
            *s += w * (a + b);
        }
    }
    sums
}

/// Every second pixel after the 5-tap filter [1 4 6 4 1]/16: pixel (x, y) of the result lies at (2x, 2y) of the source.
pub(crate) fn halve(plane: &Plane) -> Plane {
    let (width, height) = (plane.width().div_ceil(2), plane.height().div_ceil(2));
    let mut filter = RowFilter::new(plane.width(), &[6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0]);
    let mut half = Vec::with_capacity(width * height);
    let mut smooth = Vec::with_capacity(plane.width());
    for y in 0..height {
        smooth.clear();
        filter.append_row(plane, 2 * y, &mut smooth);
        half.extend(smooth.iter().step_by(2));
    }
    Plane::from_vec(width, height, half)
}

/// Scharr gradients (∂/∂x, ∂/∂y) per pixel: central differences, smoothed by [3 10 3]/16 across.
pub(crate) fn gradients(plane: &Plane) -> (Plane, Plane) {
    let (width, height) = (plane.width(), plane.height());
    let mut dx = Plane::filled(width, height, 0.0);
    let mut dy = Plane::filled(width, height, 0.0);
    let mut smooth = vec![0.0; width + 2];
    let mut difference = vec![0.0; width + 2];
    for y in 0..height {
        let (above, here, below) = (plane.row(y.saturating_sub(1)), plane.row(y), plane.row((y + 1).min(height - 1)));
        for line in [&mut smooth, &mut difference] {
            line[1..=width].copy_from_slice(above);
        }
        each_with(&mut smooth[1..=width], [here, below], |a, [h, b]| (3.0 * (a + b) + 10.0 * h) / 32.0);
        each_with(&mut difference[1..=width], [below], |a, [b]| (b - a) / 32.0);
        for line in [&mut smooth, &mut difference] {
            line[0] = line[1];
            line[width + 1] = line[width];
        }
        let (dx, dy) = (dx.row_mut(y), dy.row_mut(y));
        dx.copy_from_slice(&smooth[..width]);
        each_with(dx, [&smooth[2..]], |left, [right]| right - left);
        dy.copy_from_slice(&difference[..width]);
        each_with(dy, [&difference[1..], &difference[2..]], |left, [middle, right]| {
            3.0 * (left + right) + 10.0 * middle
        });
    }
    (dx, dy)
}

/// Median over 5×5 windows.
///
/// Each column of a window is sorted once and serves five windows. Of the smallest in each column only the two largest can
/// be the median, of the second smallest the three largest, and so on: 13 of 25 remain.
pub(crate) fn median5(plane: &Plane) -> Plane {
    let (width, height) = (plane.width(), plane.height());
    let mut out = Plane::filled(width, height, 0.0);
    let mut columns: [Vec<f32>; 5] = std::array::from_fn(|_| vec![0.0; width + 4]);
    for y in 0..height {
        let rows: [&[f32]; 5] = std::array::from_fn(|k| plane.row((y + k).saturating_sub(2).min(height - 1)));
        let whole = width - width % LANES;
        (0..whole).step_by(LANES).for_each(|x| sort_columns::<LANES>(rows, x, &mut columns));
        (whole..width).for_each(|x| sort_columns::<1>(rows, x, &mut columns));
        for column in &mut columns {
            let (first, last) = (column[2], column[width + 1]);
            column[..2].fill(first);
            column[width + 2..].fill(last);
        }
        let out = out.row_mut(y);
        (0..whole).step_by(LANES).for_each(|x| medians::<LANES>(&columns, x, out));
        (whole..width).for_each(|x| medians::<1>(&columns, x, out));
    }
    out
}

/// The five values of each of the columns x…x+N−1 by size: `sorted[0]` gets the smallest, two places further on.
#[inline(always)]
fn sort_columns<const N: usize>(rows: [&[f32]; 5], x: usize, sorted: &mut [Vec<f32>; 5]) {
    let rows = rows.map(|row| &row[x..x + N]);
    let mut block = [[0.0; N]; 5];
    for l in 0..N {
        let mut v = rows.map(|row| row[l]);
        for (i, j) in [(0, 1), (3, 4), (2, 4), (2, 3), (0, 3), (0, 2), (1, 4), (1, 3), (1, 2)] {
            order(&mut v, i, j);
        }
        (0..5).for_each(|k| block[k][l] = v[k]);
    }
    for (sorted, block) in sorted.iter_mut().zip(&block) {
        sorted[x + 2..x + 2 + N].copy_from_slice(block);
    }
}

/// Medians of the windows of five neighbouring columns from x, …, x+N−1 on.
#[inline(always)]
fn medians<const N: usize>(columns: &[Vec<f32>; 5], x: usize, out: &mut [f32]) {
    let window: [[&[f32]; 5]; 5] = columns.each_ref().map(|column| std::array::from_fn(|k| &column[x + k..x + k + N]));
    let mut block = [0.0; N];
    for l in 0..N {
        let [a, b, c, d, e] = window.map(|row| row.map(|column| column[l]));
        let ([.., a0, a1], [.., b0, b1, b2]) = (largest_last::<2>(a), largest_last::<3>(b));
        let [_, c0, c1, c2, _] = extremes_apart(c);
        let ([d0, d1, d2, ..], [e0, e1, ..]) = (smallest_first::<3>(d), smallest_first::<2>(e));
        block[l] = median_of_13([a0, a1, b0, b1, b2, c0, c1, c2, d0, d1, d2, e0, e1]);
    }
    out[x..x + N].copy_from_slice(&block);
}

/// Puts the smaller of two values first. The same comparison decides both, so that nothing is lost, whatever the values.
#[inline(always)]
fn order<const N: usize>(v: &mut [f32; N], i: usize, j: usize) {
    let (a, b) = (v[i], v[j]);
    v[i] = if a < b { a } else { b };
    v[j] = if a < b { b } else { a };
}

/// The `KEPT` largest at the end, in no order: the smallest of those still there goes to the front again and again.
#[inline(always)]
fn largest_last<const KEPT: usize>(mut v: [f32; 5]) -> [f32; 5] {
    for front in 0..5 - KEPT {
        for k in front + 1..5 {
            order(&mut v, front, k);
        }
    }
    v
}

/// The `KEPT` smallest at the beginning, in no order.
#[inline(always)]
fn smallest_first<const KEPT: usize>(mut v: [f32; 5]) -> [f32; 5] {
    for back in (KEPT..5).rev() {
        for k in 0..back {
            order(&mut v, k, back);
        }
    }
    v
}

/// The smallest first, the largest last, the others in no order.
#[inline(always)]
fn extremes_apart<const N: usize>(mut v: [f32; N]) -> [f32; N] {
    for k in 1..N {
        order(&mut v, 0, k);
    }
    for k in 1..N - 1 {
        order(&mut v, k, N - 1);
    }
    v
}

/// Of eight values neither the smallest nor the largest is the median of thirteen; what is left and one more is the same
/// question with two values less.
#[inline(always)]
fn median_of_13(v: [f32; 13]) -> f32 {
    let [_, a, b, c, d, e, f, _] = extremes_apart([v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7]]);
    let [_, a, b, c, d, e, _] = extremes_apart([a, b, c, d, e, f, v[8]]);
    let [_, a, b, c, d, _] = extremes_apart([a, b, c, d, e, v[9]]);
    let [_, a, b, c, _] = extremes_apart([a, b, c, d, v[10]]);
    let [_, a, b, _] = extremes_apart([a, b, c, v[11]]);
    let [_, a, _] = extremes_apart([a, b, v[12]]);
    a
}

/// The smallest of each 3×3 neighbourhood; outside the plane counts as inside the region.
pub(crate) fn eroded(mask: &Plane) -> Plane {
    let (width, height) = (mask.width(), mask.height());
    let mut out = Plane::filled(width, height, 0.0);
    let mut padded = vec![f32::INFINITY; width + 2];
    for y in 0..height {
        let (above, below) = (mask.row(y.saturating_sub(1)), mask.row((y + 1).min(height - 1)));
        let middle = &mut padded[1..=width];
        middle.copy_from_slice(above);
        each_with(middle, [mask.row(y), below], |a, [b, c]| smaller(smaller(a, b), c));
        let out = out.row_mut(y);
        out.copy_from_slice(&padded[..width]);
        each_with(out, [&padded[1..], &padded[2..]], |a, [b, c]| smaller(smaller(a, b), c));
    }
    out
}

#[inline(always)]
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// Bilinear enlargement to `width` × `height`: pixel (x, y) takes the value at (x/2, y/2).
pub(crate) fn double(plane: &Plane, width: usize, height: usize) -> Plane {
    Plane::from_fn(width, height, |x, y| {
        let (x0, y0) = ((x / 2).min(plane.width() - 1), (y / 2).min(plane.height() - 1));
        let x1 = (x.div_ceil(2)).min(plane.width() - 1);
        let y1 = (y.div_ceil(2)).min(plane.height() - 1);
        0.25 * (plane.at(x0, y0) + plane.at(x1, y0) + plane.at(x0, y1) + plane.at(x1, y1))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradients_of_a_ramp_are_its_slope() {
        let ramp = Plane::from_fn(20, 17, |x, y| 3.0 * x as f32 - 2.0 * y as f32);
        let (dx, dy) = gradients(&ramp);
        assert!((dx.at(10, 8) - 3.0).abs() < 1e-5 && (dy.at(10, 8) + 2.0).abs() < 1e-5);
        assert!((dx.at(10, 0) - 3.0).abs() < 1e-5, "the border replicates across the derivative only");
    }

    #[test]
    fn blur_keeps_constants_and_the_mean_of_an_impulse() {
        let flat = Plane::filled(31, 23, 7.0);
        assert!(gaussian(&flat, 2.0).values().iter().all(|v| (v - 7.0).abs() < 1e-5));
        let mut impulse = Plane::filled(41, 41, 0.0);
        impulse.row_mut(20)[20] = 1.0;
        let blurred = gaussian(&impulse, 1.5);
        let sum: f32 = blurred.values().iter().sum();
        assert!((sum - 1.0).abs() < 1e-5);
        assert!((blurred.at(17, 20) - blurred.at(20, 23)).abs() < 1e-8, "isotropic");
    }

    #[test]
    fn the_median_of_every_window_is_the_middle_of_its_sorted_values() {
        let mut random = crate::random::Random::from_seed(3);
        for (width, height, steps) in [(37, 21, 1000.0), (5, 30, 3.0), (1, 7, 2.0), (24, 2, 5.0)] {
            // Few steps make many equals.
            let plane = Plane::from_fn(width, height, |_, _| (random.uniform(0.0, steps) as i32) as f32);
            let found = median5(&plane);
            for y in 0..height {
                for x in 0..width {
                    let at = |k: usize, length: usize, p: usize| (p + k).saturating_sub(2).min(length - 1);
                    let mut window: Vec<f32> =
                        (0..25).map(|k| plane.at(at(k % 5, width, x), at(k / 5, height, y))).collect();
                    window.sort_by(f32::total_cmp);
                    assert_eq!(found.at(x, y), window[12], "({x}, {y}) of {width} × {height}");
                }
            }
        }
    }

    #[test]
    fn erosion_takes_the_smallest_of_nine() {
        let mask = Plane::from_fn(9, 7, |x, y| if (x, y) == (4, 3) { 0.0 } else { 1.0 });
        let inner = eroded(&mask);
        for y in 0..7 {
            for x in 0..9 {
                let near = (3..6).contains(&x) && (2..5).contains(&y);
                assert_eq!(inner.at(x, y), if near { 0.0 } else { 1.0 });
            }
        }
        assert!(eroded(&Plane::filled(3, 1, 1.0)).values().iter().all(|&v| v == 1.0));
    }

    #[test]
    fn halving_keeps_positions() {
        let ramp = Plane::from_fn(40, 30, |x, y| x as f32 + 10.0 * y as f32);
        let half = halve(&ramp);
        assert_eq!((half.width(), half.height()), (20, 15));
        assert!((half.at(5, 6) - ramp.at(10, 12)).abs() < 1e-4);
    }
}
