//! The paper's nonlinear refinement (section 3.4): the Levenberg–Marquardt method on the algebraic error (19),
//! `E(A_1 … A_n) = Σ_j (Π_i y_jᵀA_i x_j)²`.
//!
//! With r_i = yᵀA_i x and φ = (I_x x, I_x y, I_x, I_y x, I_y y, I_y), the derivative of the product with respect to the six entries of
//! A_i is (Π_{k≠i} r_k) φ. The products without one factor are computed from the products before and after it, without division.
//!
//! **Limit.** (19) weights a measurement by its residuals for all *other* motions, so its minimum does not tend to the true motions as the
//! number of measurements grows (measured: 6 to 38 times the error of the best estimator for N = 20 000).

use nalgebra::{Cholesky, DMatrix, DVector};

use super::report::{Report, Termination};
use crate::measurements::Measurements;
use crate::motion::AffineMotion;

/// Maximum number of accepted steps.
pub const MAX_ITERATIONS: usize = 100;
/// Maximum number of dampings tried for a step.
const MAX_DAMPINGS: usize = 12;
/// The iteration has converged if a step lowers the cost by less than this share.
const COST_TOLERANCE: f64 = 1e-10;
/// The initial damping.
const FIRST_DAMPING: f64 = 1e-3;
/// The factor by which the damping changes.
const DAMPING_FACTOR: f64 = 6.0;
/// Smallest damping. Also the smallest diagonal entry that damping is proportional to, relative to the largest.
const SMALLEST: f64 = 1e-12;

/// The residual Π_i yᵀA_i x of (19) on one measurement. Its gradient with respect to all 6n entries is written to `gradient`, whose
/// length must be 6n.
///
/// ```
/// use veronese::AffineMotion;
/// use veronese::refinement::product::residual_and_gradient;
///
/// let motions = [AffineMotion::translation(1.0, 0.0), AffineMotion::translation(0.0, 2.0)];
/// let mut gradient = [0.0; 12];
/// let residual = residual_and_gradient(&motions, [3.0, 4.0], [1.0, 2.0, 0.5], &mut gradient);
/// assert_eq!(residual, 1.5 * 4.5);
/// assert_eq!(gradient[..6], [13.5, 18.0, 4.5, 27.0, 36.0, 9.0]); // 4.5 (I_x x, I_x y, I_x, I_y x, I_y y, I_y)
/// ```
pub fn residual_and_gradient(
    motions: &[AffineMotion],
    position: [f64; 2],
    derivatives: [f64; 3],
    gradient: &mut [f64],
) -> f64 {
    let ([x, y], [ix, iy, _]) = (position, derivatives);
    let features = [ix * x, ix * y, ix, iy * x, iy * y, iy];
    // Forward: the products of the factors before each motion. Backward: multiplied by the products of those after it.
    let mut product = 1.0;
    for (motion, part) in motions.iter().zip(gradient.chunks_exact_mut(6)) {
        part[0] = product;
        product *= motion.residual(position, derivatives);
    }
    let mut after = 1.0;
    for (motion, part) in motions.iter().zip(gradient.chunks_exact_mut(6)).rev() {
        let others = part[0] * after;
        for (g, feature) in part.iter_mut().zip(features) {
            *g = others * feature;
        }
        after *= motion.residual(position, derivatives);
    }
    product
}

/// The algebraic error E of (19).
///
/// ```
/// use veronese::refinement::product::cost;
/// use veronese::{AffineMotion, Measurements};
///
/// let data = Measurements::new(vec![[0.0, 0.0], [1.0, 1.0]], vec![[1.0, 0.0, -2.0], [0.0, 1.0, 3.0]])?;
/// assert_eq!(cost(&[AffineMotion::STATIC], &data), 13.0); // 2² + 3²
/// assert_eq!(cost(&[AffineMotion::STATIC, AffineMotion::translation(2.0, -3.0)], &data), 0.0);
/// # Ok::<(), veronese::Error>(())
/// ```
pub fn cost(motions: &[AffineMotion], measurements: &Measurements) -> f64 {
    let product = |(x, y): ([f64; 2], [f64; 3])| motions.iter().map(|a| a.residual(x, y)).product::<f64>();
    measurements.iter().map(|measurement| product(measurement) * product(measurement)).sum()
}

/// Minimises (19) by the Levenberg–Marquardt method. Returns the motions and a report.
///
/// `measurements` should be normalised. For one motion, the problem is linear least squares. There are at most [`MAX_ITERATIONS`] steps
/// of 2N(6n)² + O(n³) operations. If the data determine nothing (all derivatives are zero), the result is `start`.
///
/// ```
/// use veronese::refinement::product::{cost, refine};
/// # use veronese::{Measurements, Random};
/// use veronese::AffineMotion;
///
/// # fn main() -> veronese::Result<()> {
/// let truth = [AffineMotion::translation(0.5, 0.0), AffineMotion::new([0.1, -0.2, -0.5, 0.2, 0.1, 0.3])];
/// # let mut random = Random::from_seed(1);
/// # let positions: Vec<_> = (0..200).map(|_| [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)]).collect();
/// # let derivative = |(j, &[x, y]): (usize, &[f64; 2])| {
/// #     let ([u, v], [ix, iy]) = (truth[j % 2].flow(x, y), [random.normal(), random.normal()]);
/// #     [ix, iy, -ix * u - iy * v]
/// # };
/// # let derivatives = positions.iter().enumerate().map(derivative).collect();
/// # let data = Measurements::new(positions, derivatives)?;
/// // `data` are 200 measurements of the two motions, without noise.
/// let start = truth.map(|motion| AffineMotion::new(motion.matrix.map(|entry| entry + 0.05)));
/// let (refined, report) = refine(&start, &data);
/// assert!(report.was_successful() && report.final_cost < 1e-12 * report.initial_cost);
/// assert_eq!(report.final_cost, cost(&refined, &data));
/// assert!(truth.iter().zip(&refined).all(|(motion, found)| motion.relative_error(found) < 1e-6));
/// # Ok(())
/// # }
/// ```
pub fn refine(start: &[AffineMotion], measurements: &Measurements) -> (Vec<AffineMotion>, Report) {
    let mut motions = start.to_vec();
    let initial_cost = cost(&motions, measurements);
    let mut report =
        Report { termination: Termination::MaxIterations, iterations: 0, initial_cost, final_cost: initial_cost };
    let mut damping = FIRST_DAMPING;
    while report.iterations < MAX_ITERATIONS {
        if report.final_cost == 0.0 {
            report.termination = Termination::Converged;
            break;
        }
        let equations = NormalEquations::at(&motions, measurements);
        let Some((next, next_cost)) = equations.lower(&motions, measurements, report.final_cost, &mut damping) else {
            report.termination = Termination::Stalled;
            break;
        };
        let gain = report.final_cost - next_cost;
        let converged = gain < COST_TOLERANCE * report.final_cost;
        motions = next;
        report.iterations += 1;
        report.final_cost = next_cost;
        if converged {
            report.termination = Termination::Converged;
            break;
        }
    }
    (motions, report)
}

/// JᵀJ (6n × 6n, lower triangle) and Jᵀr (6n) of the residuals.
struct NormalEquations {
    matrix: DMatrix<f64>,
    gradient: DVector<f64>,
}

impl NormalEquations {
    fn at(motions: &[AffineMotion], measurements: &Measurements) -> Self {
        let size = 6 * motions.len();
        let mut matrix = DMatrix::zeros(size, size);
        let mut gradient = DVector::zeros(size);
        let mut row = vec![0.0; size];
        for (x, y) in measurements.iter() {
            let residual = residual_and_gradient(motions, x, y, &mut row);
            for (k, &value) in row.iter().enumerate() {
                gradient[k] += value * residual;
                // The lower triangle, column by column, which is all that Cholesky reads.
                let column = &mut matrix.as_mut_slice()[k * size + k..(k + 1) * size];
                for (sum, other) in column.iter_mut().zip(&row[k..]) {
                    *sum += value * other;
                }
            }
        }
        NormalEquations { matrix, gradient }
    }

    /// The first step that lowers the cost `present`, with increasing damping; `None` if there is none.
    fn lower(
        &self,
        motions: &[AffineMotion],
        measurements: &Measurements,
        present: f64,
        damping: &mut f64,
    ) -> Option<(Vec<AffineMotion>, f64)> {
        let largest = self.matrix.diagonal().amax();
        if !(largest > 0.0 && largest.is_finite()) {
            return None;
        }
        for _ in 0..MAX_DAMPINGS {
            let mut damped = self.matrix.clone();
            for k in 0..damped.nrows() {
                damped[(k, k)] += *damping * damped[(k, k)].max(SMALLEST * largest);
            }
            if let Some(factors) = Cholesky::new(damped) {
                let step = factors.solve(&self.gradient);
                let next: Vec<AffineMotion> = motions
                    .iter()
                    .enumerate()
                    .map(|(i, a)| subtracted(a, &step.as_slice()[6 * i..6 * i + 6]))
                    .collect();
                let next_cost = cost(&next, measurements);
                if next_cost < present {
                    *damping = (*damping / DAMPING_FACTOR).max(SMALLEST);
                    return Some((next, next_cost));
                }
            }
            *damping *= DAMPING_FACTOR;
        }
        None
    }
}

fn subtracted(motion: &AffineMotion, step: &[f64]) -> AffineMotion {
    let mut matrix = motion.matrix;
    for (entry, s) in matrix.iter_mut().zip(step) {
        *entry -= s;
    }
    AffineMotion::new(matrix)
}
