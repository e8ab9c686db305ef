//! Image derivatives as the paper takes them: "derivative filters in one dimension and smoothing filters in the other two"
//! (section 4), the dimensions being x, y and time.
//!
//! The filters are the matched pairs of Farid and Simoncelli (IEEE Trans. Image Processing 13(4), 2004): interpolator and
//! differentiator are designed together, so that all three derivatives see the image through the same smoothing and the
//! constraint `I_x u + I_y v + I_t = 0` (eq. 3) holds between them.

use super::{Frame, Plane};

/// Five taps in space: smoothing, derivative.
const SMOOTH: [f32; 5] = [0.037_659, 0.249_153, 0.426_375, 0.249_153, 0.037_659];
const DIFFERENCE: [f32; 5] = [-0.109_604, -0.276_691, 0.0, 0.276_691, 0.109_604];
/// Three frames in time: smoothing, derivative.
const SMOOTH_IN_TIME: [f32; 3] = [0.223_755, 0.552_490, 0.223_755];
const DIFFERENCE_IN_TIME: [f32; 3] = [-0.453_014, 0.0, 0.453_014];

/// The derivatives `y = (I_x, I_y, I_t)` of every pixel: per pixel to the right, per pixel down, per frame forwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivatives {
    /// I_x.
    pub x: Plane,
    /// I_y.
    pub y: Plane,
    /// I_t.
    pub t: Plane,
}

/// Derivatives of the frames' luminance scaled to [0, 1], the scale of the paper's threshold.
///
/// With `before` they are those at the time of `first`, from three frames; without it they are those half-way between `first` and `second`,
/// by averages and differences of the two. Borders are replicated. The frames should have the same size; what one has more than another is
/// not read.
pub fn derivatives(first: &Frame, second: &Frame, before: Option<&Frame>) -> Derivatives {
    let (smoothed, changed) = match before {
        Some(before) => {
            let planes = [before.luminance(), first.luminance(), second.luminance()];
            (weighted_sum(&planes, &SMOOTH_IN_TIME), weighted_sum(&planes, &DIFFERENCE_IN_TIME))
        }
        None => {
            let planes = [first.luminance(), second.luminance()];
            (weighted_sum(&planes, &[0.5, 0.5]), weighted_sum(&planes, &[-1.0, 1.0]))
        }
    };
    Derivatives {
        x: along_y(&along_x(&smoothed, &DIFFERENCE), &SMOOTH),
        y: along_y(&along_x(&smoothed, &SMOOTH), &DIFFERENCE),
        t: along_y(&along_x(&changed, &SMOOTH), &SMOOTH),
    }
}

/// The weighted sum of planes of grey levels, scaled to [0, 1].
fn weighted_sum(planes: &[&Plane], weights: &[f32]) -> Plane {
    let (width, height) =
        planes.iter().fold((usize::MAX, usize::MAX), |(w, h), p| (w.min(p.width()), h.min(p.height())));
    Plane::from_fn(width, height, |x, y| planes.iter().zip(weights).map(|(p, w)| w * p.at(x, y)).sum::<f32>() / 255.0)
}

fn along_x(plane: &Plane, taps: &[f32; 5]) -> Plane {
    let last = plane.width() - 1;
    Plane::from_fn(plane.width(), plane.height(), |x, y| {
        let row = plane.row(y);
        (0..5).map(|k| taps[k] * row[(x + k).saturating_sub(2).min(last)]).sum()
    })
}

fn along_y(plane: &Plane, taps: &[f32; 5]) -> Plane {
    let last = plane.height() - 1;
    Plane::from_fn(plane.width(), plane.height(), |x, y| {
        (0..5).map(|k| taps[k] * plane.at(x, (y + k).saturating_sub(2).min(last))).sum()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// I(x, y, t) = 100 + 2 (x − u t) − 3 (y − v t), grey.
    fn plane_wave(t: f64, u: f64, v: f64) -> Frame {
        let rgba: Vec<u8> = (0..32 * 24)
            .flat_map(|p| {
                let (x, y) = (f64::from(p % 32), f64::from(p / 32));
                let value = (100.0 + 2.0 * (x - u * t) - 3.0 * (y - v * t)) as u8;
                [value, value, value, 255]
            })
            .collect();
        Frame::from_rgba(32, 24, &rgba).unwrap()
    }

    #[test]
    fn a_moving_ramp_has_its_slope_and_fulfils_brightness_constancy() {
        let (u, v) = (2.0, 1.0);
        let frames = [plane_wave(-1.0, u, v), plane_wave(0.0, u, v), plane_wave(1.0, u, v)];
        for before in [None, Some(&frames[0])] {
            let d = derivatives(&frames[1], &frames[2], before);
            for (x, y) in [(2, 2), (15, 10), (29, 21)] {
                let (ix, iy, it) = (d.x.at(x, y) * 255.0, d.y.at(x, y) * 255.0, d.t.at(x, y) * 255.0);
                // The published taps have a gain within 1 % of one.
                assert!((ix - 2.0).abs() < 0.03 && (iy + 3.0).abs() < 0.04, "{ix} {iy}");
                assert!((ix * u as f32 + iy * v as f32 + it).abs() < 0.1, "{it}");
            }
        }
    }

    #[test]
    fn identical_frames_have_no_temporal_derivative() {
        let frame = plane_wave(0.0, 0.0, 0.0);
        for before in [None, Some(&frame)] {
            assert!(derivatives(&frame, &frame, before).t.values().iter().all(|&v| v.abs() < 1e-6));
        }
    }
}
