//! Means over cases.
use experiments::masks::cases::Case;
use experiments::masks::outcome::Outcome;
use experiments::masks::scores::Scores;
use serde::Serialize;

/// Means of the figures of some outcomes; NaN where no case has a figure.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Summary {
    pub(crate) cases: usize,
    pub(crate) miou: f64,
    /// Mean IoU of the cases in which things move by less than a pixel and a half.
    pub(crate) sub_pixel: f64,
    /// Share of the cases with the right number of motions.
    pub(crate) count_right: f64,
    /// Foreground IoU of groups.
    pub(crate) j_background: f64,
    /// Foreground IoU of single motions joined by the truth.
    pub(crate) j_oracle: f64,
    /// Boundary F of single motions, and of groups.
    pub(crate) boundary: f64,
    pub(crate) grouped_boundary: f64,
    pub(crate) rand: f64,
}

impl Summary {
    pub(crate) fn of<'a>(outcomes: impl Iterator<Item = (&'a Case, &'a Outcome)>) -> Summary {
        let all: Vec<(&Case, &Outcome)> = outcomes.collect();
        let mean = |figure: &dyn Fn(&Case, &Outcome) -> Option<f64>| {
            let values: Vec<f64> = all.iter().filter_map(|(case, outcome)| figure(case, outcome)).collect();
            values.iter().sum::<f64>() / values.len() as f64
        };
        let single =
            |figure: fn(&Scores) -> Option<f64>| mean(&move |_, outcome| outcome.single.as_ref().and_then(figure));
        let grouped =
            |figure: fn(&Scores) -> Option<f64>| mean(&move |_, outcome| outcome.grouped.as_ref().and_then(figure));
        Summary {
            cases: all.len(),
            miou: single(|s| Some(s.miou)),
            sub_pixel: mean(&|case, outcome| outcome.single.as_ref().filter(|_| case.sub_pixel).map(|s| s.miou)),
            count_right: single(|s| Some(f64::from(u8::from(s.found_count == s.truth_count)))),
            j_background: grouped(|s| s.j_background),
            j_oracle: single(|s| s.j_oracle),
            boundary: single(|s| s.boundary),
            grouped_boundary: grouped(|s| s.boundary),
            rand: single(|s| Some(s.rand)),
        }
    }
}
