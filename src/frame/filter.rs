//! Separable filters with replicated borders: blur, halving, gradients, median.

use super::Plane;
use crate::lanes::{LANES, each_with};

/// Radius of a Gaussian window, standard deviations: 0.3 % of the weight lies beyond.
const WINDOW_RADIUS: f32 = 3.0;

/// Weights of a normalised Gaussian, from the centre outwards.
fn gaussian_weights(sigma: f32) -> Vec<f32> {
    let radius = libm::ceilf(WINDOW_RADIUS * sigma).max(1.0) as usize;
    let mut weights: Vec<f32> =
        (0..=radius).map(|k| libm::expf(-0.5 * (k as f32 / sigma) * (k as f32 / sigma))).collect();
    let sum = weights[0] + 2.0 * weights[1..].iter().sum::<f32>();
    weights.iter_mut().for_each(|w| *w /= sum);
    weights
}

/// Gaussian blur of standard deviation `sigma` pixels; a plain copy for σ ≤ 0.
#[inline(never)]
pub(crate) fn gaussian(plane: &Plane, sigma: f32) -> Plane {
    if sigma <= 0.0 {
        return plane.clone();
    }
    let mut out = Plane::filled(plane.width(), plane.height(), 0.0);
    let mut filter = RowFilter::gaussian(plane.width(), sigma);
    for y in 0..plane.height() {
        filter.row(plane, y, out.row_mut(y));
    }
    out
}

/// A separable symmetric filter, a row at a time, for callers that need no plane of the result.
pub(crate) struct RowFilter {
    /// `weights[k]` belongs to the two neighbours at distance k.
    weights: Vec<f32>,
    /// Start of the values at distance k on both sides.
    places: Vec<[usize; 2]>,
    /// A row after the vertical filter, padded on both sides.
    padded: Vec<f32>,
}

impl RowFilter {
    /// For planes of a width.
    fn new(width: usize, weights: Vec<f32>) -> Self {
        let radius = weights.len() - 1;
        RowFilter { weights, places: vec![[0; 2]; radius], padded: vec![0.0; width + 2 * radius] }
    }

    /// Gaussian blur of standard deviation `sigma` > 0 pixels.
    pub(crate) fn gaussian(width: usize, sigma: f32) -> Self {
        Self::new(width, gaussian_weights(sigma))
    }

    /// Row y of the filtered plane.
    #[inline(never)]
    pub(crate) fn row(&mut self, plane: &Plane, y: usize, out: &mut [f32]) {
        let (width, height, radius) = (plane.width(), plane.height(), self.weights.len() - 1);
        for (k, place) in self.places.iter_mut().enumerate() {
            *place = [y.saturating_sub(k + 1) * width, (y + k + 1).min(height - 1) * width];
        }
        let middle = &mut self.padded[radius..radius + width];
        write_sums(plane.values(), y * width, &self.places, &self.weights, middle);
        let (first, last) = (middle[0], middle[width - 1]);
        self.padded[..radius].fill(first);
        self.padded[radius + width..].fill(last);
        for (k, place) in self.places.iter_mut().enumerate() {
            *place = [radius - k - 1, radius + k + 1];
        }
        write_sums(&self.padded, radius, &self.places, &self.weights, out);
    }
}

/// `out[x] = weights[0] v[centre + x] + Σ_k weights[k] (v[places[k−1][0] + x] + v[places[k−1][1] + x])`, summed in that order.
fn write_sums(values: &[f32], centre: usize, places: &[[usize; 2]], weights: &[f32], out: &mut [f32]) {
    let count = out.len();
    if count < BLOCK {
        for (x, out) in out.iter_mut().enumerate() {
            [*out] = weighted_block(values, centre + x, x, places, weights);
        }
        return;
    }
    for x in (0..count).step_by(BLOCK) {
        // The last block overlaps the one before.
        let x = x.min(count - BLOCK);
        let block: [f32; BLOCK] = weighted_block(values, centre + x, x, places, weights);
        out[x..x + BLOCK].copy_from_slice(&block);
    }
}

/// Values summed together: as many as fit in registers along with their terms.
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

/// Every second pixel after the 5-tap filter [1 4 6 4 1]/16 (Burt and Adelson, IEEE Trans. Communications 31(4), 1983): pixel (x, y) of
/// the result lies at (2x, 2y) of the source.
pub(crate) fn halve(plane: &Plane) -> Plane {
    let (width, height) = (plane.width().div_ceil(2), plane.height().div_ceil(2));
    let mut filter = RowFilter::new(plane.width(), vec![6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0]);
    let mut half = Vec::with_capacity(width * height);
    let mut smooth = vec![0.0; plane.width()];
    for y in 0..height {
        filter.row(plane, 2 * y, &mut smooth);
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

/// Sorts pairs of variables, one pair after the other. One comparison decides both places, so no value is lost, not even NaN. Sorting
/// networks use it instead of loops over arrays, which stay in registers only if the compiler unrolls the loops.
macro_rules! order {
    ($($a:ident $b:ident),*) => { $(let ($a, $b) = if $a < $b { ($a, $b) } else { ($b, $a) };)* };
}

/// Puts the smallest value first, the others in no order.
macro_rules! smallest_first {
    ($first:ident $($other:ident)*) => { order!($($first $other),*) };
}

/// Puts the largest value last, the others in no order; the place for it is named first.
macro_rules! largest_into {
    ($last:ident $($other:ident)*) => { order!($($other $last),*) };
}

/// Puts the smallest value first and the largest last, the others in no order.
macro_rules! extremes_apart {
    ($first:ident, $($middle:ident)*, $last:ident) => {
        smallest_first!($first $($middle)* $last);
        largest_into!($last $($middle)*);
    };
}

/// The five values of each of the columns x…x+N−1 by size: `sorted[0]` gets the smallest, two places further on.
#[inline(always)]
fn sort_columns<const N: usize>(rows: [&[f32]; 5], x: usize, sorted: &mut [Vec<f32>; 5]) {
    let [a, b, c, d, e] = rows;
    let (a, b, c, d, e) = (&a[x..x + N], &b[x..x + N], &c[x..x + N], &d[x..x + N], &e[x..x + N]);
    let mut block = [[0.0; N]; 5];
    for l in 0..N {
        let (a, b, c, d, e) = (a[l], b[l], c[l], d[l], e[l]);
        order!(a b, d e, c e, c d, a d, a c, b e, b d, b c);
        [block[0][l], block[1][l], block[2][l], block[3][l], block[4][l]] = [a, b, c, d, e];
    }
    for (sorted, block) in sorted.iter_mut().zip(&block) {
        sorted[x + 2..x + 2 + N].copy_from_slice(block);
    }
}

/// Medians of the windows of five neighbouring columns from x, …, x+N−1 on.
#[inline(always)]
fn medians<const N: usize>(columns: &[Vec<f32>; 5], x: usize, out: &mut [f32]) {
    let [smallest, second, third, fourth, largest] = columns;
    let (smallest, second, third) = (&smallest[x..x + N + 4], &second[x..x + N + 4], &third[x..x + N + 4]);
    let (fourth, largest) = (&fourth[x..x + N + 4], &largest[x..x + N + 4]);
    let mut block = [0.0; N];
    for l in 0..N {
        let five = |row: &[f32]| [row[l], row[l + 1], row[l + 2], row[l + 3], row[l + 4]];
        block[l] = median_of_25([five(smallest), five(second), five(third), five(fourth), five(largest)]);
    }
    out[x..x + N].copy_from_slice(&block);
}

/// The median of the smallest values of five columns, their second smallest, and so on to their largest.
#[inline(always)]
#[allow(unused_variables, reason = "values that cannot be the median are put aside")]
fn median_of_25([smallest, second, third, fourth, largest]: [[f32; 5]; 5]) -> f32 {
    let [a, b, c, d, e] = smallest;
    smallest_first!(a b c d e);
    smallest_first!(b c d e);
    smallest_first!(c d e);
    let [f, g, h, i, j] = second;
    smallest_first!(f g h i j);
    smallest_first!(g h i j);
    let [k, l, m, n, o] = third;
    extremes_apart!(k, l m n, o);
    let [p, q, r, s, t] = fourth;
    largest_into!(t p q r s);
    largest_into!(s p q r);
    let [u, v, w, x, y] = largest;
    largest_into!(y u v w x);
    largest_into!(x u v w);
    largest_into!(w u v);
    // Thirteen are left. Of any eight, neither the smallest nor the largest is the median: drop both, add the next value and repeat
    // with one value less.
    extremes_apart!(d, e h i j l m, n);
    extremes_apart!(e, h i j l m, p);
    extremes_apart!(h, i j l m, q);
    extremes_apart!(i, j l m, r);
    extremes_apart!(j, l m, u);
    extremes_apart!(l, m, v);
    m
}

/// Erosion: the minimum of each 3×3 neighbourhood. Pixels outside the plane count as inside the region.
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
