//! Evidence carried through time along the motions of the pixels.

use super::evidence::Evidence;
use crate::frame::Plane;
use crate::frame::warp::Footprint;

/// Where the motion of a pixel leads, in the other frame.
#[inline(always)]
pub(crate) fn destination(along: &Evidence, x: usize, y: usize) -> [f32; 2] {
    let width = along.odds.width();
    let [u, v] = along.motions[usize::from(along.labels[y * width + x])].flow(x as f64, y as f64);
    [(x as f64 + u) as f32, (y as f64 + v) as f32]
}

/// What a plane of another frame says about each pixel of this one: its value where the pixel's motion leads, or at the nearest place
/// inside the frame.
pub(crate) fn carried(plane: &Plane, along: &Evidence) -> Plane {
    let (width, height) = (plane.width(), plane.height());
    Plane::from_fn(width, height, |x, y| {
        let [px, py] = destination(along, x, y);
        Footprint::new(px, py, width, height).sample(plane.values())
    })
}
