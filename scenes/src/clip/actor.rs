//! Those who act: objects, and what of the background hides them.

use super::super::shape::Shape;
use super::super::warp::Warp;
use super::path::Path;

/// Something that moves as a whole, with parts that may swing.
pub(super) struct Actor {
    /// Its label; 0 if it belongs to the background.
    pub(super) number: u8,
    /// From back to front; the last is the body.
    pub(super) parts: Vec<Part>,
    pub(super) path: Path,
    /// Radians per frame.
    pub(super) spin: f64,
    /// Logarithmic, per frame.
    pub(super) growth: f64,
}

/// A rigid part: it turns around a joint.
pub(super) struct Part {
    pub(super) shape: Shape,
    /// Where the body holds it, in the coordinates of the actor.
    pub(super) joint: [f64; 2],
    /// From the joint to the middle of the shape.
    pub(super) arm: [f64; 2],
    /// Amplitude, change per frame and start of the angle's phase, radians.
    pub(super) swing: [f64; 3],
}

impl Part {
    /// The body, or all there is of a rigid actor.
    pub(super) fn body(shape: Shape) -> Part {
        Part { shape, joint: [0.0; 2], arm: [0.0; 2], swing: [0.0; 3] }
    }

    fn at(&self, moment: f64) -> Warp {
        let [amplitude, rate, phase] = self.swing;
        let angle = amplitude * libm::sin(rate * moment + phase);
        Warp::similarity(self.joint, angle, 1.0).after(&Warp::similarity(self.arm, 0.0, 1.0))
    }
}

impl Actor {
    /// From each part to the world; `time` is that from the middle of the shot.
    pub(super) fn at(&self, moment: f64, time: f64) -> impl Iterator<Item = Warp> {
        let pose = Warp::similarity(self.path.at(moment), self.spin * time, libm::exp(self.growth * time));
        self.parts.iter().map(move |part| pose.after(&part.at(moment)))
    }
}
