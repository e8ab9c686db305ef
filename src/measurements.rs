//! The paper's image measurements: pixel positions and image derivatives, checked once, normalised for the algebra.

use crate::error::{Error, Result};
use crate::motion::AffineMotion;
use crate::workspace::{Buffer, kept};

/// Largest absolute value a measurement may have: products of degree 20 (n = 10) must stay finite after normalisation.
const LARGEST: f64 = 1e12;

kept!([f64; 2], [f64; 3]);

/// N image measurements `(x_j, y_j)`: positions `(x, y)` and derivatives `(I_x, I_y, I_t)`.
///
/// Positions are in pixels (or any unit: the motions come out in the same), derivatives in grey levels per pixel and per frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurements {
    positions: Buffer<[f64; 2]>,
    derivatives: Buffer<[f64; 3]>,
}

/// The change of coordinates of [`Measurements::normalised`], to carry motions back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normalisation {
    /// Centre of the positions' bounding box.
    pub centre: [f64; 2],
    /// Half of the longer side of the bounding box (1 where all positions are the same).
    pub scale: f64,
    /// Root mean square length of the derivatives (1 where all are zero).
    pub intensity: f64,
}

impl Measurements {
    /// Measurements from two lists of equal length.
    ///
    /// # Errors
    /// [`Error::MeasurementCountMismatch`], [`Error::NotFinite`].
    pub fn new(positions: Vec<[f64; 2]>, derivatives: Vec<[f64; 3]>) -> Result<Self> {
        Self::checked(positions.into(), derivatives.into())
    }

    /// [`Measurements::new`] of buffers.
    pub(crate) fn checked(positions: Buffer<[f64; 2]>, derivatives: Buffer<[f64; 3]>) -> Result<Self> {
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

    /// Number of measurements, N.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are none.
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

    /// The measurements with the given indices, in that order. Indices out of range are left out.
    pub fn subset(&self, indices: &[usize]) -> Measurements {
        let valid = || indices.iter().filter(|&&j| j < self.len());
        Measurements {
            positions: valid().map(|&j| self.positions[j]).collect(),
            derivatives: valid().map(|&j| self.derivatives[j]).collect(),
        }
    }

    /// Positions in [−1, 1]², derivatives of unit root mean square: one isotropic change of coordinates and one global
    /// factor, so that noise that was equal on all derivatives stays equal. Every estimator works in these coordinates:
    /// the conditioning of the embedded data depends on them more than on the choice of basis (measured up to n = 10).
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
    /// A motion found on the normalised measurements, in the coordinates of the original ones.
    pub fn restore(&self, motion: &AffineMotion) -> AffineMotion {
        motion.from_normalised(self.centre, self.scale)
    }

    /// A motion of the original measurements, in normalised coordinates.
    pub fn apply(&self, motion: &AffineMotion) -> AffineMotion {
        motion.in_normalised(self.centre, self.scale)
    }
}
