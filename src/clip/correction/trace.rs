//! Traces each pixel back to the frame in which a person annotated an object, and reads the object's mask there.
//!
//! The motions from frame to frame add up to a position in the annotated frame. Each step moves it to where the surrounding colours agree
//! best, so that errors do not add up. The better they agree, the more the mask counts. Masks of the frames in between are not used, so
//! their mistakes are not carried on.

use super::features::FrameFeatures;
use super::proposal::logit;
use super::template::{at, difference};
use crate::clip::options::model;
use crate::clip::pairs::LayeredMotion;
use crate::frame::Plane;
use crate::frame::area::Area;
use crate::frame::filter::gaussian;
use crate::frame::warp::Footprint;

#[derive(Clone, Debug)]
pub(super) struct Trace {
    /// Share of the object at each pixel of the annotated frame, 0…1, and the colours there.
    mask: Plane,
    colours: [Plane; 3],
    /// Column and row in the annotated frame for each pixel of the current frame.
    places: [Plane; 2],
    /// Whether each pixel has been visible ever since.
    was_seen: Vec<bool>,
}

impl Trace {
    /// Begins in the annotated frame.
    pub(super) fn new(mask: &Plane, features: &FrameFeatures) -> Trace {
        let [width, height] = features.size;
        let places = [0, 1].map(|k| Plane::from_fn(width, height, |x, y| [x, y][k] as f32));
        let was_seen = vec![true; features.pixels()];
        Trace { mask: gaussian(mask, model().blur), colours: features.fine.clone(), places, was_seen }
    }

    /// Advances to the next frame, given its motion to the previous frame and the motion from there. Returns the log-odds of the object at
    /// the pixels of an area, nats.
    pub(super) fn follow(
        &mut self,
        features: &FrameFeatures,
        [to, from]: [&LayeredMotion; 2],
        area: &Area,
    ) -> Vec<f32> {
        let (size @ [width, _], pixels) = (features.size, features.pixels());
        let places: Vec<[f32; 2]> = (0..pixels).map(|p| self.place_before(to, [p % width, p / width], size)).collect();
        self.places = [0, 1].map(|k| features.plane_of(&|p| places[p][k]));
        let was_seen = |p: usize| source(to, from, [p % width, p / width]).is_some_and(|before| self.was_seen[before]);
        self.was_seen = (0..pixels).map(was_seen).collect();
        let mut least = self.disagreement(features, area, [0, 0]);
        let mut steps = [0, 1].map(|_| Plane::filled(area.width(), area.height(), 0.0));
        for step in (0..9).map(|k| [k % 3 - 1, k / 3 - 1]).filter(|step| *step != [0, 0]) {
            let other = self.disagreement(features, area, step);
            for (k, (least, other)) in least.values_mut().iter_mut().zip(other.values()).enumerate() {
                if other < least {
                    *least = *other;
                    [0, 1].iter().for_each(|&axis| steps[axis].values_mut()[k] = step[axis] as f32);
                }
            }
        }
        for (places, steps) in self.places.iter_mut().zip(&steps) {
            let smooth = gaussian(steps, model().border);
            area.pixels(width).zip(smooth.values()).for_each(|(p, step)| places.values_mut()[p] += step);
        }
        let disagreement = self.disagreement(features, area, [0, 0]);
        area.pixels(width).zip(disagreement.values()).map(|(p, &d)| self.log_odds(p, d, size)).collect()
    }

    /// The position of a pixel of the next frame in the annotated frame, extrapolated beyond the border.
    fn place_before(&self, to: &LayeredMotion, [x, y]: [usize; 2], size: [usize; 2]) -> [f32; 2] {
        let [u, v] = to.at(x, y);
        let before = [x as f32 + u as f32, y as f32 + v as f32];
        let footprint = Footprint::new(before[0], before[1], size[0], size[1]);
        [0, 1].map(|k| {
            let beyond = before[k] - before[k].max(0.0).min(size[k] as f32 - 1.0);
            footprint.sample(self.places[k].values()) + beyond
        })
    }

    /// Mean colour difference around each pixel of an area at its position plus a step, 0…1.
    fn disagreement(&self, features: &FrameFeatures, area: &Area, step: [isize; 2]) -> Plane {
        let [width, height] = features.size.map(|side| side as isize);
        let of = |p: usize| {
            let [x, y] = [0, 1].map(|k| libm::roundf(self.places[k].values()[p]) as isize + step[k]);
            let is_inside = (0..width).contains(&x) && (0..height).contains(&y);
            if is_inside { difference(at(&features.fine, p), at(&self.colours, (y * width + x) as usize)) } else { 1.0 }
        };
        let differences = area.pixels(features.size[0]).map(of).collect();
        gaussian(&Plane::from_vec(area.width(), area.height(), differences), model().border)
    }

    fn log_odds(&self, p: usize, disagreement: f32, [width, height]: [usize; 2]) -> f32 {
        let place = self.places.each_ref().map(|places| places.values()[p]);
        let log_odds = logit(Footprint::new(place[0], place[1], width, height).sample(self.mask.values()));
        let weight = (1.0 - 2.0 * disagreement).max(0.0);
        // A pixel that came into sight was behind the object if its position is inside the mask.
        weight * if self.was_seen[p] { log_odds } else { log_odds.min(0.0) }
    }
}

/// Index of the pixel of the previous frame from which a pixel came, if the motion from there leads back.
fn source(to: &LayeredMotion, from: &LayeredMotion, [x, y]: [usize; 2]) -> Option<usize> {
    let (step, [px, py]) = (to.at(x, y), to.destination(x, y)?);
    let back = from.at(px, py);
    let length = |of: [f64; 2]| (of[0] * of[0] + of[1] * of[1]).sqrt();
    let tolerance = f64::from(model().same_motion) + f64::from(model().same_relative_motion) * length(step);
    (length([step[0] + back[0], step[1] + back[1]]) < tolerance).then_some(py * to.width + px)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Random;
    use crate::clip::annotation::{Direction, Seed, Spread};
    use crate::clip::correction::group::{Group, Scene};
    use crate::clip::correction::plan::Anchor;
    use crate::clip::correction::track::Track;
    use crate::motion::AffineMotion;

    const SIZE: [usize; 2] = [128, 72];
    /// Columns and rows of a car and of its shadow in the first frame. Both have one colour and move right by two pixels per frame.
    const CAR: [std::ops::Range<usize>; 2] = [20..44, 20..36];
    const SHADOW: [std::ops::Range<usize>; 2] = [20..44, 36..48];

    fn is_at([columns, rows]: &[std::ops::Range<usize>; 2], t: usize, x: usize, y: usize) -> bool {
        x.checked_sub(2 * t).is_some_and(|x| columns.contains(&x)) && rows.contains(&y)
    }

    /// Spots move with the pixels, dark ones on the car and the shadow, bright ones on the ground.
    fn features(t: usize) -> FrameFeatures {
        let mut random = Random::from_seed(3);
        let spots: Vec<u8> = (0..SIZE[0] * SIZE[1]).map(|_| random.uniform(0.0, 60.0) as u8).collect();
        FrameFeatures::painted(SIZE, |x, y| match is_at(&CAR, t, x, y) || is_at(&SHADOW, t, x, y) {
            true => [40 + spots[y / 3 * SIZE[0] + (x - 2 * t) / 3]; 3],
            false => [130 + spots[y / 3 * SIZE[0] + x / 3]; 3],
        })
    }

    /// The motion as a pair of frames measures it.
    fn flow(t: usize, step: f64) -> LayeredMotion {
        let is_moving = |p: usize| [&CAR, &SHADOW].iter().any(|of| is_at(of, t, p % SIZE[0], p / SIZE[0]));
        LayeredMotion {
            width: SIZE[0],
            labels: (0..SIZE[0] * SIZE[1]).map(|p| u8::from(is_moving(p))).collect(),
            motions: vec![AffineMotion::STATIC, AffineMotion::translation(step, 0.0)],
            measured: true,
        }
    }

    #[test]
    fn pixels_are_followed_to_the_annotated_frame() {
        let first = features(0);
        let mut trace = Trace::new(&first.plane(&|p| is_at(&CAR, 0, p % SIZE[0], p / SIZE[0])), &first);
        let mut log_odds = Vec::new();
        for t in 1..=20 {
            let here = features(t);
            log_odds = trace.follow(&here, [&flow(t, -2.0), &flow(t - 1, 2.0)], &here.area());
        }
        let at = |x: usize, y: usize| log_odds[y * SIZE[0] + x];
        assert!(at(40 + 32, 28) > 3.0, "the car, {}", at(72, 28));
        assert!(at(40 + 32, 43) < -3.0, "its shadow, {}", at(72, 43));
        assert!(at(110, 28) < -3.0, "ground, {}", at(110, 28));
        // The car hid it at first.
        assert!(at(30, 28) <= 0.0, "what came into sight, {}", at(30, 28));
    }

    #[test]
    fn what_a_whole_mask_leaves_out_stays_out() {
        let shares = [true, false].map(|is_whole| {
            let anchor = Anchor { frame: 0, spread: Spread::Both, is_whole };
            let mut group = Group { tracks: vec![Track::new(1, vec![anchor], 21)], changing: vec![1] };
            let mut in_shadow = 0;
            for t in 0..=20 {
                let (here, to, from) = (features(t), flow(t, -2.0), flow(t.saturating_sub(1), 2.0));
                let seed = |p: usize| if is_at(&CAR, 0, p % SIZE[0], p / SIZE[0]) { Seed::Object } else { Seed::Other };
                let seeds = |_: u8| (t == 0).then(|| ((0..here.pixels()).map(seed).collect(), Spread::Both));
                let flows = (t > 0).then_some([&to, &from]);
                // The car and its shadow were found as one object.
                let scene = Scene { features: &here, seeds: &seeds, seen: &|_| None, found: &to.labels, flows };
                let proposals = group.visit(t, Direction::Forward, false, &scene);
                let proposal = proposals[0].1.as_ref().unwrap();
                let pixels = proposal.area.pixels(SIZE[0]).zip(&proposal.mask).filter(|(_, inside)| **inside > 0);
                in_shadow = pixels.filter(|(p, _)| is_at(&SHADOW, t, p % SIZE[0], p / SIZE[0])).count();
            }
            in_shadow
        });
        assert!(shares[0] < 30 && shares[1] > 60, "{shares:?} of 288 pixels");
    }
}
