//! Log-odds and labels carried from frame to frame along the motions of the pixels.

use super::pairs::LayeredMotion;
use crate::clip::options::model;
use crate::frame::Plane;
use crate::frame::warp::{CHUNK, Footprints, RowPath};
use crate::labelling::BACKGROUND;

/// For each pixel of this frame, the value of a plane of another frame at the position to which the pixel moves, clamped to the frame.
pub(crate) fn carried(plane: &Plane, along: &LayeredMotion) -> Plane {
    let (width, height) = (plane.width(), plane.height());
    let mut carried = Plane::filled(width, height, 0.0);
    let (mut samples, mut at) = ([0.0; CHUNK], Footprints::new());
    let rows = carried.values_mut().chunks_exact_mut(width).zip(along.labels.chunks_exact(width));
    for (y, (row, labels)) in rows.enumerate() {
        let mut x = 0;
        // Pixels with the same motion lie side by side.
        for run in labels.chunk_by(|one, next| one == next) {
            let path = RowPath::new(&along.motions[usize::from(run[0])], x, y);
            for (chunk, values) in row[x..x + run.len()].chunks_mut(CHUNK).enumerate() {
                at.follow(&path, chunk * CHUNK, values.len(), width, height);
                at.sample(plane.values(), &mut samples);
                values.copy_from_slice(&samples[..values.len()]);
            }
            x += run.len();
        }
    }
    carried
}

/// The labels of the next frame if all pixels keep their motions; `flow` is a frame's motion to the previous frame.
pub(crate) fn continued_labels(flow: &LayeredMotion) -> Vec<u8> {
    let (width, height) = (flow.width, flow.labels.len() / flow.width);
    let mut labels = vec![BACKGROUND as u8; flow.labels.len()];
    for (number, motion) in (0u8..).zip(&flow.motions).skip(BACKGROUND + 1) {
        for (y, row) in labels.chunks_exact_mut(width).enumerate() {
            for (x, label) in row.iter_mut().enumerate() {
                let [u, v] = motion.flow(x as f64, y as f64);
                let (px, py) = (x as f64 + u + 0.5, y as f64 + v + 0.5);
                let inside = px >= 0.0 && py >= 0.0 && px < width as f64 && py < height as f64;
                if inside && flow.labels[py as usize * width + px as usize] == number {
                    *label = number;
                }
            }
        }
    }
    labels
}

/// For each pixel of this frame, the label of another frame at the position to which the pixel moves; `unknown` where that position is
/// outside, or the other frame's motion does not lead back, as where the pixel is occluded. `return_flow` is the other frame's motion to
/// this one, if it was measured.
pub(crate) fn carried_labels(
    labels: &[u8],
    along: &LayeredMotion,
    return_flow: Option<&LayeredMotion>,
    unknown: u8,
) -> Vec<u8> {
    let (width, height) = (along.width, labels.len() / along.width);
    let mut carried = Vec::with_capacity(labels.len());
    for y in 0..height {
        for x in 0..width {
            let comes_back = |&[qx, qy]: &[usize; 2]| {
                return_flow.is_none_or(|flow| {
                    let ([u, v], [r, s]) = (along.at(x, y), flow.at(qx, qy));
                    (u + r) * (u + r) + (v + s) * (v + s) < (2.0 * f64::from(model().same_motion)).powi(2)
                })
            };
            let place = along.destination(x, y).filter(comes_back);
            carried.push(place.map_or(unknown, |[qx, qy]| labels[qy * width + qx]));
        }
    }
    carried
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::AffineMotion;

    #[test]
    fn what_came_three_pixels_goes_on_three_pixels() {
        let (width, height) = (20, 10);
        let square = |left: usize| -> Vec<u8> {
            let inside = |p: usize| (left..left + 4).contains(&(p % width)) && (2..6).contains(&(p / width));
            (0..width * height).map(|p| u8::from(inside(p))).collect()
        };
        // The motions lead back to the frame before.
        let motions = vec![AffineMotion::STATIC, AffineMotion::translation(-3.0, 0.0)];
        let flow = |left| LayeredMotion { width, labels: square(left), motions: motions.clone(), measured: true };
        assert_eq!(continued_labels(&flow(5))[..], square(8)[..]);
        // Pixels that leave the frame are gone.
        assert_eq!(continued_labels(&flow(14))[..], square(17)[..]);
    }
}
