//! One case after another through every method, and what comes out as figures.
use std::path::Path;
use std::time::Instant;

use experiments::Result;
use experiments::masks::cases::{Case, Set, baseline};
use experiments::masks::outcome::{Method, Outcome, grouped, outcome};
use experiments::parallel::in_parallel;
use veronese::{Quality, SegmentOptions, segment_pair};

use crate::pictures;

/// A case with all its outcomes.
pub(crate) struct Measured {
    pub(crate) case: Case,
    pub(crate) size: [usize; 2],
    pub(crate) outcomes: Vec<Outcome>,
    /// Frame, best, baseline and truth side by side, as a PNG file.
    pub(crate) picture: Vec<u8>,
}

impl Measured {
    pub(crate) fn of(&self, method: Method) -> Option<&Outcome> {
        self.outcomes.iter().find(|outcome| outcome.method == method)
    }
}

/// All methods on all cases; what the baseline found is read from `baselines`.
pub(crate) fn all(cases: &[Case], baselines: &Path) -> Result<Vec<Measured>> {
    in_parallel(cases, |case| {
        let measured = measure(case, baselines)?;
        let main = measured.of(Method::Best).and_then(|best| best.single.as_ref()).map(|single| single.miou);
        eprintln!("{}: mean IoU {:.3}", case.name, main.unwrap_or_default());
        Ok(measured)
    })
}

fn measure(case: &Case, baselines: &Path) -> Result<Measured> {
    let data = case.load().map_err(|error| error.to_string())?;
    let width = data.first.width();
    let mut outcomes = Vec::new();
    let mut shown = Vec::new();
    for (method, quality) in [(Method::Best, Quality::Best), (Method::Fast, Quality::Fast)] {
        let start = Instant::now();
        let options = SegmentOptions::default().with_quality(quality);
        let found = segment_pair(&data.first, &data.second, &options, &mut |_| {})?;
        let milliseconds = 1e3 * start.elapsed().as_secs_f64();
        let groups = grouped(&found);
        outcomes.push(outcome(method, &data, &found.labels, &groups, milliseconds));
        if method == Method::Best {
            shown.push(if matches!(case.set, Set::Pairs | Set::Sequences) { groups } else { found.labels });
        }
    }
    let their = baseline(&baselines.join(&case.name)).map_err(|error| error.to_string())?;
    if let Some(their) = their.filter(|their| their.labels.len() == data.rgba[0].len() / 4) {
        outcomes.push(outcome(Method::Baseline, &data, &their.labels, &their.labels, their.milliseconds));
        shown.push(their.labels);
    }
    shown.extend(data.truth.clone());
    Ok(Measured {
        case: case.clone(),
        size: [width, data.first.height()],
        outcomes,
        picture: pictures::panels(&data, &shown)?,
    })
}
