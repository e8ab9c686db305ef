//! The call on measurements.

use numpy::{AllowTypeChange, PyArrayLikeDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;
use veronese::{FitOptions, Measurements, fit_motions};

use crate::errors::Failure;
use crate::options;
use crate::results;
use crate::worker::alone;

/// A `MotionFit`.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "they are named in Python")]
pub(crate) fn fit_points<'py>(
    py: Python<'py>,
    positions: &Bound<'py, PyAny>,
    derivatives: &Bound<'py, PyAny>,
    motions: &Bound<'py, PyAny>,
    method: &Bound<'py, PyAny>,
    seed: &Bound<'py, PyAny>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let options = FitOptions::default()
        .with_motions(options::motions(motions)?)
        .with_method(options::method(method)?)
        .with_seed(options::seed(seed)?);
    let (positions, derivatives) = (rows("positions", positions)?, rows("derivatives", derivatives)?);
    let fit = alone(py, progress, move |progress| {
        Ok(fit_motions(&Measurements::new(positions, derivatives)?, &options, progress)?)
    })?;
    results::motion_fit(py, fit)
}

/// Rows of `N` numbers from what can become an array of them.
fn rows<const N: usize>(name: &str, given: &Bound<'_, PyAny>) -> Result<Vec<[f64; N]>, Failure> {
    let shape = || Failure::input(format!("the {name} must be an array of float64 of shape (number, {N})"));
    let array: PyArrayLikeDyn<'_, f64, AllowTypeChange> = given.extract().map_err(|_| shape())?;
    if array.ndim() != 2 || array.shape()[1] != N {
        return Err(shape());
    }
    let values: Vec<f64> = array.as_array().iter().copied().collect();
    Ok(values.as_chunks().0.to_vec())
}
