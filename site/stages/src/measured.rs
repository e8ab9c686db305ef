//! Measurements of motions that are given.

use crate::{MOST, within};
use scenes::protocol::Problem;
use veronese::{AffineMotion, Error, MAX_MOTIONS, Random, Result};

/// Measurements of given motions by the [`protocol`](scenes::protocol) of the paper's Figure 1: positions uniform in [−1, 1]², derivatives
/// of unit length that satisfy brightness constancy, with noise uniform in ±`noise` on every component.
///
/// `shares` are those of the motions, up to scale. Measurements of all motions alternate in these shares. The random numbers do not depend
/// on the motions: with the same seed a motion that changes little changes its measurements little.
///
/// # Errors
/// [`Error::InvalidOption`] for `motions`, `shares`, `count` or `noise` out of range; [`Error::NotFinite`] for motions that are too large.
pub fn motion_measurements(
    motions: &[AffineMotion],
    shares: &[f64],
    count: usize,
    noise: f64,
    seed: u64,
) -> Result<Problem> {
    within("motions", motions.len(), [1, MAX_MOTIONS])?;
    within("count", count, [1, MOST])?;
    within("noise", noise, [0.0, 1.0])?;
    if let Some(index) = motions.iter().position(|motion| !motion.is_finite()) {
        return Err(Error::NotFinite { what: "motion", index });
    }
    let sum: f64 = shares.iter().sum();
    let usable = shares.len() == motions.len() && shares.iter().all(|share| *share >= 0.0) && sum > 0.0;
    if !usable || !sum.is_finite() {
        let reason = format!("must hold a number of at least 0 for each of the {} motions, not all 0", motions.len());
        return Err(Error::InvalidOption { name: "shares", reason });
    }
    let shares: Vec<f64> = shares.iter().map(|share| share / sum).collect();
    Problem::measured(motions.to_vec(), &dealt(&shares, count), 0.0, noise, &mut Random::from_seed(seed))
}

/// `count` labels in the given shares, which have the sum 1. Each goes to the label that lacks most, so that equal shares take turns.
fn dealt(shares: &[f64], count: usize) -> Vec<usize> {
    let mut given = vec![0_usize; shares.len()];
    let next = |dealt: usize| {
        let mut most = (f64::NEG_INFINITY, 0);
        for (label, share) in shares.iter().enumerate().filter(|(_, share)| **share > 0.0) {
            let lack = share * (dealt + 1) as f64 - given[label] as f64;
            if lack > most.0 {
                most = (lack, label);
            }
        }
        given[most.1] += 1;
        most.1
    };
    (0..count).map(next).collect()
}
