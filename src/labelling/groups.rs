//! Motions that belong together: a continuous surface has a continuous flow, so two neighbouring regions whose motions agree
//! along their common border are one (a slanted plane, the layers of a rigid background).

use crate::motion::AffineMotion;
use crate::order::median_f64;

/// A common border shorter than this many pixel pairs decides nothing.
const SHORTEST_BORDER: usize = 12;
/// Flows that differ by less than this (median along the border, pixels) are continuous …
const TOLERANCE: f64 = 0.3;
/// … or by less than this share of the largest jump in the frame.
const RELATIVE_TOLERANCE: f64 = 0.2;

/// The group of every motion, as the smallest label in it. `motions` in pixels of the label grid, one of which has `reduction`
/// pixels of the frame.
pub(crate) fn groups(motions: &[AffineMotion], labels: &[u8], width: usize, reduction: f64) -> Vec<usize> {
    let n = motions.len();
    let mut jumps: Vec<(f64, usize, usize)> = Vec::new();
    for (i, j, along) in borders(motions, labels, width) {
        if along.len() >= SHORTEST_BORDER {
            jumps.extend(median_f64(&along).map(|jump| (jump, i, j)));
        }
    }
    let largest = jumps.iter().fold(0.0f64, |m, j| m.max(j.0));
    let tolerance = (TOLERANCE / reduction).max(RELATIVE_TOLERANCE * largest);
    let mut group: Vec<usize> = (0..n).collect();
    for (jump, i, j) in jumps {
        if jump < tolerance {
            let (keep, drop) = (group[i].min(group[j]), group[i].max(group[j]));
            group.iter_mut().filter(|g| **g == drop).for_each(|g| *g = keep);
        }
    }
    group
}

/// For every pair of labels that touch: how far their flows differ at each border pixel.
fn borders(motions: &[AffineMotion], labels: &[u8], width: usize) -> Vec<(usize, usize, Vec<f64>)> {
    let n = motions.len();
    let mut found: Vec<Vec<f64>> = vec![Vec::new(); n * n];
    let mut note = |p: usize, q: usize| {
        let (i, j) = (usize::from(labels[p].min(labels[q])), usize::from(labels[p].max(labels[q])));
        if i != j && j < n {
            let (x, y) = ((p % width) as f64, (p / width) as f64);
            let ([u, v], [r, s]) = (motions[i].flow(x, y), motions[j].flow(x, y));
            found[i * n + j].push(((u - r) * (u - r) + (v - s) * (v - s)).sqrt());
        }
    };
    for p in 0..labels.len() {
        if (p + 1) % width != 0 {
            note(p, p + 1);
        }
        if p + width < labels.len() {
            note(p, p + width);
        }
    }
    found.into_iter().enumerate().filter(|(_, f)| !f.is_empty()).map(|(k, f)| (k / n, k % n, f)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_continuous_surface_is_one_group_and_a_jump_is_two() {
        // Left third, middle third, right third; flow continuous at x = 20, jumping at x = 40.
        let labels: Vec<u8> = (0..60 * 30).map(|p| ((p % 60) / 20) as u8).collect();
        let motions = [
            AffineMotion::translation(1.0, 0.0),
            AffineMotion::new([0.05, 0.0, 0.0, 0.0, 0.0, 0.0]),
            AffineMotion::translation(7.0, 0.0),
        ];
        assert_eq!(groups(&motions, &labels, 60, 1.0), [0, 0, 2]);
    }
}
