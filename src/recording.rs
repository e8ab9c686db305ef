//! What the stages of a pair find on their way, for [`stages`](crate::stages). Motions are in pixels of the working size of their level.
//!
//! Nothing here computes: the pipeline notes what it has. There is none of this without the feature `stages`.

use crate::frame::Plane;
use crate::measurements::Measurements;
use crate::motion::AffineMotion;

/// All that was found of a pair.
#[derive(Clone, Debug, Default)]
pub(crate) struct Recording {
    /// The hypotheses about the background, in the order in which they were solved.
    pub(crate) hypotheses: Vec<Hypothesis>,
    /// The index of the one that was taken.
    pub(crate) chosen: usize,
    /// Labels carried on at a finer working size.
    pub(crate) detail: Option<Labels>,
    /// The final labels of the working size.
    pub(crate) working: Labels,
}

/// A hypothesis about the background, solved to the end.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hypothesis {
    /// The motion of the background.
    pub(crate) dominant: AffineMotion,
    /// Pixels of the full frame for a pixel of the working size.
    pub(crate) reduction: f64,
    /// What was seen on the base level.
    pub(crate) seen: Seen,
    /// The measurements of the multibody constraint, unless there are too few.
    pub(crate) measured: Option<Measured>,
    /// The proposals, in order.
    pub(crate) proposals: Vec<Proposed>,
    /// What a motion has to gain.
    pub(crate) price: f64,
    /// After greedy selection.
    pub(crate) selected: Vec<Supported>,
    /// The motion that is cheapest at each pixel, after selection.
    pub(crate) selection: Labels,
    /// After refinement on the intensities.
    pub(crate) refined: Vec<Supported>,
    /// The motion that is cheapest at each pixel, after refinement.
    pub(crate) refinement: Labels,
    /// The draft labels.
    pub(crate) draft: Labels,
    /// The labels of the working size.
    pub(crate) labels: Labels,
}

/// The base level along the dominant motion.
#[derive(Clone, Debug)]
pub(crate) struct Seen {
    /// Pixels of the working size for a pixel of the level.
    pub(crate) pixel: f64,
    /// Noise, grey levels.
    pub(crate) noise: f32,
    /// Intensity difference along the dominant motion.
    pub(crate) residual: Plane,
    /// Horizontal, vertical and recentred temporal derivative.
    pub(crate) derivatives: [Plane; 3],
    /// The local flow relative to the dominant motion, pixels of the level.
    pub(crate) flow: [Plane; 2],
}

impl Default for Seen {
    fn default() -> Seen {
        let empty = || Plane::filled(0, 0, 0.0);
        let derivatives = [empty(), empty(), empty()];
        Seen { pixel: 1.0, noise: 0.0, residual: empty(), derivatives, flow: [empty(), empty()] }
    }
}

/// The measurements that the multibody constraint is fitted to.
#[derive(Clone, Debug)]
pub(crate) struct Measured {
    pub(crate) measurements: Measurements,
    /// How badly the dominant motion explains each, 0…1.
    pub(crate) weights: Vec<f64>,
    /// Their pixels on the base level.
    pub(crate) places: Vec<[usize; 2]>,
    /// Pixels of the base level for a unit of their flow.
    pub(crate) unit: f64,
}

/// Where a proposal comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// The multibody constraint of this degree.
    Constraint(usize),
    /// The local flow of a window.
    Window,
    /// It was known before.
    Known,
}

/// A proposal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Proposed {
    pub(crate) motion: AffineMotion,
    pub(crate) source: Source,
    /// What it saves beside the dominant motion alone, before it is refined.
    pub(crate) gain: f64,
    /// Share of the pixels that it explains better than the dominant motion.
    pub(crate) support: f64,
}

/// A motion, and the share of the pixels that it explains best.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Supported {
    pub(crate) motion: AffineMotion,
    pub(crate) support: f64,
}

/// Labels of a level with their motions.
#[derive(Clone, Debug, Default)]
pub(crate) struct Labels {
    pub(crate) size: [usize; 2],
    /// Pixels of the full frame for a pixel of the level …
    pub(crate) scale: f64,
    /// … and for a pixel of the working size.
    pub(crate) reduction: f64,
    pub(crate) motions: Vec<AffineMotion>,
    pub(crate) labels: Vec<u8>,
}
