//! Upsampling of labels to full size: each label's mask is enlarged and aligned with the edges of the full-size frame by the guided
//! filter (He, Sun, Tang, PAMI 35(6), 2013); the strongest label wins.
//!
//! Tiles are processed one by one with the labels near them. Most tiles have one label nearby and need no filtering.

use std::ops::Range;

use crate::frame::Plane;
use crate::frame::area::Area;
use crate::frame::scaling::Scaling;
use crate::lanes::each_with;
use crate::model::Model;

/// Radius of the filter's windows, full-size pixels. Not varied: the sums below are made for it.
const RADIUS: usize = 4;
/// Side of a tile, full-size pixels. For speed.
const TILE: usize = 32;

/// Labels of the small size, all below `of`, at full size, that of `guide`.
pub(crate) fn upsample(labels: &[u8], scaling: &Scaling, of: usize, guide: &Plane, model: &Model) -> Vec<u8> {
    if scaling.step == 1 {
        return labels.to_vec();
    }
    let [full_width, full_height] = scaling.full;
    let grid = LabelGrid { labels, scaling };
    let mut winner = vec![0u8; full_width * full_height];
    for top in (0..full_height).step_by(TILE) {
        for left in (0..full_width).step_by(TILE) {
            let (right, bottom) = ((left + TILE).min(full_width), (top + TILE).min(full_height));
            let tile = Area { columns: left..right, rows: top..bottom };
            let present = grid.present(&tile.grown(2 * RADIUS, full_width, full_height), of);
            match present[..] {
                [only] => tile.rows.for_each(|y| winner[y * full_width..][tile.columns.clone()].fill(only)),
                _ => decide(&grid, &present, guide, &tile, &mut winner, model),
            }
        }
    }
    winner
}

/// Gives every pixel of a tile the strongest of the labels, the first on ties.
fn decide(grid: &LabelGrid<'_>, labels: &[u8], guide: &Plane, tile: &Area, winner: &mut [u8], model: &Model) {
    let full = (guide.width(), guide.height());
    let guide = Patch::from_fn(tile.grown(2 * RADIUS, full.0, full.1), |x, y| guide.at(x, y));
    let filter = GuidedFilter::new(&guide, tile, full, model.flat_variance);
    let mut best = Patch::from_fn(tile.clone(), |_, _| f32::NEG_INFINITY);
    // The masks sum to one and the filter is linear, so the strengths sum to one: the last is the remainder.
    let mut rest = Patch::from_fn(tile.clone(), |_, _| 1.0);
    for (k, &label) in labels.iter().enumerate() {
        let strength = if k + 1 < labels.len() {
            let strength = match model.flat_variance.is_finite() {
                true => filter.apply(&guide, &grid.mask(label, guide.area.clone()), tile),
                false => grid.mask(label, tile.clone()),
            };
            rest.values.iter_mut().zip(&strength.values).for_each(|(r, s)| *r -= s);
            strength
        } else {
            Patch { area: tile.clone(), values: std::mem::take(&mut rest.values) }
        };
        for y in tile.rows.clone() {
            let winner = &mut winner[y * full.0..][tile.columns.clone()];
            for ((b, w), s) in best.row_mut(y).iter_mut().zip(winner).zip(strength.row(y)) {
                if *s > *b {
                    (*b, *w) = (*s, label);
                }
            }
        }
    }
}

/// A plane of the small size enlarged bilinearly to the full one.
pub(crate) fn enlarged(small: &Plane, scaling: &Scaling) -> Plane {
    let [width, height] = scaling.full;
    Plane::from_vec(width, height, Patch::enlarged(Area::whole(width, height), scaling, |x, y| small.at(x, y)).values)
}

/// Labels at a fraction of the full size.
struct LabelGrid<'a> {
    labels: &'a [u8],
    scaling: &'a Scaling,
}

impl LabelGrid<'_> {
    /// The labels, below `of`, that have any weight in an area of the full size, in order.
    fn present(&self, area: &Area, of: usize) -> Vec<u8> {
        let mut found = vec![false; of];
        let Scaling { small: [width, height], step, .. } = *self.scaling;
        let cells = |of: &Range<usize>, size: usize| of.start / step..((of.end - 1) / step + 2).min(size);
        for y in cells(&area.rows, height) {
            for &label in &self.labels[y * width..][cells(&area.columns, width)] {
                if let Some(slot) = found.get_mut(usize::from(label)) {
                    *slot = true;
                }
            }
        }
        (0..of as u8).filter(|&label| found[usize::from(label)]).collect()
    }

    /// One label's mask, enlarged bilinearly: full pixel X lies at X / 2^k.
    fn mask(&self, label: u8, area: Area) -> Patch {
        let width = self.scaling.small[0];
        let at = |x: usize, y: usize| if self.labels[y * width + x] == label { 1.0 } else { 0.0 };
        Patch::enlarged(area, self.scaling, at)
    }
}

/// Position of a full-size coordinate in a grid of `size` points, `step` times smaller: index of the grid point at or before it, and the
/// fraction beyond.
fn place(x: usize, step: usize, size: usize) -> (usize, f32) {
    if x / step + 1 >= size { (size - 1, 0.0) } else { (x / step, (x % step) as f32 / step as f32) }
}

/// Values of the pixels of an area; rows and columns are addressed as in the frame.
struct Patch {
    area: Area,
    values: Vec<f32>,
}

impl Patch {
    fn from_fn(area: Area, f: impl Fn(usize, usize) -> f32) -> Patch {
        let mut values = Vec::with_capacity(area.width() * area.height());
        for y in area.rows.clone() {
            values.extend(area.columns.clone().map(|x| f(x, y)));
        }
        Patch { area, values }
    }

    /// Bilinear enlargement of an area of the full size from small values: full-size pixel X lies at X / step.
    fn enlarged(area: Area, scaling: &Scaling, at: impl Fn(usize, usize) -> f32) -> Patch {
        let Scaling { small: [width, height], step, .. } = *scaling;
        // A row of the small grid at the columns of the area.
        let stretched = |y: usize, row: &mut Vec<f32>| {
            row.clear();
            row.extend(area.columns.clone().map(|x| {
                let (left, share) = place(x, step, width);
                let (a, b) = (at(left, y), at((left + 1).min(width - 1), y));
                a + share * (b - a)
            }));
        };
        let [mut top, mut bottom] = [0; 2].map(|_| Vec::with_capacity(area.width()));
        let mut between = None;
        let mut values = Vec::with_capacity(area.width() * area.height());
        for y in area.rows.clone() {
            let (upper, share) = place(y, step, height);
            if between != Some(upper) {
                stretched(upper, &mut top);
                stretched((upper + 1).min(height - 1), &mut bottom);
                between = Some(upper);
            }
            let start = values.len();
            values.extend_from_slice(&top);
            each_with(&mut values[start..], [&bottom], |top, [bottom]| top + share * (bottom - top));
        }
        Patch { area, values }
    }

    fn row(&self, y: usize) -> &[f32] {
        &self.values[(y - self.area.rows.start) * self.area.width()..][..self.area.width()]
    }

    fn row_mut(&mut self, y: usize) -> &mut [f32] {
        let width = self.area.width();
        &mut self.values[(y - self.area.rows.start) * width..][..width]
    }

    /// Pixel by pixel product of two patches of one area.
    fn times(&self, other: &Patch) -> Patch {
        let values = self.values.iter().zip(&other.values).map(|(a, b)| a * b).collect();
        Patch { area: self.area.clone(), values }
    }

    /// Means over (2·RADIUS + 1)² windows around the pixels of an area of a frame of the given size, with replicated borders. The patch
    /// must reach RADIUS pixels beyond the area wherever the frame does.
    fn box_mean(&self, area: Area, (width, height): (usize, usize)) -> Patch {
        const WEIGHT: f32 = 1.0 / (2 * RADIUS + 1) as f32;
        const { assert!(RADIUS == 4, "sums of nine are made below") };
        // Columns of the patch that the area's windows touch.
        let touched = area.grown(RADIUS, width, height).columns;
        let skipped = touched.start - self.area.columns.start;
        let left = RADIUS - (area.columns.start - touched.start);
        let right = (area.columns.end + RADIUS).saturating_sub(width);
        let mut sums = vec![0.0f32; touched.len()];
        let mut padded = vec![0.0; left + touched.len() + right];
        let (mut two, mut four) = (padded.clone(), padded.clone());
        let mut mean = Patch { values: vec![0.0; area.width() * area.height()], area };
        let top = mean.area.rows.start;
        for y in mean.area.rows.clone() {
            let row = |y: usize| &self.row(y.saturating_sub(RADIUS).min(height - 1))[skipped..];
            if y == top {
                (0..=2 * RADIUS).for_each(|k| each_with(&mut sums, [row(y + k)], |s, [v]| s + v));
            } else {
                // The window moves down: one row leaves, one enters.
                each_with(&mut sums, [row(y + 2 * RADIUS), row(y - 1)], |s, [comes, goes]| s + (comes - goes));
            }
            let middle = &mut padded[left..left + touched.len()];
            each_with(middle, [&sums], |_, [s]| s * WEIGHT);
            let (first, last) = (padded[left], padded[left + touched.len() - 1]);
            padded[..left].fill(first);
            padded[left + touched.len()..].fill(last);
            // Nine neighbours: four and four, each two and two, and one.
            each_with(&mut two, [&padded, &padded[1..]], |_, [a, b]| a + b);
            each_with(&mut four, [&two, &two[2..]], |_, [a, b]| a + b);
            let nine = |_, [a, b, c]: [f32; 3]| (a + b + c) * WEIGHT;
            each_with(mean.row_mut(y), [&four, &four[4..], &padded[8..]], nine);
        }
        mean
    }
}

/// Mean and variance of the guide around the pixels of a tile with a margin.
struct GuidedFilter {
    /// Width and height of the frame.
    full: (usize, usize),
    mean: Patch,
    variance: Patch,
    /// Variance below which a window counts as flat.
    flat_variance: f32,
}

impl GuidedFilter {
    fn new(guide: &Patch, tile: &Area, full: (usize, usize), flat_variance: f32) -> GuidedFilter {
        let area = tile.grown(RADIUS, full.0, full.1);
        let mean = guide.box_mean(area.clone(), full);
        let mut variance = guide.times(guide).box_mean(area, full);
        for (v, m) in variance.values.iter_mut().zip(&mean.values) {
            *v -= m * m;
        }
        GuidedFilter { full, mean, variance, flat_variance }
    }

    /// Filters the input in a tile. Guide and input reach 2·RADIUS pixels beyond the tile.
    fn apply(&self, guide: &Patch, input: &Patch, tile: &Area) -> Patch {
        let area = &self.mean.area;
        let mut offset = input.box_mean(area.clone(), self.full);
        let mut slope = guide.times(input).box_mean(area.clone(), self.full);
        let of_guide = self.mean.values.iter().zip(&self.variance.values);
        for ((s, o), (mean, variance)) in slope.values.iter_mut().zip(offset.values.iter_mut()).zip(of_guide) {
            let covariance = *s - mean * *o;
            let variance = if *variance > 0.0 { *variance } else { 0.0 };
            *s = covariance / (variance + self.flat_variance);
            *o -= *s * mean;
        }
        let mut out = slope.box_mean(tile.clone(), self.full);
        let offset = offset.box_mean(tile.clone(), self.full);
        let skipped = tile.columns.start - guide.area.columns.start;
        for y in tile.rows.clone() {
            let terms = guide.row(y)[skipped..].iter().zip(offset.row(y));
            out.row_mut(y).iter_mut().zip(terms).for_each(|(o, (guide, offset))| *o = *o * guide + offset);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mask_follows_the_edge_of_the_full_frame() {
        // The true edge lies at x = 33, which half the size cannot resolve.
        let guide = Plane::from_fn(64, 48, |x, _| if x < 33 { 40.0 } else { 200.0 });
        let labels: Vec<u8> = (0..32 * 24).map(|p| u8::from(p % 32 >= 17)).collect();
        let full = upsample(&labels, &Scaling::halved([64, 48], 1), 2, &guide, &Model::DEFAULT);
        for y in 4..44 {
            let row: Vec<u8> = full[y * 64..(y + 1) * 64].to_vec();
            let expected: Vec<u8> = (0..64).map(|x| u8::from(x >= 33)).collect();
            assert_eq!(row, expected);
        }
    }
}
