//! Full-size values at a smaller size.

use super::features::FrameFeatures;

/// Full-size values at the size of features: at the centre of each pixel, or anywhere in it.
pub(super) fn at_features<T: Copy + PartialEq>(
    values: &[T],
    nothing: T,
    full_width: usize,
    features: &FrameFeatures,
) -> Vec<T> {
    at_working_size(values, nothing, full_width, features.size, features.step)
}

/// Full-size values at a working size with so many pixels for each.
#[inline(never)]
pub(super) fn at_working_size<T: Copy + PartialEq>(
    values: &[T],
    nothing: T,
    full_width: usize,
    [width, height]: [usize; 2],
    step: usize,
) -> Vec<T> {
    let mut working = vec![nothing; width * height];
    for (p, &value) in values.iter().enumerate().filter(|(_, value)| **value != nothing) {
        let (x, y) = (p % full_width, p / full_width);
        let here = &mut working[(y / step).min(height - 1) * width + (x / step).min(width - 1)];
        if *here == nothing || (x % step, y % step) == (step / 2, step / 2) {
            *here = value;
        }
    }
    working
}
