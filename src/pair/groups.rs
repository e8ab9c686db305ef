//! Groups of regions that are parts of one thing: of an object that bends, or of a background at several depths.
//!
//! ```text
//! ln P/(1−P) = ε − α ln r − β √b₁ + γ √min(b₂, b),    r = (j + κ)/(m + κ)
//! ```
//! P is the probability that two neighbouring regions are parts of one thing, j the median jump of the flow across their border, m the
//! largest motion relative to the background in these frames, and κ the error of the position that a motion predicts: r is 1 at the largest
//! jumps, and small where the flow is continuous. b₁ ≥ b₂ are the shares of the two outlines that lie on the border of the frame: two parts
//! of the background often both reach it, an object and the background seldom do. Before a camera at rest nothing that moves is background:
//! r = 1 and b₂ = 0 for regions next to it. All of this is measured at the working size.
//!
//! The weights are a maximum likelihood fit to real pairs and generated scenes. The absolute jump, the share of the outline, sizes, colours of
//! the two regions, image edges along the border, the fit of one slanted plane to both flows and the direction of their difference were tried,
//! too; none improves the groups of held-out pairs.
//!
//! Regions are joined pair by pair, the likeliest first, as long as P is above ½, and a joined region is measured again along its whole
//! border. A chain of small jumps therefore does not join two regions that differ along their own border; otherwise a slowly moving limb
//! would tie a whole animal to the ground.

use crate::labelling::regions::description::border_lengths;
use crate::labelling::{BACKGROUND, across_borders};
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::order::median_f64;

/// The regions of a labelling, and the borders between them.
#[derive(Clone, Debug)]
pub(crate) struct Regions<'a> {
    regions: Vec<Region>,
    /// For every [`pair`] of labels, the difference of their flows at each pixel pair of the border, pixels of the labels.
    jumps: Vec<Vec<f64>>,
    /// The largest motion of a region relative to the background, pixels of the labels.
    largest: f64,
    /// Whether the background is at rest.
    at_rest: bool,
    model: &'a Model,
}

/// A region, or several that are joined.
#[derive(Clone, Copy, Debug, Default)]
struct Region {
    /// Pixel pairs on its outline inside the frame.
    inner: usize,
    /// Sides of its pixels on the border of the frame.
    outer: usize,
}

impl Region {
    /// Share of the outline that lies on the border of the frame.
    fn on_frame(&self) -> f64 {
        self.outer as f64 / (self.inner + self.outer).max(1) as f64
    }
}

impl<'a> Regions<'a> {
    /// The regions of some labels; `motions` are in pixels of the labels.
    pub(crate) fn new(motions: &[AffineMotion], labels: &[u8], width: usize, model: &'a Model) -> Regions<'a> {
        let n = motions.len();
        let mut regions = vec![Region::default(); n];
        let mut jumps: Vec<Vec<f64>> = vec![Vec::new(); n * n];
        sides_on_frame(labels, n, width).into_iter().zip(&mut regions).for_each(|(outer, region)| region.outer = outer);
        across_borders(labels, width, |p, q| {
            let (i, j) = (usize::from(labels[p]), usize::from(labels[q]));
            [i, j].into_iter().for_each(|k| regions[k].inner += 1);
            let (x, y) = ((p % width) as f64, (p / width) as f64);
            let ([u, v], [r, s]) = (motions[i].flow(x, y), motions[j].flow(x, y));
            jumps[pair(n, i, j)].push(((u - r) * (u - r) + (v - s) * (v - s)).sqrt());
        });
        let at_rest = motions[BACKGROUND] == AffineMotion::STATIC;
        Regions { regions, jumps, largest: largest_motion(motions, labels, width), at_rest, model }
    }

    /// Length of the border of two regions, pixel pairs of the labels.
    pub(crate) fn border(&self, [i, j]: [usize; 2]) -> usize {
        self.jumps[pair(self.regions.len(), i, j)].len()
    }

    /// The median jump of the flow across the border of two regions, times its length; pixels of the labels.
    pub(super) fn total_jump(&mut self, [i, j]: [usize; 2]) -> f64 {
        let n = self.regions.len();
        let along = &mut self.jumps[pair(n, i, j)];
        along.len() as f64 * median_f64(along).unwrap_or(0.0)
    }

    /// The largest motion of a region relative to the background, pixels of the labels.
    pub(super) fn largest_motion(&self) -> f64 {
        self.largest
    }

    /// Share of the border of the frame that every region has.
    pub(super) fn shares_of_frame(&self) -> Vec<f64> {
        let all: usize = self.regions.iter().map(|region| region.outer).sum();
        self.regions.iter().map(|region| region.outer as f64 / all as f64).collect()
    }

    /// Probability, 0…1, that two regions are parts of one thing; `None` where their border is too short to decide.
    pub(crate) fn likelihood(&mut self, [i, j]: [usize; 2]) -> Option<f64> {
        let n = self.regions.len();
        let along = &mut self.jumps[pair(n, i, j)];
        let border = along.len();
        let jump = median_f64(along).filter(|_| 2 * border >= self.model.fewest_of_border)?;
        let [one, other] = [self.regions[i].on_frame(), self.regions[j].on_frame()];
        // Before a camera at rest nothing that moves is background.
        let [largest, less] = match self.at_rest && i.min(j) == BACKGROUND {
            true => [jump, 0.0],
            false => [self.largest.max(jump), one.min(other)],
        };
        let model = self.model;
        let sigma = f64::from(model.position_sigma);
        let log_odds = model.joint_constant
            - model.joint_jump * libm::log((jump + sigma) / (largest + sigma))
            - model.joint_more * libm::sqrt(one.max(other))
            + model.joint_less * libm::sqrt(less.min(model.joint_enough));
        Some(f64::from(1.0 / (1.0 + libm::expf(-log_odds as f32))))
    }

    /// The group of every region: the smallest label in it.
    pub(crate) fn groups(mut self) -> Vec<usize> {
        let n = self.regions.len();
        let mut group: Vec<usize> = (0..n).collect();
        while let Some([kept, gone]) = self.likeliest() {
            self.join(kept, gone);
            group.iter_mut().filter(|g| **g == gone).for_each(|g| *g = kept);
        }
        group
    }

    /// The two regions that are most likely one thing, the smaller label first; `None` if no two are more likely one than two.
    fn likeliest(&mut self) -> Option<[usize; 2]> {
        let n = self.regions.len();
        let mut best = (0.5, None);
        for pair in (0..n).flat_map(|i| (i + 1..n).map(move |j| [i, j])) {
            match self.likelihood(pair) {
                Some(likelihood) if likelihood > best.0 => best = (likelihood, Some(pair)),
                _ => {}
            }
        }
        best.1
    }

    fn join(&mut self, kept: usize, gone: usize) {
        let n = self.regions.len();
        let common = 2 * self.border([kept, gone]);
        for other in 0..n {
            let moved = std::mem::take(&mut self.jumps[pair(n, gone, other)]);
            if other != kept && other != gone {
                self.jumps[pair(n, kept, other)].extend(moved);
            }
        }
        let Region { inner, outer } = std::mem::take(&mut self.regions[gone]);
        let joined = &mut self.regions[kept];
        *joined = Region { inner: joined.inner + inner - common, outer: joined.outer + outer };
    }
}

/// Index of a pair of labels in a list of n · n.
fn pair(n: usize, i: usize, j: usize) -> usize {
    i.min(j) * n + i.max(j)
}

/// Sides of the pixels of each label on the border of the frame.
fn sides_on_frame(labels: &[u8], of: usize, width: usize) -> Vec<usize> {
    let mut sides = vec![0; of];
    let rows = labels.chunks(width).flat_map(|row| [row[0], row[width - 1]]);
    let columns = labels[..width].iter().chain(&labels[labels.len() - width..]);
    rows.chain(columns.copied()).for_each(|label| sides[usize::from(label)] += 1);
    sides
}

/// Share of the outline of each label that lies on the border of the frame; 0 for a label without pixels.
pub(crate) fn shares_on_frame(labels: &[u8], of: usize, width: usize) -> Vec<f64> {
    let inner = border_lengths(labels, of, width);
    let outer = sides_on_frame(labels, of, width);
    inner.into_iter().zip(outer).map(|(inner, outer)| Region { inner, outer }.on_frame()).collect()
}

/// The largest motion of a region relative to the background, root mean square over its pixels; 0 if there is no other region.
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

    #[test]
    fn a_continuous_surface_is_one_group_and_a_jump_is_two() {
        // Left third, middle third, right third; flow continuous at x = 20, jumping at x = 40.
        let labels: Vec<u8> = (0..60 * 30).map(|p| ((p % 60) / 20) as u8).collect();
        let motions = [
            AffineMotion::translation(1.0, 0.0),
            AffineMotion::new([0.05, 0.0, 0.0, 0.0, 0.0, 0.0]),
            AffineMotion::translation(7.0, 0.0),
        ];
        assert_eq!(Regions::new(&motions, &labels, 60, &Model::DEFAULT).groups(), [0, 0, 2]);
    }

    #[test]
    fn a_chain_of_small_jumps_does_not_tie_a_moving_thing_to_the_ground() {
        // The thing (1) jumps by 0.56 pixels against the ground (0) along most of its border; its foot (2) moves half as much, which
        // is too little a difference from either.
        let (width, height) = (60, 60);
        let labels: Vec<u8> = (0..width * height)
            .map(|p| match (p % width, p / width) {
                (20..40, 10..40) => 1,
                (26..42, 40..44) => 2,
                _ => 0,
            })
            .collect();
        let motions = [
            AffineMotion::translation(0.0, 0.0),
            AffineMotion::translation(0.56, 0.0),
            AffineMotion::translation(0.28, 0.0),
        ];
        let groups = Regions::new(&motions, &labels, width, &Model::DEFAULT).groups();
        assert_ne!(groups[0], groups[1]);
    }

    #[test]
    fn before_a_camera_at_rest_there_are_no_layers_of_the_background() {
        // Two things: one moves by 5 pixels against the ground, the other one by a third of a pixel, as a layer of the ground might.
        let (width, height) = (90, 40);
        let labels: Vec<u8> = (0..width * height)
            .map(|p| match (p % width, p / width) {
                (10..30, 10..30) => 1,
                (50..70, 10..30) => 2,
                _ => 0,
            })
            .collect();
        let groups = |camera: f64| {
            let motions = [0.0, 5.0, 0.3].map(|u| AffineMotion::translation(camera + u, 0.0));
            Regions::new(&motions, &labels, width, &Model::DEFAULT).groups()
        };
        assert_eq!(groups(1.0), [0, 1, 0]);
        assert_eq!(groups(0.0), [0, 1, 2]);
    }

    #[test]
    fn where_nothing_touches_every_motion_is_its_own_group() {
        let labels = vec![0; 32 * 32];
        assert_eq!(
            Regions::new(&[AffineMotion::STATIC, AffineMotion::translation(9.0, 0.0)], &labels, 32, &Model::DEFAULT)
                .groups(),
            [0, 1]
        );
    }

    /// Likelihood that an object (1) on the ground (0) is of one piece with it, where the object moves by `jump` and another (2) by 5.
    fn likelihood(ground: f64, jump: f64, thing: [std::ops::Range<usize>; 2]) -> Option<f64> {
        let (width, height) = (90, 60);
        let labels: Vec<u8> = (0..width * height)
            .map(|p| match (p % width, p / width) {
                (x, y) if thing[0].contains(&x) && thing[1].contains(&y) => 1,
                (60..80, 20..40) => 2,
                _ => 0,
            })
            .collect();
        let motions = [0.0, jump, 5.0].map(|u| AffineMotion::translation(ground + u, 0.0));
        Regions::new(&motions, &labels, width, &Model::DEFAULT).likelihood([0, 1])
    }

    #[test]
    fn all_features_count() {
        let within = likelihood(1.0, 1.0, [10..30, 10..30]);
        assert!(likelihood(1.0, 2.0, [10..30, 10..30]) < within, "a larger jump");
        let [wide, high] = [likelihood(1.0, 1.0, [0..30, 10..30]), likelihood(1.0, 1.0, [10..30, 0..30])];
        assert!(wide > within && high > within, "both reach the border of the frame");
        assert!(likelihood(0.0, 1.0, [0..30, 10..30]) < within, "one does, before a camera at rest");
        assert_eq!(likelihood(1.0, 1.0, [0..2, 0..2]), None, "too short a border");
    }

    #[test]
    fn joined_regions_have_their_outer_border() {
        // Two halves of a square: what they have in common is no border of the square.
        let (width, height) = (60, 40);
        let label = |x: usize, y: usize| match (x, y) {
            (0..10, 10..30) => 1,
            (10..20, 10..30) => 2,
            _ => 0,
        };
        let labels: Vec<u8> = (0..width * height).map(|p| label(p % width, p / width)).collect();
        let motions = [0.0, 4.0, 4.1].map(|u| AffineMotion::translation(u, 0.0));
        let mut regions = Regions::new(&motions, &labels, width, &Model::DEFAULT);
        regions.join(1, 2);
        assert_eq!(regions.border([0, 1]), 60);
        let square: Vec<u8> = labels.iter().map(|&label| label.min(1)).collect();
        assert_eq!(regions.regions[1].on_frame(), shares_on_frame(&square, 2, width)[1]);
        assert_eq!(regions.groups(), [0, 1, 2], "where nothing else is joined, labels stay as they are");
    }

    #[test]
    fn outlines_are_counted_in_sides_of_pixels() {
        let square = |x: usize| -> Vec<u8> {
            (0..96).map(|p| u8::from((x..x + 3).contains(&(p % 12)) && (2..5).contains(&(p / 12)))).collect()
        };
        let of_object = |labels: &[u8]| shares_on_frame(labels, 3, 12)[1];
        assert_eq!(of_object(&square(4)), 0.0);
        assert_eq!(of_object(&square(0)), 0.25);
        assert_eq!(of_object(&[1; 96]), 1.0);
        assert_eq!(of_object(&[0; 96]), 0.0);
    }

    #[test]
    fn frames_in_which_nothing_moves_have_no_jumps() {
        let labels: Vec<u8> = (0..60 * 30).map(|p| ((p % 60) / 20) as u8).collect();
        let still = [AffineMotion::STATIC; 3];
        assert_eq!(largest_motion(&still, &labels, 60), 0.0);
        let likelihood = Regions::new(&still, &labels, 60, &Model::DEFAULT).likelihood([0, 1]);
        assert!(likelihood.is_some_and(f64::is_finite));
    }
}
