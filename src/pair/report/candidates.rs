//! Scores of different numbers of motions: description lengths with fewer and with more motions than were found.

use crate::answer::Candidate;
use crate::frame::Plane;
use crate::labelling::regions::description::{length, motion_penalty, worth};
use crate::labelling::solver::Solver;
use crate::labelling::terms::data::{compare, estimation_costs, label_costs};
use crate::motion::AffineMotion;
use crate::options::MAX_MOTIONS;
use crate::pair::labels::{LabelledPair, borders};
use crate::pair::settings::Settings;

/// Description lengths, nats, with the motions found, with fewer (the least useful ones are removed one by one) and with one more. Labels
/// are solved for each number at the base level, without costs of occlusion and colour.
pub(super) fn scored_candidates(labelled: &LabelledPair, settings: &Settings) -> Vec<Candidate> {
    let pair = &labelled.pair;
    let level = &pair.levels[pair.base];
    let width = level.width();
    let n = labelled.motions.len();
    let mut motions: Vec<AffineMotion> =
        labelled.motions.iter().chain(&labelled.rejected).copied().take(MAX_MOTIONS).collect();
    let compared = compare(level, &motions, Vec::new());
    let mut raw = estimation_costs(level, &compared);
    let mut costs = label_costs(level, &compared, settings.labelling);
    let borders = borders(pair, pair.base, settings);
    let solve = |costs: &[Plane]| borders.solve(costs, Solver::LIGHT);
    let one_more = (motions.len() > n).then(|| length(&motions, &raw, &solve(&costs), width, level.model));
    motions.truncate(n);
    raw.truncate(n);
    costs.truncate(n);
    let mut labels = solve(&costs);
    let mut candidates = vec![Candidate { motions: n, score: length(&motions, &raw, &labels, width, level.model) }];
    if n < MAX_MOTIONS {
        // A motion without pixels costs its six parameters.
        let unused = candidates[0].score + motion_penalty(labels.len());
        candidates.insert(0, Candidate { motions: n + 1, score: one_more.map_or(unused, |score| score.min(unused)) });
    }
    while raw.len() > 1 {
        let worths = worth(&raw, &labels, width, level.model);
        let Some((weakest, _)) = worths.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)) else { break };
        motions.remove(weakest);
        raw.remove(weakest);
        costs.remove(weakest);
        labels = solve(&costs);
        candidates.push(Candidate { motions: raw.len(), score: length(&motions, &raw, &labels, width, level.model) });
    }
    candidates.reverse();
    candidates
}
