//! What the labels that were found automatically say of an object, as far as they agreed with it so far.

use crate::frame::Plane;

/// Share of the counts that is left after a frame.
const DECAY: f32 = 0.9;
/// Share that a label can have at least.
const FLOOR: f32 = 0.05;
/// Largest ratio, nats.
const MOST: f32 = 2.0;
/// Ground around the object that counts, pixels.
const AROUND: usize = 50;

/// How many of the object's pixels, and of the ground near it, had each label.
#[derive(Clone, Debug)]
pub(super) struct Evidence {
    counts: Vec<[f32; 2]>,
    ratios: Vec<f32>,
}

impl Default for Evidence {
    fn default() -> Evidence {
        Evidence { counts: vec![[0.0; 2]; 256], ratios: vec![0.0; 256] }
    }
}

impl Evidence {
    /// Log-likelihood ratio of the object for a label.
    pub(super) fn ratio(&self, found: u8) -> f32 {
        self.ratios[usize::from(found)]
    }

    /// Takes a frame.
    pub(super) fn learn(&mut self, found: &[u8], mask: &Plane, begins: bool, own: Option<u8>) {
        let inside: Vec<usize> = (0..found.len()).filter(|&p| mask.values()[p] > 0.5).collect();
        if inside.is_empty() {
            return;
        }
        let area = crate::frame::area::Area::of(&inside, mask.width()).grown(AROUND, mask.width(), mask.height());
        let mut counts = vec![[0.0f32; 2]; 256];
        for y in area.rows.clone() {
            for x in area.columns.clone() {
                let p = y * mask.width() + x;
                counts[kind(found[p])][usize::from(mask.values()[p] < 0.5)] += 1.0;
            }
        }
        let [mut old, mut new] = if begins { [0.0, 1.0] } else { [DECAY, 1.0 - DECAY] };
        if begins && let Some(own) = own {
            let t: f32 = std::env::var("OWN").map_or(0.0, |t| t.parse().unwrap());
            [old, new] = [t, 1.0 - t];
            let sum = |side: usize| counts.iter().map(|count| count[side]).sum::<f32>();
            let [object, ground] = [sum(0), sum(1)];
            self.counts = vec![[0.0; 2]; 256];
            self.counts[0] = [0.2 * object, 0.9 * ground];
            self.counts[usize::from(own)] = [0.8 * object, 0.1 * ground];
        }
        let mut totals = [0.0f32; 2];
        for (count, now) in self.counts.iter_mut().zip(&counts) {
            for side in 0..2 {
                count[side] = old * count[side] + new * now[side];
                totals[side] += count[side];
            }
        }
        let share = |count: f32, total: f32| (count + FLOOR * total + 1.0) / ((1.0 + 2.0 * FLOOR) * total + 2.0);
        self.ratios = self
            .counts
            .iter()
            .map(|[object, ground]| {
                libm::logf(share(*object, totals[0]) / share(*ground, totals[1])).clamp(-MOST, MOST)
            })
            .collect();
        if std::env::var("BINARY").is_ok() {
            let one = self.ratios[1];
            self.ratios[2..].fill(one);
        }
    }
}

fn kind(label: u8) -> usize {
    if std::env::var("BINARY").is_ok() { usize::from(label > 0) } else { usize::from(label) }
}
