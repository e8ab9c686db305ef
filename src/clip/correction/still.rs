//! One object in a single frame: what is said of some pixels goes on along the looks of the object that was found, and along its motion.

use super::constants::constants;
use super::look::Look;
use super::memory::{Memory, Part};
use super::sweep::{BEGINNING, Said, centre_of, logit, solved};
use crate::frame::{Frame, Plane};

/// A frame at the size at which objects are corrected.
pub(crate) struct Still(Look);

impl Still {
    pub(crate) fn new(frame: &Frame) -> Still {
        Still(Look::new(frame))
    }

    /// Width and height.
    pub(crate) fn size(&self) -> [usize; 2] {
        self.0.size
    }

    /// Full-size pixels for each of these.
    pub(crate) fn step(&self) -> usize {
        self.0.step
    }

    /// The object's mask, 1 inside. `found` is where it was found, and `motion` are its odds from how the pixels move, nats.
    pub(crate) fn mask(&self, said: &[Said], found: &dyn Fn(usize) -> bool, motion: &Plane) -> Vec<u8> {
        let (look, constants) = (&self.0, constants());
        let shown = look.plane(&|p| if said[p] == Said::Nothing { found(p) } else { said[p] == Said::Object });
        let centre = centre_of(&shown).unwrap_or_else(|| look.middle());
        let mut memory = Memory::of(&shown, &constants);
        memory.learn_said(look, centre, Some(said));
        memory.learn(look, centre, Part::Found, 1.0, |p| usize::from(!found(p)));
        let remembered = memory.read(look, &look.area(), centre, &constants);
        let odds = remembered.iter().zip(memory.trusts(look)).enumerate().map(|(p, (remembered, trust))| {
            let found = if found(p) { trust[0] * BEGINNING } else { -trust[1] * BEGINNING };
            found + constants.memory * logit(*remembered) + motion.values()[p]
        });
        solved(look, look.area(), odds.collect(), Some(said), &constants).mask
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stroke_takes_what_looks_and_moves_like_the_object_along() {
        // Three boxes: one was found; strokes say that the second belongs to it as well, and the third does not.
        let size @ [width, height] = [120, 80];
        let inside =
            |p: usize, left: usize| (left..left + 24).contains(&(p % width)) && (30..54).contains(&(p / width));
        let look =
            Look::painted(size, |x, y| match [10, 46, 82].iter().position(|&left| inside(y * width + x, left)) {
                Some(0) => [190, 70, 60],
                Some(1) => [60, 80, 190],
                Some(_) => [200, 190, 60],
                None => [110, 120, 115],
            });
        let mut said = vec![Said::Nothing; width * height];
        said[42 * width + 58..42 * width + 62].fill(Said::Object);
        said[42 * width + 94..42 * width + 98].fill(Said::Other);
        let unknown = Plane::filled(width, height, 0.0);
        let mask = Still(look).mask(&said, &|p| inside(p, 10) || inside(p, 82), &unknown);
        for p in 0..mask.len() {
            assert_eq!(mask[p] == 1, inside(p, 10) || inside(p, 46), "({}, {})", p % width, p / width);
        }
    }
}
