//! The crate's tests through its public interface. One program: it is linked once, and what its parts have in common is compiled once.

mod clip;
mod corrections;
mod estimator;
mod examples;
// Reads image files.
#[cfg(feature = "codecs")]
mod expectations;
// So do these.
#[cfg(feature = "codecs")]
mod golden;
mod literal;
mod outlines;
mod paper;
mod pipeline;
mod promises;
mod properties;
mod session;
mod support;
