//! What the stages of a pair find, recorded by an observer of the pipeline for the figures of the site.

mod recorder;

pub use recorder::segment_pair_stages;

use crate::frame::{Derivatives, Plane};
use crate::measurements::Measurements;
use crate::motion::AffineMotion;
use crate::pair::Segmentation;

/// The result of [`segment_pair_stages`].
#[derive(Clone, Debug)]
pub struct PairStages {
    /// The hypotheses about the background that were solved, one or two.
    pub hypotheses: Vec<Background>,
    /// The index of the one that describes the frames in fewer nats.
    pub chosen: usize,
    /// Large frames with quality [`Best`](crate::Quality::Best): the labels of the search continued at a finer working size.
    pub detail: Option<Labelling>,
    /// The labels at the final working size, after shadows are given back to the background.
    pub working: Labelling,
    /// Labels of the result by groups.
    pub groups: Vec<Vec<u8>>,
    /// The result of [`segment_pair`](crate::segment_pair).
    pub result: Segmentation,
}

/// A grid of pixels: its pixel (x, y) lies at `scale` (x, y) of the full frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Grid {
    /// Width in its own pixels.
    pub width: usize,
    /// Height in its own pixels.
    pub height: usize,
    /// Pixels of the full frame for one of its own.
    pub scale: f64,
}

/// A hypothesis about the background, solved to the end. Motions are in pixels of the full frame.
#[derive(Clone, Debug)]
pub struct Background {
    /// The motion of the background: the one that explains most pixels, or rest.
    pub dominant: AffineMotion,
    /// The level on which derivatives and measurements are taken.
    pub base: Grid,
    /// Standard deviation of the intensity difference along a correct motion in flat areas, grey levels.
    pub noise: f64,
    /// The second frame along the dominant motion minus the first, grey levels, on `base`.
    pub residual: Plane,
    /// Derivatives on `base`, grey levels per pixel of `base`, where the local flow lands, recentred: `I_x u + I_y v + I_t = 0` for the flow
    /// (u, v) relative to the dominant motion, in pixels of `base`.
    pub derivatives: Derivatives,
    /// The local flow (u, v) relative to the dominant motion, pixels of the full frame, on `base`.
    pub local_flow: [Plane; 2],
    /// The measurements of the multibody constraint; `None` where they are too few.
    pub measured: Option<MeasuredPixels>,
    /// The candidates, in the order in which they were proposed.
    pub candidates: Vec<CandidateMotion>,
    /// The gain that a motion needs to be selected.
    pub penalty: f64,
    /// The motions after greedy selection; the first is the dominant one.
    pub selected: Vec<SelectedMotion>,
    /// The selected motion that explains each pixel best, without regard to its neighbours.
    pub selection: Labelling,
    /// The motions after refinement on the intensities.
    pub refined: Vec<SelectedMotion>,
    /// The refined motion that explains each pixel best, without regard to its neighbours.
    pub refinement: Labelling,
    /// The labels of the draft level.
    pub draft: Labelling,
    /// The labels of the working size.
    pub labelling: Labelling,
}

/// Measurements on pixels that the dominant motion does not explain.
#[derive(Clone, Debug)]
pub struct MeasuredPixels {
    /// The pixels, in pixels of the full frame.
    pub places: Vec<[f64; 2]>,
    /// As the constraint has them: positions normalised by the half width, derivatives of about unit length.
    pub measurements: Measurements,
    /// How badly the dominant motion explains each, 0…1.
    pub weights: Vec<f64>,
    /// Pixels of the full frame for a unit of the flow of the measurements, which is relative to the dominant motion.
    pub unit: f64,
}

/// Where a candidate comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CandidateSource {
    /// The multibody constraint of this degree.
    Constraint(usize),
    /// The local flow of a window.
    Window,
    /// The other hypothesis about the background.
    Hypothesis,
}

/// A candidate motion.
#[derive(Clone, Copy, Debug)]
pub struct CandidateMotion {
    /// The motion.
    pub matrix: AffineMotion,
    /// Where it comes from.
    pub source: CandidateSource,
    /// How much cost it would save in addition to the dominant motion before it is refined, in the unit of [`Background::penalty`].
    pub gain: f64,
    /// Share of the pixels, 0…1, that it explains better than the dominant motion does.
    pub support: f64,
}

/// A motion that was selected.
#[derive(Clone, Copy, Debug)]
pub struct SelectedMotion {
    /// The motion.
    pub matrix: AffineMotion,
    /// Share of the pixels, 0…1, that it explains best.
    pub support: f64,
}

/// Labels with their motions. The first motion is the background's; numbers are not yet those of the report.
#[derive(Clone, Debug, Default)]
pub struct Labelling {
    /// The pixels of the labels.
    pub grid: Grid,
    /// The motions, pixels of the full frame.
    pub motions: Vec<AffineMotion>,
    /// The label of every pixel of `grid`, row by row.
    pub labels: Vec<u8>,
}
