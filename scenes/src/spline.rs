//! Cubic B-splines on a raster: smooth interpolation of textures between pixels.

/// A cubic B-spline surface with coefficients on the integer grid, mirrored at the borders.
#[derive(Clone, Debug)]
pub(super) struct Spline {
    width: usize,
    height: usize,
    coefficients: Vec<f32>,
}

impl Spline {
    /// The spline with the given coefficients, which it smooths.
    pub(super) fn smoothing(width: usize, height: usize, coefficients: Vec<f32>) -> Self {
        Spline { width, height, coefficients }
    }

    /// The spline that interpolates the given values (Unser, IEEE Signal Processing Magazine 16(6), 1999).
    pub(super) fn interpolating(width: usize, height: usize, mut values: Vec<f32>) -> Self {
        let mut line = Vec::new();
        for row in values.chunks_exact_mut(width) {
            line.clear();
            line.extend(row.iter().map(|&v| f64::from(v)));
            prefilter(&mut line);
            row.iter_mut().zip(&line).for_each(|(v, &c)| *v = c as f32);
        }
        for x in 0..width {
            line.clear();
            line.extend(values[x..].iter().step_by(width).map(|&v| f64::from(v)));
            prefilter(&mut line);
            values[x..].iter_mut().step_by(width).zip(&line).for_each(|(v, &c)| *v = c as f32);
        }
        Spline { width, height, coefficients: values }
    }

    /// Value at (x, y).
    pub(super) fn at(&self, x: f64, y: f64) -> f32 {
        let (column, row) = (x.floor(), y.floor());
        let (wx, wy) = (weights((x - column) as f32), weights((y - row) as f32));
        let (column, row) = (column as i64 - 1, row as i64 - 1);
        let columns: [usize; 4] = std::array::from_fn(|k| mirrored(column + k as i64, self.width));
        let mut sum = 0.0;
        for (k, weight) in wy.into_iter().enumerate() {
            let start = mirrored(row + k as i64, self.height) * self.width;
            let line = &self.coefficients[start..start + self.width];
            sum += weight
                * (wx[0] * line[columns[0]]
                    + wx[1] * line[columns[1]]
                    + wx[2] * line[columns[2]]
                    + wx[3] * line[columns[3]]);
        }
        sum
    }
}

/// The four cubic B-spline weights at the fraction f of a pixel, 0 to 1.
fn weights(f: f32) -> [f32; 4] {
    let g = 1.0 - f;
    [g * g * g / 6.0, 2.0 / 3.0 - f * f * (1.0 - 0.5 * f), 2.0 / 3.0 - g * g * (1.0 - 0.5 * g), f * f * f / 6.0]
}

/// The index of element i of a sequence mirrored at its first and last element.
fn mirrored(i: i64, length: usize) -> usize {
    let last = length as i64 - 1;
    if last < 1 {
        return 0;
    }
    let m = i.rem_euclid(2 * last);
    m.min(2 * last - m) as usize
}

/// Converts the values of a line to B-spline coefficients, mirrored at the ends.
fn prefilter(line: &mut [f64]) {
    let n = line.len();
    if n < 2 {
        return;
    }
    let pole = 3.0_f64.sqrt() - 2.0;
    line.iter_mut().for_each(|v| *v *= 6.0);
    // The sum over the mirrored past ends after 24 terms: pole²⁴ < 10⁻¹³.
    let (mut first, mut power) = (0.0, 1.0);
    for k in 0..24 {
        first += power * line[mirrored(k, n)];
        power *= pole;
    }
    line[0] = first;
    for k in 1..n {
        line[k] += pole * line[k - 1];
    }
    line[n - 1] = pole / (pole * pole - 1.0) * (line[n - 1] + pole * line[n - 2]);
    for k in (0..n - 1).rev() {
        line[k] = pole * (line[k + 1] - line[k]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_interpolates_its_values_and_reproduces_a_parabola() {
        let f = |x: f64, y: f64| 3.0 + 0.5 * x - 0.25 * y + 0.02 * x * x - 0.01 * x * y;
        let values = (0..40 * 30).map(|p| f((p % 40) as f64, (p / 40) as f64) as f32).collect();
        let spline = Spline::interpolating(40, 30, values);
        for (x, y) in [(0.0, 0.0), (39.0, 29.0), (7.0, 12.0)] {
            assert!((f64::from(spline.at(x, y)) - f(x, y)).abs() < 1e-4);
        }
        for (x, y) in [(20.5, 14.5), (18.3, 15.9)] {
            assert!((f64::from(spline.at(x, y)) - f(x, y)).abs() < 1e-4);
        }
        assert_eq!(spline.at(-3.0, 4.0), spline.at(3.0, 4.0));
    }
}
