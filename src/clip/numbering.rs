//! The final numbers of objects, by the whole clip.
//!
//! An object of a few frames in a longer scene is a mistake of single pairs, and none. The others are numbered by first appearance, then by
//! size there, then by their topmost, leftmost pixel.

use super::identity::MAX_OBJECTS;
use crate::clip::options::model;
use crate::order::sort_few;

/// All objects of a clip, counted frame by frame.
pub(crate) struct Numbering {
    seen: Vec<Option<Seen>>,
    /// First frame of every scene.
    scenes: Vec<usize>,
    /// Frames so far.
    count: usize,
}

/// When an object was seen.
#[derive(Clone)]
struct Seen {
    scene: usize,
    frames: usize,
    last: usize,
    /// First frame, and there the pixels it lacks, and its first pixel: what it is numbered by.
    order: (usize, usize, usize),
}

impl Numbering {
    pub(crate) fn new() -> Numbering {
        Numbering { seen: vec![None; MAX_OBJECTS + 1], scenes: Vec::new(), count: 0 }
    }

    /// Counts the objects of the next frame.
    pub(crate) fn add(&mut self, labels: &[u8], begins_scene: bool) {
        let index = self.count;
        self.count += 1;
        if begins_scene {
            self.scenes.push(index);
        }
        let mut pixels = [(0usize, 0usize); MAX_OBJECTS + 1];
        for (p, &label) in labels.iter().enumerate().rev().filter(|(_, label)| **label > 0) {
            let (count, first) = &mut pixels[usize::from(label)];
            (*count, *first) = (*count + 1, p);
        }
        let scene = self.scenes.len().saturating_sub(1);
        for (seen, (count, first)) in self.seen.iter_mut().zip(pixels).filter(|(_, (count, _))| *count > 0) {
            let order = (index, labels.len() - count, first);
            let seen = seen.get_or_insert(Seen { scene, frames: 0, last: index, order });
            seen.frames += 1;
            seen.last = index;
        }
    }

    /// The final number of each object, by the number it has; those that are none have 0.
    pub(crate) fn final_numbers(&self) -> [u8; 256] {
        let lasts = |seen: &Seen| {
            let end = self.scenes.get(seen.scene + 1).unwrap_or(&self.count);
            seen.frames >= model().lasting || seen.order.0 == self.scenes[seen.scene] || seen.last + 1 == *end
        };
        let objects = self.seen.iter().enumerate().filter_map(|(k, seen)| Some((k, seen.as_ref()?)));
        let mut orders: Vec<_> = objects.filter(|(_, seen)| lasts(seen)).map(|(k, seen)| (seen.order, k)).collect();
        sort_few(&mut orders, Ord::cmp);
        let mut numbers = [0u8; 256];
        (1..=MAX_OBJECTS as u8).zip(orders).for_each(|(number, (_, k))| numbers[k] = number);
        numbers
    }
}
