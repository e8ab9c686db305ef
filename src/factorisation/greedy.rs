//! The choice of n motions from many hypotheses.

use crate::measurements::Measurements;
use crate::motion::AffineMotion;

/// Maximum number of passes of replacing single hypotheses.
const MAX_PASSES: usize = 3;
/// A replacement must lower the cost by this share, so that rounding cannot cause cycles.
const LEAST_GAIN: f64 = 1e-9;

/// The result of [`choose`].
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Indices of the chosen hypotheses, in the order in which they were added.
    pub indices: Vec<usize>,
    /// Σ_j min_i min(|d_ij|, cap), with d_ij the distance of measurement j from motion i.
    pub cost: f64,
}

/// The n = `motions` hypotheses that together explain the measurements best. The cost of a measurement is its distance
/// ([`AffineMotion::distance`]) from the nearest of them, at most `cap` (infinity for no limit).
///
/// The method is greedy: n times, the hypothesis that lowers the total cost most is added; then single hypotheses are replaced while
/// that lowers the cost, in at most three passes. A hypothesis may be chosen twice if none lowers the cost. The time is proportional to
/// n times the number of hypotheses times the number of measurements. Without hypotheses, the result is empty.
///
/// ```
/// use veronese::factorisation::choose;
/// use veronese::{AffineMotion, Measurements};
///
/// // Measurements of the displacements (1, 0) and (0, 2).
/// let positions = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
/// let derivatives = vec![[1.0, 1.0, -1.0], [1.0, 0.5, -1.0], [1.0, 1.0, -2.0], [0.5, 1.0, -2.0]];
/// let data = Measurements::new(positions, derivatives)?;
/// let hypotheses = [[1.0, 2.0], [1.0, 0.0], [5.0, 5.0], [0.0, 2.0]].map(|[u, v]| AffineMotion::translation(u, v));
/// let mut choice = choose(&hypotheses, &data, 2, f64::INFINITY);
/// choice.indices.sort_unstable();
/// assert_eq!((choice.indices, choice.cost), (vec![1, 3], 0.0));
/// # Ok::<(), veronese::Error>(())
/// ```
pub fn choose(hypotheses: &[AffineMotion], measurements: &Measurements, motions: usize, cap: f64) -> Choice {
    if hypotheses.is_empty() || motions == 0 {
        return Choice { indices: Vec::new(), cost: f64::INFINITY };
    }
    let distances: Vec<Vec<f64>> = hypotheses
        .iter()
        .map(|a| measurements.iter().map(|(x, y)| a.distance(x, y).abs().min(cap)).collect())
        .collect();
    let mut indices: Vec<usize> = Vec::with_capacity(motions);
    let mut nearest = vec![f64::MAX; measurements.len()];
    let mut cost = f64::MAX;
    for _ in 0..motions {
        let (index, sum) = best_addition(&distances, &nearest);
        indices.push(index);
        lower(&mut nearest, &distances[index]);
        cost = sum;
    }
    for _ in 0..MAX_PASSES {
        let mut changed = false;
        for i in 0..motions {
            let mut others = vec![f64::MAX; measurements.len()];
            for (_, &k) in indices.iter().enumerate().filter(|(j, _)| *j != i) {
                lower(&mut others, &distances[k]);
            }
            let (index, sum) = best_addition(&distances, &others);
            if sum < cost * (1.0 - LEAST_GAIN) {
                (indices[i], cost, changed) = (index, sum, true);
            }
        }
        if !changed {
            break;
        }
    }
    Choice { indices, cost }
}

/// The hypothesis with the smallest sum of distances if the others leave the distances `nearest`, and that sum.
fn best_addition(distances: &[Vec<f64>], nearest: &[f64]) -> (usize, f64) {
    let mut best = (0, f64::INFINITY);
    for (index, row) in distances.iter().enumerate() {
        let sum = sum_of_smaller(row, nearest);
        if sum < best.1 {
            best = (index, sum);
        }
    }
    best
}

/// Σ_j min(a_j, b_j), in four lanes.
fn sum_of_smaller(a: &[f64], b: &[f64]) -> f64 {
    let length = a.len().min(b.len());
    let (a, a_rest) = a[..length].as_chunks::<4>();
    let (b, b_rest) = b[..length].as_chunks::<4>();
    let mut lanes = [0.0; 4];
    for (p, q) in a.iter().zip(b) {
        for k in 0..4 {
            lanes[k] += if p[k] < q[k] { p[k] } else { q[k] };
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(p, q)| p.min(*q)).sum();
    (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]) + rest
}

fn lower(nearest: &mut [f64], row: &[f64]) {
    for (n, d) in nearest.iter_mut().zip(row) {
        *n = n.min(*d);
    }
}
