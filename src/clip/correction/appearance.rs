//! Appearance of an object and of the ground around it: a histogram over colour and position relative to the object's centre.
//!
//! Each cell of position and colour counts pixels of the object and of the ground. Counts of annotated frames stay, counts of the frames
//! passed since then decay. Cells with few pixels back off to wider cells, and these to the colour's share over all positions.

use super::features::{CHROMA, COLOURS, FrameFeatures, LIGHTNESS};
use crate::clip::annotation::Seed;
use crate::clip::options::model;
use crate::frame::Plane;
use crate::frame::area::Area;
use crate::side::Side;

/// Weighted numbers of pixels, by [`Side`].
type Counts = [f32; 2];

/// Where counted pixels come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// Seeds of annotations.
    Annotated,
    /// Frames that the propagation has passed.
    Recent,
    /// Frames in which the object was found automatically.
    Found,
}

#[derive(Clone, Debug)]
/// The histogram: a grid of cells for each colour seen.
pub(super) struct AppearanceModel {
    /// Columns and rows of cells.
    size: [usize; 2],
    /// Side of a cell, pixels.
    cell: f32,
    /// For each colour, one more than its index in `seen`; 0 if it was not seen.
    places: Vec<u16>,
    /// The colours seen, in the order of their first occurrence.
    seen: Vec<u16>,
    /// Cells of all colours seen, counted in annotations and in recent frames.
    annotated: Vec<Counts>,
    recent: Vec<Counts>,
    /// Cells counted in frames in which the object was found automatically; and for each colour, how often it was found and how often
    /// annotated. Where annotations disagree with what was found, that counts less.
    found: Vec<Counts>,
    found_of: Vec<Counts>,
    annotated_of: Vec<Counts>,
}

impl AppearanceModel {
    /// An empty model for an object as large as a mask.
    pub(super) fn of(mask: &Plane) -> AppearanceModel {
        let (width, height) = (mask.width(), mask.height());
        let pixels: Vec<usize> = (0..width * height).filter(|&p| mask.values()[p] > 0.0).collect();
        let around = if pixels.is_empty() { Area::whole(width, height) } else { Area::of(&pixels, width) };
        AppearanceModel::new(&around, model().cell * width.max(height) as f32)
    }

    /// An empty model for an object within an area, with cells of the given side in pixels.
    pub(super) fn new(area: &Area, cell: f32) -> AppearanceModel {
        let cells = |side: usize| (side as f32 / cell) as usize + 2 + 2 * model().cells_around;
        let size = [cells(area.width()), cells(area.height())];
        AppearanceModel {
            size,
            cell,
            places: vec![0; COLOURS],
            seen: Vec::new(),
            annotated: Vec::new(),
            recent: Vec::new(),
            found: Vec::new(),
            found_of: Vec::new(),
            annotated_of: Vec::new(),
        }
    }

    fn cells(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// Position of the pixel (x, y) in cells, for an object with the given centre.
    fn at(&self, x: usize, y: usize, centre: [f32; 2]) -> [f32; 2] {
        let place = |at: usize, centre: f32, size: usize| {
            // Below the last cell, because the next one is read as well.
            ((at as f32 - centre) / self.cell + 0.5 * (size - 1) as f32).max(0.0).min(size as f32 - 1.001)
        };
        [place(x, centre[0], self.size[0]), place(y, centre[1], self.size[1])]
    }

    /// Multiplies the recent counts by `left`, 0…1.
    pub(super) fn fade(&mut self, left: f32) {
        self.recent.iter_mut().flatten().for_each(|count| *count *= left);
    }

    /// Forgets recent counts.
    pub(super) fn forget_recent(&mut self) {
        self.recent.fill([0.0; 2]);
    }

    /// Adds the pixels of a frame with a weight. `sides` gives the side of a pixel, `None` if it is not counted.
    pub(super) fn learn(
        &mut self,
        features: &FrameFeatures,
        centre: [f32; 2],
        source: Source,
        weight: f32,
        sides: &dyn Fn(usize) -> Option<Side>,
    ) {
        self.learn_within(features, &features.area(), centre, source, weight, sides);
    }

    /// [`learn`](Self::learn) from an area. Not generic, so that it is compiled only once.
    pub(super) fn learn_within(
        &mut self,
        features: &FrameFeatures,
        area: &Area,
        centre: [f32; 2],
        source: Source,
        weight: f32,
        sides: &dyn Fn(usize) -> Option<Side>,
    ) {
        let width = features.size[0];
        for y in area.rows.clone() {
            for x in area.columns.clone() {
                let Some(side) = sides(y * width + x) else { continue };
                let place = self.place_of(features.colours[y * width + x]);
                let [u, v] = self.at(x, y, centre);
                let cell = place * self.cells() + (v + 0.5) as usize * self.size[0] + (u + 0.5) as usize;
                match source {
                    Source::Annotated => {
                        self.annotated_of[place][side] += weight;
                        self.annotated[cell][side] += weight;
                    }
                    Source::Recent => self.recent[cell][side] += weight,
                    Source::Found => {
                        self.found_of[place][side] += weight;
                        self.found[cell][side] += weight;
                    }
                }
            }
        }
    }

    /// Learns from the seeds of a frame.
    pub(super) fn learn_seeds(&mut self, features: &FrameFeatures, centre: [f32; 2], seeds: Option<&[Seed]>) {
        let Some(seeds) = seeds else { return };
        self.learn(features, centre, Source::Annotated, 1.0, &|p| match seeds[p] {
            Seed::Object => Some(Side::Object),
            Seed::Other => Some(Side::Ground),
            Seed::Nothing | Seed::Dropped => None,
        });
    }

    fn place_of(&mut self, colour: u16) -> usize {
        let place = &mut self.places[usize::from(colour)];
        if *place == 0 {
            self.seen.push(colour);
            *place = self.seen.len() as u16;
            let cells = self.seen.len() * self.size[0] * self.size[1];
            self.annotated.resize(cells, [0.0; 2]);
            self.recent.resize(cells, [0.0; 2]);
            self.found.resize(cells, [0.0; 2]);
            self.found_of.push([0.0; 2]);
            self.annotated_of.push([0.0; 2]);
        }
        usize::from(*place) - 1
    }

    /// Probability of the object at every pixel of an area, 0…1, for an object with the given centre.
    pub(super) fn read(&self, features: &FrameFeatures, area: &Area, centre: [f32; 2]) -> Vec<f32> {
        let (cells, width) = (self.cells(), features.size[0]);
        let mut blurred: Vec<Counts> = self
            .annotated
            .iter()
            .zip(&self.recent)
            .map(|(annotated, recent)| Side::BOTH.map(|side| annotated[side] + recent[side]))
            .collect();
        for (place, &colour) in self.seen.iter().enumerate() {
            let trust = self.trust(colour);
            let cells = place * cells..(place + 1) * cells;
            for (sum, found) in blurred[cells.clone()].iter_mut().zip(&self.found[cells]) {
                *sum = Side::BOTH.map(|side| sum[side] + trust[side] * found[side]);
            }
        }
        let mut total = [0.0f32; 2];
        for counts in &blurred {
            total = Side::BOTH.map(|side| total[side] + counts[side]);
        }
        let mut line = vec![[0.0; 2]; self.size[0].max(self.size[1])];
        blurred.chunks_exact_mut(cells).for_each(|plane| self.blur(plane, &mut line));
        // One grid of cells for each colour of the area, computed when the colour first occurs.
        let mut known = vec![0u16; COLOURS];
        let mut planes: Vec<Counts> = Vec::new();
        let mut wide: Vec<Counts> = Vec::new();
        let mut shares: Vec<f32> = Vec::new();
        let mut probabilities = Vec::with_capacity(area.width() * area.height());
        for y in area.rows.clone() {
            for x in area.columns.clone() {
                let colour = features.colours[y * width + x];
                if known[usize::from(colour)] == 0 {
                    let from = planes.len();
                    planes.resize(from + cells, [0.0; 2]);
                    self.gather(colour, &blurred, &mut planes[from..]);
                    wide.extend_from_slice(&planes[from..]);
                    (0..2).for_each(|_| self.blur(&mut wide[from..], &mut line));
                    let mut sum = [0.0f32; 2];
                    planes[from..].iter().for_each(|counts| sum = Side::BOTH.map(|side| sum[side] + counts[side]));
                    let of = Side::BOTH.map(|side| sum[side] / total[side].max(1e-6) + 1e-5);
                    shares.push(of[Side::Object] / (of[Side::Object] + of[Side::Ground]));
                    known[usize::from(colour)] = shares.len() as u16;
                }
                let k = usize::from(known[usize::from(colour)]) - 1;
                let [u, v] = self.at(x, y, centre);
                let (column, row) = (u as usize, v as usize);
                let (fx, fy) = (u - column as f32, v - row as f32);
                let first = k * cells + row * self.size[0] + column;
                let sample = |counts: &[Counts]| {
                    let window = &counts[first..first + self.size[0] + 2];
                    let [a, b, c, d] = [window[0], window[1], window[self.size[0]], window[self.size[0] + 1]];
                    Side::BOTH.map(|s| {
                        let (top, bottom) = (a[s] + fx * (b[s] - a[s]), c[s] + fx * (d[s] - c[s]));
                        top + fy * (bottom - top)
                    })
                };
                let (near, wider) = (sample(&planes), sample(&wide));
                let back_off = model().back_off;
                let of_wider = (wider[Side::Object] + model().places * back_off * shares[k])
                    / (wider[Side::Object] + wider[Side::Ground] + model().places * back_off);
                let all = near[Side::Object] + near[Side::Ground] + back_off;
                probabilities.push((near[Side::Object] + back_off * of_wider) / all);
            }
        }
        probabilities
    }

    /// How far the labels found automatically are trusted for a colour, 0…1: that a pixel labelled as the object is the object, and that
    /// one labelled as ground is ground.
    pub(super) fn trust(&self, colour: u16) -> Counts {
        let [mut annotated, mut found] = [[[0.0; 2]]; 2];
        self.gather(colour, &self.annotated_of, &mut annotated);
        self.gather(colour, &self.found_of, &mut found);
        let ([annotated], [found]) = (annotated, found);
        let all = annotated[Side::Object] + annotated[Side::Ground];
        Side::BOTH.map(|side| {
            let weight = (model().outweighed * all / found[side].max(1e-6)).min(1.0);
            1.0 - weight * annotated[side.other()] / (all + 1.0)
        })
    }

    /// [`trust`](Self::trust) of the colour of every pixel.
    pub(super) fn trusts(&self, features: &FrameFeatures) -> Vec<Counts> {
        let mut known: Vec<Option<Counts>> = vec![None; COLOURS];
        let mut of = |colour: &u16| *known[usize::from(*colour)].get_or_insert_with(|| self.trust(*colour));
        features.colours.iter().map(&mut of).collect()
    }

    /// Adds the counts of a colour and of its neighbours in colour space, weighted.
    fn gather(&self, colour: u16, counts: &[Counts], plane: &mut [Counts]) {
        let colour = usize::from(colour);
        let [l, a, b] = [colour / (CHROMA * CHROMA), colour / CHROMA % CHROMA, colour % CHROMA];
        let near = |at: usize, size: usize| at.saturating_sub(1)..(at + 2).min(size);
        // [1 2 1]/4 in each direction.
        let weight = |at: usize, other: usize| if at == other { 0.5 } else { 0.25f32 };
        for i in near(l, LIGHTNESS) {
            for j in near(a, CHROMA) {
                for k in near(b, CHROMA) {
                    let place = usize::from(self.places[(i * CHROMA + j) * CHROMA + k]);
                    if place > 0 {
                        let weight = weight(l, i) * weight(a, j) * weight(b, k);
                        let other = &counts[(place - 1) * plane.len()..place * plane.len()];
                        for (sum, count) in plane.iter_mut().flatten().zip(other.iter().flatten()) {
                            *sum += weight * count;
                        }
                    }
                }
            }
        }
    }

    /// [1 2 1]/4 along rows and columns.
    fn blur(&self, plane: &mut [Counts], line: &mut [Counts]) {
        let [columns, rows] = self.size;
        let mut along = |first: usize, step: usize, count: usize| {
            (0..count).for_each(|k| line[k] = plane[first + k * step]);
            for k in 0..count {
                let (before, after) = (line[k.saturating_sub(1)], line[(k + 1).min(count - 1)]);
                // [1 2 1]/4.
                plane[first + k * step] = Side::BOTH.map(|s| 0.25 * before[s] + 0.5 * line[k][s] + 0.25 * after[s]);
            }
        };
        (0..rows).for_each(|row| along(row * columns, 1, columns));
        (0..columns).for_each(|column| along(column, columns, rows));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [usize; 2] = [96, 96];
    const CENTRE: [f32; 2] = [32.0, 48.0];
    const RED: [u8; 3] = [200, 60, 50];
    const BLUE: [u8; 3] = [40, 60, 200];
    const GREY: [u8; 3] = [120, 120, 120];

    fn is_object(x: usize, y: usize) -> bool {
        (20..44).contains(&x) && (36..60).contains(&y)
    }

    fn is_beside(x: usize, y: usize) -> bool {
        (64..88).contains(&x) && (36..60).contains(&y)
    }

    /// The object, and a patch of a colour beside it.
    fn features(beside: [u8; 3]) -> FrameFeatures {
        let colour = |x, y| if is_object(x, y) { RED } else { beside };
        FrameFeatures::painted(SIZE, |x, y| if is_object(x, y) || is_beside(x, y) { colour(x, y) } else { GREY })
    }

    fn appearance_of(features: &FrameFeatures, source: Source) -> AppearanceModel {
        let side = |p: usize| Some(Side::object_if(is_object(p % SIZE[0], p / SIZE[0])));
        let mut appearance = AppearanceModel::of(&features.plane(&|p| side(p) == Some(Side::Object)));
        appearance.learn(features, CENTRE, source, 1.0, &side);
        appearance
    }

    fn at(appearance: &AppearanceModel, features: &FrameFeatures, [x, y]: [usize; 2], centre: [f32; 2]) -> f32 {
        appearance.read(features, &features.area(), centre)[y * SIZE[0] + x]
    }

    #[test]
    fn a_colour_is_remembered_at_its_place() {
        let features = features(RED);
        for source in [Source::Annotated, Source::Recent, Source::Found] {
            let appearance = appearance_of(&features, source);
            assert!(at(&appearance, &features, [32, 48], CENTRE) > 0.9, "{source:?}");
            assert!(at(&appearance, &features, [76, 48], CENTRE) < 0.1, "{source:?}: the same colour elsewhere");
            assert!(at(&appearance, &features, [50, 48], CENTRE) < 0.1, "{source:?}: ground beside it");
            // The cells move with the object.
            assert!(at(&appearance, &features, [76, 48], [76.0, 48.0]) > 0.9, "{source:?}");
            assert!(at(&appearance, &features, [32, 48], [-12.0, 48.0]) < 0.1, "{source:?}");
        }
    }

    #[test]
    fn where_a_colour_was_not_seen_all_places_count() {
        let appearance = appearance_of(&features(GREY), Source::Annotated);
        assert!(at(&appearance, &features(RED), [76, 48], CENTRE) > 0.9);
        let unknown = at(&appearance, &features(BLUE), [76, 48], CENTRE);
        assert!((unknown - 0.5).abs() < 0.05, "{unknown}");
    }

    #[test]
    fn annotations_outweigh_what_was_found() {
        let features = features(RED);
        let mut appearance = appearance_of(&features, Source::Found);
        let red = features.colours[48 * SIZE[0] + 32];
        assert_eq!(appearance.trust(red), [1.0, 1.0]);
        assert!(at(&appearance, &features, [32, 48], CENTRE) > 0.9);
        // Half of the object is annotated as ground, so what was found in the other half is not trusted either.
        appearance.learn(&features, CENTRE, Source::Annotated, 1.0, &|p| {
            (is_object(p % SIZE[0], p / SIZE[0]) && p / SIZE[0] < 48).then_some(Side::Ground)
        });
        let trust = appearance.trust(red);
        assert!(trust[Side::Object] < 0.05 && trust[Side::Ground] == 1.0, "{trust:?}");
        let outweighed = at(&appearance, &features, [32, 54], CENTRE);
        assert!(outweighed < 0.5, "{outweighed}");
    }
}
