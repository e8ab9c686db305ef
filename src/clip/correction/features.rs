//! The features of a frame that propagation uses: colours, colour cells and edge weights.

use crate::clip::options::model;
use crate::frame::area::Area;
use crate::frame::filter::{gaussian, halve};
use crate::frame::lab::lab;
use crate::frame::picture::{Picture, colours};
use crate::frame::scaling::Scaling;
use crate::frame::{Frame, Plane};
use crate::labelling::terms::smoothness::EdgeWeights;
use crate::model::Model;
use crate::view::cost::SMALLEST_NOISE;

/// Number of colour cells along L, and along a and b, of which only the middle half of the range is resolved.
pub(super) const LIGHTNESS: usize = 22;
pub(super) const CHROMA: usize = 24;
pub(super) const COLOURS: usize = LIGHTNESS * CHROMA * CHROMA;

/// The colour cell of a pixel.
fn colour_cell([l, a, b]: [f32; 3]) -> u16 {
    // The range begins at −64, shifted by half a cell: the first and the last cell are unbounded.
    let chroma = |value: f32| (((value - 64.0) / model().colour_step + 1.5).max(0.0) as usize).min(CHROMA - 1);
    let lightness = ((l / (2.0 * model().colour_step) + 0.5).max(0.0) as usize).min(LIGHTNESS - 1);
    ((lightness * CHROMA + chroma(a)) * CHROMA + chroma(b)) as u16
}

/// A frame at the working size of the propagation.
#[derive(Clone, Debug)]
pub(super) struct FrameFeatures {
    pub(super) size: [usize; 2],
    /// Between the full size and this one.
    pub(super) scaling: Scaling,
    /// Colour cell of every pixel.
    pub(super) colours: Vec<u16>,
    /// L, a and b, blurred.
    pub(super) fine: [Plane; 3],
    /// L, a and b at a quarter of the size.
    pub(super) coarse: [Plane; 3],
    /// Edge weights for a smoothness of 1.
    pub(super) edge_weights: EdgeWeights,
}

impl FrameFeatures {
    pub(super) fn new(frame: &Frame) -> FrameFeatures {
        let scaling = Scaling::within([frame.width(), frame.height()], Model::DEFAULT.work_side);
        let mut luminance = frame.luminance().clone();
        (0..scaling.halvings()).for_each(|_| luminance = halve(&luminance));
        let picture = Picture { colours: colours(frame, luminance.width()), luminance };
        let fine = lab(&picture.colours).each_ref().map(|plane| gaussian(plane, model().blur));
        let size = scaling.small;
        let colours =
            (0..size[0] * size[1]).map(|p| colour_cell(fine.each_ref().map(|plane| plane.values()[p]))).collect();
        let coarse = fine.each_ref().map(|plane| halve(&halve(plane)));
        let edge_weights = EdgeWeights::new(&picture, SMALLEST_NOISE, 1.0, &Model::DEFAULT);
        FrameFeatures { size, scaling, colours, fine, coarse, edge_weights }
    }
}

impl FrameFeatures {
    pub(super) fn pixels(&self) -> usize {
        self.colours.len()
    }

    pub(super) fn area(&self) -> Area {
        Area::whole(self.size[0], self.size[1])
    }

    pub(super) fn middle(&self) -> [f32; 2] {
        self.size.map(|side| 0.5 * side as f32)
    }

    /// A plane with a value for each pixel.
    pub(super) fn plane_of(&self, value: &dyn Fn(usize) -> f32) -> Plane {
        Plane::from_vec(self.size[0], self.size[1], (0..self.pixels()).map(value).collect())
    }

    /// A plane of 1 at the pixels inside, 0 elsewhere.
    pub(super) fn plane(&self, inside: &dyn Fn(usize) -> bool) -> Plane {
        self.plane_of(&|p| f32::from(u8::from(inside(p))))
    }
}

#[cfg(test)]
impl FrameFeatures {
    /// A frame with a colour for each pixel.
    pub(super) fn painted([width, height]: [usize; 2], colour: impl Fn(usize, usize) -> [u8; 3]) -> FrameFeatures {
        let rgba: Vec<u8> = (0..width * height)
            .flat_map(|p| {
                let [r, g, b] = colour(p % width, p / width);
                [r, g, b, 255]
            })
            .collect();
        FrameFeatures::new(&Frame::from_rgba(width, height, rgba).unwrap())
    }
}
