//! Sequential tree-reweighted message passing (Kolmogorov, PAMI 28(10), 2006) on the 4-connected grid with Potts weights.
//!
//! Pixels are visited in raster order. Every edge keeps one message, towards the end that is visited next. A
//! forward pass sends messages right and down, a backward pass left and up. With Potts weights a message costs O(labels):
//! `m(l) = min(s(l) − min s, w)`. The backward pass also gives a lower bound of the energy, which never falls; where
//! the energy of the labels read out on the way meets it, they are optimal and the iteration ends.
//!
//! On a pyramid (costs and weights summed over 2×2 blocks, messages handed down at half their size) a handful of
//! iterations carries information across the image that would otherwise need as many iterations as a region is wide.

use super::potts::{Potts, allowed};
use crate::workspace::{Buffer, Kept};

/// Labels are handled in vectors of 4, 8 or 16.
pub(super) const MAX_LABELS: usize = 16;
/// Cost of the padding labels of a vector.
const PADDING: f32 = 1e20;
/// Smallest side of a level of the pyramid.
const SMALLEST: usize = 8;
/// Up to this many iterations are completed before labels are read out.
const FEW: usize = 2;
/// Relative gap between energy and bound at which the labels count as optimal.
const CLOSED: f64 = 1e-6;
/// Relative rise of the bound in one iteration below which the iteration stops.
const STALLED: f64 = 2e-6;

/// Labels, and a lower bound of the energy.
pub(super) struct Solution {
    pub(super) labels: Buffer<u8>,
    #[cfg_attr(not(test), allow(dead_code))]
    pub(super) bound: f64,
}

/// At most `iterations` iterations on each of at most `levels` levels.
#[inline(never)]
pub(super) fn minimise(problem: &Potts<'_>, levels: usize, iterations: usize) -> Solution {
    match problem.costs.len() {
        0..=4 => solve::<4>(problem, levels, iterations),
        5..=8 => solve::<8>(problem, levels, iterations),
        _ => solve::<16>(problem, levels, iterations),
    }
}

/// One level: a grid with costs, weights, and the messages on its edges.
struct Grid<const L: usize>
where
    [f32; L]: Kept,
{
    width: usize,
    height: usize,
    costs: Buffer<[f32; L]>,
    /// Weight of the edge from p to its right and to its lower neighbour; 0 where there is none.
    weights: Buffer<[f32; 2]>,
    /// Message on the edge from p to its right neighbour and to its lower neighbour; all 0 where there is none.
    right: Buffer<[f32; L]>,
    down: Buffer<[f32; L]>,
}

fn solve<const L: usize>(problem: &Potts<'_>, levels: usize, iterations: usize) -> Solution
where
    [f32; L]: Kept,
{
    let mut pyramid = vec![Grid::<L>::new(problem)];
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
            pyramid[level].forward(None);
            pyramid[level].backward();
        }
        let (finer, coarser) = pyramid.split_at_mut(level);
        finer[level - 1].take_messages_from(&coarser[0]);
    }

    let grid = &mut pyramid[0];
    let mut labels = Buffer::filled(grid.costs.len(), 0u8);
    let (mut best, mut lowest) = (labels.clone(), f64::INFINITY);
    let mut bound = f64::NEG_INFINITY;
    let unread = if iterations <= FEW { iterations } else { 0 };
    for _ in 0..unread {
        grid.forward(None);
        grid.backward();
    }
    for iteration in unread..=iterations {
        // If all messages are still zero, this reads out the costs alone: a valid labelling.
        let energy = grid.forward(Some(&mut labels));
        if energy < lowest {
            lowest = energy;
            best.copy_from_slice(&labels);
        }
        if iteration == iterations || lowest - bound <= CLOSED * (1.0 + lowest.abs()) {
            break;
        }
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

/// Coarse levels only initialise the messages, so a few iterations are enough.
const COARSE_ITERATIONS: usize = 3;

/// State of a row during a pass. Each pixel depends on its neighbour's message, so two rows are processed in turns, the second one
/// pixel behind.
struct Row<const L: usize> {
    /// Index of its first pixel.
    start: usize,
    /// The message from the neighbour that was visited last, its label, and the weight of the edge to it.
    message: [f32; L],
    label: u8,
    weight: f32,
    /// Energy or bound.
    sum: f64,
    /// Shares of its first pixel, its last, and those between.
    shares: [f32; 3],
}

impl<const L: usize> Row<L> {
    fn new(grid: &Grid<L>, y: usize) -> Self
    where
        [f32; L]: Kept,
    {
        let last = grid.width - 1;
        let shares = [grid.share(0, y), grid.share(last, y), grid.share(last.min(1), y)];
        Row { start: y * grid.width, message: [0.0; L], label: 0, weight: 0.0, sum: 0.0, shares }
    }

    #[inline(always)]
    fn share(&self, x: usize, width: usize) -> f32 {
        if x == 0 {
            self.shares[0]
        } else if x + 1 == width {
            self.shares[1]
        } else {
            self.shares[2]
        }
    }
}

impl<const L: usize> Grid<L>
where
    [f32; L]: Kept,
{
    fn new(problem: &Potts<'_>) -> Self {
        let (width, height) = (problem.width(), problem.height());
        let size = width * height;
        // Padding labels keep their price.
        let mut costs = Buffer::filled(size, [PADDING; L]);
        for (l, plane) in problem.costs.iter().enumerate() {
            costs.iter_mut().zip(plane.values()).for_each(|(cost, &of_label)| cost[l] = allowed(of_label));
        }
        let (h, v) = (problem.horizontal.values(), problem.vertical.values());
        let mut weights: Buffer<[f32; 2]> = h.iter().zip(v).map(|(&h, &v)| [h, v]).collect();
        for row in weights.chunks_exact_mut(width) {
            row[width - 1][0] = 0.0;
        }
        weights[(height - 1) * width..].iter_mut().for_each(|w| w[1] = 0.0);
        Grid { width, height, costs, weights, right: Buffer::default(), down: Buffer::default() }
    }

    /// Costs and the weights across the border of 2×2 blocks, summed.
    fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut costs = Buffer::with_capacity(width * height);
        let mut weights = Buffer::with_capacity(width * height);
        let plus = |a: [f32; L], b: &[f32; L]| std::array::from_fn(|l| a[l] + b[l]);
        for y in (0..self.height).step_by(2) {
            let of_row = |y: usize| y * self.width..(y + 1) * self.width;
            let last = (y + 1).min(self.height - 1);
            for (upper, lower) in self.costs[of_row(y)].chunks(2).zip(self.costs[of_row(last)].chunks(2)) {
                let sum = upper[1..].iter().fold(upper[0], plus);
                costs.push(if last > y { lower.iter().fold(sum, plus) } else { sum });
            }
            for (upper, lower) in self.weights[of_row(y)].chunks(2).zip(self.weights[of_row(last)].chunks(2)) {
                let mut across = [0.0, 0.0];
                if let ([_, upper], [_, lower]) = (upper, lower) {
                    across[0] = if last > y { upper[0] + lower[0] } else { upper[0] };
                }
                if last > y {
                    across[1] = lower.iter().map(|w| w[1]).sum();
                }
                weights.push(across);
            }
        }
        Grid { width, height, costs, weights, right: Buffer::default(), down: Buffer::default() }
    }

    /// Sets all messages to zero.
    fn clear_messages(&mut self) {
        self.right = Buffer::filled(self.costs.len(), [0.0; L]);
        self.down = self.right.clone();
    }

    /// Initialises the messages from the coarser level. The bound is valid for any messages.
    fn take_messages_from(&mut self, coarser: &Self) {
        let none = [0.0; L];
        let half = |m: &[f32; L]| m.map(|m| 0.5 * m);
        for (messages, of_coarser) in [(&mut self.right, &coarser.right), (&mut self.down, &coarser.down)] {
            *messages = Buffer::with_capacity(self.width * self.height);
            for y in 0..self.height {
                let row = &of_coarser[y / 2 * coarser.width..][..coarser.width];
                let both = row.iter().flat_map(|m| [half(m); 2]);
                messages.extend(both.take(self.width));
            }
        }
        // No message leaves the grid.
        self.right.chunks_exact_mut(self.width).for_each(|row| row[self.width - 1] = none);
        self.down[(self.height - 1) * self.width..].fill(none);
    }

    /// Share of a pixel's costs in each message: one over the number of chains through the pixel.
    fn share(&self, x: usize, y: usize) -> f32 {
        let ahead = u8::from(x + 1 < self.width) + u8::from(y + 1 < self.height);
        let behind = u8::from(x > 0) + u8::from(y > 0);
        1.0 / f32::from(ahead.max(behind).max(1))
    }

    /// Sends messages right and down. With `labels`, reads them out on the way: each pixel takes the cheapest label given the labels
    /// before it and the messages from after it. Returns the energy of the labels.
    fn forward(&mut self, mut labels: Option<&mut [u8]>) -> f64 {
        let mut energy = 0.0;
        for y in (0..self.height).step_by(2) {
            let (mut upper, mut lower) = (Row::new(self, y), Row::new(self, y + 1));
            let both = y + 1 < self.height;
            for x in 0..=self.width {
                if x < self.width {
                    self.forward_pixel(&mut upper, x, labels.as_deref_mut());
                }
                if both && x > 0 {
                    self.forward_pixel(&mut lower, x - 1, labels.as_deref_mut());
                }
            }
            energy += upper.sum;
            energy += lower.sum;
        }
        energy
    }

    /// Sends messages left and up; returns a lower bound of the energy.
    fn backward(&mut self) -> f64 {
        let mut bound = 0.0;
        for y in (0..self.height.next_multiple_of(2)).rev().step_by(2) {
            let (mut lower, mut upper) = (Row::new(self, y), Row::new(self, y - 1));
            let both = y < self.height;
            for x in (0..=self.width).rev() {
                if both && x > 0 {
                    self.backward_pixel(&mut lower, x - 1);
                }
                if x < self.width {
                    self.backward_pixel(&mut upper, x);
                }
            }
            bound += lower.sum;
            bound += upper.sum;
        }
        bound
    }

    /// A pixel's part of [`forward`](Self::forward). What comes from the left is in `row`.
    #[inline(always)]
    fn forward_pixel(&mut self, row: &mut Row<L>, x: usize, labels: Option<&mut [u8]>) {
        let p = row.start + x;
        let (costs, right, down) = (&self.costs[p], self.right[p], self.down[p]);
        let [to_right, to_below] = self.weights[p];
        let up = if row.start > 0 { self.down[p - self.width] } else { [0.0; L] };
        let ahead = sum3(costs, &right, &down);
        if let Some(labels) = labels {
            let mut fixed = [0.0; L];
            add_change(&mut fixed, row.label, row.weight);
            if row.start > 0 {
                add_change(&mut fixed, labels[p - self.width], self.weights[p - self.width][1]);
            }
            let l = first_lowest::<L>(&std::array::from_fn(|l| ahead[l] + fixed[l]));
            (row.label, row.weight) = (l as u8, to_right);
            labels[p] = row.label;
            row.sum += f64::from(costs[l] + fixed[l]);
        }
        let total = sum3(&ahead, &row.message, &up);
        let share = row.share(x, self.width);
        (row.message, _) = message(&total, share, &right, to_right);
        self.right[p] = row.message;
        (self.down[p], _) = message(&total, share, &down, to_below);
    }

    /// A pixel's part of [`backward`](Self::backward). What comes from the right is in `row`.
    #[inline(always)]
    fn backward_pixel(&mut self, row: &mut Row<L>, x: usize) {
        let p = row.start + x;
        let left = if x > 0 { self.right[p - 1] } else { [0.0; L] };
        let up = if row.start > 0 { self.down[p - self.width] } else { [0.0; L] };
        let mut total = sum3(&sum3(&self.costs[p], &row.message, &self.down[p]), &left, &up);
        let lowest = lowest(&total);
        row.sum += f64::from(lowest);
        total.iter_mut().for_each(|t| *t -= lowest);
        let share = row.share(x, self.width);
        if x > 0 {
            let removed;
            (row.message, removed) = message(&total, share, &left, self.weights[p - 1][0]);
            self.right[p - 1] = row.message;
            row.sum += f64::from(removed);
        }
        if row.start > 0 {
            let (sent, removed) = message(&total, share, &up, self.weights[p - self.width][1]);
            self.down[p - self.width] = sent;
            row.sum += f64::from(removed);
        }
    }
}

#[inline(always)]
fn sum3<const L: usize>(a: &[f32; L], b: &[f32; L], c: &[f32; L]) -> [f32; L] {
    std::array::from_fn(|l| a[l] + b[l] + c[l])
}

/// Adds the weight to all labels but one.
#[inline(always)]
fn add_change<const L: usize>(price: &mut [f32; L], label: u8, weight: f32) {
    for (l, p) in price.iter_mut().enumerate() {
        *p += if l == usize::from(label) { 0.0 } else { weight };
    }
}

/// The smallest value, by halves so that the compiler can compare several at once.
#[inline(always)]
fn lowest<const L: usize>(values: &[f32; L]) -> f32 {
    let mut v = *values;
    let mut half = L / 2;
    while half > 0 {
        for l in 0..half {
            v[l] = if v[l + half] < v[l] { v[l + half] } else { v[l] };
        }
        half /= 2;
    }
    v[0]
}

/// The first index of the smallest value.
#[inline(always)]
fn first_lowest<const L: usize>(values: &[f32; L]) -> usize {
    let value = lowest(values);
    let places: [f32; L] = std::array::from_fn(|l| if values[l] == value { l as f32 } else { L as f32 });
    // An index below L, unless all values are NaN.
    (lowest(&places) as usize).min(L - 1)
}

/// The new message along an edge whose message in the opposite direction was `old`, and what was subtracted to make its smallest
/// entry zero.
#[inline(always)]
fn message<const L: usize>(total: &[f32; L], share: f32, old: &[f32; L], weight: f32) -> ([f32; L], f32) {
    let source: [f32; L] = std::array::from_fn(|l| share * total[l] - old[l]);
    let low = lowest(&source);
    (
        std::array::from_fn(|l| {
            let m = source[l] - low;
            if m < weight { m } else { weight }
        }),
        low,
    )
}
