//! How many things move between two video frames, how each moves, and which pixels belong to it.

mod alignment;
#[cfg(test)]
extern crate self as veronese;

mod best;
#[cfg(feature = "codecs")]
pub mod codecs;
pub mod embedding;
mod error;
pub mod factorisation;
mod frame;
mod labelling;
pub mod linear;
mod literal;
mod measurements;
mod motion;
mod options;
mod order;
pub mod paper;
mod pipeline;
mod points;
mod progress;
mod proposal;
mod random;
pub mod refinement;
pub mod scene;
mod selection;
#[cfg(target_arch = "wasm32")]
pub mod wasm;

pub use error::{Error, Result};
pub use frame::{Derivatives, Frame, MAX_SIDE, MIN_SIDE, Plane, derivatives};
pub use literal::{KeptPixels, LiteralSegmentation, PAPER_THRESHOLD, literal_pair};
pub use measurements::{Measurements, Normalisation};
pub use motion::AffineMotion;
pub use options::{FitOptions, MAX_MOTIONS, Method, MotionCount, Quality, SegmentOptions};
pub use pipeline::{PairEvidence, Segmentation, SegmentedMotion, segment_pair};
pub use points::{Candidate, FitEvidence, FittedMotion, MotionFit, PaperStages, UNLABELLED, fit_motions};
pub use progress::{Progress, Stage};
pub use random::Random;
