//! A motion refined on a region of the labels: when it was selected it had another one.

use super::mask_of;
use crate::alignment::cost::Photometric;
use crate::alignment::gauss_newton::{Alignment, Freedom, Support, align};
use crate::frame::Plane;
use crate::frame::pyramid::Level;
use crate::motion::AffineMotion;

/// Iterations on the region of a label.
const ITERATIONS: usize = 3;
/// Prior against linear terms of an object's motion.
const RIDGE: f64 = 1e-2;

/// The motion of an object refined on the pixels of its label.
pub(crate) fn refitted(level: &Level, motion: &AffineMotion, labels: &[u8], label: u8) -> AffineMotion {
    aligned_on(level, motion, &mask_of(labels, label, level.width(), level.height()), ITERATIONS, RIDGE)
}

/// A motion refined on the pixels of a mask.
pub(super) fn aligned_on(
    level: &Level,
    motion: &AffineMotion,
    mask: &Plane,
    iterations: usize,
    ridge: f64,
) -> AffineMotion {
    let how = Alignment { freedom: Freedom::Affine, iterations, robustness: 4.0, ridge, photometric: false };
    align(level, motion, &Support::weighted(mask), &mut Photometric::default(), how)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labelling::merging::tests::{SIZE, level};

    #[test]
    fn a_motion_found_on_a_part_is_that_of_the_whole_afterwards() {
        let (level, labels) = level([2.0, 1.0]);
        let bent = AffineMotion::new([0.01, 0.0, 1.6, 0.0, -0.01, 1.1]);
        let found = refitted(&level, &bent, &labels, 1);
        for p in (0..labels.len()).filter(|&p| labels[p] == 1) {
            let [u, v] = found.flow((p % SIZE[0]) as f64, (p / SIZE[0]) as f64);
            assert!((u - 2.0).abs() < 0.05 && (v - 1.0).abs() < 0.05, "{u}, {v}");
        }
    }
}
