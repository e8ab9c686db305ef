//! Rendering of layers to frames and their ground truth.

use super::layer::{Layer, Sprite};
use super::shape::Shape;
use super::warp::Warp;
use super::{Scene, SceneOptions};
use veronese::{AffineMotion, Error, Frame, MAX_SIDE, MIN_SIDE, Random, Result};

/// Renders the frames at t = −1, 0, 1. The layers are in order of depth: the first is the background, the last the nearest.
pub(super) fn render(layers: &[Layer], options: &SceneOptions, random: &mut Random) -> Result<Scene> {
    let (width, height) = (options.width, options.height);
    let mut rgba: [Vec<u8>; 3] = Default::default();
    let mut labels: [Vec<u8>; 3] = Default::default();
    for t in 0..3 {
        let (mut image, visible) =
            compose(layers.iter().map(|layer| (&layer.sprite, origin(&layer.motion, t))), width, height);
        blur(&mut image, width, height, options.blur);
        labels[t] = visible;
        let (gain, bias) = match t {
            0 => (1.0 / options.gain, -options.bias),
            1 => (1.0, 0.0),
            _ => (options.gain, options.bias),
        };
        rgba[t] = exposed(&image, gain as f32, bias as f32, options.noise, random);
    }
    let frame = |t: usize| Frame::from_rgba(width, height, &rgba[t]);
    let motions: Vec<AffineMotion> = layers.iter().map(|l| l.motion).collect();
    let occluded = occlusion(&motions, &labels[1], &labels[2], width, height);
    let [_, truth, _] = labels;
    Ok(Scene { frames: [frame(0)?, frame(1)?, frame(2)?], rgba, labels: truth, motions, occluded, options: *options })
}

/// From frame t (0, 1, 2 for before, first, second) to `first`, as an object with this motion sees it.
fn origin(motion: &AffineMotion, t: usize) -> Warp {
    match t {
        0 => Warp::of(motion),
        1 => Warp::of(&AffineMotion::STATIC),
        _ => Warp::of(motion).inverse(),
    }
}

/// The image of sprites from back to front without blur, and the index of the visible sprite at every pixel. The warps go from the
/// frame to the sprite.
pub(super) fn compose<'a>(
    sprites: impl Iterator<Item = (&'a Sprite, Warp)>,
    width: usize,
    height: usize,
) -> (Vec<[f32; 3]>, Vec<u8>) {
    let mut image = vec![[0.0f32; 3]; width * height];
    let mut labels = vec![0u8; width * height];
    for (index, (sprite, warp)) in sprites.enumerate() {
        each_covered(sprite.shape.as_ref(), &warp, [width, height], |p, [u, v], cover| {
            let new = sprite.texture.at(u + sprite.offset[0], v + sprite.offset[1]);
            for k in 0..3 {
                image[p][k] += cover * (new[k] - image[p][k]);
            }
            if cover > 0.5 {
                labels[p] = index as u8;
            }
        });
    }
    (image, labels)
}

/// Calls `paint` for every pixel of a frame that a shape covers at least in part: its index, its place in the coordinates of the shape,
/// the share that is covered. No shape covers everything.
pub(super) fn each_covered(
    shape: Option<&(Shape, [f64; 2])>,
    warp: &Warp,
    [width, height]: [usize; 2],
    mut paint: impl FnMut(usize, [f64; 2], f32),
) {
    for y in 0..height {
        for x in 0..width {
            let [u, v] = warp.at(x as f64, y as f64);
            let cover = match shape {
                None => 1.0,
                Some((shape, centre)) => {
                    let (dx, dy) = (u - centre[0], v - centre[1]);
                    let reach = shape.reach() + 2.0;
                    if dx * dx + dy * dy > reach * reach {
                        continue;
                    }
                    shape.coverage(dx, dy) as f32
                }
            };
            if cover > 0.0 {
                paint(y * width + x, [u, v], cover);
            }
        }
    }
}

/// The blur of the camera: a Gaussian of standard deviation `sigma` pixels.
pub(super) fn blur(image: &mut [[f32; 3]], width: usize, height: usize, sigma: f64) {
    if sigma <= 0.0 {
        return;
    }
    let reach = libm::ceil(3.0 * sigma) as i64;
    let mut kernel: Vec<f64> = (-reach..=reach).map(|k| libm::exp(-((k * k) as f64) / (2.0 * sigma * sigma))).collect();
    let sum: f64 = kernel.iter().sum();
    kernel.iter_mut().for_each(|k| *k /= sum);
    let mut pass = |step: usize, length: usize, starts: usize, next: usize| {
        let mut line = vec![[0.0f32; 3]; length];
        for start in (0..starts).map(|s| s * next) {
            for (i, value) in line.iter_mut().enumerate() {
                *value = image[start + i * step];
            }
            for i in 0..length {
                let mut sum = [0.0f32; 3];
                for (k, &weight) in kernel.iter().enumerate() {
                    let j = (i as i64 + k as i64 - reach).clamp(0, length as i64 - 1) as usize;
                    for c in 0..3 {
                        sum[c] += weight as f32 * line[j][c];
                    }
                }
                image[start + i * step] = sum;
            }
        }
    };
    pass(1, width, height, width);
    pass(width, height, width, 1);
}

/// RGBA bytes of an image after gain, bias and noise of standard deviation `noise`·√(I/128), which is equal in all channels.
pub(super) fn exposed(image: &[[f32; 3]], gain: f32, bias: f32, noise: f64, random: &mut Random) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(image.len() * 4);
    for pixel in image {
        let value = pixel.map(|c| c.clamp(0.0, 255.0) * gain + bias);
        let luminance = 0.299 * value[0] + 0.587 * value[1] + 0.114 * value[2];
        let level = f64::from(luminance.clamp(10.0, 255.0));
        let error = (noise * (level / 128.0).sqrt() * random.normal()) as f32;
        bytes.extend(value.map(|c| (c + error).round().clamp(0.0, 255.0) as u8));
        bytes.push(255);
    }
    bytes
}

/// Whether a pixel of `first` leaves the image or moves to a pixel where `second` shows another layer.
fn occlusion(motions: &[AffineMotion], first: &[u8], second: &[u8], width: usize, height: usize) -> Vec<bool> {
    (0..first.len())
        .map(|p| {
            let (x, y) = ((p % width) as f64, (p / width) as f64);
            let [u, v] = motions[usize::from(first[p])].flow(x, y);
            let (x, y) = ((x + u).round(), (y + v).round());
            let inside = x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64;
            !inside || second[y as usize * width + x as usize] != first[p]
        })
        .collect()
}

/// Checks the ranges of the options.
pub(super) fn check(options: &SceneOptions) -> Result<()> {
    let bad = |name, reason: &str| Err(Error::InvalidOption { name, reason: reason.to_owned() });
    let (width, height) = (options.width, options.height);
    let sides = MIN_SIDE..=MAX_SIDE;
    if !sides.contains(&width) || !sides.contains(&height) {
        return Err(Error::FrameSizeUnsupported { width, height, min: *sides.start(), max: *sides.end() });
    }
    if options.objects > super::MAX_OBJECTS {
        return bad("objects", &format!("must be from 0 to {}, not {}", super::MAX_OBJECTS, options.objects));
    }
    if !(0.0..=50.0).contains(&options.noise) {
        return bad("noise", &format!("must be from 0 to 50 grey levels, not {}", options.noise));
    }
    if !(0.5..=2.0).contains(&options.gain) {
        return bad("gain", &format!("must be from 0.5 to 2, not {}", options.gain));
    }
    if !(-100.0..=100.0).contains(&options.bias) {
        return bad("bias", &format!("must be from -100 to 100 grey levels, not {}", options.bias));
    }
    if !(0.0..=5.0).contains(&options.blur) {
        return bad("blur", &format!("must be from 0 to 5 pixels, not {}", options.blur));
    }
    Ok(())
}
