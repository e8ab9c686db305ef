//! Figure and ground: which regions are objects, and which are the scene around them.
//!
//! Every subset S of the regions could be the figure. The one with the highest score is:
//!
//! ```text
//! score(S) = a centre + b plane + c edge + d jump + e gain + f kept
//! ```
//! *centre* is how central the pixels of S are, and *plane* the logarithm of the distance of their flow from that of one plane: both are
//! means over S minus means over the rest. *edge* is the mean, along the border of S, of the logarithm of the gradient relative to that of
//! the whole picture: objects end at edges, parts of the ground seldom do. The others are shares of totals, so that two objects score
//! higher than one of them: *jump* is the share of all jumps of the flow that lies on the border of S, *gain* the share of what motions
//! explain better than the background's, *kept* the share of what lies outside the largest [group](Regions::groups).
//!
//! The main subject, on request, is a single thing:
//!
//! ```text
//! score(S) = a like + b jump + c centre + d edge − e frame
//! ```
//! *like* is the overlap of S and the figure, *jump* the mean jump of the flow along the border of S relative to the largest motion,
//! *frame* the root of the share of its outline that lies on the border of the frame. Where several things move, most of them are then
//! lost.
//!
//! The weights maximise the overlap of the figure with the true one on real pairs with one object, on these with a second one pasted in,
//! and on generated scenes; those of the main subject on the real pairs alone. Each feature gains on sequences that it was not fitted to.
//! Depth order at borders, focus, residuals, shapes, deformation, colours and sizes gain nothing in addition.

use super::groups::Regions;
use super::planar_flow::distances_to_plane;
use crate::frame::scaling::Scaling;
use crate::labelling::regions::description::counts;
use crate::labelling::{BACKGROUND, across_borders};
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::view::cost::{RobustKernel, costs};
use crate::view::level::PairLevel;

/// Largest share of the border of the frame that the figure may have. Guard: scenes without objects have no figure that the ground
/// surrounds.
const MOST_OF_FRAME: f64 = 0.5;
/// Largest share of the picture that the figure may have. Guard: an object may fill half of it; in scenes without objects far more would be
/// figure.
const MOST_OF_PICTURE: f64 = 0.6;
/// Distance to the plane, pixels of the working size, below which all distances count the same.
const NEAR: f64 = 0.1;
/// Smallest motion to which jumps at borders are related, pixels of the working size.
const LEAST_MOTION: f64 = 0.5;
/// Mean squared gradient below which edges are noise, squared grey levels per pixel.
const LEAST_GRADIENT: f64 = 0.25;
/// Rate at which centrality falls: 1/e at .35 of the frame's sides from its middle.
const CENTRAL: f64 = 8.0;

/// The group of every region: [`BACKGROUND`], or a number of the figure's groups in the order of their first regions. The main subject is
/// one group.
pub(super) fn groups(
    mut regions: Regions<'_>,
    motions: &[AffineMotion],
    labels: &[u8],
    level: &PairLevel,
    subject: bool,
) -> Vec<usize> {
    let mut joined = regions.clone().groups();
    let known = Known::new(&mut regions, &joined, motions, labels, level);
    let mut figure = known.figure(level.model);
    if subject {
        figure = known.subject(figure, level.model);
        joined.fill(0);
    }
    let mut found: Vec<usize> = Vec::new();
    let number = |(region, group): (usize, usize)| {
        if figure >> region & 1 == 0 {
            return BACKGROUND;
        }
        1 + found.iter().position(|&of| of == group).unwrap_or_else(|| {
            found.push(group);
            found.len() - 1
        })
    };
    joined.into_iter().enumerate().map(number).collect()
}

/// What is measured of the regions.
struct Known {
    /// Share of all pixels.
    areas: Vec<f64>,
    /// Share of the frame's border that each region has.
    frame: Vec<f64>,
    /// Length of the frame's border, pixels.
    around: f64,
    centres: Vec<f64>,
    planes: Vec<f64>,
    gains: Vec<f64>,
    /// 0 for the regions of the largest group.
    kept: Vec<f64>,
    /// Length of the border between every two regions.
    borders: Vec<f64>,
    /// Sum of the edges along it, and its median jump times its length.
    edges: Vec<f64>,
    jumps: Vec<f64>,
    /// The largest motion of a region relative to the background.
    largest: f64,
}

impl Known {
    fn new(
        regions: &mut Regions<'_>,
        joined: &[usize],
        motions: &[AffineMotion],
        labels: &[u8],
        level: &PairLevel,
    ) -> Known {
        let (n, pixels) = (motions.len(), labels.len() as f64);
        let areas: Vec<f64> = counts(labels, n).into_iter().map(|count| count as f64 / pixels).collect();
        let largest = largest_group(joined, &areas);
        let kept = (0..n).map(|k| if joined[k] == largest { 0.0 } else { areas[k].sqrt() }).collect();
        let planes: Vec<Option<f64>> = distances_to_plane(level, motions, labels)
            .into_iter()
            .map(|distance| distance.map(|distance| libm::log(NEAR + distance)))
            .collect();
        let measured: Vec<(f64, f64)> =
            planes.iter().zip(&areas).filter_map(|(plane, area)| plane.zip(Some(*area))).collect();
        let area = measured.iter().map(|(_, area)| area).sum::<f64>();
        let mean = measured.iter().map(|(plane, area)| plane * area).sum::<f64>() / area.max(f64::MIN_POSITIVE);
        let (mut borders, mut jumps) = (vec![0.0; n * n], vec![0.0; n * n]);
        for k in 0..n * n {
            let pair = [k / n, k % n];
            (borders[k], jumps[k]) = (regions.border(pair) as f64, regions.total_jump(pair));
        }
        Known {
            frame: regions.shares_of_frame(),
            around: 2.0 * (level.width() + level.height()) as f64,
            centres: centres(labels, level.width(), &areas),
            planes: planes.into_iter().map(|plane| plane.unwrap_or(mean)).collect(),
            gains: gains(motions, labels, level),
            borders,
            edges: edges(labels, n, level),
            jumps,
            largest: regions.largest_motion(),
            areas,
            kept,
        }
    }

    /// The subset with the highest score, one bit per region; empty if there is only one group, which is then ground.
    fn figure(&self, model: &Model) -> u32 {
        let kept = (0..self.areas.len()).filter(|&k| self.kept[k] > 0.0).map(|k| 1 << k).sum();
        self.best(kept, &|subset| {
            let possible = self.within(subset, &self.frame) <= MOST_OF_FRAME
                && self.within(subset, &self.areas) <= MOST_OF_PICTURE;
            possible.then(|| self.score(subset, model))
        })
    }

    /// The subset of the main subject; empty if the figure is empty.
    fn subject(&self, figure: u32, model: &Model) -> u32 {
        self.best(figure, &|subset| Some(self.score_of_subject(subset, figure, model)))
    }

    /// The subset with the highest score; `otherwise` if none has a score.
    fn best(&self, otherwise: u32, score: &dyn Fn(u32) -> Option<f64>) -> u32 {
        let mut best = (f64::NEG_INFINITY, otherwise);
        for subset in (1..(1 << self.areas.len()) - 1).filter(|_| otherwise != 0) {
            match score(subset) {
                Some(score) if score > best.0 => best = (score, subset),
                _ => {}
            }
        }
        best.1
    }

    fn score(&self, subset: u32, model: &Model) -> f64 {
        let share = |of: &[f64]| self.within(subset, of) / of.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        let jumps = self.jumps.iter().sum::<f64>() / 2.0;
        model.figure_centre * self.excess(subset, &self.centres)
            + model.figure_plane * self.excess(subset, &self.planes)
            + model.figure_edge * self.along(subset, &self.edges)
            + model.figure_jump * self.across(subset, &self.jumps) / jumps.max(f64::MIN_POSITIVE)
            + model.figure_gain * share(&self.gains)
            + model.figure_kept * share(&self.kept)
    }

    fn score_of_subject(&self, subset: u32, figure: u32, model: &Model) -> f64 {
        let area = |subset: u32| self.within(subset, &self.areas);
        let like = area(subset & figure) / area(subset | figure).max(LEAST_AREA);
        let on_frame = self.around * self.within(subset, &self.frame);
        let outline = on_frame + self.across(subset, &self.borders);
        model.subject_like * like
            + model.subject_jump * self.along(subset, &self.jumps) / (self.largest + LEAST_MOTION)
            + model.subject_centre * self.excess(subset, &self.centres)
            + model.subject_edge * self.along(subset, &self.edges)
            - model.subject_frame * (on_frame / outline.max(1.0)).sqrt()
    }

    /// The mean over a subset minus that over the rest.
    fn excess(&self, subset: u32, of: &[f64]) -> f64 {
        let mean = |subset: u32| {
            let weighted: f64 = members(subset, of.len()).map(|k| self.areas[k] * of[k]).sum();
            weighted / self.within(subset, &self.areas).max(LEAST_AREA)
        };
        mean(subset) - mean(!subset)
    }

    /// The mean along the border of a subset.
    fn along(&self, subset: u32, of: &[f64]) -> f64 {
        self.across(subset, of) / self.across(subset, &self.borders).max(1.0)
    }

    /// The sum over all pairs of a region in the subset and one outside.
    fn across(&self, subset: u32, of: &[f64]) -> f64 {
        let n = self.areas.len();
        members(subset, n).map(|i| self.within(!subset, &of[i * n..][..n])).sum()
    }

    fn within(&self, subset: u32, of: &[f64]) -> f64 {
        members(subset, of.len()).map(|k| of[k]).sum()
    }
}

/// Area below which a mean counts as 0, share of the frame.
const LEAST_AREA: f64 = 1e-6;

fn members(subset: u32, of: usize) -> impl Iterator<Item = usize> {
    (0..of).filter(move |k| subset >> k & 1 == 1)
}

/// The group with the most pixels; on ties the first.
fn largest_group(groups: &[usize], areas: &[f64]) -> usize {
    let mut sizes = vec![0.0; groups.len()];
    areas.iter().zip(groups).for_each(|(area, &group)| sizes[group] += area);
    (0..sizes.len()).reduce(|best, k| if sizes[k] > sizes[best] { k } else { best }).unwrap_or(0)
}

/// How central the pixels of every region are, 0…1: people keep what they film in the middle.
fn centres(labels: &[u8], width: usize, areas: &[f64]) -> Vec<f64> {
    let height = labels.len() / width;
    let falling = |place: usize, side: usize| {
        let from_middle = place as f64 / side as f64 - 0.5;
        libm::exp(-CENTRAL * from_middle * from_middle)
    };
    let across: Vec<f64> = (0..width).map(|x| falling(x, width)).collect();
    let mut centres = vec![0.0; areas.len()];
    for (y, row) in labels.chunks_exact(width).enumerate() {
        let down = falling(y, height);
        row.iter().zip(&across).for_each(|(&label, across)| centres[usize::from(label)] += down * across);
    }
    let pixels = labels.len() as f64;
    centres.iter().zip(areas).map(|(centre, area)| centre / (area * pixels).max(1.0)).collect()
}

/// For every two regions, the sum along their border of the logarithm of the gradient relative to that of the whole picture.
fn edges(labels: &[u8], n: usize, level: &PairLevel) -> Vec<f64> {
    let energy = level.energy.values();
    let mean = energy.iter().map(|&energy| f64::from(energy)).sum::<f64>() / energy.len() as f64;
    let mut edges = vec![0.0; n * n];
    across_borders(labels, level.width(), |p, q| {
        let here = f64::from(energy[p].max(energy[q]));
        let edge = 0.5 * libm::log((here + LEAST_GRADIENT) / (mean + LEAST_GRADIENT));
        let [i, j] = [p, q].map(|p| usize::from(labels[p]));
        edges[i * n + j] += edge;
        edges[j * n + i] += edge;
    });
    edges
}

/// How much the motion of every region lowers the costs of its pixels compared with the background's motion, on a sample.
fn gains(motions: &[AffineMotion], labels: &[u8], level: &PairLevel) -> Vec<f64> {
    let sample = level.thinned();
    let costs = costs(&sample, motions, RobustKernel::labels(level.model));
    let mut gains = vec![0.0; motions.len()];
    let scaling = Scaling::between([level.width(), level.height()], [sample.width(), sample.height()]);
    for (p, label) in scaling.thinned(labels).into_iter().enumerate() {
        let [ground, own] = [BACKGROUND, usize::from(label)].map(|k| costs[k].values()[p]);
        gains[usize::from(label)] += f64::from(ground - own);
    }
    gains.into_iter().map(|gain| gain.max(0.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Plane;
    use crate::view::level::build;

    /// The ground, a slope in front of it that reaches the border of the frame, and two objects.
    fn known() -> Known {
        let borders =
            [[0.0, 200.0, 120.0, 100.0], [200.0, 0.0, 0.0, 0.0], [120.0, 0.0, 0.0, 0.0], [100.0, 0.0, 0.0, 0.0]]
                .concat();
        let times = |factors: [f64; 3]| {
            let of = |k: usize| match k {
                1 | 4 => factors[0],
                2 | 8 => factors[1],
                _ => factors[2],
            };
            borders.iter().enumerate().map(|(k, border)| border * of(k)).collect()
        };
        Known {
            areas: vec![0.6, 0.2, 0.12, 0.08],
            frame: vec![0.7, 0.3, 0.0, 0.0],
            around: 1000.0,
            centres: vec![0.4, 0.1, 0.8, 0.5],
            planes: vec![-2.0, -1.8, 1.0, 0.8],
            gains: vec![0.0, 100.0, 800.0, 600.0],
            kept: vec![0.0, 0.45, 0.35, 0.28],
            edges: times([-0.3, 0.8, 0.7]),
            jumps: times([0.2, 2.5, 2.5]),
            largest: 3.0,
            borders,
        }
    }

    #[test]
    fn objects_are_figure_and_a_slope_is_not() {
        assert_eq!(known().figure(&Model::DEFAULT), 0b1100);
    }

    #[test]
    fn the_main_subject_is_the_central_one_of_two() {
        let known = Known { centres: vec![0.3, 0.1, 0.9, 0.2], frame: vec![0.6, 0.3, 0.0, 0.1], ..known() };
        assert_eq!(known.figure(&Model::DEFAULT), 0b1100);
        assert_eq!(known.subject(0b1100, &Model::DEFAULT), 0b0100);
    }

    #[test]
    fn where_there_is_one_group_it_is_ground() {
        let one = Known { kept: vec![0.0; 4], ..known() };
        assert_eq!(one.figure(&Model::DEFAULT), 0);
        assert_eq!(one.subject(0, &Model::DEFAULT), 0);
    }

    #[test]
    fn what_surrounds_the_scene_is_no_figure() {
        let around = Known { frame: vec![0.0, 0.1, 0.6, 0.3], ..known() };
        assert_eq!(around.figure(&Model::DEFAULT) & 0b100, 0);
    }

    #[test]
    fn an_enclosed_object_may_fill_half_of_the_picture_and_not_most_of_it() {
        let filling = |share: f64| Known { areas: vec![0.9 - share, 0.05, share, 0.05], ..known() };
        assert_eq!(filling(0.5).figure(&Model::DEFAULT) & 0b100, 0b100);
        assert_eq!(filling(0.65).figure(&Model::DEFAULT) & 0b100, 0);
    }

    #[test]
    fn centres_are_higher_in_the_middle() {
        let labels: Vec<u8> =
            (0..40 * 30).map(|p| u8::from((10..30).contains(&(p % 40)) && (8..22).contains(&(p / 40)))).collect();
        let inside = labels.iter().map(|&label| f64::from(label)).sum::<f64>() / labels.len() as f64;
        let [ground, middle] = centres(&labels, 40, &[1.0 - inside, inside])[..] else { panic!() };
        assert!(0.0 < ground && ground < 0.6 && middle > 0.7 && middle < 1.0, "{ground} {middle}");
    }

    #[test]
    fn groups_of_the_figure_are_numbered_after_the_ground() {
        let (width, height) = (96, 72);
        let texture =
            |x: f64, y: f64| 128.0 + 50.0 * libm::sin(0.7 * x + 0.2 * y) + 40.0 * libm::sin(0.9 * y - 0.3 * x);
        let square = |x: usize, y: usize| (36..60).contains(&x) && (24..48).contains(&y);
        let labels: Vec<u8> = (0..width * height).map(|p| u8::from(square(p % width, p / width))).collect();
        let motions = [AffineMotion::translation(1.0, 0.0), AffineMotion::translation(-3.0, 2.0)];
        let first = Plane::from_fn(width, height, |x, y| texture(x as f64, y as f64) as f32);
        let second = Plane::from_fn(width, height, |x, y| {
            let object = x < width - 3 && y >= 2 && square(x + 3, y - 2);
            let [u, v] = if object { [-3.0, 2.0] } else { [1.0, 0.0] };
            texture(x as f64 - u, y as f64 - v) as f32
        });
        let level = &build(first, second, 24)[0];
        let of = |motions: &[AffineMotion], labels: &[u8]| {
            groups(Regions::new(motions, labels, width, &Model::DEFAULT), motions, labels, level, false)
        };
        assert_eq!(of(&motions, &labels), [BACKGROUND, 1]);
        let swapped: Vec<u8> = labels.iter().map(|label| 1 - label).collect();
        assert_eq!(of(&[motions[1], motions[0]], &swapped), [1, BACKGROUND], "also where the object's label is 0");
    }
}
