//! Labels of a coarser level at the working size: coarse labels decide what is there, fine costs where exactly it ends.
//!
//! Only tiles in which two labels meet, or nearly, are looked at, and only the labels near each compete; those that touch are solved
//! together, on their own. What is known of a neighbourhood rather than of a pixel (how well anything fits there, what is hidden, what the colours say) is taken from the
//! coarser level.

use super::appearance::{ColourPrices, Palette};
use super::energy::{Borders, Coherence, Picture, as_label, border_price};
use super::misfit::allowed_for;
use super::potts::Solver;
use super::views::mixed;
use super::visibility::most_where_hidden;
use crate::alignment::cost::{Comparison, CostModel, View};
use crate::frame::Plane;
use crate::frame::area::Area;
use crate::frame::pyramid::Level;
use crate::motion::AffineMotion;

/// Size of a tile, working pixels.
const TILE: [usize; 2] = [32, 8];
/// How far around a tile labels compete in it, coarse pixels.
const MARGIN: usize = 4;
/// What a label costs where it does not compete.
const FAR: f32 = 1e3;

/// A labelling of a coarser level and what it was decided by.
pub(crate) struct Coarse<'a> {
    pub(crate) width: usize,
    pub(crate) labels: &'a [u8],
    /// Working pixels per pixel.
    pub(crate) step: usize,
    /// How much larger the variance is than the noise's.
    pub(crate) misfit: &'a Plane,
    /// Share of the second frame, where there is a frame before.
    pub(crate) shares: Option<&'a Plane>,
    /// For every label the pixels that it may be hidden at.
    pub(crate) hidden: &'a [Vec<bool>],
    /// For every label the pixels that it cannot have, if any.
    pub(crate) barred: &'a [Vec<bool>],
    pub(crate) colours: Option<&'a ColourPrices>,
}

/// What the working size adds.
pub(crate) struct Fine<'a> {
    pub(crate) level: &'a Level,
    pub(crate) picture: Option<&'a Picture>,
    pub(crate) palette: &'a Palette,
    pub(crate) motions: &'a [AffineMotion],
    pub(crate) coherence: Coherence,
}

/// A tile and the labels that compete in it.
struct Tile {
    area: Area,
    labels: Vec<u8>,
}

/// Tiles that touch, and a rectangle around them. Its pixels that are in none of them keep their labels.
struct Region {
    area: Area,
    tiles: Vec<Tile>,
}

/// The labels of the working size.
pub(crate) fn sharpened(coarse: &Coarse<'_>, fine: &Fine<'_>, solver: Solver) -> Vec<u8> {
    let (width, height) = (fine.level.width(), fine.level.height());
    let mut labels: Vec<u8> = (0..width * height).map(|p| coarse.labels[coarse.pixel(p % width, p / width)]).collect();
    let comparisons = Comparisons::new(fine);
    for region in regions(coarse.contested(width, height)) {
        region.solve(coarse, fine, &comparisons, solver, &mut labels);
    }
    labels
}

/// Tiles gathered into rectangles that do not touch.
fn regions(tiles: Vec<Tile>) -> Vec<Region> {
    let mut regions: Vec<Region> = Vec::new();
    for tile in tiles {
        let mut grown = Region { area: tile.area.clone(), tiles: vec![tile] };
        while let Some(k) = regions.iter().position(|region| region.area.touches(&grown.area)) {
            let other = regions.swap_remove(k);
            grown.area = grown.area.with(&other.area);
            grown.tiles.extend(other.tiles);
        }
        regions.push(grown);
    }
    regions
}

impl Region {
    fn solve(
        &self,
        coarse: &Coarse<'_>,
        fine: &Fine<'_>,
        comparisons: &Comparisons<'_>,
        solver: Solver,
        labels: &mut [u8],
    ) {
        let (width, height) = (fine.level.width(), fine.level.height());
        // What surrounds the tiles holds them with the labels that it keeps.
        let area = self.area.grown(1, width, height);
        let rows = || area.rows.clone().map(|y| y * width + area.columns.start..y * width + area.columns.end);
        let start: Vec<u8> = rows().flat_map(|row| labels[row].iter().copied()).collect();
        let mut present = [false; 256];
        let competing = self.tiles.iter().flat_map(|tile| &tile.labels);
        start.iter().chain(competing).for_each(|&l| present[usize::from(l)] = true);
        let present: Vec<u8> = (0..=u8::MAX).filter(|&l| present[usize::from(l)]).collect();
        let mut number = [0u8; 256];
        present.iter().zip(0..).for_each(|(&l, k)| number[usize::from(l)] = k);
        let fixed = |&label: &u8| {
            let cost = start.iter().map(|&l| if l == label { 0.0 } else { FAR });
            Plane::from_vec(area.width(), area.height(), cost.collect())
        };
        let mut costs: Vec<Plane> = present.iter().map(fixed).collect();
        let mut borders = Borders::uniform(area.width(), area.height(), fine.coherence);
        let corner = [area.columns.start, area.rows.start];
        for tile in &self.tiles {
            comparisons.fill(coarse, fine, tile, corner, &number, &mut costs);
            if let Some(picture) = fine.picture {
                borders.follow(picture, fine.level.noise, fine.coherence, &tile.area, corner);
            }
        }
        let numbered: Vec<u8> = start.iter().map(|&l| number[usize::from(l)]).collect();
        let solved = borders.solve_from(&costs, solver, &numbered);
        for (row, solved) in rows().zip(solved.chunks_exact(area.width())) {
            labels[row].iter_mut().zip(solved).for_each(|(label, &k)| *label = present[usize::from(k)]);
        }
    }
}

impl Coarse<'_> {
    /// The coarse pixel of a working pixel.
    #[inline(always)]
    fn pixel(&self, x: usize, y: usize) -> usize {
        (y / self.step) * self.width + x / self.step
    }

    /// The tiles near which there is more than one label.
    fn contested(&self, width: usize, height: usize) -> Vec<Tile> {
        let rows = self.labels.len() / self.width;
        let near = |from: usize, to: usize, size: usize| {
            (from / self.step).saturating_sub(MARGIN)..((to - 1) / self.step + MARGIN + 1).min(size)
        };
        let mut tiles = Vec::new();
        for top in (0..height).step_by(TILE[1]) {
            for left in (0..width).step_by(TILE[0]) {
                let (right, bottom) = ((left + TILE[0]).min(width), (top + TILE[1]).min(height));
                let mut present = [false; 256];
                for y in near(top, bottom, rows) {
                    let row = &self.labels[y * self.width..][near(left, right, self.width)];
                    row.iter().for_each(|&l| present[usize::from(l)] = true);
                }
                let labels: Vec<u8> = (0..=u8::MAX).filter(|&l| present[usize::from(l)]).collect();
                if labels.len() > 1 {
                    tiles.push(Tile { area: Area { columns: left..right, rows: top..bottom }, labels });
                }
            }
        }
        tiles
    }
}

/// The frames compared along every motion.
struct Comparisons<'a> {
    second: Vec<Option<Comparison<'a>>>,
    before: Vec<Option<Comparison<'a>>>,
}

impl<'a> Comparisons<'a> {
    fn new(fine: &Fine<'a>) -> Comparisons<'a> {
        let all = |view| {
            let one = |motion| Comparison::new(fine.level, view, motion, CostModel::LABELS);
            fine.motions.iter().map(one).collect()
        };
        Comparisons { second: all(View::Second), before: all(View::Before) }
    }

    /// The costs of the labels that compete in a tile, on planes that begin at `corner`; `number` says which is whose.
    fn fill(
        &self,
        coarse: &Coarse<'_>,
        fine: &Fine<'_>,
        tile: &Tile,
        corner: [usize; 2],
        number: &[u8; 256],
        costs: &mut [Plane],
    ) {
        let (width, height) = (fine.level.width(), fine.level.height());
        let Area { columns, rows: tile_rows } = &tile.area;
        let (mut earlier, mut seen) = ([0.0; TILE[0]], [0.0; TILE[0]]);
        let mut rows = vec![[0.0; TILE[0]]; tile.labels.len()];
        for y in tile_rows.clone() {
            seen.fill(f32::INFINITY);
            for (row, &label) in rows.iter_mut().zip(&tile.labels) {
                let label = usize::from(label);
                let row = &mut row[..columns.len()];
                match &self.second[label] {
                    Some(second) => second.row(y, columns.start, row),
                    None => row.fill(f32::INFINITY),
                }
                if let (Some(before), Some(shares)) = (&self.before[label], coarse.shares) {
                    before.row(y, columns.start, &mut earlier[..row.len()]);
                    for ((c, b), x) in row.iter_mut().zip(&earlier).zip(columns.clone()) {
                        *c = mixed(*c, *b, shares.values()[coarse.pixel(x, y)]);
                    }
                }
                for ((c, seen), x) in row.iter_mut().zip(&mut seen).zip(columns.clone()) {
                    *c = allowed_for(*c, coarse.misfit.values()[coarse.pixel(x, y)]);
                    *seen = seen.min(*c);
                }
            }
            let at_border = border_price(fine.coherence);
            for (row, &label) in rows.iter().zip(&tile.labels) {
                let label = usize::from(label);
                let most = most_where_hidden(label, fine.coherence.departure);
                let out = &mut costs[usize::from(number[label])].row_mut(y - corner[1])[columns.start - corner[0]..];
                for (((out, c), seen), x) in out.iter_mut().zip(row).zip(&seen).zip(columns.clone()) {
                    let p = coarse.pixel(x, y);
                    let mut cost = as_label(label, *c, *seen, fine.coherence);
                    let borders = u8::from(x == 0 || x + 1 == width) + u8::from(y == 0 || y + 1 == height);
                    if label > 0 {
                        cost += f32::from(borders) * at_border;
                    }
                    if coarse.barred.get(label).is_some_and(|barred| barred[p]) {
                        cost += CostModel::ESTIMATION.truncation;
                    }
                    if coarse.hidden.get(label).is_some_and(|hidden| hidden[p]) {
                        cost = cost.min(most);
                    }
                    if let Some(colours) = coarse.colours {
                        cost += colours.of(fine.palette, y * width + x, label);
                    }
                    *out = cost;
                }
            }
        }
    }
}
