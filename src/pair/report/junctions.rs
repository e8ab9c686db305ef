//! Junctions: how likely two neighbouring regions are to be one thing; and the groups that follow.
//!
//! Things at rest in part, people and animals move in parts that affine motions cannot join. Where two frames cannot tell, a person can,
//! so the regions worth asking about are offered.
//!
//! ```text
//! ln P/(1−P) = ε − α j − β √b₁ + γ √min(b₂, b) + δ s
//! ```
//! The jump j of the flow across the border (median) is a share of the largest motion against the background in these frames: 1 where
//! nothing jumps further, 0 where the flow is continuous. b₁ ≥ b₂ are the shares of the two outlines that lie on the frame's border: parts
//! of the background often reach it both, an object and the background seldom do. Before a camera at rest nothing that moves is background,
//! and b₂ = 0 of what borders on it. s is the share of the smaller region's inner outline that is this border. All of it is measured at the
//! working size.
//!
//! The weights are a maximum likelihood fit to real pairs and, at half the weight, to generated scenes: masks of real pairs show one object
//! each, so that they have few objects that the frame cuts. docs/masks.md has the measurement on others. Colours of the two regions, image
//! edges along the border, the fit of one slanted plane to both flows and the direction of their difference were tried, too; on held-out
//! pairs none improves the log loss by more than .015.

use serde::Serialize;

use super::doubt::shares_on_frame_border;
use crate::labelling::BACKGROUND;
use crate::labelling::regions::description::{border_lengths, counts};
use crate::labelling::regions::groups::{borders, pair};
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::order::median_f64;

/// The common border of two motions of a [`Segmentation`](super::Segmentation), and whether they may be one thing.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Junction {
    /// The labels of the two motions, the smaller first.
    pub labels: [u8; 2],
    /// Probability, 0…1, that the two motions are of one thing: one object, or one background. Groups also depend on whether the flow is
    /// continuous: then it need not be as large.
    pub likelihood: f64,
    /// Length of the border, pixels of the full-size frame. It is measured at the working size.
    pub border: usize,
}

/// The junctions of the motions in `order`, whose place there is their label in the report, by labels. Borders that are too short to
/// decide on groups are left out. `motions` are in pixels of the `labels`, each of which is `reduction` pixels of the frame wide.
pub(super) fn junctions(
    motions: &[AffineMotion],
    labels: &[u8],
    width: usize,
    reduction: f64,
    order: &[usize],
    model: &Model,
) -> Vec<Junction> {
    let n = motions.len();
    let sizes = counts(labels, n);
    let outlines = border_lengths(labels, n, width);
    let on_frame = shares_on_frame_border(labels, n, width);
    let largest = largest_motion(motions, labels, width).max(model.group_tolerance / reduction);
    let at_rest = motions[BACKGROUND] == AffineMotion::STATIC;
    let mut borders = borders(motions, labels, width);
    let mut found = Vec::new();
    for (a, &i) in order.iter().enumerate() {
        for (b, &j) in order.iter().enumerate().skip(a + 1) {
            let along = &mut borders[pair(n, i, j)];
            let Some(jump) = median_f64(along).filter(|_| along.len() >= model.shortest_border) else { continue };
            let smaller = if sizes[i] < sizes[j] { i } else { j };
            let [more, less] = [on_frame[i].max(on_frame[j]), on_frame[i].min(on_frame[j])];
            let evidence = Evidence {
                jump: jump / largest.max(jump),
                on_frame: [more, if at_rest && i.min(j) == BACKGROUND { 0.0 } else { less }],
                outline: along.len() as f64 / outlines[smaller] as f64,
            };
            let border = (along.len() as f64 * reduction) as usize;
            found.push(Junction { labels: [a as u8, b as u8], likelihood: evidence.likelihood(model), border });
        }
    }
    found
}

/// The group of every label of the report, from its `junctions` and the groups by the flow alone: motions whose flow is continuous are one
/// group unless they are unlikely to be one thing, others if they are certain to be.
pub(super) fn groups(junctions: &[Junction], by_flow: &[usize], model: &Model) -> Vec<usize> {
    let mut groups: Vec<usize> = (0..by_flow.len()).collect();
    for Junction { labels, likelihood, .. } in junctions {
        let [one, other] = labels.map(usize::from);
        let needed = if by_flow[one] == by_flow[other] { model.junction_likely } else { model.junction_certain };
        if *likelihood > needed {
            let [kept, joined] = [groups[one].min(groups[other]), groups[one].max(groups[other])];
            groups.iter_mut().filter(|group| **group == joined).for_each(|group| *group = kept);
        }
    }
    groups
}

/// What is known of a border.
#[derive(Clone, Copy, Debug)]
struct Evidence {
    /// Jump of the flow, as a share of the largest motion; 0…1.
    jump: f64,
    /// Shares of both outlines that lie on the frame's border, the larger first.
    on_frame: [f64; 2],
    /// Share of the smaller region's inner outline.
    outline: f64,
}

impl Evidence {
    fn likelihood(&self, model: &Model) -> f64 {
        let [more, less] = self.on_frame;
        let log_odds = model.junction_constant - model.junction_jump * self.jump - model.junction_more * more.sqrt()
            + model.junction_less * less.min(model.junction_enough).sqrt()
            + model.junction_outline * self.outline;
        f64::from(1.0 / (1.0 + libm::expf(-log_odds as f32)))
    }
}

/// The largest motion of a region against the background, root mean square over its pixels; 0 where there is no other region.
fn largest_motion(motions: &[AffineMotion], labels: &[u8], width: usize) -> f64 {
    let mut squares = vec![(0.0, 0.0); motions.len()];
    for (p, &label) in labels.iter().enumerate() {
        let (x, y) = ((p % width) as f64, (p / width) as f64);
        let ([u, v], [r, s]) = (motions[usize::from(label)].flow(x, y), motions[BACKGROUND].flow(x, y));
        let (sum, count) = &mut squares[usize::from(label)];
        *sum += (u - r) * (u - r) + (v - s) * (v - s);
        *count += 1.0;
    }
    squares.iter().map(|(sum, count)| sum / f64::max(*count, 1.0)).fold(0.0, f64::max).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 60;
    const SURE: Evidence = Evidence { jump: 0.5, on_frame: [0.04, 0.0], outline: 0.5 };

    /// Ground (0), a thing with a part on its right that moves a little less (1, 2), and a thing apart (3).
    fn scene() -> ([AffineMotion; 4], Vec<u8>) {
        let labels = (0..WIDTH * 40).map(|p| match (p % WIDTH, p / WIDTH) {
            (10..25, 10..30) => 1,
            (25..35, 10..30) => 2,
            (45..55, 10..20) => 3,
            _ => 0,
        });
        ([0.0, 6.0, 5.0, -4.0].map(|u| AffineMotion::translation(u, 0.0)), labels.collect())
    }

    #[test]
    fn neighbours_have_a_junction_and_others_have_none() {
        let (motions, labels) = scene();
        let found = junctions(&motions, &labels, WIDTH, 2.0, &[0, 1, 2, 3], &Model::DEFAULT);
        let pairs: Vec<[u8; 2]> = found.iter().map(|junction| junction.labels).collect();
        assert_eq!(pairs, [[0, 1], [0, 2], [0, 3], [1, 2]]);
        assert_eq!(found.iter().map(|junction| junction.border).collect::<Vec<_>>(), [100, 80, 80, 40]);
        assert!(found.iter().all(|junction| (0.0..=1.0).contains(&junction.likelihood)));
    }

    #[test]
    fn parts_of_one_thing_are_likelier_to_belong_together_than_thing_and_ground() {
        let (motions, labels) = scene();
        let found = junctions(&motions, &labels, WIDTH, 2.0, &[0, 1, 2, 3], &Model::DEFAULT);
        let [ground, _, apart, parts] = [0, 1, 2, 3].map(|k| found[k].likelihood);
        assert!(parts > 0.8 && ground < 0.5 && apart < parts, "{found:?}");
    }

    #[test]
    fn labels_are_those_of_the_report() {
        let (motions, labels) = scene();
        let found = junctions(&motions, &labels, WIDTH, 1.0, &[0, 1, 2, 3], &Model::DEFAULT);
        // The part (2) is numbered before the thing (1), and the thing apart has no pixels in the report.
        let renumbered = junctions(&motions, &labels, WIDTH, 1.0, &[0, 2, 1], &Model::DEFAULT);
        assert_eq!(renumbered.iter().map(|junction| junction.labels).collect::<Vec<_>>(), [[0, 1], [0, 2], [1, 2]]);
        let likelihoods = [&renumbered[1], &renumbered[0], &renumbered[2]].map(|junction| junction.likelihood);
        assert_eq!(likelihoods, [&found[0], &found[1], &found[3]].map(|junction| junction.likelihood));
    }

    #[test]
    fn continuous_flow_and_likelihood_decide_on_groups() {
        let junction = |labels, likelihood| Junction { labels, likelihood, border: 20 };
        let groups = |likelihoods: [f64; 3], by_flow| {
            let [a, b, c] = likelihoods;
            super::groups(&[junction([0, 1], a), junction([0, 2], b), junction([1, 2], c)], by_flow, &Model::DEFAULT)
        };
        assert_eq!(groups([0.1, 0.1, 0.6], &[0, 1, 1]), [0, 1, 1]);
        assert_eq!(groups([0.1, 0.1, 0.3], &[0, 1, 1]), [0, 1, 2], "continuous, but unlikely");
        assert_eq!(groups([0.1, 0.8, 0.95], &[0, 1, 2]), [0, 1, 2], "likely, but not continuous");
        assert_eq!(groups([0.1, 0.8, 0.98], &[0, 1, 2]), [0, 1, 1], "not continuous, but certain");
        assert_eq!(groups([0.1, 0.8, 0.95], &[0, 0, 0]), [0, 0, 0], "one by way of another");
        assert_eq!(super::groups(&[], &[0, 0], &Model::DEFAULT), [0, 1], "nothing is known without a common border");
    }

    #[test]
    fn short_borders_decide_nothing() {
        let (motions, mut labels) = scene();
        // Only eleven pixels of the part touch the thing.
        labels
            .iter_mut()
            .enumerate()
            .filter(|(p, _)| p % WIDTH == 25 && p / WIDTH > 20)
            .for_each(|(_, label)| *label = 0);
        let pairs = |found: Vec<Junction>| found.iter().any(|junction| junction.labels == [1, 2]);
        assert!(!pairs(junctions(&motions, &labels, WIDTH, 2.0, &[0, 1, 2, 3], &Model::DEFAULT)));
    }

    #[test]
    fn all_evidence_counts() {
        let likelihood = SURE.likelihood(&Model::DEFAULT);
        assert!(Evidence { jump: 0.7, ..SURE }.likelihood(&Model::DEFAULT) < likelihood, "a larger jump");
        assert!(
            Evidence { on_frame: [0.2, 0.0], ..SURE }.likelihood(&Model::DEFAULT) < likelihood,
            "one region reaches the frame's border"
        );
        assert!(Evidence { on_frame: [0.2, 0.2], ..SURE }.likelihood(&Model::DEFAULT) > likelihood, "both do");
        assert!(Evidence { outline: 0.7, ..SURE }.likelihood(&Model::DEFAULT) > likelihood, "more of the outline");
    }

    #[test]
    fn what_moves_before_a_camera_at_rest_is_no_background() {
        // The lower half jumps by as much as anything, and reaches the frame's border as the upper one does.
        let labels: Vec<u8> = (0..WIDTH * 40).map(|p| u8::from(p / WIDTH >= 20)).collect();
        let likelihood = |camera: f64| {
            let motions = [camera, camera + 5.0].map(|u| AffineMotion::translation(u, 0.0));
            junctions(&motions, &labels, WIDTH, 1.0, &[0, 1], &Model::DEFAULT)[0].likelihood
        };
        assert!(
            likelihood(0.0) < 0.1 && likelihood(1.0) > Model::DEFAULT.junction_likely,
            "{} and {}",
            likelihood(0.0),
            likelihood(1.0)
        );
    }

    #[test]
    fn frames_in_which_nothing_moves_have_no_jumps() {
        let (_, labels) = scene();
        let still = [AffineMotion::STATIC; 4];
        assert_eq!(largest_motion(&still, &labels, WIDTH), 0.0);
        assert!(
            junctions(&still, &labels, WIDTH, 1.0, &[0, 1, 2, 3], &Model::DEFAULT)
                .iter()
                .all(|one| one.likelihood.is_finite())
        );
    }
}
