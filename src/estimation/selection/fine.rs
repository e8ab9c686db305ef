//! Proposals at a finer level: one step of local flow (the constraint with n = 1 in a window) from the cheapest motion of each pixel.
//! It finds displacements too small for the level of the first selection. Pixels are those of a thinned level.

use super::{ScoredMotion, winners};
use crate::estimation::proposal::{Proposal, distinct, translated};
use crate::frame::Plane;
use crate::frame::filter::gaussian;
use crate::frame::warp::Footprint;
use crate::motion::AffineMotion;
use crate::order::descending;
use crate::view::level::PairLevel;

/// At most `most` local corrections of the selected motions, the most promising first.
pub(crate) fn fine_proposals(level: &PairLevel, selected: &[ScoredMotion], most: usize) -> Vec<AffineMotion> {
    let (width, height) = (level.width(), level.height());
    let (model, stride, flat) = (level.model, level.model.tile_stride, level.model.flow_flat);
    let winners = winners(selected);
    let [xx, xy, yy, xr, yr] = window_sums(level, selected, &winners);
    let [columns, rows] = [width, height].map(|size| size.div_ceil(stride));
    let mut gains = Vec::with_capacity(columns * rows);
    let mut places = Vec::with_capacity(columns * rows);
    let mut steps = Vec::with_capacity(columns * rows);
    for y in (stride / 2..height).step_by(stride) {
        for x in (stride / 2..width).step_by(stride) {
            let (a, c, d) = (xx.at(x, y) + flat, xy.at(x, y), yy.at(x, y) + flat);
            let (p, q) = (xr.at(x, y), yr.at(x, y));
            let determinant = a * d - c * c;
            let (u, v) = ((c * q - d * p) / determinant, (c * p - a * q) / determinant);
            gains.push(-(p * u + q * v));
            places.push(y * width + x);
            steps.push([u, v]);
        }
    }
    let order = descending(gains.iter().map(|&gain| f64::from(gain)));
    let pixel = level.pixel();
    let proposals = order.iter().filter_map(|&k| {
        let [u, v] = steps[k].map(f64::from);
        let length = (u * u + v * v).sqrt();
        let (x, y) = (places[k] % width, places[k] / width);
        (length > f64::from(model.position_sigma)).then(|| Proposal {
            motion: translated(&selected[winners[places[k]]].motion, u * pixel, v * pixel),
            place: [x as f64 * pixel, y as f64 * pixel],
        })
    });
    distinct(
        proposals,
        2.0 * f64::from(model.position_sigma) * pixel,
        [width as f64 * pixel, height as f64 * pixel],
        most,
        model,
    )
}

/// Products of gradients and residual along each pixel's cheapest motion, divided by the variance and averaged over windows.
fn window_sums(level: &PairLevel, selected: &[ScoredMotion], winners: &[usize]) -> [Plane; 5] {
    let (width, height) = (level.width(), level.height());
    let scaled: Vec<AffineMotion> = selected.iter().map(|l| level.scaled(&l.motion)).collect();
    let noise = level.noise * level.noise;
    let stride = level.stride as f64;
    let half = 0.5 * level.stride as f32;
    let mut sums: [Plane; 5] = std::array::from_fn(|_| Plane::filled(width, height, 0.0));
    for y in 0..height {
        for x in 0..width {
            let [u, v] = scaled[winners[y * width + x]].flow(x as f64, y as f64);
            let place = [x as f64 + u, y as f64 + v].map(|p| (stride * p) as f32);
            let at = Footprint::new(place[0], place[1], level.second.width(), level.second.height());
            let gx = half * (level.first_dx.at(x, y) + at.sample(level.second_dx.values()));
            let gy = half * (level.first_dy.at(x, y) + at.sample(level.second_dy.values()));
            let r = at.sample(level.second.values()) - level.first.at(x, y);
            let weight = 1.0 / (noise + level.model.position_variance() * level.energy.at(x, y));
            for (plane, product) in sums.iter_mut().zip([gx * gx, gx * gy, gy * gy, gx * r, gy * r]) {
                plane.row_mut(y)[x] = weight * product;
            }
        }
    }
    sums.map(|plane| gaussian(&plane, level.model.flow_window))
}
