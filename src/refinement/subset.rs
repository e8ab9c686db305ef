//! Selection of n motions from many hypotheses. The cost of a measurement is its squared distance from the nearest selected motion, up to
//! a cap.
//!
//! Squares, not absolute values: two slightly different copies of one motion share its measurements and reduce many small distances. In a
//! sum of absolute distances, that gains as much as a missing motion with a twentieth of the measurements; in a sum of squares it does
//! not.

use super::mixture::capped_squares;
use super::samples::Samples;

/// Passes of exchanging single hypotheses. More than two rarely change anything.
const EXCHANGES: usize = 3;
/// Number of independent partial sums.
const LANES: usize = 8;

/// The indices of the `n` hypotheses (all if there are fewer) with the smallest `Σ_j min(cap², min_i d_ij²)`: greedy selection, then
/// exchange of single hypotheses while that lowers the cost.
pub(crate) fn choose(samples: &Samples, hypotheses: &[[f64; 6]], n: usize, cap: f64) -> Vec<usize> {
    let width = samples.len();
    let n = n.min(hypotheses.len());
    let mut table = Vec::with_capacity(hypotheses.len() * width);
    hypotheses.iter().for_each(|motion| capped_squares(samples, motion, cap, &mut table));
    let row = |k: usize| &table[k * width..(k + 1) * width];
    let best_beside = |others: &[f32]| {
        let mut best = (f64::INFINITY, 0);
        for k in 0..hypotheses.len() {
            let cost = joint_cost(others, row(k));
            if cost < best.0 {
                best = (cost, k);
            }
        }
        best
    };
    let mut chosen = Vec::with_capacity(n);
    let most = (cap * cap) as f32;
    let mut nearest = vec![most; width];
    let mut cost = f64::INFINITY;
    for _ in 0..n {
        let (least, k) = best_beside(&nearest);
        chosen.push(k);
        cost = least;
        lower(&mut nearest, row(k));
    }
    for _ in 0..if n > 1 { EXCHANGES } else { 0 } {
        let before = cost;
        for i in 0..n {
            nearest.fill(most);
            for (_, &k) in chosen.iter().enumerate().filter(|&(j, _)| j != i) {
                lower(&mut nearest, row(k));
            }
            let (least, k) = best_beside(&nearest);
            if least < cost * (1.0 - 1e-9) {
                chosen[i] = k;
                cost = least;
            }
        }
        if cost >= before {
            break;
        }
    }
    chosen
}

/// `a_j ← min(a_j, b_j)`; `f32::min` would also handle NaN.
fn lower(a: &mut [f32], b: &[f32]) {
    a.iter_mut().zip(b).for_each(|(a, &b)| *a = if b < *a { b } else { *a });
}

/// `Σ_j min(a_j, b_j)`.
fn joint_cost(a: &[f32], b: &[f32]) -> f64 {
    let mut sums = [0.0_f32; LANES];
    let (a_rows, b_rows) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest: f32 = a_rows.remainder().iter().zip(b_rows.remainder()).map(|(p, q)| p.min(*q)).sum();
    for (p, q) in a_rows.zip(b_rows) {
        for l in 0..LANES {
            sums[l] += if p[l] < q[l] { p[l] } else { q[l] };
        }
    }
    sums.iter().map(|&s| f64::from(s)).sum::<f64>() + f64::from(rest)
}
