//! An object as a whole: where it was last seen whole, and by which shift its pixels are found again, whatever the pairs know of its motion.

use super::constants::Constants;
use super::look::{COARSE, Look};
use crate::clip::evidence::Flow;
use crate::frame::Plane;
use crate::order::median;

/// A shift of an object, pixels of the working size.
pub(super) type Shift = [f32; 2];

/// Pixels of the object that are compared.
const COMPARED: usize = 150;
/// How far around the expected shift, coarse pixels.
const SEARCH: isize = 12;
/// Squared colour difference beyond which it does not matter.
const TRUNCATION: f32 = 600.0;
/// What a pixel outside costs, as a share of that.
const OUTSIDE: f32 = 0.7;
/// Pixels of an object below which it is not searched.
const FEWEST: f32 = 80.0;
/// An object is seen whole while it has this share of the pixels that it had …
const SEEN: f32 = 0.85;
/// … of which this share is expected a frame later.
const SHRINKING: f32 = 0.97;

/// The object where it was last seen whole.
#[derive(Clone, Debug)]
pub(super) struct Whole {
    pub(super) mask: Plane,
    fine: [Plane; 3],
    coarse: [Plane; 3],
    centre: [f32; 2],
    /// From there to the frame that the sweep has reached, and the last step of it.
    shift: Shift,
    step: Shift,
    /// Whether it is seen whole in that frame.
    pub(super) now: bool,
    /// Pixels that it has.
    pixels: f32,
    /// Whether all of its mask was said once; else its pixels may be few because they were too many before.
    known: bool,
}

impl Whole {
    pub(super) fn new(mask: &Plane, look: &Look, centre: [f32; 2], known: bool) -> Whole {
        let pixels = mask.values().iter().sum();
        Whole {
            mask: mask.clone(),
            fine: look.fine.clone(),
            coarse: look.coarse.clone(),
            centre,
            shift: [0.0; 2],
            step: [0.0; 2],
            now: true,
            pixels,
            known,
        }
    }

    /// The object a frame later. While much of it is hidden, it stays what it was, and moves on.
    pub(super) fn gone_on(self, mask: &Plane, look: &Look, centre: [f32; 2], shift: Option<Shift>) -> Whole {
        let pixels: f32 = mask.values().iter().sum();
        let expected = SHRINKING * self.pixels;
        let shift = shift.unwrap_or(self.shift);
        let before = if self.now { [0.0; 2] } else { self.shift };
        let step = [shift[0] - before[0], shift[1] - before[1]];
        if self.known && pixels < SEEN * expected {
            return Whole { shift, step, now: false, pixels: expected, ..self };
        }
        Whole { step, pixels: pixels.max(expected), ..Whole::new(mask, look, centre, self.known) }
    }

    /// The centre of an object that is partly hidden.
    pub(super) fn expected_centre(&self, shift: Option<Shift>) -> Option<[f32; 2]> {
        shift.filter(|_| !self.now).map(|[dx, dy]| [self.centre[0] + dx, self.centre[1] + dy])
    }

    /// The shift from where it was seen whole to a frame; none for an object that is too small. `flow` leads to that frame from the one
    /// before it.
    pub(super) fn shift_to(&self, look: &Look, flow: &Flow, constants: &Constants) -> Option<Shift> {
        let inside: Vec<usize> = (0..look.pixels()).filter(|&p| self.mask.values()[p] > 0.5).collect();
        if (inside.len() as f32) < FEWEST {
            return None;
        }
        let width = look.size[0];
        if !self.now {
            return Some([self.shift[0] + self.step[0], self.shift[1] + self.step[1]]);
        }
        let along = |k: usize| {
            let flows: Vec<f32> = inside.iter().map(|&p| flow.at(p % width, p / width)[k] as f32).collect();
            median(&flows).unwrap_or(0.0)
        };
        Some(self.nearest(look, [along(0), along(1)], constants))
    }

    /// The best shift near the one expected: first of all at a quarter of the size, then around that and around the one expected.
    fn nearest(&self, look: &Look, expected: Shift, constants: &Constants) -> Shift {
        let quarter = expected.map(|shift| shift / COARSE as f32);
        let [coarse, fine] = [(&self.coarse, &look.coarse, COARSE), (&self.fine, &look.fine, 1)]
            .map(|(before, here, side)| Comparison { before, here, pixels: self.pixels_of(before, side) });
        let price = |steps: f32| constants.shift * steps;
        let best = coarse.best(around(quarter, SEARCH), &|shift| price(distance(shift, quarter)));
        let near = best.map(|shift| shift * COARSE as f32);
        let both = around(near, COARSE as isize).chain(around(expected, 1));
        fine.best(both, &|shift| price(distance(shift, expected) / COARSE as f32))
    }

    /// Pixels of the object that are compared, in planes of which a pixel is so many of the working size wide.
    fn pixels_of(&self, [plane, ..]: &[Plane; 3], side: usize) -> Vec<usize> {
        let width = plane.width();
        let is_inside = |&p: &usize| {
            let (x, y) = (p % width * side, p / width * side);
            x < self.mask.width() && y < self.mask.height() && self.mask.at(x, y) > 0.5
        };
        let inside: Vec<usize> = (0..width * plane.height()).filter(is_inside).collect();
        inside.iter().copied().step_by((inside.len() / COMPARED).max(1)).collect()
    }
}

/// Colours of the object before, and of a frame.
struct Comparison<'a> {
    before: &'a [Plane; 3],
    here: &'a [Plane; 3],
    pixels: Vec<usize>,
}

impl Comparison<'_> {
    /// The first of the shifts with the least difference and price.
    fn best(&self, shifts: impl Iterator<Item = [isize; 2]>, price: &dyn Fn(Shift) -> f32) -> Shift {
        let mut best = (f32::INFINITY, [0.0; 2]);
        for at in shifts {
            let shift = at.map(|shift| shift as f32);
            let cost = self.difference(at) + price(shift);
            if cost < best.0 {
                best = (cost, shift);
            }
        }
        best.1
    }

    /// Mean difference of the colours, 0 to 1.
    fn difference(&self, [dx, dy]: [isize; 2]) -> f32 {
        let (width, height) = (self.here[0].width(), self.here[0].height());
        let of_pixel = |&p: &usize| {
            let (x, y) = ((p % width) as isize + dx, (p / width) as isize + dy);
            if x < 0 || y < 0 || x >= width as isize || y >= height as isize {
                return OUTSIDE;
            }
            let q = y as usize * width + x as usize;
            let steps = self.before.iter().zip(self.here).map(|(before, here)| before.values()[p] - here.values()[q]);
            (steps.map(|step| step * step).sum::<f32>() / TRUNCATION).min(1.0)
        };
        self.pixels.iter().map(of_pixel).sum::<f32>() / self.pixels.len().max(1) as f32
    }
}

/// Whole shifts within a distance.
fn around(middle: Shift, reach: isize) -> impl Iterator<Item = [isize; 2]> {
    let [x, y] = middle.map(|shift| libm::roundf(shift) as isize);
    (-reach..=reach).flat_map(move |dy| (-reach..=reach).map(move |dx| [x + dx, y + dy]))
}

fn distance([x, y]: Shift, [u, v]: Shift) -> f32 {
    libm::hypotf(x - u, y - v)
}

#[cfg(test)]
mod tests {
    use super::super::constants::constants;
    use super::*;
    use crate::Random;

    const SIZE: [usize; 2] = [128, 96];

    /// A patch of coarse texture at a place, over grey ground.
    fn look(place: [usize; 2]) -> Look {
        look_behind(place, SIZE[0])
    }

    /// As [`look`], behind what begins at a column.
    fn look_behind([left, top]: [usize; 2], column: usize) -> Look {
        let mut random = Random::from_seed(3);
        let texture: Vec<[u8; 3]> =
            (0..36).map(|_| std::array::from_fn(|_| random.uniform(20.0, 230.0) as u8)).collect();
        Look::painted(SIZE, |x, y| match (x.checked_sub(left), y.checked_sub(top)) {
            _ if x >= column => [30, 30, 90],
            (Some(u), Some(v)) if u < 24 && v < 24 => texture[v / 4 * 6 + u / 4],
            _ => [110, 120, 115],
        })
    }

    fn mask(look: &Look, [left, top]: [usize; 2]) -> Plane {
        let inside = |at: usize, from: usize| (from..from + 24).contains(&at);
        look.plane(&|p| inside(p % SIZE[0], left) && inside(p / SIZE[0], top))
    }

    fn begun() -> Whole {
        let first = look([16, 20]);
        Whole::new(&mask(&first, [16, 20]), &first, [28.0, 32.0], true)
    }

    #[test]
    fn a_patch_that_has_moved_is_found() {
        let still = Flow::still(SIZE);
        for [dx, dy] in [[12, 8], [40, -16], [0, 0]] {
            let here = look([16 + dx, 20 + dy].map(|at: isize| at as usize));
            let shift = begun().shift_to(&here, &still, &constants());
            assert_eq!(shift, Some([dx as f32, dy as f32]), "the pairs know nothing of its motion");
        }
        let small = begun();
        let few = Whole { mask: Plane::filled(SIZE[0], SIZE[1], 0.0), ..small };
        assert_eq!(few.shift_to(&look([16, 20]), &still, &constants()), None);
    }

    #[test]
    fn one_that_is_hidden_moves_on() {
        let (still, gone) = (Flow::still(SIZE), look([200, 200]));
        let seen = look([24, 24]);
        let shift = begun().shift_to(&seen, &still, &constants());
        assert_eq!(shift, Some([8.0, 4.0]));
        let mut whole = begun().gone_on(&mask(&seen, [24, 24]), &seen, [36.0, 36.0], shift);
        assert!(whole.now && whole.expected_centre(shift).is_none());
        // It comes behind something until two thirds of it are left, and then nothing.
        let covered = |p: usize| p % SIZE[0] >= 48;
        let partly = look_behind([32, 28], 48);
        let all = mask(&partly, [32, 28]);
        let left = partly.plane(&|p| all.values()[p] > 0.5 && !covered(p));
        for k in 1..4 {
            let (here, mask) =
                if k == 1 { (&partly, left.clone()) } else { (&gone, Plane::filled(SIZE[0], SIZE[1], 0.0)) };
            let shift = whole.shift_to(here, &still, &constants());
            assert_eq!(shift, Some([8.0 * k as f32, 4.0 * k as f32]), "frame {k}");
            whole = whole.gone_on(&mask, here, [0.0; 2], shift);
            assert!(!whole.now);
            assert_eq!(whole.expected_centre(shift), Some([36.0 + 8.0 * k as f32, 36.0 + 4.0 * k as f32]));
        }
        // What it looked like is kept until it comes out again.
        assert_eq!(whole.mask, mask(&seen, [24, 24]));
        let place = [24 + 32, 24 + 16];
        let out = look(place);
        let shift = whole.shift_to(&out, &still, &constants());
        whole = whole.gone_on(&mask(&out, place), &out, [68.0, 52.0], shift);
        assert!(whole.now);
        assert_eq!(whole.mask, mask(&out, place));
    }
}
