//! Objects that part were two from the start: their pixels are followed back through the frames in which they had one number.

use super::pairs::LayeredMotion;
use crate::clip::options::model;
use crate::components::absorb_small;

/// Divides the pixels with the number `from` in a frame between `from` and `new`, by their numbers in the next frame, `later`, to which
/// `onward` leads. Returns whether enough pixels of `new` were found.
pub(super) fn divide(labels: &mut [u8], later: &[u8], onward: &LayeredMotion, from: u8, new: u8) -> bool {
    let width = onward.width;
    let mut carried: Vec<u8> = labels.iter().map(|&label| u8::from(label == from)).collect();
    for (p, here) in carried.iter_mut().enumerate().filter(|(_, here)| **here > 0) {
        if let Some([x, y]) = onward.destination(p % width, p / width)
            && later[y * width + x] == new
        {
            *here = 2;
        }
    }
    let count = |labels: &[u8], number: u8| labels.iter().filter(|&&label| label == number).count();
    let (found, expected) = (count(&carried, 2), count(later, new));
    if (found as f64) < 0.5 * expected as f64 {
        return false;
    }
    absorb_small(&mut carried, width, (f64::from(model().sliver) * found as f64) as usize);
    labels
        .iter_mut()
        .zip(&carried)
        .filter(|(label, here)| **label == from && **here == 2)
        .for_each(|(label, _)| *label = new);
    true
}
