//! Splitting of regions to which a single affine motion was fitted although they contain several bodies: every region is tried in two
//! parts.

use super::description::{border_penalty, second_motion_penalty, weight_of_pixel};
use crate::components::{Connectivity, components};
use crate::estimation::alignment::{Alignment, Support, align, ridge_of_label};
use crate::frame::Plane;
use crate::frame::area::Area;
use crate::frame::filter::gaussian;
use crate::labelling::{objects, pixels};
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::view::brightness::GainBias;
use crate::view::cost::{RobustKernel, cost_within};
use crate::view::level::PairLevel;

fn smallest_part(pixels: usize, model: &Model) -> usize {
    model.fewest.max((model.smallest_share * pixels as f64) as usize)
}

/// A motion refined on the pixels of a mask.
pub(super) fn aligned_on(
    level: &PairLevel,
    motion: &AffineMotion,
    mask: &Plane,
    iterations: usize,
    ridge: f64,
) -> AffineMotion {
    let how = Alignment::of_region(iterations, ridge, level.model);
    align(level, motion, &Support::weighted(mask, level.model), &mut GainBias::default(), how)
}

/// Splits objects into two bodies where that shortens the description. The largest part that is not connected with the rest is tried first.
/// Then motions are fitted to the halves along the long axis, and pixels are reassigned to the better one.
pub(crate) fn split_bodies(level: &PairLevel, motions: &mut Vec<AffineMotion>, labels: &mut [u8], most: usize) -> bool {
    let mut changed = false;
    for label in objects(motions.len()) {
        if motions.len() >= most {
            break;
        }
        let region = pixels(labels, |l| l == label);
        if region.len() < 2 * smallest_part(labels.len(), level.model) {
            continue;
        }
        let known = (label, &motions[label]);
        let split = apart(&region, level.width())
            .and_then(|parts| two_bodies(level, known, &region, parts, 0))
            .or_else(|| two_bodies(level, known, &region, far_half(&region, level.width()), level.model.split_rounds));
        if let Some((pair, second)) = split {
            motions[label] = pair[0];
            motions.push(pair[1]);
            let new = (motions.len() - 1) as u8;
            region.iter().zip(&second).filter(|(_, s)| **s).for_each(|(&p, _)| labels[p] = new);
            changed = true;
        }
    }
    changed
}

/// Two motions that shorten the description of a region, and which of its pixels belong to the second. Pixels are reassigned in so many
/// rounds.
fn two_bodies(
    level: &PairLevel,
    (label, motion): (usize, &AffineMotion),
    region: &[usize],
    mut second: Vec<bool>,
    rounds: usize,
) -> Option<([AffineMotion; 2], Vec<bool>)> {
    let (width, height) = (level.width(), level.height());
    let model = level.model;
    // As far as a Gaussian window of this deviation reaches.
    let reach = libm::ceilf(3.0 * model.cost_window) as usize;
    let around = Area::of(region, width).grown(reach, width, height);
    let mut pair = [*motion; 2];
    for round in 0..=rounds {
        let mut costs = Vec::with_capacity(2);
        for (side, motion) in pair.iter_mut().enumerate() {
            let mut mask = Plane::filled(width, height, 0.0);
            for (&p, &s) in region.iter().zip(&second) {
                mask.values_mut()[p] = if usize::from(s) == side { 1.0 } else { 0.0 };
            }
            *motion = aligned_on(level, motion, &mask, model.region_iterations, ridge_of_label(label, model));
            costs.push(gaussian(
                &cost_within(level, &around, motion, RobustKernel::estimation(model)),
                model.cost_window,
            ));
        }
        if round == rounds {
            break;
        }
        for (&p, s) in region.iter().zip(&mut second) {
            let place = around.index_of(p, width);
            *s = costs[1].values()[place] < costs[0].values()[place];
        }
        let share = second.iter().filter(|s| **s).count() as f64 / region.len() as f64;
        if !(model.smallest_body..=1.0 - model.smallest_body).contains(&share) {
            return None;
        }
    }
    let [one, two @ ..] =
        [*motion, pair[0], pair[1]].map(|m| cost_within(level, &around, &m, RobustKernel::estimation(model)));
    let mut gain = 0.0;
    for (&p, &s) in region.iter().zip(&second) {
        let place = around.index_of(p, width);
        gain += 0.5 * f64::from(one.values()[place] - two[usize::from(s)].values()[place]);
    }
    gain *= f64::from(weight_of_pixel(level));
    let of_second = second.iter().filter(|s| **s).count();
    let penalty = second_motion_penalty([region.len() - of_second, of_second])
        + border_penalty(inner_border(region, &second, width, height), model);
    (gain > penalty).then_some((pair, second))
}

/// Which pixels of a region are not connected with most of it; `None` if all of them are.
fn apart(region: &[usize], width: usize) -> Option<Vec<bool>> {
    let mut mask = vec![0u8; (region.last()? / width + 1) * width];
    region.iter().for_each(|&p| mask[p] = 1);
    let found = components(&mask, width, Connectivity::Eight);
    let parts = found.list.iter().enumerate().filter(|(_, part)| part.label == 1);
    let (largest, part) = parts.max_by_key(|(_, part)| part.size)?;
    (part.size < region.len()).then(|| region.iter().map(|&p| found.of[p] as usize != largest).collect())
}

/// Which pixels of a region lie beyond its centre along its long axis.
fn far_half(region: &[usize], width: usize) -> Vec<bool> {
    let n = region.len() as f64;
    let place = |p: usize| ((p % width) as f64, (p / width) as f64);
    let (mut cx, mut cy) = (0.0, 0.0);
    for &p in region {
        cx += place(p).0 / n;
        cy += place(p).1 / n;
    }
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for &p in region {
        let (x, y) = (place(p).0 - cx, place(p).1 - cy);
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    // The larger root of λ² − (xx + yy) λ + xx yy − xy² = 0.
    let largest = 0.5 * (xx + yy + ((xx - yy) * (xx - yy) + 4.0 * xy * xy).sqrt());
    let (ax, ay) = if xx >= yy { (largest - yy, xy) } else { (xy, largest - xx) };
    region.iter().map(|&p| (place(p).0 - cx) * ax + (place(p).1 - cy) * ay > 0.0).collect()
}

/// Number of neighbouring pairs of the region that the split separates.
fn inner_border(region: &[usize], second: &[bool], width: usize, height: usize) -> usize {
    let mut side = vec![0u8; width * height];
    for (&p, &s) in region.iter().zip(second) {
        side[p] = 1 + u8::from(s);
    }
    let apart = |a: u8, b: u8| usize::from(a != 0 && b != 0 && a != b);
    region
        .iter()
        .map(|&p| {
            let right = if (p + 1) % width != 0 { apart(side[p], side[p + 1]) } else { 0 };
            let below = if p + width < side.len() { apart(side[p], side[p + width]) } else { 0 };
            right + below
        })
        .sum()
}
