//! Generated scenes: the ground truth agrees with the frames, and the same options give the same bytes on every platform.
#![allow(clippy::unwrap_used, reason = "test code may panic")]

use crate::hash;
use scenes::{Background, Scene, SceneOptions, Speed};
use veronese::{AffineMotion, Plane};

/// Cubic convolution (Catmull–Rom) at (x, y); `None` within two pixels of the border.
fn sample(plane: &Plane, x: f64, y: f64) -> Option<f64> {
    let (column, row) = (x.floor(), y.floor());
    if column < 1.0 || row < 1.0 || column + 2.0 >= plane.width() as f64 || row + 2.0 >= plane.height() as f64 {
        return None;
    }
    let weights = |f: f64| {
        let (f2, f3) = (f * f, f * f * f);
        [-0.5 * f3 + f2 - 0.5 * f, 1.5 * f3 - 2.5 * f2 + 1.0, -1.5 * f3 + 2.0 * f2 + 0.5 * f, 0.5 * f3 - 0.5 * f2]
    };
    let (wx, wy) = (weights(x - column), weights(y - row));
    let mut sum = 0.0;
    for (j, &b) in wy.iter().enumerate() {
        for (i, &a) in wx.iter().enumerate() {
            sum += a * b * f64::from(plane.at(column as usize + i - 1, row as usize + j - 1));
        }
    }
    Some(sum)
}

/// For each label, the root mean square difference between `first` and `second`, warped back and with its brightness restored, and the
/// number of pixels: those at least three pixels away from other labels and from occluded pixels.
fn residuals(scene: &Scene, motions: &[AffineMotion]) -> Vec<(f64, usize)> {
    let (width, height) = (scene.options.width, scene.options.height);
    let mut sums = vec![(0.0, 0usize); motions.len()];
    for y in 3..height - 3 {
        for x in 3..width - 3 {
            let p = y * width + x;
            let label = scene.labels[p];
            let inner = (y - 3..=y + 3).all(|v| {
                (x - 3..=x + 3).all(|u| scene.labels[v * width + u] == label && !scene.occluded[v * width + u])
            });
            if !inner {
                continue;
            }
            let [u, v] = motions[usize::from(label)].flow(x as f64, y as f64);
            if let Some(value) = sample(scene.second().luminance(), x as f64 + u, y as f64 + v) {
                let restored = (value - scene.options.bias) / scene.options.gain;
                let r = restored - f64::from(scene.first().luminance().at(x, y));
                let sum = &mut sums[usize::from(label)];
                *sum = (sum.0 + r * r, sum.1 + 1);
            }
        }
    }
    sums.into_iter().map(|(sum, count)| ((sum / count.max(1) as f64).sqrt(), count)).collect()
}

#[test]
fn warping_by_the_true_motions_restores_the_first_frame() {
    for (k, mut options) in SceneOptions::series(40, &[(200, 150)]).into_iter().enumerate() {
        options.noise = 0.0;
        options.colour = k % 2 == 1;
        let scene = scenes::generate(&options).unwrap();
        assert!(scene.motions.len() > 1, "scene {k} has no objects");
        let truth = residuals(&scene, &scene.motions);
        let wrong: Vec<_> = scene
            .motions
            .iter()
            .map(|m| {
                let a = m.matrix;
                AffineMotion::new([a[0], a[1], a[2] + 0.6, a[3], a[4], a[5] - 0.6])
            })
            .collect();
        let shifted = residuals(&scene, &wrong);
        for (label, (&(rms, count), &(other, _))) in truth.iter().zip(&shifted).enumerate() {
            assert!(count > 100, "scene {k}, label {label}: {count} pixels");
            // The rest is interpolation by the test and rounding to eight bits.
            assert!(rms < 2.0 && rms < 0.4 * other, "scene {k}, label {label}: rms {rms}, wrong motion {other}");
        }
    }
}

#[test]
fn occluded_pixels_are_those_hidden_or_outside() {
    let mut options =
        SceneOptions { speed: Speed::Large, background: Background::Static, seed: 5, ..Default::default() };
    options.noise = 0.0;
    let scene = scenes::generate(&options).unwrap();
    // Static background, away from blurred borders: pixels that are visible in both frames are equal in both.
    let (mut seen, mut hidden) = ((0.0, 0), (0.0, 0));
    for y in 3..237 {
        for x in 3..317 {
            let p = y * 320 + x;
            let same = (y - 3..=y + 3).all(|v| {
                (x - 3..=x + 3).all(|u| {
                    let q = v * 320 + u;
                    scene.labels[q] == 0 && scene.occluded[q] == scene.occluded[p]
                })
            });
            if same {
                let change = scene.second().luminance().at(x, y) - scene.first().luminance().at(x, y);
                let sum = if scene.occluded[p] { &mut hidden } else { &mut seen };
                *sum = (sum.0 + f64::from(change.abs()), sum.1 + 1);
            }
        }
    }
    assert!(seen.1 > 20_000 && seen.0 < 0.01 * f64::from(seen.1), "{seen:?}");
    assert!(hidden.1 > 100 && hidden.0 > 10.0 * f64::from(hidden.1), "{hidden:?}");
    // With a moving camera, a strip of the background leaves the frame.
    let moving = scenes::generate(&SceneOptions { objects: 0, speed: Speed::Large, ..Default::default() }).unwrap();
    for y in 0..240 {
        for x in 0..320 {
            let [u, v] = moving.motions[0].flow(x as f64, y as f64);
            let (x_, y_) = (x as f64 + u, y as f64 + v);
            let outside = x_ < -0.5 || y_ < -0.5 || x_ >= 319.5 || y_ >= 239.5;
            assert_eq!(moving.occluded[y * 320 + x], outside, "({x}, {y})");
        }
    }
}

#[test]
fn options_out_of_range_are_rejected() {
    let ok = SceneOptions { width: 32, height: 32, ..Default::default() };
    let code = |o: SceneOptions| scenes::generate(&o).map(|_| ()).unwrap_err().code();
    assert_eq!(code(SceneOptions { width: 15, ..ok }), "frame-size-unsupported");
    assert_eq!(code(SceneOptions { height: 4097, ..ok }), "frame-size-unsupported");
    assert_eq!(code(SceneOptions { objects: 9, ..ok }), "invalid-option");
    assert_eq!(code(SceneOptions { noise: f64::NAN, ..ok }), "invalid-option");
    assert_eq!(code(SceneOptions { noise: -1.0, ..ok }), "invalid-option");
    assert_eq!(code(SceneOptions { gain: 0.0, ..ok }), "invalid-option");
    assert_eq!(code(SceneOptions { bias: f64::INFINITY, ..ok }), "invalid-option");
    assert_eq!(code(SceneOptions { blur: -0.1, ..ok }), "invalid-option");
    assert!(scenes::generate(&SceneOptions { width: 16, height: 16, objects: 8, ..ok }).is_ok());
    assert!(scenes::generate(&SceneOptions { objects: 0, ..ok }).unwrap().labels.iter().all(|&l| l == 0));
}

fn hash_of(scene: &Scene) -> u64 {
    let pixels = scene.rgba.iter().flatten().copied();
    let occluded = scene.occluded.iter().map(|&o| u8::from(o));
    let motions = scene.motions.iter().flat_map(|m| m.matrix).flat_map(|a| a.to_bits().to_le_bytes());
    hash(pixels.chain(scene.labels.iter().copied()).chain(occluded).chain(motions))
}

/// One scene of every kind: what a scene shows and claims changes only on purpose.
#[test]
fn the_same_seed_gives_the_same_bytes_on_every_machine() {
    let small = SceneOptions { width: 96, height: 64, seed: 99, ..SceneOptions::default() };
    let slow = SceneOptions { speed: Speed::Creeping, background: Background::Static, ..small };
    let colour = SceneOptions { colour: true, ..small }.with_drawn_camera();
    for (scene, expected) in [
        (scenes::generate(&colour), "31adf922886e66fc"),
        (scenes::generate(&slow), "e473519d7a17f54e"),
        (scenes::leader_follower(1), "f0155a546e06d78a"),
        (scenes::bare_ground(5), "63f098d37eb628ff"),
        (scenes::parallax(4), "11e0e8d8f0e01294"),
    ] {
        assert_eq!(format!("{:016x}", hash_of(&scene.unwrap())), expected);
    }
}
