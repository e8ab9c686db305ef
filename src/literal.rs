//! The image experiment of the paper, step by step as written there (section 4): derivatives, selection of the pixels with a strong
//! temporal derivative, Problem 1 on these pixels.
//!
//! It serves for comparison; use [`segment_pair`](crate::segment_pair) for results. One pixel gives one equation for the two components
//! of its flow, so the labels of single pixels are noisy in textured images. Pixels that are not selected have no label, and the
//! selection assumes a static background.

use serde::Serialize;

use crate::answer::{MotionFit, UNLABELLED};
use crate::error::{Error, Result};
use crate::frame::{Frame, derivatives};
use crate::measurements::Measurements;
use crate::options::{FitOptions, Method, MotionCount};
use crate::points::fit_motions;

/// The paper's threshold on |I_t|, for intensities scaled to [0, 1].
pub const PAPER_THRESHOLD: f64 = 0.115;

/// Which pixels [`literal_pair`] uses.
///
/// ```
/// use veronese::{KeptPixels, PAPER_THRESHOLD};
///
/// assert_eq!(KeptPixels::default(), KeptPixels::Above(PAPER_THRESHOLD));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KeptPixels {
    /// Pixels with |I_t| above this threshold, at least 0, for intensities scaled to [0, 1].
    Above(f64),
    /// This share of all pixels, 0 to 1, those with the largest |I_t|. The paper keeps 1995 of 150 × 200 pixels, a share of 0.0665.
    Strongest(f64),
}

impl Default for KeptPixels {
    fn default() -> Self {
        KeptPixels::Above(PAPER_THRESHOLD)
    }
}

/// The result of [`literal_pair`].
#[non_exhaustive]
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
    /// The motions, in pixels, with the stages of [`Method::Paper`]. Its labels are those of the kept pixels in raster order.
    pub fit: MotionFit,
}

/// Segments a pair of frames as the paper does: [`Method::Paper`] on the measurements of the kept pixels, each of which gets the label
/// of the motion with the smallest |yᵀAx|.
///
/// With `before`, the frame before the first, derivatives use three frames and are smoothed in time; without it they use two.
///
/// ```
/// use veronese::{KeptPixels, MotionCount, UNLABELLED, literal_pair};
///
/// # fn main() -> veronese::Result<()> {
/// # let scene = scenes::leader_follower(2)?;
/// # let (before, first, second) = (scene.before(), scene.first(), scene.second());
/// let kept = KeptPixels::Strongest(0.0665);
/// let found = literal_pair(first, second, Some(before), kept, MotionCount::Given(2))?;
/// assert_eq!((found.fit.count, found.labels.len()), (2, 200 * 150));
/// assert_eq!(found.labels.iter().filter(|&&label| label != UNLABELLED).count(), found.kept);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`Error::FrameSizeMismatch`]; [`Error::InvalidOption`] `threshold` or `motions`; [`Error::TooFewMeasurements`] if too few pixels
/// are kept.
pub fn literal_pair(
    first: &Frame,
    second: &Frame,
    before: Option<&Frame>,
    threshold: KeptPixels,
    motions: MotionCount,
) -> Result<LiteralSegmentation> {
    motions.validate()?;
    first.check_size_of(second)?;
    before.map_or(Ok(()), |before| first.check_size_of(before))?;
    let y = derivatives(first, second, before);
    let kept = kept_pixels(y.t.values(), threshold)?;
    if kept.len() < 6 {
        return Err(Error::TooFewMeasurements { motions: 1, needed: 6, found: kept.len() });
    }
    let (width, height) = (first.width(), first.height());
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

/// The kept pixels in raster order. A pixel with I_t = 0 is never kept.
fn kept_pixels(change: &[f32], threshold: KeptPixels) -> Result<Vec<usize>> {
    let invalid = |reason: String| Err(Error::InvalidOption { name: "threshold", reason });
    let limit = match threshold {
        KeptPixels::Above(limit) if limit >= 0.0 && limit.is_finite() => limit as f32,
        KeptPixels::Above(limit) => return invalid(format!("must be a number of at least 0, not {limit}")),
        KeptPixels::Strongest(share) if (0.0..=1.0).contains(&share) => {
            let mut sizes: Vec<f32> = change.iter().map(|t| t.abs()).collect();
            sizes.sort_by(|a, b| b.total_cmp(a));
            // The largest value that is not kept. Pixels equal to it are not kept either.
            sizes.get((share * change.len() as f64) as usize).copied().unwrap_or(0.0)
        }
        KeptPixels::Strongest(share) => return invalid(format!("must be a share from 0 to 1, not {share}")),
    };
    Ok((0..change.len()).filter(|&p| change[p].abs() > limit).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
