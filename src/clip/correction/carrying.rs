//! How the labels of a corrected frame come to the next one.

use super::Front;
use crate::clip::evidence::Flow;
use crate::estimation::alignment::{Alignment, Support, align, ridge_of_label, softened};
use crate::frame::Plane;
use crate::frame::filter::{gaussian, halve};
use crate::frame::pyramid::FramePyramid;
use crate::frame::warp::Footprint;
use crate::labelling::{BACKGROUND, is_background};
use crate::motion::AffineMotion;
use crate::view::cost::{CostModel, cost, inverse, noise};
use crate::view::level::{Level, levels};

/// Window in which a motion must explain the next frame, working pixels. Not varied, like the constants below.
const WINDOW: f32 = 1.5;
/// What a label is worth where its motion does not explain the next frame at all, for one where it does.
const UNEXPLAINED: f32 = 0.2;
/// Share of an object that must be without a motion of its own for its motion to be estimated.
const MOTIONLESS: f64 = 0.5;
/// Iterations of the estimation on each of two levels.
const ITERATIONS: usize = 4;

/// What the labels of one frame say of the next.
pub(super) struct Carried {
    /// For each label, how far it is carried to each pixel, 0…1.
    pub(super) labels: Vec<Plane>,
    /// How far each pixel is governed by the correction, 0…1.
    pub(super) governed: Plane,
    /// Motions that were estimated, by label.
    pub(super) motions: Vec<(u8, AffineMotion)>,
}

impl Carried {
    /// The given labels, carried from `last` along its flow.
    pub(super) fn new(last: &Front, next: &FramePyramid, flow: &Flow, numbers: &[u8]) -> Carried {
        let (width, height) = (last.governed.width(), last.governed.height());
        let motions = estimated(last, next, flow, numbers);
        let mut levels = levels(&next.levels, &last.pyramid.levels, None);
        levels[0].noise = noise(&levels[0], &inverse(&flow.motions[BACKGROUND]).unwrap_or_default());
        let empty = Plane::filled(width, height, 0.0);
        let mut carried = Carried { labels: vec![empty.clone(); numbers.len()], governed: empty, motions };
        for (k, &number) in numbers.iter().enumerate() {
            let own = carried.motions.iter().find(|(label, _)| *label == number).map(|(_, motion)| *motion);
            // An object's parts are carried one by one, each by its own motion.
            for (j, of_pair) in flow.motions.iter().enumerate() {
                let motion = own.filter(|_| j == BACKGROUND).unwrap_or(*of_pair);
                let part = |p: usize| last.labels[p] == number && usize::from(flow.labels[p]) == j;
                let part: Vec<f32> = (0..last.labels.len()).map(|p| f32::from(u8::from(part(p)))).collect();
                if let Some(back) = inverse(&motion)
                    && part.iter().any(|&inside| inside > 0.0)
                {
                    carried.add(k, &part, last, &levels[0], &back);
                }
            }
        }
        carried
    }

    /// Adds a part of label `k`; `back` is the motion from the next frame to the last.
    fn add(&mut self, k: usize, part: &[f32], last: &Front, level: &Level, back: &AffineMotion) {
        let (width, height) = (level.width(), level.height());
        let held: Vec<f32> = part.iter().zip(last.governed.values()).map(|(part, governed)| part * governed).collect();
        let misfit = gaussian(&cost(level, back, CostModel::labels()), WINDOW);
        for y in 0..height {
            for x in 0..width {
                let ([u, v], p) = (back.flow(x as f64, y as f64), y * width + x);
                let source = Footprint::new((x as f64 + u) as f32, (y as f64 + v) as f32, width, height);
                let share = if source.inside { source.sample(part) } else { 0.0 };
                if share > 0.0 {
                    let fits = 1.0 - (misfit.values()[p] / CostModel::labels().truncation).min(1.0);
                    let (label, governed) = (&mut self.labels[k].values_mut()[p], &mut self.governed.values_mut()[p]);
                    *label = label.max(share * (UNEXPLAINED + (1.0 - UNEXPLAINED) * fits));
                    *governed = governed.max(source.sample(&held) * fits);
                }
            }
        }
    }
}

/// The motions to the next frame of objects that the pair saw no motion of.
fn estimated(last: &Front, next: &FramePyramid, flow: &Flow, numbers: &[u8]) -> Vec<(u8, AffineMotion)> {
    let (width, height) = (last.governed.width(), last.governed.height());
    let mut levels = levels(&last.pyramid.levels, &next.levels, None);
    levels.truncate(2);
    for level in &mut levels {
        level.noise = noise(level, &flow.motions[BACKGROUND]);
    }
    let mut motions = Vec::new();
    for &number in numbers.iter().filter(|&&number| number > 0) {
        let of_object = |p: usize| last.labels[p] == number;
        let size = (0..last.labels.len()).filter(|&p| of_object(p)).count();
        let still = (0..last.labels.len()).filter(|&p| of_object(p) && is_background(flow.labels[p])).count();
        if size == 0 || flow.measured && (still as f64) < MOTIONLESS * size as f64 {
            continue;
        }
        let region = Plane::from_fn(width, height, |x, y| f32::from(u8::from(of_object(y * width + x))));
        let mut regions = vec![softened(&region)];
        while regions.len() < levels.len() {
            let half = halve(&regions[regions.len() - 1]);
            regions.push(half);
        }
        let misfit = |motion: &AffineMotion| {
            let plane = cost(&levels[levels.len() - 1], motion, CostModel::labels());
            plane.values().iter().zip(regions[regions.len() - 1].values()).map(|(c, w)| f64::from(c * w)).sum::<f64>()
        };
        let earlier = last.motions.iter().filter(|(label, _)| *label == number).map(|(_, motion)| *motion);
        let candidates: Vec<AffineMotion> = flow.motions.iter().copied().chain(earlier).collect();
        let refined = candidates.iter().map(|candidate| {
            levels.iter().zip(&regions).rev().fold(*candidate, |motion, (level, region)| {
                let how = Alignment::of_region(ITERATIONS, ridge_of_label(1));
                align(level, &motion, &Support::weighted(region), &mut Default::default(), how)
            })
        });
        let best = refined.map(|motion| (misfit(&motion), motion)).min_by(|one, other| one.0.total_cmp(&other.0));
        motions.extend(best.map(|(_, motion)| (number, motion)));
    }
    motions
}
