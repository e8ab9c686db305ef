//! Separable filters with replicated borders: blur, halving, gradients, median.

use super::Plane;
use crate::order::median;

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
    let (width, height, radius) = (plane.width(), plane.height(), weights.len() - 1);
    let mut vertical = Plane::filled(width, height, 0.0);
    for y in 0..height {
        let out = vertical.row_mut(y);
        for (o, v) in out.iter_mut().zip(plane.row(y)) {
            *o = weights[0] * v;
        }
        for k in 1..=radius {
            let (above, below) = (plane.row(y.saturating_sub(k)), plane.row((y + k).min(height - 1)));
            for ((o, a), b) in out.iter_mut().zip(above).zip(below) {
                *o += weights[k] * (a + b);
            }
        }
    }
    let mut padded = vec![0.0; width + 2 * radius];
    for y in 0..height {
        let row = vertical.row_mut(y);
        padded[..radius].fill(row[0]);
        padded[radius..radius + width].copy_from_slice(row);
        padded[radius + width..].fill(row[width - 1]);
        for (o, v) in row.iter_mut().zip(&padded[radius..]) {
            *o = weights[0] * v;
        }
        for k in 1..=radius {
            let (left, right) = (&padded[radius - k..], &padded[radius + k..]);
            for ((o, a), b) in row.iter_mut().zip(left).zip(right) {
                *o += weights[k] * (a + b);
            }
        }
    }
    vertical
}

/// Every second pixel after the 5-tap filter [1 4 6 4 1]/16: pixel (x, y) of the result lies at (2x, 2y) of the source.
pub(crate) fn halve(plane: &Plane) -> Plane {
    let smooth = symmetric(plane, &[6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0]);
    let (width, height) = (plane.width().div_ceil(2), plane.height().div_ceil(2));
    Plane::from_fn(width, height, |x, y| smooth.at(2 * x, 2 * y))
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
        for x in 0..width {
            smooth[x + 1] = (3.0 * (above[x] + below[x]) + 10.0 * here[x]) / 32.0;
            difference[x + 1] = (below[x] - above[x]) / 32.0;
        }
        for line in [&mut smooth, &mut difference] {
            line[0] = line[1];
            line[width + 1] = line[width];
        }
        for (x, o) in dx.row_mut(y).iter_mut().enumerate() {
            *o = smooth[x + 2] - smooth[x];
        }
        for (x, o) in dy.row_mut(y).iter_mut().enumerate() {
            *o = 3.0 * (difference[x] + difference[x + 2]) + 10.0 * difference[x + 1];
        }
    }
    (dx, dy)
}

/// Median over 5×5 windows.
pub(crate) fn median5(plane: &Plane) -> Plane {
    let (width, height) = (plane.width(), plane.height());
    let mut window = [0.0f32; 25];
    Plane::from_fn(width, height, |x, y| {
        for dy in 0..5 {
            let row = plane.row((y + dy).saturating_sub(2).min(height - 1));
            for dx in 0..5 {
                window[dy * 5 + dx] = row[(x + dx).saturating_sub(2).min(width - 1)];
            }
        }
        median(&mut window).unwrap_or(0.0)
    })
}

/// The smallest of each 3×3 neighbourhood; outside the plane counts as inside the region.
pub(crate) fn eroded(mask: &Plane) -> Plane {
    let (width, height) = (mask.width(), mask.height());
    Plane::from_fn(width, height, |x, y| {
        let mut smallest = f32::INFINITY;
        for ny in y.saturating_sub(1)..=(y + 1).min(height - 1) {
            for nx in x.saturating_sub(1)..=(x + 1).min(width - 1) {
                smallest = smallest.min(mask.at(nx, ny));
            }
        }
        smallest
    })
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
    fn halving_keeps_positions() {
        let ramp = Plane::from_fn(40, 30, |x, y| x as f32 + 10.0 * y as f32);
        let half = halve(&ramp);
        assert_eq!((half.width(), half.height()), (20, 15));
        assert!((half.at(5, 6) - ramp.at(10, 12)).abs() < 1e-4);
    }
}
