//! How many things move between two video frames, how each moves, and which pixels belong to it.

#[cfg(test)]
extern crate self as veronese;

mod best;
pub mod embedding;
mod error;
pub mod factorisation;
mod frame;
pub mod linear;
mod measurements;
mod motion;
mod options;
pub mod paper;
mod pipeline;
mod points;
mod progress;
mod random;
pub mod refinement;

pub use error::{Error, Result};
pub use frame::{Frame, MAX_SIDE, MIN_SIDE, Plane};
pub use measurements::{Measurements, Normalisation};
pub use motion::AffineMotion;
pub use options::{FitOptions, MAX_MOTIONS, Method, MotionCount, Quality, SegmentOptions};
pub use pipeline::{PairEvidence, Segmentation, SegmentedMotion, segment_pair};
pub use points::{Candidate, FitEvidence, FittedMotion, MotionFit, PaperStages, UNLABELLED, fit_motions};
pub use progress::{Progress, Stage};
pub use random::Random;
