//! The sensitivity: the same cases with one tuned constant made smaller or larger by half.

use std::fmt::Write;

use serde_json::{Value, json};
use veronese::Tuned;

use crate::Failure;
use crate::cases::{Case, Set, a_third};
use crate::outcome::{Method, Outcome, Variant, of_variant};
use crate::parallel::in_parallel;
use crate::scores::Scores;

/// What a constant is multiplied by.
const FACTORS: [f32; 2] = [0.5, 1.5];
/// A mean change of more standard errors than this is set in bold type.
const SIGNIFICANT: f64 = 2.0;

/// The constants, each with what it is and its name in the sources, in the order of the pipeline.
const CONSTANTS: [(Tuned, &str); 27] = [
    (Tuned::PositionSigma, "position error of a correct motion, `POSITION_SIGMA`"),
    (Tuned::EstimationTruncation, "largest cost in estimation, `ESTIMATION_TRUNCATION`"),
    (Tuned::LabelTruncation, "largest cost of a label, `LABEL_TRUNCATION`"),
    (Tuned::Robustness, "robustness of the alignment, all stages"),
    (Tuned::Ridge, "prior against linear terms, all stages"),
    (Tuned::RegionBlur, "soft border of a region, `REGION_BLUR`"),
    (Tuned::SelectionWindow, "window of costs in selection, `selection::WINDOW`"),
    (Tuned::GainWindow, "window of gains, `gain_window`"),
    (Tuned::GainMargin, "gain that does not count, `deflation::MARGIN`"),
    (Tuned::Smoothness, "price of a border, `smoothness`"),
    (Tuned::EdgeShare, "share of it left at an edge, `EDGE_SHARE`"),
    (Tuned::EdgeStep, "step that makes an edge, `SMALLEST_STEP` and `NOISE_STEPS`"),
    (Tuned::ColourShare, "weight of a step in colour, `COLOUR_SHARE`"),
    (Tuned::FrameBorder, "price along the frame's border, `FRAME_BORDER`"),
    (Tuned::ObjectBias, "price of an object's pixel, `object_bias`"),
    (Tuned::HiddenCost, "largest cost of an occluded pixel, `HIDDEN`"),
    (Tuned::ExpectedMisfit, "misfit that noise explains, `EXPECTED`"),
    (Tuned::LargestInflation, "largest inflation of the deviation, `LARGEST`"),
    (Tuned::InflationWindow, "window of the inflation, `variance_inflation::WINDOW`"),
    (Tuned::ColourPrice, "cost of an improbable colour, `PRICE_PER_NAT`"),
    (Tuned::LargestColourPrice, "largest cost of a colour, `LARGEST_PRICE`"),
    (Tuned::MotionPrice, "description of a motion, `price_of_motion`"),
    (Tuned::BorderPrice, "description of a border, `PER_BORDER_PIXEL`"),
    (Tuned::SmallestShare, "smallest region, `SMALLEST_SHARE`"),
    (Tuned::CoarsePixel, "weight of a coarse pixel, `COARSE_PIXEL`"),
    (Tuned::GroupTolerance, "jump within a group, `RELATIVE_TOLERANCE`"),
    (Tuned::LargestGroupTolerance, "largest jump within a group, `LARGEST_TOLERANCE`"),
];

/// A figure of a table, on the sets it is computed on.
struct Column {
    title: &'static str,
    sets: &'static [Set],
    figure: fn(&Outcome) -> Option<f64>,
}

const COLUMNS: [Column; 5] = [
    Column { title: "J", sets: &[Set::Sequences], figure: |o| grouped(o)?.j_background },
    Column { title: "J by hand", sets: &[Set::Sequences], figure: |o| single(o)?.j_oracle },
    Column { title: "F", sets: &[Set::Sequences], figure: |o| grouped(o)?.boundary },
    Column { title: "mean IoU", sets: &[Set::Generated, Set::Colour], figure: |o| Some(single(o)?.miou) },
    Column { title: "mean IoU, bare ground", sets: &[Set::Bare], figure: |o| Some(single(o)?.miou) },
];

fn single(outcome: &Outcome) -> Option<&Scores> {
    outcome.single.as_ref()
}

fn grouped(outcome: &Outcome) -> Option<&Scores> {
    outcome.grouped.as_ref()
}

/// A case with the outcomes of the pipeline as it is, then of every constant with every factor.
pub(crate) struct Varied {
    case: Case,
    outcomes: Vec<Outcome>,
}

/// The cases that are measured: generated scenes, those with a bare ground, and a third of the pairs of every sequence.
pub(crate) fn chosen(cases: Vec<Case>) -> Vec<Case> {
    let (pairs, mut chosen): (Vec<Case>, Vec<Case>) = cases.into_iter().partition(|case| case.set == Set::Sequences);
    chosen.retain(|case| matches!(case.set, Set::Generated | Set::Colour | Set::Bare));
    chosen.extend(a_third(pairs.into_iter()));
    chosen
}

/// Measures all cases with all constants.
pub(crate) fn measure(cases: &[Case]) -> Result<Vec<Varied>, Failure> {
    let constants = CONSTANTS.iter().flat_map(|&(constant, _)| FACTORS.map(|factor| Variant::Varied(constant, factor)));
    let variants: Vec<Variant> = std::iter::once(Variant::Whole).chain(constants).collect();
    in_parallel(cases, |case| {
        let data = case.load().map_err(|error| error.to_string())?;
        let outcome = |&variant| of_variant(variant, Method::Best, &data);
        let outcomes = variants.iter().map(outcome).collect::<Result<_, _>>()?;
        eprintln!("{}", case.name);
        Ok(Varied { case: case.clone(), outcomes })
    })
}

/// A mean change and its standard error.
#[derive(Clone, Copy)]
struct Change {
    mean: f64,
    error: f64,
}

impl Change {
    /// Of a figure between the pipeline as it is and variant `k`. Pairs of one sequence are alike, so that the error is that over the
    /// sequences.
    fn of(measured: &[Varied], column: &Column, k: usize) -> Change {
        let own = measured.iter().filter(|one| column.sets.contains(&one.case.set));
        let change = |one: &Varied| Some((column.figure)(&one.outcomes[k])? - (column.figure)(&one.outcomes[0])?);
        let mut sequences: Vec<(&str, Vec<f64>)> = Vec::new();
        for (name, change) in own.filter_map(|one| Some((one.case.sequence(), change(one)?))) {
            match sequences.last_mut().filter(|(last, _)| *last == name) {
                Some((_, changes)) => changes.push(change),
                None => sequences.push((name, vec![change])),
            }
        }
        let means: Vec<f64> = sequences.iter().map(|(_, list)| list.iter().sum::<f64>() / list.len() as f64).collect();
        let n = means.len() as f64;
        let mean = means.iter().sum::<f64>() / n;
        let variance = means.iter().map(|m| (m - mean) * (m - mean)).sum::<f64>() / (n - 1.0);
        Change { mean, error: (variance / n).sqrt() }
    }

    fn cell(self) -> String {
        match self.mean {
            mean if mean.is_nan() => "–".into(),
            0.0 => "0".into(),
            mean if mean.abs() > SIGNIFICANT * self.error => format!("**{mean:+.3}**"),
            mean => format!("{mean:+.3}"),
        }
    }
}

/// Index of the outcome of constant `k` with factor `f`.
fn variant(k: usize, f: usize) -> usize {
    1 + FACTORS.len() * k + f
}

/// The changes as values for programs.
pub(crate) fn json(measured: &[Varied]) -> Value {
    let rows = CONSTANTS.iter().enumerate().flat_map(|(k, (_, title))| {
        FACTORS.iter().enumerate().map(move |(f, factor)| {
            let figures = COLUMNS.iter().map(|column| {
                let change = Change::of(measured, column, variant(k, f));
                (column.title.to_owned(), json!({ "change": change.mean, "standardError": change.error }))
            });
            json!({ "constant": title, "factor": factor, "figures": figures.collect::<serde_json::Map<_, _>>() })
        })
    });
    rows.collect()
}

/// The table of the page.
pub(crate) fn table(measured: &[Varied]) -> String {
    let count = |sets: &[Set]| measured.iter().filter(|one| sets.contains(&one.case.set)).count();
    let [pairs, scenes, bare] = [&COLUMNS[0], &COLUMNS[3], &COLUMNS[4]].map(|column| count(column.sets));
    let mut text = format!(
        "What the scores change by if one constant is multiplied by 0.5 / by 1.5 (best). J, J by hand and F are those of {pairs} of the \
         real pairs, two of each sequence; mean IoU is that of {scenes} generated scenes and of the {bare} of cars on bare ground. Changes \
         of more than {SIGNIFICANT} standard errors (over the sequences or scenes) are bold, and 0 means that no score changes.\n\n| constant |"
    );
    COLUMNS.iter().for_each(|column| _ = write!(text, " {} |", column.title));
    let _ = writeln!(text, "\n|---{}|", "|---".repeat(COLUMNS.len()));
    for (k, (_, title)) in CONSTANTS.iter().enumerate() {
        let _ = write!(text, "| {title} |");
        for column in &COLUMNS {
            let [less, more] = [0, 1].map(|f| Change::of(measured, column, variant(k, f)).cell());
            let _ = write!(text, " {less} / {more} |");
        }
        text.push('\n');
    }
    text
}
