//! Problem 1 of the paper for given measurements: the number of motions, the motions, the segmentation.

use crate::answer::{Candidate, FitEvidence, FittedMotion, MotionFit, PaperStages, UNLABELLED};
use crate::best::best_fit;
use crate::error::Result;
use crate::linear::RowQr;
use crate::measurements::Measurements;
use crate::motion::AffineMotion;
use crate::options::{FitOptions, Method};
use crate::order::descending;
use crate::paper::paper_fit;
use crate::progress::Progress;

/// Singular values below this share of the largest count as zero (normalised measurements).
const DETERMINED: f64 = 1e-6;

/// Solves Problem 1 of the paper: the number of affine motions that explain the measurements, the motions, and the motion of each
/// measurement.
///
/// ```
/// use veronese::{AffineMotion, FitOptions, Measurements, Random, fit_motions};
///
/// # fn main() -> veronese::Result<()> {
/// let truth = [AffineMotion::translation(0.5, -0.25), AffineMotion::new([0.2, -0.4, 0.0, 0.4, 0.2, 0.6])];
/// let mut random = Random::from_seed(1);
/// let (mut positions, mut derivatives) = (Vec::new(), Vec::new());
/// for j in 0..300 {
///     let [x, y] = [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)];
///     let [u, v] = truth[usize::from(j >= 200)].flow(x, y); // 200 measurements of one motion, 100 of the other
///     let [ix, iy] = [random.normal(), random.normal()];
///     positions.push([x, y]);
///     derivatives.push([ix, iy, -ix * u - iy * v + 0.01 * random.normal()]);
/// }
/// let measurements = Measurements::new(positions, derivatives)?;
///
/// let fit = fit_motions(&measurements, &FitOptions::default(), &mut |_| {})?;
/// assert_eq!(fit.count, 2);
/// for (motion, truth) in fit.motions.iter().zip(&truth) {
///     assert!(truth.relative_error(&motion.matrix) < 0.02);
///     assert_eq!(motion.determined, 6);
/// }
/// let right = fit.labels.iter().enumerate().filter(|&(j, &label)| label == u8::from(j >= 200)).count();
/// assert!(right > 280); // measurements near both planes may get either label
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`Error::InvalidOption`](crate::Error::InvalidOption) for a number of motions outside 1 to [`MAX_MOTIONS`](crate::MAX_MOTIONS);
/// [`Error::TooFewMeasurements`](crate::Error::TooFewMeasurements) for fewer than 6 measurements per motion, or, with
/// [`Method::Paper`], fewer than M_n² − Z_n − 1 in all (6, 24, 64, 139, … for n = 1, 2, 3, 4, …).
pub fn fit_motions(measurements: &Measurements, options: &FitOptions, progress: Progress<'_>) -> Result<MotionFit> {
    options.motions.validate()?;
    match options.method {
        Method::Paper => fit_as_the_paper(measurements, options, progress),
        Method::Best => best_fit(measurements, options, progress),
    }
}

fn fit_as_the_paper(measurements: &Measurements, options: &FitOptions, progress: Progress<'_>) -> Result<MotionFit> {
    let fit = paper_fit(measurements, options.motions, progress)?;
    let order = order_by_count(fit.refined.len(), &fit.labels);
    let (motions, labels) = ordered_motions(measurements, &fit.refined, &fit.labels);
    let in_order = |motions: &[AffineMotion]| order.iter().map(|&i| motions[i]).collect();
    // The rank rule (12) asks for a rank of one less than the number of columns. The score is the difference from that.
    let candidates = fit
        .ranks
        .iter()
        .map(|tried| Candidate { motions: tried.motions, score: (tried.rank + 1).abs_diff(tried.columns) as f64 });
    Ok(MotionFit {
        count: motions.len(),
        motions,
        labels,
        evidence: FitEvidence { candidates: candidates.collect(), singular_values: fit.singular_values },
        stages: Some(PaperStages {
            factorisation: in_order(&fit.factorisation),
            refined: in_order(&fit.refined),
            ranks: fit.ranks,
            rank_rule_fired: fit.rank_rule_fired,
            refinement: fit.refinement,
        }),
    })
}

/// Motions by decreasing number of measurements, and the labels in that numbering. `nearest` holds the index in `found` of each
/// measurement's motion; an index out of range marks an outlier, [`UNLABELLED`].
pub(crate) fn ordered_motions(
    measurements: &Measurements,
    found: &[AffineMotion],
    nearest: &[usize],
) -> (Vec<FittedMotion>, Vec<u8>) {
    let order = order_by_count(found.len(), nearest);
    let mut label_of = vec![UNLABELLED; found.len()];
    let mut motions = Vec::with_capacity(found.len());
    for (&i, label) in order.iter().zip(0u8..) {
        label_of[i] = label;
        let own: Vec<usize> = (0..nearest.len()).filter(|&j| nearest[j] == i).collect();
        let determined = determined_entries(&measurements.subset(&own));
        motions.push(FittedMotion { label, matrix: found[i], measurements: own.len(), determined, covariance: None });
    }
    let labels = nearest.iter().map(|&i| label_of.get(i).copied().unwrap_or(UNLABELLED)).collect();
    (motions, labels)
}

/// Indices of motions by decreasing number of measurements, ties by the lower index.
fn order_by_count(motions: usize, nearest: &[usize]) -> Vec<usize> {
    let mut counts = vec![0usize; motions];
    for &i in nearest {
        if let Some(count) = counts.get_mut(i) {
            *count += 1;
        }
    }
    descending(counts.iter().map(|&count| count as f64))
}

/// The rank of the constraints `φᵀa = −I_t`, φ = (I_x x, I_x y, I_x, I_y x, I_y y, I_y), that measurements put on the six entries a of
/// one motion: 6 if they determine it, fewer if, for example, their gradients are parallel or their positions collinear.
fn determined_entries(measurements: &Measurements) -> usize {
    let (normalised, _) = measurements.normalised();
    let mut qr = RowQr::new(6);
    for first in (0..normalised.len()).step_by(RowQr::BLOCK_ROWS) {
        let end = normalised.len().min(first + RowQr::BLOCK_ROWS);
        let rows = normalised.positions()[first..end].iter().zip(&normalised.derivatives()[first..end]);
        let features: Vec<[f64; 6]> =
            rows.map(|([x, y], [ix, iy, _])| [ix * x, ix * y, *ix, iy * x, iy * y, *iy]).collect();
        let mut block: Vec<f64> = (0..6).flat_map(|k| features.iter().map(move |row| row[k])).collect();
        qr.absorb(features.len(), &mut block);
    }
    let values = qr.into_triangle().singular_values().unwrap_or_default();
    let largest = values.first().copied().unwrap_or(0.0);
    values.iter().filter(|&&s| s > DETERMINED * largest).count()
}
