//! Sequential tree-reweighted message passing (Kolmogorov, PAMI 28(10), 2006) on the 4-connected grid with Potts weights.
//!
//! Pixels are visited in raster order. Every edge keeps one message, towards the end that is visited next. A
//! forward pass sends messages right and down, a backward pass left and up. With Potts weights a message costs O(labels):
//! `m(l) = min(s(l) − min s, w)`.
//!
//! On a pyramid (costs and weights summed over 2×2 blocks, messages handed down at half their size) a handful of
//! iterations carries information across the image that would otherwise need as many iterations as a region is wide.
//!
//! Costs and messages are 16-bit integers, in units in which the heaviest weight is [`HEAVIEST`]. They need half the memory of floats,
//! which limits the speed of a pass, are processed twice as many at a time, and are the same on every platform. A label that costs more
//! than the cheapest label of its pixel and the four edges together is never taken. Larger differences are therefore cut, and no sum leaves
//! the range. On each coarser level the unit is twice as large, so that a message handed down at half its size keeps its number.
//!
//! A message depends on the previous one in its row and on the one above it. Eight rows, a band, are therefore processed at once, each one
//! pixel behind the row above. All arithmetic is on eight pixels at a time, and gives the same bits as pixel by pixel:
//!
//! ```text
//! step     0  1  2  3  4  …        the columns of eight rows of three pixels; the rest is padding, without costs and weights
//! row 0    0  1  2
//! row 1       0  1  2
//! row 2          0  1  2
//! …
//! ```

use wide::i16x8;

use super::potts::Potts;

/// Labels are padded to 2, 3, 4, 5, 6, 8, 10, 12 or 16.
pub(super) const MAX_LABELS: usize = 16;
/// The heaviest weight of a problem, in units of costs and messages.
const HEAVIEST: i16 = 4095;
/// Largest cost of a label above that of its pixel's cheapest one: the weight of four edges. The sum with four messages is in range.
const DEAREST: i16 = 4 * HEAVIEST;
/// Smallest side of a level of the pyramid.
const SMALLEST: usize = 8;
/// Coarse levels only initialise the messages, so a few iterations are enough.
const COARSE_ITERATIONS: usize = 3;
/// Rows of a band.
const ROWS: usize = 8;
/// Steps that the last row of a band is behind the first.
const BEHIND: usize = ROWS - 1;

/// Values of the pixels of a band in one step, one of each row.
type Step = [i16; ROWS];

/// Labels after so many iterations on each of at most `levels` levels.
#[inline(never)]
pub(super) fn minimise(problem: &Potts<'_>, levels: usize, iterations: usize) -> Vec<u8> {
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
        pyramid[level].pass_messages(iterations.min(COARSE_ITERATIONS));
        let (finer, coarser) = pyramid.split_at_mut(level);
        finer[level - 1].take_messages_from(&coarser[0]);
    }
    pyramid[0].pass_messages(iterations);
    let mut labels = pyramid[0].read_out();
    problem.descend(&mut labels, 2);
    labels
}

/// Number of labels for which there is code, at least `labels`.
fn padded(labels: usize) -> usize {
    match labels {
        0..=2 => 2,
        3..=6 => labels,
        7..=12 => labels.next_multiple_of(2),
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
    #[inline(never)]
    fn new(problem: &Potts<'_>) -> Self {
        let (width, height, given) = (problem.width(), problem.height(), problem.costs.len());
        let labels = padded(given);
        let mut grid = Self::unconnected(width, height, labels);
        let unit = f32::from(HEAVIEST) / problem.heaviest();
        let mut band = Band::new(width);
        let mut lows = vec![vec![0.0; width]; ROWS];
        for first in 0..height.div_ceil(ROWS) {
            let rows = (first * ROWS..height).take(ROWS);
            for (y, low) in rows.clone().zip(&mut lows) {
                low.fill(f32::INFINITY);
                for label in 0..given {
                    let costs = problem.costs_of_row(label, y);
                    low.iter_mut().zip(costs).for_each(|(low, cost)| *low = if cost < *low { cost } else { *low });
                }
            }
            let start = first * grid.steps();
            for label in 0..labels {
                band.clear();
                for ((y, low), row) in rows.clone().zip(&lows).zip(band.rows()) {
                    if label < given {
                        let costs = problem.costs_of_row(label, y).zip(low);
                        row.iter_mut()
                            .zip(costs)
                            .for_each(|(row, (cost, low))| *row = rounded(unit * (cost - low), DEAREST));
                    } else {
                        row.fill(DEAREST);
                    }
                }
                band.stagger(&mut grid.costs[start * labels + label..], labels);
            }
            let weights = |row: &mut [i16], weights: &[f32]| {
                row.iter_mut().zip(weights).for_each(|(row, weight)| *row = rounded(unit * weight, HEAVIEST));
            };
            band.clear();
            rows.clone().zip(band.rows()).for_each(|(y, row)| weights(row, &problem.horizontal.row(y)[..width - 1]));
            band.stagger(&mut grid.to_right[start..], 1);
            band.clear();
            let connected = rows.filter(|y| y + 1 < height);
            connected.zip(band.rows()).for_each(|(y, row)| weights(row, problem.vertical.row(y)));
            band.stagger(&mut grid.to_below[start..], 1);
        }
        grid
    }

    /// A grid without costs, weights and messages.
    fn unconnected(width: usize, height: usize, labels: usize) -> Self {
        let steps = height.div_ceil(ROWS) * (width + BEHIND);
        let none = |count: usize| vec![[0; ROWS]; count];
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

    /// Costs and the weights across the border of 2×2 blocks, summed, in units twice as large.
    #[inline(never)]
    fn halved(&self) -> Self {
        let labels = self.labels;
        let mut half = Self::unconnected(self.width.div_ceil(2), self.height.div_ceil(2), labels);
        let mut sums = [0i32; MAX_LABELS];
        let weight = |a: i16, b: i16| ((i32::from(a) + i32::from(b)) >> 1) as i16;
        for y in 0..half.height {
            let ((start, lane), (from, at)) = (half.place(0, y), self.place(0, 2 * y));
            for x in 0..half.width {
                let step = start + x;
                // The pixel on the right is a step further in the same lane, the one below a step further in the next lane, as an even row
                // is never the last of a band. Outside the grid there is padding, without costs and weights.
                let upper = from + 2 * x;
                let beside = upper + 1;
                let across = (upper + 2).min(self.to_right.len() - 1);
                for (l, sum) in sums[..labels].iter_mut().enumerate() {
                    let cost = |step: usize, lane: usize| i32::from(self.costs[step * labels + l][lane]);
                    *sum = cost(upper, at) + cost(beside, at) + cost(beside, at + 1) + cost(across, at + 1);
                }
                let low = sums[..labels].iter().fold(i32::MAX, |low, &sum| low.min(sum));
                for (costs, sum) in half.costs[step * labels..].iter_mut().zip(&sums[..labels]) {
                    costs[lane] = ((sum - low) >> 1).min(i32::from(DEAREST)) as i16;
                }
                half.to_right[step][lane] = weight(self.to_right[beside][at], self.to_right[across][at + 1]);
                half.to_below[step][lane] = weight(self.to_below[beside][at + 1], self.to_below[across][at + 1]);
            }
        }
        half
    }

    /// Sets all messages to zero.
    fn clear_messages(&mut self) {
        self.right = vec![[0; ROWS]; self.costs.len()];
        self.down = self.right.clone();
    }

    /// Initialises the messages from the coarser level.
    #[inline(never)]
    fn take_messages_from(&mut self, coarser: &Self) {
        self.clear_messages();
        let (labels, steps) = (self.labels, self.steps());
        for band in 0..self.height.div_ceil(ROWS) {
            let places: [_; ROWS] =
                std::array::from_fn(|r| coarser.place(0, ((band * ROWS + r) / 2).min(coarser.height - 1)));
            for step in 0..steps {
                let from: [_; ROWS] =
                    std::array::from_fn(|r| (places[r].0 + step.saturating_sub(r).min(self.width - 1) / 2) * labels);
                let here = (band * steps + step) * labels;
                for (fine, coarse) in [(&mut self.right, &coarser.right), (&mut self.down, &coarser.down)] {
                    for (l, fine) in fine[here..here + labels].iter_mut().enumerate() {
                        *fine = std::array::from_fn(|r| coarse[from[r] + l][places[r].1]);
                    }
                }
            }
        }
        self.clear_edges();
    }

    /// Removes the messages that leave the grid, and those of the padding.
    fn clear_edges(&mut self) {
        let (labels, steps) = (self.labels, self.steps());
        for y in 0..self.height.next_multiple_of(ROWS) {
            let (band, lane) = (y / ROWS * steps, y % ROWS);
            let clear = |messages: &mut [Step], columns: std::ops::Range<usize>| {
                let outside = (band..band + lane + columns.start).chain(band + lane + columns.end..band + steps);
                for step in outside {
                    messages[step * labels..][..labels].iter_mut().for_each(|values| values[lane] = 0);
                }
            };
            let columns = |there: bool, count: usize| 0..if there { count } else { 0 };
            clear(&mut self.right, columns(y < self.height, self.width - 1));
            clear(&mut self.down, columns(y + 1 < self.height, self.width));
        }
    }

    /// The step, in the band above, of the pixel above the first row's in the step `column` of the band that begins at `first`.
    #[inline(always)]
    fn above(&self, first: usize, column: usize) -> Option<usize> {
        (first > 0 && column < self.width).then(|| first - self.width + column)
    }

    /// Sends messages right and down, then left and up, so many times.
    fn pass_messages(&mut self, times: usize) {
        for _ in 0..times {
            match self.labels {
                2 => self.forward_and_back::<2>(),
                3 => self.forward_and_back::<3>(),
                4 => self.forward_and_back::<4>(),
                5 => self.forward_and_back::<5>(),
                6 => self.forward_and_back::<6>(),
                8 => self.forward_and_back::<8>(),
                10 => self.forward_and_back::<10>(),
                12 => self.forward_and_back::<12>(),
                _ => self.forward_and_back::<MAX_LABELS>(),
            }
        }
    }

    fn forward_and_back<const L: usize>(&mut self) {
        // Half of a pixel's costs goes along each of the two chains through it; a single row or column is one chain.
        if self.width.min(self.height) > 1 {
            self.send_forward::<L, 1>();
            self.send_backward::<L, 1>();
        } else {
            self.send_forward::<L, 0>();
            self.send_backward::<L, 0>();
        }
    }

    fn send_forward<const L: usize, const HALVINGS: i32>(&mut self) {
        let steps = self.steps();
        for first in (0..self.to_right.len()).step_by(steps) {
            let (mut from_left, mut from_above) = ([i16x8::ZERO; L], [i16x8::ZERO; L]);
            for step in first..first + steps {
                let above = self.above(first, step - first);
                let [costs, right, down] = [&self.costs, &self.right, &self.down].map(|values| at::<L>(values, step));
                let share: [i16x8; L] = std::array::from_fn(|l| {
                    let above = above.map_or(0, |above| self.down[above * L + l][BEHIND]);
                    (costs[l] + right[l] + down[l] + from_left[l] + lowered(above, from_above[l])) >> HALVINGS
                });
                from_left = message(&share, &right, i16x8::new(self.to_right[step]));
                from_above = message(&share, &down, i16x8::new(self.to_below[step]));
                put(&mut self.right, step, &from_left);
                put(&mut self.down, step, &from_above);
            }
        }
    }

    fn send_backward<const L: usize, const HALVINGS: i32>(&mut self) {
        let steps = self.steps();
        for first in (0..self.to_right.len()).step_by(steps).rev() {
            for step in (first..first + steps).rev() {
                let above = self.above(first, step - first);
                // Before the first step there is nothing.
                let before = step.checked_sub(1).filter(|_| step > first);
                let messages = |values| before.map_or([i16x8::ZERO; L], |before| at::<L>(values, before));
                let (left, before_down) = (messages(&self.right), messages(&self.down));
                let weights = |values: &[Step]| before.map_or(i16x8::ZERO, |before| i16x8::new(values[before]));
                let (weights_left, weights_down) = (weights(&self.to_right), weights(&self.to_below));
                let up: [i16x8; L] = std::array::from_fn(|l| {
                    lowered(above.map_or(0, |above| self.down[above * L + l][BEHIND]), before_down[l])
                });
                let weights_up = lowered(above.map_or(0, |above| self.to_below[above][BEHIND]), weights_down);
                let [costs, right, down] = [&self.costs, &self.right, &self.down].map(|values| at::<L>(values, step));
                let share: [i16x8; L] =
                    std::array::from_fn(|l| (costs[l] + right[l] + down[l] + left[l] + up[l]) >> HALVINGS);
                let to_left = message(&share, &left, weights_left);
                let to_above = message(&share, &up, weights_up).map(i16x8::to_array);
                if let Some(before) = before {
                    put(&mut self.right, before, &to_left);
                    let down = &mut self.down[before * L..][..L];
                    for (down, to) in down.iter_mut().zip(&to_above) {
                        *down = [to[1], to[2], to[3], to[4], to[5], to[6], to[7], down[BEHIND]];
                    }
                }
                if let Some(above) = above {
                    let down = &mut self.down[above * L..][..L];
                    down.iter_mut().zip(&to_above).for_each(|(down, to)| down[BEHIND] = to[0]);
                }
            }
        }
    }

    /// Reads out labels: each pixel takes the cheapest label given the labels before it and the messages from after it.
    #[inline(never)]
    fn read_out(&self) -> Vec<u8> {
        let steps = self.steps();
        let mut labels = vec![0u8; self.width * self.height];
        let mut found_in = vec![[0; ROWS]; steps];
        let mut row_above: Vec<i16> = vec![0; self.width];
        for (first, labels) in (0..).step_by(steps).zip(labels.chunks_mut(ROWS * self.width)) {
            let (mut last, mut weights, mut weights_down) = (i16x8::ZERO, i16x8::ZERO, i16x8::ZERO);
            for (x, found_in) in found_in.iter_mut().enumerate() {
                let step = first + x;
                let (above, weight_above) = match self.above(first, x) {
                    Some(above) => (row_above[x], self.to_below[above][BEHIND]),
                    None => (0, 0),
                };
                let (up, weights_up) = (lowered(above, last), lowered(weight_above, weights_down));
                let of_step = |values| labels_of(values, step, self.labels);
                let each = of_step(&self.costs).iter().zip(of_step(&self.right)).zip(of_step(&self.down));
                let (mut best, mut found) = (i16x8::MAX, i16x8::ZERO);
                for (l, ((cost, right), down)) in each.enumerate() {
                    let label = i16x8::splat(l as i16);
                    let [cost, right, down] = [cost, right, down].map(|values| i16x8::new(*values));
                    let same = (last.simd_eq(label) & weights) + (up.simd_eq(label) & weights_up);
                    let value = cost + right + down + weights + weights_up - same;
                    found = value.simd_lt(best).select(label, found);
                    best = value.min(best);
                }
                *found_in = found.to_array();
                (last, weights) = (found, i16x8::new(self.to_right[step]));
                weights_down = i16x8::new(self.to_below[step]);
            }
            for (k, row) in labels.chunks_mut(self.width).enumerate() {
                row.iter_mut().zip(&found_in[k..]).for_each(|(label, found)| *label = found[k] as u8);
            }
            row_above.iter_mut().zip(&found_in[BEHIND..]).for_each(|(above, found)| *above = found[BEHIND]);
        }
        labels
    }
}

/// 2²³: from here on an `f32` has no fraction, and its last bits are a whole number.
const NO_FRACTION: f32 = 8_388_608.0;

/// The whole number nearest to one of 0 or more, at most `most`. Unlike a cast this vectorises.
#[inline(always)]
fn rounded(value: f32, most: i16) -> i16 {
    let most = f32::from(most);
    let value = if value < most { value } else { most };
    (value + NO_FRACTION).to_bits() as u16 as i16
}

/// Rows of a band before they are written to its steps, with padding on both sides for their offsets.
struct Band {
    width: usize,
    rows: [Vec<i16>; ROWS],
}

impl Band {
    fn new(width: usize) -> Band {
        Band { width, rows: [0; ROWS].map(|_| vec![0; (width + BEHIND).next_multiple_of(ROWS) + BEHIND]) }
    }

    fn clear(&mut self) {
        self.rows.iter_mut().for_each(|row| row.fill(0));
    }

    fn rows(&mut self) -> impl Iterator<Item = &mut [i16]> {
        let width = self.width;
        self.rows.iter_mut().map(move |row| &mut row[BEHIND..BEHIND + width])
    }

    /// Writes the values to every `stride`-th of `places`, one for each step.
    #[inline(never)]
    fn stagger(&self, places: &mut [Step], stride: usize) {
        let mut places = places.iter_mut().step_by(stride);
        for step in (0..self.width + BEHIND).step_by(ROWS) {
            let rows: [i16x8; ROWS] =
                std::array::from_fn(|r| i16x8::from_slice_unaligned(&self.rows[r][BEHIND + step - r..][..ROWS]));
            for (values, place) in i16x8::transpose(rows).iter().zip(places.by_ref()) {
                *place = values.to_array();
            }
        }
    }
}

/// The values of all labels in a step.
fn labels_of(values: &[Step], step: usize, labels: usize) -> &[Step] {
    &values[step * labels..][..labels]
}

/// The same where the compiler knows their number.
#[inline(always)]
fn at<const L: usize>(values: &[Step], step: usize) -> [i16x8; L] {
    values.as_chunks::<L>().0[step].map(i16x8::new)
}

#[inline(always)]
fn put<const L: usize>(values: &mut [Step], step: usize, new: &[i16x8; L]) {
    values.as_chunks_mut::<L>().0[step] = new.map(i16x8::to_array);
}

/// The values of each row in the next one, with `above` in the first.
#[inline(always)]
fn lowered(above: i16, values: i16x8) -> i16x8 {
    let [a, b, c, d, e, f, g, _] = values.to_array();
    i16x8::new([above, a, b, c, d, e, f, g])
}

/// The new message along an edge whose message in the opposite direction was `old`.
#[inline(always)]
fn message<const L: usize>(share: &[i16x8; L], old: &[i16x8; L], weights: i16x8) -> [i16x8; L] {
    let source: [i16x8; L] = std::array::from_fn(|l| share[l] - old[l]);
    let low = source[1..].iter().fold(source[0], |low, value| low.min(*value));
    source.map(|value| (value - low).min(weights))
}
