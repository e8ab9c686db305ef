//! Shadows that objects cast on the ground.
//!
//! A shadow moves with its object, so the object's motion explains it. But only the light moves: the ground beneath stays where it is, with
//! its texture and its colours. A pixel of an object is given back to the background where a smooth change of light explains it and its
//! colour is one of the ground.
//!
//! ```text
//! d(x)  = I2(x + B x) − I1(x)              difference along the background's motion B
//! d̄(x)  = mean of d around x               the change of light, from pixels that it explains
//! E(l)  = Σ ρ(own motion)                          over the pixels that stay with their object
//!       + Σ ρ(d − d̄) + P + ln p(c | object)/p(c | ground)    over those given back
//!       + edges
//! ```
//! p(c | object) is learned from the pixels of objects that no change of light explains. p(c | ground) is that of c or of the colour a step
//! brighter, whichever is larger: the ground is darker in a shadow.

use super::solver::Solver;
use super::terms::smoothness::EdgeWeights;
use super::{BACKGROUND, is_background, objects};
use crate::frame::Plane;
use crate::frame::filter::gaussian;
use crate::frame::palette::{COLOURS, Palette, brighter};
use crate::frame::warp::warp;
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::side::Side;
use crate::view::cost::{RobustKernel, cost};
use crate::view::level::PairLevel;

/// Cost that keeps every pixel of the background.
const NEVER: f32 = 100.0;

/// Gives shadows of objects, in labels of the working size, back to the background. `edge_weights` are those of the labels.
pub(crate) fn return_shadows(
    level: &PairLevel,
    palette: &Palette,
    edge_weights: &EdgeWeights,
    motions: &[AffineMotion],
    labels: &mut [u8],
    solver: Solver,
) {
    let lit = cost_of_light(level, &motions[BACKGROUND]);
    let Some(ratios) = colour_ratios(palette, labels, &lit, level.model) else { return };
    let (width, height) = (level.width(), level.height());
    let mut given_back = Plane::filled(width, height, 0.0);
    let mut kept = Plane::filled(width, height, NEVER);
    for k in objects(motions.len()) {
        let own = cost(level, &motions[k], RobustKernel::labels(level.model));
        let values = kept.values_mut().iter_mut().zip(given_back.values_mut()).zip(own.values()).zip(lit.values());
        for (p, (((kept, given_back), own), lit)) in values.enumerate().filter(|(p, _)| usize::from(labels[*p]) == k) {
            (*kept, *given_back) = (*own, lit + level.model.light_penalty + ratios[palette.index(p)]);
        }
    }
    let found = edge_weights.solve(&[given_back, kept], solver);
    for (label, kept) in labels.iter_mut().zip(&found) {
        if is_background(*kept) {
            *label = BACKGROUND as u8;
        }
    }
}

/// Cost of the background's motion at every pixel, with a smooth change of light.
fn cost_of_light(level: &PairLevel, background: &AffineMotion) -> Plane {
    let (model, window) = (RobustKernel::labels(level.model), level.model.light_window);
    let mut difference = warp(&level.second, &level.scaled(background));
    difference.values_mut().iter_mut().zip(level.first.values()).for_each(|(second, first)| *second -= first);
    let (noise, position) = (level.noise * level.noise, level.model.position_variance());
    let mut weights = Plane::filled(level.width(), level.height(), 1.0);
    let mut costs = weights.clone();
    for _ in 0..level.model.light_iterations {
        let mut weighted = difference.clone();
        weighted.values_mut().iter_mut().zip(weights.values()).for_each(|(difference, weight)| *difference *= weight);
        let (sums, totals) = (gaussian(&weighted, window), gaussian(&weights, window));
        for (p, (cost, weight)) in costs.values_mut().iter_mut().zip(weights.values_mut()).enumerate() {
            let residual =
                difference.values()[p] - sums.values()[p] / totals.values()[p].max(level.model.smallest_weight);
            let square = residual * residual / (noise + position * level.energy.values()[p]);
            *cost = square / (1.0 + square / model.truncation);
            let explained = 1.0 - *cost / model.truncation;
            *weight = explained * explained;
        }
    }
    costs
}

/// Log-likelihood ratio of object against ground for every colour, nats; `None` where there are too few pixels to learn from.
fn colour_ratios(palette: &Palette, labels: &[u8], lit: &Plane, model: &Model) -> Option<Vec<f32>> {
    let mut counts = vec![[0.0f32; 2]; COLOURS];
    let mut totals = [0.0f32; 2];
    let unexplained = RobustKernel::labels(model).outside();
    for (p, (&label, &lit)) in labels.iter().zip(lit.values()).enumerate() {
        let side = Side::object_if(!is_background(label));
        if side == Side::Ground || lit >= unexplained {
            counts[palette.index(p)][side] += 1.0;
            totals[side] += 1.0;
        }
    }
    let (ground, object) = (totals[Side::Ground], totals[Side::Object]);
    let (prior, most) = (model.colour_prior, model.largest_cost());
    let ratio = |(colour, count): (usize, &[f32; 2])| {
        let of_ground = count[Side::Ground];
        let of_ground =
            brighter(colour).map_or(of_ground, |brighter| f32::max(of_ground, counts[brighter][Side::Ground]));
        libm::logf((count[Side::Object] / object + prior) / (of_ground / ground + prior)).clamp(-most, most)
    };
    (ground >= model.fewest_of_colours as f32 && object >= model.fewest_of_colours as f32)
        .then(|| counts.iter().enumerate().map(ratio).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Frame;
    use crate::frame::scaling::Scaling;
    use crate::view::level::build;

    const SIZE: [usize; 2] = [120, 80];

    /// A textured object of one colour moves 3 pixels to the right over a textured ground of another, under a light that changes below it.
    /// All of it is labelled as the object.
    fn scene(shadow_colour: [f32; 3]) -> (PairLevel, Palette, Vec<u8>) {
        let [width, height] = SIZE;
        let texture = |x: f32, y: f32| 20.0 * libm::sinf(0.9 * x + 0.4 * y) * libm::cosf(0.7 * y - 0.3 * x);
        let thing = |x: f32, y: f32| (40.0..70.0).contains(&x) && (20.0..40.0).contains(&y);
        let shadow = |x: f32, y: f32| (40.0..70.0).contains(&x) && (40.0..60.0).contains(&y);
        let luminance = |x: usize, y: usize, t: f32| {
            let (x, y) = (x as f32, y as f32);
            let dark = libm::expf(-((x - 55.0 - 3.0 * t) * (x - 55.0 - 3.0 * t) + (y - 50.0) * (y - 50.0)) / 120.0);
            match thing(x - 3.0 * t, y) {
                true => 150.0 + texture(1.3 * (x - 3.0 * t), y),
                false => 110.0 + texture(x, y) - 60.0 * dark,
            }
        };
        let frame = |t: f32| Plane::from_fn(width, height, |x, y| luminance(x, y, t));
        let level = build(frame(0.0), frame(1.0), 1000).remove(0);
        let colours: Vec<u8> = (0..width * height)
            .flat_map(|p| {
                let (x, y) = ((p % width) as f32, (p / width) as f32);
                let of = if thing(x, y) {
                    [1.0, 0.3, 0.3]
                } else if shadow(x, y) {
                    shadow_colour
                } else {
                    [0.4, 0.5, 0.4]
                };
                let [r, g, b] = of.map(|share| (200.0 * share) as u8);
                [r, g, b, 255]
            })
            .collect();
        let palette =
            Palette::new(&Frame::from_rgba(width, height, &colours).unwrap(), &Scaling::halved([width, height], 0));
        let labels = (0..width * height).map(|p| {
            let (x, y) = ((p % width) as f32, (p / width) as f32);
            u8::from(thing(x, y) || shadow(x, y))
        });
        (level, palette, labels.collect())
    }

    fn returned(shadow_colour: [f32; 3]) -> [usize; 2] {
        let (mut level, palette, mut labels) = scene(shadow_colour);
        level.noise = 2.0;
        let edge_weights = EdgeWeights::uniform(SIZE[0], SIZE[1], 8.0);
        let motions = [AffineMotion::STATIC, AffineMotion::translation(3.0, 0.0)];
        let before = labels.clone();
        return_shadows(&level, &palette, &edge_weights, &motions, &mut labels, Solver::BEST);
        let lost = |rows: std::ops::Range<usize>| {
            (0..labels.len()).filter(|p| rows.contains(&(p / SIZE[0])) && labels[*p] != before[*p]).count()
        };
        [lost(20..40), lost(40..60)]
    }

    #[test]
    fn ground_that_only_changes_its_light_is_given_back() {
        let [thing, shadow] = returned([0.4, 0.5, 0.4]);
        assert!(thing < 20 && shadow > 550, "{thing} of 600 pixels of the thing, {shadow} of its shadow");
    }

    #[test]
    fn what_has_the_colour_of_the_object_stays_with_it() {
        let [thing, shadow] = returned([1.0, 0.3, 0.3]);
        assert!(thing < 20 && shadow < 20, "{thing} of 600 pixels of the thing, {shadow} below");
    }
}
