//! The experiment of the paper's Figure 1 (protocol B1) as problems with known solutions, and the oracle, which knows the labels.
//!
//! Positions are uniform in [−1, 1]², the six entries of each motion uniform in [−1, 1]. Labels alternate. `y` is uniform on the unit
//! circle orthogonal to `A x`, plus noise uniform in [−p, p] on every component. The `y` of an outlier is uniform on the unit sphere.

use veronese::factorisation::assignment::assign;
use veronese::{AffineMotion, Measurements, Random, Result};

/// Parameters of a problem.
#[derive(Clone, Debug)]
pub struct Protocol {
    /// Number of motions.
    pub motions: usize,
    /// Number of measurements.
    pub count: usize,
    /// Half width p of the noise.
    pub noise: f64,
    /// Share of outliers.
    pub outliers: f64,
    /// Share of the first motion; the others have equal shares. `None` for equal shares of all.
    pub first_share: Option<f64>,
    /// Configuration of the motions.
    pub relation: Relation,
}

/// General and special configurations of motions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Relation {
    /// Independent entries.
    General,
    /// The second motion has this Euclidean distance (of the six entries) from the first.
    Near(f64),
    /// Equal entries (1, 3).
    EqualA13,
    /// Equal entries (2, 3).
    EqualA23,
    /// Equal translations.
    EqualTranslation,
    /// Equal linear parts.
    EqualLinear,
    /// One motion is a translation.
    OneTranslation,
    /// One motion is static.
    Static,
    /// One motion is static, one a translation.
    StaticAndTranslation,
    /// One motion has u = 0 and v constant.
    RankOne,
    /// One motion has u = 0.
    RankTwo,
    /// The linear part of one motion has rows that are multiples of each other.
    ProportionalRows,
    /// All motions are translations.
    Translations,
    /// All motions are similarities.
    Similarities,
}

/// All special configurations.
pub const SPECIAL: [Relation; 12] = [
    Relation::EqualA13,
    Relation::EqualA23,
    Relation::EqualTranslation,
    Relation::EqualLinear,
    Relation::OneTranslation,
    Relation::Static,
    Relation::StaticAndTranslation,
    Relation::RankOne,
    Relation::RankTwo,
    Relation::ProportionalRows,
    Relation::Translations,
    Relation::Similarities,
];

/// A problem and its solution.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The measurements.
    pub measurements: Measurements,
    /// The true motions.
    pub motions: Vec<AffineMotion>,
    /// The motion of every measurement, `None` for an outlier.
    pub labels: Vec<Option<usize>>,
}

impl Protocol {
    /// n general motions with equal shares, 600 measurements, noise p, no outliers.
    pub fn new(motions: usize, noise: f64) -> Self {
        Protocol { motions, count: 600, noise, outliers: 0.0, first_share: None, relation: Relation::General }
    }

    /// The problem of a seed.
    ///
    /// # Panics
    /// Without motions, with [`Relation::Near`] and a single one, and for noise that is not finite.
    #[allow(clippy::expect_used, reason = "with finite noise, measurements of the motions that are drawn are finite")]
    pub fn problem(&self, seed: u64) -> Problem {
        let random = &mut Random::from_seed(seed);
        let motions = self.draw_motions(random);
        let first = self.first_share.map(|share| (share * self.count as f64) as usize);
        let label = |j: usize| match first {
            Some(first) if self.motions > 1 => {
                if j < first {
                    0
                } else {
                    1 + j % (self.motions - 1)
                }
            }
            _ => j % self.motions,
        };
        let labels: Vec<usize> = (0..self.count).map(label).collect();
        Problem::measured(motions, &labels, self.outliers, self.noise, random).expect("finite numbers")
    }

    fn draw_motions(&self, random: &mut Random) -> Vec<AffineMotion> {
        let mut a: Vec<[f64; 6]> =
            (0..self.motions).map(|_| std::array::from_fn(|_| random.uniform(-1.0, 1.0))).collect();
        let first = a[0];
        match self.relation {
            Relation::General => {}
            Relation::Near(distance) => {
                let step: [f64; 6] = std::array::from_fn(|_| random.normal());
                let length = step.iter().map(|s| s * s).sum::<f64>().sqrt();
                a[1] = std::array::from_fn(|k| first[k] + distance * step[k] / length);
            }
            Relation::EqualA13 => a.iter_mut().for_each(|m| m[2] = first[2]),
            Relation::EqualA23 => a.iter_mut().for_each(|m| m[5] = first[5]),
            Relation::EqualTranslation => a.iter_mut().for_each(|m| (m[2], m[5]) = (first[2], first[5])),
            Relation::EqualLinear => a.iter_mut().for_each(|m| {
                *m = [first[0], first[1], m[2], first[3], first[4], m[5]];
            }),
            Relation::OneTranslation => a[0] = [0.0, 0.0, first[2], 0.0, 0.0, first[5]],
            Relation::Static => a[0] = [0.0; 6],
            Relation::StaticAndTranslation => {
                a[0] = [0.0; 6];
                if let Some(second) = a.get_mut(1) {
                    *second = [0.0, 0.0, second[2], 0.0, 0.0, second[5]];
                }
            }
            Relation::RankOne => a[0] = [0.0, 0.0, 0.0, 0.0, 0.0, first[5]],
            Relation::RankTwo => a[0] = [0.0, 0.0, 0.0, first[3], first[4], first[5]],
            Relation::ProportionalRows => (a[0][3], a[0][4]) = (0.5 * first[0], 0.5 * first[1]),
            Relation::Translations => a.iter_mut().for_each(|m| *m = [0.0, 0.0, m[2], 0.0, 0.0, m[5]]),
            Relation::Similarities => a.iter_mut().for_each(|m| *m = [m[0], m[1], m[2], -m[1], m[0], m[5]]),
        }
        a.into_iter().map(AffineMotion::new).collect()
    }
}

impl Problem {
    /// Measurements of given motions: measurement j is one of motion `labels[j]`, or an outlier.
    ///
    /// # Errors
    /// [`NotFinite`](veronese::Error::NotFinite) for motions or noise so large that derivatives are not finite numbers.
    pub fn measured(
        motions: Vec<AffineMotion>,
        labels: &[usize],
        outliers: f64,
        noise: f64,
        random: &mut Random,
    ) -> Result<Problem> {
        let (mut positions, mut derivatives, mut true_labels) = (Vec::new(), Vec::new(), Vec::new());
        for &label in labels {
            let (x, y) = (random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
            let [u, v] = motions[label].flow(x, y);
            let mut direction: [f64; 3] = std::array::from_fn(|_| random.normal());
            let outlier = random.unit() < outliers;
            if !outlier {
                let along = (direction[0] * u + direction[1] * v + direction[2]) / (u * u + v * v + 1.0);
                direction = [direction[0] - along * u, direction[1] - along * v, direction[2] - along];
            }
            let length = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
            positions.push([x, y]);
            derivatives.push(direction.map(|d| d / length + random.uniform(-noise, noise)));
            true_labels.push((!outlier).then_some(label));
        }
        let measurements = Measurements::new(positions, derivatives)?;
        Ok(Problem { measurements, motions, labels: true_labels })
    }

    /// The least squares estimate of each motion from its own measurements: maximum likelihood if the noise were normal.
    pub fn oracle(&self) -> Vec<AffineMotion> {
        (0..self.motions.len())
            .map(|i| {
                let own: Vec<usize> = (0..self.labels.len()).filter(|&j| self.labels[j] == Some(i)).collect();
                fit_one(&self.measurements.subset(&own), self.motions[i])
            })
            .collect()
    }

    /// Mean and largest relative error (eq. 20) under the best assignment.
    pub fn errors(&self, found: &[AffineMotion]) -> (f64, f64) {
        if found.len() != self.motions.len() {
            return (f64::INFINITY, f64::INFINITY);
        }
        let costs: Vec<Vec<f64>> =
            self.motions.iter().map(|a| found.iter().map(|b| a.relative_error(b)).collect()).collect();
        let errors = assign(&costs).into_iter().zip(&costs).map(|(k, row)| row[k]);
        errors.fold((0.0, 0.0), |(mean, largest), error| (mean + error / found.len() as f64, error.max(largest)))
    }
}

/// Gauss-Newton on the distances of one motion, starting from the true motion.
fn fit_one(own: &Measurements, start: AffineMotion) -> AffineMotion {
    let mut a = start.matrix;
    for _ in 0..10 {
        let mut normal = nalgebra::Matrix6::<f64>::zeros();
        let mut right = nalgebra::Vector6::<f64>::zeros();
        for ([x, y], [ix, iy, it]) in own.iter() {
            let [u, v] = AffineMotion::new(a).flow(x, y);
            let (r, s) = (ix * u + iy * v + it, u * u + v * v + 1.0);
            let m = s.sqrt();
            let (gx, gy) = ((ix - r * u / s) / m, (iy - r * v / s) / m);
            let j = nalgebra::Vector6::new(gx * x, gx * y, gx, gy * x, gy * y, gy);
            normal += j * j.transpose();
            right -= j * (r / m);
        }
        let Some(step) = normal.cholesky().map(|c| c.solve(&right)) else { break };
        (0..6).for_each(|k| a[k] += step[k]);
    }
    AffineMotion::new(a)
}
