//! The precision of a motion: the covariance of its entries, and the rank of their constraints.

use nalgebra::{Matrix2, Matrix3, Matrix6, UDU, Vector3};

use super::mixture::{Normal, cholesky};
use super::samples::Samples;

/// A direction in the space of the six entries is determined if the mean squared gradient along it exceeds this multiple of σ² …
const ABOVE_NOISE: f64 = 2.0;
/// … plus this constant, for data without noise (derivatives have unit root mean square length).
const ABOVE_ROUNDING: f64 = 1e-9;
/// Positions are collinear if their second moment in some direction is below this share of the total.
const IN_LINE: f64 = 1e-10;

/// `σ² H⁻¹` with `H = Σ w J Jᵀ`, the covariance of the entries with the labels taken as known. Directions that are not determined have a
/// large but finite variance.
pub(crate) fn covariance(normal: &Normal, sigma: f64) -> Matrix6<f64> {
    cholesky(normal.ridged()).inverse() * (sigma * sigma)
}

/// The numerical rank of the constraints on the six entries, 0 to 6: in how many directions the mean squared gradient, which is H relative
/// to the flow energy `Σ X Xᵀ`, X = (x, y, 1), at the positions of the motion's measurements `own`, exceeds the noise. By Sylvester's law
/// of inertia, these are the positive pivots of the difference.
pub(crate) fn determined(normal: &Normal, samples: &Samples, own: impl Iterator<Item = usize>, sigma: f64) -> usize {
    let (mut energy, mut count) = (Matrix3::zeros(), 0);
    for j in own {
        count += 1;
        let [x, y] = samples.position(j);
        let position = Vector3::new(x, y, 1.0);
        energy += position * position.transpose();
    }
    let threshold = ABOVE_NOISE * sigma * sigma + ABOVE_ROUNDING;
    let noise = energy * threshold + Matrix3::from_diagonal_element(IN_LINE * energy.trace());
    let above = UDU::new(normal.matrix - Matrix2::identity().kronecker(&noise));
    let directions = above.map_or(0, |factors| factors.d.iter().filter(|&&pivot| pivot > 0.0).count());
    // A position determines two entries at most.
    directions.min(2 * count)
}
