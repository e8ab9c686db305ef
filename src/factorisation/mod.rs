//! From the multibody motion 𝒜 back to the motions A_1 … A_n (section 3.3 of the paper), in two ways.
//!
//! * [`five_steps`]: the paper's own, by factoring rows and columns of 𝒜 into linear forms ([`ternary`], [`roots`]) and
//!   associating the pieces ([`assignment`]). It fails where two motions share a translation entry, where a motion
//!   has a zero row, and it is sensitive to noise.
//! * [`differentiation`]: by derivatives of the polynomial at points. It needs no association and has none of these limits.

pub mod assignment;
pub mod differentiation;
mod five_steps;
mod greedy;
pub mod roots;
pub mod ternary;

pub use differentiation::{algebraic_start, motions_at};
pub use five_steps::five_steps;
pub use greedy::{Choice, choose};
