//! The mask of an object in one frame, from clicks or a box.
//!
//! As in GrabCut (Rother, Kolmogorov, Blake, SIGGRAPH 2004), the appearance of the object and of the ground around it is learned from a
//! mask, a cut with this appearance makes the next mask, and so on. Besides colours, the labels found automatically and the motions to the
//! neighbouring frames are used: a label that lies mostly inside the mask raises the log-odds of the object.
//!
//! * A box begins with its inscribed ellipse; outside the box there is no object.
//! * The size of a clicked object is unknown. Fits begin with discs of several sizes around the click, and with the regions of one label or
//!   motion that contain it. The resulting masks vote, each weighted by how well it agrees with the others. Pixels with enough votes are
//!   the object.
//!
//! Further clicks refine the mask in their order. Each adds the part around it or removes it, as far as the colours and labels near it
//! suggest, and changes nothing else; a separate piece is removed as a whole. The size of a part is unknown as well; it reaches at most to
//! the nearest pixel that already is as the click demands. Where a click shows that the mask is wrong, another mask of the earlier fits may
//! be right: its difference around the click is a candidate part, too. People click the middle of a wrong region, so parts vote by how near
//! the click is to the deepest of their pixels. Other annotations do not influence the mask: the same prompt always gives the same object,
//! and takes no pixels from other annotated objects.

use std::ops::Range;

use super::appearance::{AppearanceModel, Source};
use super::features::FrameFeatures;
use super::label_ratios::LabelRatios;
use super::proposal::{CERTAIN, cut, logit};
use crate::answer::UNLABELLED;
use crate::clip::annotation::{Click, Prompt};
use crate::clip::options::model;
use crate::clip::pairs::LayeredMotion;
use crate::clip::segmented_clip::SegmentedClip;
use crate::components::{Connectivity, components};
use crate::frame::Frame;
use crate::frame::area::Area;
use crate::frame::filter::gaussian;
use crate::labelling::upsampling::upsample;
use crate::model::Model;
use crate::side::Side;

/// A frame, and what is known for a prompt in it.
struct View<'a> {
    features: &'a FrameFeatures,
    /// Labels found automatically, and the motion labels to the next frame and to the previous one.
    found: Vec<Vec<u8>>,
    /// The side that the clicks so far give to a pixel, if any.
    sure: Vec<Option<Side>>,
    /// The area in which the object may be.
    limit: Area,
    /// The mask after the clicks so far: 1 inside.
    mask: Vec<u8>,
    /// Alternative masks: the results of every beginning so far, with the changes of later clicks.
    others: Vec<Vec<u8>>,
}

/// The initial state of a fit.
struct Beginning {
    /// The area in which the object may be.
    area: Area,
    /// Log-odds of the object at every pixel, nats.
    log_odds: Vec<f32>,
    /// The side of every pixel; `None` where it is open.
    sides: Vec<Option<Side>>,
}

/// The full-size outline of a prompt's object: its number inside, 0 outside, 255 where another annotated object keeps its pixels. `shown`
/// are the labels of the frame.
#[inline(never)]
pub(super) fn outline(
    clip: &SegmentedClip,
    index: usize,
    frame: &Frame,
    features: &FrameFeatures,
    shown: &[u8],
    prompt: &Prompt,
) -> Vec<u8> {
    let width = frame.width();
    let mut labels = vec![UNLABELLED; shown.len()];
    if !prompt.points() {
        return labels;
    }
    let flow = |kept: Option<LayeredMotion>| kept.filter(|of| of.measured).map(|of| of.enlarged(features.size).labels);
    let own = clip.found_at(index, features.size);
    let found = [Some(own), flow(clip.onward(index)), flow(clip.back(index))].into_iter().flatten().collect();
    let step = features.scaling.step;
    let scaled = |side: Range<usize>, size: usize| side.start / step..side.end.div_ceil(step).min(size);
    let limit = prompt.within.map_or(features.area(), |[x, y, columns, rows]| Area {
        columns: scaled(x..x + columns, features.size[0]),
        rows: scaled(y..y + rows, features.size[1]),
    });
    let nothing = vec![0; features.pixels()];
    let mut view =
        View { features, found, sure: vec![None; features.pixels()], limit, mask: nothing, others: Vec::new() };
    let clicks: Vec<(usize, bool)> =
        prompt.clicks.iter().map(|Click { at: [x, y], inside }| (y * width + x, *inside)).collect();
    if prompt.within.is_some() {
        view.mask = view.boxed();
    }
    for (at, inside) in &clicks {
        let click = features.scaling.small_pixel(*at);
        let centre = view.place(click);
        for p in 0..features.pixels() {
            if view.square(p, centre, [model().click; 2]) < 1.0 {
                view.sure[p] = Some(Side::object_if(*inside));
            }
        }
        view.refine(click, *inside);
    }
    let mut mask = upsample(&view.mask, &features.scaling, 2, frame.luminance(), &Model::DEFAULT);
    if let Some([x, y, columns, rows]) = prompt.within {
        let area = Area { columns: x..x + columns, rows: y..y + rows };
        let is_empty = !area.pixels(width).any(|p| mask[p] > 0);
        let mut within = vec![0; mask.len()];
        // A box that is too small to resolve anything is the object as a whole.
        area.pixels(width).for_each(|p| within[p] = if is_empty { 1 } else { mask[p] });
        mask = within;
    }
    clicks.iter().for_each(|&(at, inside)| mask[at] = u8::from(inside));
    let (user_objects, kept) = (clip.user_objects_in(index), clip.protected());
    let is_others = |label: u8| {
        label != prompt.object
            && (user_objects[usize::from(label)]
                || kept[usize::from(label)]
                || clip.frames[index].accepted && label != 0)
    };
    for (p, label) in labels.iter_mut().enumerate().filter(|(p, _)| !is_others(shown[*p])) {
        *label = if mask[p] > 0 { prompt.object } else { 0 };
    }
    labels
}

impl View<'_> {
    /// The mask of the object in the box.
    fn boxed(&self) -> Vec<u8> {
        let area = self.limit.clone();
        let middle = |side: &Range<usize>| 0.5 * (side.start + side.end - 1) as f32;
        let centre = [middle(&area.columns), middle(&area.rows)];
        let radii = [area.width(), area.height()].map(|side| 0.5 * side as f32);
        let seen = self.around(&area, &self.features.area());
        self.fitted(self.ellipse(area, centre, radii, [0.5, f32::INFINITY]), &seen)
    }

    /// Adds to the mask the part around a click inside the object, or removes the part around a click outside it.
    fn refine(&mut self, click: usize, inside: bool) {
        if (self.mask[click] > 0) == inside {
            return;
        }
        if !self.mask.contains(&1) {
            // The first click is in the middle of many parts of the object, too, so its depth is not informative.
            let parts = self.parts(click, inside);
            self.mask = self.elected(&parts, &agreements(&parts), click);
            self.others = parts;
            return;
        }
        let part = self.piece(click).filter(|_| !inside).unwrap_or_else(|| {
            let mut parts = self.parts(click, inside);
            let of_others: Vec<Vec<u8>> = self.others.iter().map(|other| self.change(other, click, inside)).collect();
            let changed = |part: &Vec<u8>| self.mask.iter().zip(part).map(|(mask, is_in)| mask ^ is_in).collect();
            let now: Vec<Vec<u8>> = parts.iter().map(changed).collect();
            self.others.extend(now);
            parts.extend(of_others);
            let central: Vec<f32> = parts.iter().map(|part| centrality(part, click, self.features.size[0])).collect();
            self.elected(&parts, &central, click)
        });
        for mask in std::iter::once(&mut self.mask).chain(&mut self.others) {
            mask.iter_mut().zip(&part).filter(|(_, is_in)| **is_in > 0).for_each(|(mask, _)| *mask = u8::from(inside));
        }
    }

    /// Candidate parts by which a click may change the mask, from beginnings of several sizes.
    fn parts(&self, click: usize, inside: bool) -> Vec<Vec<u8>> {
        let (pixels, [width, height]) = (self.features.pixels(), self.features.size);
        let centre = self.place(click);
        let whole = 1.0 - model().rim;
        let disc = |radius: f32| {
            let area = Area::of(&[click], width).grown((radius / whole) as usize + 1, width, height);
            self.ellipse(area, centre, [radius; 2], [whole, 1.0 / whole])
        };
        let same = (0..pixels).filter(|&p| (self.mask[p] > 0) == inside).map(|p| self.square(p, centre, [1.0; 2]));
        let reach = same.fold(f32::INFINITY, f32::min).sqrt().max(2.0);
        // From the side of a cell on, or half the distance to the nearest pixel that already is as the click demands.
        let longest = width.max(height) as f32;
        let first = (model().cell * longest).min(0.5 * reach);
        let radii = std::iter::successors(Some(first), |radius| Some(std::f32::consts::SQRT_2 * radius));
        // Up to a third of the longer side.
        let discs = radii.take_while(|radius| 3.0 * *radius < longest && *radius <= reach).map(disc);
        let regions = self.found.iter().filter_map(|labels| self.region(labels, click));
        discs.chain(regions).map(|from| self.part(click, inside, from)).collect()
    }

    /// The connected pixels around a click that have enough of the votes.
    fn elected(&self, parts: &[Vec<u8>], weights: &[f32], click: usize) -> Vec<u8> {
        let mut votes = vec![0.0f32; self.features.pixels()];
        for (part, weight) in parts.iter().zip(weights) {
            votes.iter_mut().zip(part).for_each(|(votes, &is_in)| *votes += weight * f32::from(is_in));
        }
        let enough = model().votes * weights.iter().sum::<f32>();
        self.connected(click, &|p| votes[p] > enough)
    }

    /// The connected component of the mask at a click, if it has no click inside the object and is not the largest.
    fn piece(&self, click: usize) -> Option<Vec<u8>> {
        let parts = components(&self.mask, self.features.size[0], Connectivity::Four);
        let largest = parts.list.iter().filter(|part| part.label > 0).map(|part| part.size).max()?;
        let own = parts.of[click];
        let is_sure = parts.of.iter().zip(&self.sure).any(|(&part, &sure)| part == own && sure == Some(Side::Object));
        let is_separate = !is_sure && parts.list[own as usize].size < largest;
        is_separate.then(|| parts.of.iter().map(|&part| u8::from(part == own)).collect())
    }

    /// The connected part around a click that a fit changes as the click demands. The fit begins with `from` being that part.
    fn part(&self, click: usize, inside: bool, from: Beginning) -> Vec<u8> {
        let (features, mask, width) = (self.features, &self.mask, self.features.size[0]);
        let own: Vec<usize> = (0..mask.len()).filter(|&p| mask[p] > 0).collect();
        let fit = if own.is_empty() {
            let area = self.around(&from.area, &self.limit);
            let seen = self.around(&area, &features.area());
            self.fitted(Beginning { area, ..from }, &seen)
        } else {
            // The appearance is learned near the part, because the rest of the object may have the same colours as its surroundings.
            let seen = from.area.grown(from.area.width().max(from.area.height()) / 2, width, features.size[1]);
            let area = self.around(&from.area.with(&Area::of(&own, width)), &self.limit);
            let soft = gaussian(&features.plane(&|p| mask[p] > 0), model().border);
            let prior = soft.values().iter().map(|share| model().beginning * (2.0 * share - 1.0));
            let sign = if inside { 1.0 } else { -1.0 };
            let log_odds = prior.zip(&from.log_odds).map(|(prior, part)| sign * (sign * prior).max(*part)).collect();
            let side = |(&mask, &part): (&u8, &Option<Side>)| match part {
                Some(Side::Object) => Some(Side::object_if(inside)),
                None if (mask > 0) != inside => None,
                _ => Some(Side::object_if(mask > 0)),
            };
            let sides = mask.iter().zip(&from.sides).map(side).collect();
            self.fitted(Beginning { area, log_odds, sides }, &seen)
        };
        self.change(&fit, click, inside)
    }

    /// The connected part around a click where another mask is as the click demands, this mask is not, and no other click demands
    /// otherwise.
    fn change(&self, other: &[u8], click: usize, inside: bool) -> Vec<u8> {
        let (own, otherwise) = (u8::from(inside), Some(Side::object_if(!inside)));
        self.connected(click, &|p| other[p] == own && self.mask[p] != own && self.sure[p] != otherwise)
    }

    /// The connected component at a click of the pixels for which `is_in` holds.
    fn connected(&self, click: usize, is_in: &dyn Fn(usize) -> bool) -> Vec<u8> {
        let all: Vec<u8> = (0..self.features.pixels()).map(|p| u8::from(is_in(p))).collect();
        let parts = components(&all, self.features.size[0], Connectivity::Four);
        all.iter().zip(&parts.of).map(|(is_in, part)| is_in & u8::from(*part == parts.of[click])).collect()
    }

    /// An ellipse within an area: object up to a share of its radii, ground from the share `ground` on. The prior log-odds fall with the
    /// squared distance from its centre, in units of the radii, and are zero where that is `even`.
    fn ellipse(&self, area: Area, centre: [f32; 2], radii: [f32; 2], [even, ground]: [f32; 2]) -> Beginning {
        let object = 1.0 - model().rim;
        let squares: Vec<f32> = (0..self.features.pixels()).map(|p| self.square(p, centre, radii)).collect();
        let mut sides = vec![Some(Side::Ground); squares.len()];
        for p in area.pixels(self.features.size[0]).filter(|&p| squares[p] < ground * ground) {
            sides[p] = (squares[p] < object * object).then_some(Side::Object);
        }
        Beginning { area, sides, log_odds: squares.iter().map(|square| model().beginning * (even - square)).collect() }
    }

    /// The connected region of the click's label; `None` if it is small, or most of the frame has the label.
    fn region(&self, labels: &[u8], click: usize) -> Option<Beginning> {
        let width = self.features.size[0];
        let parts = components(labels, width, Connectivity::Eight);
        let part = parts.list[parts.of[click] as usize];
        let alike = labels.iter().filter(|label| **label == labels[click]).count();
        if part.size < model().pixels || 2 * alike > labels.len() {
            return None;
        }
        let inside = |p: usize| parts.of[p] == parts.of[click];
        let [left, top, right, bottom] = part.bounds;
        Some(Beginning {
            area: Area { columns: left..right + 1, rows: top..bottom + 1 },
            sides: (0..labels.len()).map(|p| Some(Side::object_if(inside(p)))).collect(),
            log_odds: gaussian(&self.features.plane(&inside), model().border)
                .values()
                .iter()
                .map(|share| model().beginning * (2.0 * share - 1.0))
                .collect(),
        })
    }

    /// Alternates between learning the appearance from a mask, in the area `seen`, and cutting the next mask.
    fn fitted(&self, from: Beginning, seen: &Area) -> Vec<u8> {
        let (features, width) = (self.features, self.features.size[0]);
        let Beginning { area, log_odds: prior, mut sides } = from;
        sides
            .iter_mut()
            .zip(&self.sure)
            .filter(|(_, sure)| **sure == Some(Side::Ground))
            .for_each(|(side, sure)| *side = *sure);
        for _ in 0..model().prompt_rounds {
            let count = |side: Side| seen.pixels(width).filter(|&p| sides[p] == Some(side)).count() as f32;
            // Ground pixels weigh less the more of them there are.
            let weight = (count(Side::Object) / count(Side::Ground).max(1.0)).sqrt();
            let mut appearance = AppearanceModel::new(&Area::whole(0, 0), f32::INFINITY);
            for (side, weight) in [(Side::Object, 1.0), (Side::Ground, weight)] {
                let of = |p: usize| sides[p].filter(|own| *own == side);
                appearance.learn_within(features, seen, [0.0; 2], Source::Recent, weight, &of);
            }
            let remembered = appearance.read(features, &area, [0.0; 2]);
            let ratios: Vec<LabelRatios> =
                self.found.iter().map(|found| LabelRatios::of(found, &sides, seen, width)).collect();
            let log_odds = |(p, remembered): (usize, f32)| {
                let found: f32 = self.found.iter().zip(&ratios).map(|(found, of)| of.ratio(found[p])).sum();
                match self.sure[p] {
                    Some(Side::Object) => CERTAIN,
                    Some(Side::Ground) => -CERTAIN,
                    None => prior[p] + logit(remembered) + found,
                }
            };
            let log_odds: Vec<f32> = area.pixels(width).zip(remembered).map(log_odds).collect();
            let mask = cut(features, &area, &log_odds);
            if !mask.contains(&1) {
                break;
            }
            sides.fill(Some(Side::Ground));
            area.pixels(width).zip(mask).for_each(|(p, inside)| sides[p] = Some(Side::object_if(inside > 0)));
        }
        sides.iter().map(|&side| u8::from(side == Some(Side::Object))).collect()
    }

    /// An area grown by a margin, within a limit.
    fn around(&self, area: &Area, limit: &Area) -> Area {
        area.grown(model().margin, self.features.size[0], self.features.size[1]).within(limit)
    }

    fn place(&self, p: usize) -> [f32; 2] {
        [p % self.features.size[0], p / self.features.size[0]].map(|at| at as f32)
    }

    /// Squared distance of a pixel from a centre, in units of the radii.
    fn square(&self, p: usize, centre: [f32; 2], radii: [f32; 2]) -> f32 {
        let place = self.place(p);
        [0, 1].map(|k| (place[k] - centre[k]) / radii[k]).map(|x| x * x).iter().sum()
    }
}

/// Intersection over union of two masks, 0…1.
pub(super) fn overlap(one: &[u8], other: &[u8]) -> f32 {
    let (mut both, mut either) = (0usize, 0usize);
    for (one, other) in one.iter().zip(other) {
        both += usize::from(one & other);
        either += usize::from(one | other);
    }
    both as f32 / either.max(1) as f32
}

/// Weight of each part: the square of its summed overlaps with the others, at least a small positive number.
fn agreements(parts: &[Vec<u8>]) -> Vec<f32> {
    let of = |part: &Vec<u8>| parts.iter().map(|other| overlap(part, other)).sum::<f32>() - 1.0;
    parts.iter().map(|part| of(part).powi(2).max(f32::EPSILON)).collect()
}

/// Weight of a part: the fourth power of the depth of a pixel in it relative to its deepest pixel, 0…1.
fn centrality(part: &[u8], pixel: usize, width: usize) -> f32 {
    let squares = squared_depths(part, width);
    let deepest = squares.iter().copied().max().unwrap_or(0).max(1);
    (squares[pixel] as f32 / deepest as f32).powi(2)
}

/// Squared distance of each pixel of a part from the nearest pixel that is outside it or beyond the frame; 0 outside the part.
fn squared_depths(part: &[u8], width: usize) -> Vec<usize> {
    // First along columns, then the nearest along each row.
    let mut along = vec![0usize; part.len()];
    for p in (0..part.len()).filter(|&p| part[p] > 0) {
        along[p] = 1 + p.checked_sub(width).map_or(0, |above| along[above]);
    }
    for p in (0..part.len()).rev().filter(|&p| part[p] > 0) {
        along[p] = along[p].min(1 + along.get(p + width).copied().unwrap_or(0));
    }
    let nearest = |row: &[usize], x: usize| {
        let mut least = row[x] * row[x];
        let mut aside = 1;
        while aside * aside < least {
            let left = x.checked_sub(aside).map_or(0, |left| row[left]);
            let depth = left.min(row.get(x + aside).copied().unwrap_or(0));
            least = least.min(aside * aside + depth * depth);
            aside += 1;
        }
        least
    };
    along.chunks_exact(width).flat_map(|row| (0..width).map(move |x| nearest(row, x))).collect()
}
