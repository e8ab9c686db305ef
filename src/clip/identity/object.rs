//! An object as it was last seen, and where it is expected.

use super::sight::{Sight, mean_motion, moves};
use crate::clip::options::model;
use crate::clip::pairs::LayeredMotion;
use crate::clip::record::Record;
use crate::labelling::BACKGROUND;

/// Frames for which a hidden object is remembered.
const REMEMBERED: usize = 16;

/// An object.
#[derive(Clone, Debug)]
pub(crate) struct Object {
    pub(crate) number: u8,
    /// As it was last completely visible, moved on since then.
    pub(crate) whole: Sight,
    /// Number of visible pixels in the last frame.
    in_sight: f64,
    /// Number of frames since it was last seen.
    pub(crate) hidden: usize,
    /// How its two largest pieces have moved since they came apart.
    pub(crate) apart: Apart,
}

/// How two pieces of an object have moved relative to each other.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Apart {
    /// Displacement of the second relative to the first, working pixels.
    moved: [f64; 2],
    /// Frames in a row in which they had different motions.
    pub(crate) frames: usize,
}

impl Apart {
    /// Adds a frame.
    pub(crate) fn add(&mut self, along: &LayeredMotion, one: &[usize], other: &[usize]) {
        let [u, v] = mean_motion(along, one);
        let [r, s] = mean_motion(along, other);
        self.moved = [self.moved[0] + r - u, self.moved[1] + s - v];
        // Pieces of a rotating body have different displacements, but one motion.
        let differs = |(one, other): (&[usize], &[usize])| {
            let motion = along.motions[along.most_frequent(one.iter().copied()).unwrap_or(BACKGROUND)];
            let n = other.len() as f64;
            let place = |p: usize| ((p % along.width) as f64, (p / along.width) as f64);
            let [x, y] = other.iter().map(|&p| place(p)).fold([0.0; 2], |[a, b], (x, y)| [a + x / n, b + y / n]);
            let ([u, v], [r, s]) = (motion.flow(x, y), mean_motion(along, other));
            let [a, b] = along.motions[BACKGROUND].flow(x, y);
            let (difference, own) = (libm::hypot(u - r, v - s), libm::hypot(r - a, s - b));
            difference > f64::from(model().same_motion) && difference > f64::from(model().same_relative_motion) * own
        };
        self.frames = if differs((one, other)) && differs((other, one)) { self.frames + 1 } else { 0 };
    }

    /// How far they have moved relative to each other, working pixels.
    pub(crate) fn distance(&self) -> f64 {
        libm::hypot(self.moved[0], self.moved[1])
    }
}

impl Object {
    pub(crate) fn new(number: u8, whole: Sight) -> Object {
        Object { number, in_sight: whole.size, whole, hidden: 0, apart: Apart::default() }
    }

    /// Moves the expected position on by one frame.
    pub(crate) fn move_on(&mut self) {
        let Sight { centre, velocity, .. } = &mut self.whole;
        *centre = [centre[0] + velocity[0], centre[1] + velocity[1]];
    }

    /// Updates the object by its pixels in the next frame.
    pub(crate) fn see(&mut self, record: &Record, pixels: &[usize]) {
        self.in_sight = pixels.len() as f64;
        self.hidden = if pixels.is_empty() { self.hidden + 1 } else { 0 };
        if pixels.is_empty() {
            return;
        }
        let sight = Sight::of(record, pixels);
        let whole = !self.is_covered();
        // The smaller the visible part, the more of it passes for background, or for the object in front.
        let shown = whole || (2.0 * self.in_sight > self.whole.size && moves(record, pixels));
        let velocity = steady(record, pixels).filter(|_| shown).unwrap_or(self.whole.velocity);
        if whole {
            self.whole = Sight { velocity, ..sight };
        } else {
            self.whole.velocity = velocity;
            self.whole.size *= f64::from(model().shrinking);
        }
    }

    /// Whether clearly less of it is visible than it has.
    pub(crate) fn is_covered(&self) -> bool {
        self.in_sight < (1.0 - f64::from(model().hidden)) * self.whole.size
    }

    /// Whether it was seen recently enough to come back.
    pub(crate) fn is_remembered(&self) -> bool {
        self.hidden <= REMEMBERED
    }

    pub(crate) fn moves_like(&self, sight: &Sight) -> bool {
        same(sight.velocity, self.whole.velocity)
    }

    /// Whether a position is near the expected one.
    pub(crate) fn is_near(&self, [x, y]: [f64; 2]) -> bool {
        let [a, b] = self.whole.centre;
        let reach =
            model().search * self.whole.size.sqrt() * (1.0 + f64::from(model().search_growth) * self.hidden as f64);
        ((x - a) * (x - a) + (y - b) * (y - b)).sqrt() < reach
    }
}

/// The velocity of some pixels if both pairs of the frame agree on it. They do not where pixels are being covered, and so have no
/// counterpart in the next frame, where pixels come out, and so have none in the previous one, and in repeated frames, which show no
/// motion.
fn steady(record: &Record, pixels: &[usize]) -> Option<[f64; 2]> {
    let (onward, back) = (record.onward.as_ref()?, record.back.as_ref()?);
    let (to, from) = (mean_motion(onward, pixels), mean_motion(back, pixels).map(|v| -v));
    (!onward.is_still() && !back.is_still() && same(to, from)).then_some(from)
}

/// Whether the first displacement is like the second.
fn same([u, v]: [f64; 2], [r, s]: [f64; 2]) -> bool {
    ((u - r) * (u - r) + (v - s) * (v - s)).sqrt()
        < f64::from(model().same_motion) + f64::from(model().same_relative_motion) * (r * r + s * s).sqrt()
}
