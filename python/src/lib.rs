//! The interface to Python: arrays, paths and plain options in, arrays and plain classes out. No arithmetic happens here.
//!
//! Work runs in a thread of its own, without the interpreter (`worker.rs`): other Python threads continue, and signals are handled. Results
//! are the classes of the module `veronese._types`, errors its `VeroneseError` with a stable `code`.

use pyo3::prelude::*;

mod clip;
mod errors;
mod frames;
mod options;
mod pair;
mod points;
mod results;
mod worker;

/// The compiled part of `veronese`; its functions are called by the Python code of the package alone.
#[pymodule]
fn _veronese(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_function(wrap_pyfunction!(pair::segment_pair, module)?)?;
    module.add_function(wrap_pyfunction!(points::fit_points, module)?)?;
    module.add_function(wrap_pyfunction!(clip::open_clip, module)?)?;
    module.add_function(wrap_pyfunction!(clip::stream::segment_stream, module)?)?;
    module.add_class::<clip::Clip>()?;
    module.add_class::<clip::stream::ClipStream>()
}
