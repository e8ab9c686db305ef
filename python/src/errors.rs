//! Errors as the exception of the package.

use pyo3::prelude::*;

/// An error to raise: a `VeroneseError` with a `code`.
#[derive(Debug)]
pub(crate) struct Failure {
    pub(crate) code: &'static str,
    pub(crate) message: String,
}

impl Failure {
    pub(crate) fn input(message: String) -> Failure {
        Failure { code: "invalid-input", message }
    }

    pub(crate) fn option(name: &str, reason: &str) -> Failure {
        Failure { code: "invalid-option", message: format!("option '{name}': {reason}") }
    }

    pub(crate) fn internal(message: String) -> Failure {
        Failure { code: "internal", message }
    }

    /// The same, with what it is about.
    pub(crate) fn about(self, what: &str) -> Failure {
        Failure { message: format!("{what}: {}", self.message), ..self }
    }
}

impl From<veronese::Error> for Failure {
    fn from(error: veronese::Error) -> Failure {
        Failure { code: error.code(), message: error.to_string() }
    }
}

impl From<Failure> for PyErr {
    fn from(Failure { code, message }: Failure) -> PyErr {
        Python::attach(|py| {
            let class = py.import("veronese._types").and_then(|types| types.getattr("VeroneseError"));
            match class.and_then(|class| class.call1((code, message))) {
                Ok(error) => PyErr::from_value(error),
                Err(error) => error,
            }
        })
    }
}
