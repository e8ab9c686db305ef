//! Which pixel goes with which motion: cost of each motion at each pixel, plus a price for every border between labels that is
//! lower where the image has an edge.

use super::potts::{Potts, Solver, minimise};
use crate::alignment::cost::{CostModel, cost};
use crate::frame::Plane;
use crate::frame::pyramid::Level;
use crate::motion::AffineMotion;

/// How strongly labels hold together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coherence {
    /// λ: price of a border between two pixels that look alike, in costs.
    pub(crate) smoothness: f32,
    /// Price of a pixel that does not go with the dominant motion: decides where the data cannot tell.
    pub(crate) departure: f32,
    /// Who minimises while motions still come and go.
    pub(crate) draft_solver: Solver,
    /// Who minimises at the end.
    pub(crate) solver: Solver,
}

/// Share of λ that remains at the strongest image edge.
const EDGE_SHARE: f32 = 0.15;
/// Intensity step at which the rest of λ has fallen to 1/e: at least this many grey levels …
const SMALLEST_STEP: f32 = 5.0;
/// … and at least this many noise deviations.
const NOISE_STEPS: f32 = 4.0;
/// Share of λ that an object pays for every pixel on the frame's border: without it a border between labels that leaves the
/// frame costs nothing, and flat regions leak through.
const FRAME_BORDER: f32 = 0.5;

/// Prices of borders between neighbours, from the unblurred first frame.
#[derive(Clone, Debug)]
pub(crate) struct Borders {
    horizontal: Plane,
    vertical: Plane,
}

impl Borders {
    pub(crate) fn new(first: &Plane, noise: f32, coherence: Coherence) -> Borders {
        let step = SMALLEST_STEP.max(NOISE_STEPS * noise);
        let (width, height) = (first.width(), first.height());
        let price = |a: f32, b: f32| {
            coherence.smoothness * (EDGE_SHARE + (1.0 - EDGE_SHARE) * libm::expf(-(a - b).abs() / step))
        };
        Borders {
            horizontal: Plane::from_fn(width, height, |x, y| {
                price(first.at(x, y), first.at((x + 1).min(width - 1), y))
            }),
            vertical: Plane::from_fn(width, height, |x, y| price(first.at(x, y), first.at(x, (y + 1).min(height - 1)))),
        }
    }

    /// The labels of least energy.
    pub(crate) fn solve(&self, costs: &[Plane], solver: Solver) -> Vec<u8> {
        minimise(&Potts { costs, horizontal: &self.horizontal, vertical: &self.vertical }, solver, None)
    }
}

/// Cost of one motion at every pixel, as labels see it; `object` is whether it is not the dominant motion.
pub(crate) fn label_cost(level: &Level, motion: &AffineMotion, object: bool, coherence: Coherence) -> Plane {
    let mut plane = cost(level, motion, CostModel::LABELS);
    if object {
        plane.values_mut().iter_mut().for_each(|c| *c += coherence.departure);
        let price = FRAME_BORDER * coherence.smoothness;
        let (width, height) = (plane.width(), plane.height());
        for y in [0, height - 1] {
            plane.row_mut(y).iter_mut().for_each(|c| *c += price);
        }
        for y in 0..height {
            for x in [0, width - 1] {
                plane.row_mut(y)[x] += price;
            }
        }
    }
    plane
}
