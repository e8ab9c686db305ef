//! Where the camera looks.

use std::f64::consts::PI;

use super::super::warp::Warp;

/// A camera that pans and zooms smoothly; it shows the world as it is in the middle of the shot.
pub(super) struct Camera {
    /// Middle of the frame, pixels.
    pub(super) centre: [f64; 2],
    /// How far the background moves in a frame, on the average, pixels.
    pub(super) pan: [f64; 2],
    /// Growth of the background in a frame, logarithmic.
    pub(super) zoom: f64,
    /// Number of moments.
    pub(super) moments: usize,
}

/// A uniform movement whose speed swings by the share `swing` over the shot, fastest in the middle: the way at `time` from there.
pub(super) fn swung(time: f64, moments: usize, swing: f64) -> f64 {
    let turn = 2.0 * PI / moments as f64;
    time + swing / turn * libm::sin(turn * time)
}

impl Camera {
    /// Time from the middle of the shot, frames.
    pub(super) fn time(&self, moment: f64) -> f64 {
        moment - 0.5 * (self.moments as f64 - 1.0)
    }

    /// From the world to the frame.
    pub(super) fn at(&self, moment: f64) -> Warp {
        let time = self.time(moment);
        let scale = libm::exp(self.zoom * time);
        let way = swung(time, self.moments, 0.3);
        let [x, y] = [0, 1].map(|k| self.centre[k] * (1.0 - scale) + self.pan[k] * way);
        Warp([scale, 0.0, x, 0.0, scale, y])
    }

    /// The part of the world that is in sight at any time, with a margin: its least and its largest coordinates, whole numbers.
    pub(super) fn bounds(&self, size: [usize; 2]) -> [[f64; 2]; 2] {
        const MARGIN: f64 = 4.0;
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for moment in 0..self.moments {
            let world = self.at(moment as f64).inverse();
            for corner in [world.at(0.0, 0.0), world.at(size[0] as f64, size[1] as f64)] {
                for k in 0..2 {
                    low[k] = f64::min(low[k], (corner[k] - MARGIN).floor());
                    high[k] = f64::max(high[k], (corner[k] + MARGIN).ceil());
                }
            }
        }
        [low, high]
    }
}
