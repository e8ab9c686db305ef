//! Merging of regions that are one body.
//!
//! Motions are refined on the regions they won during selection, not on their final regions. Two motions that share a body then
//! explain one part of it each. Two cases are common: an object that was found twice, and a dominant motion fitted across an object,
//! which leaves the true background motion to count as another object. To decide whether one motion is enough, one is refined on
//! both regions together.

use super::description::{between, border_penalty, counts, second_motion_penalty, sums, weight_of_pixel};
use super::splitting::aligned_on;
use crate::estimation::alignment::ridge_of_label;
use crate::frame::Plane;
use crate::frame::area::Area;
use crate::labelling::{BACKGROUND, pixels};
use crate::motion::AffineMotion;
use crate::view::cost::{RobustKernel, cost_within};
use crate::view::level::PairLevel;

/// Two labels that are one body, the smaller first, and its motion.
pub(crate) struct Merger {
    pub(crate) labels: [usize; 2],
    pub(crate) motion: AffineMotion,
}

/// The two touching regions whose description a common motion shortens most; `None` if two motions are always better. `raw` as in
/// [`worth`](super::description::worth).
pub(crate) fn best_merger(level: &PairLevel, motions: &[AffineMotion], raw: &[Plane], labels: &[u8]) -> Option<Merger> {
    let width = level.width();
    let pixel = weight_of_pixel(level);
    let between = between(labels, motions.len(), width);
    let (sums, counts) = (sums(raw, labels), counts(labels, motions.len()));
    let mut best: Option<(f64, Merger)> = None;
    for (a, b) in (0..motions.len()).flat_map(|a| (a + 1..motions.len()).map(move |b| (a, b))) {
        let both = |k: usize| sums[a][k] + sums[b][k];
        let better = if both(a) <= both(b) { a } else { b };
        // The dominant motion was refined on nearly the whole frame; one more object would not change it.
        if between[a][b] == 0 || better == BACKGROUND {
            continue;
        }
        let region = pixels(labels, |label| [a, b].contains(&label));
        let mut mask = Plane::filled(width, level.height(), 0.0);
        region.iter().for_each(|&p| mask.values_mut()[p] = 1.0);
        let motion =
            aligned_on(level, &motions[better], &mask, level.model.region_iterations, ridge_of_label(a, level.model));
        let area = Area::of(&region, width);
        let cost = cost_within(level, &area, &motion, RobustKernel::estimation(level.model));
        let together: f64 = region.iter().map(|&p| f64::from(pixel * cost.values()[area.index_of(p, width)])).sum();
        let saved = second_motion_penalty([counts[a], counts[b]]) + border_penalty(between[a][b], level.model);
        let gain = 0.5 * (sums[a][a] + sums[b][b] - together) + saved;
        if gain > best.as_ref().map_or(0.0, |(most, _)| *most) {
            best = Some((gain, Merger { labels: [a, b], motion }));
        }
    }
    best.map(|(_, merger)| merger)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::filter::gaussian;
    use crate::random::Random;
    use crate::view::cost::cost;
    use crate::view::level::build;

    const SIZE: [usize; 2] = [96, 64];

    /// A square that moves by `object` on a background at rest, and which pixels are the square's.
    fn level(object: [f64; 2]) -> (PairLevel, Vec<u8>) {
        let mut random = Random::from_seed(11);
        let mut texture = || {
            let noise = Plane::from_fn(SIZE[0] + 8, SIZE[1] + 8, |_, _| random.uniform(0.0, 255.0) as f32);
            gaussian(&noise, 1.0)
        };
        let (ground, body) = (texture(), texture());
        let square = |x: usize, y: usize| (30..66).contains(&x) && (16..48).contains(&y);
        let frame = |u: usize, v: usize| {
            Plane::from_fn(SIZE[0], SIZE[1], |x, y| {
                let (px, py) = (x.wrapping_sub(u), y.wrapping_sub(v));
                if square(px, py) { body.at(px, py) } else { ground.at(x, y) }
            })
        };
        let second = frame(object[0] as usize, object[1] as usize);
        let labels = (0..SIZE[0] * SIZE[1]).map(|p| u8::from(square(p % SIZE[0], p / SIZE[0]))).collect();
        (build(frame(0, 0), second, 24).remove(0), labels)
    }

    fn merger(level: &PairLevel, motions: &[AffineMotion], labels: &[u8]) -> Option<Merger> {
        let raw: Vec<Plane> = motions.iter().map(|m| cost(level, m, RobustKernel::estimation(level.model))).collect();
        best_merger(level, motions, &raw, labels)
    }

    fn near(motion: &AffineMotion, x: f64, y: f64, flow: [f64; 2]) -> bool {
        let [u, v] = motion.flow(x, y);
        (u - flow[0]).abs() < 0.1 && (v - flow[1]).abs() < 0.1
    }

    #[test]
    fn an_object_found_twice_is_one() {
        let (level, mut labels) = level([2.0, 1.0]);
        labels.iter_mut().enumerate().filter(|(p, l)| **l == 1 && p % SIZE[0] >= 48).for_each(|(_, l)| *l = 2);
        // Each is slightly off, fitted to its own half.
        let one = AffineMotion::new([0.01, 0.0, 1.6, 0.0, 0.0, 1.1]);
        let other = AffineMotion::new([-0.01, 0.0, 2.6, 0.0, 0.0, 0.9]);
        let found = merger(&level, &[AffineMotion::STATIC, one, other], &labels).unwrap();
        assert_eq!(found.labels, [1, 2]);
        assert!(near(&found.motion, 48.0, 32.0, [2.0, 1.0]), "{:?}", found.motion);
    }

    #[test]
    fn the_true_background_replaces_a_dominant_motion_fitted_across_objects() {
        let (level, mut labels) = level([2.0, 1.0]);
        labels.iter_mut().enumerate().filter(|(p, _)| p % SIZE[0] >= 76).for_each(|(_, l)| *l = 2);
        let bent = AffineMotion::new([-0.004, 0.0, 0.6, 0.0, 0.002, 0.3]);
        let motions = [bent, AffineMotion::translation(2.0, 1.0), AffineMotion::translation(0.05, 0.0)];
        let found = merger(&level, &motions, &labels).unwrap();
        assert_eq!(found.labels, [0, 2]);
        assert!(near(&found.motion, 10.0, 10.0, [0.0, 0.0]), "{:?}", found.motion);
    }

    #[test]
    fn bodies_that_move_apart_stay_two() {
        let (level, mut labels) = level([2.0, 1.0]);
        let motions = [AffineMotion::STATIC, AffineMotion::translation(2.0, 1.0)];
        assert!(merger(&level, &motions, &labels).is_none());
        // Nor are regions joined that do not touch, whatever their motions.
        labels.iter_mut().for_each(|l| *l = 0);
        labels[5 * SIZE[0] + 5] = 1;
        labels[40 * SIZE[0] + 80] = 2;
        let motions = [AffineMotion::STATIC, AffineMotion::translation(0.2, 0.0), AffineMotion::translation(0.2, 0.0)];
        assert!(merger(&level, &motions, &labels).is_none());
    }
}
