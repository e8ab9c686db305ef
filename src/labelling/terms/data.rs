//! The data term: the cost of every motion at every pixel, and the cost of its label that follows.

use crate::frame::Plane;
use crate::labelling::BACKGROUND;
use crate::labelling::options::LabellingOptions;
use crate::labelling::regions::description::weight_of_pixel;
use crate::labelling::terms::variance_inflation::{VarianceInflation, inflate_variance};
use crate::lanes::{each, each_with, lower};
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::view::cost::{RobustKernel, cheapest, cost_where_seen};
use crate::view::level::PairLevel;

/// Motions and their costs at every pixel, infinite where a motion moves the pixel out of the frame. Label and estimation costs follow from
/// them.
pub(crate) type Compared = Vec<(AffineMotion, Plane)>;

/// Compares the frames along motions, except those in `known`.
pub(crate) fn compare(level: &PairLevel, motions: &[AffineMotion], mut known: Compared) -> Compared {
    let plane = |motion: &AffineMotion| match known.iter().position(|(other, _)| other == motion) {
        Some(k) => known.swap_remove(k).1,
        None => cost_where_seen(level, motion, RobustKernel::labels(level.model)),
    };
    let planes: Vec<Plane> = motions.iter().map(plane).collect();
    motions.iter().copied().zip(planes).collect()
}

/// Estimation costs of every motion, from the same comparisons: `1/ρ = 1/e + 1/T` for both largest costs T.
pub(crate) fn estimation_costs(level: &PairLevel, compared: &Compared) -> Vec<Plane> {
    let (model, weight) = (RobustKernel::estimation(level.model), weight_of_pixel(level));
    let less = 1.0 / RobustKernel::labels(level.model).truncation - 1.0 / model.truncation;
    let outside = model.outside();
    let plane = |(_, cost): &(AffineMotion, Plane)| {
        let mut plane = cost.clone();
        each(plane.values_mut(), |c| weight * if c.is_finite() { c / (1.0 - less * c) } else { outside });
        plane
    };
    compared.iter().map(plane).collect()
}

/// Label cost of every motion at every pixel; the first is the dominant motion.
///
/// A pixel that a motion moves out of the frame cannot be compared, so the motion costs there as much as the cheapest one that keeps
/// the pixel inside. This is at least the neutral cost for an object and at most the neutral cost for the dominant motion, so that
/// objects do not win pixels by moving them out of the frame.
///
/// They are computed row by row, so that the only intermediate plane is that of the smallest costs.
pub(crate) fn label_costs(level: &PairLevel, compared: &Compared, options: LabellingOptions) -> Vec<Plane> {
    let mut costs: Vec<Plane> = compared.iter().map(|(_, cost)| cost.clone()).collect();
    let mut inflation = VarianceInflation::new(cheapest(&costs, f32::INFINITY), level.model);
    let [mut inflation_row, mut seen] = [vec![0.0; level.width()], vec![0.0; level.width()]];
    for y in 0..level.height() {
        inflation.write(y, &mut inflation_row);
        seen.fill(f32::INFINITY);
        for cost in &mut costs {
            inflate_variance(cost.row_mut(y), &inflation_row, level.model);
            lower(&mut seen, cost.row(y));
        }
        for (label, cost) in costs.iter_mut().enumerate() {
            to_label_costs(label, cost.row_mut(y), &seen, options, level.model);
        }
    }
    costs[BACKGROUND + 1..].iter_mut().for_each(|cost| add_frame_border_penalty(cost, options));
    costs
}

/// Turns costs of a motion into those of its label: fills in pixels moved out of the frame and adds the object bias. `seen` is the
/// smallest cost of any motion that keeps the pixel inside, infinite if there is none.
#[inline(never)]
fn to_label_costs(label: usize, costs: &mut [f32], seen: &[f32], options: LabellingOptions, model: &Model) {
    let neutral = RobustKernel::labels(model).outside();
    let (least, most, object_bias) = match label {
        BACKGROUND => (f32::NEG_INFINITY, neutral, 0.0),
        _ => (neutral, f32::INFINITY, options.object_bias),
    };
    each_with(costs, [seen], |cost, [seen]| {
        let unseen = if seen < most { seen } else { neutral };
        let unseen = if unseen > least { unseen } else { neutral };
        object_bias + if cost.is_finite() { cost } else { unseen }
    });
}

/// Adds the penalty of an object's pixels on the frame's border, for each of the borders that they lie on.
fn add_frame_border_penalty(cost: &mut Plane, options: LabellingOptions) {
    let penalty = 0.5 * options.smoothness;
    let (width, height) = (cost.width(), cost.height());
    for y in [0, height - 1] {
        cost.row_mut(y).iter_mut().for_each(|c| *c += penalty);
    }
    for y in 0..height {
        for x in [0, width - 1] {
            cost.row_mut(y)[x] += penalty;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labelling::options::LabellingOptions;
    use crate::view::level::build;

    fn costs(level: &PairLevel, motions: &[AffineMotion]) -> Vec<Plane> {
        label_costs(level, &compare(level, motions, Vec::new()), LabellingOptions::OF_TESTS)
    }

    fn noise(seed: u64) -> Plane {
        let mut random = crate::random::Random::from_seed(seed);
        Plane::from_fn(64, 48, |_, _| random.uniform(0.0, 255.0) as f32)
    }

    #[test]
    fn leaving_the_frame_wins_an_object_nothing_and_costs_the_dominant_motion_nothing() {
        let (still, leaving) = (AffineMotion::STATIC, AffineMotion::translation(20.0, 0.0));
        let same = &build(noise(1), noise(1), 24)[0];
        let other = &build(noise(1), noise(2), 24)[0];
        for level in [same, other] {
            let (object, dominant) = (costs(level, &[still, leaving]), costs(level, &[leaving, still]));
            for y in 1..47 {
                for x in 45..63 {
                    assert!(
                        object[1].at(x, y) >= object[0].at(x, y) + LabellingOptions::OF_TESTS.object_bias,
                        "({x}, {y})"
                    );
                    assert!(dominant[0].at(x, y) <= dominant[1].at(x, y), "({x}, {y})");
                }
            }
        }
        let nowhere = AffineMotion::translation(100.0, 0.0);
        let unseen = costs(same, &[nowhere, nowhere]);
        assert_eq!(unseen[0].at(30, 30), RobustKernel::labels(&Model::DEFAULT).outside());
        assert!((unseen[1].at(30, 30) - unseen[0].at(30, 30) - LabellingOptions::OF_TESTS.object_bias).abs() < 1e-6);
    }
}
