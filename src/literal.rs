//! The paper's own image experiment, literally (section 4): derivatives, the pixels with a strong temporal derivative,
//! Problem 1 on them. It is here to be compared with; [`segment_pair`](crate::segment_pair) is what to use.
//!
//! One pixel gives one equation for two unknowns of flow, so that on textured images the labels of single pixels are noisy,
//! and a moving background is not foreseen: the pixels left out are simply not labelled.

use serde::Serialize;

use crate::answer::{MotionFit, UNLABELLED};
use crate::error::{Error, Result};
use crate::frame::{Frame, derivatives};
use crate::measurements::Measurements;
use crate::options::{FitOptions, Method, MotionCount};
use crate::points::fit_motions;

/// The threshold on |I_t| of the paper's experiment, for images scaled to [0, 1].
pub const PAPER_THRESHOLD: f64 = 0.115;

/// Which pixels take part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KeptPixels {
    /// Those with |I_t| above this, the image scaled to [0, 1].
    Above(f64),
    /// This share of all pixels, those with the largest |I_t|; 0…1. The paper's 1995 of 150 × 200 pixels are 0.0665.
    Strongest(f64),
}

impl Default for KeptPixels {
    fn default() -> Self {
        KeptPixels::Above(PAPER_THRESHOLD)
    }
}

/// What the paper's method makes of a pair.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct LiteralSegmentation {
    /// Width of the frames, pixels.
    pub width: usize,
    /// Height of the frames, pixels.
    pub height: usize,
    /// One label per pixel, row by row; [`UNLABELLED`] for pixels that were not kept.
    #[serde(skip)]
    pub labels: Vec<u8>,
    /// Number of pixels kept, N.
    pub kept: usize,
    /// The motions, pixels per frame, and the stages they come from. Its labels are those of the kept pixels in raster
    /// order.
    pub fit: MotionFit,
}

/// Segments a pair as the paper does: the measurements (x, y) of the kept pixels, Problem 1 by the paper's method, every
/// kept pixel to the motion with the smallest |yᵀAx|.
///
/// With `before` the derivatives use three frames, as filters with smoothing in time need; without it two.
///
/// # Errors
/// [`Error::FrameSizeMismatch`], [`Error::InvalidOption`] (`threshold`, `motions`), and
/// [`Error::TooFewMeasurements`] where too few pixels change.
pub fn literal_pair(
    first: &Frame,
    second: &Frame,
    before: Option<&Frame>,
    threshold: KeptPixels,
    motions: MotionCount,
) -> Result<LiteralSegmentation> {
    motions.validate()?;
    let size = (first.width(), first.height());
    for other in [Some(second), before].into_iter().flatten() {
        if (other.width(), other.height()) != size {
            return Err(Error::FrameSizeMismatch { first: size, second: (other.width(), other.height()) });
        }
    }
    let y = derivatives(first, second, before);
    let kept = kept_pixels(y.t.values(), threshold)?;
    if kept.len() < 6 {
        return Err(Error::TooFewMeasurements { motions: 1, needed: 6, found: kept.len() });
    }
    let (width, height) = size;
    let positions = kept.iter().map(|&p| [(p % width) as f64, (p / width) as f64]).collect();
    let at = |p: usize| [y.x.values()[p], y.y.values()[p], y.t.values()[p]].map(f64::from);
    let measurements = Measurements::new(positions, kept.iter().map(|&p| at(p)).collect())?;
    let options = FitOptions { motions, method: Method::Paper, ..FitOptions::default() };
    let fit = fit_motions(&measurements, &options, &mut |_| {})?;
    let mut labels = vec![UNLABELLED; width * height];
    for (&p, &label) in kept.iter().zip(&fit.labels) {
        labels[p] = label;
    }
    Ok(LiteralSegmentation { width, height, labels, kept: kept.len(), fit })
}

/// The pixels that take part, in raster order. A pixel without any change never does.
fn kept_pixels(change: &[f32], threshold: KeptPixels) -> Result<Vec<usize>> {
    let invalid = |reason: String| Err(Error::InvalidOption { name: "threshold", reason });
    let limit = match threshold {
        KeptPixels::Above(limit) if limit >= 0.0 && limit.is_finite() => limit as f32,
        KeptPixels::Above(limit) => return invalid(format!("must be a number of at least 0, not {limit}")),
        KeptPixels::Strongest(share) if (0.0..=1.0).contains(&share) => {
            let mut sizes: Vec<f32> = change.iter().map(|t| t.abs()).collect();
            sizes.sort_by(|a, b| b.total_cmp(a));
            // The first value that is no longer kept: what equals it is not kept either.
            sizes.get((share * change.len() as f64) as usize).copied().unwrap_or(0.0)
        }
        KeptPixels::Strongest(share) => return invalid(format!("must be a share from 0 to 1, not {share}")),
    };
    Ok((0..change.len()).filter(|&p| change[p].abs() > limit).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    #[test]
    fn the_pixels_kept_are_those_above_the_threshold() {
        let change = [0.0, 0.2, -0.3, 0.1, -0.05];
        assert_eq!(kept_pixels(&change, KeptPixels::default()).unwrap(), [1, 2]);
        assert_eq!(kept_pixels(&change, KeptPixels::Strongest(0.6)).unwrap(), [1, 2, 3]);
        assert_eq!(kept_pixels(&change, KeptPixels::Strongest(1.0)).unwrap(), [1, 2, 3, 4]);
        assert!(kept_pixels(&change, KeptPixels::Strongest(0.0)).unwrap().is_empty());
        for bad in [KeptPixels::Above(f64::NAN), KeptPixels::Above(-0.1), KeptPixels::Strongest(1.5)] {
            assert_eq!(kept_pixels(&change, bad).unwrap_err().code(), "invalid-option");
        }
    }

    #[test]
    fn what_cannot_be_processed_is_refused() {
        let scene = scene::leader_follower(1).unwrap();
        let frame = scene.first();
        let run = |second: &Frame, motions| literal_pair(frame, second, None, KeptPixels::default(), motions);
        assert_eq!(run(frame, MotionCount::Auto).unwrap_err().code(), "too-few-measurements");
        assert_eq!(run(frame, MotionCount::Given(11)).unwrap_err().code(), "invalid-option");
        let small = Frame::from_rgba(20, 20, &[0; 1600]).unwrap();
        assert_eq!(run(&small, MotionCount::Auto).unwrap_err().code(), "frame-size-mismatch");
    }
}
