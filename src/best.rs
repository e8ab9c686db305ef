//! Our own solution of Problem 1 on points.

use crate::embedding::rank::{MAX_TRIED, number_of_motions};
use crate::error::Result;
use crate::factorisation::choose;
use crate::factorisation::differentiation::{POINTS, algebraic_start};
use crate::measurements::Measurements;
use crate::motion::AffineMotion;
use crate::options::{FitOptions, MotionCount};
use crate::paper::nearest_by;
use crate::points::{FitEvidence, MotionFit, ordered_motions};
use crate::progress::{Progress, Stages};
use crate::random::Random;

const STAGES: &[&str] = &["number", "motions", "labels"];

/// Differentiation of the multibody motion at many points, the best choice of hypotheses, labels by the smallest distance.
pub(crate) fn best_fit(measurements: &Measurements, options: &FitOptions, progress: Progress<'_>) -> Result<MotionFit> {
    let mut stages = Stages::new(STAGES, progress);
    let (normalised, normalisation) = measurements.normalised();
    stages.begin("number");
    let count = match options.motions {
        MotionCount::Given(n) => n,
        MotionCount::Auto => number_of_motions(&normalised, MAX_TRIED)?.motions,
    };
    stages.begin("motions");
    let mut random = Random::from_seed(options.seed);
    let pool = algebraic_start(&normalised, count, &mut random, POINTS)?;
    let choice = choose(&pool, &normalised, count, f64::INFINITY);
    let mut found: Vec<AffineMotion> = choice.indices.iter().map(|&k| pool[k]).collect();
    found.resize(count, AffineMotion::STATIC);
    stages.begin("labels");
    let nearest = nearest_by(&normalised, &found, |a, x, y| a.distance(x, y).abs());
    let restored: Vec<AffineMotion> = found.iter().map(|a| normalisation.restore(a)).collect();
    let (motions, labels) = ordered_motions(measurements, &restored, &nearest);
    Ok(MotionFit { count, motions, labels, evidence: FitEvidence::default(), stages: None })
}
