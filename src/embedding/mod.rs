//! The multibody affine constraint (sections 3.1 and 3.2 of the paper): measurements embedded by the Veronese map, the matrix 𝒜 that
//! contains all motions, and the number of motions from ranks.
//!
//! In order: [`monomials`] and their structural zeros, [`veronese`] with their values, [`EmbeddedData`] (one row per measurement,
//! reduced to a triangle), [`MultibodyMotion`] (its null vector) and [`rank`] (Theorem 1).
//!
//! **Pitfall.** The functions evaluate polynomials of degree up to 20 in the data. Use measurements from
//! [`Measurements::normalised`](crate::Measurements::normalised).
//!
//! ```
//! use veronese::embedding::{MultibodyMotion, monomials, rank};
//! # use veronese::{Measurements, Random};
//! use veronese::AffineMotion;
//!
//! # fn main() -> veronese::Result<()> {
//! let truth = [
//!     AffineMotion::new([0.1, -0.2, 0.5, 0.2, 0.1, -0.3]),
//!     AffineMotion::new([-0.3, 0.4, -0.4, 0.1, 0.2, 0.6]),
//! ];
//! # let mut random = Random::from_seed(1);
//! # let positions: Vec<_> = (0..300).map(|_| [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)]).collect();
//! # let derivative = |(j, &[x, y]): (usize, &[f64; 2])| {
//! #     let ([u, v], [ix, iy]) = (truth[j % 2].flow(x, y), [random.normal(), random.normal()]);
//! #     [ix, iy, -ix * u - iy * v]
//! # };
//! # let derivatives = positions.iter().enumerate().map(derivative).collect();
//! # let data = Measurements::new(positions, derivatives)?;
//! // `data` are 300 measurements of the two motions, without noise, with positions in [−1, 1]².
//! let rule = rank::number_of_motions(&data, 3)?;
//! assert_eq!((rule.motions, rule.fired), (2, true));
//!
//! let multibody = MultibodyMotion::estimate(&data, 2)?;
//! assert_eq!(multibody.coefficients().len(), monomials::unknowns(2));
//! let expected = MultibodyMotion::from_motions(&truth);
//! assert!((multibody.matrix() - expected.matrix()).amax() < 1e-10);
//! # Ok(())
//! # }
//! ```

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
