//! The steps of the method one by one, for figures and for study. Feature `stages`.
//!
//! **Stability.** This module may change in any version: it shows the inside of the others and changes with them.
//!
//! The functions compute nothing of their own: they run the parts of this crate and hand out what those give each other.
//!
//! * [`veronese_map`]: points embedded by the Veronese map, and the polynomial that vanishes on them;
//! * [`multibody_flow`]: several translations from one polynomial in the derivatives (eq. 13 and 14);
//! * [`grey_derivatives`]: image derivatives in grey levels;
//! * [`paper_stages`]: the paper's algorithm step by step, with the ambiguity of its fifth step, and differentiation beside it;
//! * [`motions_at_pixel`]: differentiation at one pixel; [`embedded_spectra`]: the singular values behind the rank rule;
//! * [`segment_pair_stages`]: the image pipeline with what its stages find, and where and why it leaves the paper ([`pair`]);
//! * [`motion_measurements`] and [`figure_1_trial`]: generated measurements and one trial of the paper's Figure 1, by [`protocol`].
//!
//! ```
//! use veronese::stages::{multibody_flow, veronese_map};
//!
//! # fn main() -> veronese::Result<()> {
//! // Points on the lines x = y and x = −2y: x² + xy − 2y² vanishes on both.
//! let points = [1.0, 1.0, -2.0, -2.0, 2.0, -1.0, -1.0, 0.5, 0.5, 0.5];
//! let map = veronese_map(&points, 2, 2)?;
//! assert_eq!(map.exponents, [[2, 0, 0], [1, 1, 0], [0, 2, 0]]);
//! assert_eq!((map.rank, map.lines.len(), map.complex), (2, 2, 0));
//!
//! // Derivatives of pixels that move by (1, 0), and of others that move by (0, -2).
//! let derivatives = [[1.0, 0.5, -1.0], [2.0, -1.0, -2.0], [1.0, 1.0, 2.0], [0.5, 2.0, 4.0], [1.0, 3.0, -1.0]];
//! let flow = multibody_flow(&derivatives, 2)?;
//! assert_eq!(flow.factors.len(), 2);
//! # Ok(())
//! # }
//! ```

mod figure_1;
mod fit;
mod flow;
mod grey;
mod map;
mod measured;
pub mod pair;
mod pixel;
pub mod protocol;
mod recorder;
mod spectra;

pub use figure_1::{Figure1Trial, TrialError, figure_1_trial};
pub use fit::{FitStages, paper_stages};
pub use flow::{MultibodyFlow, multibody_flow};
pub use grey::grey_derivatives;
pub use map::{VeroneseMap, veronese_map};
pub use measured::motion_measurements;
pub use pair::PairStages;
pub use pixel::{PixelStages, motions_at_pixel};
pub use recorder::segment_pair_stages;
pub use spectra::{Spectrum, embedded_spectra};

use crate::error::{Error, Result};

/// Largest number of points or measurements.
const MOST: usize = 100_000;

/// Checks that a number lies in a range.
fn within<T: PartialOrd + std::fmt::Display>(name: &'static str, value: T, [least, most]: [T; 2]) -> Result<()> {
    if least <= value && value <= most {
        return Ok(());
    }
    Err(Error::InvalidOption { name, reason: format!("must be from {least} to {most}, not {value}") })
}

#[cfg(test)]
mod tests;
