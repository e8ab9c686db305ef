//! The error type of the crate: why an input cannot be processed.
//!
//! Ambiguous data are not an error but a result with scores, and a solver that stops early returns a report. See "Three kinds of outcome"
//! in ARCHITECTURE.md.

/// Why an input cannot be processed. Every variant has a stable [`code`](Error::code).
#[non_exhaustive]
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// Two frames that are processed together differ in size.
    #[error("the frames differ in size: {}×{} and {}×{} pixels", first.0, first.1, second.0, second.1)]
    FrameSizeMismatch {
        /// Width and height of the first frame.
        first: (usize, usize),
        /// Width and height of the frame that differs.
        second: (usize, usize),
    },
    /// A frame is too small or too large to be processed.
    #[error(
        "a frame of {width}×{height} pixels cannot be processed: both sides must be between {min} and {max} pixels"
    )]
    FrameSizeUnsupported {
        /// Width in pixels.
        width: usize,
        /// Height in pixels.
        height: usize,
        /// Smallest side.
        min: usize,
        /// Largest side.
        max: usize,
    },
    /// The bytes of a frame do not fill width × height RGBA pixels.
    #[error("a frame of {width}×{height} pixels needs {needed} RGBA bytes, found {found}")]
    PixelCountMismatch {
        /// Width in pixels.
        width: usize,
        /// Height in pixels.
        height: usize,
        /// Bytes needed.
        needed: usize,
        /// Bytes found.
        found: usize,
    },
    /// Positions and derivatives differ in number.
    #[error("there are {positions} positions but {derivatives} derivatives")]
    MeasurementCountMismatch {
        /// Number of positions.
        positions: usize,
        /// Number of derivatives.
        derivatives: usize,
    },
    /// There are fewer measurements than the method needs.
    #[error("{motions} motion(s) need at least {needed} measurements, found {found}")]
    TooFewMeasurements {
        /// Number of motions asked for (or tried first).
        motions: usize,
        /// Measurements needed.
        needed: usize,
        /// Measurements found.
        found: usize,
    },
    /// A number is NaN, infinite or too large to compute with.
    #[error("{what} number {index} is not a finite number of usable size")]
    NotFinite {
        /// "position" or "derivative".
        what: &'static str,
        /// Index in the input.
        index: usize,
    },
    /// An option has an invalid value.
    #[error("option '{name}': {reason}")]
    InvalidOption {
        /// The option's name.
        name: &'static str,
        /// Why it is wrong, and which values are valid.
        reason: String,
    },
    /// A frame of a clip was read again and had other pixels.
    #[error("frame {index} is not the one that was segmented")]
    OtherFrame {
        /// Index of the frame, from 0.
        index: usize,
    },
    /// An annotation would change a locked object.
    #[error("object {object} is locked: unlock it to change it")]
    ObjectLocked {
        /// Its number.
        object: u8,
    },
    /// A file is not an image in a supported format, or is damaged.
    #[error("the image cannot be read: {reason}")]
    UnreadableImage {
        /// The decoder's message.
        reason: String,
    },
}

impl Error {
    /// A stable kebab-case code, the same on the command line and in JavaScript. The message ([`Display`](std::fmt::Display)) may change.
    ///
    /// ```
    /// use veronese::{Frame, Measurements};
    ///
    /// assert_eq!(Frame::from_rgba(32, 32, &[0; 12][..]).unwrap_err().code(), "pixel-count-mismatch");
    /// let error = Measurements::new(vec![[0.0, 0.0]], vec![[1.0, f64::NAN, 0.0]]).unwrap_err();
    /// assert_eq!(error.code(), "not-finite");
    /// assert_eq!(error.to_string(), "derivative number 0 is not a finite number of usable size");
    /// ```
    pub fn code(&self) -> &'static str {
        match self {
            Error::FrameSizeMismatch { .. } => "frame-size-mismatch",
            Error::FrameSizeUnsupported { .. } => "frame-size-unsupported",
            Error::PixelCountMismatch { .. } => "pixel-count-mismatch",
            Error::MeasurementCountMismatch { .. } => "measurement-count-mismatch",
            Error::TooFewMeasurements { .. } => "too-few-measurements",
            Error::NotFinite { .. } => "not-finite",
            Error::InvalidOption { .. } => "invalid-option",
            Error::OtherFrame { .. } => "invalid-input",
            Error::ObjectLocked { .. } => "object-locked",
            Error::UnreadableImage { .. } => "unreadable-image",
        }
    }
}

/// A result with the crate's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;
