//! Generated scenes: the ground truth agrees with the frames, and the same options give the same bytes on every platform.
#![allow(clippy::unwrap_used, reason = "test code may panic")]

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use veronese::scene::{self, Background, Scene, SceneOptions, Speed};
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
        let scene = scene::generate(&options).unwrap();
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
fn the_residual_of_the_true_motions_is_the_noise() {
    let mut options = SceneOptions { width: 160, height: 120, objects: 1, noise: 0.0, seed: 3, ..Default::default() };
    options.background = Background::Static;
    let clean = residuals(&scene::generate(&options).unwrap(), &[AffineMotion::STATIC; 2])[0].0;
    options.noise = 4.0;
    let scene = scene::generate(&options).unwrap();
    let noisy = residuals(&scene, &[AffineMotion::STATIC; 2])[0].0;
    let mean: f64 = scene.first().luminance().values().iter().map(|&v| f64::from(v)).sum::<f64>() / (160.0 * 120.0);
    let expected = 4.0 * (2.0 * mean / 128.0).sqrt();
    assert!(clean < 0.01, "a static background differs by {clean}");
    assert!((noisy / expected - 1.0).abs() < 0.15, "{noisy} instead of {expected}");
}

#[test]
fn speeds_and_backgrounds_match_the_options() {
    for (speed, low, high) in [(Speed::SubPixel, 0.5, 1.5), (Speed::Medium, 1.5, 5.0), (Speed::Large, 5.0, 20.0)] {
        for seed in 0..3 {
            let options = SceneOptions { speed, background: Background::Static, seed, ..Default::default() };
            let scene = scene::generate(&options).unwrap();
            assert_eq!(scene.motions[0], AffineMotion::STATIC);
            for (label, motion) in scene.motions.iter().enumerate().skip(1) {
                let pixels: Vec<usize> =
                    (0..scene.labels.len()).filter(|&p| usize::from(scene.labels[p]) == label).collect();
                let mut mean = [0.0; 2];
                for &p in &pixels {
                    let flow = motion.flow((p % 320) as f64, (p / 320) as f64);
                    mean = [mean[0] + flow[0] / pixels.len() as f64, mean[1] + flow[1] / pixels.len() as f64];
                }
                // An object has the given speed at its centre. The mean over an object cut by the frame may differ a little.
                let speed = (mean[0] * mean[0] + mean[1] * mean[1]).sqrt();
                assert!(speed > 0.7 * low && speed < 1.2 * high, "seed {seed}: {speed} px");
            }
        }
    }
    let moving = scene::generate(&SceneOptions::default()).unwrap();
    assert_ne!(moving.motions[0], AffineMotion::STATIC);
}

#[test]
fn the_robots_are_small_and_move_alike() {
    let scene = scene::leader_follower(1).unwrap();
    assert_eq!((scene.first().width(), scene.first().height(), scene.motions.len()), (200, 150, 3));
    for label in 1..3 {
        let count = scene.labels.iter().filter(|&&l| l == label).count();
        assert!((600..1200).contains(&count), "robot {label} has {count} pixels");
    }
    let [_, leader, follower] = [scene.motions[0], scene.motions[1], scene.motions[2]];
    assert!((leader.matrix[1] - follower.matrix[1]).abs() < 0.02);
    assert_eq!(scene.motions[0], AffineMotion::STATIC);
    assert!(residuals(&scene, &scene.motions).iter().all(|r| r.0 < 4.0));
}

#[test]
fn a_bare_ground_is_nearly_even_and_its_cars_are_not() {
    for seed in [4, 5] {
        let scene = scene::bare_ground(seed).unwrap();
        let (width, height) = (scene.first().width(), scene.first().height());
        assert_eq!((width, height, scene.motions.len()), (384, 216, 3 + (seed % 2) as usize));
        assert_eq!(scene.motions[0], AffineMotion::STATIC);
        // Share of the pixels of a label with a step of more than twelve grey levels, ten standard deviations of the noise.
        let luminance = scene.first().luminance();
        let steep = |label: u8| {
            let inner = |p: usize| (scene.labels[p], scene.labels[p + 2]) == (label, label);
            let pixels: Vec<usize> = (0..width * height - 2).filter(|&p| p % width < width - 2 && inner(p)).collect();
            let step = |p: usize| (luminance.values()[p + 2] - luminance.values()[p]).abs();
            pixels.iter().filter(|&&p| step(p) > 12.0).count() as f64 / pixels.len() as f64
        };
        assert!(steep(0) < 0.02, "{}", steep(0));
        for label in 1..scene.motions.len() as u8 {
            assert!(steep(label) > 0.04, "car {label}: {}", steep(label));
        }
        assert!(residuals(&scene, &scene.motions).iter().all(|r| r.0 < 4.0));
    }
}

#[test]
fn occluded_pixels_are_those_hidden_or_outside() {
    let mut options =
        SceneOptions { speed: Speed::Large, background: Background::Static, seed: 5, ..Default::default() };
    options.noise = 0.0;
    let scene = scene::generate(&options).unwrap();
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
    let moving = scene::generate(&SceneOptions { objects: 0, speed: Speed::Large, ..Default::default() }).unwrap();
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
    let code = |o: SceneOptions| scene::generate(&o).map(|_| ()).unwrap_err().code();
    assert_eq!(code(SceneOptions { width: 15, ..ok }), "frame-size-unsupported");
    assert_eq!(code(SceneOptions { height: 4097, ..ok }), "frame-size-unsupported");
    assert_eq!(code(SceneOptions { objects: 9, ..ok }), "invalid-option");
    assert_eq!(code(SceneOptions { noise: f64::NAN, ..ok }), "invalid-option");
    assert_eq!(code(SceneOptions { noise: -1.0, ..ok }), "invalid-option");
    assert_eq!(code(SceneOptions { gain: 0.0, ..ok }), "invalid-option");
    assert_eq!(code(SceneOptions { bias: f64::INFINITY, ..ok }), "invalid-option");
    assert_eq!(code(SceneOptions { blur: -0.1, ..ok }), "invalid-option");
    assert!(scene::generate(&SceneOptions { width: 16, height: 16, objects: 8, ..ok }).is_ok());
    assert!(scene::generate(&SceneOptions { objects: 0, ..ok }).unwrap().labels.iter().all(|&l| l == 0));
}

/// FNV-1a, 64 bits.
fn hash(bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3))
}

fn hash_of(scene: &Scene) -> u64 {
    let pixels = scene.rgba.iter().flatten().copied();
    let occluded = scene.occluded.iter().map(|&o| u8::from(o));
    let motions = scene.motions.iter().flat_map(|m| m.matrix).flat_map(|a| a.to_bits().to_le_bytes());
    hash(pixels.chain(scene.labels.iter().copied()).chain(occluded).chain(motions))
}

#[test]
fn the_same_seed_gives_the_same_bytes_on_every_machine() {
    let options = SceneOptions { width: 96, height: 64, colour: true, seed: 99, ..SceneOptions::default() };
    let scene = scene::generate(&options.with_drawn_camera()).unwrap();
    assert_eq!(format!("{:016x}", hash_of(&scene)), "31adf922886e66fc");
    assert_eq!(format!("{:016x}", hash_of(&scene::leader_follower(1).unwrap())), "f0155a546e06d78a");
}

#[test]
fn the_slowest_objects_move_a_third_of_a_pixel() {
    for seed in 1..4 {
        let slow = SceneOptions { objects: 1, speed: Speed::Creeping, seed, ..SceneOptions::default() };
        let scene = scene::generate(&SceneOptions { width: 120, height: 90, ..slow }).unwrap();
        assert_eq!(scene.motions.len(), 2);
        let (background, object) = (scene.motions[0], scene.motions[1]);
        let own: Vec<usize> = (0..scene.labels.len()).filter(|&p| scene.labels[p] == 1).collect();
        let centre = |of: &dyn Fn(usize) -> usize| own.iter().map(|&p| of(p) as f64).sum::<f64>() / own.len() as f64;
        let (x, y) = (centre(&|p| p % 120), centre(&|p| p / 120));
        let ([u, v], [a, b]) = (background.flow(x, y), object.flow(x, y));
        let relative = ((u - a) * (u - a) + (v - b) * (v - b)).sqrt();
        assert!((relative - 0.3).abs() < 0.05, "{relative}");
    }
}
