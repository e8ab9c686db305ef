//! An object as last seen, and where it is expected.

use super::sight::{Sight, is_still, mean_motion, moves};
use crate::clip::record::Record;

// The constants below were set by hand on ten real clips and on tests/clip.rs, and were not varied, except as said.

/// Share of its pixels that must be in sight to tell how an object moves.
const MOVING: f64 = 0.3;
/// Share of its pixels from which an object is in full sight.
const WHOLE: f64 = 0.95;
/// What is left of its full size in every frame in which less is in sight: objects also become smaller by moving away.
const SHRINKING: f64 = 0.98;
/// Frames for which an object may be hidden and keep its number. 16 gains nothing on five generated clips.
const LONGEST_HIDDEN: usize = 10;
/// What was hidden of an object is looked for this far from where its motion leads, in roots of its size, …
const SEARCH: f64 = 1.5;
/// … and this share of that farther for each frame in which it was hidden.
const SEARCH_GROWTH: f64 = 0.1;
/// A part of an object in sight moves like it, to within this many working pixels …
const SAME_MOTION: f64 = 1.0;
/// … and this share of its displacement.
const SAME_SPEED: f64 = 0.25;

/// An object.
#[derive(Clone, Debug)]
pub(crate) struct Object {
    pub(crate) number: u8,
    /// Where it was last seen whole, moved on with it since.
    pub(crate) whole: Sight,
    /// Pixels in sight in the last frame.
    in_sight: f64,
    /// Frames since it was seen.
    pub(crate) hidden: usize,
    /// How far its largest pieces have moved relative to each other since they came apart, working pixels.
    pub(crate) apart: [f64; 2],
}

impl Object {
    pub(crate) fn new(number: u8, whole: Sight) -> Object {
        Object { number, in_sight: whole.size, whole, hidden: 0, apart: [0.0; 2] }
    }

    /// One frame further.
    pub(crate) fn move_on(&mut self) {
        let Sight { centre, velocity, .. } = &mut self.whole;
        *centre = [centre[0] + velocity[0], centre[1] + velocity[1]];
    }

    /// What the next frame shows of it.
    pub(crate) fn see(&mut self, record: &Record, pixels: &[usize]) {
        self.in_sight = pixels.len() as f64;
        self.hidden = if pixels.is_empty() { self.hidden + 1 } else { 0 };
        if pixels.is_empty() {
            return;
        }
        let sight = Sight::of(record, pixels);
        let whole = !self.is_covered();
        // The little that is in sight may pass for background in its pairs.
        let shown = whole || (self.in_sight >= MOVING * self.whole.size && moves(record, pixels));
        let velocity = steady(record, pixels).filter(|_| shown).unwrap_or(self.whole.velocity);
        if whole {
            self.whole = Sight { velocity, ..sight };
        } else {
            self.whole.velocity = velocity;
            self.whole.size *= SHRINKING;
        }
    }

    /// Whether less of it was in sight than there is.
    pub(crate) fn is_covered(&self) -> bool {
        self.in_sight < WHOLE * self.whole.size
    }

    /// Whether it may come back.
    pub(crate) fn is_remembered(&self) -> bool {
        self.hidden <= LONGEST_HIDDEN
    }

    pub(crate) fn moves_like(&self, sight: &Sight) -> bool {
        same(sight.velocity, self.whole.velocity)
    }

    /// Whether a place is near where it is expected.
    pub(crate) fn is_near(&self, [x, y]: [f64; 2]) -> bool {
        let [a, b] = self.whole.centre;
        let reach = SEARCH * self.whole.size.sqrt() * (1.0 + SEARCH_GROWTH * self.hidden as f64);
        ((x - a) * (x - a) + (y - b) * (y - b)).sqrt() < reach
    }
}

/// The velocity of some pixels if both pairs of the frame agree on it. What is being covered has no counterpart in the next frame, what
/// comes out has none in the frame before, and a repeated frame shows no motion.
fn steady(record: &Record, pixels: &[usize]) -> Option<[f64; 2]> {
    let (onward, back) = (record.onward.as_ref()?, record.back.as_ref()?);
    let (to, from) = (mean_motion(onward, pixels), mean_motion(back, pixels).map(|v| -v));
    (!is_still(onward) && !is_still(back) && same(to, from)).then_some(from)
}

/// Whether one displacement is like another.
fn same([u, v]: [f64; 2], [r, s]: [f64; 2]) -> bool {
    ((u - r) * (u - r) + (v - s) * (v - s)).sqrt() < SAME_MOTION + SAME_SPEED * (r * r + s * s).sqrt()
}
