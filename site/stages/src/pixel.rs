//! Differentiation at one pixel.

use crate::within;
use veronese::embedding::MultibodyMotion;
use veronese::factorisation::differentiation::{along_direction, motions_at};
use veronese::factorisation::roots::roots;
use veronese::{AffineMotion, Error, Measurements, Result};

/// Largest number of motions.
const MOST_MOTIONS: usize = 4;

/// The result of [`motions_at_pixel`].
#[derive(Clone, Debug)]
pub struct PixelStages {
    /// The multibody polynomial at the pixel for y = (cos θ, sin θ, t), by increasing powers of t. The last coefficient is 1.
    pub coefficients: Vec<f64>,
    /// Its roots, real and imaginary part of each: the temporal derivatives that the motions predict.
    pub roots: Vec<[f64; 2]>,
    /// The motions that the derivatives of the multibody polynomial at the roots give, in the coordinates of the input, without those that
    /// are not finite. In the order of the roots if all are finite.
    pub motions: Vec<AffineMotion>,
}

/// The motions by differentiating the multibody polynomial of `motions` = 1 to 4 motions at one pixel, along the direction `angle` (radians)
/// of the image gradient.
///
/// # Errors
/// [`Error::InvalidOption`] for a number of motions out of range; [`Error::TooFewMeasurements`] for fewer than M_n² − Z_n − 1 measurements;
/// [`Error::NotFinite`].
pub fn motions_at_pixel(
    measurements: &Measurements,
    motions: usize,
    position: [f64; 2],
    angle: f64,
) -> Result<PixelStages> {
    within("motions", motions, [1, MOST_MOTIONS])?;
    if !position.iter().chain([&angle]).all(|value| value.is_finite()) {
        return Err(Error::NotFinite { what: "position", index: 0 });
    }
    let (normalised, normalisation) = measurements.normalised();
    let multibody = MultibodyMotion::estimate(&normalised, motions)?;
    let position = [0, 1].map(|k| (position[k] - normalisation.centre[k]) / normalisation.scale);
    let direction = [libm::cos(angle), libm::sin(angle)];
    let coefficients = along_direction(&multibody, [position[0], position[1], 1.0], direction);
    let found = motions_at(&multibody, position, angle);
    Ok(PixelStages {
        roots: roots(&coefficients).finite.iter().map(|root| [root.re, root.im]).collect(),
        motions: found.iter().map(|motion| normalisation.restore(motion)).collect(),
        coefficients,
    })
}
