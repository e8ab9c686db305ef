//! What a method finds in one pair, in figures.

use std::time::Instant;

use serde::Serialize;
use veronese::{Model, Quality, Result, SegmentOptions, Segmentation, UNLABELLED, segment_pair_with};

use super::cases::Data;
use super::scores::{Scores, scores};

/// The methods compared, in the order of the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
pub enum Method {
    Best,
    Fast,
    Baseline,
}

impl Method {
    pub const ALL: [Method; 3] = [Method::Best, Method::Fast, Method::Baseline];

    pub fn name(self) -> &'static str {
        match self {
            Method::Best => "best",
            Method::Fast => "fast",
            Method::Baseline => "baseline",
        }
    }
}

/// What a method found in a case, in figures.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Outcome {
    pub method: Method,
    /// Figures of the single motions.
    pub single: Option<Scores>,
    /// Figures of the groups; of the baseline, which has none, the same as of its labels.
    pub grouped: Option<Scores>,
    pub milliseconds: f64,
}

pub fn grouped(found: &Segmentation) -> Vec<u8> {
    let group = |label: &u8| found.motions.get(usize::from(*label)).map_or(UNLABELLED, |motion| motion.group);
    found.labels.iter().map(group).collect()
}

pub fn outcome(method: Method, data: &Data, labels: &[u8], groups: &[u8], milliseconds: f64) -> Outcome {
    let width = data.first.width();
    let against = |labels: &[u8]| data.truth.as_deref().map(|truth| scores(truth, labels, width));
    Outcome { method, single: against(labels), grouped: against(groups), milliseconds }
}

/// A case segmented with other constants, and with the quality of a method.
pub fn segmented(model: &'static Model, method: Method, data: &Data) -> Result<Segmentation> {
    let quality = if method == Method::Fast { Quality::Fast } else { Quality::Best };
    let options = SegmentOptions::default().with_quality(quality);
    segment_pair_with(model, &data.first, &data.second, &options)
}

/// What that gives.
pub fn of_model(model: &'static Model, method: Method, data: &Data) -> Result<Outcome> {
    let start = Instant::now();
    let found = segmented(model, method, data)?;
    let milliseconds = 1e3 * start.elapsed().as_secs_f64();
    Ok(outcome(method, data, &found.labels, &grouped(&found), milliseconds))
}
