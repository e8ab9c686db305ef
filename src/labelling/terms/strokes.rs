//! Strokes: at some pixels only some labels are possible.
//!
//! A stroke is a hard constraint on its own pixels and a soft one around them: a label that the nearest stroke excludes costs
//! `STROKE_PRICE · exp(−d/STROKE_REACH)` more. The geodesic distance d grows slowly where the frames agree with the stroke, at image
//! edges where they cannot tell, and fast where they contradict it. One stroke therefore takes a whole region with it and stops at its
//! border.
//!
//! Prices are in costs, of which [`CostModel`](crate::view::cost::CostModel) has at most 2 for a pixel, and distances in steps between
//! neighbours. No study has varied these constants: there is no true answer to how far a stroke should reach.

use crate::frame::Plane;
use crate::frame::filter::gaussian;
use crate::workspace::Buffer;

/// Price of an excluded label next to the stroke: twice the cost of a motion that does not fit.
const STROKE_PRICE: f32 = 4.0;
/// Geodesic distance at which it has fallen to 1/e.
const STROKE_REACH: f32 = 24.0;
/// Length of a step between neighbours where the frames agree with the stroke …
const AGREED_STEP: f32 = 0.25;
/// … added to it where the frames cannot tell …
const UNDECIDED_STEP: f32 = 2.0;
/// … and added at a strong edge where they cannot tell, and everywhere where they contradict the stroke.
const BARRIER: f32 = 40.0;
/// Intensity step, grey levels, at which an edge has 1 − 1/e of its full strength.
const STRONG_EDGE: f32 = 24.0;
/// Difference of two motions' costs at which the frames decide between them …
const DECISIVE_GAP: f32 = 0.5;
/// … averaged over this window, working pixels.
const GAP_WINDOW: f32 = 1.5;
/// Double sweeps in which distances are propagated.
const SWEEPS: usize = 2;
/// Price of an excluded label on the stroke itself.
const EXCLUDED_PRICE: f32 = 1e6;

/// Adds the prices of labels that strokes exclude. `allowed` has a set of labels for every pixel, 0 where any is possible; `edges` is the
/// luminance without blur. Returns the influence of the nearest stroke at every pixel, 0…1.
pub(crate) fn add_strokes(costs: &mut [Plane], allowed: &[u16], edges: &Plane) -> Buffer<f32> {
    let mut influence: Buffer<f32> = allowed.iter().map(|&set| if set == 0 { 0.0 } else { 1.0 }).collect();
    let smooth: Vec<Plane> = costs.iter().map(|c| gaussian(c, GAP_WINDOW)).collect();
    for k in 0..costs.len() {
        let excluded = |p: usize| allowed[p] != 0 && allowed[p] >> k & 1 == 0;
        if !(0..allowed.len()).any(excluded) {
            continue;
        }
        let distance = distances(edges, &cost_gap(&smooth, k), excluded);
        for (p, c) in costs[k].values_mut().iter_mut().enumerate() {
            let strength = libm::expf(-distance[p] / STROKE_REACH);
            *c += if excluded(p) { EXCLUDED_PRICE } else { STROKE_PRICE * strength };
            influence[p] = influence[p].max(strength);
        }
    }
    influence
}

/// By how much label k is more expensive than the cheapest other, in units of [`DECISIVE_GAP`], cut to −1…1.
fn cost_gap(costs: &[Plane], k: usize) -> Vec<f32> {
    let other =
        |p: usize| (0..costs.len()).filter(|&l| l != k).map(|l| costs[l].values()[p]).fold(f32::INFINITY, f32::min);
    let own = costs[k].values().iter().enumerate();
    own.map(|(p, &own)| ((own - other(p)) / DECISIVE_GAP).clamp(-1.0, 1.0)).collect()
}

/// Geodesic distance of every pixel from the nearest one that `starts`. `agreement`, −1…1, is how far the frames agree with the
/// stroke. Distances are propagated along rows and columns in [`SWEEPS`] double sweeps; behind many corners they come out too large.
fn distances(edges: &Plane, agreement: &[f32], starts: impl Fn(usize) -> bool) -> Vec<f32> {
    let (width, height) = (edges.width(), edges.height());
    let values = edges.values();
    let step = |p: usize, q: usize| {
        let both_agree = agreement[p].min(agreement[q]);
        let edge = 1.0 - libm::expf(-(values[p] - values[q]).abs() / STRONG_EDGE);
        AGREED_STEP + (1.0 - both_agree.abs()) * (UNDECIDED_STEP + BARRIER * edge) + BARRIER * (-both_agree).max(0.0)
    };
    let right: Vec<f32> = (0..values.len()).map(|p| if (p + 1) % width == 0 { 0.0 } else { step(p, p + 1) }).collect();
    let down: Vec<f32> = (0..(height - 1) * width).map(|p| step(p, p + width)).collect();
    let mut distance: Vec<f32> = (0..values.len()).map(|p| if starts(p) { 0.0 } else { f32::INFINITY }).collect();
    for _ in 0..SWEEPS {
        for p in 0..values.len() {
            if p % width > 0 {
                distance[p] = distance[p].min(distance[p - 1] + right[p - 1]);
            }
            if p >= width {
                distance[p] = distance[p].min(distance[p - width] + down[p - width]);
            }
        }
        for p in (0..values.len()).rev() {
            if (p + 1) % width != 0 {
                distance[p] = distance[p].min(distance[p + 1] + right[p]);
            }
            if p + width < values.len() {
                distance[p] = distance[p].min(distance[p + width] + down[p]);
            }
        }
    }
    distance
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 9;

    /// A flat image with a white column in the middle that has a gap in the last row.
    fn walled() -> Plane {
        Plane::from_fn(WIDTH, 5, |x, y| if x == 4 && y < 4 { 255.0 } else { 0.0 })
    }

    #[test]
    fn where_the_frames_cannot_tell_distance_goes_around_an_edge() {
        let distance = distances(&walled(), &[0.0; 45], |p| p == 0);
        let step = UNDECIDED_STEP + AGREED_STEP;
        assert_eq!(distance[3], 3.0 * step);
        // Down, through the gap, up again.
        assert_eq!(distance[8], 16.0 * step);
    }

    #[test]
    fn where_they_agree_it_crosses_edges_and_where_they_do_not_it_stops() {
        assert_eq!(distances(&walled(), &[1.0; 45], |p| p == 0)[8], 8.0 * AGREED_STEP);
        let mut agreement = [1.0; 45];
        (0..45).filter(|p| p % WIDTH > 4).for_each(|p| agreement[p] = -1.0);
        assert!(distances(&walled(), &agreement, |p| p == 0)[5] > BARRIER);
    }
}
