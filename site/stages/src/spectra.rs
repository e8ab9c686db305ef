//! The singular values behind the rank rule (12).

use crate::within;
use veronese::embedding::EmbeddedData;
use veronese::embedding::monomials::unknowns;
use veronese::embedding::rank::{KAPPA, MAX_TRIED, numerical_rank};
use veronese::{Measurements, Result};

/// The singular values of P̃_i for one number of motions i.
#[derive(Clone, Debug)]
pub struct Spectrum {
    /// The number of motions i.
    pub motions: usize,
    /// Columns scaled to unit length, decreasing.
    pub singular_values: Vec<f64>,
    /// Their rank by the paper's footnote 4, with [`KAPPA`].
    pub rank: usize,
}

/// The singular values of P̃_1 … P̃_i for i = `largest`, 1 to [`MAX_TRIED`], as
/// [`number_of_motions`](veronese::embedding::rank::number_of_motions) sees them, also where it stops before. Those for which there are too
/// few measurements are left out.
///
/// # Errors
/// [`Error::InvalidOption`](veronese::Error::InvalidOption) for `largest` out of range.
pub fn embedded_spectra(measurements: &Measurements, largest: usize) -> Result<Vec<Spectrum>> {
    within("largest", largest, [1, MAX_TRIED])?;
    let (normalised, _) = measurements.normalised();
    let enough = |motions: &usize| measurements.len() + 1 >= unknowns(*motions);
    let spectrum = |motions| {
        let singular_values = EmbeddedData::new(&normalised, motions).scaled_singular_values().unwrap_or_default();
        Spectrum { motions, rank: numerical_rank(&singular_values, KAPPA), singular_values }
    };
    Ok((1..=largest).take_while(enough).map(spectrum).collect())
}
