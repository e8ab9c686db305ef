//! A pair solved at the working size, for those who go on from there: no numbering, no full-size labels, no evidence for the number.

use super::background::{self, Solved};
use super::settings::Settings;
use super::{Pair, hypothesis, labels};
use crate::frame::mirror::Mirror;
use crate::frame::pyramid::FramePyramid;
use crate::frame::{Frame, Plane};
use crate::labelling::BACKGROUND;
use crate::labelling::confidence::probabilities;
use crate::labelling::regions::groups::groups;
use crate::labelling::terms::views::{cheapest, costs_where_seen};
use crate::motion::AffineMotion;
use crate::progress::Stages;
use crate::view::cost::{CostModel, inverse};
use crate::workspace::Buffer;

/// What a pair tells about its first frame. The background has label [`BACKGROUND`](crate::labelling::BACKGROUND).
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    /// Pixels of the working size.
    pub(crate) motions: Vec<AffineMotion>,
    /// The label of every working pixel.
    pub(crate) labels: Buffer<u8>,
    /// The probability, 0…1, of every motion at every working pixel.
    pub(crate) probabilities: Vec<Plane>,
    /// The group of every motion, named by its smallest label: motions of one rigid background share one.
    pub(crate) groups: Vec<usize>,
    /// Cost up to which its motions are enough for the pair that follows.
    enough: f64,
    /// Cost after the last search.
    searched: f64,
    /// Mean of the smallest cost of any motion, as a share of the largest cost there is.
    unexplained: f32,
}

/// Share of the largest cost, in the mean, above which two frames show different scenes. Not varied; tests/clip.rs has a cut.
const CUT: f32 = 0.5;

impl Solution {
    /// Whether the frames have so little in common that there must be a cut between them.
    pub(crate) fn is_cut(&self) -> bool {
        self.unexplained > CUT
    }
}

/// What is expected of a pair.
#[derive(Clone, Debug)]
pub(crate) struct Prior {
    /// Motions, pixels of the working size; the first is that of the background.
    pub(crate) motions: Vec<AffineMotion>,
    /// Cost up to which these motions are enough. Else a search adds others.
    pub(crate) enough: f64,
    /// Cost after the last search. Motions that are followed are searched anew at the latest when they cost much more.
    pub(crate) searched: f64,
}

/// Expected motions are enough where they cost no more than this share more than expected. Not varied.
const TOLERANCE: f64 = 0.05;
/// The same for motions that are followed without a look at others. Chosen on ten real clips: .05 costs .006 J.
const TOLERANCE_FOLLOWED: f64 = 0.02;
/// Motions that are followed may cost this share more than after the last search as long as none is found missing. Chosen on ten real clips: .1
/// costs .017 J there, and nothing in generated ones.
const TOLERANCE_SEARCHED: f64 = 0.05;

impl Prior {
    /// What is expected of a mirror image of the frames. `size` is the working size.
    pub(crate) fn mirrored(&self, mirror: Mirror, size: [usize; 2]) -> Prior {
        let motions = self.motions.iter().map(|motion| mirror.motion(motion, size)).collect();
        Prior { motions, ..*self }
    }

    /// Whether a prior from outside the program can be used.
    pub(crate) fn is_valid(&self) -> bool {
        !self.motions.is_empty() && self.motions.iter().all(AffineMotion::is_finite)
    }
}

impl Solution {
    /// The solution of a mirror image of the frames, as that of the frames themselves. `size` is the working size.
    pub(crate) fn mirrored(mut self, mirror: Mirror, size: [usize; 2]) -> Solution {
        self.motions.iter_mut().for_each(|motion| *motion = mirror.motion(motion, size));
        mirror.reorder(&mut self.labels, size[0]);
        self.probabilities.iter_mut().for_each(|plane| mirror.reorder(plane.values_mut(), size[0]));
        self
    }

    /// What to expect of a pair in which everything keeps its motion; no search where that explains it about as well.
    pub(crate) fn prior(&self) -> Prior {
        Prior { motions: self.motions.clone(), enough: self.enough, searched: self.searched }
    }

    /// What to expect of the pair the other way round. There is always a search.
    pub(crate) fn reversed(&self) -> Prior {
        let motions = self.motions.iter().map(|motion| inverse(motion).unwrap_or(*motion)).collect();
        Prior { motions, enough: f64::NEG_INFINITY, searched: f64::NEG_INFINITY }
    }
}

/// Solves the pair of a frame and another one, whose pyramid is `second`. The motions of a prior are candidates, and all there are where
/// they explain the pair; `expected` are labels of these motions that are likely to go on.
pub(crate) fn solve(
    first: &Frame,
    pyramid: &FramePyramid,
    second: &FramePyramid,
    settings: &Settings,
    prior: Option<&Prior>,
    expected: Option<Buffer<u8>>,
) -> Solution {
    let mut ignored = |_| {};
    let mut stages = Stages::new(super::STAGES, &mut ignored);
    let mut pair = Pair::new(first, pyramid, second, None, settings);
    let likely = prior.map_or(&[][..], |prior| &prior.motions[BACKGROUND + 1..]);
    let prior = prior.filter(|prior| prior.enough > 0.0);
    let (labelled, [enough, searched]) = match (prior, expected) {
        // Frames so narrow that they are not halved to the size of drafts are not followed.
        (Some(prior), Some(labels)) if pair.draft == 0 && pair.selection == 0 => {
            follow(&mut pair, prior, labels, settings)
        }
        (Some(prior), _) => {
            let dominant = pair.find_dominant_near(&prior.motions[BACKGROUND], settings.dominant_search());
            let (found, cost) = hypothesis::expected(&pair, dominant, likely, settings);
            let is_enough = cost < prior.enough + settings.price[0];
            is_enough.then(|| {
                let found = hypothesis::refine(&pair, found, settings);
                (labels::label(&pair, found, settings), [(1.0 + TOLERANCE) * cost, cost])
            })
        }
        _ => None,
    }
    .unwrap_or_else(|| {
        let Solved { pair: solved, labelled, cost } =
            background::solve(Pair::new(first, pyramid, second, None, settings), likely, settings, &mut stages);
        pair = solved;
        let limits = if settings.follows {
            let cost = hypothesis::cost(&pair, &labelled.motions);
            [(1.0 + TOLERANCE_FOLLOWED) * cost, cost]
        } else {
            [(1.0 + TOLERANCE) * cost, cost]
        };
        (labelled, limits)
    });
    let level = pair.finest();
    let costs = costs_where_seen(level, &labelled.motions);
    let most = CostModel::labels().truncation;
    let smallest = cheapest(&costs, most);
    let unexplained = smallest.values().iter().sum::<f32>() / (most * smallest.values().len() as f32);
    let probabilities = probabilities(&costs, &labelled.labels);
    let groups = groups(&labelled.motions, &labelled.labels, level.width(), pair.reduction);
    Solution {
        motions: labelled.motions,
        labels: labelled.labels,
        probabilities,
        groups,
        enough,
        searched,
        unexplained,
    }
}

/// The labels and motions with which the expected ones go on, the cost up to which they are enough afterwards, and that after the last search;
/// none if they do not explain the pair.
fn follow(
    pair: &mut Pair,
    prior: &Prior,
    mut labels: Buffer<u8>,
    settings: &Settings,
) -> Option<(labels::Labelled, [f64; 2])> {
    let dominant = pair.find_dominant_near(&prior.motions[BACKGROUND], settings.dominant_search());
    let objects = &prior.motions[BACKGROUND + 1..];
    let (found, cost) = hypothesis::followed(pair, dominant, objects, &mut labels, settings);
    // Costs rise when a motion is missing, but also when more is occluded.
    let enough = if cost < prior.enough {
        // Else costs that rise little by little would never lead to a look for others.
        prior.enough.min((1.0 + TOLERANCE_FOLLOWED) * cost)
    } else if cost < (1.0 + TOLERANCE_SEARCHED) * prior.searched && !hypothesis::is_missing(pair, &found, settings) {
        (1.0 + TOLERANCE_FOLLOWED) * cost
    } else {
        return None;
    };
    Some((labels::label_on(pair, found, labels, settings), [enough, prior.searched]))
}
