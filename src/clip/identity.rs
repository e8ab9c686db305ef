//! Which foreground is which object: numbers that last from an object's first frame to its last.
//!
//! The labels of the frame before are carried along the motions. A connected region that one object leads to is that object, with all the
//! parts that single frames give motions of their own. Where several lead to one region, they share it. Where none does, the region is
//! an object, or a part of one, that was hidden; or else a new one. Pieces of an object that move apart are two.

use std::rc::Rc;

use super::carry::carried_labels;
use super::evidence::Flow;
use super::record::Record;
use crate::components::{Connectivity, components};
use crate::frame::Plane;
use crate::frame::palette::COLOURS;
use crate::labelling::is_background;
use crate::labelling::regions::description::smallest_share;
use crate::labelling::solver::{MAX_LABELS, Solver};
use crate::order::descending;

// The constants below were set by hand on ten real clips and on tests/clip.rs, and were not varied.

/// Largest number of an object: 255 is kept for unlabelled pixels.
pub(crate) const MAX_OBJECTS: usize = 254;
/// An object leads to a region where its carried pixels are at least this share of the region or of the object …
const CLAIM: f64 = 0.2;
/// … and a region with less than this share of carried pixels is not claimed by what grazes it.
const GRAZE: f64 = 0.05;
/// A carried label that is not known: it hid behind something.
const UNKNOWN: u8 = u8::MAX;
/// Share of its pixels that must be in sight to tell how it moves.
const MOVING: f64 = 0.3;
/// Share of its pixels from which an object is in full sight.
const WHOLE: f64 = 0.95;
/// What is left of its full size in every frame in which less is in sight: objects also become smaller by moving away.
const SHRINKING: f64 = 0.98;
/// Frames for which an object may be hidden and keep its number.
const LONGEST_HIDDEN: usize = 10;
/// What was hidden of an object is looked for this far from where its motion leads, in roots of its size.
const SEARCH: f64 = 1.5;
/// A part of an object in sight moves like it, to within this many working pixels …
const SAME_MOTION: f64 = 1.0;
/// … and this share of its displacement.
const SAME_SPEED: f64 = 0.25;
/// Overlap of two colour histograms, 0…1, from which they may be of one object.
const ALIKE: f64 = 0.4;
/// Largest growth of an object while it was hidden.
const GROWTH: f64 = 4.0;
/// Two pieces of an object are two objects when one has moved this far relative to the other, in roots of its size. What covers the
/// middle of an object leaves its pieces where they are.
const APART: f64 = 0.5;
/// Share of an object that a piece must have to be one.
const SMALLEST_PIECE: f64 = 0.2;
/// Price of a label other than the one carried to a pixel, and of one that few carried pixels of the same motion have.
const PRICES: [f32; 2] = [2.0, 1.0];
/// Price of a border between two objects.
const SMOOTHNESS: f32 = 3.0;

/// An object as last seen.
#[derive(Clone, Debug)]
struct Object {
    number: u8,
    /// Working pixels where it was last seen whole: more than [`WHOLE`] of the most before.
    pixels: f64,
    /// Its centre there, moved on with it since.
    centre: [f64; 2],
    /// Displacement of its centre in a frame, working pixels.
    velocity: [f64; 2],
    colours: Vec<f32>,
    /// Frames since it was seen.
    hidden: usize,
    /// How far its largest pieces have moved relative to each other since they came apart, working pixels.
    apart: [f64; 2],
}

/// The objects of a clip so far.
#[derive(Debug)]
pub(crate) struct Identities {
    objects: Vec<Object>,
    /// The last frame and its labels.
    last: Option<(Rc<Record>, Vec<u8>)>,
    /// Number of the next new object.
    next: usize,
    /// Objects that got no number.
    pub(crate) dropped: usize,
}

impl Identities {
    pub(crate) fn new() -> Identities {
        Identities { objects: Vec::new(), last: None, next: 1, dropped: 0 }
    }

    /// The object of every working pixel of the next frame, 0 for the background; `mask` is 1 on its foreground.
    pub(crate) fn assign(&mut self, record: &Rc<Record>, mask: &[u8]) -> Vec<u8> {
        let [width, _] = record.size();
        let carried = match (&record.back, &self.last) {
            (Some(back), Some((last, labels))) => {
                let return_flow = last.onward.as_ref().filter(|flow| flow.measured);
                let mut carried = carried_labels(labels, back, return_flow, UNKNOWN);
                self.follow_velocities(labels, mask, width, &mut carried);
                carried
            }
            _ => {
                // A new scene: nothing goes on.
                self.objects.clear();
                vec![UNKNOWN; mask.len()]
            }
        };
        let mut labels = vec![0u8; mask.len()];
        let found = components(mask, width, Connectivity::Eight);
        let smallest = (smallest_share() * mask.len() as f64) as usize / 2;
        let mut unclaimed = Vec::new();
        for k in descending(found.list.iter().map(|c| c.size as f64)).iter().copied() {
            if found.list[k].label == 0 || found.list[k].size < smallest {
                continue;
            }
            let pixels: Vec<usize> = (0..mask.len()).filter(|&p| found.of[p] as usize == k).collect();
            match self.claims(&pixels, &carried)[..] {
                [] => unclaimed.push(pixels),
                [only] => pixels.iter().for_each(|&p| labels[p] = only),
                ref several => share(record, &pixels, &carried, several, &mut labels),
            }
        }
        for pixels in unclaimed {
            let number = self.returned(record, &pixels).or_else(|| self.new_number());
            pixels.iter().for_each(|&p| labels[p] = number.unwrap_or(0));
        }
        self.part(record, &mut labels);
        self.remember(record, &labels);
        labels
    }

    /// Foreground that the motions lead to no object, as one of its pairs took it for background, may be where an object's velocity leads.
    fn follow_velocities(&self, labels: &[u8], mask: &[u8], width: usize, carried: &mut [u8]) {
        let height = (labels.len() / width) as f64;
        let lost = |label: u8| label == 0 || label == UNKNOWN;
        for (p, carried) in carried.iter_mut().enumerate().filter(|(p, carried)| mask[*p] > 0 && lost(**carried)) {
            let (x, y) = ((p % width) as f64 + 0.5, (p / width) as f64 + 0.5);
            let leads_here = |object: &&Object| {
                let (px, py) = (x - object.velocity[0], y - object.velocity[1]);
                let inside = px >= 0.0 && py >= 0.0 && px < width as f64 && py < height;
                inside && labels[py as usize * width + px as usize] == object.number
            };
            *carried = self.objects.iter().find(leads_here).map_or(*carried, |object| object.number);
        }
    }

    /// The objects that lead to a region, by number.
    fn claims(&self, pixels: &[usize], carried: &[u8]) -> Vec<u8> {
        let mut counts = [0usize; 256];
        pixels.iter().for_each(|&p| counts[usize::from(carried[p])] += 1);
        let size = pixels.len() as f64;
        let claims = |object: &&Object| {
            let count = counts[usize::from(object.number)] as f64;
            count >= CLAIM * size || (count >= CLAIM * object.pixels && count >= GRAZE * size)
        };
        let mut numbers: Vec<u8> = self.objects.iter().filter(claims).map(|object| object.number).collect();
        numbers.sort_unstable();
        numbers.truncate(MAX_LABELS);
        numbers
    }

    /// The object that a region is, or is a part of, which was hidden until now: the one whose colours are most alike among those that
    /// may be here.
    fn returned(&self, record: &Record, pixels: &[usize]) -> Option<u8> {
        let (centre, colours) = (centre(pixels, record.size()[0]), histogram(record, pixels));
        let ([u, v], size) = (velocity(record, pixels), pixels.len() as f64);
        let mut best = (ALIKE, None);
        for object in &self.objects {
            let [r, s] = object.velocity;
            let moves_alike =
                ((u - r) * (u - r) + (v - s) * (v - s)).sqrt() < SAME_MOTION + SAME_SPEED * (r * r + s * s).sqrt();
            let grown = size / object.pixels;
            let may_be = object.hidden > 0 || moves_alike;
            let [dx, dy] = [0, 1].map(|k| object.centre[k] + object.velocity[k] - centre[k]);
            let reach = SEARCH * object.pixels.sqrt() * (1.0 + 0.1 * object.hidden as f64);
            let alike = overlap(&object.colours, &colours);
            if may_be && grown < GROWTH && (dx * dx + dy * dy).sqrt() < reach && alike > best.0 {
                best = (alike, Some(object.number));
            }
        }
        best.1
    }

    fn new_number(&mut self) -> Option<u8> {
        if self.next > MAX_OBJECTS {
            self.dropped += 1;
            return None;
        }
        self.next += 1;
        Some((self.next - 1) as u8)
    }

    /// Gives pieces that have moved apart from their object for some frames numbers of their own.
    fn part(&mut self, record: &Record, labels: &mut [u8]) {
        let Some(along) = record.onward.as_ref().or(record.back.as_ref()) else { return };
        let width = record.size()[0];
        let found = components(labels, width, Connectivity::Eight);
        for k in 0..self.objects.len() {
            let number = self.objects[k].number;
            let mut pieces: Vec<usize> = (0..found.list.len()).filter(|&c| found.list[c].label == number).collect();
            pieces.sort_by_key(|&c| std::cmp::Reverse(found.list[c].size));
            let whole: usize = pieces.iter().map(|&c| found.list[c].size).sum();
            let large = |c: &&usize| found.list[**c].size as f64 >= SMALLEST_PIECE * whole as f64;
            let second = pieces.iter().skip(1).find(large).copied();
            let Some(second) = second else {
                self.objects[k].apart = [0.0; 2];
                continue;
            };
            let motion = |c: usize| mean_motion(along, &pixels_of(&found.of, c), width);
            let ([u, v], [r, s]) = (motion(pieces[0]), motion(second));
            let [x, y] = &mut self.objects[k].apart;
            (*x, *y) = (*x + u - r, *y + v - s);
            if (*x * *x + *y * *y).sqrt() > APART * (found.list[second].size as f64).sqrt()
                && let Some(new) = self.new_number()
            {
                pixels_of(&found.of, second).iter().for_each(|&p| labels[p] = new);
                self.objects[k].apart = [0.0; 2];
            }
        }
    }

    /// Keeps what the next frame needs.
    fn remember(&mut self, record: &Rc<Record>, labels: &[u8]) {
        let mut pixels: Vec<Vec<usize>> = vec![Vec::new(); MAX_OBJECTS + 1];
        labels.iter().enumerate().filter(|(_, l)| **l > 0).for_each(|(p, &l)| pixels[usize::from(l)].push(p));
        for object in &mut self.objects {
            object.hidden += 1;
            (0..2).for_each(|k| object.centre[k] += object.velocity[k]);
        }
        for (number, pixels) in pixels.iter().enumerate().filter(|(_, pixels)| !pixels.is_empty()) {
            let (number, size, velocity) = (number as u8, pixels.len() as f64, velocity(record, pixels));
            let seen = || {
                let (centre, colours) = (centre(pixels, record.size()[0]), histogram(record, pixels));
                Object { number, pixels: size, centre, velocity, colours, hidden: 0, apart: [0.0; 2] }
            };
            match self.objects.iter_mut().find(|object| object.number == number) {
                Some(object) if size < WHOLE * object.pixels => {
                    object.hidden = 0;
                    // The little that is in sight may pass for background in its pairs.
                    if size >= MOVING * object.pixels && moves(record, pixels) {
                        object.velocity = velocity;
                    }
                    object.pixels *= SHRINKING;
                }
                Some(object) => *object = Object { apart: object.apart, ..seen() },
                None => self.objects.push(seen()),
            }
        }
        self.objects.retain(|object| object.hidden <= LONGEST_HIDDEN);
        self.last = Some((record.clone(), labels.to_vec()));
    }
}

/// Shares a region among the objects that lead to it: each pixel stays with its own, and pixels of one motion stay together.
fn share(record: &Record, pixels: &[usize], carried: &[u8], numbers: &[u8], labels: &mut [u8]) {
    let [width, height] = record.size();
    let motions = record.back.as_ref().map(|back| &back.labels);
    let motion = |p: usize| motions.map_or(0, |labels| usize::from(labels[p]));
    let mut votes = vec![vec![0usize; numbers.len()]; 256];
    for &p in pixels {
        if let Some(k) = numbers.iter().position(|&n| n == carried[p]) {
            votes[motion(p)][k] += 1;
        }
    }
    let mut costs: Vec<Plane> = numbers.iter().map(|_| Plane::filled(width, height, 0.0)).collect();
    for &p in pixels {
        let votes = &votes[motion(p)];
        let all = votes.iter().sum::<usize>().max(1) as f32;
        let known = numbers.contains(&carried[p]);
        for (k, cost) in costs.iter_mut().enumerate() {
            let other = if known && numbers[k] != carried[p] { PRICES[0] } else { 0.0 };
            cost.values_mut()[p] = other + PRICES[1] * (1.0 - votes[k] as f32 / all);
        }
    }
    let solved = record.borders(SMOOTHNESS).solve(&costs, Solver::FAST);
    pixels.iter().for_each(|&p| labels[p] = numbers[usize::from(solved[p])]);
}

fn pixels_of(of: &[u32], component: usize) -> Vec<usize> {
    (0..of.len()).filter(|&p| of[p] as usize == component).collect()
}

fn centre(pixels: &[usize], width: usize) -> [f64; 2] {
    let n = pixels.len().max(1) as f64;
    let sums = pixels.iter().fold([0.0, 0.0], |[x, y], &p| [x + (p % width) as f64, y + (p / width) as f64]);
    sums.map(|sum| sum / n)
}

/// Mean displacement of some pixels.
fn mean_motion(along: &Flow, pixels: &[usize], width: usize) -> [f64; 2] {
    let n = pixels.len().max(1) as f64;
    let sums = pixels.iter().fold([0.0, 0.0], |[a, b], &p| {
        let [u, v] = along.at(p % width, p / width);
        [a + u, b + v]
    });
    sums.map(|sum| sum / n)
}

/// Mean displacement of some pixels to the next frame or, at the end, from the frame before.
fn velocity(record: &Record, pixels: &[usize]) -> [f64; 2] {
    let width = record.size()[0];
    match (&record.onward, &record.back) {
        (Some(onward), _) => mean_motion(onward, pixels, width),
        (None, Some(back)) => mean_motion(back, pixels, width).map(|v| -v),
        (None, None) => [0.0; 2],
    }
}

/// Whether most of some pixels have another motion than the background.
fn moves(record: &Record, pixels: &[usize]) -> bool {
    let Some(flow) = record.onward.as_ref().or(record.back.as_ref()) else { return false };
    2 * pixels.iter().filter(|&&p| !is_background(flow.labels[p])).count() > pixels.len()
}

/// Share of each colour among some pixels.
fn histogram(record: &Record, pixels: &[usize]) -> Vec<f32> {
    let palette = &record.appearance.palette;
    let mut shares = vec![0.0; COLOURS];
    let share = 1.0 / pixels.len().max(1) as f32;
    pixels.iter().for_each(|&p| shares[palette.index(p)] += share);
    shares
}

fn overlap(one: &[f32], other: &[f32]) -> f64 {
    one.iter().zip(other).map(|(a, b)| f64::from(a.min(*b))).sum()
}
