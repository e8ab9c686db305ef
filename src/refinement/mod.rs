//! From the algebraic start to the best motions.

pub mod product;
mod report;

pub use report::{Report, Termination};
