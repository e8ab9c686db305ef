//! The dominant motion: the affine motion that explains most of the frame, and the change of brightness between the frames.

use super::alignment::{Alignment, Convergence, Freedom, Support, align};
use crate::motion::AffineMotion;
use crate::view::brightness::Photometric;
use crate::view::cost::{CostModel, cost_with, total};
use crate::view::level::Level;

/// Reach of the search for a start at the coarsest level, pixels of that level. Its square is the price. Not varied.
const REACH: i32 = 3;
/// Mean cost per pixel of length that decides ties for the shorter shift.
const LENGTH_PRICE: f64 = 1e-3;
/// Prior against linear terms: most of the frame determines them. Chosen on generated scenes.
pub(crate) const RIDGE: f64 = 1e-3;
/// Iterations with a translation at the coarsest level, and with an affine motion at every level. Chosen on generated scenes.
const ITERATIONS: [usize; 2] = [6, 5];
/// Robustness of the translation, of the affine motions, and of a last fit at the base level: strict only when the motion is nearly
/// right. Chosen on generated scenes.
const ROBUSTNESS: [f32; 3] = [9.0, 6.0, 2.0];
/// At the base level every second pixel of every second row is enough.
const THINNING: usize = 2;

/// How the dominant motion is found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DominantSearch {
    /// Whether a change of brightness is estimated.
    pub(crate) brightness: bool,
    /// What has to converge.
    pub(crate) convergence: Convergence,
}

/// The dominant motion of the working frame and the change of brightness (none unless it is estimated), from the levels `base` and coarser.
pub(crate) fn dominant_motion(levels: &[Level], base: usize, how: DominantSearch) -> (AffineMotion, Photometric) {
    let coarsest = &levels[levels.len() - 1];
    let start = match how.brightness {
        true => Photometric::from_moments(&coarsest.first, &coarsest.second),
        false => Photometric::default(),
    };
    let mut candidates = vec![AffineMotion::STATIC];
    let shift = best_shift(coarsest, start);
    if shift != AffineMotion::STATIC {
        candidates.push(shift);
    }
    let finest = &levels[base].thinned(THINNING);
    let mut best = static_candidate(finest, start, how.brightness);
    for candidate in candidates {
        let (motion, photometric) = descend(levels, base, finest, candidate, start, how);
        let sum = total(&cost_with(finest, &motion, photometric, CostModel::estimation()));
        if sum < best.0 {
            best = (sum, motion, photometric);
        }
    }
    (best.1, best.2)
}

/// [`dominant_motion`] near one that is expected, from the base level alone.
pub(crate) fn dominant_motion_near(
    levels: &[Level],
    base: usize,
    expected: &AffineMotion,
    how: DominantSearch,
) -> (AffineMotion, Photometric) {
    let finest = &levels[base].thinned(THINNING);
    let start = match how.brightness {
        true => Photometric::from_moments(&finest.first, &finest.second),
        false => Photometric::default(),
    };
    let mut best = static_candidate(finest, start, how.brightness);
    let (motion, photometric) = descend(&levels[..=base], base, finest, *expected, start, how);
    let sum = total(&cost_with(finest, &motion, photometric, CostModel::estimation()));
    if sum < best.0 {
        best = (sum, motion, photometric);
    }
    (best.1, best.2)
}

/// The whole-pixel shift at the coarsest level with the smallest cost.
fn best_shift(level: &Level, photometric: Photometric) -> AffineMotion {
    let mut best = (f64::INFINITY, AffineMotion::STATIC);
    for dx in -REACH..=REACH {
        for dy in -REACH..=REACH {
            let (dx, dy) = (f64::from(dx), f64::from(dy));
            let shift = AffineMotion::translation(dx * level.pixel(), dy * level.pixel());
            let plane = cost_with(level, &shift, photometric, CostModel::estimation());
            let cost = total(&plane) / plane.values().len() as f64 + LENGTH_PRICE * (dx * dx + dy * dy).sqrt();
            if cost < best.0 {
                best = (cost, shift);
            }
        }
    }
    best.1
}

/// Coarse to fine from one start: translation first, then affine, with a stricter robust weight at the end.
fn descend(
    levels: &[Level],
    base: usize,
    finest: &Level,
    mut motion: AffineMotion,
    mut photometric: Photometric,
    how: DominantSearch,
) -> (AffineMotion, Photometric) {
    let affine = Alignment {
        freedom: Freedom::Affine,
        iterations: ITERATIONS[1],
        convergence: how.convergence,
        robustness: ROBUSTNESS[1],
        ridge: RIDGE,
        photometric: how.brightness,
    };
    let translation =
        Alignment { freedom: Freedom::Translation, iterations: ITERATIONS[0], robustness: ROBUSTNESS[0], ..affine };
    let strict = Alignment { robustness: ROBUSTNESS[2], ..affine };
    for (index, level) in levels.iter().enumerate().skip(base).rev() {
        let level = if index == base { finest } else { level };
        let support = Support::everything(level);
        if index + 1 == levels.len() {
            motion = align(level, &motion, &support, &mut photometric, translation);
        }
        motion = align(level, &motion, &support, &mut photometric, affine);
        if index == base {
            motion = align(level, &motion, &support, &mut photometric, strict);
        }
    }
    (motion, photometric)
}

/// The zero motion: only the change of brightness is fitted.
fn static_candidate(level: &Level, mut photometric: Photometric, brightness: bool) -> (f64, AffineMotion, Photometric) {
    if brightness {
        photometric = photometric.refined_at_rest(level);
    }
    let cost = total(&cost_with(level, &AffineMotion::STATIC, photometric, CostModel::estimation()));
    (cost, AffineMotion::STATIC, photometric)
}
