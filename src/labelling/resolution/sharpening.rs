//! Refinement of coarse labels at the working size: coarse labels decide what is there, fine costs where exactly it ends.
//!
//! Only tiles near a border between labels are solved, each with the labels near it; tiles that touch are solved together. Properties
//! of a neighbourhood rather than of a pixel (variance inflation, occlusion, colour costs) are taken from the coarser level.

use crate::frame::Plane;
use crate::frame::area::Area;
use crate::frame::palette::Palette;
use crate::frame::picture::Picture;
use crate::labelling::BACKGROUND;
use crate::labelling::coherence::Coherence;
use crate::labelling::solver::Solver;
use crate::labelling::terms::colour::ColourPrices;
use crate::labelling::terms::data::{frame_border_price, to_label_costs};
use crate::labelling::terms::smoothness::{Borders, Price};
use crate::labelling::terms::variance_inflation::inflate_variance;
use crate::labelling::terms::visibility::most_where_hidden;
use crate::lanes::lower;
use crate::motion::AffineMotion;
use crate::view::cost::{Comparison, CostModel};
use crate::view::level::Level;

/// Size of a tile, working pixels: as wide as a chunk of a row, low enough to follow a border. For speed.
const TILE: [usize; 2] = [32, 8];
/// How far around a tile labels compete in it, coarse pixels. Not varied.
const MARGIN: usize = 4;
/// Cost of a label that does not compete: more than four neighbours could save.
const FAR: f32 = 1e3;

/// Labels of a coarser level, with the neighbourhood properties they were solved with.
pub(crate) struct CoarseLabelling<'a> {
    pub(crate) width: usize,
    pub(crate) labels: &'a [u8],
    /// Working pixels per pixel.
    pub(crate) step: usize,
    /// Factor of the noise variance.
    pub(crate) variance_inflation: &'a Plane,
    /// For every label, the pixels at which it may be occluded.
    pub(crate) hidden: &'a [Vec<bool>],
    pub(crate) colours: Option<&'a ColourPrices>,
}

/// Inputs at the working size.
pub(crate) struct WorkingLevel<'a> {
    pub(crate) level: &'a Level,
    pub(crate) picture: &'a Picture,
    pub(crate) palette: &'a Palette,
    pub(crate) motions: &'a [AffineMotion],
    pub(crate) coherence: Coherence,
}

/// A tile and the labels that compete in it.
struct Tile {
    area: Area,
    labels: Vec<u8>,
}

/// Tiles that touch, and their bounding rectangle. Pixels of the rectangle outside the tiles keep their labels.
struct Region {
    area: Area,
    tiles: Vec<Tile>,
}

/// The labels of the working size.
pub(crate) fn sharpened(coarse: &CoarseLabelling<'_>, fine: &WorkingLevel<'_>, solver: Solver) -> Vec<u8> {
    let (width, height) = (fine.level.width(), fine.level.height());
    let mut labels: Vec<u8> = (0..width * height).map(|p| coarse.labels[coarse.pixel(p % width, p / width)]).collect();
    let comparisons = Comparisons::new(fine);
    for region in regions(coarse.contested(width, height)) {
        region.solve(coarse, fine, &comparisons, solver, &mut labels);
    }
    labels
}

/// Groups tiles into rectangles that do not touch.
fn regions(tiles: Vec<Tile>) -> Vec<Region> {
    let mut regions: Vec<Region> = Vec::new();
    for tile in tiles {
        let mut grown = Region { area: tile.area.clone(), tiles: vec![tile] };
        while let Some(k) = regions.iter().position(|region| region.area.touches(&grown.area)) {
            let mut other = regions.swap_remove(k);
            grown.area = grown.area.with(&other.area);
            // The shorter list moves.
            if grown.tiles.len() < other.tiles.len() {
                std::mem::swap(&mut grown.tiles, &mut other.tiles);
            }
            grown.tiles.extend(other.tiles);
        }
        regions.push(grown);
    }
    regions
}

impl Region {
    fn solve(
        &self,
        coarse: &CoarseLabelling<'_>,
        fine: &WorkingLevel<'_>,
        comparisons: &Comparisons<'_>,
        solver: Solver,
        labels: &mut [u8],
    ) {
        let (width, height) = (fine.level.width(), fine.level.height());
        // The pixels around the tiles keep their labels and act as boundary conditions.
        let area = self.area.grown(1, width, height);
        let rows = || area.rows.clone().map(|y| y * width + area.columns.start..y * width + area.columns.end);
        let mut start = Vec::with_capacity(area.width() * area.height());
        rows().for_each(|row| start.extend_from_slice(&labels[row]));
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
        let mut borders = Borders::uniform(area.width(), area.height(), fine.coherence.smoothness);
        let price = Price::new(fine.level.noise, fine.coherence.smoothness, fine.level.model);
        let corner = [area.columns.start, area.rows.start];
        for tile in &self.tiles {
            comparisons.fill(coarse, fine, tile, corner, &number, &mut costs);
            // Includes the pixels to the left and above: their weights connect to the tile.
            let mut around = tile.area.clone();
            around.columns.start = around.columns.start.max(corner[0] + 1) - 1;
            around.rows.start = around.rows.start.max(corner[1] + 1) - 1;
            borders.follow(fine.picture, &price, &around, corner);
        }
        let numbered: Vec<u8> = start.iter().map(|&l| number[usize::from(l)]).collect();
        let solved = borders.solve_from(&costs, solver, &numbered);
        for (row, solved) in rows().zip(solved.chunks_exact(area.width())) {
            labels[row].iter_mut().zip(solved).for_each(|(label, &k)| *label = present[usize::from(k)]);
        }
    }
}

impl CoarseLabelling<'_> {
    /// The coarse pixel of a working pixel.
    #[inline(always)]
    fn pixel(&self, x: usize, y: usize) -> usize {
        (y / self.step) * self.width + x / self.step
    }

    /// The tiles with more than one label nearby.
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

/// Comparisons of the frames along every motion.
struct Comparisons<'a>(Vec<Comparison<'a>>);

impl<'a> Comparisons<'a> {
    fn new(fine: &WorkingLevel<'a>) -> Comparisons<'a> {
        let one = |motion| Comparison::new(fine.level, motion, CostModel::labels(fine.level.model));
        Comparisons(fine.motions.iter().map(one).collect())
    }

    /// Writes the costs of the labels that compete in a tile to planes that begin at `corner`; label l has the plane `number[l]`.
    fn fill(
        &self,
        coarse: &CoarseLabelling<'_>,
        fine: &WorkingLevel<'_>,
        tile: &Tile,
        corner: [usize; 2],
        number: &[u8; 256],
        costs: &mut [Plane],
    ) {
        let (width, height) = (fine.level.width(), fine.level.height());
        let Area { columns, rows: tile_rows } = &tile.area;
        let (count, left) = (columns.len(), columns.start);
        let mut rows = vec![[0.0; TILE[0]]; tile.labels.len()];
        let (mut inflation, mut seen) = ([0.0; TILE[0]], [0.0; TILE[0]]);
        let mut places = [0; TILE[0]];
        let border = frame_border_price(fine.coherence);
        for y in tile_rows.clone() {
            places.iter_mut().zip(columns.clone()).for_each(|(place, x)| *place = coarse.pixel(x, y));
            let places = &places[..count];
            inflation
                .iter_mut()
                .zip(places)
                .for_each(|(inflation, &p)| *inflation = coarse.variance_inflation.values()[p]);
            seen.fill(f32::INFINITY);
            for (row, &label) in rows.iter_mut().zip(&tile.labels) {
                let row = &mut row[..count];
                self.0[usize::from(label)].row(y, left, row);
                inflate_variance(row, &inflation, fine.level.model);
                lower(&mut seen, row);
            }
            for (row, &label) in rows.iter_mut().zip(&tile.labels) {
                let label = usize::from(label);
                let row = &mut row[..count];
                to_label_costs(label, row, &seen, fine.coherence, fine.level.model);
                if label != BACKGROUND {
                    let across = if y == 0 || y + 1 == height { border } else { 0.0 };
                    for (c, x) in row.iter_mut().zip(columns.clone()) {
                        *c += across + if x == 0 || x + 1 == width { border } else { 0.0 };
                    }
                }
                if let Some(hidden) = coarse.hidden.get(label) {
                    let most = most_where_hidden(label, fine.coherence.object_bias, fine.level.model);
                    row.iter_mut().zip(places).filter(|(_, p)| hidden[**p]).for_each(|(c, _)| *c = c.min(most));
                }
                if let Some(colours) = coarse.colours {
                    let pixels = row.iter_mut().zip(y * width + left..);
                    pixels.for_each(|(c, p)| *c += colours.of(fine.palette, p, label));
                }
                costs[usize::from(number[label])].row_mut(y - corner[1])[left - corner[0]..][..count]
                    .copy_from_slice(row);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::filter::gaussian;
    use crate::labelling::coherence::tests::COHERENCE;
    use crate::labelling::terms::data::{LabelCosts, compare};
    use crate::labelling::terms::visibility::hidden_under;
    use crate::random::Random;
    use crate::view::level::build;

    const SIZE: [usize; 2] = [192, 128];

    /// Two squares, which move by (2, 0) and (0, -2), with odd corners, on a background at rest.
    fn owner(x: usize, y: usize) -> u8 {
        let within = |x0: usize, y0: usize| (x0..x0 + 37).contains(&x) && (y0..y0 + 33).contains(&y);
        u8::from(within(21, 29)) + 2 * u8::from(within(143, 61))
    }

    fn frames() -> [Plane; 2] {
        let mut random = Random::from_seed(3);
        let mut texture = || {
            let noise = Plane::from_fn(SIZE[0] + 8, SIZE[1] + 8, |_, _| random.uniform(0.0, 255.0) as f32);
            gaussian(&noise, 0.8)
        };
        let textures = [texture(), texture(), texture()];
        let motions = [(0, 0), (2, 0), (0, -2)];
        let second = |x: usize, y: usize| {
            let place = |k: usize| (x.wrapping_add_signed(-motions[k].0), y.wrapping_add_signed(-motions[k].1));
            let k = [1, 2].into_iter().find(|&k| owner(place(k).0, place(k).1) == k as u8).unwrap_or(0);
            (k, place(k))
        };
        [
            Plane::from_fn(SIZE[0], SIZE[1], |x, y| textures[usize::from(owner(x, y))].at(x, y)),
            Plane::from_fn(SIZE[0], SIZE[1], |x, y| {
                let (k, (px, py)) = second(x, y);
                textures[k].at(px, py)
            }),
        ]
    }

    #[test]
    fn labels_of_half_the_size_get_the_borders_of_the_full_size() {
        let [first, second] = frames();
        let levels = build(first.clone(), second, 24);
        let motions = [(0.0, 0.0), (2.0, 0.0), (0.0, -2.0)].map(|(u, v)| AffineMotion::translation(u, v));
        let labels: Vec<u8> =
            (0..SIZE[0] * SIZE[1] / 4).map(|p| owner(p % (SIZE[0] / 2) * 2, p / (SIZE[0] / 2) * 2)).collect();
        let uncorrected = LabelCosts::new(&levels[1], &compare(&levels[1], &motions, Vec::new()), COHERENCE);
        let hidden = hidden_under(&levels[1], &motions, &labels);
        let coarse = CoarseLabelling {
            width: SIZE[0] / 2,
            labels: &labels,
            step: 2,
            variance_inflation: &uncorrected.variance_inflation,
            hidden: &hidden,
            colours: None,
        };
        let picture = Picture { luminance: first.clone(), colours: [0; 3].map(|_| first.clone()) };
        let colours = vec![[128u8; 4]; SIZE[0] * SIZE[1]];
        let frame = crate::frame::Frame::from_rgba(SIZE[0], SIZE[1], colours.as_flattened()).unwrap();
        let palette = Palette::new(&frame, SIZE[0], SIZE[1]);
        let fine = WorkingLevel {
            level: &levels[0],
            picture: &picture,
            palette: &palette,
            motions: &motions,
            coherence: COHERENCE,
        };
        // Each square has a region of its own; what lies between them is not solved.
        let found = regions(coarse.contested(SIZE[0], SIZE[1]));
        assert_eq!(found.len(), 2);
        assert!(!found[0].area.touches(&found[1].area));
        let wrong = |labels: &[u8]| (0..labels.len()).filter(|&p| labels[p] != owner(p % SIZE[0], p / SIZE[0])).count();
        let enlarged: Vec<u8> =
            (0..SIZE[0] * SIZE[1]).map(|p| labels[coarse.pixel(p % SIZE[0], p / SIZE[0])]).collect();
        let sharp = sharpened(&coarse, &fine, Solver::FAST);
        assert!(wrong(&enlarged) > 100, "{} pixels are wrong at the start", wrong(&enlarged));
        assert!(3 * wrong(&sharp) < 2 * wrong(&enlarged), "{} of {}", wrong(&sharp), wrong(&enlarged));
        let apart = |p: usize| {
            found.iter().all(|r| !r.area.columns.contains(&(p % SIZE[0])) || !r.area.rows.contains(&(p / SIZE[0])))
        };
        assert!((0..sharp.len()).filter(|&p| apart(p)).all(|p| sharp[p] == enlarged[p]));
    }

    #[test]
    fn what_touches_is_one_region() {
        let tile = |x: usize, y: usize| Tile { area: Area { columns: x..x + 4, rows: y..y + 4 }, labels: vec![0, 1] };
        // The last tile joins two regions, whose rectangle then holds a third.
        let found = regions(vec![tile(0, 0), tile(20, 0), tile(0, 8), tile(8, 8), tile(40, 40), tile(4, 4)]);
        let sizes: Vec<usize> = found.iter().map(|region| region.tiles.len()).collect();
        assert_eq!(sizes, [1, 1, 4]);
        assert_eq!(found[2].area, Area { columns: 0..12, rows: 0..12 });
    }
}
