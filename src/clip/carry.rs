//! Evidence carried through time along the motions of the pixels.

use super::evidence::Flow;
use crate::frame::Plane;
use crate::frame::warp::Footprint;

/// What a plane of another frame says about each pixel of this one: its value where the pixel's motion leads, or at the nearest place
/// inside the frame.
pub(crate) fn carried(plane: &Plane, along: &Flow) -> Plane {
    let (width, height) = (plane.width(), plane.height());
    Plane::from_fn(width, height, |x, y| {
        let [u, v] = along.at(x, y);
        Footprint::new((x as f64 + u) as f32, (y as f64 + v) as f32, width, height).sample(plane.values())
    })
}

/// The labels of another frame where the motions of this one's pixels lead; 0 where that is outside.
pub(crate) fn carried_labels(labels: &[u8], along: &Flow) -> Vec<u8> {
    let (width, height) = (along.width, labels.len() / along.width);
    let mut carried = Vec::with_capacity(labels.len());
    for y in 0..height {
        for x in 0..width {
            let [u, v] = along.at(x, y);
            let (px, py) = (x as f64 + u + 0.5, y as f64 + v + 0.5);
            let inside = px >= 0.0 && py >= 0.0 && px < width as f64 && py < height as f64;
            carried.push(if inside { labels[py as usize * width + px as usize] } else { 0 });
        }
    }
    carried
}
