//! A pair solved at the working size, for those who go on from there: no numbering, no full-size labels, no evidence for the number.

use super::settings::{Part, Settings};
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
    /// Cost of the selected motions: what a pair that follows may be expected to cost.
    cost: f64,
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
}

/// Expected motions are enough where they cost no more than this share more than expected. Not varied.
const TOLERANCE: f64 = 0.05;

impl Prior {
    /// What is expected of a mirror image of the frames. `size` is the working size.
    pub(crate) fn mirrored(&self, mirror: Mirror, size: [usize; 2]) -> Prior {
        let motions = self.motions.iter().map(|motion| mirror.motion(motion, size)).collect();
        Prior { motions, enough: self.enough }
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
        Prior { motions: self.motions.clone(), enough: (1.0 + TOLERANCE) * self.cost }
    }

    /// What to expect of the pair the other way round. There is always a search.
    pub(crate) fn reversed(&self) -> Prior {
        let motions = self.motions.iter().map(|motion| inverse(motion).unwrap_or(*motion)).collect();
        Prior { motions, enough: f64::NEG_INFINITY }
    }
}

/// Solves the pair of a frame and another one, whose pyramid is `second`. The motions of a prior
/// are candidates, and all there are where they explain the pair.
pub(crate) fn solve(
    first: &Frame,
    pyramid: &FramePyramid,
    second: &FramePyramid,
    settings: &Settings,
    prior: Option<&Prior>,
) -> Solution {
    let mut ignored = |_| {};
    let mut stages = Stages::new(super::STAGES, &mut ignored);
    let mut pair = Pair::new(first, pyramid, second, None, settings);
    let brightness = settings.has(Part::Brightness);
    let likely = prior.map_or(&[][..], |prior| &prior.motions[BACKGROUND + 1..]);
    let expected = prior.filter(|prior| prior.enough > 0.0).and_then(|prior| {
        let dominant = pair.find_dominant_near(&prior.motions[BACKGROUND], brightness);
        let (found, cost) = hypothesis::expected(&pair, dominant, likely, settings);
        (cost < prior.enough + settings.price[0]).then_some((found, cost))
    });
    let (found, cost) = expected.unwrap_or_else(|| {
        pair = Pair::new(first, pyramid, second, None, settings);
        let dominant = pair.find_dominant(brightness);
        hypothesis::best(&pair, dominant, likely, settings, &mut stages)
    });
    let found = hypothesis::refine(&pair, found, settings);
    let labelled = labels::label(&pair, found, settings);
    let level = pair.finest();
    let costs = costs_where_seen(level, &labelled.motions);
    let most = CostModel::labels().truncation;
    let smallest = cheapest(&costs, most);
    let unexplained = smallest.values().iter().sum::<f32>() / (most * smallest.values().len() as f32);
    let probabilities = probabilities(&costs, &labelled.labels);
    let groups = groups(&labelled.motions, &labelled.labels, level.width(), pair.reduction);
    Solution { motions: labelled.motions, labels: labelled.labels, probabilities, groups, cost, unexplained }
}
