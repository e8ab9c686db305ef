//! The dominant motion: the affine motion that explains most of the frame, and the change of brightness between the frames.

use super::alignment::{Alignment, Convergence, Freedom, Support, align};
use crate::motion::AffineMotion;
use crate::view::brightness::GainBias;
use crate::view::cost::{RobustKernel, cost_with};
use crate::view::level::PairLevel;

/// How the dominant motion is found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DominantSearch {
    /// Whether a change of brightness is estimated.
    pub(crate) brightness: bool,
    /// The entries that must converge.
    pub(crate) convergence: Convergence,
}

/// The dominant motion of the working frame and the change of brightness (none unless it is estimated), from the levels `base` and coarser.
/// Near a motion that is expected, the base level is enough.
pub(crate) fn dominant_motion(
    levels: &[PairLevel],
    base: usize,
    expected: Option<&AffineMotion>,
    how: DominantSearch,
) -> (AffineMotion, GainBias) {
    let finest = &levels[base].thinned();
    let levels = if expected.is_some() { &levels[..=base] } else { levels };
    let coarsest = if expected.is_some() { finest } else { &levels[levels.len() - 1] };
    let start = match how.brightness {
        true => GainBias::from_moments(&coarsest.first, &coarsest.second, coarsest.model),
        false => GainBias::default(),
    };
    let mut candidates = match expected {
        Some(motion) => vec![*motion],
        None => vec![AffineMotion::STATIC, best_shift(coarsest, start)],
    };
    candidates.dedup();
    let mut best = static_candidate(finest, start, how.brightness);
    for candidate in candidates {
        let (motion, photometric) = descend(levels, base, finest, candidate, start, how);
        let sum = cost_with(finest, &motion, photometric, RobustKernel::estimation(finest.model)).total();
        if sum < best.0 {
            best = (sum, motion, photometric);
        }
    }
    (best.1, best.2)
}

/// The whole-pixel shift at the coarsest level with the smallest cost.
fn best_shift(level: &PairLevel, photometric: GainBias) -> AffineMotion {
    let mut best = (f64::INFINITY, AffineMotion::STATIC);
    let reach = level.model.reach;
    for dx in -reach..=reach {
        for dy in -reach..=reach {
            let (dx, dy) = (f64::from(dx), f64::from(dy));
            let shift = AffineMotion::translation(dx * level.pixel(), dy * level.pixel());
            let plane = cost_with(level, &shift, photometric, RobustKernel::estimation(level.model));
            let cost = plane.total() / plane.values().len() as f64
                + f64::from(level.model.shift_penalty) * (dx * dx + dy * dy).sqrt();
            if cost < best.0 {
                best = (cost, shift);
            }
        }
    }
    best.1
}

/// Coarse to fine from one start: translation first, then affine.
fn descend(
    levels: &[PairLevel],
    base: usize,
    finest: &PairLevel,
    mut motion: AffineMotion,
    mut photometric: GainBias,
    how: DominantSearch,
) -> (AffineMotion, GainBias) {
    let model = levels[base].model;
    let affine = Alignment {
        freedom: Freedom::Affine,
        iterations: model.dominant_iterations,
        convergence: how.convergence,
        truncation: model.truncation,
        ridge: model.ridge_background,
        photometric: how.brightness,
    };
    let translation = Alignment {
        freedom: Freedom::Translation,
        iterations: model.dominant_iterations,
        truncation: model.truncation_loose,
        ..affine
    };
    for (index, level) in levels.iter().enumerate().skip(base).rev() {
        let level = if index == base { finest } else { level };
        let support = Support::everything(level);
        if index + 1 == levels.len() {
            motion = align(level, &motion, &support, &mut photometric, translation);
        }
        motion = align(level, &motion, &support, &mut photometric, affine);
    }
    (motion, photometric)
}

/// The zero motion: only the change of brightness is fitted.
fn static_candidate(level: &PairLevel, mut photometric: GainBias, brightness: bool) -> (f64, AffineMotion, GainBias) {
    if brightness {
        photometric = photometric.refined_at_rest(level);
    }
    let cost = cost_with(level, &AffineMotion::STATIC, photometric, RobustKernel::estimation(level.model)).total();
    (cost, AffineMotion::STATIC, photometric)
}
