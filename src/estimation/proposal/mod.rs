//! Candidate motions: from the multibody affine constraint on pixels that the dominant motion does not explain, and from the local flow of
//! single windows.

pub(crate) mod algebraic;
mod clustering;
pub(crate) mod local_flow;
pub(crate) mod tiles;

use crate::model::Model;
use crate::motion::AffineMotion;

/// A candidate motion, and where it was observed, pixels of the working frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Proposal {
    pub(crate) motion: AffineMotion,
    pub(crate) place: [f64; 2],
}

/// A motion plus a translation.
pub(crate) fn translated(motion: &AffineMotion, u: f64, v: f64) -> AffineMotion {
    let mut a = motion.matrix;
    a[2] += u;
    a[5] += v;
    AffineMotion::new(a)
}

/// Drops every proposal that agrees with an earlier one to within `tolerance` pixels around its position; keeps at most `most`.
pub(crate) fn distinct(
    proposals: impl Iterator<Item = Proposal>,
    tolerance: f64,
    [width, height]: [f64; 2],
    most: usize,
    model: &Model,
) -> Vec<AffineMotion> {
    let mut kept: Vec<AffineMotion> = Vec::new();
    for Proposal { motion, place: [x, y] } in proposals {
        if kept.len() >= most {
            break;
        }
        let points = [(x, y), (x + model.distinct_span * width, y), (x, y + model.distinct_span * height)];
        let alike = |other: &AffineMotion| {
            points.iter().all(|&(x, y)| {
                let ([u, v], [p, q]) = (motion.flow(x, y), other.flow(x, y));
                (u - p).abs() <= tolerance && (v - q).abs() <= tolerance
            })
        };
        if !kept.iter().any(alike) {
            kept.push(motion);
        }
    }
    kept
}
