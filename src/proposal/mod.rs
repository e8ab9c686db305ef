//! Motions worth trying: from the multibody affine constraint on what the dominant motion does not explain, and from local
//! motions of single windows.

pub(crate) mod algebraic;
mod clustering;
pub(crate) mod local_flow;
pub(crate) mod tiles;

use crate::motion::AffineMotion;

/// A motion to try, and where in the frame (pixels of the working frame) it was seen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Proposal {
    pub(crate) motion: AffineMotion,
    pub(crate) place: [f64; 2],
}

/// A motion with a translation added at every pixel.
pub(crate) fn translated(motion: &AffineMotion, u: f64, v: f64) -> AffineMotion {
    let mut a = motion.matrix;
    a[2] += u;
    a[5] += v;
    AffineMotion::new(a)
}

/// Leaves out every proposal that moves the neighbourhood of its place (a tenth of the frame's width and height) like an
/// earlier one, to within `tolerance` pixels; at most `most` remain.
pub(crate) fn distinct(
    proposals: &mut dyn Iterator<Item = Proposal>,
    tolerance: f64,
    [width, height]: [f64; 2],
    most: usize,
) -> Vec<AffineMotion> {
    let mut kept: Vec<AffineMotion> = Vec::new();
    for Proposal { motion, place: [x, y] } in proposals {
        if kept.len() >= most {
            break;
        }
        let points = [(x, y), (x + 0.1 * width, y), (x, y + 0.1 * height)];
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
