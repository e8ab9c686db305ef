//! The smoothness term: the penalty of a border between two labels, lower along the edges of the image.

use crate::frame::Plane;
use crate::frame::area::Area;
use crate::frame::picture::Picture;
use crate::frame::warp::CHUNK;
use crate::labelling::solver::potts::Potts;
use crate::labelling::solver::{Solver, minimise};
use crate::lanes::whole;
use crate::model::Model;

/// The penalties of different labels at neighbouring pixels.
#[derive(Clone, Debug)]
pub(crate) struct EdgeWeights {
    horizontal: Plane,
    vertical: Plane,
}

impl EdgeWeights {
    /// The penalties with a weight λ, lower along the edges of a picture with the given noise, grey levels.
    pub(crate) fn new(picture: &Picture, noise: f32, smoothness: f32, model: &Model) -> EdgeWeights {
        let (width, height) = (picture.luminance.width(), picture.luminance.height());
        let penalty = BorderPenalty::new(noise, smoothness, model);
        let mut borders = Self::uniform(width, height, smoothness);
        for y in 0..height {
            let (start, below) = (y * width, (y + 1).min(height - 1) * width);
            let here = picture.run(start..start + width);
            penalty.write(here, picture.run(below..below + width), borders.vertical.row_mut(y));
            penalty.write(here, picture.run(start + 1..start + width), borders.horizontal.row_mut(y));
        }
        borders
    }

    /// The same penalties, multiplied by a factor.
    pub(crate) fn times(&self, factor: f32) -> EdgeWeights {
        let mut borders = self.clone();
        let planes = [&mut borders.horizontal, &mut borders.vertical];
        planes.into_iter().flat_map(|plane| plane.values_mut()).for_each(|penalty| *penalty *= factor);
        borders
    }

    /// The penalties within an area, multiplied by a factor.
    pub(crate) fn cropped(&self, area: &Area, factor: f32) -> EdgeWeights {
        let [horizontal, vertical] = [&self.horizontal, &self.vertical].map(|plane| {
            let (left, top) = (area.columns.start, area.rows.start);
            Plane::from_fn(area.width(), area.height(), |x, y| factor * plane.at(left + x, top + y))
        });
        EdgeWeights { horizontal, vertical }
    }

    /// The same penalty everywhere.
    pub(crate) fn uniform(width: usize, height: usize, smoothness: f32) -> EdgeWeights {
        let everywhere = Plane::filled(width, height, smoothness);
        EdgeWeights { horizontal: everywhere.clone(), vertical: everywhere }
    }

    /// The labels of least energy found.
    pub(crate) fn solve(&self, costs: &[Plane], solver: Solver) -> Vec<u8> {
        minimise(&Potts { costs, horizontal: &self.horizontal, vertical: &self.vertical }, solver)
    }
}

/// The penalty of a border as a function of the intensity step across it.
struct BorderPenalty {
    smoothness: f32,
    /// Reciprocal of the step, grey levels, at which 1 − 1/e of the discount of an edge is reached.
    per_step: f32,
    edge_share: f32,
    colour_share: f32,
}

impl BorderPenalty {
    fn new(noise: f32, smoothness: f32, model: &Model) -> BorderPenalty {
        let per_step = 1.0 / (model.noise_steps * noise.max(1.0));
        // A grey step is √3 times as long in RGB.
        BorderPenalty { smoothness, per_step, edge_share: model.edge_share, colour_share: 1.0 / 3.0f32.sqrt() }
    }

    /// Penalties between the pixels of two runs; ends with the shorter one.
    fn write<'a>(&self, one: [&'a [f32]; 4], other: [&'a [f32]; 4], penalties: &mut [f32]) {
        let BorderPenalty { edge_share, colour_share, .. } = *self;
        for (k, penalties) in penalties.chunks_mut(CHUNK).enumerate() {
            let mut space = [[0.0; CHUNK]; 8];
            let [s0, s1, s2, s3, s4, s5, s6, s7] = &mut space;
            let part = |run: [&'a [f32]; 4], c: usize| &run[c][(k * CHUNK).min(run[c].len())..];
            let (a, red) = (whole(part(one, 0), s0), whole(part(one, 1), s1));
            let (green, blue) = (whole(part(one, 2), s2), whole(part(one, 3), s3));
            let (b, r) = (whole(part(other, 0), s4), whole(part(other, 1), s5));
            let (g, l) = (whole(part(other, 2), s6), whole(part(other, 3), s7));
            let mut chunk = [0.0; CHUNK];
            for k in 0..CHUNK {
                let (dr, dg, db) = (red[k] - r[k], green[k] - g[k], blue[k] - l[k]);
                let (grey, colour) = ((a[k] - b[k]).abs(), colour_share * (dr * dr + dg * dg + db * db).sqrt());
                let step = if colour > grey { colour } else { grey };
                chunk[k] = self.smoothness * (edge_share + (1.0 - edge_share) * fading(step * self.per_step));
            }
            penalties.copy_from_slice(&chunk[..penalties.len()]);
        }
    }
}

/// exp(−z) for z ≥ 0, as the sixteenth power of an approximate 1/exp(z/16): within 0.3 % up to z = 4, within 0.001 beyond.
#[inline(always)]
fn fading(z: f32) -> f32 {
    let t = z / 16.0; // exp(t) by its series up to t³/6
    // As above.
    let f = 1.0 / (1.0 + t * (1.0 + t * (0.5 + t * (1.0 / 6.0))));
    let f = f * f;
    let f = f * f;
    let f = f * f;
    f * f
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labelling::options::LabellingOptions;

    #[test]
    fn borders_are_cheap_along_edges_and_expensive_elsewhere() {
        let grey = Plane::filled(64, 48, 100.0);
        let step = |small: f32, large: f32| Plane::from_fn(64, 48, |x, _| if x < 32 { small } else { large });
        let bright = Picture { luminance: step(60.0, 160.0), colours: [0; 3].map(|_| step(60.0, 160.0)) };
        let coloured =
            Picture { luminance: grey.clone(), colours: [step(40.0, 140.0), step(140.0, 76.0), grey.clone()] };
        let borders = EdgeWeights::new(&bright, 1.0, LabellingOptions::OF_TESTS.smoothness, &Model::DEFAULT);
        for borders in
            [&borders, &EdgeWeights::new(&coloured, 1.0, LabellingOptions::OF_TESTS.smoothness, &Model::DEFAULT)]
        {
            assert_eq!(borders.horizontal.at(10, 10), LabellingOptions::OF_TESTS.smoothness);
            assert!(
                borders.horizontal.at(31, 10)
                    < (Model::DEFAULT.edge_share + 0.01) * LabellingOptions::OF_TESTS.smoothness
            );
        }
        // The costs locate the border only to within four pixels; the edge decides where exactly.
        let costs = [
            Plane::from_fn(64, 48, |x, _| if x >= 34 { 1.0 } else { 0.0 }),
            Plane::from_fn(64, 48, |x, _| if x < 30 { 1.0 } else { 0.0 }),
        ];
        let labels = borders.solve(&costs, Solver::BEST);
        assert!((0..64 * 48).all(|p| usize::from(labels[p]) == usize::from(p % 64 >= 32)));
    }
}
