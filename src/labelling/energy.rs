//! The labelling energy: the cost of each motion at each pixel, plus a smoothness weight for every border between labels that is lower
//! along image edges.

use std::ops::Range;

use super::potts::Potts;
use super::solver::{Solver, minimise};
use super::variance_inflation::{VarianceInflation, inflate_variance};
use super::views::{cheapest, costs_in_views};
use crate::alignment::cost::CostModel;
use crate::frame::Plane;
use crate::frame::area::Area;
use crate::frame::pyramid::Level;
use crate::frame::warp::CHUNK;
use crate::lanes::{each_with, lower, whole};
use crate::motion::AffineMotion;
use crate::workspace::Buffer;

/// The smoothness of labels, and how they are solved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coherence {
    /// λ: price of a border between two pixels of equal intensity, in costs.
    pub(crate) smoothness: f32,
    /// Price of every object pixel: it favours the dominant motion where the data cannot tell.
    pub(crate) object_bias: f32,
    /// Solver while motions are still added and removed.
    pub(crate) draft_solver: Solver,
    /// Solver of the final labels.
    pub(crate) solver: Solver,
    /// Solver that starts from the labels of a coarser level.
    pub(crate) sharpening: Solver,
}

/// Share of λ that remains at the strongest image edge.
const EDGE_SHARE: f32 = 0.02;
/// Intensity step at which the rest of λ has fallen to 1/e: at least this many grey levels …
const SMALLEST_STEP: f32 = 5.0;
/// … and at least this many noise deviations.
const NOISE_STEPS: f32 = 4.0;
/// Share of λ that an object pays for every pixel on the frame's border. Without it the part of an object's outline along the frame's
/// border would be free, and labels would leak into flat regions there.
const FRAME_BORDER: f32 = 0.375;

/// Weight of a step in RGB relative to one in luminance.
const COLOUR_SHARE: f32 = 0.6;

/// The unblurred first frame at working size: labels may change along its edges.
#[derive(Clone, Debug)]
pub(crate) struct Picture {
    pub(crate) luminance: Plane,
    /// Red, green, blue.
    pub(crate) colours: [Plane; 3],
}

impl Picture {
    /// Luminance, red, green and blue of a run of pixels.
    fn run(&self, pixels: Range<usize>) -> [&[f32]; 4] {
        let [red, green, blue] = &self.colours;
        [&self.luminance, red, green, blue].map(|plane| &plane.values()[pixels.clone()])
    }
}

/// Prices of borders between neighbours.
#[derive(Clone, Debug)]
pub(crate) struct Borders {
    horizontal: Plane,
    vertical: Plane,
}

impl Borders {
    pub(crate) fn new(picture: &Picture, noise: f32, coherence: Coherence) -> Borders {
        let (width, height) = (picture.luminance.width(), picture.luminance.height());
        let mut borders = Self::uniform(width, height, coherence);
        borders.follow(picture, noise, coherence, &Area::whole(width, height), [0, 0]);
        borders
    }

    /// Borders that cost the same everywhere.
    pub(crate) fn uniform(width: usize, height: usize, coherence: Coherence) -> Borders {
        let everywhere = Plane::filled(width, height, coherence.smoothness);
        Borders { horizontal: everywhere.clone(), vertical: everywhere }
    }

    /// Sets the prices of an area from the edges of the picture. The grid begins at the picture's pixel `corner`.
    pub(crate) fn follow(
        &mut self,
        picture: &Picture,
        noise: f32,
        coherence: Coherence,
        area: &Area,
        corner: [usize; 2],
    ) {
        let (width, height) = (picture.luminance.width(), picture.luminance.height());
        let price = Price { smoothness: coherence.smoothness, per_step: 1.0 / SMALLEST_STEP.max(NOISE_STEPS * noise) };
        let places = area.columns.start - corner[0]..area.columns.end - corner[0];
        for y in area.rows.clone() {
            let start = y * width;
            let here = picture.run(start + area.columns.start..start + area.columns.end);
            let below = (y + 1).min(height - 1) * width;
            let below = picture.run(below + area.columns.start..below + area.columns.end);
            price.write(here, below, &mut self.vertical.row_mut(y - corner[1])[places.clone()]);
            let right = picture.run(start + area.columns.start + 1..start + (area.columns.end + 1).min(width));
            price.write(here, right, &mut self.horizontal.row_mut(y - corner[1])[places.clone()]);
        }
    }

    /// The labels of least energy found, never worse than those given.
    pub(crate) fn solve_from(&self, costs: &[Plane], solver: Solver, labels: &[u8]) -> Buffer<u8> {
        minimise(&Potts { costs, horizontal: &self.horizontal, vertical: &self.vertical }, solver, Some(labels))
    }

    /// The labels of least energy found.
    pub(crate) fn solve(&self, costs: &[Plane], solver: Solver) -> Buffer<u8> {
        minimise(&Potts { costs, horizontal: &self.horizontal, vertical: &self.vertical }, solver, None)
    }
}

/// The price of a border as a function of the step across it.
struct Price {
    smoothness: f32,
    /// Reciprocal of the step, grey levels, at which 1 − 1/e of the discount of an edge is reached.
    per_step: f32,
}

impl Price {
    /// Prices between the pixels of two runs; ends with the shorter one.
    fn write<'a>(&self, one: [&'a [f32]; 4], other: [&'a [f32]; 4], prices: &mut [f32]) {
        for (k, prices) in prices.chunks_mut(CHUNK).enumerate() {
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
                let (grey, colour) = ((a[k] - b[k]).abs(), COLOUR_SHARE * (dr * dr + dg * dg + db * db).sqrt());
                let step = if colour > grey { colour } else { grey };
                chunk[k] = self.smoothness * (EDGE_SHARE + (1.0 - EDGE_SHARE) * fading(step * self.per_step));
            }
            prices.copy_from_slice(&chunk[..prices.len()]);
        }
    }
}

/// exp(−z) for z ≥ 0, as the sixteenth power of an approximate 1/exp(z/16): within 0.3 % up to z = 4, within 0.001 beyond.
#[inline(always)]
fn fading(z: f32) -> f32 {
    let t = z / 16.0;
    let f = 1.0 / (1.0 + t * (1.0 + t * (0.5 + t * (1.0 / 6.0))));
    let f = f * f;
    let f = f * f;
    let f = f * f;
    f * f
}

/// Label cost of every motion at every pixel; the first is the dominant motion.
///
/// A pixel that a motion moves out of the frame cannot be compared, so the motion costs there as much as the cheapest one that keeps
/// the pixel inside. This is at least the neutral cost for an object and at most the neutral cost for the dominant motion, so that
/// objects do not win pixels by moving them out of the frame.
pub(crate) fn label_costs(level: &Level, motions: &[AffineMotion], coherence: Coherence) -> Vec<Plane> {
    LabelCosts::new(level, motions, coherence).costs
}

/// Label costs, and the intermediate results that sharpening uses again.
pub(crate) struct LabelCosts {
    /// See [`label_costs`].
    pub(crate) costs: Vec<Plane>,
    /// Weight of the second frame in the costs, if there is a frame before.
    pub(crate) shares: Option<Plane>,
    pub(crate) variance_inflation: Plane,
}

impl LabelCosts {
    /// Computes them row by row, so that the only intermediate plane is that of the smallest costs.
    pub(crate) fn new(level: &Level, motions: &[AffineMotion], coherence: Coherence) -> LabelCosts {
        let (mut costs, shares) = costs_in_views(level, motions);
        let mut inflation_rows = VarianceInflation::new(cheapest(&costs, f32::INFINITY));
        let mut inflation = Plane::unwritten(level.width(), level.height());
        let mut seen = Buffer::unwritten(level.width());
        for y in 0..level.height() {
            inflation_rows.write(y, inflation.row_mut(y));
            seen.fill(f32::INFINITY);
            for cost in &mut costs {
                inflate_variance(cost.row_mut(y), inflation.row(y));
                lower(&mut seen, cost.row(y));
            }
            for (label, cost) in costs.iter_mut().enumerate() {
                to_label_costs(label, cost.row_mut(y), &seen, coherence);
            }
        }
        costs.iter_mut().skip(1).for_each(|cost| add_frame_border_price(cost, coherence));
        LabelCosts { costs, shares, variance_inflation: inflation }
    }
}

/// Turns costs of a motion into those of its label: fills in pixels moved out of the frame and adds the object bias. `seen` is the
/// smallest cost of any motion that keeps the pixel inside, infinite if there is none.
#[inline(never)]
pub(crate) fn to_label_costs(label: usize, costs: &mut [f32], seen: &[f32], coherence: Coherence) {
    let neutral = CostModel::LABELS.outside();
    let (least, most, object_bias) = match label {
        0 => (f32::NEG_INFINITY, neutral, 0.0),
        _ => (neutral, f32::INFINITY, coherence.object_bias),
    };
    each_with(costs, [seen], |cost, [seen]| {
        let unseen = if seen < most { seen } else { neutral };
        let unseen = if unseen > least { unseen } else { neutral };
        object_bias + if cost.is_finite() { cost } else { unseen }
    });
}

/// Price of an object's pixel on the frame's border, for each of the borders it lies on.
pub(crate) fn frame_border_price(coherence: Coherence) -> f32 {
    FRAME_BORDER * coherence.smoothness
}

fn add_frame_border_price(cost: &mut Plane, coherence: Coherence) {
    let price = frame_border_price(coherence);
    let (width, height) = (cost.width(), cost.height());
    for y in [0, height - 1] {
        cost.row_mut(y).iter_mut().for_each(|c| *c += price);
    }
    for y in 0..height {
        for x in [0, width - 1] {
            cost.row_mut(y)[x] += price;
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::frame::pyramid::build;

    pub(crate) const COHERENCE: Coherence = Coherence {
        smoothness: 8.0,
        object_bias: 0.05,
        draft_solver: Solver::FAST,
        solver: Solver::BEST,
        sharpening: Solver::FAST,
    };

    fn noise(seed: u64) -> Plane {
        let mut random = crate::random::Random::from_seed(seed);
        Plane::from_fn(64, 48, |_, _| random.uniform(0.0, 255.0) as f32)
    }

    #[test]
    fn leaving_the_frame_wins_an_object_nothing_and_costs_the_dominant_motion_nothing() {
        let (still, leaving) = (AffineMotion::STATIC, AffineMotion::translation(20.0, 0.0));
        let same = &build(noise(1), noise(1), None, 24)[0];
        let other = &build(noise(1), noise(2), None, 24)[0];
        for level in [same, other] {
            let object = label_costs(level, &[still, leaving], COHERENCE);
            let dominant = label_costs(level, &[leaving, still], COHERENCE);
            for y in 1..47 {
                for x in 45..63 {
                    assert!(object[1].at(x, y) >= object[0].at(x, y) + COHERENCE.object_bias, "({x}, {y})");
                    assert!(dominant[0].at(x, y) <= dominant[1].at(x, y), "({x}, {y})");
                }
            }
        }
        let nowhere = AffineMotion::translation(100.0, 0.0);
        let unseen = label_costs(same, &[nowhere, nowhere], COHERENCE);
        assert_eq!(unseen[0].at(30, 30), CostModel::LABELS.outside());
        assert!((unseen[1].at(30, 30) - unseen[0].at(30, 30) - COHERENCE.object_bias).abs() < 1e-6);
    }

    #[test]
    fn borders_are_cheap_along_edges_and_expensive_elsewhere() {
        let grey = Plane::filled(64, 48, 100.0);
        let step = |small: f32, large: f32| Plane::from_fn(64, 48, |x, _| if x < 32 { small } else { large });
        let bright = Picture { luminance: step(60.0, 160.0), colours: [0; 3].map(|_| step(60.0, 160.0)) };
        let coloured =
            Picture { luminance: grey.clone(), colours: [step(40.0, 140.0), step(140.0, 76.0), grey.clone()] };
        let borders = Borders::new(&bright, 1.0, COHERENCE);
        for borders in [&borders, &Borders::new(&coloured, 1.0, COHERENCE)] {
            assert_eq!(borders.horizontal.at(10, 10), COHERENCE.smoothness);
            assert!(borders.horizontal.at(31, 10) < 0.03 * COHERENCE.smoothness);
        }
        // The costs locate the border only to within four pixels; the edge decides where exactly.
        let costs = [
            Plane::from_fn(64, 48, |x, _| if x >= 34 { 1.0 } else { 0.0 }),
            Plane::from_fn(64, 48, |x, _| if x < 30 { 1.0 } else { 0.0 }),
        ];
        let labels = borders.solve(&costs, Solver::Expansion { sweeps: 1 });
        assert!((0..64 * 48).all(|p| usize::from(labels[p]) == usize::from(p % 64 >= 32)));
    }
}
