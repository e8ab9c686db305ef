//! How many things move between two video frames, how each moves, and which pixels belong to it: from the intensities alone.
//!
//! A pixel x = (x, y, 1) with the image derivatives y = (I_x, I_y, I_t) that moves with the affine motion A satisfies
//! `yᵀ A x = 0`. Whichever of n motions it belongs to, it satisfies the product of all n constraints, the *multibody affine
//! constraint*, which is one linear equation in the products of monomials of x and y. Its solution holds all motions at once;
//! factorising or differentiating it gives them one by one, before any pixel is assigned to one (R. Vidal and S. Sastry,
//! *Segmentation of Dynamic Scenes from Image Intensities*, IEEE Workshop on Vision and Motion Computing, 2002).
//!
//! [`fit_motions`] solves this for given measurements:
//! 1. [`embedding`]: the Veronese map, the embedded data matrix, its rank, the multibody motion (eq. 6-12);
//! 2. [`factorisation`]: the polynomial into motions, as in the paper (eq. 13-17) or by differentiation;
//! 3. [`refinement`]: the paper's nonlinear refinement (eq. 19), and the most likely mixture of motions with outliers.
//!
//! [`segment_pair`] does it for two frames:
//! 1. luminance, pyramids, gradients; 2. the dominant motion and the change of brightness; 3. measurements of what it leaves
//!    unexplained, taken where a local flow lands; 4. motions proposed by the multibody constraint on them; 5. greedy selection;
//! 6. each motion refined on the intensities of its pixels, coarse to fine; 7. labels of least energy, corrected for occlusion;
//! 8. masks at full size, groups, evidence.
//!
//! ```
//! use veronese::scene::{self, SceneOptions};
//! use veronese::{SegmentOptions, segment_pair};
//!
//! # fn main() -> veronese::Result<()> {
//! let scene = scene::generate(&SceneOptions { width: 160, height: 120, objects: 1, ..SceneOptions::default() })?;
//! let found = segment_pair(scene.first(), scene.second(), None, &SegmentOptions::default(), &mut |_stage| {})?;
//! assert_eq!(found.labels.len(), 160 * 120);
//! for motion in &found.motions {
//!     println!("{} {:.1} % {:?}", motion.label, 100.0 * motion.share, motion.matrix);
//! }
//! # Ok(())
//! # }
//! ```
//!
//! The same input gives the same bits natively and in WebAssembly; ARCHITECTURE.md says what that takes.

// Unit tests share generators with the integration tests, which know the crate by its name.
#[cfg(test)]
extern crate self as veronese;

mod answer;
mod best;
pub mod clip;
#[cfg(feature = "codecs")]
pub mod codecs;
mod components;
pub mod embedding;
mod error;
mod estimation;
pub mod factorisation;
mod frame;
mod labelling;
mod lanes;
pub mod linear;
mod literal;
mod measurements;
mod motion;
mod options;
mod order;
mod pair;
pub mod paper;
mod points;
mod progress;
mod random;
pub mod refinement;
pub mod scene;
mod view;
#[cfg(target_arch = "wasm32")]
pub mod wasm;
mod workspace;

pub use answer::{Candidate, FitEvidence, FittedMotion, MotionFit, PaperStages, UNLABELLED};
pub use error::{Error, Result};
pub use frame::{Derivatives, Frame, MAX_SIDE, MIN_SIDE, Plane, derivatives};
pub use literal::{KeptPixels, LiteralSegmentation, PAPER_THRESHOLD, literal_pair};
pub use measurements::{Measurements, Normalisation};
pub use motion::AffineMotion;
pub use options::{FitOptions, MAX_MOTIONS, Method, MotionCount, Quality, SegmentOptions};
#[doc(hidden)]
pub use pair::Part;
#[cfg(feature = "ablation")]
#[doc(hidden)]
pub use pair::segment_pair_without;
pub use pair::{
    Correction, MAX_CORRECTED, PairEvidence, Relabelling, Segmentation, SegmentedMotion, relabel, segment_pair,
};
pub use points::fit_motions;
pub use progress::{Progress, Stage};
pub use random::Random;
pub use workspace::release_workspace;
