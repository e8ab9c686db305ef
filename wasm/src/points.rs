//! The call on measurements.

use js_sys::Function;
use wasm_bindgen::prelude::*;

use crate::plain::{Record, candidate, numbers};
use crate::{Failure, REPORT_VERSION, SOFTWARE, choice, entries, invalid, listener, motions, motions_asked, unknown};
use veronese::embedding::rank::RankCandidate;
use veronese::refinement::Report;
use veronese::{AffineMotion, FitEvidence, FitOptions, FittedMotion, Measurements, Method, MotionFit, PaperStages};

/// `Number.MAX_SAFE_INTEGER`, 2⁵³ − 1.
const MAX_SAFE_INTEGER: f64 = 9_007_199_254_740_991.0;

/// Solves Problem 1 of the paper for measurements: `positions` holds x, y for each, `derivatives` I_x, I_y, I_t.
///
/// Returns the report of points as a plain object without `milliseconds`, which the caller measures, with `labels: Uint8Array`.
///
/// # Errors
/// A `VeroneseError`: the codes of [`veronese::Error`], and `invalid-input` for arrays whose length is not a multiple of 2 or 3.
#[wasm_bindgen(js_name = fitMotions)]
pub fn fit_motions(
    positions: &[f64],
    derivatives: &[f64],
    options: &JsValue,
    on_stage: Option<Function>,
) -> Result<JsValue, JsValue> {
    let options = fit_options(options)?;
    let measurements = Measurements::new(rows("positions", positions)?, rows("derivatives", derivatives)?);
    let fit = measurements
        .and_then(|measurements| veronese::fit_motions(&measurements, &options, &mut listener(on_stage)))
        .map_err(Failure::from)?;
    let settings = Record::new()
        .set("motions", &motions_asked(options.motions))
        .text("method", options.method.name())
        .number("seed", options.seed as f64)
        .text("software", SOFTWARE);
    let report = add_fit(Record::new().number("version", REPORT_VERSION), &fit)
        .set("settings", &settings.into_value())
        .bytes("labels", &fit.labels);
    Ok(report.into_value())
}

/// Rows of `N` numbers from a flat array.
pub fn rows<const N: usize>(name: &str, values: &[f64]) -> Result<Vec<[f64; N]>, Failure> {
    let (rows, rest) = values.as_chunks::<N>();
    if !rest.is_empty() {
        return Err(Failure::input(format!(
            "'{name}' must hold {N} numbers for each measurement, found {}",
            values.len()
        )));
    }
    Ok(rows.to_vec())
}

fn fit_options(value: &JsValue) -> Result<FitOptions, Failure> {
    let mut options = FitOptions::default();
    for (name, value) in entries(value)? {
        match name.as_str() {
            "motions" => options.motions = motions(&value)?,
            "method" => options.method = choice("method", &value, [("paper", Method::Paper), ("best", Method::Best)])?,
            "seed" => options.seed = seed(&value)?,
            _ => return Err(unknown(&name, "motions, method, seed")),
        }
    }
    Ok(options)
}

/// A seed of random numbers.
pub fn seed(value: &JsValue) -> Result<u64, Failure> {
    match value.as_f64() {
        Some(seed) if (0.0..=MAX_SAFE_INTEGER).contains(&seed) && seed == seed.floor() => Ok(seed as u64),
        _ => Err(invalid("seed", "a whole number from 0 to 9007199254740991", value)),
    }
}

/// Adds the entries of a fit except its labels.
fn add_fit(record: Record, fit: &MotionFit) -> Record {
    let MotionFit { count, motions, labels: _, evidence, stages, .. } = fit;
    let FitEvidence { singular_values, candidates, .. } = evidence;
    let evidence = Record::new().numbers("singularValues", singular_values).list("candidates", candidates, candidate);
    let record =
        record.count("count", *count).list("motions", motions, fitted_motion).set("evidence", &evidence.into_value());
    match stages {
        Some(stages) => record.set("stages", &paper_stages(stages)),
        None => record,
    }
}

fn fitted_motion(motion: &FittedMotion) -> JsValue {
    let FittedMotion { label, matrix, measurements, determined, covariance, .. } = motion;
    let record = Record::new()
        .count("label", usize::from(*label))
        .numbers("matrix", &matrix.matrix)
        .count("measurements", *measurements)
        .count("determined", *determined);
    match covariance {
        Some(rows) => record.list("covariance", rows, |row| numbers(row)).into_value(),
        None => record.into_value(),
    }
}

fn paper_stages(stages: &PaperStages) -> JsValue {
    let PaperStages { ranks, rank_rule_fired, factorisation, refined, refinement, .. } = stages;
    let refinement = report_of_refinement(refinement);
    Record::new()
        .list("ranks", ranks, rank_candidate)
        .set("rankRuleFired", &rank_rule_fired.map_or(JsValue::NULL, JsValue::from))
        .list("factorisation", factorisation, matrix)
        .list("refined", refined, matrix)
        .set("refinement", &refinement.into_value())
        .into_value()
}

/// How a refinement ended.
#[inline(always)]
pub fn report_of_refinement(report: &Report) -> Record {
    let Report { termination, iterations, initial_cost, final_cost, .. } = report;
    Record::new()
        .text("termination", termination.name())
        .count("iterations", *iterations)
        .number("initialCost", *initial_cost)
        .number("finalCost", *final_cost)
}

fn rank_candidate(tried: &RankCandidate) -> JsValue {
    let RankCandidate { motions, rank, columns, ratio, .. } = tried;
    Record::new()
        .count("motions", *motions)
        .count("rank", *rank)
        .count("columns", *columns)
        .number("ratio", *ratio)
        .into_value()
}

/// The six entries of a motion.
pub fn matrix(motion: &AffineMotion) -> JsValue {
    numbers(&motion.matrix)
}
