//! An object from a click or a box: its mask in one frame at once.
//!
//! As in GrabCut (Rother, Kolmogorov, Blake, SIGGRAPH 2004), what the object and the ground around it look like is learned from a mask, a
//! cut makes the next mask of that, and so on. Besides colours, the labels found automatically and the motions to the neighbouring frames
//! count: what lies mostly inside speaks for the object.
//!
//! * A box begins with the ellipse in it; outside there is no object.
//! * How far the object of a click reaches is open. Discs of several sizes begin, and the regions with one label or motion that the click
//!   is in; the masks that come of them vote, each by how well it agrees with the others. What enough votes say begins the last fit.
//!
//! What is said of the clip makes no difference to the mask: the same click always points to the same object. What is then said of the frame
//! is more than the mask: it is ground where nothing else is, which is worth .12 of J through a clip. Others keep what they have.

use crate::clip::model;
use std::ops::Range;

use super::evidence::Evidence;
use super::look::Look;
use super::memory::{Memory, Part};
use super::sweep::{CERTAIN, cut, logit};
use crate::clip::evidence::Flow;
use crate::clip::whole::{NOTHING_SAID, SegmentedClip};
use crate::components::{Connectivity, components};
use crate::error::{Error, Result};
use crate::frame::Frame;
use crate::frame::area::Area;
use crate::frame::filter::gaussian;
use crate::labelling::resolution::upsampling::upsample;
use crate::model::Model;

/// Where an object is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prompt {
    /// A pixel of it: column and row.
    Click([usize; 2]),
    /// A rectangle that has all of it: first column, first row, width and height.
    Box([usize; 4]),
}

/// What is seen of a frame.
struct View<'a> {
    look: &'a Look,
    /// Labels found automatically, and those of the motions to the next frame and the one before.
    found: Vec<Vec<u8>>,
}

/// What a fit begins with.
struct Beginning {
    /// Where the object may be.
    area: Area,
    /// Odds of the object at every pixel, nats.
    odds: Vec<f32>,
    /// 0 for the object, 1 for ground, 2 for what is open.
    sides: Vec<u8>,
}

/// What is said of a frame when the object of a number is where a prompt points to.
pub(in crate::clip) fn outline(
    clip: &SegmentedClip,
    index: usize,
    frame: &Frame,
    prompt: Prompt,
    number: u8,
) -> Result<Vec<u8>> {
    clip.check(index, frame)?;
    check(prompt, clip.size())?;
    if number == 0 || number == NOTHING_SAID {
        let reason = format!("{number} is no number of an object: these are 1 to 254");
        return Err(Error::InvalidOption { name: "label", reason });
    }
    let (look, width) = (Look::new(frame), frame.width());
    let flow = |kept: Option<Flow>| kept.filter(|of| of.measured).map(|of| of.enlarged(look.size).labels);
    let labels = clip.found_at(index, look.size);
    let found = [Some(labels), flow(clip.onward(index)), flow(clip.back(index))].into_iter().flatten().collect();
    let view = View { look: &look, found };
    let full = |mask: &[u8]| upsample(mask, look.size, 2, frame.luminance(), &Model::DEFAULT);
    let mask = match prompt {
        Prompt::Click([x, y]) => {
            let mut mask = full(&view.clicked(look.pixel(y * width + x, width)));
            mask[y * width + x] = 1;
            mask
        }
        Prompt::Box([x, y, columns, rows]) => {
            let area = Area { columns: x..x + columns, rows: y..y + rows };
            let found = full(&view.boxed(&area));
            let is_empty = !area.pixels(width).any(|p| found[p] > 0);
            let mut mask = vec![0; found.len()];
            // One that is too small to see anything in is all object.
            area.pixels(width).for_each(|p| mask[p] = if is_empty { 1 } else { found[p] });
            mask
        }
    };
    Ok(said_of(clip, index, &clip.layered(index, frame.luminance()), &mask, number))
}

/// An object with its mask, and ground where nothing else is shown and was said.
fn said_of(clip: &SegmentedClip, index: usize, shown: &[u8], mask: &[u8], number: u8) -> Vec<u8> {
    let persons = clip.persons_in(index);
    let ([width, _], [w, h]) = (clip.size(), clip.working_size());
    let (step, (found, _)) = (clip.working_step(), clip.found(index));
    let before = clip.frames[index].said.as_ref().map(|said| said.labels.values());
    let mut sizes = [[0usize; 2]; 256];
    for (&label, &inside) in shown.iter().zip(mask) {
        let [all, taken] = &mut sizes[usize::from(label)];
        *all += 1;
        *taken += usize::from(inside);
    }
    // Ground in a part of what was found is a correction of that, so none is said in any pixel of it.
    let found = |p: usize| found[(p / width / step).min(h - 1) * w + (p % width / step).min(w - 1)];
    let others = |label: u8| label != 0 && label != NOTHING_SAID && label != number;
    // What was found yields to an object that has most of it.
    let is_left = |label: u8| 2 * sizes[usize::from(label)][1] <= sizes[usize::from(label)][0];
    let said = |p: usize| match before.as_ref().map_or(NOTHING_SAID, |before| before[p]) {
        label if others(label) => label,
        _ if others(shown[p]) && persons[usize::from(shown[p])] => NOTHING_SAID,
        _ if mask[p] > 0 => number,
        0 => 0,
        _ if [shown[p], found(p)].into_iter().any(|label| others(label) && is_left(label)) => NOTHING_SAID,
        _ => 0,
    };
    (0..mask.len()).map(said).collect()
}

fn check(prompt: Prompt, [width, height]: [usize; 2]) -> Result<()> {
    let fits = |from: usize, count: usize, side: usize| count > 0 && from < side && count <= side - from;
    let (name, [x, y, columns, rows]) = match prompt {
        Prompt::Click([x, y]) => ("click", [x, y, 1, 1]),
        Prompt::Box(sides) => ("box", sides),
    };
    if fits(x, columns, width) && fits(y, rows, height) {
        return Ok(());
    }
    let what = format!("{columns}×{rows} pixels from ({x}, {y}) on are not within a frame of {width}×{height} pixels");
    Err(Error::InvalidOption { name, reason: what })
}

impl View<'_> {
    fn boxed(&self, full: &Area) -> Vec<u8> {
        let ([width, height], step) = (self.look.size, self.look.step);
        let part = |side: &Range<usize>, size: usize| side.start / step..side.end.div_ceil(step).min(size);
        let area = Area { columns: part(&full.columns, width), rows: part(&full.rows, height) };
        let middle = |side: &Range<usize>| 0.5 * (side.start + side.end - 1) as f32;
        let centre = [middle(&area.columns), middle(&area.rows)];
        let radii = [area.width(), area.height()].map(|side| 0.5 * side as f32);
        self.fitted(self.ellipse(area, centre, radii, [0.5, f32::INFINITY]), &|_| false)
    }

    fn clicked(&self, click: usize) -> Vec<u8> {
        let (pixels, [width, height]) = (self.look.pixels(), self.look.size);
        let centre = self.place(click);
        let near = |p: usize| self.square(p, centre, [model().near; 2]) < 1.0;
        let whole = 1.0 - model().part;
        let disc = |radius: f32| {
            let area = self.around(&Area::of(&[click], width).grown(radius as usize, width, height));
            self.ellipse(area, centre, [radius; 2], [whole, 1.0 / whole])
        };
        // From the side of a cell on, each twice as large, to a third of the frame.
        let longest = width.max(height) as f32;
        let radii =
            std::iter::successors(Some(model().cell * longest), |radius| Some(std::f32::consts::SQRT_2 * radius));
        // A third of the longer side.
        let discs = radii.take_while(|radius| 3.0 * *radius < longest).map(disc);
        let regions = self.found.iter().filter_map(|labels| self.region(labels, click));
        let beginnings = discs.chain(regions);
        let masks: Vec<Vec<u8>> = beginnings.map(|from| self.part_of(click, self.fitted(from, &near))).collect();
        let mut votes = vec![0.0f32; pixels];
        let mut total = 0.0;
        for mask in &masks {
            let others = masks.iter().map(|other| overlap(mask, other)).sum::<f32>() - 1.0;
            votes.iter_mut().zip(mask).for_each(|(votes, &inside)| *votes += others * others * f32::from(inside));
            total += others * others;
        }
        votes.iter_mut().for_each(|votes| *votes /= total.max(f32::MIN_POSITIVE));
        let agreed: Vec<usize> = (0..pixels).filter(|&p| votes[p] > model().part || near(p)).collect();
        let mut sides = vec![1; pixels];
        agreed.iter().for_each(|&p| sides[p] = 0);
        let odds = votes.iter().map(|votes| 2.0 * model().guess * (votes - model().part)).collect();
        let area = self.around(&Area::of(&agreed, self.look.size[0]));
        self.part_of(click, self.fitted(Beginning { area, odds, sides }, &near))
    }

    /// An ellipse within an area, the object up to a share of its radii, and ground from another share `ground` on. The odds fall from its
    /// middle with the squared distance, to none at `even`.
    fn ellipse(&self, area: Area, centre: [f32; 2], radii: [f32; 2], [even, ground]: [f32; 2]) -> Beginning {
        let object = 1.0 - model().part;
        let squares: Vec<f32> = (0..self.look.pixels()).map(|p| self.square(p, centre, radii)).collect();
        let mut sides = vec![1; squares.len()];
        for p in area.pixels(self.look.size[0]).filter(|&p| squares[p] < ground * ground) {
            sides[p] = if squares[p] < object * object { 0 } else { 2 };
        }
        Beginning { area, sides, odds: squares.iter().map(|square| model().guess * (even - square)).collect() }
    }

    /// The connected pixels that have the click's label, unless most of the frame has it.
    fn region(&self, labels: &[u8], click: usize) -> Option<Beginning> {
        let width = self.look.size[0];
        let parts = components(labels, width, Connectivity::Eight);
        let part = parts.list[parts.of[click] as usize];
        let alike = labels.iter().filter(|label| **label == labels[click]).count();
        if part.size < model().pixels || 2 * alike > labels.len() {
            return None;
        }
        let inside = |p: usize| parts.of[p] == parts.of[click];
        let [left, top, right, bottom] = part.bounds;
        Some(Beginning {
            area: self.around(&Area { columns: left..right + 1, rows: top..bottom + 1 }),
            sides: (0..labels.len()).map(|p| u8::from(!inside(p))).collect(),
            odds: gaussian(&self.look.plane(&inside), model().near)
                .values()
                .iter()
                .map(|share| model().guess * (2.0 * share - 1.0))
                .collect(),
        })
    }

    /// Learns from a mask what the object looks like, cuts the next one, and so on.
    fn fitted(&self, from: Beginning, is_sure: &dyn Fn(usize) -> bool) -> Vec<u8> {
        let (look, [width, height]) = (self.look, self.look.size);
        let Beginning { area, odds: prior, mut sides } = from;
        let seen = area.grown(model().margin, width, height);
        for _ in 0..model().rounds {
            let count = |side: u8| seen.pixels(width).filter(|&p| sides[p] == side).count() as f32;
            // Ground counts less where there is more of it.
            let weight = (count(0) / count(1).max(1.0)).sqrt();
            let mut memory = Memory::new(&Area::whole(0, 0), f32::INFINITY);
            for (side, weight) in [(0, 1.0), (1, weight)] {
                let of = |p: usize| if sides[p] == side { usize::from(side) } else { 2 };
                memory.learn_within(look, &seen, [0.0; 2], Part::Recent, weight, &of);
            }
            let remembered = memory.read(look, &area, [0.0; 2]);
            let evidence: Vec<Evidence> =
                self.found.iter().map(|found| Evidence::of(found, &sides, &seen, width)).collect();
            let odds = |(p, remembered): (usize, f32)| {
                let found: f32 = self.found.iter().zip(&evidence).map(|(found, of)| of.ratio(found[p])).sum();
                if is_sure(p) { CERTAIN } else { prior[p] + logit(remembered) + found }
            };
            let odds: Vec<f32> = area.pixels(width).zip(remembered).map(odds).collect();
            let mask = cut(look, &area, &odds);
            if !mask.contains(&1) {
                break;
            }
            sides.fill(1);
            area.pixels(width).zip(mask).for_each(|(p, inside)| sides[p] = 1 - inside);
        }
        sides.iter().map(|&side| u8::from(side == 0)).collect()
    }

    /// The connected part of a mask that the click is in.
    fn part_of(&self, click: usize, mut mask: Vec<u8>) -> Vec<u8> {
        let parts = components(&mask, self.look.size[0], Connectivity::Four);
        mask.iter_mut().enumerate().for_each(|(p, inside)| *inside &= u8::from(parts.of[p] == parts.of[click]));
        mask
    }

    /// Where an object may reach that lies in an area.
    fn around(&self, area: &Area) -> Area {
        area.grown(model().margin, self.look.size[0], self.look.size[1])
    }

    fn place(&self, p: usize) -> [f32; 2] {
        [p % self.look.size[0], p / self.look.size[0]].map(|at| at as f32)
    }

    /// Squared distance of a pixel from a centre, in units of the radii.
    fn square(&self, p: usize, centre: [f32; 2], radii: [f32; 2]) -> f32 {
        let place = self.place(p);
        [0, 1].map(|k| (place[k] - centre[k]) / radii[k]).map(|x| x * x).iter().sum()
    }
}

/// Intersection over union.
fn overlap(one: &[u8], other: &[u8]) -> f32 {
    let (mut both, mut either) = (0usize, 0usize);
    for (one, other) in one.iter().zip(other) {
        both += usize::from(one & other);
        either += usize::from(one | other);
    }
    both as f32 / either.max(1) as f32
}
