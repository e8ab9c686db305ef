//! Outlines of objects and of the patches in a texture.

use std::f64::consts::PI;

use veronese::Random;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Blob,
    Ellipse,
    Rectangle,
}

/// An outline around the origin with about the area of a circle of `radius`.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    kind: Kind,
    radius: f64,
    /// Cosine and sine of the direction of its long axis.
    axis: [f64; 2],
    /// Square root of the ratio of its axes.
    stretch: f64,
    /// Relative radius of a blob as a Fourier series: cosine and sine coefficients from the second harmonic on.
    harmonics: [[f64; 2]; 5],
}

impl Shape {
    pub(super) fn draw(random: &mut Random, kind: Kind, radius: f64) -> Shape {
        let stretch = random.uniform(0.6, 1.6).sqrt();
        let direction = random.uniform(0.0, PI);
        let harmonics = std::array::from_fn(|k| {
            let amplitude = random.uniform(0.0, 0.16) / ((k + 1) as f64).sqrt();
            let phase = random.uniform(0.0, 2.0 * PI);
            [amplitude * libm::cos(phase), amplitude * libm::sin(phase)]
        });
        Shape { kind, radius, axis: [libm::cos(direction), libm::sin(direction)], stretch, harmonics }
    }

    /// A shape with its long axis in the direction `axis` (unit length), `ratio` times as long as the short axis.
    pub(super) fn oriented(kind: Kind, radius: f64, axis: [f64; 2], ratio: f64) -> Shape {
        Shape { kind, radius, axis, stretch: ratio.sqrt(), harmonics: [[0.0; 2]; 5] }
    }

    /// Upper bound of the distance of its points from the origin.
    pub(super) fn reach(&self) -> f64 {
        let longest = self.stretch.max(1.0 / self.stretch);
        match self.kind {
            Kind::Ellipse => longest * self.radius,
            Kind::Rectangle => longest * 1.26 * self.radius,
            Kind::Blob => {
                let sum: f64 = self.harmonics.iter().map(|h| (h[0] * h[0] + h[1] * h[1]).sqrt()).sum();
                longest * (1.0 + sum) * self.radius
            }
        }
    }

    /// Share of the pixel at (x, y) that is inside, to first order, 0 to 1.
    pub(super) fn coverage(&self, x: f64, y: f64) -> f64 {
        let value = self.implicit(x, y);
        if value.abs() > 3.0 {
            return if value < 0.0 { 1.0 } else { 0.0 };
        }
        // To first order, the distance from the border is the value divided by its slope.
        let slope_x = self.implicit(x + 0.5, y) - self.implicit(x - 0.5, y);
        let slope_y = self.implicit(x, y + 0.5) - self.implicit(x, y - 0.5);
        let slope = (slope_x * slope_x + slope_y * slope_y).sqrt().max(0.2);
        (0.5 - value / slope).clamp(0.0, 1.0)
    }

    /// An implicit function of the outline: negative inside, positive outside, approximately a distance in pixels.
    fn implicit(&self, x: f64, y: f64) -> f64 {
        let [c, s] = self.axis;
        let (a, b) = ((c * x + s * y) / self.stretch, (c * y - s * x) * self.stretch);
        match self.kind {
            Kind::Ellipse => (a * a + b * b).sqrt() - self.radius,
            // Half the side of a square with the area of the circle is r √π / 2.
            Kind::Rectangle => a.abs().max(b.abs()) - 0.886_226_925_452_758 * self.radius,
            Kind::Blob => {
                let distance = (a * a + b * b).sqrt();
                let (u, v) = if distance > 1e-9 { (a / distance, b / distance) } else { (1.0, 0.0) };
                // The harmonics are powers of u + iv, which avoids trigonometric functions.
                let (mut re, mut im) = (u, v);
                let mut outline = 1.0;
                for h in &self.harmonics {
                    (re, im) = (re * u - im * v, re * v + im * u);
                    outline += h[0] * re + h[1] * im;
                }
                distance - outline * self.radius
            }
        }
    }
}
