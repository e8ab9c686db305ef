//! The multibody affine constraint (sections 3.1 and 3.2 of the paper): measurements embedded by the Veronese map, the matrix
//! 𝒜 that holds all motions at once, and the number of motions from ranks. Knows no images.
//!
//! The path: [`monomials`] (which products there are, and which of them can occur) → [`veronese`] (their values) →
//! [`EmbeddedData`] (one row per measurement, reduced to a triangle) → [`MultibodyMotion`] (the null vector) and
//! [`rank`] (Theorem 1).
//!
//! **Pitfall**: everything here is homogeneous polynomials of degree up to 20 in the data. Give it measurements from
//! [`Measurements::normalised`](crate::Measurements::normalised).

mod embedded;
mod moments;
pub mod monomials;
mod multibody;
pub mod rank;
mod taubin;
pub mod veronese;

pub use embedded::{EmbeddedData, embedded_matrix};
pub(crate) use moments::Refitting;
pub use multibody::MultibodyMotion;
pub use taubin::taubin_motion;
