//! Sequential tree-reweighted message passing (Kolmogorov, PAMI 28(10), 2006) on the 4-connected grid with Potts weights.
//!
//! Pixels are visited in raster order. Every edge keeps one message, towards the end that is visited next. A
//! forward pass sends messages right and down, a backward pass left and up. With Potts weights a message costs O(labels):
//! `m(l) = min(s(l) − min s, w)`. The backward pass also gives a lower bound of the energy, which never falls; where
//! the energy of the labels read out on the way meets it, they are optimal and the iteration ends.
//!
//! On a pyramid (costs and weights summed over 2×2 blocks, messages handed down at half their size) a handful of
//! iterations carries information across the image that would otherwise need as many iterations as a region is wide.
//!
//! A message depends on the one before it in its row, and on the one above it. Four rows, a band, are therefore processed at once, each a
//! pixel behind the row above, so that all arithmetic is on four pixels at a time, and gives the same bits as pixel by pixel:
//!
//! ```text
//! step     0  1  2  3  4  5        the columns of four rows of three pixels; the rest is padding, without costs and weights
//! row 0    0  1  2
//! row 1       0  1  2
//! row 2          0  1  2
//! row 3             0  1  2
//! ```

use wide::f32x4;

use super::potts::{FORBIDDEN, Potts, cut};

/// Labels are padded to 2, 3, 4, 8 or 16.
pub(super) const MAX_LABELS: usize = 16;
/// Cost of the padding labels.
const PADDING: f32 = 1e20;
/// Smallest side of a level of the pyramid.
const SMALLEST: usize = 8;
/// Up to this many iterations are completed before labels are read out.
const FEW: usize = 2;
/// Relative gap between energy and bound at which the labels count as optimal.
const CLOSED: f64 = 1e-6;
/// Relative rise of the bound in one iteration below which the iteration stops.
const STALLED: f64 = 2e-6;
/// Coarse levels only initialise the messages, so a few iterations are enough.
const COARSE_ITERATIONS: usize = 3;
/// Rows of a band.
const ROWS: usize = 4;
/// Steps that the last row of a band is behind the first.
const BEHIND: usize = ROWS - 1;

/// Values of the pixels of a band in one step, one of each row.
type Step = [f32; ROWS];

/// Labels, and a lower bound of the energy.
pub(super) struct Solution {
    pub(super) labels: Vec<u8>,
    #[cfg_attr(not(test), allow(dead_code))]
    pub(super) bound: f64,
}

/// At most `iterations` iterations on each of at most `levels` levels.
#[inline(never)]
pub(super) fn minimise(problem: &Potts<'_>, levels: usize, iterations: usize) -> Solution {
    let mut pyramid = vec![Grid::new(problem)];
    while pyramid.len() < levels {
        let finest = &pyramid[pyramid.len() - 1];
        if finest.width.min(finest.height) < 2 * SMALLEST {
            break;
        }
        let coarser = finest.halved();
        pyramid.push(coarser);
    }
    if let Some(coarsest) = pyramid.last_mut() {
        coarsest.clear_messages();
    }
    for level in (1..pyramid.len()).rev() {
        for _ in 0..iterations.min(COARSE_ITERATIONS) {
            pyramid[level].forward();
            pyramid[level].backward();
        }
        let (finer, coarser) = pyramid.split_at_mut(level);
        finer[level - 1].take_messages_from(&coarser[0]);
    }

    let grid = &mut pyramid[0];
    let mut labels = vec![0u8; grid.width * grid.height];
    let (mut best, mut lowest) = (labels.clone(), f64::INFINITY);
    let mut bound = f64::NEG_INFINITY;
    let unread = if iterations <= FEW { iterations } else { 0 };
    for _ in 0..unread {
        grid.forward();
        grid.backward();
    }
    for iteration in unread..=iterations {
        // If all messages are still zero, this reads out the costs alone: a valid labelling.
        let energy = grid.read_out(&mut labels);
        if energy < lowest {
            lowest = energy;
            best.copy_from_slice(&labels);
        }
        if iteration == iterations || lowest - bound <= CLOSED * (1.0 + lowest.abs()) {
            break;
        }
        grid.forward();
        let reached = grid.backward();
        if reached - bound <= STALLED * (1.0 + reached.abs()) && iteration > 2 {
            bound = bound.max(reached);
            break;
        }
        bound = bound.max(reached);
    }
    problem.descend(&mut best, 2);
    Solution { labels: best, bound }
}

/// Number of labels for which there is code, at least `labels`.
fn padded(labels: usize) -> usize {
    match labels {
        0..=2 => 2,
        3..=4 => labels,
        5..=8 => 8,
        _ => MAX_LABELS,
    }
}

/// One level: a grid with costs, weights, and the messages on its edges, in the order of the steps. Padding is 0 throughout.
struct Grid {
    width: usize,
    height: usize,
    /// Number of labels with the padding.
    labels: usize,
    /// For every step, the costs of each label.
    costs: Vec<Step>,
    /// Weight of the edge from p to its right and to its lower neighbour; 0 where there is none.
    to_right: Vec<Step>,
    to_below: Vec<Step>,
    /// Message on the edge from p to its right neighbour and to its lower neighbour, for every step that of each label; all 0 where there
    /// is none.
    right: Vec<Step>,
    down: Vec<Step>,
}

impl Grid {
    fn new(problem: &Potts<'_>) -> Self {
        let labels = padded(problem.costs.len());
        let mut grid = Self::unconnected(problem.width(), problem.height(), labels);
        let (width, height) = (grid.width, grid.height);
        let size = [width, height];
        for l in 0..labels {
            let costs = &mut grid.costs[l..];
            match problem.costs.get(l) {
                Some(plane) => stagger(|y| &plane.row(y)[..width], size, FORBIDDEN, costs, labels),
                // Padding labels keep their price.
                None => {
                    let padding = vec![PADDING; width];
                    stagger(|_| &padding, size, PADDING, costs, labels);
                }
            }
        }
        let (horizontal, vertical) = (problem.horizontal, problem.vertical);
        let connected = [width - 1, height - 1];
        stagger(|y| &horizontal.row(y)[..connected[0]], size, PADDING, &mut grid.to_right, 1);
        stagger(|y| vertical.row(y), [width, connected[1]], PADDING, &mut grid.to_below, 1);
        grid
    }

    /// A grid without costs, weights and messages.
    fn unconnected(width: usize, height: usize, labels: usize) -> Self {
        let steps = height.div_ceil(ROWS) * (width + BEHIND);
        let none = |count: usize| vec![[0.0; ROWS]; count];
        let [right, down] = [0; 2].map(|_| Vec::new());
        Grid {
            width,
            height,
            labels,
            costs: none(steps * labels),
            to_right: none(steps),
            to_below: none(steps),
            right,
            down,
        }
    }

    /// Steps of a band.
    fn steps(&self) -> usize {
        self.width + BEHIND
    }

    /// The step and the lane of a pixel.
    #[inline(always)]
    fn place(&self, x: usize, y: usize) -> (usize, usize) {
        (y / ROWS * self.steps() + x + y % ROWS, y % ROWS)
    }

    /// Costs and the weights across the border of 2×2 blocks, summed.
    #[inline(never)]
    fn halved(&self) -> Self {
        let labels = self.labels;
        let mut half = Self::unconnected(self.width.div_ceil(2), self.height.div_ceil(2), labels);
        for y in 0..half.height {
            let ((start, lane), (from, at)) = (half.place(0, y), self.place(0, 2 * y));
            for x in 0..half.width {
                let step = start + x;
                // The pixel on the right is a step further in the same lane, the one below a step further in the next lane, as an even row
                // is never the last of a band. Outside the grid there is padding, without costs and weights.
                let upper = from + 2 * x;
                let beside = upper + 1;
                let across = (upper + 2).min(self.to_right.len() - 1);
                for l in 0..labels {
                    let at_step = |step: usize, lane: usize| self.costs[step * labels + l][lane];
                    half.costs[step * labels + l][lane] =
                        at_step(upper, at) + at_step(beside, at) + at_step(beside, at + 1) + at_step(across, at + 1);
                }
                half.to_right[step][lane] = self.to_right[beside][at] + self.to_right[across][at + 1];
                half.to_below[step][lane] = self.to_below[beside][at + 1] + self.to_below[across][at + 1];
            }
        }
        half
    }

    /// Sets all messages to zero.
    fn clear_messages(&mut self) {
        self.right = vec![[0.0; ROWS]; self.costs.len()];
        self.down = self.right.clone();
    }

    /// Initialises the messages from the coarser level. The bound is valid for any messages.
    #[inline(never)]
    fn take_messages_from(&mut self, coarser: &Self) {
        self.clear_messages();
        let labels = self.labels;
        for y in 0..self.height {
            let ((start, lane), (from, of)) = (self.place(0, y), coarser.place(0, y / 2));
            // No message leaves the grid.
            let down = if y + 1 < self.height { 0.5 } else { 0.0 };
            for x in 0..self.width {
                let right = if x + 1 < self.width { 0.5 } else { 0.0 };
                let (here, there) = ((start + x) * labels, (from + x / 2) * labels);
                for l in 0..labels {
                    self.right[here + l][lane] = right * coarser.right[there + l][of];
                    self.down[here + l][lane] = down * coarser.down[there + l][of];
                }
            }
        }
    }

    /// Share of a pixel's costs in each message: one over the number of chains through the pixel. That is two, unless the grid is a
    /// single row or column, or the pixel is the last of the first row or the first of the last row.
    #[inline(always)]
    fn shares(&self, step: usize, corners: [(usize, usize); 2]) -> f32x4 {
        let shares = f32x4::splat(if self.width.min(self.height) > 1 { 0.5 } else { 1.0 });
        corners.iter().fold(shares, |shares, &(place, lane)| {
            if place == step {
                let mut shares = shares.to_array();
                shares[lane] = 1.0;
                f32x4::new(shares)
            } else {
                shares
            }
        })
    }

    /// The places of the two pixels with a share of one.
    fn corners(&self) -> [(usize, usize); 2] {
        [self.place(self.width - 1, 0), self.place(0, self.height - 1)]
    }

    /// The step, in the band above, of the pixel above the first row's in the step `column` of the band that begins at `first`.
    #[inline(always)]
    fn above(&self, first: usize, column: usize) -> Option<usize> {
        (first > 0 && column < self.width).then(|| first - self.width + column)
    }

    /// Sends messages right and down.
    fn forward(&mut self) {
        match self.labels {
            2 => self.send_forward::<2>(),
            3 => self.send_forward::<3>(),
            4 => self.send_forward::<4>(),
            8 => self.send_forward::<8>(),
            _ => self.send_forward::<MAX_LABELS>(),
        }
    }

    /// Sends messages left and up; returns a lower bound of the energy.
    fn backward(&mut self) -> f64 {
        match self.labels {
            2 => self.send_backward::<2>(),
            3 => self.send_backward::<3>(),
            4 => self.send_backward::<4>(),
            8 => self.send_backward::<8>(),
            _ => self.send_backward::<MAX_LABELS>(),
        }
    }

    fn send_forward<const L: usize>(&mut self) {
        let (steps, corners) = (self.steps(), self.corners());
        for first in (0..self.to_right.len()).step_by(steps) {
            let (mut from_left, mut from_above) = ([f32x4::ZERO; L], [f32x4::ZERO; L]);
            for step in first..first + steps {
                let above = self.above(first, step - first);
                let shares = self.shares(step, corners);
                let [costs, right, down] = [&self.costs, &self.right, &self.down].map(|values| at::<L>(values, step));
                let total: [f32x4; L] = std::array::from_fn(|l| {
                    let above = above.map_or(0.0, |above| self.down[above * L + l][BEHIND]);
                    costs[l] + right[l] + down[l] + from_left[l] + lowered(above, from_above[l])
                });
                (from_left, _) = message(&total, shares, &right, f32x4::new(self.to_right[step]));
                (from_above, _) = message(&total, shares, &down, f32x4::new(self.to_below[step]));
                put(&mut self.right, step, &from_left);
                put(&mut self.down, step, &from_above);
            }
        }
    }

    fn send_backward<const L: usize>(&mut self) -> f64 {
        let (steps, corners) = (self.steps(), self.corners());
        let mut bound = 0.0;
        for first in (0..self.to_right.len()).step_by(steps).rev() {
            let mut sums = [0.0f64; ROWS];
            for step in (first..first + steps).rev() {
                let above = self.above(first, step - first);
                // Before the first step there is nothing.
                let before = step.checked_sub(1).filter(|_| step > first);
                let shares = self.shares(step, corners);
                let messages = |values| before.map_or([f32x4::ZERO; L], |before| at::<L>(values, before));
                let (left, before_down) = (messages(&self.right), messages(&self.down));
                let weights = |values: &[Step]| before.map_or(f32x4::ZERO, |before| f32x4::new(values[before]));
                let (weights_left, weights_down) = (weights(&self.to_right), weights(&self.to_below));
                let up: [f32x4; L] = std::array::from_fn(|l| {
                    lowered(above.map_or(0.0, |above| self.down[above * L + l][BEHIND]), before_down[l])
                });
                let weights_up = lowered(above.map_or(0.0, |above| self.to_below[above][BEHIND]), weights_down);
                let [costs, right, down] = [&self.costs, &self.right, &self.down].map(|values| at::<L>(values, step));
                let mut total: [f32x4; L] = std::array::from_fn(|l| costs[l] + right[l] + down[l] + left[l] + up[l]);
                let low = lowest(&total);
                total.iter_mut().for_each(|t| *t -= low);
                let (to_left, removed_left) = message(&total, shares, &left, weights_left);
                let (to_above, removed_up) = message(&total, shares, &up, weights_up);
                for removed in [low, removed_left, removed_up] {
                    sums.iter_mut().zip(removed.to_array()).for_each(|(sum, removed)| *sum += f64::from(removed));
                }
                let to_above = to_above.map(f32x4::to_array);
                if let Some(before) = before {
                    put(&mut self.right, before, &to_left);
                    let down = &mut self.down[before * L..][..L];
                    down.iter_mut().zip(&to_above).for_each(|(down, to)| *down = [to[1], to[2], to[3], down[BEHIND]]);
                }
                if let Some(above) = above {
                    let down = &mut self.down[above * L..][..L];
                    down.iter_mut().zip(&to_above).for_each(|(down, to)| down[BEHIND] = to[0]);
                }
            }
            sums.iter().rev().for_each(|sum| bound += sum);
        }
        bound
    }

    /// Reads out labels: each pixel takes the cheapest label given the labels before it and the messages from after it. Returns their
    /// energy.
    #[inline(never)]
    fn read_out(&self, labels: &mut [u8]) -> f64 {
        let steps = self.steps();
        let mut energy = 0.0;
        let mut found_in = vec![[0.0; ROWS]; steps];
        let mut row_above: Vec<f32> = vec![0.0; self.width];
        for (first, labels) in (0..).step_by(steps).zip(labels.chunks_mut(ROWS * self.width)) {
            let mut sums = [0.0f64; ROWS];
            let (mut last, mut weights, mut weights_down) = (f32x4::ZERO, f32x4::ZERO, f32x4::ZERO);
            for (x, found_in) in found_in.iter_mut().enumerate() {
                let step = first + x;
                let (above, weight_above) = match self.above(first, x) {
                    Some(above) => (row_above[x], self.to_below[above][BEHIND]),
                    None => (0.0, 0.0),
                };
                let (up, weights_up) = (lowered(above, last), lowered(weight_above, weights_down));
                let of_step = |values| labels_of(values, step, self.labels);
                let each = of_step(&self.costs).iter().zip(of_step(&self.right)).zip(of_step(&self.down));
                let (mut best, mut prices, mut found) = (f32x4::splat(f32::INFINITY), f32x4::ZERO, f32x4::ZERO);
                for (l, ((cost, right), down)) in each.enumerate() {
                    let label = f32x4::splat(l as f32);
                    let [cost, right, down] = [cost, right, down].map(|values| f32x4::new(*values));
                    let fixed = (last.simd_ne(label) & weights) + (up.simd_ne(label) & weights_up);
                    let value = cost + right + down + fixed;
                    let better = value.simd_lt(best);
                    found = better.select(label, found);
                    prices = better.select(cost + fixed, prices);
                    best = value.fast_min(best);
                }
                sums.iter_mut().zip(prices.to_array()).for_each(|(sum, price)| *sum += f64::from(price));
                *found_in = found.to_array();
                (last, weights) = (found, f32x4::new(self.to_right[step]));
                weights_down = f32x4::new(self.to_below[step]);
            }
            sums.iter().for_each(|sum| energy += sum);
            for (k, row) in labels.chunks_mut(self.width).enumerate() {
                row.iter_mut().zip(&found_in[k..]).for_each(|(label, found)| *label = found[k] as u8);
            }
            row_above.iter_mut().zip(&found_in[BEHIND..]).for_each(|(above, found)| *above = found[BEHIND]);
        }
        energy
    }
}

/// Writes a grid's rows, each as long as there are values, to every `stride`-th of `steps`; values are cut to ±`most`.
#[inline(never)]
fn stagger<'a>(
    row: impl Fn(usize) -> &'a [f32],
    [width, height]: [usize; 2],
    most: f32,
    steps: &mut [Step],
    stride: usize,
) {
    for y in 0..height {
        let start = y / ROWS * (width + BEHIND) + y % ROWS;
        let places = steps[start * stride..].iter_mut().step_by(stride);
        places.zip(row(y)).for_each(|(step, &value)| step[y % ROWS] = cut(value, most));
    }
}

/// The values of all labels in a step.
fn labels_of(values: &[Step], step: usize, labels: usize) -> &[Step] {
    &values[step * labels..][..labels]
}

/// The same where the compiler knows their number.
#[inline(always)]
fn at<const L: usize>(values: &[Step], step: usize) -> [f32x4; L] {
    values.as_chunks::<L>().0[step].map(f32x4::new)
}

#[inline(always)]
fn put<const L: usize>(values: &mut [Step], step: usize, new: &[f32x4; L]) {
    values.as_chunks_mut::<L>().0[step] = new.map(f32x4::to_array);
}

/// The values of each row in the next one, with `above` in the first.
#[inline(always)]
fn lowered(above: f32, values: f32x4) -> f32x4 {
    let [first, second, third, _] = values.to_array();
    f32x4::new([above, first, second, third])
}

/// The smallest value of any label.
#[inline(always)]
fn lowest<const L: usize>(values: &[f32x4; L]) -> f32x4 {
    values[1..].iter().fold(values[0], |low, value| value.fast_min(low))
}

/// The new message along an edge whose message in the opposite direction was `old`, and what was subtracted to make its smallest
/// entry zero.
#[inline(always)]
fn message<const L: usize>(total: &[f32x4; L], shares: f32x4, old: &[f32x4; L], weights: f32x4) -> ([f32x4; L], f32x4) {
    let source: [f32x4; L] = std::array::from_fn(|l| shares * total[l] - old[l]);
    let low = lowest(&source);
    (source.map(|value| (value - low).fast_min(weights)), low)
}
