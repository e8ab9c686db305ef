//! One shift of the whole object: where its pixels are found again, whatever the pairs know of its motion.

use super::constants::Constants;
use crate::clip::evidence::Flow;
use crate::frame::Plane;

/// Pixels of the object that are compared.
const COMPARED: usize = 150;
/// How far around the median of the flow, coarse pixels.
const SEARCH: isize = 12;
/// Squared colour difference beyond which it does not matter.
const TRUNCATION: f32 = 600.0;
/// What a pixel outside costs, as a share of that.
const OUTSIDE: f32 = 0.7;
/// Coarse pixels are so many of the working size.
const COARSE: usize = 4;
/// Pixels of an object below which it is not searched.
const FEWEST: usize = 80;

/// A shift of an object, pixels of the working size.
pub(super) type Shift = [f32; 2];

/// The median displacement of an object's pixels, if there are enough of them.
pub(super) fn middle(mask: &Plane, flow: &Flow) -> Option<Shift> {
    let inside: Vec<usize> = (0..mask.values().len()).filter(|&p| mask.values()[p] > 0.5).collect();
    if inside.len() < FEWEST {
        return None;
    }
    let flows: Vec<[f64; 2]> = inside.iter().map(|&p| flow.at(p % mask.width(), p / mask.width())).collect();
    Some([0, 1].map(|k| {
        let mut along: Vec<f64> = flows.iter().map(|flow| flow[k]).collect();
        along.sort_unstable_by(f64::total_cmp);
        along[along.len() / 2] as f32
    }))
}

/// The shift near the expected one by which the object's pixels are found again, with what it costs a pixel, 0…1.
pub(super) fn shift_of(mask: &Plane, before: &[Plane; 3], here: &[Plane; 3], expected: Shift, constants: &Constants) -> (Shift, f32) {
    let middle = expected.map(|shift| libm::roundf(shift / COARSE as f32) as isize);
    let (width, height) = (before[0].width(), before[0].height());
    let coarse: Vec<usize> = (0..width * height)
        .filter(|&p| {
            let (x, y) = (p % width * COARSE, p / width * COARSE);
            x < mask.width() && y < mask.height() && mask.at(x, y) > 0.5
        })
        .collect();
    let step = (coarse.len() / COMPARED).max(1);
    let chosen: Vec<usize> = coarse.into_iter().step_by(step).collect();
    let mut best = (f32::INFINITY, middle, f32::INFINITY);
    for dy in -SEARCH..=SEARCH {
        for dx in -SEARCH..=SEARCH {
            let [sx, sy] = [middle[0] + dx, middle[1] + dy];
            let mut sum = 0.0;
            for &p in &chosen {
                let (x, y) = ((p % width) as isize + sx, (p / width) as isize + sy);
                if x < 0 || y < 0 || x >= width as isize || y >= height as isize {
                    sum += OUTSIDE * TRUNCATION;
                    continue;
                }
                let q = y as usize * width + x as usize;
                let squares = before.iter().zip(here).map(|(before, here)| {
                    let step = before.values()[p] - here.values()[q];
                    step * step
                });
                sum += squares.sum::<f32>().min(TRUNCATION);
            }
            let far = libm::sqrtf((dx * dx + dy * dy) as f32) * COARSE as f32;
            let misfit = sum / chosen.len().max(1) as f32;
            let cost = misfit + constants.shift * far;
            if cost < best.0 {
                best = (cost, [sx, sy], misfit / TRUNCATION);
            }
        }
    }
    (best.1.map(|shift| (shift * COARSE as isize) as f32), best.2)
}
