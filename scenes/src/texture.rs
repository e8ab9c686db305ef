//! Procedural textures with the statistics of natural images: the dead leaves model (patches of all sizes that occlude each other). Patches
//! are flat, shaded, rough or striped, under uneven light.

use std::f64::consts::PI;

use super::shape::{Kind, Shape};
use super::spline::Spline;
use veronese::Random;

/// Weights of red, green and blue in the luminance (Rec. 601, as in [`Frame`](veronese::Frame)).
const LUMINANCE: [f32; 3] = [0.299, 0.587, 0.114];
/// Maximum number of patches.
const MOST_PATCHES: usize = 4000;
/// Patches of a smaller radius, in pixels, are details with a level and a colour near those of the patch below.
const DETAIL: f64 = 9.0;

/// A texture: one spline per channel (one for grey, three for colour).
#[derive(Clone, Debug)]
pub(super) struct Texture {
    channels: Vec<Spline>,
    /// Standard deviation of its luminance, grey levels.
    pub(super) contrast: f64,
}

/// Parameters of a kind of texture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Style {
    /// Total area of the patches relative to the area of the texture.
    patches: f64,
    /// Radius of the smallest patch in pixels, and of the largest as a share of the shorter side.
    radii: [f64; 2],
    /// Standard deviation of the noise of rough patches, grey levels.
    roughness: f64,
    /// Share of patches without roughness.
    flat: f64,
    /// Amplitude of an octave of the roughness relative to the next finer one.
    persistence: f64,
}

impl Style {
    /// Objects of all sizes, half of them smooth.
    pub(super) const THINGS: Style =
        Style { patches: 2.2, radii: [4.0, 0.35], roughness: 12.0, flat: 0.45, persistence: 1.4 };
    /// Grass, gravel, foliage: rough everywhere, few patches.
    pub(super) const GROUND: Style =
        Style { patches: 0.5, radii: [3.0, 0.2], roughness: 26.0, flat: 0.1, persistence: 1.25 };
    /// Walls and floors: large uniform areas with details.
    pub(super) const WALLS: Style =
        Style { patches: 1.2, radii: [6.0, 0.7], roughness: 7.0, flat: 0.5, persistence: 1.6 };

    /// Distant asphalt: nearly uniform, with a few small marks.
    pub(super) const BARE: Style =
        Style { patches: 0.006, radii: [1.5, 0.02], roughness: 1.0, flat: 0.0, persistence: 1.25 };

    pub(super) fn draw(random: &mut Random) -> Style {
        [Style::THINGS, Style::GROUND, Style::WALLS][random.below(3)]
    }
}

/// The appearance of a patch.
struct Paint {
    /// Grey level at the centre.
    level: f64,
    /// Change of the level per pixel.
    shade: [f64; 2],
    roughness: f64,
    tint: [f32; 3],
    /// Amplitude in grey levels, and phase per pixel in x and y.
    stripes: [f64; 3],
}

impl Texture {
    pub(super) fn draw(random: &mut Random, style: &Style, width: usize, height: usize, colour: bool) -> Texture {
        let rough = roughness(random, width, height, style.persistence);
        let palette: [(f64, [f32; 3]); 5] = std::array::from_fn(|_| (random.uniform(25.0, 225.0), tint(random)));
        let side = width.min(height) as f64;

        let mut canvas = vec![[0.0f32; 3]; width * height];
        let ground = Paint::draw(random, style, &palette, side, false);
        for (p, pixel) in canvas.iter_mut().enumerate() {
            *pixel = ground.at((p % width) as f64 - 0.5 * side, (p / width) as f64 - 0.5 * side, rough[p]);
        }
        for radius in radii(random, style, width, height) {
            let kind = [Kind::Blob, Kind::Ellipse, Kind::Rectangle][random.below(3)];
            let shape = Shape::draw(random, kind, radius);
            let mut paint = Paint::draw(random, style, &palette, radius, true);
            let centre = [random.uniform(0.0, width as f64), random.uniform(0.0, height as f64)];
            if radius < DETAIL {
                // Marks rather than objects: near in level and colour to the patch below.
                let under = canvas[centre[1] as usize * width + centre[0] as usize];
                let grey: f32 = under.iter().zip(LUMINANCE).map(|(c, l)| c * l).sum();
                paint.level = f64::from(grey) + 22.0 * random.normal();
                paint.tint = under.map(|c| c / grey.max(1.0));
            }
            let reach = shape.reach() + 1.0;
            let span = |c: f64, n: usize| ((c - reach).max(0.0) as usize)..((c + reach).max(0.0) as usize + 1).min(n);
            for y in span(centre[1], height) {
                for x in span(centre[0], width) {
                    let (dx, dy) = (x as f64 - centre[0], y as f64 - centre[1]);
                    let cover = shape.coverage(dx, dy) as f32;
                    if cover > 0.0 {
                        let p = y * width + x;
                        let new = paint.at(dx, dy, rough[p]);
                        for k in 0..3 {
                            canvas[p][k] += cover * (new[k] - canvas[p][k]);
                        }
                    }
                }
            }
        }
        let light = [random.uniform(-0.3, 0.3) / width as f64, random.uniform(-0.3, 0.3) / height as f64];
        for (p, pixel) in canvas.iter_mut().enumerate() {
            let (x, y) = ((p % width) as f64 - 0.5 * width as f64, (p / width) as f64 - 0.5 * height as f64);
            let factor = (1.0 + light[0] * x + light[1] * y) as f32;
            // Compressed rather than clipped: a clipped texture has no gradient.
            *pixel = pixel.map(|v| soft(v * factor));
        }
        Texture::from_canvas(width, height, &canvas, colour)
    }

    fn from_canvas(width: usize, height: usize, canvas: &[[f32; 3]], colour: bool) -> Texture {
        let grey: Vec<f32> =
            canvas.iter().map(|c| LUMINANCE[0] * c[0] + LUMINANCE[1] * c[1] + LUMINANCE[2] * c[2]).collect();
        let count = grey.len().max(1) as f64;
        let mean = grey.iter().map(|&v| f64::from(v)).sum::<f64>() / count;
        let variance = grey.iter().map(|&v| (f64::from(v) - mean) * (f64::from(v) - mean)).sum::<f64>() / count;
        let channels = if colour {
            (0..3).map(|k| Spline::interpolating(width, height, canvas.iter().map(|c| c[k]).collect())).collect()
        } else {
            vec![Spline::interpolating(width, height, grey)]
        };
        Texture { channels, contrast: variance.sqrt() }
    }

    /// Red, green and blue at (x, y), 0 to 255.
    pub(super) fn at(&self, x: f64, y: f64) -> [f32; 3] {
        match self.channels.as_slice() {
            [red, green, blue] => [red.at(x, y), green.at(x, y), blue.at(x, y)],
            [grey, ..] => [grey.at(x, y); 3],
            [] => [0.0; 3],
        }
    }
}

impl Paint {
    fn draw(random: &mut Random, style: &Style, palette: &[(f64, [f32; 3])], size: f64, is_patch: bool) -> Paint {
        let (level, tint) = palette[random.below(palette.len())];
        let slope = random.uniform(0.0, 35.0) / size.max(4.0);
        let direction = random.uniform(0.0, 2.0 * PI);
        let flat = random.unit() < style.flat;
        let roughness = if flat { 0.0 } else { style.roughness * random.uniform(0.4, 1.4) };
        let period = random.uniform(4.0, 12.0);
        let along = random.uniform(0.0, PI);
        let striped = random.unit() < 0.12 && is_patch && size > 2.0 * period;
        let amplitude = if striped { random.uniform(8.0, 28.0) } else { 0.0 };
        Paint {
            level: level + 12.0 * random.normal(),
            shade: [slope * libm::cos(direction), slope * libm::sin(direction)],
            roughness,
            tint,
            stripes: [amplitude, 2.0 * PI / period * libm::cos(along), 2.0 * PI / period * libm::sin(along)],
        }
    }

    fn at(&self, dx: f64, dy: f64, rough: f32) -> [f32; 3] {
        let mut v = self.level + self.shade[0] * dx + self.shade[1] * dy + self.roughness * f64::from(rough);
        if self.stripes[0] > 0.0 {
            v += self.stripes[0] * libm::cos(self.stripes[1] * dx + self.stripes[2] * dy);
        }
        self.tint.map(|t| t * v as f32)
    }
}

/// Random factors of red, green and blue that preserve the luminance of grey.
fn tint(random: &mut Random) -> [f32; 3] {
    let raw: [f32; 3] = std::array::from_fn(|_| random.uniform(0.75, 1.25) as f32);
    let luminance = LUMINANCE[0] * raw[0] + LUMINANCE[1] * raw[1] + LUMINANCE[2] * raw[2];
    raw.map(|c| c / luminance)
}

/// Radii of the patches in random order, with density r⁻³: each octave of sizes covers the same area.
fn radii(random: &mut Random, style: &Style, width: usize, height: usize) -> Vec<f64> {
    let smallest = style.radii[0];
    let largest = (style.radii[1] * width.min(height) as f64).max(2.0 * smallest);
    let ratio = smallest / largest;
    let wanted = style.patches * (width * height) as f64;
    let (mut radii, mut area) = (Vec::new(), 0.0);
    while area < wanted && radii.len() < MOST_PATCHES {
        let r = smallest / (1.0 - random.unit() * (1.0 - ratio * ratio)).sqrt();
        area += PI * r * r;
        radii.push(r);
    }
    radii
}

/// Fractal noise of about unit standard deviation: six octaves of random splines, each rotated against the last to avoid a visible
/// lattice.
fn roughness(random: &mut Random, width: usize, height: usize, persistence: f64) -> Vec<f32> {
    let mut sum = vec![0.0f32; width * height];
    let (mut amplitude, mut power) = (1.0, 0.0);
    for octave in 0..6 {
        let cell = [1.6, 3.0, 6.0, 12.0, 25.0, 50.0][octave];
        let (c, s) = (libm::cos(octave as f64 * 0.7) / cell, libm::sin(octave as f64 * 0.7) / cell);
        let span = ((width as f64 * width as f64 + height as f64 * height as f64).sqrt() / cell) as usize + 6;
        let lattice = Spline::smoothing(span, span, (0..span * span).map(|_| random.normal() as f32).collect());
        // The spline reduces the variance of the lattice to about a quarter.
        power += 0.23 * amplitude * amplitude;
        for y in 0..height {
            for x in 0..width {
                let (x_, y_) = (x as f64, y as f64);
                sum[y * width + x] += amplitude as f32 * lattice.at(c * x_ - s * y_ + 2.0, s * x_ + c * y_ + 2.0);
            }
        }
        amplitude *= persistence;
    }
    let scale = (1.0 / f64::max(power, 1e-9).sqrt()) as f32;
    sum.iter_mut().for_each(|v| *v *= scale);
    sum
}

/// Compresses arbitrary grey levels to 4…251; unchanged between 30 and 225.
fn soft(v: f32) -> f32 {
    const TOE: f32 = 26.0;
    if v < 30.0 {
        let d = 30.0 - v;
        30.0 - TOE * d / (TOE + d)
    } else if v > 225.0 {
        let d = v - 225.0;
        225.0 + TOE * d / (TOE + d)
    } else {
        v
    }
}
