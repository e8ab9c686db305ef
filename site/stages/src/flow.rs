//! The multibody optical flow (eq. 13 and 14) where all motions are translations.

use crate::map::{columns_of, triangle_of};
use crate::{MOST, within};
use veronese::embedding::MultibodyMotion;
use veronese::embedding::monomials::{count, kept_pairs};
use veronese::factorisation::choose;
use veronese::factorisation::differentiation::{POINTS, along_direction};
use veronese::factorisation::roots::roots;
use veronese::factorisation::ternary::factorise;
use veronese::linear::NullVector;
use veronese::{AffineMotion, Error, Measurements, Result};

/// Largest number of motions.
const MOST_MOTIONS: usize = 4;
/// A last coefficient below this share of the length of all counts as zero.
const VANISHING: f64 = 1e-13;

/// The result of [`multibody_flow`].
#[derive(Clone, Debug)]
pub struct MultibodyFlow {
    /// The coefficients of `Π_i yᵀu_i` for the monomials of y = (I_x, I_y, I_t) in the paper's order, up to scale. The last one is 1, or
    /// they are of unit length if it vanishes: then some flow is infinite.
    pub coefficients: Vec<f64>,
    /// Singular values of the embedded derivatives, decreasing, as many as there are coefficients.
    pub singular_values: Vec<f64>,
    /// The flows (u, v) by factoring the polynomial into linear forms. Of complex roots, which occur with noise, the real parts are used.
    /// Fewer than n if some are infinite. Two flows with the same v have the same root, and their u is not determined.
    pub factors: Vec<[f64; 2]>,
    /// The flows by differentiation: where the polynomial vanishes, its gradient is parallel to the u_i of the factor that vanishes. It is
    /// taken along the directions of up to [`POINTS`] gradients, and [`choose`] selects n. Empty if the last coefficient vanishes.
    pub by_differentiation: Vec<[f64; 2]>,
}

/// The flows of n = `motions` translations, 1 to 4, from derivatives that all obey `Π_i yᵀu_i = 0`, u_i = (u, v, 1).
///
/// # Errors
/// [`Error::InvalidOption`] for a number of motions or `derivatives` out of range; [`Error::TooFewMeasurements`] for fewer than M_n − 1;
/// [`Error::NotFinite`].
pub fn multibody_flow(derivatives: &[[f64; 3]], motions: usize) -> Result<MultibodyFlow> {
    within("motions", motions, [1, MOST_MOTIONS])?;
    let (found, needed) = (derivatives.len(), count(motions) - 1);
    if found > MOST {
        return Err(Error::InvalidOption {
            name: "derivatives",
            reason: format!("must be at most {MOST}, not {found}"),
        });
    }
    let measurements = Measurements::new(vec![[0.0; 2]; found], derivatives.to_vec())?;
    if found < needed {
        return Err(Error::TooFewMeasurements { motions, needed, found });
    }
    let triangle = triangle_of(&columns_of(motions, derivatives));
    let mut coefficients = NullVector::of(&triangle).vector;
    let last = coefficients[needed];
    let is_finite = last.abs() > VANISHING;
    if is_finite {
        coefficients.iter_mut().for_each(|c| *c /= last);
    }
    let forms = factorise(&coefficients, motions).unwrap_or_default();
    let factors = forms.iter().map(|b| [b[0] / b[2], b[1] / b[2]]).filter(|flow| flow.iter().all(|f| f.is_finite()));
    Ok(MultibodyFlow {
        singular_values: triangle.singular_values().unwrap_or_default(),
        factors: factors.collect(),
        by_differentiation: if is_finite { differentiated(&coefficients, &measurements, motions) } else { Vec::new() },
        coefficients,
    })
}

/// The flows by differentiation.
fn differentiated(coefficients: &[f64], measurements: &Measurements, motions: usize) -> Vec<[f64; 2]> {
    // A multibody motion of translations depends on y alone: only its last column, that of zⁿ, is not zero.
    let last = count(motions) - 1;
    let of = |&(row, column): &(usize, usize)| if column == last { coefficients[row] } else { 0.0 };
    let entries: Vec<f64> = kept_pairs(motions).iter().map(of).collect();
    let multibody = MultibodyMotion::from_coefficients(motions, &entries);
    let x = [0.0, 0.0, 1.0];
    let points = measurements.len().min(POINTS);
    let mut flows = Vec::new();
    for k in 0..points {
        let [ix, iy, _] = measurements.derivatives()[k * measurements.len() / points];
        let length = (ix * ix + iy * iy).sqrt();
        let direction = [ix / length, iy / length];
        if !direction.iter().all(|d| d.is_finite()) {
            continue;
        }
        for root in roots(&along_direction(&multibody, x, direction)).finite {
            let [u, v, scale] = multibody.gradient_y(x, [direction[0], direction[1], root.re]);
            flows.push(AffineMotion::translation(u / scale, v / scale));
        }
    }
    flows.retain(AffineMotion::is_finite);
    let choice = choose(&flows, measurements, motions, f64::INFINITY);
    choice.indices.iter().map(|&k| flows[k].flow(0.0, 0.0)).collect()
}
