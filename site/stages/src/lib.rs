//! The steps of the method one by one, for the figures of the site. `calls` hands them to JavaScript.
//!
//! The functions compute nothing of their own: they run the parts of [`veronese`] and hand out what those give each other.
//!
//! * [`veronese_map`]: points embedded by the Veronese map, and the polynomial that vanishes on them;
//! * [`multibody_flow`]: several translations from one polynomial in the derivatives (eq. 13 and 14);
//! * [`grey_derivatives`]: image derivatives in grey levels;
//! * [`paper_stages`]: the paper's algorithm step by step, with the ambiguity of its fifth step, and differentiation beside it;
//! * [`motions_at_pixel`]: differentiation at one pixel; [`embedded_spectra`]: the singular values behind the rank rule;
//! * [`segment_pair_stages`](veronese::stages::segment_pair_stages) of the crate: the image pipeline with what its stages find;
//! * [`motion_measurements`] and [`figure_1_trial`]: generated measurements and one trial of the paper's Figure 1, by
//!   [`scenes::protocol`].
//!
//! Where the image pipeline leaves the paper, and why:
//!
//! * **Derivatives** are taken where a rough local flow lands, not at the pixel itself: those of the paper are linear for motions of a
//!   fraction of a pixel only.
//! * **The dominant motion** is found first, on the intensities, and its pixels count little in the constraint. The paper leaves out pixels
//!   that do not move, to the same end: n motions more evenly shared are better conditioned.
//! * **The constraint** proposes translations beside the dominant motion, from polynomials of several low degrees in the derivatives and the
//!   position, by differentiation. The paper factors one polynomial of the degree that its rank rule finds; on real frames no rank is exact,
//!   and the factorisation of O(n⁴) unknowns is sensitive to noise.
//! * **Windows** propose motions of things that are too small for the polynomial.
//! * **Selection** decides the number of motions: each must gain more than it costs to describe. This takes the place of the rank rule.
//! * **Refinement** compares intensities instead of derivatives (the paper: eq. 19), coarse to fine.
//! * **Labels** minimise an energy in which neighbours agree; the paper gives each pixel the motion of its smallest residual, which is noisy,
//!   as one pixel has one equation for two components.

#[cfg(target_arch = "wasm32")]
pub mod calls;
mod figure_1;
mod fit;
mod flow;
mod grey;
mod map;
mod measured;
mod pixel;
mod spectra;

pub use figure_1::{Figure1Trial, TrialError, figure_1_trial};
pub use fit::{FitStages, paper_stages};
pub use flow::{MultibodyFlow, multibody_flow};
pub use grey::grey_derivatives;
pub use map::{VeroneseMap, veronese_map};
pub use measured::motion_measurements;
pub use pixel::{PixelStages, motions_at_pixel};
pub use spectra::{Spectrum, embedded_spectra};

use veronese::{Error, Result};

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
