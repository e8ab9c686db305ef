//! The mask that an object proposes for a frame, and its log-odds.

use super::features::FrameFeatures;
use crate::clip::annotation::Seed;
use crate::clip::options::model;
use crate::frame::Plane;
use crate::frame::area::Area;
use crate::labelling::solver::Solver;

/// Log-odds of a seed, nats: more than all edges of a pixel can outweigh.
pub(super) const CERTAIN: f32 = 99.0;

/// Where an object may be in a frame, with its log-odds and mask.
#[derive(Clone, Debug)]
pub(super) struct Proposal {
    pub(super) area: Area,
    /// Log-odds of the object against everything else at the pixels of the area, nats.
    pub(super) log_odds: Vec<f32>,
    /// For each pixel of the area, 1 inside the object, 0 outside.
    pub(super) mask: Vec<u8>,
    /// Where the mask may be expected to change.
    pub(super) signs: Signs,
}

/// What supports a change of the object's mask, at the pixels of the frame's features.
#[derive(Clone, Debug, Default)]
pub(super) struct Signs {
    /// Log-odds of the object by its appearance, and by the traced mask that a person has given, nats.
    pub(super) looks: Patch,
    /// Share of each pixel that annotations have changed, propagated from the previous frame, 0…1; `None` if they are about all of the
    /// object.
    pub(super) change: Option<Patch>,
}

/// Values of pixels: some in a rectangle, and 0 elsewhere. Proposals that wait for the backward pass take little memory so.
#[derive(Clone, Debug, Default)]
pub(super) struct Patch {
    area: Area,
    /// Width of the grid of pixels.
    width: usize,
    values: Vec<f32>,
}

impl Proposal {
    /// The mask of least energy. Seeds are hard constraints.
    pub(super) fn solved(features: &FrameFeatures, area: Area, log_odds: Vec<f32>, seeds: Option<&[Seed]>) -> Proposal {
        let Some(seeds) = seeds else {
            let mask = cut(features, &area, &log_odds);
            return Proposal { area, log_odds, mask, signs: Signs::default() };
        };
        let log_odds: Vec<f32> = (0..features.pixels())
            .map(|p| match seeds[p] {
                Seed::Nothing => log_odds_at(&area, &log_odds, p, features.size[0]),
                Seed::Other | Seed::Dropped => -CERTAIN,
                Seed::Object => CERTAIN,
            })
            .collect();
        let area = features.area();
        let mask = if seeds.contains(&Seed::Nothing) {
            cut(features, &area, &log_odds)
        } else {
            log_odds.iter().map(|&z| u8::from(z > 0.0)).collect()
        };
        Proposal { area, log_odds, mask, signs: Signs::default() }
    }

    /// The weighted mean of the log-odds of two proposals, and its mask.
    pub(super) fn joined(features: &FrameFeatures, proposals: [&Proposal; 2], weights: [f32; 2]) -> Proposal {
        let (area, width) = (proposals[0].area.with(&proposals[1].area), features.size[0]);
        let mean = |of: [f32; 2]| (of[0] * weights[0] + of[1] * weights[1]) / (weights[0] + weights[1]);
        let log_odds: Vec<f32> =
            area.pixels(width).map(|p| mean(proposals.map(|of| of.log_odds_at(p, width)))).collect();
        let both = |of: [&Patch; 2], joined: &dyn Fn([f32; 2]) -> f32| {
            let area = match of.map(|of| of.values.is_empty()) {
                [true, _] => of[1].area.clone(),
                [_, true] => of[0].area.clone(),
                _ => of[0].area.with(&of[1].area),
            };
            let values = of.map(|of| of.values(features.pixels()));
            Patch { values: area.pixels(width).map(|p| joined([values[0][p], values[1][p]])).collect(), area, width }
        };
        let signs = Signs {
            looks: both(proposals.map(|of| &of.signs.looks), &mean),
            change: match proposals.map(|of| of.signs.change.as_ref()) {
                [Some(one), Some(other)] => Some(both([one, other], &|[one, other]| one.max(other))),
                _ => None,
            },
        };
        let mask = cut(features, &area, &log_odds);
        Proposal { area, log_odds, mask, signs }
    }

    /// The mask in the whole frame.
    pub(super) fn inside(&self, features: &FrameFeatures) -> Vec<u8> {
        let mut mask = vec![0; features.pixels()];
        self.area.pixels(features.size[0]).zip(&self.mask).for_each(|(p, &inside)| mask[p] = inside);
        mask
    }

    /// The mask in the whole frame as a plane.
    pub(super) fn plane(&self, features: &FrameFeatures) -> Plane {
        let mask = self.inside(features);
        features.plane(&|p| mask[p] > 0)
    }

    /// Log-odds at a pixel.
    pub(super) fn log_odds_at(&self, p: usize, width: usize) -> f32 {
        log_odds_at(&self.area, &self.log_odds, p, width)
    }
}

impl Patch {
    /// The values of a rectangle of a grid that is `width` wide.
    pub(super) fn new(area: Area, width: usize, values: Vec<f32>) -> Patch {
        Patch { area, width, values }
    }

    /// The smallest patch of values.
    pub(super) fn of(values: &[f32], width: usize) -> Patch {
        let set: Vec<usize> = (0..values.len()).filter(|&p| values[p] != 0.0).collect();
        let area = Area::of(&set, width);
        Patch { values: area.pixels(width).map(|p| values[p]).collect(), area, width }
    }

    /// The values of all pixels.
    pub(super) fn values(&self, pixels: usize) -> Vec<f32> {
        let mut values = vec![0.0; pixels];
        self.area.pixels(self.width).zip(&self.values).for_each(|(p, &value)| values[p] = value);
        values
    }
}

/// Log-odds at any pixel, nats; a negative constant outside the area.
pub(super) fn log_odds_at(area: &Area, log_odds: &[f32], p: usize, width: usize) -> f32 {
    let inside = area.columns.contains(&(p % width)) && area.rows.contains(&(p / width));
    if inside { log_odds[area.index_of(p, width)] } else { -2.0 * model().certain }
}

/// The mask of least energy: 1 inside.
pub(super) fn cut(features: &FrameFeatures, area: &Area, log_odds: &[f32]) -> Vec<u8> {
    let (width, height) = (area.width(), area.height());
    let edge_weights = features.edge_weights.cropped(area, model().smoothness);
    let object = Plane::from_vec(width, height, log_odds.iter().map(|&z| -z).collect());
    edge_weights.solve(&[Plane::filled(width, height, 0.0), object], Solver::FAST)
}

/// Centre of a mask, weighted by its values: column and row; `None` if it is empty.
pub(super) fn centre_of(mask: &Plane) -> Option<[f32; 2]> {
    let mut moments = [0.0f64; 3];
    for y in 0..mask.height() {
        for (x, &share) in mask.row(y).iter().enumerate() {
            let share = f64::from(share);
            moments = [moments[0] + share, moments[1] + share * x as f64, moments[2] + share * y as f64];
        }
    }
    (moments[0] > 0.0).then(|| [1, 2].map(|k| (moments[k] / moments[0]) as f32))
}

/// Log-odds of a probability, nats.
pub(super) fn logit(p: f32) -> f32 {
    libm::logf((p + model().doubt) / (1.0 - p + model().doubt))
}
