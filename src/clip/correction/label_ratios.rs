//! For each label found automatically, the log-likelihood ratio of the object against the ground near it, learned from the frames so far.

use crate::clip::options::model;
use crate::frame::Plane;
use crate::frame::area::Area;
use crate::side::Side;

/// Counts of each label among the object's pixels and among the ground near it, and their log-likelihood ratios.
#[derive(Clone, Debug)]
pub(super) struct LabelRatios {
    counts: Vec<[f32; 2]>,
    ratios: Vec<f32>,
}

impl Default for LabelRatios {
    fn default() -> LabelRatios {
        LabelRatios { counts: vec![[0.0; 2]; 256], ratios: vec![0.0; 256] }
    }
}

impl LabelRatios {
    /// The ratios of one frame, given the side of each pixel, `None` if it is not counted.
    pub(super) fn of(found: &[u8], sides: &[Option<Side>], area: &Area, width: usize) -> LabelRatios {
        let mut ratios = LabelRatios::default();
        ratios.count([0.0, 1.0], found, area, width, &|p| sides[p]);
        ratios
    }

    /// Log-likelihood ratio of object against ground for a label, nats.
    pub(super) fn ratio(&self, found: u8) -> f32 {
        self.ratios[usize::from(found)]
    }

    /// Learns from a frame. If it `begins`, earlier counts are discarded.
    pub(super) fn learn(&mut self, found: &[u8], mask: &Plane, begins: bool) {
        let (width, height) = (mask.width(), mask.height());
        let inside: Vec<usize> = (0..found.len()).filter(|&p| mask.values()[p] > 0.5).collect();
        if inside.is_empty() {
            return;
        }
        let area = Area::of(&inside, width).grown(model().margin, width, height);
        let side = |p: usize| Some(Side::object_if(mask.values()[p] >= 0.5));
        let shares = if begins { [0.0, 1.0] } else { [model().memory_decay, 1.0 - model().memory_decay] };
        self.count(shares, found, &area, width, &side);
    }

    /// Replaces the counts by the sum of the earlier ones and those of a frame, weighted by `[old, new]`.
    fn count(
        &mut self,
        [old, new]: [f32; 2],
        found: &[u8],
        area: &Area,
        width: usize,
        side: &dyn Fn(usize) -> Option<Side>,
    ) {
        let mut counts = vec![[0.0f32; 2]; 256];
        for p in area.pixels(width) {
            if let Some(side) = side(p) {
                counts[usize::from(found[p])][side] += 1.0;
            }
        }
        let mut totals = [0.0f32; 2];
        for (count, now) in self.counts.iter_mut().zip(&counts) {
            for side in Side::BOTH {
                count[side] = old * count[side] + new * now[side];
                totals[side] += count[side];
            }
        }
        let share = |count: f32, total: f32| {
            (count + model().doubt * total + 1.0) / ((1.0 + 2.0 * model().doubt) * total + 2.0)
        };
        let share = |count: &[f32; 2], side: Side| share(count[side], totals[side]);
        for (ratio, count) in self.ratios.iter_mut().zip(&self.counts) {
            *ratio = libm::logf(share(count, Side::Object) / share(count, Side::Ground))
                .clamp(-model().labels, model().labels);
        }
    }
}
