//! Which foreground is which object: numbers that stay the same from an object's first frame to its last.
//!
//! The labels of the previous frame are carried along the motions. A connected region that gets labels of one object is that object,
//! including the parts to which single frames give motions of their own. A region that gets labels of several objects is shared among them
//! (`identity/sharing.rs`). A region without labels, or a piece that moves independently, may be an object, or a part of one, that was
//! hidden; else it is a new object. Pieces of an object that move apart become two objects.

mod object;
mod sharing;
mod sight;

use crate::answer::UNLABELLED;
use crate::clip::options::model;
use std::sync::Arc;

use super::carry::carried_labels;
use super::record::Record;
use crate::components::{Components, Connectivity, components};
use crate::labelling::solver::MAX_LABELS;
use crate::model::Model;
use crate::order::{descending, sort_few};
use object::{Apart, Object};
use sharing::share;
use sight::{Sight, shown_motion};

/// Largest number of an object: 255 is kept for unlabelled pixels.
pub(crate) const MAX_OBJECTS: usize = 254;

/// An object that was part of another one before a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parting {
    pub(crate) frame: usize,
    pub(crate) from: u8,
    pub(crate) new: u8,
}

/// The objects of a clip so far.
#[derive(Debug)]
pub(crate) struct Identities {
    /// Whether everything that is found is one object, the main subject.
    subject: bool,
    objects: Vec<Object>,
    /// In order of frames.
    pub(crate) parted: Vec<Parting>,
    /// The last frame and its labels.
    last: Option<(Arc<Record>, Vec<u8>)>,
    /// Number of the next new object.
    next: usize,
    /// Number of objects for which no number was left.
    pub(crate) dropped: usize,
}

impl Identities {
    pub(crate) fn new(subject: bool) -> Identities {
        Identities { subject, objects: Vec::new(), parted: Vec::new(), last: None, next: 1, dropped: 0 }
    }

    /// The object of every working pixel of the next frame, 0 for the background; `mask` is 1 on its foreground.
    pub(crate) fn assign(&mut self, record: &Arc<Record>, mask: &[u8]) -> Vec<u8> {
        let smallest = (Model::DEFAULT.smallest_share * mask.len() as f64) as usize / 2;
        if self.subject || model().identities == 0 {
            let mut labels = vec![0u8; mask.len()];
            let found = components(mask, record.size()[0], Connectivity::Eight);
            regions(&found, smallest).iter().flatten().for_each(|&p| labels[p] = 1);
            return labels;
        }
        let mut carried = self.carried(record, mask);
        let emerged = self.emerge(record, mask, smallest, &mut carried);
        let mut labels = vec![0u8; mask.len()];
        let mut unclaimed = Vec::new();
        for pixels in regions(&components(mask, record.size()[0], Connectivity::Eight), smallest) {
            match self.claims(&pixels, &carried, &emerged)[..] {
                [] => unclaimed.push(pixels),
                [only] => pixels.iter().for_each(|&p| labels[p] = only),
                ref several => share(record, &pixels, &carried, several, &mut labels),
            }
        }
        for pixels in unclaimed {
            let number = self.returned(&Sight::of(record, &pixels)).or_else(|| self.new_number());
            pixels.iter().for_each(|&p| labels[p] = number.unwrap_or(0));
        }
        self.part(record, &mut labels);
        self.remember(record, &labels);
        labels
    }

    /// The labels of the previous frame, carried along the motions; 255 where there is none. Moves the objects on; a new scene begins
    /// without objects.
    fn carried(&mut self, record: &Record, mask: &[u8]) -> Vec<u8> {
        let (Some(back), Some((last, labels))) = (&record.back, &self.last) else {
            self.objects.clear();
            return vec![UNLABELLED; mask.len()];
        };
        let return_flow = last.onward.as_ref().filter(|flow| flow.measured);
        let mut carried = carried_labels(labels, back, return_flow, UNLABELLED);
        // A repeated frame shows no motion: the objects stay where they are.
        if !record.repeats {
            self.objects.iter_mut().for_each(Object::move_on);
            self.follow_velocities(labels, mask, record.size()[0], &mut carried);
        }
        carried
    }

    /// Gives foreground without a carried label, which one of its pairs took for background, the object whose velocity leads there.
    fn follow_velocities(&self, labels: &[u8], mask: &[u8], width: usize, carried: &mut [u8]) {
        let height = (labels.len() / width) as f64;
        let lost = |label: u8| label == 0 || label == UNLABELLED;
        for (p, carried) in carried.iter_mut().enumerate().filter(|(p, carried)| mask[*p] > 0 && lost(**carried)) {
            let (x, y) = ((p % width) as f64 + 0.5, (p / width) as f64 + 0.5);
            let leads_here = |object: &&Object| {
                let [u, v] = object.whole.velocity;
                let (px, py) = (x - u, y - v);
                let inside = px >= 0.0 && py >= 0.0 && px < width as f64 && py < height;
                inside && labels[py as usize * width + px as usize] == object.number
            };
            *carried = self.objects.iter().find(leads_here).map_or(*carried, |object| object.number);
        }
    }

    /// Finds pieces that come out from behind an object. Such a piece touches the object in front, and the motions of one pair carry it
    /// from there; but it moves independently, as a hidden object did, and its colours are more like those of the hidden object. It then
    /// counts as carried from the hidden object. Returns the numbers of these objects.
    fn emerge(&self, record: &Record, mask: &[u8], smallest: usize, carried: &mut [u8]) -> Vec<u8> {
        let Some(along) = shown_motion(record) else { return Vec::new() };
        let moving: Vec<u8> =
            mask.iter().zip(&along.labels[..]).map(|(&m, &k)| if m > 0 { k + 1 } else { 0 }).collect();
        let pieces = regions(&components(&moving, along.width, Connectivity::Eight), smallest);
        // The object from which most of a piece is carried, and how many of its pixels are.
        let owners: Vec<(Option<&Object>, usize)> = pieces.iter().map(|piece| self.owner(piece, carried)).collect();
        let mut emerged = Vec::new();
        for (piece, (owner, count)) in pieces.iter().zip(&owners) {
            let is_owner = |number: u8| owner.is_some_and(|owner| owner.number == number);
            let largest =
                |(other, size): &(Option<&Object>, usize)| !other.is_some_and(|o| is_owner(o.number)) || size <= count;
            if let Some(owner) = owner
                && owners.iter().all(largest)
            {
                // A covered object keeps its place in the region, however little of it is visible.
                if owner.is_covered() && 2 * count >= piece.len() {
                    emerged.push(owner.number);
                }
                continue;
            }
            let sight = Sight::of(record, piece);
            let least = owner.map_or(0.0, |owner| owner.whole.alike(&sight));
            let may_be = |object: &Object| !is_owner(object.number) && object.is_covered() && object.moves_like(&sight);
            if let Some(number) = self.most_alike(&sight, least, may_be) {
                piece.iter().for_each(|&p| carried[p] = number);
                emerged.push(number);
            }
        }
        emerged
    }

    /// The object from which most pixels of a piece are carried, and how many are.
    fn owner(&self, piece: &[usize], carried: &[u8]) -> (Option<&Object>, usize) {
        let counts = counts(piece, carried);
        let of = |object: &Object| counts[usize::from(object.number)];
        let owner = self.objects.iter().filter(|object| of(object) > 0).max_by_key(|object| of(object));
        (owner, owner.map_or(0, of))
    }

    /// The numbers of the objects from which a sufficient share of a region is carried; of emerged objects any pixel is sufficient.
    fn claims(&self, pixels: &[usize], carried: &[u8], emerged: &[u8]) -> Vec<u8> {
        let counts = counts(pixels, carried);
        let size = pixels.len() as f64;
        let claims = |object: &&Object| {
            let count = counts[usize::from(object.number)] as f64;
            count >= f64::from(model().carried) * size || (count > 0.0 && emerged.contains(&object.number))
        };
        let mut numbers: Vec<u8> = self.objects.iter().filter(claims).map(|object| object.number).collect();
        sort_few(&mut numbers, u8::cmp);
        numbers.truncate(MAX_LABELS);
        numbers
    }

    /// The known object that a region is, or is a part of, after it was hidden.
    fn returned(&self, sight: &Sight) -> Option<u8> {
        self.most_alike(sight, 0.0, |object| object.is_covered() || object.moves_like(sight))
    }

    /// The object near a region whose colours are most like it, among those that `may_be` it, if they are more alike than `least`.
    fn most_alike(&self, sight: &Sight, least: f64, may_be: impl Fn(&Object) -> bool) -> Option<u8> {
        let mut best = (least.max(f64::from(model().likeness)), None);
        for object in &self.objects {
            let alike = object.whole.alike(sight);
            if may_be(object) && object.is_near(sight.centre) && alike > best.0 {
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

    /// Gives new numbers to pieces that have moved apart from their object for some frames.
    fn part(&mut self, record: &Record, labels: &mut [u8]) {
        let Some(along) = record.onward.as_ref().or(record.back.as_ref()) else { return };
        let found = components(labels, record.size()[0], Connectivity::Eight);
        let order = descending(found.list.iter().map(|component| component.size as f64));
        for k in 0..self.objects.len() {
            let number = self.objects[k].number;
            let pieces: Vec<usize> = order.iter().copied().filter(|&c| found.list[c].label == number).collect();
            let whole: usize = pieces.iter().map(|&c| found.list[c].size).sum();
            let large = |c: &&usize| found.list[**c].size as f64 >= f64::from(model().fragment) * whole as f64;
            let second = pieces.iter().skip(1).find(large).copied();
            let Some(second) = second else {
                self.objects[k].apart = Apart::default();
                continue;
            };
            let [one, other] = [pieces[0], second].map(|c| pixels_of(&found, c));
            let apart = &mut self.objects[k].apart;
            apart.add(along, &one, &other);
            if apart.distance() > model().search * (other.len() as f64).sqrt() || apart.frames >= model().lasting_motion
            {
                self.objects[k].apart = Apart::default();
                if let Some(new) = self.new_number() {
                    other.iter().for_each(|&p| labels[p] = new);
                    self.parted.push(Parting { frame: record.index, from: number, new });
                }
            }
        }
    }

    /// Keeps what the next frame needs.
    fn remember(&mut self, record: &Arc<Record>, labels: &[u8]) {
        let mut pixels: Vec<Vec<usize>> = vec![Vec::new(); MAX_OBJECTS + 1];
        labels.iter().enumerate().filter(|(_, l)| **l > 0).for_each(|(p, &l)| pixels[usize::from(l)].push(p));
        for object in &mut self.objects {
            object.see(record, &pixels[usize::from(object.number)]);
        }
        self.objects.retain(Object::is_remembered);
        let known: Vec<u8> = self.objects.iter().map(|object| object.number).collect();
        let new = (1..=MAX_OBJECTS as u8)
            .filter(|number| !pixels[usize::from(*number)].is_empty() && !known.contains(number));
        self.objects.extend(new.map(|number| Object::new(number, Sight::of(record, &pixels[usize::from(number)]))));
        self.last = Some((record.clone(), labels.to_vec()));
    }
}

/// The pixels of each component with a label other than 0 and at least `smallest` pixels, the largest component first.
fn regions(found: &Components, smallest: usize) -> Vec<Vec<usize>> {
    let mut pixels = vec![Vec::new(); found.list.len()];
    found.of.iter().enumerate().for_each(|(p, &k)| pixels[k as usize].push(p));
    let order = descending(found.list.iter().map(|component| component.size as f64));
    let large = |&&k: &&usize| found.list[k].label > 0 && found.list[k].size >= smallest;
    order.iter().filter(large).map(|&k| std::mem::take(&mut pixels[k])).collect()
}

/// How many of some pixels are carried from each object, by number.
fn counts(pixels: &[usize], carried: &[u8]) -> [usize; 256] {
    let mut counts = [0; 256];
    pixels.iter().for_each(|&p| counts[usize::from(carried[p])] += 1);
    counts
}

fn pixels_of(found: &Components, component: usize) -> Vec<usize> {
    (0..found.of.len()).filter(|&p| found.of[p] as usize == component).collect()
}
