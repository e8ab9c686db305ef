//! The calls of the site's module: what lies between the steps, as plain JavaScript objects.

use js_sys::{Float32Array, Float64Array};
use wasm_bindgen::prelude::*;

use crate::{FitStages, MultibodyFlow, PixelStages, Spectrum, TrialError, VeroneseMap};
use veronese::embedding::rank::RankCandidate;
use veronese::stages::{Background, CandidateMotion, CandidateSource, Grid, Labelling, MeasuredPixels, SelectedMotion};
use veronese::{AffineMotion, Measurements, MotionCount, Plane, UNLABELLED};
use veronese_wasm::plain::{Record, list, numbers};
use veronese_wasm::{
    Failure, frames, invalid, matrix, motions, report_of_pair, report_of_refinement, rows, seed, segment_options,
};

/// The Veronese map of points: `{ exponents, matrix: Float64Array, rows, columns, singularValues, rank, nullVector }`, and with two
/// variables `{ lines, complex }`.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`, `invalid-input` or `not-finite`.
#[wasm_bindgen(js_name = veroneseMap)]
pub fn veronese_map(points: &[f64], variables: &JsValue, degree: &JsValue) -> Result<JsValue, JsValue> {
    let variables = whole("variables", variables)?;
    let map = crate::veronese_map(points, variables, whole("degree", degree)?).map_err(Failure::from)?;
    let VeroneseMap { exponents, matrix, rows, columns, singular_values, rank, null_vector, lines, complex } = map;
    let powers: Vec<Vec<f64>> =
        exponents.iter().map(|powers| powers[..variables].iter().map(|power| *power as f64).collect()).collect();
    let record = Record::new()
        .list("exponents", &powers, |powers| numbers(powers))
        .set("matrix", &Float64Array::from(&matrix[..]))
        .count("rows", rows)
        .count("columns", columns)
        .numbers("singularValues", &singular_values)
        .count("rank", rank)
        .numbers("nullVector", &null_vector);
    let record = match variables {
        2 => record.list("lines", &lines, |line| numbers(line)).count("complex", complex),
        _ => record,
    };
    Ok(record.into_value())
}

/// Translations from one polynomial in the derivatives: `{ coefficients, singularValues, factors, byDifferentiation }`.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`, `invalid-input`, `too-few-measurements` or `not-finite`.
#[wasm_bindgen(js_name = multibodyFlow)]
pub fn multibody_flow(derivatives: &[f64], motions: &JsValue) -> Result<JsValue, JsValue> {
    let rows = rows("derivatives", derivatives)?;
    let flow = crate::multibody_flow(&rows, whole("motions", motions)?).map_err(Failure::from)?;
    let MultibodyFlow { coefficients, singular_values, factors, by_differentiation } = flow;
    let record = Record::new()
        .numbers("coefficients", &coefficients)
        .numbers("singularValues", &singular_values)
        .list("factors", &factors, |flow| numbers(flow))
        .list("byDifferentiation", &by_differentiation, |flow| numbers(flow));
    Ok(record.into_value())
}

/// Image derivatives in grey levels: `{ width, height, horizontal, vertical, temporal }`, each plane a `Float32Array`.
///
/// # Errors
/// A `VeroneseError`: the codes of frames.
#[wasm_bindgen(js_name = derivativesOf)]
pub fn derivatives_of(first: &JsValue, second: &JsValue) -> Result<JsValue, JsValue> {
    let (first, second) = frames(first, second)?;
    let planes = crate::grey_derivatives(&first, &second).map_err(Failure::from)?;
    let record = Record::new()
        .count("width", first.width())
        .count("height", first.height())
        .set("horizontal", &plane(&planes.x))
        .set("vertical", &plane(&planes.y))
        .set("temporal", &plane(&planes.t));
    Ok(record.into_value())
}

/// The paper's algorithm step by step.
///
/// # Errors
/// A `VeroneseError`: the codes of [`veronese::Error`], and `invalid-input`.
#[wasm_bindgen(js_name = paperStages)]
pub fn paper_stages(positions: &[f64], derivatives: &[f64], count: &JsValue) -> Result<JsValue, JsValue> {
    let count = if count.is_undefined() { MotionCount::Auto } else { motions(count)? };
    let measurements = Measurements::new(rows("positions", positions)?, rows("derivatives", derivatives)?);
    let stages = measurements.and_then(|data| crate::paper_stages(&data, count)).map_err(Failure::from)?;
    Ok(fit_stages(&stages))
}

fn fit_stages(stages: &FitStages) -> JsValue {
    let FitStages { fit, normalisation, embedded, third_columns, gaps, mismatches, ambiguous, differentiation } =
        stages;
    let [rows, columns] = *embedded;
    let labels: Vec<u8> = fit.labels.iter().map(|label| *label as u8).collect();
    let multibody = fit.multibody.matrix();
    let by_rows: Vec<f64> = multibody.row_iter().flat_map(|row| row.iter().copied().collect::<Vec<_>>()).collect();
    let normalised = Record::new()
        .numbers("centre", &normalisation.centre)
        .number("scale", normalisation.scale)
        .number("intensity", normalisation.intensity);
    Record::new()
        .count("count", fit.refined.len())
        .list("ranks", &fit.ranks, tried)
        .set("ruleFired", &fit.rank_rule_fired.map_or(JsValue::NULL, JsValue::from))
        .numbers("singularValues", &fit.singular_values)
        .set("embedded", &Record::new().count("rows", rows).count("columns", columns).into_value())
        .set("normalisation", &normalised.into_value())
        .set(
            "multibody",
            &Record::new()
                .count("size", multibody.nrows())
                .set("matrix", &Float64Array::from(&by_rows[..]))
                .into_value(),
        )
        .list("thirdColumns", third_columns, |column| numbers(column))
        .set("gaps", &gaps.map_or(JsValue::NULL, |gaps| numbers(&gaps)))
        .numbers("mismatches", mismatches)
        .set("ambiguous", &(*ambiguous).into())
        .list("factorisation", &fit.factorisation, matrix)
        .list("differentiation", differentiation, matrix)
        .list("refined", &fit.refined, matrix)
        .set("refinement", &report_of_refinement(&fit.refinement).into_value())
        .bytes("labels", &labels)
        .into_value()
}

fn tried(candidate: &RankCandidate) -> JsValue {
    let RankCandidate { motions, rank, columns, ratio, .. } = candidate;
    Record::new()
        .count("motions", *motions)
        .count("rank", *rank)
        .count("columns", *columns)
        .count("wanted", candidate.wanted())
        .number("ratio", *ratio)
        .into_value()
}

/// The singular values behind the rank rule: a list of `{ motions, singularValues, rank }`.
///
/// # Errors
/// A `VeroneseError`: the codes of [`veronese::Error`], and `invalid-input`.
#[wasm_bindgen(js_name = embeddedSpectra)]
pub fn embedded_spectra(positions: &[f64], derivatives: &[f64], largest: &JsValue) -> Result<JsValue, JsValue> {
    let largest = whole("largest", largest)?;
    let measurements = Measurements::new(rows("positions", positions)?, rows("derivatives", derivatives)?);
    let found = measurements.and_then(|data| crate::embedded_spectra(&data, largest));
    Ok(list(&found.map_err(Failure::from)?, |Spectrum { motions, singular_values, rank }| {
        Record::new()
            .count("motions", *motions)
            .numbers("singularValues", singular_values)
            .count("rank", *rank)
            .into_value()
    }))
}

/// The motions by differentiation at one pixel: `{ coefficients, roots, motions }`.
///
/// # Errors
/// A `VeroneseError`: the codes of [`veronese::Error`], and `invalid-input`.
#[wasm_bindgen(js_name = motionsAtPixel)]
pub fn motions_at_pixel(
    positions: &[f64],
    derivatives: &[f64],
    motions: &JsValue,
    x: f64,
    y: f64,
    angle: f64,
) -> Result<JsValue, JsValue> {
    let count = whole("motions", motions)?;
    let measurements = Measurements::new(rows("positions", positions)?, rows("derivatives", derivatives)?);
    let found = measurements.and_then(|data| crate::motions_at_pixel(&data, count, [x, y], angle));
    let PixelStages { coefficients, roots, motions } = found.map_err(Failure::from)?;
    let record = Record::new()
        .numbers("coefficients", &coefficients)
        .list("roots", &roots, |root| numbers(root))
        .list("motions", &motions, matrix);
    Ok(record.into_value())
}

/// One trial of the paper's Figure 1: `{ truth, errors: { factorisation, refined, best, oracle }, countRight: { rule, best } }`, errors in
/// per cent.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`.
#[wasm_bindgen(js_name = figure1Trial)]
pub fn figure_1_trial(motions: &JsValue, noise: f64, seed_of_trial: &JsValue) -> Result<JsValue, JsValue> {
    let motions = whole("motions", motions)?;
    let trial = crate::figure_1_trial(motions, noise, seed(seed_of_trial)?).map_err(Failure::from)?;
    let per_cent = |error: TrialError| error.per_cent();
    let errors = Record::new()
        .number("factorisation", per_cent(trial.factorisation))
        .number("refined", per_cent(trial.refined))
        .number("best", per_cent(trial.best))
        .number("oracle", per_cent(trial.oracle));
    let right = Record::new().set("rule", &trial.rule_right.into()).set("best", &trial.best_right.into());
    let record = Record::new()
        .list("truth", &trial.truth, matrix)
        .set("errors", &errors.into_value())
        .set("countRight", &right.into_value());
    Ok(record.into_value())
}

/// Generated measurements of given motions: `{ positions: Float64Array, derivatives: Float64Array, labels: Uint8Array }`.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`, `invalid-input` or `not-finite`.
#[wasm_bindgen(js_name = motionMeasurements)]
pub fn motion_measurements(
    motions: &[f64],
    shares: &[f64],
    count: &JsValue,
    noise: f64,
    seed_of_draw: &JsValue,
) -> Result<JsValue, JsValue> {
    let motions: Vec<AffineMotion> = rows("motions", motions)?.into_iter().map(AffineMotion::new).collect();
    let (count, seed) = (whole("count", count)?, seed(seed_of_draw)?);
    let problem = crate::motion_measurements(&motions, shares, count, noise, seed).map_err(Failure::from)?;
    let labels: Vec<u8> = problem.labels.iter().map(|label| label.map_or(UNLABELLED, |label| label as u8)).collect();
    let record = Record::new()
        .set("positions", &Float64Array::from(problem.measurements.positions().as_flattened()))
        .set("derivatives", &Float64Array::from(problem.measurements.derivatives().as_flattened()))
        .bytes("labels", &labels);
    Ok(record.into_value())
}

/// [`veronese::segment_pair`] with what its stages found.
///
/// # Errors
/// As `segmentPair`.
#[wasm_bindgen(js_name = segmentPairStages)]
pub fn segment_pair_stages(first: &JsValue, second: &JsValue, options: &JsValue) -> Result<JsValue, JsValue> {
    let options = segment_options(options)?;
    let (first, second) = frames(first, second)?;
    let stages = veronese::stages::segment_pair_stages(&first, &second, &options).map_err(Failure::from)?;
    let record = Record::new()
        .list("hypotheses", &stages.hypotheses, background)
        .count("chosen", stages.chosen)
        .set("detail", &stages.detail.as_ref().map_or(JsValue::NULL, labelling))
        .set("working", &labelling(&stages.working))
        .list("groups", &stages.groups, |labels| list(labels, |label| f64::from(*label).into()))
        .set("result", &report_of_pair(&stages.result, &options));
    Ok(record.into_value())
}

fn background(background: &Background) -> JsValue {
    let Background { dominant, base, noise, residual, derivatives, local_flow, measured, .. } = background;
    let Background { candidates, penalty, selected, selection, refined, refinement, .. } = background;
    let Background { draft, labelling: of_working_size, .. } = background;
    let [u, v] = local_flow;
    let planes = Record::new()
        .set("horizontal", &plane(&derivatives.x))
        .set("vertical", &plane(&derivatives.y))
        .set("temporal", &plane(&derivatives.t));
    Record::new()
        .set("atRest", &(*dominant == AffineMotion::STATIC).into())
        .set("dominant", &matrix(dominant))
        .set("base", &add_grid(Record::new(), base).into_value())
        .number("noise", *noise)
        .set("residual", &plane(residual))
        .set("derivatives", &planes.into_value())
        .set("localFlow", &Record::new().set("u", &plane(u)).set("v", &plane(v)).into_value())
        .set("measurements", &measured.as_ref().map_or(JsValue::NULL, measured_pixels))
        .list("candidates", candidates, candidate)
        .number("price", *penalty)
        .list("selected", selected, selected_motion)
        .set("selection", &labelling(selection))
        .list("refined", refined, selected_motion)
        .set("refinement", &labelling(refinement))
        .set("draft", &labelling(draft))
        .set("labelling", &labelling(of_working_size))
        .into_value()
}

fn measured_pixels(measured: &MeasuredPixels) -> JsValue {
    let MeasuredPixels { places, measurements, weights, unit } = measured;
    Record::new()
        .set("places", &Float64Array::from(places.as_flattened()))
        .set("positions", &Float64Array::from(measurements.positions().as_flattened()))
        .set("derivatives", &Float64Array::from(measurements.derivatives().as_flattened()))
        .set("weights", &Float64Array::from(&weights[..]))
        .number("unit", *unit)
        .into_value()
}

fn candidate(candidate: &CandidateMotion) -> JsValue {
    let CandidateMotion { matrix: motion, source, gain, support } = candidate;
    let (source, degree) = match source {
        CandidateSource::Constraint(degree) => ("constraint", *degree),
        CandidateSource::Window => ("window", 0),
        CandidateSource::Hypothesis => ("hypothesis", 0),
    };
    Record::new()
        .set("matrix", &matrix(motion))
        .text("source", source)
        .count("degree", degree)
        .number("gain", *gain)
        .number("support", *support)
        .into_value()
}

fn selected_motion(motion: &SelectedMotion) -> JsValue {
    Record::new().set("matrix", &matrix(&motion.matrix)).number("support", motion.support).into_value()
}

fn labelling(labelling: &Labelling) -> JsValue {
    let Labelling { grid, motions, labels } = labelling;
    add_grid(Record::new(), grid).list("motions", motions, matrix).bytes("labels", labels).into_value()
}

fn add_grid(record: Record, grid: &Grid) -> Record {
    record.count("width", grid.width).count("height", grid.height).number("scale", grid.scale)
}

fn plane(plane: &Plane) -> JsValue {
    Float32Array::from(plane.values()).into()
}

/// A whole number that is not negative. Its range is checked where it is used.
fn whole(name: &str, value: &JsValue) -> Result<usize, Failure> {
    match value.as_f64() {
        Some(number) if number >= 0.0 && number <= f64::from(u32::MAX) && number == number.floor() => {
            Ok(number as usize)
        }
        _ => Err(invalid(name, "a whole number", value)),
    }
}
