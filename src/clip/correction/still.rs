//! One object in a single frame: what is said of some pixels goes on along the looks of the object that was found, and along its motion.

use super::constants::constants;
use super::look::Look;
use super::memory::{Memory, Part};
use super::sweep::{BEGINNING, Said, centre_of, logit, solved};
use crate::frame::{Frame, Plane};

/// Odds from which motions decide, nats.
const DECISIVE: f32 = 0.5;

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
    pub(crate) fn mask(&self, said: &[Said], found: &[bool], motion: &Plane) -> Vec<u8> {
        let (look, constants) = (&self.0, constants());
        let shown = look.plane(&|p| if said[p] == Said::Nothing { found[p] } else { said[p] == Said::Object });
        let centre = centre_of(&shown).unwrap_or_else(|| look.middle());
        let mut memory = Memory::of(&shown, &constants);
        memory.learn_said(look, centre, Some(said));
        let doubted = trust_against_motion(said, found, motion);
        for contradicted in [false, true] {
            let weight = if contradicted { doubted } else { 1.0 };
            let of_these = |p: usize| contradicts(found[p], motion.values()[p]) == contradicted;
            memory.learn(look, centre, Part::Found, weight, |p| if of_these(p) { usize::from(!found[p]) } else { 2 });
        }
        let remembered = memory.read(look, &look.area(), centre, &constants);
        let odds = remembered.iter().zip(memory.trusts(look)).enumerate().map(|(p, (remembered, trust))| {
            let (found, motion) = (found[p], motion.values()[p]);
            let weight = if contradicts(found, motion) { doubted } else { 1.0 };
            let found = if found { trust[0] * BEGINNING } else { -trust[1] * BEGINNING };
            weight * found + constants.memory * logit(*remembered) + motion
        });
        solved(look, look.area(), odds.collect(), Some(said), &constants).mask
    }
}

/// How far what was found is trusted where motions contradict it, 0…1: as far as what is said agrees with it there.
fn trust_against_motion(said: &[Said], found: &[bool], motion: &Plane) -> f32 {
    let [mut agrees, mut all] = [0.0f32; 2];
    for ((said, &found), &motion) in said.iter().zip(found).zip(motion.values()) {
        if *said != Said::Nothing && contradicts(found, motion) {
            agrees += f32::from(u8::from(found == (*said == Said::Object)));
            all += 1.0;
        }
    }
    (agrees + 1.0) / (all + 1.0)
}

/// Whether the motions at a pixel clearly contradict what was found there.
fn contradicts(found: bool, motion: f32) -> bool {
    if found { motion < -DECISIVE } else { motion > DECISIVE }
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
        for row in 37..47 {
            said[row * width + 50..row * width + 66].fill(Said::Object);
            said[row * width + 86..row * width + 102].fill(Said::Other);
        }
        let unknown = Plane::filled(width, height, 0.0);
        let found: Vec<bool> = (0..width * height).map(|p| inside(p, 10) || inside(p, 82)).collect();
        let mask = Still(look).mask(&said, &found, &unknown);
        let overlap = |left: usize| {
            let both = (0..mask.len()).filter(|&p| mask[p] == 1 && inside(p, left)).count();
            both as f64 / (24 * 24) as f64
        };
        let [first, second, third] = [10, 46, 82].map(overlap);
        // Colours of a pixel on the border are no longer those of either side.
        assert!(first > 0.97 && second > 0.8 && third < 0.25, "{first}, {second}, {third}");
        assert!(mask.iter().filter(|inside| **inside > 0).count() < 2 * 24 * 24 + 24);
    }
}
