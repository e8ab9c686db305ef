//! Synthetic scenes with exact ground truth, for the tests, benchmarks and examples of `veronese`: textured objects in affine motion in
//! front of a background.
//!
//! Three frames at t = −1, 0, 1 show the same layers. The ground truth is that of the middle frame, `first`. The layers have a fixed
//! depth order, so objects occlude each other and the background. Rendering has sub-pixel accuracy (cubic splines, anti-aliased
//! outlines). The camera adds blur, a change of brightness between frames, noise, and quantisation to eight bits. The same options give
//! the same bytes on every platform.
//!
//! [`protocol`] generates measurements without frames.
//!
//! ```
//! use scenes::SceneOptions;
//!
//! let scene = scenes::generate(&SceneOptions { objects: 3, seed: 7, ..SceneOptions::default() })?;
//! assert_eq!(scene.labels.len(), 320 * 240);
//! assert_eq!(scene.motions.len(), 4); // the background and three objects
//! # Ok::<(), veronese::Error>(())
//! ```

mod clip;
mod layer;
pub mod protocol;
mod render;
mod shape;
mod spline;
mod texture;
mod warp;

use std::f64::consts::PI;

use veronese::{AffineMotion, Frame, Random, Result};

pub use clip::{ClipScene, ClipSceneOptions, Event, MAX_CLIP_FRAMES, MIN_CLIP_FRAMES, Occurrence, generate_clip};
use layer::{RICH, background, object};
use shape::{Kind, Shape};
use texture::Style;

/// Largest number of objects in a scene.
pub const MAX_OBJECTS: usize = 8;

/// Speed of the objects relative to the background, and of the camera if it moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Speed {
    /// Objects 0.3 pixels per frame, camera 0.1.
    Creeping,
    /// Objects 0.5 to 1.5 pixels per frame, camera 0.2 to 1.
    SubPixel,
    /// Objects 1.5 to 5 pixels per frame, camera 0.5 to 3.
    Medium,
    /// Objects 5 to 20 pixels per frame (10 in frames narrower than 240 pixels), camera 2 to 10.
    Large,
}

/// Motion of the background.
///
/// ```
/// use veronese::AffineMotion;
/// use scenes::{Background, SceneOptions, generate};
///
/// let small = SceneOptions { width: 64, height: 48, ..SceneOptions::default() };
/// let still = generate(&SceneOptions { background: Background::Static, ..small })?;
/// let moving = generate(&SceneOptions { background: Background::Moving, ..small })?;
/// assert!(still.motions[0] == AffineMotion::STATIC && moving.motions[0] != AffineMotion::STATIC);
/// # Ok::<(), veronese::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Background {
    /// No motion.
    Static,
    /// The motion of a background seen by a moving camera: translation with some rotation, zoom and shear.
    Moving,
}

/// Contents of a scene and properties of the camera.
///
/// ```
/// use scenes::{SceneOptions, generate};
///
/// // The second frame is 20 % brighter.
/// let options = SceneOptions { width: 64, height: 48, objects: 0, gain: 1.2, ..SceneOptions::default() };
/// let scene = generate(&options)?;
/// let mean = |frame: &veronese::Frame| frame.luminance().values().iter().sum::<f32>() / (64.0 * 48.0);
/// let ratio = mean(scene.second()) / mean(scene.first());
/// assert!((1.1..1.3).contains(&ratio));
///
/// let wrong = SceneOptions { noise: f64::NAN, ..options };
/// assert_eq!(generate(&wrong).unwrap_err().code(), "invalid-option");
/// # Ok::<(), veronese::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneOptions {
    /// Width in pixels; default 320.
    pub width: usize,
    /// Height in pixels; default 240.
    pub height: usize,
    /// Number of objects, 0 to [`MAX_OBJECTS`]; default 2. The scene has fewer if they do not fit.
    pub objects: usize,
    /// Speed of objects and camera; default [`Speed::Medium`].
    pub speed: Speed,
    /// Motion of the background; default [`Background::Moving`].
    pub background: Background,
    /// Standard deviation of the noise at grey level 128, in grey levels, 0 to 50; default 2. It is proportional to √I.
    pub noise: f64,
    /// Gain of the second frame, whose intensity is `gain · I + bias`; that of the frame before is `I / gain − bias`. 0.5 to 2, default 1.
    pub gain: f64,
    /// Bias of the second frame (see `gain`), in grey levels, −100 to 100; default 0.
    pub bias: f64,
    /// Standard deviation of the Gaussian blur of the camera, in pixels, 0 to 5; default 0.65.
    pub blur: f64,
    /// Colour (`true`) or grey (`false`); default grey.
    pub colour: bool,
    /// Seed of everything else: textures, shapes, motions, noise; default 1.
    pub seed: u64,
}

impl Default for SceneOptions {
    fn default() -> Self {
        SceneOptions {
            width: 320,
            height: 240,
            objects: 2,
            speed: Speed::Medium,
            background: Background::Moving,
            noise: 2.0,
            gain: 1.0,
            bias: 0.0,
            blur: 0.65,
            colour: false,
            seed: 1,
        }
    }
}

impl SceneOptions {
    /// The same scene with a random camera, drawn from the seed: blur 0.5 to 0.8 pixels, noise 1 to 3 grey levels, gain 0.97 to 1.03,
    /// bias −3 to 3 grey levels.
    ///
    /// ```
    /// use scenes::SceneOptions;
    ///
    /// let options = SceneOptions::default().with_drawn_camera();
    /// assert!((0.5..0.8).contains(&options.blur) && (0.97..1.03).contains(&options.gain));
    /// assert_eq!(options, SceneOptions::default().with_drawn_camera());
    /// ```
    pub fn with_drawn_camera(mut self) -> Self {
        let mut random = Random::from_seed(self.seed ^ 0xCA3E_7A00);
        self.blur = random.uniform(0.5, 0.8);
        self.noise = random.uniform(1.0, 3.0);
        self.gain = random.uniform(0.97, 1.03);
        self.bias = random.uniform(-3.0, 3.0);
        self
    }

    /// A benchmark: for each size (width, height), one scene for each [`Background`] and each [`Speed`] from sub-pixel to large, six in
    /// all, with one to four objects and random cameras. The seeds are `seed`, `seed + 1`, ….
    ///
    /// ```
    /// use scenes::SceneOptions;
    ///
    /// let series = SceneOptions::series(40, &[(320, 240), (640, 480)]);
    /// assert_eq!((series.len(), series[11].width, series[11].seed), (12, 640, 51));
    /// ```
    pub fn series(seed: u64, sizes: &[(usize, usize)]) -> Vec<SceneOptions> {
        let mut series = Vec::new();
        for &(width, height) in sizes {
            for speed in [Speed::SubPixel, Speed::Medium, Speed::Large] {
                for background in [Background::Static, Background::Moving] {
                    let i = series.len();
                    let options = SceneOptions {
                        width,
                        height,
                        objects: 1 + (i * 7 / 2) % 4,
                        speed,
                        background,
                        seed: seed.wrapping_add(i as u64),
                        ..SceneOptions::default()
                    };
                    series.push(options.with_drawn_camera());
                }
            }
        }
        series
    }
}

/// Three frames, and the ground truth of the middle one.
///
/// ```
/// use scenes::{SceneOptions, generate};
///
/// let scene = generate(&SceneOptions { width: 96, height: 72, noise: 0.0, ..SceneOptions::default() })?;
/// let (first, second) = (scene.first().luminance(), scene.second().luminance());
/// // Visible pixels keep their intensity along their motion; here compared at the nearest pixel.
/// let mut differences = Vec::new();
/// for p in (0..96 * 72).filter(|&p| !scene.occluded[p]) {
///     let (x, y) = (p % 96, p / 96);
///     let [u, v] = scene.motions[usize::from(scene.labels[p])].flow(x as f64, y as f64);
///     let (x2, y2) = ((x as f64 + u).round() as usize, (y as f64 + v).round() as usize);
///     differences.push((second.at(x2, y2) - first.at(x, y)).abs());
/// }
/// differences.sort_by(f32::total_cmp);
/// assert!(differences[differences.len() / 2] < 5.0); // grey levels
/// # Ok::<(), veronese::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Scene {
    /// The frames before, first and second (t = −1, 0, 1).
    pub frames: [Frame; 3],
    /// The RGBA bytes of the frames, row by row.
    pub rgba: [Vec<u8>; 3],
    /// The visible layer at every pixel of `first`: 0 is the background, 1, 2, … the objects from back to front.
    pub labels: Vec<u8>,
    /// The motion of each layer from `first` to `second`, in pixels, in the order of the labels.
    pub motions: Vec<AffineMotion>,
    /// Whether a pixel of `first` is outside or hidden in `second`.
    pub occluded: Vec<bool>,
    /// The options of the scene.
    pub options: SceneOptions,
}

impl Scene {
    /// The frame at t = −1.
    pub fn before(&self) -> &Frame {
        &self.frames[0]
    }

    /// The frame at t = 0, to which the ground truth belongs.
    pub fn first(&self) -> &Frame {
        &self.frames[1]
    }

    /// The frame at t = 1.
    pub fn second(&self) -> &Frame {
        &self.frames[2]
    }
}

/// Ranges of speeds in pixels per frame, and bounds of the linear parts (see [`drawn_motion`]).
struct Ranges {
    object: [f64; 2],
    camera: [f64; 2],
    camera_linear: f64,
    object_linear: f64,
}

fn ranges(options: &SceneOptions) -> Ranges {
    let (object, camera, camera_linear, object_linear) = match options.speed {
        Speed::Creeping => ([0.3, 0.3], [0.1, 0.1], 0.1, 0.1),
        Speed::SubPixel => ([0.5, 1.5], [0.2, 1.0], 0.3, 0.5),
        Speed::Medium => ([1.5, 5.0], [0.5, 3.0], 0.8, 1.5),
        Speed::Large => ([5.0, if options.width < 240 { 10.0 } else { 20.0 }], [2.0, 10.0], 1.5, 3.0),
    };
    Ranges { object, camera, camera_linear, object_linear }
}

/// A random motion with the flow `translation` at `centre`, a rotation up to `amount` degrees, a zoom up to `amount` per cent and some
/// shear.
fn drawn_motion(random: &mut Random, centre: [f64; 2], translation: [f64; 2], amount: f64) -> AffineMotion {
    let angle = random.uniform(-amount, amount) * PI / 180.0;
    let zoom = 1.0 + random.uniform(-0.01, 0.01) * amount;
    let mut shear = || random.uniform(-0.003, 0.003) * amount;
    let (c, s) = (zoom * libm::cos(angle), zoom * libm::sin(angle));
    let linear = [c - 1.0 + shear(), -s + shear(), s + shear(), c - 1.0 + shear()];
    about(centre, translation, linear)
}

/// The motion with the flow `translation` at `centre` and the linear part `[a11, a12, a21, a22]`.
fn about(centre: [f64; 2], translation: [f64; 2], b: [f64; 4]) -> AffineMotion {
    let u = translation[0] - b[0] * centre[0] - b[1] * centre[1];
    let v = translation[1] - b[2] * centre[0] - b[3] * centre[1];
    AffineMotion::new([b[0], b[1], u, b[2], b[3], v])
}

/// Generates a scene. See the [example of the crate](self).
///
/// # Errors
/// [`Error::FrameSizeUnsupported`](veronese::Error::FrameSizeUnsupported); [`Error::InvalidOption`](veronese::Error::InvalidOption) for an
/// option out of the range given in [`SceneOptions`].
pub fn generate(options: &SceneOptions) -> Result<Scene> {
    render::check(options)?;
    let mut random = Random::from_seed(options.seed);
    let ranges = ranges(options);
    let (width, height) = (options.width as f64, options.height as f64);
    let polar = |length: f64, angle: f64| [length * libm::cos(angle), length * libm::sin(angle)];

    let shift = polar(random.uniform(ranges.camera[0], ranges.camera[1]), random.uniform(0.0, 2.0 * PI));
    let drawn = drawn_motion(&mut random, [0.5 * width, 0.5 * height], shift, ranges.camera_linear);
    let camera = if options.background == Background::Static { AffineMotion::STATIC } else { drawn };
    let margin = (2.2 * (ranges.object[1] + ranges.camera[1])).ceil() as usize + 4;
    let style = Style::draw(&mut random);
    let mut layers = vec![background(&mut random, options, camera, margin, (&style, RICH))];

    let mut placed: Vec<([f64; 2], f64)> = Vec::new();
    for _ in 0..400 {
        if placed.len() == options.objects {
            break;
        }
        let share = random.uniform(0.025, if options.objects > 1 { 0.12 } else { 0.2 });
        let radius = (share * width * height / PI).sqrt();
        let centre = [random.uniform(0.12, 0.88) * width, random.uniform(0.12, 0.88) * height];
        let relative = polar(random.uniform(ranges.object[0], ranges.object[1]), random.uniform(0.0, 2.0 * PI));
        let [u, v] = camera.flow(centre[0], centre[1]);
        let flow = [u + relative[0], v + relative[1]];
        let distance =
            |a: [f64; 2], b: [f64; 2]| ((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])).sqrt();
        let crowded = placed.iter().any(|&(c, r)| distance(c, centre) < 0.75 * (r + radius));
        let alike =
            layers[1..].iter().any(|l| distance(l.motion.flow(centre[0], centre[1]), flow) < 0.7 * ranges.object[0]);
        if crowded || alike {
            continue;
        }
        let motion = drawn_motion(&mut random, centre, flow, ranges.object_linear);
        let kind = [Kind::Blob, Kind::Blob, Kind::Ellipse, Kind::Rectangle][random.below(4)];
        let shape = Shape::draw(&mut random, kind, radius);
        let style = Style::draw(&mut random);
        layers.push(object(&mut random, options, motion, shape, centre, &style));
        placed.push((centre, radius));
    }
    render::render(&layers, options, &mut random)
}

/// A scene like that of Figures 2 and 3 of the paper: two small robots follow each other on a circle in front of a static background;
/// 200 × 150 pixels, grey. Labels are 0 for the background, 1 for the leader, 2 for the follower.
///
/// ```
/// use veronese::AffineMotion;
/// use scenes::leader_follower;
///
/// let scene = leader_follower(1)?;
/// assert_eq!((scene.first().width(), scene.first().height()), (200, 150));
/// assert_eq!((scene.motions.len(), scene.motions[0]), (3, AffineMotion::STATIC));
/// # Ok::<(), veronese::Error>(())
/// ```
///
/// # Errors
/// None in practice; the signature is that of [`generate`].
pub fn leader_follower(seed: u64) -> Result<Scene> {
    let options = SceneOptions {
        width: 200,
        height: 150,
        background: Background::Static,
        noise: 1.0,
        seed,
        ..SceneOptions::default()
    };
    let mut random = Random::from_seed(seed);
    let mut layers = vec![background(&mut random, &options, AffineMotion::STATIC, 8, (&Style::WALLS, RICH))];
    // Seen obliquely from above, the circle is an ellipse. The follower has its own, and is a little faster.
    let start = random.uniform(0.0, 2.0 * PI);
    let circle = [random.uniform(92.0, 108.0), random.uniform(70.0, 80.0)];
    for (behind, radius, speed) in [(0.0, 46.0, 1.9), (random.uniform(1.0, 1.5), 50.0, 2.4)] {
        let (c, s) = (libm::cos(start - behind), libm::sin(start - behind));
        let centre = [circle[0] + radius * c, circle[1] + 0.8 * radius * s];
        let turn: f64 = speed / radius;
        let linear = [libm::cos(turn) - 1.0, -libm::sin(turn), libm::sin(turn), libm::cos(turn) - 1.0];
        let motion = about(centre, [-speed * s, 0.8 * speed * c], linear);
        let length = (s * s + 0.64 * c * c).sqrt();
        let shape = Shape::oriented(Kind::Rectangle, 17.0, [-s / length, 0.8 * c / length], 1.5);
        layers.push(object(&mut random, &options, motion, shape, centre, &Style::THINGS));
    }
    render::render(&layers, &SceneOptions { objects: 2, ..options }, &mut random)
}

/// A camera moves sideways past a static scene, so near objects are displaced more than far ones: three objects at different depths in
/// front of a wall; 400 × 300 pixels, colour. Labels are 0 for the wall, 1 to 3 for the objects from far to near.
///
/// ```
/// use scenes::parallax;
///
/// let scene = parallax(4)?;
/// let speeds: Vec<f64> = scene.motions.iter().map(|motion| motion.flow(200.0, 150.0)[0].abs()).collect();
/// assert!(speeds.is_sorted());
/// # Ok::<(), veronese::Error>(())
/// ```
///
/// # Errors
/// None in practice; the signature is that of [`generate`].
pub fn parallax(seed: u64) -> Result<Scene> {
    let options = SceneOptions {
        width: 400,
        height: 300,
        objects: 3,
        background: Background::Moving,
        noise: 0.8,
        colour: true,
        seed,
        ..SceneOptions::default()
    };
    let mut random = Random::from_seed(seed);
    // Inverse depths of the wall and the objects. The camera also moves a little forward, towards the centre of the frame.
    let depths = [0.35, 0.8, 1.3, 2.0];
    let (sideways, forward) = (-4.0, 0.004);
    let moved = |inverse_depth: f64, centre: [f64; 2]| {
        let zoom = forward * inverse_depth;
        let [x, y] = [centre[0] - 200.0, centre[1] - 150.0];
        about(centre, [sideways * inverse_depth + zoom * x, zoom * y], [zoom, 0.0, 0.0, zoom])
    };
    let mut layers =
        vec![background(&mut random, &options, moved(depths[0], [200.0, 150.0]), 16, (&Style::WALLS, RICH))];
    let places = [[105.0, 95.0], [285.0, 115.0], [190.0, 225.0]];
    for ((place, &depth), (kind, radius)) in
        places.iter().zip(&depths[1..]).zip([(Kind::Rectangle, 40.0), (Kind::Blob, 48.0), (Kind::Ellipse, 56.0)])
    {
        let centre = place.map(|middle| middle + random.uniform(-12.0, 12.0));
        let shape = Shape::draw(&mut random, kind, radius);
        layers.push(object(&mut random, &options, moved(depth, centre), shape, centre, &Style::THINGS));
    }
    render::render(&layers, &options, &mut random)
}

/// Cars on nearly textureless ground, seen from above by a static camera: two cars in opposite directions, and with an odd seed a third
/// one across; 384 × 216 pixels, colour. Labels are 0 for the ground, 1, 2, … for the cars.
///
/// The scene is difficult because one affine motion fits all cars at once, and on the ground only a few small marks contradict it.
///
/// ```
/// use scenes::bare_ground;
///
/// assert_eq!(bare_ground(2)?.motions.len(), 3); // the ground and two cars
/// assert_eq!(bare_ground(3)?.motions.len(), 4);
/// # Ok::<(), veronese::Error>(())
/// ```
///
/// # Errors
/// None in practice; the signature is that of [`generate`].
pub fn bare_ground(seed: u64) -> Result<Scene> {
    let options = SceneOptions {
        width: 384,
        height: 216,
        objects: 2 + (seed % 2) as usize,
        background: Background::Static,
        noise: 1.2,
        colour: true,
        seed,
        ..SceneOptions::default()
    };
    let mut random = Random::from_seed(seed);
    let mut layers = vec![background(&mut random, &options, AffineMotion::STATIC, 16, (&Style::BARE, 0.0))];
    let opposite = if random.unit() < 0.5 { 1.0 } else { -1.0 };
    let places =
        [([90.0, 100.0], [0.0, opposite]), ([205.0, 118.0], [0.0, -opposite]), ([316.0, 108.0], [opposite, 0.0])];
    for (place, direction) in places.into_iter().take(options.objects) {
        let centre = place.map(|middle: f64| middle + random.uniform(-8.0, 8.0));
        let speed = random.uniform(6.0, 9.0);
        let motion = about(centre, direction.map(|d| d * speed), [0.0; 4]);
        let shape = Shape::oriented(Kind::Rectangle, random.uniform(44.0, 52.0), direction, 2.0);
        layers.push(object(&mut random, &options, motion, shape, centre, &Style::THINGS));
    }
    render::render(&layers, &options, &mut random)
}
