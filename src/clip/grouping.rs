//! Objects judged by the whole clip: which are parts of one object, which are mistakes, and their final numbers.
//!
//! Parts that move together while both are visible are one object (the Gestalt law of common fate). An object that lasts only a few frames
//! of a longer scene is a mistake of single pairs. Objects are numbered by first appearance, then by size there, then by their topmost,
//! leftmost pixel.

use super::identity::MAX_OBJECTS;
use super::pairs::LayeredMotion;
use crate::clip::options::model;
use crate::labelling::BACKGROUND;
use crate::order::sort_few;

/// All objects of a clip, counted frame by frame.
pub(crate) struct Census {
    objects: Vec<Option<Seen>>,
    /// Pairs of objects that were visible together, in the order of their first meeting.
    meetings: Vec<Meeting>,
    /// First frame of every scene.
    scenes: Vec<usize>,
    /// Frames so far.
    count: usize,
}

/// When an object was seen.
struct Seen {
    scene: usize,
    frames: usize,
    last: usize,
    /// Sort key of its number: the first frame; in that frame the number of pixels outside the object, and its first pixel.
    order: (usize, usize, usize),
}

/// How two objects moved while both were visible.
struct Meeting {
    numbers: [u8; 2],
    /// Number of frames in which both moved.
    frames: usize,
    /// Sum of the differences of their motions, and of their displacements relative to the background, working pixels.
    difference: f64,
    displacement: f64,
    /// Smallest distance, relative to the root of the smaller object's number of pixels.
    distance: f64,
}

/// An object in one frame.
struct Sighting {
    number: u8,
    pixels: usize,
    first: usize,
    centre: [f64; 2],
    /// First and last column, first and last row.
    bounds: [usize; 4],
    /// Mean displacement to the next frame.
    displacement: [f64; 2],
    /// Index of the most frequent motion of its pixels.
    motion: usize,
}

impl Census {
    pub(crate) fn new() -> Census {
        Census {
            objects: (0..=MAX_OBJECTS).map(|_| None).collect(),
            meetings: Vec::new(),
            scenes: Vec::new(),
            count: 0,
        }
    }

    /// Counts the objects of the next frame. `onward` is its flow to the next frame of its scene.
    pub(crate) fn add(&mut self, labels: &[u8], width: usize, onward: Option<&LayeredMotion>, begins_scene: bool) {
        let index = self.count;
        self.count += 1;
        if begins_scene {
            self.scenes.push(index);
        }
        let scene = self.scenes.len().saturating_sub(1);
        let sightings = sightings(labels, width, onward);
        for sighting in &sightings {
            let order = (index, labels.len() - sighting.pixels, sighting.first);
            let seen = &mut self.objects[usize::from(sighting.number)];
            let seen = seen.get_or_insert(Seen { scene, frames: 0, last: index, order });
            seen.frames += 1;
            seen.last = index;
        }
        let Some(onward) = onward else { return };
        for (k, one) in sightings.iter().enumerate() {
            sightings[k + 1..].iter().for_each(|other| self.meet(one, other, onward));
        }
    }

    fn meet(&mut self, one: &Sighting, other: &Sighting, onward: &LayeredMotion) {
        let numbers = [one.number, other.number];
        let known = self.meetings.iter().position(|meeting| meeting.numbers == numbers);
        let place = known.unwrap_or_else(|| {
            let unmet = Meeting { numbers, frames: 0, difference: 0.0, displacement: 0.0, distance: f64::INFINITY };
            self.meetings.push(unmet);
            self.meetings.len() - 1
        });
        let meeting = &mut self.meetings[place];
        let at = |motion: usize, [x, y]: [f64; 2]| onward.motions[motion].flow(x, y);
        let length = |[u, v]: [f64; 2], [r, s]: [f64; 2]| ((u - r) * (u - r) + (v - s) * (v - s)).sqrt();
        // Where the motion of each would take the other.
        let difference = length(at(one.motion, other.centre), other.displacement)
            + length(at(other.motion, one.centre), one.displacement);
        let moved = |sighting: &Sighting| length(at(BACKGROUND, sighting.centre), sighting.displacement);
        if moved(one) >= f64::from(model().same_motion) && moved(other) >= f64::from(model().same_motion) {
            meeting.frames += 1;
            meeting.difference += difference;
            meeting.displacement += moved(one) + moved(other);
        }
        let gap = |k: usize| {
            let (a, b) = (&one.bounds, &other.bounds);
            (b[k].saturating_sub(a[k + 1])).max(a[k].saturating_sub(b[k + 1])) as f64
        };
        let root = (one.pixels.min(other.pixels) as f64).sqrt();
        meeting.distance = meeting.distance.min(length([gap(0), gap(2)], [0.0; 2]) / root);
    }

    /// The final number of each object, by its current number; 0 for those that are dropped.
    pub(crate) fn final_numbers(&self) -> [u8; 256] {
        let mut group: Vec<usize> = (0..self.objects.len()).collect();
        for meeting in self.meetings.iter().filter(|meeting| meeting.is_of_one_object()) {
            let [one, other] = meeting.numbers.map(|number| group[usize::from(number)]);
            group.iter_mut().filter(|group| **group == one.max(other)).for_each(|group| *group = one.min(other));
        }
        let mut orders: Vec<(usize, usize, usize, usize)> = Vec::new();
        for object in 1..group.len() {
            let parts = || (0..group.len()).filter(|&k| group[k] == object).filter_map(|k| self.objects[k].as_ref());
            let lasts = parts().any(|seen| {
                let end = self.scenes.get(seen.scene + 1).unwrap_or(&self.count);
                seen.frames >= model().lasting || seen.order.0 == self.scenes[seen.scene] || seen.last + 1 == *end
            });
            if let Some(&(frame, lacking, first)) = parts().map(|seen| &seen.order).min()
                && lasts
            {
                orders.push((frame, lacking, first, object));
            }
        }
        sort_few(&mut orders, Ord::cmp);
        let mut numbers = [0u8; 256];
        for (k, group) in group.iter().enumerate().skip(1) {
            let place = orders.iter().position(|(.., object)| object == group);
            numbers[k] = place.map_or(0, |place| place as u8 + 1);
        }
        numbers
    }
}

impl Meeting {
    fn is_of_one_object(&self) -> bool {
        model().joins > 0
            && self.frames >= model().lasting_motion
            && self.difference <= f64::from(model().same_relative_motion) * self.displacement
            && self.distance <= model().search
    }
}

/// The objects of a frame, by number.
fn sightings(labels: &[u8], width: usize, onward: Option<&LayeredMotion>) -> Vec<Sighting> {
    let mut sightings: Vec<Option<Sighting>> = (0..=MAX_OBJECTS).map(|_| None).collect();
    for (p, &number) in labels.iter().enumerate().filter(|(_, label)| **label > 0) {
        let (x, y) = (p % width, p / width);
        let sighting = sightings[usize::from(number)].get_or_insert(Sighting {
            number,
            pixels: 0,
            first: p,
            centre: [0.0; 2],
            bounds: [x, x, y, y],
            displacement: [0.0; 2],
            motion: BACKGROUND,
        });
        sighting.pixels += 1;
        let [left, right, top, bottom] = sighting.bounds;
        sighting.bounds = [left.min(x), right.max(x), top, bottom.max(y)];
        let [u, v] = onward.map_or([0.0; 2], |onward| onward.at(x, y));
        let sums = [[x as f64, y as f64], [u, v]];
        [&mut sighting.centre, &mut sighting.displacement].into_iter().zip(sums).for_each(|(sum, [a, b])| {
            sum[0] += a;
            sum[1] += b;
        });
    }
    let mut sightings: Vec<Sighting> = sightings.into_iter().flatten().collect();
    for sighting in &mut sightings {
        let pixels = sighting.pixels as f64;
        [&mut sighting.centre, &mut sighting.displacement].into_iter().flatten().for_each(|sum| *sum /= pixels);
        let pixels_of = (0..labels.len()).filter(|&p| labels[p] == sighting.number);
        sighting.motion = onward.and_then(|onward| onward.most_frequent(pixels_of)).unwrap_or(BACKGROUND);
    }
    sightings
}
