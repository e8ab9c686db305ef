//! A pair solved at the working size, for those who go on from there: no numbering, no full-size labels, no evidence for the number.

use super::background::{self, Solved};
use super::settings::Settings;
use super::{Pair, hypothesis, labels};
use crate::frame::pyramid::FramePyramid;
use crate::frame::{Frame, Plane};
use crate::labelling::confidence::probabilities;
use crate::labelling::regions::groups::Regions;
use crate::labelling::{BACKGROUND, is_background};
use crate::motion::AffineMotion;
use crate::view::cost::{CostModel, cheapest, costs, inverse};

/// What a pair tells about its first frame. The background has label [`BACKGROUND`](crate::labelling::BACKGROUND).
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    /// Pixels of the working size.
    pub(crate) motions: Vec<AffineMotion>,
    /// The label of every working pixel.
    pub(crate) labels: Vec<u8>,
    /// The probability, 0…1, of every motion at every working pixel.
    pub(crate) probabilities: Vec<Plane>,
    /// The group of every motion, named by its smallest label: motions of one rigid background share one.
    pub(crate) groups: Vec<usize>,
    /// What a fast stream expects of the next pair.
    prior: Option<Prior>,
    /// Mean of the smallest cost of any motion, as a share of the largest cost there is.
    unexplained: f32,
}

impl Solution {
    /// Whether the frames have so little in common that there must be a cut between them.
    pub(crate) fn is_cut(&self) -> bool {
        self.unexplained > 0.5
    }
}

/// What a fast stream expects of a pair: that everything keeps its motion.
#[derive(Clone, Debug)]
pub(crate) struct Prior {
    /// Motions, pixels of the working size; the first is that of the background.
    pub(crate) motions: Vec<AffineMotion>,
    /// Cost up to which these motions are enough.
    pub(crate) enough: f64,
    /// Cost after the last search. Motions that are followed are searched anew at the latest when they cost much more.
    pub(crate) searched: f64,
}

impl Prior {
    /// Whether a prior from outside the program can be used.
    pub(crate) fn is_valid(&self) -> bool {
        !self.motions.is_empty() && self.motions.iter().all(AffineMotion::is_finite)
    }
}

impl Solution {
    /// What a fast stream expects of the next pair.
    pub(crate) fn prior(&self) -> Option<Prior> {
        self.prior.clone()
    }

    /// The motions of its objects, the other way round.
    pub(crate) fn reversed(&self) -> Vec<AffineMotion> {
        self.motions[BACKGROUND + 1..].iter().map(|motion| inverse(motion).unwrap_or(*motion)).collect()
    }
}

/// What is known before a pair is solved.
pub(crate) enum Expected<'a> {
    Nothing,
    /// Objects may have these motions.
    Motions(&'a [AffineMotion]),
    /// The labels of a prior's motions are likely to go on. Where they do not explain the pair, its motions are candidates.
    Labels(&'a Prior, Vec<u8>),
}

/// Solves the pair of a frame and another one, whose pyramid is `second`.
pub(crate) fn solve(
    first: &Frame,
    pyramid: &FramePyramid,
    second: &FramePyramid,
    settings: &Settings,
    expected: Expected<'_>,
) -> Solution {
    let model = settings.model;
    let mut pair = Pair::new(first, pyramid, second, settings);
    let (likely, followed) = match expected {
        Expected::Nothing => (&[][..], None),
        Expected::Motions(motions) => (motions, None),
        // Frames so narrow that they are not halved to the size of drafts are not followed.
        Expected::Labels(prior, labels) => (
            &prior.motions[BACKGROUND + 1..],
            (pair.draft == 0 && pair.selection == 0).then(|| follow(&mut pair, prior, labels, settings)).flatten(),
        ),
    };
    let (mut labelled, limits) = followed.unwrap_or_else(|| {
        let Solved { pair: solved, labelled } =
            background::solve(Pair::new(first, pyramid, second, settings), likely, settings, &mut ());
        pair = solved;
        let cost = if settings.follows {
            // Of a pair prepared as one that is followed: costs are in units of its noise.
            let mut followed = Pair::new(first, pyramid, second, settings);
            followed.find_dominant(Some(&labelled.motions[BACKGROUND]), settings.dominant_search());
            hypothesis::cost(&followed, &labelled.motions)
        } else {
            0.0
        };
        (labelled, [(1.0 + model.follow_tolerance) * cost, cost])
    });
    let with_shadows = labelled.labels.clone();
    labels::return_shadows(&pair, &mut labelled, settings);
    let level = pair.finest();
    let mut costs = costs(level, &labelled.motions, CostModel::labels(model));
    let most = model.largest_cost();
    let smallest = cheapest(&costs, most);
    let unexplained = smallest.values().iter().sum::<f32>() / (most * smallest.values().len() as f32);
    // Where a shadow was given back to the background, a change of light explains it as well as any motion does.
    for (p, cost) in costs[BACKGROUND].values_mut().iter_mut().enumerate() {
        if is_background(labelled.labels[p]) && !is_background(with_shadows[p]) {
            *cost = smallest.values()[p];
        }
    }
    let probabilities = probabilities(&costs, &labelled.labels, model);
    let groups = Regions::new(&labelled.motions, &labelled.labels, level.width(), model).groups();
    let [enough, searched] = limits;
    let prior = settings.follows.then(|| Prior { motions: labelled.motions.clone(), enough, searched });
    Solution { motions: labelled.motions, labels: labelled.labels, probabilities, groups, prior, unexplained }
}

/// The labels and motions with which the expected ones go on, the cost up to which they are enough afterwards, and that after the last search;
/// none if they do not explain the pair.
fn follow(
    pair: &mut Pair,
    prior: &Prior,
    mut labels: Vec<u8>,
    settings: &Settings,
) -> Option<(labels::Labelled, [f64; 2])> {
    let model = settings.model;
    let dominant = pair.find_dominant(Some(&prior.motions[BACKGROUND]), settings.dominant_search());
    let objects = &prior.motions[BACKGROUND + 1..];
    let (found, cost) = hypothesis::followed(pair, dominant, objects, &mut labels, settings);
    // Costs rise when a motion is missing, but also when more is occluded.
    let enough = if cost < prior.enough {
        // Else costs that rise little by little would never lead to a look for others.
        prior.enough.min((1.0 + model.follow_tolerance) * cost)
    } else if cost < (1.0 + model.follow_tolerance_searched) * prior.searched
        && !hypothesis::is_missing(pair, &found, settings)
    {
        (1.0 + model.follow_tolerance) * cost
    } else {
        return None;
    };
    Some((labels::label_on(pair, found, labels, settings), [enough, prior.searched]))
}
