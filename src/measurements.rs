//! The paper's image measurements: positions and image derivatives, validated on construction, normalised for the algebra.

use crate::error::{Error, Result};
use crate::motion::AffineMotion;

/// Largest absolute value of an entry of a measurement: products of degree 20 (n = 10) must stay finite after normalisation.
const LARGEST: f64 = 1e12;

/// N image measurements `(x_j, y_j)`: positions `(x, y)` and derivatives `(I_x, I_y, I_t)`.
///
/// Positions are in pixels, derivatives in grey levels per pixel and grey levels per frame. Other units work too; motions have the unit
/// of the positions.
///
/// ```
/// use veronese::{AffineMotion, Measurements, Random};
///
/// // Measurements of a known motion: I_t follows from the gradient (I_x, I_y) by brightness constancy (eq. 3).
/// let motion = AffineMotion::new([0.01, -0.02, 1.5, 0.02, 0.01, -0.5]);
/// let mut random = Random::from_seed(1);
/// let (mut positions, mut derivatives) = (Vec::new(), Vec::new());
/// for _ in 0..100 {
///     let [x, y] = [random.uniform(0.0, 320.0), random.uniform(0.0, 240.0)];
///     let ([u, v], [ix, iy]) = (motion.flow(x, y), [random.normal(), random.normal()]);
///     positions.push([x, y]);
///     derivatives.push([ix, iy, -ix * u - iy * v]);
/// }
/// let measurements = Measurements::new(positions, derivatives)?;
/// assert_eq!(measurements.len(), 100);
/// assert!(measurements.iter().all(|(position, derivatives)| motion.residual(position, derivatives).abs() < 1e-12));
/// # Ok::<(), veronese::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Measurements {
    positions: Vec<[f64; 2]>,
    derivatives: Vec<[f64; 3]>,
}

/// The change of coordinates made by [`Measurements::normalised`], which converts motions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normalisation {
    /// Centre of the bounding box of the positions.
    pub centre: [f64; 2],
    /// Half of the longer side of the bounding box; 1 if all positions are the same.
    pub scale: f64,
    /// Root mean square length of the derivatives; 1 if all are zero.
    pub intensity: f64,
}

impl Measurements {
    /// Measurements from two lists of equal length.
    ///
    /// # Errors
    /// [`Error::MeasurementCountMismatch`] for lists of different length; [`Error::NotFinite`] for an entry that is not finite or whose
    /// absolute value exceeds 10¹².
    pub fn new(positions: Vec<[f64; 2]>, derivatives: Vec<[f64; 3]>) -> Result<Self> {
        if positions.len() != derivatives.len() {
            return Err(Error::MeasurementCountMismatch { positions: positions.len(), derivatives: derivatives.len() });
        }
        let usable = |v: &f64| v.is_finite() && v.abs() <= LARGEST;
        if let Some(index) = positions.iter().position(|p| !p.iter().all(usable)) {
            return Err(Error::NotFinite { what: "position", index });
        }
        if let Some(index) = derivatives.iter().position(|y| !y.iter().all(usable)) {
            return Err(Error::NotFinite { what: "derivative", index });
        }
        Ok(Measurements { positions, derivatives })
    }

    /// Rejects fewer measurements than a number of motions needs.
    pub(crate) fn check_number(&self, motions: usize, needed: usize) -> Result<()> {
        let found = self.len();
        if found < needed { Err(Error::TooFewMeasurements { motions, needed, found }) } else { Ok(()) }
    }

    /// Number of measurements, N.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are no measurements.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Positions `(x, y)`.
    pub fn positions(&self) -> &[[f64; 2]] {
        &self.positions
    }

    /// Derivatives `(I_x, I_y, I_t)`.
    pub fn derivatives(&self) -> &[[f64; 3]] {
        &self.derivatives
    }

    /// Positions and derivatives, pairwise.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = ([f64; 2], [f64; 3])> + '_ {
        self.positions.iter().copied().zip(self.derivatives.iter().copied())
    }

    /// The measurements with the given indices, in that order. Indices out of range are skipped.
    ///
    /// ```
    /// use veronese::Measurements;
    ///
    /// let all = Measurements::new(vec![[0.0, 0.0], [1.0, 2.0]], vec![[1.0, 0.0, 0.5], [0.0, 1.0, 0.25]])?;
    /// let one = all.subset(&[1, 7]);
    /// assert_eq!((one.positions(), one.derivatives()), (&[[1.0, 2.0]][..], &[[0.0, 1.0, 0.25]][..]));
    /// # Ok::<(), veronese::Error>(())
    /// ```
    pub fn subset(&self, indices: &[usize]) -> Measurements {
        let valid = || indices.iter().filter(|&&j| j < self.len());
        Measurements {
            positions: valid().map(|&j| self.positions[j]).collect(),
            derivatives: valid().map(|&j| self.derivatives[j]).collect(),
        }
    }

    /// The measurements with positions in [−1, 1]² and derivatives of root mean square length 1, and the change of coordinates.
    ///
    /// Positions are scaled isotropically and derivatives by one common factor, so noise of equal variance on all derivatives keeps
    /// equal variances. All estimators work in these coordinates. They matter more for the conditioning of the embedded data than the
    /// choice of polynomial basis (measured up to n = 10).
    ///
    /// ```
    /// use veronese::{AffineMotion, Measurements};
    ///
    /// let positions = vec![[0.0, 0.0], [320.0, 0.0], [320.0, 240.0]];
    /// let data = Measurements::new(positions, vec![[30.0, 40.0, 0.0]; 3])?;
    /// let (normalised, normalisation) = data.normalised();
    /// assert_eq!((normalisation.centre, normalisation.scale, normalisation.intensity), ([160.0, 120.0], 160.0, 50.0));
    /// assert_eq!(normalised.positions()[0], [-1.0, -0.75]);
    /// assert_eq!(normalised.derivatives()[0], [0.6, 0.8, 0.0]);
    ///
    /// let motion = AffineMotion::translation(2.0, 1.0);
    /// assert_eq!(normalisation.restore(&normalisation.apply(&motion)), motion);
    /// # Ok::<(), veronese::Error>(())
    /// ```
    pub fn normalised(&self) -> (Measurements, Normalisation) {
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for p in &self.positions {
            for k in 0..2 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        let extent = (high[0] - low[0]).max(high[1] - low[1]);
        let (centre, scale) = if extent > 0.0 && extent.is_finite() {
            ([0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])], 0.5 * extent)
        } else {
            (self.positions.first().copied().unwrap_or([0.0; 2]), 1.0)
        };
        let squares: f64 = self.derivatives.iter().map(|y| y[0] * y[0] + y[1] * y[1] + y[2] * y[2]).sum();
        let rms = (squares / self.len().max(1) as f64).sqrt();
        let intensity = if rms > 0.0 { rms } else { 1.0 };
        let normalisation = Normalisation { centre, scale, intensity };
        let positions =
            self.positions.iter().map(|p| [(p[0] - centre[0]) / scale, (p[1] - centre[1]) / scale]).collect();
        let derivatives =
            self.derivatives.iter().map(|y| [y[0] / intensity, y[1] / intensity, y[2] / intensity]).collect();
        (Measurements { positions, derivatives }, normalisation)
    }
}

impl Normalisation {
    /// Converts a motion from normalised to original coordinates.
    pub fn restore(&self, motion: &AffineMotion) -> AffineMotion {
        motion.from_normalised(self.centre, self.scale)
    }

    /// Converts a motion from original to normalised coordinates.
    pub fn apply(&self, motion: &AffineMotion) -> AffineMotion {
        motion.in_normalised(self.centre, self.scale)
    }
}
