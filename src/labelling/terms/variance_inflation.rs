//! Larger variances where no motion fits well.
//!
//! The noise of a pair is measured where the dominant motion explains it. Elsewhere an affine motion may be only approximate: limbs, cloth,
//! water, parallax, blur. Costs there saturate for correct and wrong motions alike, and their difference is mostly chance. The cost of the
//! best motion around a pixel shows by how much the variance is too small, and costs are computed again with the inflated variance. Where
//! affine motions are exact, in nearly all of most frames, nothing changes.

use crate::frame::Plane;
use crate::frame::filter::RowFilter;
use crate::lanes::{each, each_with};
use crate::model::Model;
use crate::view::cost::RobustKernel;

/// Mean cost of noise alone: E[e/(1 + e/T)] for e of one degree of freedom and T = 2.
const NOISE_ALONE: f32 = 0.484;

/// Factor of each pixel's variance, computed row by row from the smallest label cost.
///
/// The mean of the saturated costs grows about as the standard deviation of the residuals.
pub(crate) struct VarianceInflation {
    smallest: Plane,
    model: &'static Model,
    window: RowFilter,
}

impl VarianceInflation {
    /// `smallest` is infinite where all motions move a pixel out of the second frame.
    pub(crate) fn new(mut smallest: Plane, model: &'static Model) -> VarianceInflation {
        each(smallest.values_mut(), |c| if c.is_finite() { c } else { RobustKernel::labels(model).outside() });
        let window = RowFilter::gaussian(smallest.width(), model.window_of_fit());
        VarianceInflation { smallest, model, window }
    }

    /// Writes the factors of row y.
    pub(crate) fn write(&mut self, y: usize, row: &mut [f32]) {
        self.window.row(&self.smallest, y, row);
        let largest = self.model.largest_inflation;
        each(row, |m| {
            let ratio = (m / NOISE_ALONE).clamp(1.0, largest);
            ratio * ratio
        });
    }
}

/// Costs with inflated variance: e / (1 + e/T) with e / inflation in place of e. Infinite costs stay infinite.
#[inline(never)]
pub(crate) fn inflate_variance(costs: &mut [f32], inflation: &[f32], model: &Model) {
    let truncation = model.largest_cost();
    each_with(costs, [inflation], |cost, [inflation]| {
        let share = cost / truncation;
        let allowed = cost / (inflation * (1.0 - share) + share);
        if cost.is_finite() { allowed } else { cost }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::cost::cheapest;

    fn allow(costs: &mut [Plane]) {
        let mut inflation = VarianceInflation::new(cheapest(costs, f32::INFINITY), &Model::DEFAULT);
        let mut row = vec![0.0; costs[0].width()];
        for y in 0..costs[0].height() {
            inflation.write(y, &mut row);
            costs.iter_mut().for_each(|cost| inflate_variance(cost.row_mut(y), &row, &Model::DEFAULT));
        }
    }

    #[test]
    fn where_one_motion_fits_nothing_changes_and_where_none_does_the_better_one_is_told_apart() {
        let plane = |good: f32, bad: f32| Plane::from_fn(80, 40, move |x, _| if x < 40 { good } else { bad });
        let mut costs = [plane(0.4, 1.4), plane(1.9, 1.9)];
        let before = costs.clone();
        allow(&mut costs);
        for k in 0..2 {
            assert_eq!(costs[k].at(10, 20), before[k].at(10, 20));
        }
        let gap = |costs: &[Plane; 2]| costs[1].at(70, 20) - costs[0].at(70, 20);
        assert!(gap(&costs) > 1.3 * gap(&before), "{} was {}", gap(&costs), gap(&before));
    }

    #[test]
    fn what_is_saturated_or_unseen_stays_so() {
        let mut costs = [
            Plane::filled(20, 20, RobustKernel::labels(&Model::DEFAULT).truncation),
            Plane::filled(20, 20, f32::INFINITY),
        ];
        let before = costs.clone();
        allow(&mut costs);
        assert_eq!(costs, before);
    }
}
