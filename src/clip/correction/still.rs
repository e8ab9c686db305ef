//! One object in a single frame: what is said of some pixels goes on along the looks of the object that was found, and along its motion.

use super::appearance::{AppearanceModel, Source};
use super::features::FrameFeatures;
use super::proposal::{Proposal, centre_of, logit};
use super::strokes;
use crate::clip::annotation::Seed;
use crate::clip::options::{MAX_LOOK_AHEAD, model};
use crate::frame::filter::gaussian;
use crate::frame::{Frame, Plane};
use crate::labelling::solver::Solver;

/// A frame at the size at which objects are corrected.
pub(crate) struct Still(FrameFeatures);

impl Still {
    pub(crate) fn new(frame: &Frame) -> Still {
        Still(FrameFeatures::new(frame))
    }

    /// Width and height.
    pub(crate) fn size(&self) -> [usize; 2] {
        self.0.size
    }

    /// Full-size pixels for each of these.
    pub(crate) fn step(&self) -> usize {
        self.0.scaling.step
    }

    /// The labels of least energy, given the price of each at every pixel.
    pub(crate) fn labels(&self, costs: &[Plane]) -> Vec<u8> {
        let (features, smoothness) = (&self.0, model().smoothness);
        features.borders.times(smoothness).solve(costs, Solver::FAST)
    }

    /// The object's mask, 1 inside. `found` is where it was found, and `motion` are its odds from how the pixels move, nats. Only what is
    /// connected with something said changes.
    pub(crate) fn mask(&self, said: &[Seed], found: &[bool], motion: &Plane) -> Vec<u8> {
        let features = &self.0;
        let shown = features.plane(&|p| if said[p] == Seed::Nothing { found[p] } else { said[p] == Seed::Object });
        let centre = centre_of(&shown).unwrap_or_else(|| features.middle());
        let mut appearance = AppearanceModel::of(&shown);
        appearance.learn_seeds(features, centre, Some(said));
        // Where the motions clearly contradict what was found, what is said decides between them.
        let smooth = gaussian(motion, model().border);
        let is_doubted: Vec<bool> = found.iter().zip(smooth.values()).map(|(f, m)| contradicts(*f, *m)).collect();
        let trust = trust(said, found, &is_doubted);
        let presumed = |p: usize| if is_doubted[p] && trust < 0.0 { !found[p] } else { found[p] };
        // As much as frames of a clip in which an object was found.
        let found_weight = model().automatic * MAX_LOOK_AHEAD as f32;
        for (doubted, weight) in [(false, found_weight), (true, found_weight * trust.abs())] {
            let side = |p: usize| if is_doubted[p] == doubted { usize::from(!presumed(p)) } else { 2 };
            appearance.learn(features, centre, Source::Found, weight, &side);
        }
        let remembered = appearance.read(features, &features.area(), centre);
        let odds =
            remembered.iter().zip(appearance.trusts(features)).enumerate().map(|(p, (remembered, of_colour))| {
                let presumed = if presumed(p) { of_colour[0] * model().found } else { -of_colour[1] * model().found };
                let weight = if is_doubted[p] { trust.abs() } else { 1.0 };
                weight * presumed + model().memory * logit(*remembered) + motion.values()[p]
            });
        let mut mask = Proposal::solved(features, features.area(), odds.collect(), Some(said)).mask;
        let found: Vec<u8> = found.iter().map(|&inside| u8::from(inside)).collect();
        strokes::keep(&mut mask, &found, said, features.size[0]);
        mask
    }
}

/// How far what was found is trusted where it is doubted: from 1, where what is said agrees with it there, to −1.
fn trust(said: &[Seed], found: &[bool], is_doubted: &[bool]) -> f32 {
    let [mut sum, mut all] = [0.0f32; 2];
    for p in (0..said.len()).filter(|&p| is_doubted[p] && said[p] != Seed::Nothing) {
        sum += if found[p] == (said[p] == Seed::Object) { 1.0 } else { -1.0 };
        all += 1.0;
    }
    if all > 0.0 { sum / all } else { 1.0 }
}

/// Whether the motions at a pixel clearly contradict what was found there.
fn contradicts(found: bool, motion: f32) -> bool {
    if found { motion < -model().contradiction } else { motion > model().contradiction }
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
        let features = FrameFeatures::painted(size, |x, y| {
            match [10, 46, 82].iter().position(|&left| inside(y * width + x, left)) {
                Some(0) => [190, 70, 60],
                Some(1) => [60, 80, 190],
                Some(_) => [200, 190, 60],
                None => [110, 120, 115],
            }
        });
        let mut said = vec![Seed::Nothing; width * height];
        for row in 37..47 {
            said[row * width + 50..row * width + 66].fill(Seed::Object);
            said[row * width + 86..row * width + 102].fill(Seed::Other);
        }
        let unknown = Plane::filled(width, height, 0.0);
        let found: Vec<bool> = (0..width * height).map(|p| inside(p, 10) || inside(p, 82)).collect();
        let mask = Still(features).mask(&said, &found, &unknown);
        // Colours of pixels near a border are those of neither side.
        let inner =
            |p: usize, left: usize| (left + 3..left + 21).contains(&(p % width)) && (33..51).contains(&(p / width));
        let share = |left: usize| {
            let own = (0..mask.len()).filter(|&p| inner(p, left));
            own.map(|p| f64::from(mask[p])).sum::<f64>() / 324.0
        };
        let [first, second, third] = [10, 46, 82].map(share);
        assert!(first > 0.99 && second > 0.99 && third < 0.01, "{first}, {second}, {third}");
        let is_ground = |p: &usize| ![10, 46, 82].iter().any(|&left| inside(*p, left));
        assert!((0..mask.len()).filter(is_ground).filter(|&p| mask[p] > 0).count() < 24);
    }
}
