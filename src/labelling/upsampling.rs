//! Labels of the working size at full size: each label's mask, enlarged, follows the edges of the full-size frame by the guided
//! filter (He, Sun, Tang, PAMI 35(6), 2013); the strongest label wins.

use super::mask_of;
use crate::frame::Plane;

/// Radius of the filter's windows, full-size pixels.
const RADIUS: usize = 4;
/// Variance (grey levels²) below which the frame has no edge to follow.
const FLAT_VARIANCE: f32 = 40.0;

/// Labels at the size of `guide`, from labels at a 2^k-th of it.
pub(crate) fn upsample(labels: &[u8], [width, height]: [usize; 2], of: usize, guide: &Plane) -> Vec<u8> {
    let (full_width, full_height) = (guide.width(), guide.height());
    if (width, height) == (full_width, full_height) {
        return labels.to_vec();
    }
    let mut best = vec![f32::NEG_INFINITY; full_width * full_height];
    let mut winner = vec![0u8; full_width * full_height];
    let filter = GuidedFilter::new(guide);
    for label in 0..of as u8 {
        let mask = enlarged(&mask_of(labels, label, width, height), full_width, full_height);
        let strength = filter.apply(guide, &mask);
        for ((b, w), s) in best.iter_mut().zip(&mut winner).zip(strength.values()) {
            if *s > *b {
                (*b, *w) = (*s, label);
            }
        }
    }
    winner
}

/// Bilinear enlargement by a power of two, of a mask or anything else: full pixel X lies at X / 2^k.
pub(crate) fn enlarged(mask: &Plane, width: usize, height: usize) -> Plane {
    let (scale_x, scale_y) = (factor(mask.width(), width), factor(mask.height(), height));
    let scale = scale_x.max(scale_y) as f32;
    let (right, lower) = (mask.width() - 1, mask.height() - 1);
    Plane::from_fn(width, height, |x, y| {
        let (px, py) = ((x as f32 / scale).min(right as f32), (y as f32 / scale).min(lower as f32));
        let (ix, iy) = (px as usize, py as usize);
        let (fx, fy) = (px - ix as f32, py - iy as f32);
        let (jx, jy) = ((ix + 1).min(right), (iy + 1).min(lower));
        let top = mask.at(ix, iy) + fx * (mask.at(jx, iy) - mask.at(ix, iy));
        let bottom = mask.at(ix, jy) + fx * (mask.at(jx, jy) - mask.at(ix, jy));
        top + fy * (bottom - top)
    })
}

/// The power of two between two sizes of one side.
fn factor(small: usize, large: usize) -> usize {
    let mut factor = 1;
    while large.div_ceil(factor) > small {
        factor *= 2;
    }
    factor
}

struct GuidedFilter {
    mean: Plane,
    variance: Plane,
}

impl GuidedFilter {
    fn new(guide: &Plane) -> GuidedFilter {
        let mean = box_mean(guide);
        let mut variance = box_mean(&product(guide, guide));
        for (v, m) in variance.values_mut().iter_mut().zip(mean.values()) {
            *v -= m * m;
        }
        GuidedFilter { mean, variance }
    }

    fn apply(&self, guide: &Plane, input: &Plane) -> Plane {
        let input_mean = box_mean(input);
        let mut slope = box_mean(&product(guide, input));
        let mut offset = input_mean;
        for k in 0..slope.values().len() {
            let covariance = slope.values()[k] - self.mean.values()[k] * offset.values()[k];
            let a = covariance / (self.variance.values()[k].max(0.0) + FLAT_VARIANCE);
            slope.values_mut()[k] = a;
            offset.values_mut()[k] -= a * self.mean.values()[k];
        }
        let mut out = product(&box_mean(&slope), guide);
        for (o, b) in out.values_mut().iter_mut().zip(box_mean(&offset).values()) {
            *o += b;
        }
        out
    }
}

fn product(a: &Plane, b: &Plane) -> Plane {
    let mut out = a.clone();
    out.values_mut().iter_mut().zip(b.values()).for_each(|(o, b)| *o *= b);
    out
}

/// Mean over (2·RADIUS + 1)² windows, borders replicated.
fn box_mean(plane: &Plane) -> Plane {
    let (width, height) = (plane.width(), plane.height());
    let weight = 1.0 / (2 * RADIUS + 1) as f32;
    let mut vertical = Plane::filled(width, height, 0.0);
    for y in 0..height {
        let out = vertical.row_mut(y);
        for k in 0..=2 * RADIUS {
            let source = plane.row((y + k).saturating_sub(RADIUS).min(height - 1));
            out.iter_mut().zip(source).for_each(|(o, s)| *o += s);
        }
        out.iter_mut().for_each(|o| *o *= weight);
    }
    let mut padded = vec![0.0; width + 2 * RADIUS];
    for y in 0..height {
        let row = vertical.row_mut(y);
        padded[..RADIUS].fill(row[0]);
        padded[RADIUS..RADIUS + width].copy_from_slice(row);
        padded[RADIUS + width..].fill(row[width - 1]);
        row.fill(0.0);
        for k in 0..=2 * RADIUS {
            row.iter_mut().zip(&padded[k..]).for_each(|(o, s)| *o += s);
        }
        row.iter_mut().for_each(|o| *o *= weight);
    }
    vertical
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mask_follows_the_edge_of_the_full_frame() {
        // The true edge lies at x = 33, which half size cannot say.
        let guide = Plane::from_fn(64, 48, |x, _| if x < 33 { 40.0 } else { 200.0 });
        let labels: Vec<u8> = (0..32 * 24).map(|p| u8::from(p % 32 >= 17)).collect();
        let full = upsample(&labels, [32, 24], 2, &guide);
        for y in 4..44 {
            let row: Vec<u8> = full[y * 64..(y + 1) * 64].to_vec();
            let expected: Vec<u8> = (0..64).map(|x| u8::from(x >= 33)).collect();
            assert_eq!(row, expected);
        }
    }
}
