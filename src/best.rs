//! [`Method::Best`](crate::Method::Best): the maximum likelihood mixture of motions.

use nalgebra::Matrix6;

use crate::answer::{Candidate, FitEvidence, FittedMotion, MotionFit, UNLABELLED};
use crate::error::Result;
use crate::factorisation::algebraic_start;
use crate::measurements::{Measurements, Normalisation};
use crate::motion::AffineMotion;
use crate::options::{FitOptions, MAX_MOTIONS, MotionCount};
use crate::order::sort_few;
use crate::progress::{Progress, Stages};
use crate::random::Random;
use crate::refinement::{Mixture, Samples, Search, covariance, determined, select};

const STAGES: &[&str] = &["search", "labels"];

/// Smallest number of measurements per motion: one for each entry.
const PER_MOTION: usize = 6;
/// Up to this many motions, the search starts from the algebra (differentiation of the multibody motion at points), which is exact
/// without noise and saves time. The cost of the algebra grows with the sixth power of n, and for more motions random starts do as well.
const ALGEBRAIC: usize = 2;
/// Points at which the multibody motion is differentiated.
const POINTS: usize = 20;
/// Largest number of measurements from which the multibody motion is estimated.
const ESTIMATED_FROM: usize = 1000;

/// The maximum likelihood fit: motions, their number unless it is given, outliers, labels and covariances.
///
/// # Errors
/// [`Error::TooFewMeasurements`](crate::Error::TooFewMeasurements) for fewer than six measurements per motion.
pub(crate) fn best_fit(measurements: &Measurements, options: &FitOptions, progress: Progress<'_>) -> Result<MotionFit> {
    let mut stages = Stages::new(STAGES, progress);
    let (least, largest) = match options.motions {
        MotionCount::Given(n) => (n, n),
        MotionCount::Auto => (1, MAX_MOTIONS.min(measurements.len() / PER_MOTION)),
    };
    measurements.check_number(least, PER_MOTION * least)?;
    stages.begin("search");
    let (normalised, normalisation) = measurements.normalised();
    let samples = Samples::new(&normalised);
    let mut search = Search::new(&samples, options.seed);
    let mut random = Random::from_seed(options.seed);
    let mut hypotheses = |n| algebraic_hypotheses(&normalised, n, &mut random);
    let (fit, tried) = match options.motions {
        MotionCount::Given(n) => {
            let fit = search.fit(n, &hypotheses(n), f64::INFINITY);
            let score = search.score(&fit);
            (fit, vec![(n, score)])
        }
        MotionCount::Auto => {
            let selection = select(&mut search, largest, hypotheses);
            (selection.fit, selection.tried)
        }
    };
    stages.begin("labels");
    let (motions, labels) = labelled_motions(&mut search, &samples, fit, &normalisation);
    let candidates = tried.into_iter().map(|(motions, score)| Candidate { motions, score }).collect();
    let evidence = FitEvidence { candidates, singular_values: Vec::new() };
    Ok(MotionFit { count: motions.len(), motions, labels, evidence, stages: None })
}

/// Hypotheses from the algebra; none for more than [`ALGEBRAIC`] motions or too few measurements.
fn algebraic_hypotheses(normalised: &Measurements, n: usize, random: &mut Random) -> Vec<[f64; 6]> {
    if n > ALGEBRAIC {
        return Vec::new();
    }
    let pool = if normalised.len() > ESTIMATED_FROM {
        algebraic_start(&normalised.subset(&random.choose(normalised.len(), ESTIMATED_FROM)), n, random, POINTS)
    } else {
        algebraic_start(normalised, n, random, POINTS)
    };
    pool.unwrap_or_default().iter().filter(|motion| motion.is_finite()).map(|motion| motion.matrix).collect()
}

/// The motions of a fit by decreasing number of measurements (ties: share, then entries), in the coordinates of the input, and the
/// labels.
fn labelled_motions(
    search: &mut Search<'_>,
    samples: &Samples,
    mut fit: Mixture,
    normalisation: &Normalisation,
) -> (Vec<FittedMotion>, Vec<u8>) {
    let nearest = fit.labels(samples);
    let normals = search.evaluate(&mut fit);
    let mut counts = vec![0_usize; fit.motions.len()];
    nearest.iter().flatten().for_each(|&i| counts[i] += 1);
    let mut order: Vec<usize> = (0..counts.len()).collect();
    sort_few(&mut order, |&a, &b| {
        let entries = || fit.motions[a].iter().zip(&fit.motions[b]).map(|(p, q)| p.total_cmp(q));
        let by_entries = || entries().find(|o| o.is_ne()).unwrap_or(std::cmp::Ordering::Equal);
        let by_share = || fit.shares[b].total_cmp(&fit.shares[a]);
        counts[b].cmp(&counts[a]).then_with(by_share).then_with(by_entries)
    });
    let mut label_of = vec![UNLABELLED; counts.len()];
    let mut motions = Vec::with_capacity(counts.len());
    for (&i, label) in order.iter().zip(0_u8..) {
        label_of[i] = label;
        let own = (0..nearest.len()).filter(|&j| nearest[j] == Some(i));
        motions.push(FittedMotion {
            label,
            matrix: normalisation.restore(&AffineMotion::new(fit.motions[i])),
            measurements: counts[i],
            determined: determined(&normals[i], samples, own, fit.sigma),
            covariance: Some(restored_covariance(&covariance(&normals[i], fit.sigma), normalisation)),
        });
    }
    let labels = nearest.iter().map(|label| label.map_or(UNLABELLED, |i| label_of[i])).collect();
    (motions, labels)
}

/// The covariance `L C Lᵀ` of the entries in the coordinates of the input. Restoring a motion is linear; column k of its matrix L is the
/// restored k-th unit motion.
fn restored_covariance(normalised: &Matrix6<f64>, normalisation: &Normalisation) -> [[f64; 6]; 6] {
    let columns: [[f64; 6]; 6] = std::array::from_fn(|k| {
        let mut unit = [0.0; 6];
        unit[k] = 1.0;
        normalisation.restore(&AffineMotion::new(unit)).matrix
    });
    let restore = Matrix6::from(columns);
    (restore * normalised * restore.transpose()).into()
}
