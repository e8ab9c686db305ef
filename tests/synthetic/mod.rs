//! Measurements of known motions, after Figure 1 of the paper.
#![allow(dead_code, clippy::unwrap_used, reason = "each test file uses its part; test code may panic")]

use veronese::factorisation::assignment::assign;
use veronese::{AffineMotion, Measurements, Random};

/// Motions whose six entries are uniform in [−1, 1].
pub(crate) fn random_motions(n: usize, random: &mut Random) -> Vec<AffineMotion> {
    (0..n).map(|_| AffineMotion::new(std::array::from_fn(|_| random.uniform(-1.0, 1.0)))).collect()
}

/// `count` measurements of the motions; measurement j belongs to motion j mod n. Positions are uniform in [−1, 1]², y is uniform on the unit
/// circle orthogonal to A x, plus uniform noise on every component.
pub(crate) fn measurements(motions: &[AffineMotion], count: usize, noise: f64, random: &mut Random) -> Measurements {
    let mut positions = Vec::with_capacity(count);
    let mut derivatives = Vec::with_capacity(count);
    for j in 0..count {
        let [x, y] = [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)];
        let [u, v] = motions[j % motions.len()].flow(x, y);
        let g: [f64; 3] = std::array::from_fn(|_| random.normal());
        let share = (g[0] * u + g[1] * v + g[2]) / (u * u + v * v + 1.0);
        let across = [g[0] - share * u, g[1] - share * v, g[2] - share];
        let length = across.iter().map(|c| c * c).sum::<f64>().sqrt();
        positions.push([x, y]);
        derivatives.push(across.map(|c| c / length + random.uniform(-noise, noise)));
    }
    Measurements::new(positions, derivatives).unwrap()
}

/// Relative errors (eq. 20) of the true motions under the best assignment.
pub(crate) fn errors(truth: &[AffineMotion], found: &[AffineMotion]) -> Vec<f64> {
    let costs: Vec<Vec<f64>> = truth.iter().map(|a| found.iter().map(|b| a.relative_error(b)).collect()).collect();
    let partner = assign(&costs);
    partner.iter().enumerate().map(|(i, &k)| costs[i].get(k).copied().unwrap_or(f64::INFINITY)).collect()
}

/// The largest of [`errors`].
pub(crate) fn worst_error(truth: &[AffineMotion], found: &[AffineMotion]) -> f64 {
    errors(truth, found).into_iter().fold(0.0, f64::max)
}

/// A special configuration of motions: its name, and a function that makes it from generic motions.
pub(crate) type Configuration = (&'static str, fn(&mut [AffineMotion]));

/// The generic configuration, and those for which the paper's factorisation is undefined, ambiguous or unproven.
pub(crate) const CONFIGURATIONS: [Configuration; 13] = [
    ("generic", |_| {}),
    ("equal (1,3)", |motions| share(motions, &[2])),
    ("equal (2,3)", |motions| share(motions, &[5])),
    ("equal (1,3) and (2,3)", |motions| share(motions, &[2, 5])),
    ("equal linear parts", |motions| share(motions, &[0, 1, 3, 4])),
    ("one translation", |motions| clear(&mut motions[0], &[0, 1, 3, 4])),
    ("static background", |motions| motions[0] = AffineMotion::STATIC),
    ("static and translation", |motions| {
        motions[0] = AffineMotion::STATIC;
        clear(&mut motions[1], &[0, 1, 3, 4]);
    }),
    ("rank 1", |motions| clear(&mut motions[0], &[0, 1, 2, 3, 4])),
    ("rank 2", |motions| {
        let first = motions[0].matrix;
        (motions[0].matrix[3], motions[0].matrix[4]) = (0.5 * first[0], 0.5 * first[1]);
    }),
    ("one zero row", |motions| clear(&mut motions[0], &[3, 4, 5])),
    ("all translations", |motions| motions.iter_mut().for_each(|a| clear(a, &[0, 1, 3, 4]))),
    ("all similarities", |motions| {
        for a in motions {
            (a.matrix[3], a.matrix[4]) = (-a.matrix[1], a.matrix[0]);
        }
    }),
];

/// Gives all motions the given entries of the first.
fn share(motions: &mut [AffineMotion], entries: &[usize]) {
    let first = motions[0].matrix;
    for a in motions {
        entries.iter().for_each(|&k| a.matrix[k] = first[k]);
    }
}

fn clear(motion: &mut AffineMotion, entries: &[usize]) {
    entries.iter().for_each(|&k| motion.matrix[k] = 0.0);
}
