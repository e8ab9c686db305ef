//! From the multibody motion 𝒜 to the motions A_1 … A_n (section 3.3 of the paper), by two methods.
//!
//! * [`five_steps`], the paper's method: rows and columns of 𝒜 are factored into linear forms ([`ternary`], [`roots`]), which are then
//!   associated with each other ([`assignment`]). It fails if two motions share an entry of the third column or a motion has a zero row,
//!   and is sensitive to noise.
//! * [`differentiation`]: derivatives of the polynomial at points give whole motions. It needs no association, and fails only if two
//!   motions have the same first row or the same second row.
//!
//! ```
//! use veronese::AffineMotion;
//! use veronese::embedding::MultibodyMotion;
//! use veronese::factorisation::{five_steps, motions_at};
//!
//! // A static background has zero rows, where the five steps fail.
//! let object = AffineMotion::new([0.1, -0.2, 0.5, 0.2, 0.1, -0.3]);
//! let multibody = MultibodyMotion::from_motions(&[AffineMotion::STATIC, object]);
//! let found = |motions: &[AffineMotion]| motions.iter().any(|motion| object.relative_error(motion) < 1e-9);
//! assert!(!found(&five_steps(&multibody)));
//! assert!(found(&motions_at(&multibody, [0.3, -0.4], 0.7)));
//! ```

pub mod assignment;
pub mod differentiation;
mod five_steps;
mod greedy;
pub mod roots;
pub mod ternary;

pub use differentiation::{algebraic_start, motions_at};
pub use five_steps::five_steps;
#[doc(hidden)]
pub use five_steps::third_columns;
pub use greedy::{Choice, choose};
