//! Greedy selection: the motion that explains most of what is still unexplained is refined on its own region and added, until no further
//! motion gains more than its penalty.

use super::{ScoredMotion, smallest_cost};
use crate::components::{Connectivity, components};
use crate::estimation::alignment::{Alignment, Convergence, Freedom, Support, align};
use crate::frame::Plane;
use crate::frame::filter::gaussian;
use crate::lanes::{LANES, each_with};
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::order::descending;
use crate::view::brightness::GainBias;
use crate::view::level::PairLevel;

/// When a motion is added, and how many proposals are tried.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GreedySelection {
    /// Gain that a motion must exceed, cost summed over pixels.
    pub(crate) penalty: f64,
    /// Largest number of motions.
    pub(crate) most: usize,
    /// Proposals refined per round.
    pub(crate) tries: usize,
    /// Standard deviation of the window over which gains are averaged, pixels of the level (of the sample where it is thinned).
    pub(crate) window: f32,
    /// The entries that must converge when a proposal is refined.
    pub(crate) convergence: Convergence,
}

/// Entries of a motion; regions with no more pixels are ignored.
const ENTRIES: usize = 6;

/// By how much a cost is below the current one at every pixel, averaged over windows.
fn improvement(current: &Plane, cost: &Plane, window: f32) -> Plane {
    let mut difference = current.clone();
    each_with(difference.values_mut(), [cost.values()], |d, [c]| d - c);
    gaussian(&difference, window)
}

fn gain_of(improvement: &Plane, margin: f32) -> f64 {
    // A comparison, because `f32::max` is a call in WebAssembly.
    let gain = |d: f32| if d > margin { d - margin } else { 0.0 };
    let (blocks, rest) = improvement.values().as_chunks::<LANES>();
    let mut sum = 0.0;
    for block in blocks {
        block.map(gain).iter().for_each(|&g| sum += f64::from(g));
    }
    rest.iter().for_each(|&d| sum += f64::from(gain(d)));
    sum
}

/// Side of the blocks by whose means proposals are ranked, pixels: two pixels of a sample.
const BLOCK: usize = 4;

/// Means over blocks of `side` × `side` pixels: enough to order proposals.
fn blocks(plane: &Plane, side: usize) -> Plane {
    let (width, height) = (plane.width(), plane.height());
    let mut means = Plane::filled(width.div_ceil(side), height.div_ceil(side), 0.0);
    for y in 0..height {
        for (sum, values) in means.row_mut(y / side).iter_mut().zip(plane.row(y).chunks(side)) {
            values.iter().for_each(|v| *sum += v);
        }
    }
    for y in 0..means.height() {
        let rows = side.min(height - y * side);
        for (x, mean) in means.row_mut(y).iter_mut().enumerate() {
            *mean /= (rows * side.min(width - x * side)) as f32;
        }
    }
    means
}

/// The costs of proposals on block means, of which their gains are estimated before they are refined.
pub(crate) struct RoughCosts(Vec<Plane>);

impl RoughCosts {
    /// `thinned` has every `thinning`-th pixel of every `thinning`-th row of a level.
    pub(crate) fn new(thinned: &PairLevel, thinning: usize, proposals: &[AffineMotion]) -> RoughCosts {
        let block = BLOCK / thinning;
        RoughCosts(proposals.iter().map(|&motion| blocks(&ScoredMotion::new(thinned, motion).cost, block)).collect())
    }

    /// How much each proposal lowers the current costs of all pixels.
    pub(crate) fn gains(&self, current: &Plane, window: f32, model: &Model) -> Vec<f64> {
        let current = blocks(current, BLOCK);
        let gain = |cost: &Plane| {
            let mut difference = current.clone();
            each_with(difference.values_mut(), [cost.values()], |d, [c]| d - c);
            gain_of(&gaussian(&difference, window / BLOCK as f32), model.margin) * (BLOCK * BLOCK) as f64
        };
        self.0.iter().map(gain).collect()
    }
}

/// Adds proposed motions to `selected` as long as each gains more than its penalty. Returns the best motion that was rejected;
/// `None` if nothing was proposed.
///
/// Every round ranks all proposals by block means, refines the most promising on a sample of the pixels, and the best of those on
/// all pixels.
pub(crate) fn add_motions(
    level: &PairLevel,
    selected: &mut Vec<ScoredMotion>,
    proposals: &[AffineMotion],
    how: GreedySelection,
) -> Option<AffineMotion> {
    let model = level.model;
    let thinning = level.thinning();
    let thinned = level.thinned();
    let rough = RoughCosts::new(&thinned, thinning, proposals);
    // The gains of proposals tried before: in addition to more motions, a proposal gains no more.
    let mut most = vec![f64::INFINITY; proposals.len()];
    loop {
        let current = smallest_cost(selected);
        let gains = rough.gains(&current, how.window, model);
        let current_sample = current.thinned(thinning);
        let mut best: Option<(f64, ScoredMotion)> = None;
        let order = descending(gains.iter().copied());
        let next = order.first().map(|&k| proposals[k]);
        if selected.len() >= how.most {
            return next;
        }
        for &k in order.iter().take(how.tries) {
            if gains[k] < model.smallest_tried_gain * how.penalty {
                break;
            }
            if best.as_ref().is_some_and(|(gain, _)| most[k] <= *gain) {
                continue;
            }
            let (gain, scored) = refined(
                &thinned,
                &current_sample,
                proposals[k],
                GreedySelection { window: how.window / thinning as f32, ..how },
            );
            most[k] = gain;
            if best.as_ref().is_none_or(|b| gain > b.0) {
                best = Some((gain, scored));
            }
        }
        match best.map(|(_, scored)| refined(level, &current, scored.motion, how)) {
            Some((gain, scored)) if gain >= how.penalty => selected.push(scored),
            rejected => return rejected.map(|r| r.1.motion).or(next),
        }
    }
}

/// Refines a proposal in a few rounds on the region where it beats the current motions. Returns its gain and the motion.
fn refined(level: &PairLevel, current: &Plane, proposal: AffineMotion, how: GreedySelection) -> (f64, ScoredMotion) {
    let mut scored = ScoredMotion::new(level, proposal);
    let mut improved = improvement(current, &scored.cost, how.window);
    let model = level.model;
    let mut gain = gain_of(&improved, model.margin);
    for round in 0..model.proposal_rounds {
        let Some(region) = heaviest_region(&improved, current, &scored.cost, model.margin) else { break };
        let support = Support::weighted(&region, model);
        let affine = Alignment::of_region(model.region_iterations, model.ridge_object, model).until(how.convergence);
        let mut motion = scored.motion;
        let none = &mut GainBias::default();
        if round == 0 {
            motion = align(level, &motion, &support, none, Alignment { freedom: Freedom::Translation, ..affine });
        }
        motion = align(level, &motion, &support, none, affine);
        let refined = ScoredMotion::new(level, motion);
        let refined_improvement = improvement(current, &refined.cost, how.window);
        let better = gain_of(&refined_improvement, model.margin);
        if better > gain {
            (scored, improved, gain) = (refined, refined_improvement, better);
        }
    }
    (gain, scored)
}

/// The connected region in which a cost improves most on the current one, as weights 0 and 1.
fn heaviest_region(improved: &Plane, current: &Plane, cost: &Plane, margin: f32) -> Option<Plane> {
    let (width, height) = (improved.width(), improved.height());
    let mask: Vec<u8> = improved.values().iter().map(|&d| u8::from(d > margin)).collect();
    let found = components(&mask, width, Connectivity::Eight);
    let mut weights = vec![0.0f64; found.list.len()];
    for ((&region, a), c) in found.of.iter().zip(current.values()).zip(cost.values()) {
        weights[region as usize] += f64::from(a - c);
    }
    let mut heaviest: Option<usize> = None;
    for (k, region) in found.list.iter().enumerate() {
        let counts = region.label == 1 && region.size > ENTRIES;
        if counts && heaviest.is_none_or(|h| weights[k] > weights[h]) {
            heaviest = Some(k);
        }
    }
    let chosen = heaviest?;
    let values = found.of.iter().map(|&id| if id as usize == chosen { 1.0 } else { 0.0 }).collect();
    Some(Plane::from_vec(width, height, values))
}

/// Removes motions whose absence costs less than their penalty, the cheapest first. The first motion always stays.
pub(crate) fn prune(selected: &mut Vec<ScoredMotion>, penalty: f64) {
    while selected.len() > 1 {
        let with_all = smallest_cost(selected).total();
        let mut cheapest = (f64::INFINITY, 0);
        for k in 1..selected.len() {
            let mut others: Vec<ScoredMotion> = selected.clone();
            others.remove(k);
            let absence = smallest_cost(&others).total() - with_all;
            if absence < cheapest.0 {
                cheapest = (absence, k);
            }
        }
        if cheapest.0 >= penalty {
            break;
        }
        selected.remove(cheapest.1);
    }
}
