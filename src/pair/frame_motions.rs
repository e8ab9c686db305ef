//! The motions of the first frame of a pair at the working size, for clips, which process them further: without numbering, full-size labels
//! and scores of their number.

use super::dominant::{Dominant, Objects};
use super::frames::Pair;
use super::groups::Regions;
use super::labels::{LabelledPair, Start, label, return_shadows};
use super::settings::Settings;
use super::{figure, hypotheses, motions};
use crate::frame::pyramid::FramePyramid;
use crate::frame::{Frame, Plane};
use crate::labelling::confidence::probabilities;
use crate::labelling::{BACKGROUND, is_background};
use crate::motion::AffineMotion;
use crate::view::cost::{RobustKernel, cheapest, costs};

/// The motions of a frame to another one, and the pixels of each. The background has the label [`BACKGROUND`].
#[derive(Clone, Debug)]
pub(crate) struct FrameMotions {
    /// Pixels of the working size.
    pub(crate) motions: Vec<AffineMotion>,
    /// The label of every working pixel.
    pub(crate) labels: Vec<u8>,
    /// The probability, 0…1, of every motion at every working pixel.
    pub(crate) probabilities: Vec<Plane>,
    /// The group of every motion; that of the ground is [`BACKGROUND`].
    pub(crate) groups: Vec<usize>,
    /// What a fast stream expects of the next pair.
    prior: Option<Prior>,
    /// Mean over the pixels of the smallest cost of any motion, relative to the largest possible cost, 0…1.
    unexplained: f32,
}

impl FrameMotions {
    /// Whether the frames have so little in common that there must be a cut between them.
    pub(crate) fn is_cut(&self) -> bool {
        self.unexplained > 0.5
    }

    /// What a fast stream expects of the next pair.
    pub(crate) fn prior(&self) -> Option<Prior> {
        self.prior.clone()
    }
}

/// What a fast stream expects of the next pair: everything keeps its motion.
#[derive(Clone, Debug)]
pub(crate) struct Prior {
    /// Motions, pixels of the working size; the first is that of the background.
    pub(crate) motions: Vec<AffineMotion>,
    /// Cost up to which these motions suffice.
    pub(crate) enough: f64,
    /// Cost after the last search for motions. Followed motions are searched anew when they cost much more.
    pub(crate) searched: f64,
}

impl Prior {
    /// Whether a prior from outside the program is usable.
    pub(crate) fn is_valid(&self) -> bool {
        !self.motions.is_empty() && self.motions.iter().all(AffineMotion::is_finite)
    }
}

/// What is expected of a pair before it is solved.
pub(crate) enum Expected<'a> {
    Nothing,
    /// The pair in the opposite direction was solved with the inverse of these motions, and these labels of the working size are likely
    /// here.
    Inverse {
        motions: &'a [AffineMotion],
        labels: Vec<u8>,
    },
    /// The labels of a prior's motions, carried on, are likely. Where they do not explain the pair, its motions are candidates.
    Labels(&'a Prior, Vec<u8>),
}

/// Solves the pair of a frame and another one, whose pyramid is `second`.
pub(crate) fn frame_motions(
    first: &Frame,
    pyramid: &FramePyramid,
    second: &FramePyramid,
    settings: &Settings,
    expected: Expected<'_>,
) -> FrameMotions {
    let model = settings.model;
    let pair = || Pair::new(first, pyramid, second, settings);
    let (likely, followed) = match expected {
        Expected::Nothing => (&[][..], None),
        Expected::Inverse { motions, labels } => {
            (&motions[BACKGROUND + 1..], Some((inverted(pair(), motions, labels, settings), [0.0; 2])))
        }
        Expected::Labels(prior, labels) => (&prior.motions[BACKGROUND + 1..], follow(pair(), prior, labels, settings)),
    };
    let (mut labelled, limits) = followed.unwrap_or_else(|| {
        let labelled = hypotheses::solve(pair(), likely, settings, &mut ());
        let cost = if settings.follows {
            // The pair is prepared as one that is followed, so that costs are in units of its noise.
            let mut followed = pair();
            followed.settle_dominant(Dominant::Sought(Some(&labelled.motions[BACKGROUND])), settings);
            motions::cost(&followed, &labelled.motions)
        } else {
            0.0
        };
        (labelled, [(1.0 + model.follow_tolerance) * cost, cost])
    });
    let with_shadows = labelled.labels.clone();
    return_shadows(&mut labelled, settings);
    let LabelledPair { pair, motions, labels, .. } = labelled;
    let level = pair.finest();
    let mut costs = costs(level, &motions, RobustKernel::labels(model));
    let most = model.largest_cost();
    let smallest = cheapest(&costs, most);
    let unexplained = smallest.values().iter().sum::<f32>() / (most * smallest.values().len() as f32);
    // Where a shadow was given back to the background, a change of light explains the pixel as well as a motion does.
    for (p, cost) in costs[BACKGROUND].values_mut().iter_mut().enumerate() {
        if is_background(labels[p]) && !is_background(with_shadows[p]) {
            *cost = smallest.values()[p];
        }
    }
    let probabilities = probabilities(&costs, &labels, model);
    let regions = Regions::new(&motions, &labels, level.width(), model);
    let groups = figure::groups(regions, &motions, &labels, level, settings.subject);
    let [enough, searched] = limits;
    let prior = settings.follows.then(|| Prior { motions: motions.clone(), enough, searched });
    FrameMotions { motions, labels, probabilities, groups, prior, unexplained }
}

/// The labels and motions that continue the expected ones, the cost up to which they suffice from now on, and the cost after the last
/// search. `None` if they do not explain the pair, or if the frames are too narrow to be halved to the size at which motions are selected.
fn follow(mut pair: Pair, prior: &Prior, mut labels: Vec<u8>, settings: &Settings) -> Option<(LabelledPair, [f64; 2])> {
    if pair.draft > 0 || pair.selection > 0 {
        return None;
    }
    let model = settings.model;
    let dominant = pair.settle_dominant(Dominant::Sought(Some(&prior.motions[BACKGROUND])), settings);
    let objects = &prior.motions[BACKGROUND + 1..];
    let (motions, cost) = motions::follow(&pair, dominant, objects, &mut labels, settings);
    // Costs rise when a motion is missing, but also when more is occluded.
    let enough = if cost < prior.enough {
        // Otherwise costs that rise slowly would never lead to a search.
        prior.enough.min((1.0 + model.follow_tolerance) * cost)
    } else if cost < (1.0 + model.follow_tolerance_searched) * prior.searched && !is_missing(&pair, &motions, settings)
    {
        (1.0 + model.follow_tolerance) * cost
    } else {
        return None;
    };
    let start = Start::Expected { labels, regroups: true };
    Some((label(pair, motions, None, start, settings, &mut ()), [enough, prior.searched]))
}

/// Whether another motion would gain more than its penalty.
fn is_missing(pair: &Pair, motions: &[AffineMotion], settings: &Settings) -> bool {
    let mut more = motions.to_vec();
    motions::add_missing(pair, &mut more, settings.most.min(motions.len() + 1), settings);
    more.len() > motions.len()
}

/// The labels and motions of a pair that was solved in the opposite direction.
fn inverted(mut pair: Pair, motions: &[AffineMotion], mut labels: Vec<u8>, settings: &Settings) -> LabelledPair {
    let (background, objects) = (&motions[BACKGROUND], &motions[BACKGROUND + 1..]);
    let dominant = match *background {
        AffineMotion::STATIC => {
            let width = pair.finest().width();
            Dominant::Rest(&Objects { motions: objects, labels: &labels, width })
        }
        _ => Dominant::Sought(Some(background)),
    };
    let dominant = pair.settle_dominant(dominant, settings);
    let (mut motions, _) = motions::follow(&pair, dominant, objects, &mut labels, settings);
    motions::add_missing(&pair, &mut motions, settings.most, settings);
    label(pair, motions, None, Start::Expected { labels, regroups: false }, settings, &mut ())
}
