//! Which pixel goes with which motion: cost of each motion at each pixel, plus a price for every border between labels that is
//! lower where the image has an edge.

use super::potts::{Potts, Solver, minimise};
use crate::alignment::cost::{CostModel, cost_where_seen};
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

/// What every motion costs at every pixel, as labels see it; the first is the dominant one.
///
/// A pixel that a motion moves out of the frame says nothing about it, so there the motion costs what the cheapest of those costs
/// that keep the pixel inside. An object costs at least what says nothing by itself, and the dominant motion at most that: an object
/// does not win pixels by leaving the frame with them.
pub(crate) fn label_costs(level: &Level, motions: &[AffineMotion], coherence: Coherence) -> Vec<Plane> {
    let mut costs: Vec<Plane> = motions.iter().map(|m| cost_where_seen(level, m, CostModel::LABELS)).collect();
    let neutral = CostModel::LABELS.outside();
    let seen = cheapest(&costs);
    for (k, cost) in costs.iter_mut().enumerate() {
        for (c, seen) in cost.values_mut().iter_mut().zip(seen.values()).filter(|(c, _)| !c.is_finite()) {
            *c = match (k, seen.is_finite()) {
                (_, false) => neutral,
                (0, true) => seen.min(neutral),
                (_, true) => seen.max(neutral),
            };
        }
        if k > 0 {
            add_departure(cost, coherence);
        }
    }
    costs
}

/// The smallest of the costs at every pixel.
fn cheapest(costs: &[Plane]) -> Plane {
    let mut cheapest = costs[0].clone();
    for cost in &costs[1..] {
        cheapest.values_mut().iter_mut().zip(cost.values()).for_each(|(l, c)| *l = l.min(*c));
    }
    cheapest
}

/// What an object pays for its pixels.
fn add_departure(cost: &mut Plane, coherence: Coherence) {
    cost.values_mut().iter_mut().for_each(|c| *c += coherence.departure);
    let price = FRAME_BORDER * coherence.smoothness;
    let (width, height) = (cost.width(), cost.height());
    for y in [0, height - 1] {
        cost.row_mut(y).iter_mut().for_each(|c| *c += price);
    }
    for y in 0..height {
        for x in [0, width - 1] {
            cost.row_mut(y)[x] += price;
        }
    }
}
