//! A template of an object: its pixels in one frame, and the search for them in other frames.

use super::features::FrameFeatures;
use crate::clip::options::model;
use crate::frame::Plane;
use crate::frame::area::Area;
use crate::frame::filter::gaussian;
use crate::order::median;

/// A shift of an object, pixels of the working size.
pub(super) type Shift = [f32; 2];

/// The object's pixels and their colours.
#[derive(Clone, Debug)]
pub(super) struct Template {
    /// 1 at the object's pixels.
    pub(super) mask: Plane,
    /// The area of these pixels, and all colours in it.
    area: Area,
    colours: Vec<[f32; 3]>,
    samples: Vec<Sample>,
}

/// A pixel of the object with its colours at full size and at a quarter of it.
#[derive(Clone, Debug)]
struct Sample {
    at: [usize; 2],
    fine: [f32; 3],
    coarse: [f32; 3],
}

/// Colours of a pixel.
pub(super) fn at(planes: &[Plane; 3], p: usize) -> [f32; 3] {
    planes.each_ref().map(|plane| plane.values()[p])
}

/// Squared difference of colours relative to the truncation, at most 1.
pub(super) fn difference(one: [f32; 3], other: [f32; 3]) -> f32 {
    let steps: [f32; 3] = std::array::from_fn(|k| one[k] - other[k]);
    (steps.map(|step| step * step).iter().sum::<f32>() / model().truncation).min(1.0)
}

/// Index of the pixel to which (x, y) is shifted, if it is inside.
fn shifted([x, y]: [usize; 2], [dx, dy]: Shift, [width, height]: [usize; 2]) -> Option<usize> {
    let (x, y) = (libm::roundf(x as f32 + dx), libm::roundf(y as f32 + dy));
    let inside = x >= 0.0 && y >= 0.0 && x < width as f32 && y < height as f32;
    inside.then(|| y as usize * width + x as usize)
}

impl Template {
    pub(super) fn new(mask: &Plane, features: &FrameFeatures) -> Template {
        let width = features.size[0];
        let inside: Vec<usize> = (0..features.pixels()).filter(|&p| mask.values()[p] > 0.5).collect();
        let area = if inside.is_empty() { Area::whole(0, 0) } else { Area::of(&inside, width) };
        let colours = area.pixels(width).map(|p| at(&features.fine, p)).collect();
        let of_coarse =
            |p: &usize| (p % width).is_multiple_of(model().coarse) && (p / width).is_multiple_of(model().coarse);
        let corners: Vec<usize> = inside.into_iter().filter(of_coarse).collect();
        let coarse_width = features.coarse[0].width();
        let sample = |&p: &usize| Sample {
            at: [p % width, p / width],
            fine: at(&features.fine, p),
            coarse: at(&features.coarse, p / width / model().coarse * coarse_width + p % width / model().coarse),
        };
        let samples = corners.iter().step_by((corners.len() / model().samples).max(1)).map(sample).collect();
        Template { mask: mask.clone(), area, colours, samples }
    }

    /// The shift of least cost in a wide search around the expected one.
    pub(super) fn nearest(&self, features: &FrameFeatures, expected: Shift) -> Shift {
        let middle = expected.map(|shift| libm::roundf(shift / model().coarse as f32) * model().coarse as f32);
        let size = [features.coarse[0].width(), features.coarse[0].height()];
        let mut cost = |shift: Shift| {
            let of_sample = |sample: &Sample| {
                let to = shifted(
                    sample.at.map(|at| at / model().coarse),
                    shift.map(|shift| shift / model().coarse as f32),
                    size,
                );
                to.map_or(1.0 - model().unseen, |q| difference(sample.coarse, at(&features.coarse, q)))
            };
            self.mean(of_sample)
        };
        let reach = (model().reach / model().coarse) as isize;
        let coarse = best_of(reach, model().coarse as f32, middle, middle, &mut cost).0;
        best_of(model().fine as isize, 1.0, coarse, expected, &mut |shift| self.cost(features, shift, &[])).0
    }

    /// The shift of least cost close to the expected one, and its cost.
    pub(super) fn close(&self, features: &FrameFeatures, expected: Shift) -> (Shift, f32) {
        best_of(model().fine as isize, 1.0, expected, expected, &mut |shift| self.cost(features, shift, &[]))
    }

    /// The shift at which part of the object is seen again near the expected one, `frames` after it was fully visible; `None` if no shift
    /// stands out. `covered` marks the pixels of objects in front.
    pub(super) fn seen_again(
        &self,
        features: &FrameFeatures,
        expected: Shift,
        frames: usize,
        covered: &[bool],
    ) -> Option<Shift> {
        let reach = ((model().fine as f32 + model().drift * frames as f32) as isize)
            .min((model().reach / model().coarse) as isize);
        let mut costs = Vec::new();
        let (best, least) = best_of(reach, 1.0, expected, expected, &mut |shift| {
            costs.push(self.cost(features, shift, covered));
            costs[costs.len() - 1]
        });
        let usual = median(&costs).unwrap_or(0.0);
        (least < 1.0 - model().unseen && usual - least > model().distinct).then_some(best)
    }

    fn cost(&self, features: &FrameFeatures, shift: Shift, covered: &[bool]) -> f32 {
        self.mean(|sample| match shifted(sample.at, shift, features.size) {
            Some(q) if covered.get(q) != Some(&true) => difference(sample.fine, at(&features.fine, q)),
            _ => 1.0 - model().unseen,
        })
    }

    fn mean(&self, of_sample: impl Fn(&Sample) -> f32) -> f32 {
        self.samples.iter().map(of_sample).sum::<f32>() / self.samples.len().max(1) as f32
    }

    /// How much each pixel of a frame looks like the object at this shift, 0…1; 0 where it is covered.
    pub(super) fn alike(&self, features: &FrameFeatures, shift: Shift, covered: &[bool]) -> Plane {
        let mut alike = Plane::filled(features.size[0], features.size[1], 0.0);
        for (at_pixel, q) in self.pixels(shift) {
            if covered.get(q) == Some(&true) {
                continue;
            }
            // The position is known to within a pixel.
            let near = |at: usize, range: &std::ops::Range<usize>| at.max(range.start + 1) - 1..(at + 2).min(range.end);
            let mut least = 1.0f32;
            for y in near(at_pixel[1], &self.area.rows) {
                for x in near(at_pixel[0], &self.area.columns) {
                    let colours = self.colours[self.area.index_of(y * features.size[0] + x, features.size[0])];
                    least = least.min(difference(colours, at(&features.fine, q)) * 2.0);
                }
            }
            alike.values_mut()[q] = 1.0 - least;
        }
        alike
    }

    /// Where the object may be `frames` after it was fully visible, 0…1; 0 where it is covered.
    pub(super) fn around(&self, features: &FrameFeatures, shift: Shift, frames: usize, covered: &[bool]) -> Plane {
        let mut there = vec![false; features.pixels()];
        self.cover(shift, &mut there);
        let wide = gaussian(&features.plane(&|p| there[p]), model().drift * (frames as f32 + 1.0));
        features.plane_of(&|p| if covered[p] { 0.0 } else { (2.0 * wide.values()[p]).min(1.0) })
    }

    /// Marks the pixels of the object at this shift.
    pub(super) fn cover(&self, shift: Shift, covered: &mut [bool]) {
        self.pixels(shift).for_each(|(_, q)| covered[q] = true);
    }

    /// Positions of the object's pixels, each with the index of the pixel to which it is shifted.
    fn pixels(&self, shift: Shift) -> impl Iterator<Item = ([usize; 2], usize)> {
        let size @ [width, _] = [self.mask.width(), self.mask.height()];
        let inside = self.area.pixels(width).filter(|&p| self.mask.values()[p] > 0.5);
        inside.filter_map(move |p| {
            let at = [p % width, p / width];
            shifted(at, shift, size).map(|q| (at, q))
        })
    }
}

/// The shift of least cost on a grid around `middle`, and its cost. Distance from the expected shift is penalised.
fn best_of(
    reach: isize,
    step: f32,
    middle: Shift,
    expected: Shift,
    cost: &mut dyn FnMut(Shift) -> f32,
) -> (Shift, f32) {
    let mut best = (f32::INFINITY, middle, f32::INFINITY);
    for dy in -reach..=reach {
        for dx in -reach..=reach {
            let shift = [middle[0] + step * dx as f32, middle[1] + step * dy as f32];
            let away = [0, 1].map(|k| (shift[k] - expected[k]) / model().coarse as f32);
            let cost = cost(shift);
            let total = cost + model().shift * libm::sqrtf(away[0] * away[0] + away[1] * away[1]);
            if total < best.0 {
                best = (total, shift, cost);
            }
        }
    }
    (best.1, best.2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Random;

    const SIZE: [usize; 2] = [128, 96];

    /// Patches of one coarse texture at the given corners, later ones in front, over grey ground.
    fn features(corners: &[[usize; 2]]) -> FrameFeatures {
        let mut random = Random::from_seed(5);
        let texture: Vec<[u8; 3]> =
            (0..36).map(|_| std::array::from_fn(|_| random.uniform(20.0, 230.0) as u8)).collect();
        FrameFeatures::painted(SIZE, |x, y| {
            let of = |&[left, top]: &[usize; 2]| match (x.checked_sub(left), y.checked_sub(top)) {
                (Some(u), Some(v)) if u < 24 && v < 24 => Some(texture[v / 4 * 6 + u / 4]),
                _ => None,
            };
            corners.iter().rev().find_map(of).unwrap_or([110, 120, 115])
        })
    }

    fn inside(features: &FrameFeatures, [left, top]: [usize; 2]) -> Plane {
        features.plane(&|p| (left..left + 24).contains(&(p % SIZE[0])) && (top..top + 24).contains(&(p / SIZE[0])))
    }

    fn template() -> Template {
        let first = features(&[[16, 20]]);
        Template::new(&inside(&first, [16, 20]), &first)
    }

    #[test]
    fn a_patch_that_reappears_from_behind_a_like_one_is_found() {
        // The patch in front is 10 columns to the left, so 10 columns of the other are visible.
        let here = features(&[[60, 40], [50, 40]]);
        let mut covered = vec![false; here.pixels()];
        template().cover([34.0, 20.0], &mut covered);
        assert_eq!(covered.iter().filter(|covered| **covered).count(), 24 * 24);
        let expected = [42.0, 22.0];
        let shift = template().seen_again(&here, expected, 8, &covered);
        assert_eq!(shift, Some([44.0, 20.0]));
        let alike = template().alike(&here, [44.0, 20.0], &covered);
        let (mut out, mut elsewhere) = (0, 0);
        for (p, alike) in alike.values().iter().enumerate().filter(|(_, alike)| **alike > 0.5) {
            assert!(*alike <= 1.0 && !covered[p]);
            let is_out = (74..84).contains(&(p % SIZE[0])) && (40..64).contains(&(p / SIZE[0]));
            *(if is_out { &mut out } else { &mut elsewhere }) += 1;
        }
        assert!(out > 200 && elsewhere == 0, "{out} of 240, {elsewhere}");
        // Nothing of it is visible.
        assert_eq!(template().seen_again(&features(&[]), expected, 8, &covered), None);
    }

    #[test]
    fn where_it_may_be_grows_with_time() {
        let here = features(&[]);
        let covered: Vec<bool> = (0..here.pixels()).map(|p| p % SIZE[0] < 40).collect();
        let sizes = [1, 8, 20].map(|frames| {
            let around = template().around(&here, [16.0, 20.0], frames, &covered);
            assert!((0..here.pixels()).all(|p| !covered[p] || around.values()[p] == 0.0));
            around.values().iter().filter(|&&share| share > 0.1).count()
        });
        assert!(16 * 24 <= sizes[0] && sizes[0] < sizes[1] && sizes[1] < sizes[2], "{sizes:?}");
    }
}
