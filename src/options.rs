//! The options of the public functions and their validation.

use crate::error::{Error, Result};

/// Largest number of motions. [`Method::Paper`] needs 2430 measurements for n = 10.
pub const MAX_MOTIONS: usize = 10;

/// How many motions to look for.
///
/// ```
/// use veronese::{MAX_MOTIONS, MotionCount};
///
/// assert_eq!(MotionCount::default(), MotionCount::Auto);
/// assert!(MotionCount::Given(MAX_MOTIONS).validate().is_ok());
/// assert_eq!(MotionCount::Given(0).validate().unwrap_err().code(), "invalid-option");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum MotionCount {
    /// Estimate the number.
    #[default]
    Auto,
    /// Exactly this many, 1 to [`MAX_MOTIONS`].
    Given(usize),
}

impl MotionCount {
    /// Checks a given number. The functions that take options call this themselves.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] for a number outside 1 to [`MAX_MOTIONS`].
    pub fn validate(self) -> Result<()> {
        match self {
            MotionCount::Given(n) if n == 0 || n > MAX_MOTIONS => Err(Error::InvalidOption {
                name: "motions",
                reason: format!("must be 'auto' or a whole number from 1 to {MAX_MOTIONS}, not {n}"),
            }),
            _ => Ok(()),
        }
    }
}

/// The algorithm of [`fit_motions`](crate::fit_motions).
///
/// ```
/// use veronese::{FitOptions, Measurements, Method, MotionCount, fit_motions};
///
/// # fn main() -> veronese::Result<()> {
/// // A horizontal and a vertical gradient at each of nine positions; all of them move by (0.5, -0.25).
/// let positions: Vec<[f64; 2]> = (0..18).map(|j| [f64::from(j % 3), f64::from(j / 3 % 3)]).collect();
/// let derivatives = (0..18).map(|j| if j < 9 { [2.0, 0.0, -1.0] } else { [0.0, 2.0, 0.5] }).collect();
/// let data = Measurements::new(positions, derivatives)?;
/// for method in [Method::Paper, Method::Best] {
///     let options = FitOptions::default().with_motions(MotionCount::Given(1)).with_method(method);
///     let fit = fit_motions(&data, &options, &mut |_| {})?;
///     let [u, v] = fit.motions[0].matrix.flow(1.0, 1.0);
///     assert!((u - 0.5).abs() < 1e-6 && (v + 0.25).abs() < 1e-6);
///     assert_eq!(fit.stages.is_some(), method == Method::Paper); // the intermediate results of the paper
/// }
/// # Ok(())
/// # }
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Method {
    /// The paper's algorithm: rank rule (12), five-step factorisation (section 3.3), nonlinear refinement of (19). Each measurement gets
    /// the label of its smallest residual; none is an outlier. See [`paper`](crate::paper).
    Paper,
    /// Maximum likelihood: expectation-maximisation of a mixture of motions with a class of outliers, from many starts. More accurate
    /// than [`Method::Paper`] on noisy data.
    #[default]
    Best,
}

impl Method {
    /// Its name in options and reports.
    pub const fn name(self) -> &'static str {
        match self {
            Method::Paper => "paper",
            Method::Best => "best",
        }
    }
}

/// How much work to spend on a pair of frames.
///
/// ```
/// use veronese::{Quality, SegmentOptions, segment_pair};
///
/// # fn main() -> veronese::Result<()> {
/// # let scene = scenes::generate(&scenes::SceneOptions { width: 160, height: 120, objects: 1, ..Default::default() })?;
/// # let (first, second) = (scene.first(), scene.second());
/// for quality in [Quality::Fast, Quality::Best] {
///     let options = SegmentOptions::default().with_quality(quality);
///     let found = segment_pair(first, second, &options, &mut |_| {})?;
///     assert_eq!(found.labels.len(), 160 * 120); // labels always have the size of the frames
/// }
/// # Ok(())
/// # }
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Quality {
    /// For live video: frames are processed at 320 pixels or less (longer side), with fewer candidate motions.
    Fast,
    /// For stored results: frames are processed at 480 pixels or less (longer side), large pairs at 960 in the end.
    #[default]
    Best,
}

impl Quality {
    /// Its name in options and reports.
    pub const fn name(self) -> &'static str {
        match self {
            Quality::Fast => "fast",
            Quality::Best => "best",
        }
    }
}

/// Options of [`fit_motions`](crate::fit_motions).
///
/// ```
/// use veronese::{FitOptions, Method, MotionCount};
///
/// let options = FitOptions::default().with_motions(MotionCount::Given(3));
/// assert_eq!((options.method, options.seed), (Method::Best, 1));
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FitOptions {
    /// Number of motions; default [`MotionCount::Auto`].
    pub motions: MotionCount,
    /// Algorithm; default [`Method::Best`].
    pub method: Method,
    /// Seed of the random numbers; default 1.
    pub seed: u64,
}

impl Default for FitOptions {
    fn default() -> Self {
        FitOptions { motions: MotionCount::Auto, method: Method::Best, seed: 1 }
    }
}

impl FitOptions {
    /// The same with another [`motions`](Self::motions).
    #[must_use]
    pub const fn with_motions(self, motions: MotionCount) -> FitOptions {
        FitOptions { motions, ..self }
    }

    /// The same with another [`method`](Self::method).
    #[must_use]
    pub const fn with_method(self, method: Method) -> FitOptions {
        FitOptions { method, ..self }
    }

    /// The same with another [`seed`](Self::seed).
    #[must_use]
    pub const fn with_seed(self, seed: u64) -> FitOptions {
        FitOptions { seed, ..self }
    }
}

/// Options of [`segment_pair`](crate::segment_pair).
///
/// ```
/// use veronese::{MotionCount, SegmentOptions, UNLABELLED, segment_pair};
///
/// # fn main() -> veronese::Result<()> {
/// # let scene = scenes::generate(&scenes::SceneOptions { width: 96, height: 72, ..Default::default() })?;
/// # let (first, second) = (scene.first(), scene.second());
/// let options = SegmentOptions::default().with_motions(MotionCount::Given(2)).with_mark_unknown(true).with_confidence(true);
/// let found = segment_pair(first, second, &options, &mut |_| {})?;
/// assert_eq!(found.count, 2);
/// assert_eq!(found.labels.iter().filter(|&&label| label == UNLABELLED).count(), found.unlabelled);
/// assert_eq!(found.confidence.map(|confidence| confidence.len()), Some(96 * 72));
/// # Ok(())
/// # }
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct SegmentOptions {
    /// Number of motions; default [`MotionCount::Auto`].
    pub motions: MotionCount,
    /// How much work to spend; default [`Quality::Best`].
    pub quality: Quality,
    /// Label a pixel [`UNLABELLED`](crate::UNLABELLED) if it is occluded or outside in the second frame, has no texture around it, or has a
    /// label that is more likely wrong than right; default `false`.
    pub mark_unknown: bool,
    /// Compute [`Segmentation::confidence`](crate::Segmentation::confidence), the probability that the label of a pixel is right;
    /// default `false`.
    pub confidence: bool,
    /// Treat the main subject as the only object, as for a cut-out, and everything else as background, even if it moves; default `false`.
    pub subject: bool,
}

impl SegmentOptions {
    /// The same with another [`motions`](Self::motions).
    #[must_use]
    pub const fn with_motions(self, motions: MotionCount) -> SegmentOptions {
        SegmentOptions { motions, ..self }
    }

    /// The same with another [`quality`](Self::quality).
    #[must_use]
    pub const fn with_quality(self, quality: Quality) -> SegmentOptions {
        SegmentOptions { quality, ..self }
    }

    /// The same with another [`mark_unknown`](Self::mark_unknown).
    #[must_use]
    pub const fn with_mark_unknown(self, mark_unknown: bool) -> SegmentOptions {
        SegmentOptions { mark_unknown, ..self }
    }

    /// The same with another [`confidence`](Self::confidence).
    #[must_use]
    pub const fn with_confidence(self, confidence: bool) -> SegmentOptions {
        SegmentOptions { confidence, ..self }
    }

    /// The same with another [`subject`](Self::subject).
    #[must_use]
    pub const fn with_subject(self, subject: bool) -> SegmentOptions {
        SegmentOptions { subject, ..self }
    }
}
