//! Reports as plain JavaScript objects, entry by entry.
//!
//! By hand, because a serialiser brings three times as much code. Every type is taken apart without `..`, so that a new field cannot
//! be forgotten here.

use js_sys::{Array, Object, Reflect, Uint8Array};
use wasm_bindgen::JsValue;

use crate::embedding::rank::RankCandidate;
use crate::refinement::{Report, Termination};
use crate::{
    AffineMotion, Candidate, FitEvidence, FittedMotion, MotionFit, PairEvidence, PaperStages, Segmentation,
    SegmentedMotion,
};

/// A plain object in the making.
pub(super) struct Record(Object);

impl Record {
    pub(super) fn new() -> Record {
        Record(Object::new())
    }

    #[inline(never)]
    pub(super) fn set(self, name: &str, value: &JsValue) -> Record {
        // Setting a property of an object of our own cannot fail.
        let _ = Reflect::set(&self.0, &name.into(), value);
        self
    }

    #[inline(never)]
    pub(super) fn number(self, name: &str, value: f64) -> Record {
        self.set(name, &value.into())
    }

    #[inline(never)]
    pub(super) fn count(self, name: &str, value: usize) -> Record {
        self.number(name, value as f64)
    }

    #[inline(never)]
    pub(super) fn text(self, name: &str, value: &str) -> Record {
        self.set(name, &value.into())
    }

    #[inline(never)]
    pub(super) fn bytes(self, name: &str, value: &[u8]) -> Record {
        self.set(name, &Uint8Array::from(value))
    }

    #[inline(never)]
    fn numbers(self, name: &str, values: &[f64]) -> Record {
        self.set(name, &numbers(values))
    }

    fn list<T>(self, name: &str, items: &[T], plain: fn(&T) -> JsValue) -> Record {
        self.set(name, &list(items, plain))
    }

    pub(super) fn into_value(self) -> JsValue {
        self.0.into()
    }
}

/// The entries of a segmentation but its arrays of bytes.
pub(super) fn add_segmentation(record: Record, segmentation: &Segmentation) -> Record {
    let Segmentation { width, height, count, motions, labels: _, evidence, unlabelled, confidence: _ } = segmentation;
    let PairEvidence { candidates } = evidence;
    record
        .count("width", *width)
        .count("height", *height)
        .count("count", *count)
        .list("motions", motions, segmented_motion)
        .set("evidence", &Record::new().list("candidates", candidates, candidate).into_value())
        .count("unlabelled", *unlabelled)
}

/// The entries of a fit but its labels.
pub(super) fn add_fit(record: Record, fit: &MotionFit) -> Record {
    let MotionFit { count, motions, labels: _, evidence, stages } = fit;
    let FitEvidence { singular_values, candidates } = evidence;
    let evidence = Record::new().numbers("singularValues", singular_values).list("candidates", candidates, candidate);
    let record =
        record.count("count", *count).list("motions", motions, fitted_motion).set("evidence", &evidence.into_value());
    match stages {
        Some(stages) => record.set("stages", &paper_stages(stages)),
        None => record,
    }
}

/// Motions of a pair.
pub(super) fn segmented_motions(motions: &[SegmentedMotion]) -> JsValue {
    list(motions, segmented_motion)
}

fn segmented_motion(motion: &SegmentedMotion) -> JsValue {
    let SegmentedMotion { label, matrix, pixels, share, residual, bbox, group } = motion;
    Record::new()
        .count("label", usize::from(*label))
        .numbers("matrix", &matrix.matrix)
        .count("pixels", *pixels)
        .number("share", *share)
        .number("residual", *residual)
        .numbers("bbox", &bbox.map(|side| side as f64))
        .count("group", usize::from(*group))
        .into_value()
}

fn fitted_motion(motion: &FittedMotion) -> JsValue {
    let FittedMotion { label, matrix, measurements, determined, covariance } = motion;
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

fn candidate(candidate: &Candidate) -> JsValue {
    let Candidate { motions, score } = candidate;
    Record::new().count("motions", *motions).number("score", *score).into_value()
}

fn paper_stages(stages: &PaperStages) -> JsValue {
    let PaperStages { ranks, rank_rule_fired, factorisation, refined, refinement } = stages;
    let Report { termination, iterations, initial_cost, final_cost } = refinement;
    let termination = match termination {
        Termination::Converged => "converged",
        Termination::Stalled => "stalled",
        Termination::MaxIterations => "maxIterations",
    };
    let refinement = Record::new()
        .text("termination", termination)
        .count("iterations", *iterations)
        .number("initialCost", *initial_cost)
        .number("finalCost", *final_cost);
    Record::new()
        .list("ranks", ranks, rank_candidate)
        .set("rankRuleFired", &rank_rule_fired.map_or(JsValue::NULL, JsValue::from))
        .list("factorisation", factorisation, entries)
        .list("refined", refined, entries)
        .set("refinement", &refinement.into_value())
        .into_value()
}

fn rank_candidate(tried: &RankCandidate) -> JsValue {
    let RankCandidate { motions, rank, columns, ratio } = tried;
    Record::new()
        .count("motions", *motions)
        .count("rank", *rank)
        .count("columns", *columns)
        .number("ratio", *ratio)
        .into_value()
}

fn entries(motion: &AffineMotion) -> JsValue {
    numbers(&motion.matrix)
}

#[inline(never)]
fn numbers(values: &[f64]) -> JsValue {
    list(values, |value| (*value).into())
}

fn list<T>(items: &[T], plain: fn(&T) -> JsValue) -> JsValue {
    items.iter().map(plain).collect::<Array>().into()
}
