//! Costs in two views: pixels that are occluded in the second frame are often visible in the frame before.
//!
//! The weight of each view is the same for all motions: it depends on how well the best motion explains the surroundings in that view.
//! Taking the cheaper view for each motion separately would give every motion two chances to fit by accident.

use crate::frame::Plane;
use crate::frame::filter::gaussian;
use crate::lanes::{each, lower};
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::view::cost::{CostModel, View, cost_in};
use crate::view::level::Level;

/// Cost of every motion at every pixel, infinite where it moves the pixel out of every view; and the weight of the later view, if
/// there are two.
pub(crate) fn costs_in_views(level: &Level, motions: &[AffineMotion]) -> (Vec<Plane>, Option<Plane>) {
    let all = |view| {
        motions
            .iter()
            .map(|m| cost_in(level, view, &level.area(), m, CostModel::labels(level.model)))
            .collect::<Vec<Plane>>()
    };
    let mut costs = all(View::Second);
    if level.before.is_none() {
        return (costs, None);
    }
    let before = all(View::Before);
    let mut shares = unexplained(&before, level.model);
    for (share, later) in shares.values_mut().iter_mut().zip(unexplained(&costs, level.model).values()) {
        *share = ((*share - later) / level.model.views_transition + 0.5).clamp(0.0, 1.0);
    }
    for (cost, before) in costs.iter_mut().zip(&before) {
        let both = cost.values_mut().iter_mut().zip(before.values());
        both.zip(shares.values()).for_each(|((c, b), share)| *c = blend_views(*c, *b, *share));
    }
    (costs, Some(shares))
}

/// [`costs_in_views`] with the neutral cost where a motion moves a pixel out of every view.
pub(crate) fn costs_where_seen(level: &Level, motions: &[AffineMotion]) -> Vec<Plane> {
    let (mut costs, _) = costs_in_views(level, motions);
    let neutral = CostModel::labels(level.model).outside();
    costs.iter_mut().for_each(|cost| each(cost.values_mut(), |c| if c.is_finite() { c } else { neutral }));
    costs
}

/// The cost of a pixel from its costs in both views; `share` is the weight of the later one.
#[inline(always)]
pub(crate) fn blend_views(later: f32, earlier: f32, share: f32) -> f32 {
    match (later.is_finite(), earlier.is_finite()) {
        (true, true) => share * later + (1.0 - share) * earlier,
        (true, false) => later,
        (false, _) => earlier,
    }
}

/// The smallest cost of any motion, averaged over windows.
fn unexplained(costs: &[Plane], model: &Model) -> Plane {
    gaussian(&cheapest(costs, model.label_truncation), model.views_window)
}

/// The smallest of the costs at every pixel, at most `most`.
pub(crate) fn cheapest(costs: &[Plane], most: f32) -> Plane {
    let Some(first) = costs.first() else { return Plane::filled(0, 0, 0.0) };
    let mut cheapest = Plane::filled(first.width(), first.height(), most);
    for cost in costs {
        lower(cheapest.values_mut(), cost.values());
    }
    cheapest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::level::build;

    fn noise(seed: u64) -> Plane {
        let mut random = crate::random::Random::from_seed(seed);
        Plane::from_fn(64, 48, |_, _| random.uniform(0.0, 255.0) as f32)
    }

    #[test]
    fn what_the_second_frame_hides_is_looked_at_in_the_frame_before() {
        // Nothing moves, but something covers the left half of the second frame.
        let (first, cover) = (noise(1), noise(2));
        let second = Plane::from_fn(64, 48, |x, y| if x < 32 { cover.at(x, y) } else { first.at(x, y) });
        let motions = [AffineMotion::STATIC, AffineMotion::translation(5.0, 0.0)];
        let mean = |plane: &Plane, columns: std::ops::Range<usize>| {
            let values: Vec<f32> = (4..44).flat_map(|y| plane.row(y)[columns.clone()].to_vec()).collect();
            values.iter().sum::<f32>() / values.len() as f32
        };
        let alone = costs_in_views(&build(first.clone(), second.clone(), None, 24)[0], &motions).0;
        let both = costs_in_views(&build(first.clone(), second, Some(first), 24)[0], &motions).0;
        assert!(mean(&alone[0], 6..26) > 1.5 && mean(&both[0], 6..26) < 0.1);
        assert!(mean(&both[0], 38..58) < 0.1);
        // The wrong motion fits no better with two views than with one.
        for columns in [6..26, 38..56] {
            assert!(mean(&both[1], columns.clone()) > mean(&alone[1], columns) - 0.1);
        }
    }
}
