//! One case after another through every method, and what comes out as figures.

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use veronese::{
    AffineMotion, Part, Quality, SegmentOptions, Segmentation, Tuned, UNLABELLED, segment_pair, segment_pair_varied,
    segment_pair_without,
};

use crate::cases::{Case, Data, Set, baseline};
use crate::parallel::in_parallel;
use crate::pictures;
use crate::scores::{Scores, flow_error, scores};

/// The methods compared, in the order of the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Method {
    Best,
    Fast,
    Baseline,
}

impl Method {
    pub(crate) const ALL: [Method; 3] = [Method::Best, Method::Fast, Method::Baseline];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Method::Best => "best",
            Method::Fast => "fast",
            Method::Baseline => "baseline",
        }
    }
}

/// What a method found in a case, in figures.
#[derive(Clone, Debug)]
pub(crate) struct Outcome {
    pub(crate) method: Method,
    /// Figures of the single motions.
    pub(crate) single: Option<Scores>,
    /// Figures of the groups; of the baseline, which has none, the same as of its labels.
    pub(crate) grouped: Option<Scores>,
    /// Median end point error of the flow that labels and motions imply, pixels.
    pub(crate) flow_error: Option<f64>,
    pub(crate) milliseconds: f64,
}

/// A case with all its outcomes.
pub(crate) struct Measured {
    pub(crate) case: Case,
    pub(crate) size: [usize; 2],
    pub(crate) outcomes: Vec<Outcome>,
    /// Frame, best, baseline and truth side by side, as a PNG file.
    pub(crate) picture: Vec<u8>,
    /// What each form of the pipeline gives with either quality, in the order of the ablation; empty where the case takes no part in it.
    pub(crate) variants: Vec<[Outcome; 2]>,
}

impl Measured {
    pub(crate) fn of(&self, method: Method) -> Option<&Outcome> {
        self.outcomes.iter().find(|outcome| outcome.method == method)
    }
}

type Result<T> = std::result::Result<T, Box<dyn Error + Send + Sync>>;

/// All methods on all cases, and the `variants` of the pipeline on those of which `takes_part` is true; what the baseline found is
/// read from `baselines`.
pub(crate) fn all(
    cases: &[Case],
    baselines: &Path,
    variants: &[Variant],
    takes_part: impl Fn(&Case) -> bool + Sync,
) -> Result<Vec<Measured>> {
    in_parallel(cases, |case| {
        let measured = measure(case, baselines, if takes_part(case) { variants } else { &[] })?;
        let main = measured.of(Method::Best).map(|best| match (&best.single, best.flow_error) {
            (Some(single), _) => format!("mean IoU {:.3}", single.miou),
            (None, Some(error)) => format!("flow error {error:.2} px"),
            _ => String::new(),
        });
        eprintln!("{}: {}", case.name, main.unwrap_or_default());
        Ok(measured)
    })
}

fn measure(case: &Case, baselines: &Path, variants: &[Variant]) -> Result<Measured> {
    let data = case.load().map_err(|error| error.to_string())?;
    let width = data.first.width();
    let mut outcomes = Vec::new();
    let mut shown = Vec::new();
    for (method, quality) in [(Method::Best, Quality::Best), (Method::Fast, Quality::Fast)] {
        let start = Instant::now();
        let options = SegmentOptions { quality, ..SegmentOptions::default() };
        let found = segment_pair(&data.first, &data.second, None, &options, &mut |_| {})?;
        let milliseconds = 1e3 * start.elapsed().as_secs_f64();
        let motions: Vec<AffineMotion> = found.motions.iter().map(|motion| motion.matrix).collect();
        let groups = grouped(&found);
        outcomes.push(outcome(method, &data, &found.labels, &groups, &motions, milliseconds));
        if method == Method::Best {
            shown.push(if matches!(case.set, Set::Pairs | Set::Sequences) { groups } else { found.labels });
        }
    }
    let their = baseline(&baselines.join(&case.name)).map_err(|error| error.to_string())?;
    if let Some(their) = their.filter(|their| their.labels.len() == data.rgba[0].len() / 4) {
        let (labels, motions) = (&their.labels, &their.motions);
        outcomes.push(outcome(Method::Baseline, &data, labels, labels, motions, their.milliseconds));
        shown.push(their.labels);
    }
    shown.extend(data.truth.clone());
    Ok(Measured {
        case: case.clone(),
        size: [width, data.first.height()],
        outcomes,
        picture: pictures::panels(&data, &shown)?,
        variants: variants.iter().map(|&variant| with_both(variant, &data)).collect::<Result<_>>()?,
    })
}

fn grouped(found: &Segmentation) -> Vec<u8> {
    let group = |label: &u8| found.motions.get(usize::from(*label)).map_or(UNLABELLED, |motion| motion.group);
    found.labels.iter().map(group).collect()
}

fn outcome(
    method: Method,
    data: &Data,
    labels: &[u8],
    groups: &[u8],
    motions: &[AffineMotion],
    milliseconds: f64,
) -> Outcome {
    let width = data.first.width();
    let against = |labels: &[u8]| data.truth.as_deref().map(|truth| scores(truth, labels, width));
    let flow_of = |label: u8, x: f64, y: f64| motions.get(usize::from(label)).map(|motion| motion.flow(x, y));
    Outcome {
        method,
        single: against(labels),
        grouped: against(groups),
        flow_error: data.flow.as_ref().map(|flow| flow_error(flow, labels, width, flow_of)),
        milliseconds,
    }
}

/// The pipeline in one form of the ablation or of the sensitivity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Variant {
    /// As it is.
    Whole,
    /// Without one part.
    Without(Part),
    /// With the frame before the first, where there is one.
    ThreeFrames,
    /// With a constant multiplied by a factor.
    Varied(Tuned, f32),
}

/// What a form of the pipeline gives with `best`, then with `fast`.
fn with_both(variant: Variant, data: &Data) -> Result<[Outcome; 2]> {
    Ok([of_variant(variant, Method::Best, data)?, of_variant(variant, Method::Fast, data)?])
}

/// What a form of the pipeline gives with the quality of a method.
pub(crate) fn of_variant(variant: Variant, method: Method, data: &Data) -> Result<Outcome> {
    let (first, second) = (&data.first, &data.second);
    let quality = if method == Method::Fast { Quality::Fast } else { Quality::Best };
    let options = SegmentOptions { quality, ..SegmentOptions::default() };
    let start = Instant::now();
    let found = match variant {
        Variant::Whole => segment_pair(first, second, None, &options, &mut |_| {})?,
        Variant::ThreeFrames => segment_pair(first, second, data.before.as_ref(), &options, &mut |_| {})?,
        Variant::Without(part) => segment_pair_without(part, first, second, None, &options)?,
        Variant::Varied(constant, factor) => segment_pair_varied(constant, factor, first, second, &options)?,
    };
    let milliseconds = 1e3 * start.elapsed().as_secs_f64();
    Ok(outcome(method, data, &found.labels, &grouped(&found), &[], milliseconds))
}
