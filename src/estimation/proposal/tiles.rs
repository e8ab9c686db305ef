//! Proposals from single windows: the local flow on a grid, the most certain first.

use super::local_flow::LocalFlow;
use super::{Proposal, distinct, translated};
use crate::motion::AffineMotion;
use crate::order::descending;
use crate::view::level::Level;
use crate::workspace::Buffer;

/// Distance of the windows, pixels of the base level. Chosen on generated scenes, as are all constants below.
const STRIDE: usize = 6;
/// Windows are used if the smaller eigenvalue of their structure tensor, divided by the noise variance, exceeds this.
const CERTAIN: f32 = 0.05;
/// Shorter flow counts as the dominant motion, pixels of the base level: the position error of a correct motion.
const MOVING: f32 = 0.15;
/// Proposals closer than this are the same, pixels of the base level.
const TOLERANCE: f64 = 0.35;

/// At most `most` motions: the dominant one plus a translation.
pub(crate) fn from_tiles(level: &Level, dominant: &AffineMotion, flow: &LocalFlow, most: usize) -> Vec<AffineMotion> {
    let [columns, rows] = [level.width(), level.height()].map(|size| size.div_ceil(STRIDE));
    let mut certainties = Buffer::with_capacity(columns * rows);
    let mut places = Buffer::with_capacity(columns * rows);
    for y in (STRIDE / 2..level.height()).step_by(STRIDE) {
        for x in (STRIDE / 2..level.width()).step_by(STRIDE) {
            let (u, v) = (flow.u.at(x, y), flow.v.at(x, y));
            let certainty = flow.certainty.at(x, y);
            if certainty > CERTAIN && u * u + v * v > MOVING * MOVING {
                certainties.push(certainty);
                places.push(y * level.width() + x);
            }
        }
    }
    let order = descending(certainties.iter().map(|&c| f64::from(c)));
    let pixel = level.pixel();
    let mut proposals =
        order.iter().map(|&k| (places[k] % level.width(), places[k] / level.width())).map(|(x, y)| Proposal {
            motion: translated(dominant, f64::from(flow.u.at(x, y)) * pixel, f64::from(flow.v.at(x, y)) * pixel),
            place: [x as f64 * pixel, y as f64 * pixel],
        });
    let size = [level.width() as f64 * pixel, level.height() as f64 * pixel];
    distinct(&mut proposals, TOLERANCE * pixel, size, most)
}
