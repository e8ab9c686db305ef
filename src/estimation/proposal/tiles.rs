//! Proposals from single windows: the local flow on a grid, the most certain first.

use super::local_flow::LocalFlow;
use super::{Proposal, distinct, translated};
use crate::motion::AffineMotion;
use crate::order::descending;
use crate::view::level::PairLevel;

/// At most `most` motions: the dominant one plus a translation.
pub(crate) fn from_tiles(
    level: &PairLevel,
    dominant: &AffineMotion,
    flow: &LocalFlow,
    most: usize,
) -> Vec<AffineMotion> {
    let (model, stride) = (level.model, level.model.tile_stride);
    let [columns, rows] = [level.width(), level.height()].map(|size| size.div_ceil(stride));
    let mut certainties = Vec::with_capacity(columns * rows);
    let mut places = Vec::with_capacity(columns * rows);
    for y in (stride / 2..level.height()).step_by(stride) {
        for x in (stride / 2..level.width()).step_by(stride) {
            let (u, v) = (flow.u.at(x, y), flow.v.at(x, y));
            let certainty = flow.certainty.at(x, y);
            if certainty > model.tile_certain && u * u + v * v > model.position_sigma * model.position_sigma {
                certainties.push(certainty);
                places.push(y * level.width() + x);
            }
        }
    }
    let order = descending(certainties.iter().map(|&c| f64::from(c)));
    let pixel = level.pixel();
    let proposals =
        order.iter().map(|&k| (places[k] % level.width(), places[k] / level.width())).map(|(x, y)| Proposal {
            motion: translated(dominant, f64::from(flow.u.at(x, y)) * pixel, f64::from(flow.v.at(x, y)) * pixel),
            place: [x as f64 * pixel, y as f64 * pixel],
        });
    let size = [level.width() as f64 * pixel, level.height() as f64 * pixel];
    distinct(proposals, 2.0 * f64::from(model.position_sigma) * pixel, size, most, model)
}
