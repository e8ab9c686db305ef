//! The labelling energy `E(l) = Σ_p D_p(l_p) + Σ_pq w_pq [l_p ≠ l_q]` on the 4-connected grid.

use crate::frame::Plane;

/// Largest absolute cost of a pixel under a label. Larger costs and NaN mean "forbidden" and are cut to this.
pub(super) const FORBIDDEN: f32 = 1e7;

/// A labelling problem: costs and weights of one grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Potts<'a> {
    /// One plane per label, `costs[l].at(x, y)` = D_p(l); all of one size.
    pub(crate) costs: &'a [Plane],
    /// `horizontal.at(x, y)` ≥ 0 is the penalty of different labels at (x, y) and (x + 1, y); the last column is not read.
    pub(crate) horizontal: &'a Plane,
    /// `vertical.at(x, y)` ≥ 0 is the penalty of different labels at (x, y) and (x, y + 1); the last row is not read.
    pub(crate) vertical: &'a Plane,
}

impl Potts<'_> {
    pub(super) fn width(&self) -> usize {
        self.horizontal.width()
    }

    pub(super) fn height(&self) -> usize {
        self.horizontal.height()
    }

    /// The largest weight; a small number where there are none.
    pub(super) fn heaviest(&self) -> f32 {
        let (width, height) = (self.width(), self.height());
        let mut heaviest = 1e-6;
        let mut see = |row: &[f32]| row.iter().for_each(|&w| heaviest = if w > heaviest { w } else { heaviest });
        (0..height).for_each(|y| see(&self.horizontal.row(y)[..width - 1]));
        (0..height - 1).for_each(|y| see(self.vertical.row(y)));
        heaviest
    }

    /// The costs of a row under a label, each cut to ±[`FORBIDDEN`].
    pub(super) fn costs_of_row(&self, label: usize, y: usize) -> impl Iterator<Item = f32> {
        self.costs[label].row(y).iter().map(|&cost| cut(cost, FORBIDDEN))
    }

    /// The cost of pixel p under a label, cut to ±[`FORBIDDEN`].
    #[inline]
    pub(super) fn cost(&self, label: usize, p: usize) -> f32 {
        cut(self.costs[label].values()[p], FORBIDDEN)
    }

    /// Energy of a labelling.
    #[cfg(test)]
    pub(crate) fn energy(&self, labels: &[u8]) -> f64 {
        let (width, height) = (self.width(), self.height());
        let mut energy = 0.0;
        for y in 0..height {
            for x in 0..width {
                let p = y * width + x;
                energy += f64::from(self.cost(usize::from(labels[p]), p));
                if x + 1 < width && labels[p] != labels[p + 1] {
                    energy += f64::from(self.horizontal.values()[p]);
                }
                if y + 1 < height && labels[p] != labels[p + width] {
                    energy += f64::from(self.vertical.values()[p]);
                }
            }
        }
        energy
    }

    /// Iterated conditional modes: every pixel beside one with another label takes the label that is cheapest given its four
    /// neighbours, until nothing changes or for `sweeps` sweeps. Never raises the energy.
    pub(super) fn descend(&self, labels: &mut [u8], sweeps: usize) {
        let (width, height) = (self.width(), self.height());
        let (horizontal, vertical) = (self.horizontal.values(), self.vertical.values());
        for _ in 0..sweeps {
            let mut changed = false;
            for y in 0..height {
                for x in 0..width {
                    let p = y * width + x;
                    let own = labels[p];
                    let other = |there: bool, q: usize| there && labels[q] != own;
                    if !(other(x > 0, p.wrapping_sub(1))
                        || other(x + 1 < width, p + 1)
                        || other(y > 0, p.wrapping_sub(width))
                        || other(y + 1 < height, p + width))
                    {
                        continue;
                    }
                    // A missing neighbour has the pixel's own label and weight 0.
                    let beside = [
                        if x > 0 { (labels[p - 1], horizontal[p - 1]) } else { (own, 0.0) },
                        if x + 1 < width { (labels[p + 1], horizontal[p]) } else { (own, 0.0) },
                        if y > 0 { (labels[p - width], vertical[p - width]) } else { (own, 0.0) },
                        if y + 1 < height { (labels[p + width], vertical[p]) } else { (own, 0.0) },
                    ];
                    let energy = |label: u8| {
                        let borders = beside.iter().map(|&(other, weight)| if other == label { 0.0 } else { weight });
                        borders.fold(self.cost(usize::from(label), p), |sum, weight| sum + weight)
                    };
                    let mut best = (own, energy(own));
                    for label in 0..self.costs.len() as u8 {
                        let energy = energy(label);
                        if energy < best.1 {
                            best = (label, energy);
                        }
                    }
                    changed |= best.0 != own;
                    labels[p] = best.0;
                }
            }
            if !changed {
                break;
            }
        }
    }
}

/// A value cut to ±`most`; NaN becomes `most`.
#[inline(always)]
#[allow(clippy::manual_clamp)] // `clamp` would let NaN through
pub(super) fn cut(value: f32, most: f32) -> f32 {
    let value = if value < most { value } else { most };
    if value > -most { value } else { -most }
}
