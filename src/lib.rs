//! Motion segmentation of two video frames: how many motions there are, what each motion is, and which pixels follow it. There is no
//! trained model; everything is estimated from the intensities of the two frames.
//!
//! A pixel x = (x, y, 1) with image derivatives y = (I_x, I_y, I_t) that moves with the affine motion A satisfies `yᵀ A x = 0`. A pixel
//! that moves with one of n motions satisfies the product of their n constraints, the *multibody affine constraint*. It is a linear
//! equation in products of monomials of x and y, and its solution contains all n motions. Factorising or differentiating it recovers
//! them before any pixel is assigned to a motion (R. Vidal and S. Sastry, *Segmentation of Dynamic Scenes from Image Intensities*, IEEE
//! Workshop on Vision and Motion Computing, 2002; "the paper" in this documentation, which cites its equations by number).
//!
//! # Segmenting two frames
//!
//! [`segment_pair`] takes two [`Frame`]s and returns a [`Segmentation`]: one label for each pixel of the first frame and one
//! [`AffineMotion`] for each label. In the frames of this example, whose true motions are known, an object moves before a
//! background:
//!
//! ```
//! use veronese::{SegmentOptions, segment_pair};
//!
//! # fn main() -> veronese::Result<()> {
//! # let scene = scenes::generate(&scenes::SceneOptions { width: 160, height: 120, objects: 1, ..Default::default() })?;
//! # let (first, second, truths) = (scene.first(), scene.second(), &scene.motions);
//! let found = segment_pair(first, second, &SegmentOptions::default(), &mut |_stage| {})?;
//! assert_eq!(found.count, 2); // the background and one object
//! assert_eq!(found.labels.len(), 160 * 120);
//! for (motion, truth) in found.motions.iter().zip(truths) {
//!     let ([u, v], [p, q]) = (motion.matrix.flow(80.0, 60.0), truth.flow(80.0, 60.0));
//!     assert!((u - p).abs() < 0.5 && (v - q).abs() < 0.5); // pixels
//! }
//! # Ok(())
//! # }
//! ```
//!
//! The stages are: luminance, pyramids and gradients; the dominant motion and the change of brightness; measurements on the pixels that
//! the dominant motion does not explain; candidate motions from the multibody constraint; greedy selection; refinement of each motion
//! on the intensities of its pixels, coarse to fine; labels of least energy, corrected for occlusion; masks at full size, groups of
//! motions, scores of their number.
//!
//! # Frames, planes and derivatives
//!
//! A [`Frame`] is made from RGBA bytes. Its luminance is a [`Plane`], a row-major array of `f32`:
//!
//! ```
//! use veronese::Plane;
//!
//! let mut plane = Plane::from_fn(4, 3, |x, y| (10 * y + x) as f32);
//! assert_eq!((plane.at(3, 2), plane.row(1)), (23.0, &[10.0, 11.0, 12.0, 13.0][..]));
//! plane.row_mut(0).fill(0.5);
//! assert_eq!(plane.values()[..5], [0.5, 0.5, 0.5, 0.5, 10.0]);
//! assert_eq!(Plane::filled(2, 1, 7.0), Plane::from_vec(2, 1, vec![7.0, 7.0]));
//! ```
//!
//! [`derivatives`] computes the image derivatives of the paper. Here, a horizontal ramp of 4 grey levels per pixel moves to the right by
//! one pixel:
//!
//! ```
//! use veronese::{Frame, derivatives};
//!
//! # fn main() -> veronese::Result<()> {
//! let ramp = |shift: u8| {
//!     let grey = (0..24).flat_map(|_| 0..32).map(|x: u8| 100 + 4 * x - 4 * shift);
//!     Frame::from_rgba(32, 24, grey.flat_map(|v| [v, v, v, 255]).collect::<Vec<u8>>())
//! };
//! let (first, second) = (ramp(0)?, ramp(1)?);
//! assert_eq!((first.width(), first.height()), (32, 24));
//! assert!((first.luminance().at(5, 0) - 120.0).abs() < 1e-3);
//!
//! let y = derivatives(&first, &second, None); // luminance scaled to [0, 1]
//! let (ix, it) = (255.0 * y.x.at(16, 12), 255.0 * y.t.at(16, 12));
//! assert!((ix - 4.0).abs() < 0.1 && (it + 4.0).abs() < 0.1); // I_x u + I_t = 0 with u = 1
//! assert!(y.y.row(12).iter().all(|iy| iy.abs() < 1e-5));
//! # Ok(())
//! # }
//! ```
//!
//! # A clip, from its opening to its closing
//!
//! A [`Clip`](clip::Clip) is segmented, read and corrected: a person annotates which object some pixels of some frames belong to, and masks
//! change in all frames without solving a pair again. Each command is a step that can be undone, and is kept in a journal. The clip asks for
//! the frames that it needs. Two frames are a clip, too. Here a stroke takes the upper half of an object away from it:
//!
//! ```
//! use veronese::SegmentOptions;
//! use veronese::clip::{Annotation, Clip, Command, Content, OpenOptions};
//!
//! # fn main() -> veronese::Result<()> {
//! # let scene = scenes::generate(&scenes::SceneOptions { width: 160, height: 120, objects: 1, ..Default::default() })?;
//! # let frames = [scene.first(), scene.second()];
//! let read = |index: usize| Ok::<_, veronese::Error>(frames[index].clone());
//! let mut clip = Clip::new(frames.len(), OpenOptions::default())?;
//! clip.apply(Command::Segment { frames: 0..2, options: SegmentOptions::default() })?;
//! clip.look_at(1);
//! clip.run(read)?; // it asks for the frames that it needs
//! let before = clip.labels(1).expect("this frame is looked at");
//!
//! let object = &before.objects[0];
//! let is_upper = |p: usize| p / 160 < object.bbox[1] + object.bbox[3] / 2;
//! let labels = (0..160 * 120).map(|p| if is_upper(p) { 0 } else { 255 }).collect(); // 0: not the object; 255: not annotated
//! clip.apply(Command::Annotate(vec![Annotation::new(0, Content::Strokes { object: object.id, labels })]))?;
//! clip.run(read)?; // the other frame, which is still looked at, changes as well
//! assert!(clip.labels(1).expect("it is known").objects[0].pixels < object.pixels);
//!
//! let mut again = Clip::read(&clip.save(), OpenOptions::default())?.clip; // tomorrow
//! assert_eq!(again.frames(), clip.frames());
//! assert!(again.undo());
//! # Ok(())
//! # }
//! ```
//!
//! # Measurements instead of frames
//!
//! [`fit_motions`] solves the paper's Problem 1 for given [`Measurements`]: positions with image derivatives. Its parts are public:
//!
//! 1. [`embedding`]: the Veronese map, the embedded data matrix, its rank, the multibody motion (eq. 6–12);
//! 2. [`factorisation`]: from the multibody motion to n motions, as in the paper (eq. 13–17) or by differentiation;
//! 3. [`refinement`]: the paper's nonlinear refinement (eq. 19), and the maximum likelihood fit of a mixture of motions with outliers.
//!
//! # Stability
//!
//! From 1.0 on the crate follows semantic versioning. Options are made with `default()` and `with_…`, and results may get further
//! fields, so neither can be written as literals. Two parts may change in any version: what is hidden from this documentation; and
//! the modules [`embedding`], [`factorisation`], [`linear`], [`paper`] and [`refinement`], which are the method in parts, for study, and
//! have types of nalgebra in their signatures.
//!
//! # Reproducibility
//!
//! The same input gives the same bits in native code and in WebAssembly. "Reproducible bits" in ARCHITECTURE.md explains how.

mod answer;
mod best;
pub mod clip;
#[cfg(feature = "codecs")]
pub mod codecs;
mod components;
pub mod embedding;
mod error;
mod estimation;
mod exponential;
pub mod factorisation;
mod frame;
mod hash;
mod labelling;
mod lanes;
pub mod linear;
mod literal;
mod measurements;
mod model;
mod motion;
mod options;
mod order;
mod pair;
pub mod paper;
mod points;
mod progress;
mod random;
pub mod refinement;
mod side;
#[cfg(feature = "stages")]
#[doc(hidden)]
pub mod stages;
mod view;

pub use answer::{Candidate, FitEvidence, FittedMotion, MotionFit, PaperStages, UNLABELLED};
pub use error::{Error, Result};
pub use frame::{Derivatives, Frame, MAX_SIDE, MIN_SIDE, Plane, derivatives};
pub use literal::{KeptPixels, LiteralSegmentation, PAPER_THRESHOLD, literal_pair};
pub use measurements::{Measurements, Normalisation};
#[cfg(feature = "ablation")]
#[doc(hidden)]
pub use model::{ClipModel, Model};
pub use motion::AffineMotion;
pub use options::{FitOptions, MAX_MOTIONS, Method, MotionCount, Quality, SegmentOptions};
#[cfg(feature = "ablation")]
#[doc(hidden)]
pub use pair::segment_pair_with;
pub use pair::{Junction, PairEvidence, Segmentation, SegmentedMotion, segment_pair};
pub use points::fit_motions;
pub use progress::{Progress, Stage};
#[doc(hidden)]
pub use random::Random;
