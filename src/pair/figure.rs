//! Figure and ground: which regions are objects, and which are the scene around them.
//!
//! Every subset S of the regions could be the figure. The one with the highest score is:
//!
//! ```text
//! score(S) = a centre + b plane + c jump + d gain + e kept
//! ```
//! *centre* is how central the pixels of S are, and *plane* the logarithm of how far their flow is from that of one plane: both are means
//! over S less means over the rest. The others are shares of all there is, so that two objects score higher than one of them: *jump* of the
//! jumps of the flow along borders, *gain* of what motions explain better than that of the background, *kept* of what is left when the
//! largest [group](Regions::groups) is the ground.
//!
//! The weights make the figure overlap the true one most on real pairs with one object, with a second one pasted in, and on generated scenes.
//! Each feature wins on sequences that it was not fitted to. Edges of the image along the border won less than chance; depth order at
//! borders, focus, residuals, shapes, deformation, colours and sizes nothing.

use super::groups::Regions;
use super::planar_flow::distances_to_plane;
use crate::labelling::regions::description::counts;
use crate::labelling::{BACKGROUND, thinned};
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::view::cost::{CostModel, costs};
use crate::view::level::Level;

/// The group of the ground.
pub(crate) const GROUND: usize = 0;
/// Largest share of the border of the frame in the figure. Guard: scenes without objects have none that surrounds them.
const MOST_OF_FRAME: f64 = 0.5;
/// Distance to the plane, pixels of the working size, below which all are alike.
const NEAR: f64 = 0.1;
/// How fast centrality falls: 1/e at .35 of the frame's sides from its middle.
const CENTRAL: f64 = 8.0;

/// The groups of the regions of a pair: [`GROUND`], and those of the figure in order of their first region.
pub(super) fn groups(mut regions: Regions<'_>, motions: &[AffineMotion], labels: &[u8], level: &Level) -> Vec<usize> {
    let joined = regions.clone().groups();
    let figure = Known::new(&mut regions, &joined, motions, labels, level).figure(level.model);
    let mut found: Vec<usize> = Vec::new();
    let number = |(region, group): (usize, usize)| {
        if figure >> region & 1 == 0 {
            return GROUND;
        }
        1 + found.iter().position(|&of| of == group).unwrap_or_else(|| {
            found.push(group);
            found.len() - 1
        })
    };
    joined.into_iter().enumerate().map(number).collect()
}

/// What is known of the regions.
struct Known {
    /// Share of all pixels.
    areas: Vec<f64>,
    /// Share of the frame's border.
    frame: Vec<f64>,
    centres: Vec<f64>,
    planes: Vec<f64>,
    gains: Vec<f64>,
    /// Zero of what the largest group is made of.
    kept: Vec<f64>,
    /// Jump along the border of every two regions times its length.
    jumps: Vec<f64>,
}

impl Known {
    fn new(
        regions: &mut Regions<'_>,
        joined: &[usize],
        motions: &[AffineMotion],
        labels: &[u8],
        level: &Level,
    ) -> Known {
        let (n, pixels) = (motions.len(), labels.len() as f64);
        let areas: Vec<f64> = counts(labels, n).into_iter().map(|count| count as f64 / pixels).collect();
        let largest = largest_group(joined, &areas);
        let kept = (0..n).map(|k| if joined[k] == largest { 0.0 } else { areas[k].sqrt() }).collect();
        let planes: Vec<Option<f64>> = distances_to_plane(level, motions, labels)
            .into_iter()
            .map(|distance| distance.map(|distance| libm::log(NEAR + distance)))
            .collect();
        let told: Vec<(f64, f64)> =
            planes.iter().zip(&areas).filter_map(|(plane, area)| plane.zip(Some(*area))).collect();
        let area = told.iter().map(|(_, area)| area).sum::<f64>();
        let mean = told.iter().map(|(plane, area)| plane * area).sum::<f64>() / area.max(f64::MIN_POSITIVE);
        Known {
            frame: regions.shares_of_frame(),
            centres: centres(labels, level.width(), &areas),
            planes: planes.into_iter().map(|plane| plane.unwrap_or(mean)).collect(),
            gains: gains(motions, labels, level),
            jumps: (0..n * n).map(|k| regions.total_jump([k / n, k % n])).collect(),
            areas,
            kept,
        }
    }

    /// The subset with the highest score, a bit for each region; where there is one group it is ground.
    fn figure(&self, model: &Model) -> u32 {
        let n = self.areas.len();
        let kept = (0..n).filter(|&k| self.kept[k] > 0.0).map(|k| 1 << k).sum();
        let possible = |subset: &u32| self.within(*subset, &self.frame) <= MOST_OF_FRAME;
        let subsets = (1..(1 << n) - 1).filter(|subset| kept != 0 && possible(subset));
        let mut best = (f64::NEG_INFINITY, kept);
        for subset in subsets {
            let score = self.score(subset, model);
            if score > best.0 {
                best = (score, subset);
            }
        }
        best.1
    }

    fn score(&self, subset: u32, model: &Model) -> f64 {
        let n = self.areas.len();
        let rest = !subset;
        let share = |of: &[f64]| self.within(subset, of) / of.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        let mean = |subset: u32, of: &[f64]| {
            let weighted: f64 = members(subset, n).map(|k| self.areas[k] * of[k]).sum();
            weighted / self.within(subset, &self.areas).max(LEAST_AREA)
        };
        let excess = |of: &[f64]| mean(subset, of) - mean(rest, of);
        let across: f64 =
            members(subset, n).flat_map(|i| members(rest, n).map(move |j| i * n + j)).map(|k| self.jumps[k]).sum();
        let jumps = self.jumps.iter().sum::<f64>() / 2.0;
        model.figure_centre * excess(&self.centres)
            + model.figure_plane * excess(&self.planes)
            + model.figure_jump * across / jumps.max(f64::MIN_POSITIVE)
            + model.figure_gain * share(&self.gains)
            + model.figure_kept * share(&self.kept)
    }

    fn within(&self, subset: u32, of: &[f64]) -> f64 {
        members(subset, of.len()).map(|k| of[k]).sum()
    }
}

/// Area below which a mean is none, share of the frame.
const LEAST_AREA: f64 = 1e-6;

fn members(subset: u32, of: usize) -> impl Iterator<Item = usize> + Clone {
    (0..of).filter(move |k| subset >> k & 1 == 1)
}

/// The group with most pixels; the first of equals.
fn largest_group(groups: &[usize], areas: &[f64]) -> usize {
    let mut sizes = vec![0.0; groups.len()];
    areas.iter().zip(groups).for_each(|(area, &group)| sizes[group] += area);
    (0..sizes.len()).reduce(|best, k| if sizes[k] > sizes[best] { k } else { best }).unwrap_or(0)
}

/// How central the pixels of every region are, 0…1: a person who films holds the camera on what it is about.
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

/// By how much the motion of every region lowers the costs that its pixels have under the motion of the background, on a sample.
fn gains(motions: &[AffineMotion], labels: &[u8], level: &Level) -> Vec<f64> {
    let sample = level.thinned();
    let costs = costs(&sample, motions, CostModel::labels(level.model));
    let mut gains = vec![0.0; motions.len()];
    for (p, &label) in thinned(labels, level.width(), sample.stride).iter().enumerate() {
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
        let jumps = [[0.0, 40.0, 300.0, 250.0], [40.0, 0.0, 0.0, 0.0], [300.0, 0.0, 0.0, 0.0], [250.0, 0.0, 0.0, 0.0]];
        Known {
            areas: vec![0.6, 0.2, 0.12, 0.08],
            frame: vec![0.7, 0.3, 0.0, 0.0],
            centres: vec![0.4, 0.1, 0.8, 0.6],
            planes: vec![-2.0, -1.8, 1.0, 0.8],
            gains: vec![0.0, 100.0, 800.0, 600.0],
            kept: vec![0.0, 0.45, 0.35, 0.28],
            jumps: jumps.concat(),
        }
    }

    #[test]
    fn objects_are_figure_and_a_slope_is_not() {
        assert_eq!(known().figure(&Model::DEFAULT), 0b1100);
    }

    #[test]
    fn where_there_is_one_group_it_is_ground() {
        let one = Known { kept: vec![0.0; 4], ..known() };
        assert_eq!(one.figure(&Model::DEFAULT), 0);
    }

    #[test]
    fn what_surrounds_the_scene_is_no_figure() {
        let around = Known { frame: vec![0.0, 0.1, 0.6, 0.3], ..known() };
        assert_eq!(around.figure(&Model::DEFAULT) & 0b100, 0);
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
            groups(Regions::new(motions, labels, width, &Model::DEFAULT), motions, labels, level)
        };
        assert_eq!(of(&motions, &labels), [GROUND, 1]);
        let swapped: Vec<u8> = labels.iter().map(|label| 1 - label).collect();
        assert_eq!(of(&[motions[1], motions[0]], &swapped), [1, GROUND], "also where the object's label is 0");
    }
}
