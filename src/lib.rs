//! How many things move between two video frames, how each moves, and which pixels belong to it.

#[cfg(feature = "codecs")]
pub mod codecs;
mod error;
mod frame;
mod measurements;
mod motion;
mod options;
mod pipeline;
mod points;
mod progress;
mod random;
#[cfg(target_arch = "wasm32")]
pub mod wasm;

pub use error::{Error, Result};
pub use frame::{Frame, MAX_SIDE, MIN_SIDE, Plane};
pub use measurements::{Measurements, Normalisation};
pub use motion::AffineMotion;
pub use options::{FitOptions, MAX_MOTIONS, Method, MotionCount, Quality, SegmentOptions};
pub use pipeline::{PairEvidence, Segmentation, SegmentedMotion, segment_pair};
pub use points::{Candidate, FitEvidence, FittedMotion, MotionFit, PaperStages, UNLABELLED, fit_motions};
pub use progress::{Progress, Stage};
pub use random::Random;
