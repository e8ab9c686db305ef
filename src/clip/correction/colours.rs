//! Colours of labels, learned from the frames that a correction has reached.

use crate::frame::palette::{COLOURS, Palette};

/// Largest price of a colour, nats.
const MOST: f32 = 3.0;
/// Pixels of a label before its colours are known.
const FEWEST: f32 = 50.0;

/// How often each label has each colour.
#[derive(Clone, Debug, Default)]
pub(super) struct LabelColours(Vec<(u8, Vec<f32>)>);

impl LabelColours {
    /// Adds the pixels of a frame with their weights.
    pub(super) fn learn(&mut self, palette: &Palette, labels: &[u8], weight: impl Fn(usize) -> f32) {
        for (p, &label) in labels.iter().enumerate() {
            let weight = weight(p);
            if weight > 0.0 {
                self.of(label)[palette.index(p)] += weight;
            }
        }
    }

    fn of(&mut self, label: u8) -> &mut [f32] {
        let place = self.0.binary_search_by_key(&label, |(known, _)| *known).unwrap_or_else(|place| {
            self.0.insert(place, (label, vec![0.0; COLOURS]));
            place
        });
        &mut self.0[place].1
    }

    /// Price of every colour for each of some labels, nats: −log of the label's probability among them. Zero for a label whose colours are
    /// not known, and where no other's are.
    pub(super) fn prices(&self, labels: &[u8]) -> Vec<Vec<f32>> {
        let shares = |label: &u8| {
            let place = self.0.binary_search_by_key(label, |(known, _)| *known).ok()?;
            let counts = &self.0[place].1;
            let total: f32 = counts.iter().sum();
            let share = |count: &f32| (count + 1.0) / (total + COLOURS as f32);
            (total >= FEWEST).then(|| counts.iter().map(share).collect::<Vec<f32>>())
        };
        let shares: Vec<Option<Vec<f32>>> = labels.iter().map(shares).collect();
        let all: Vec<f32> = (0..COLOURS).map(|colour| shares.iter().flatten().map(|of| of[colour]).sum()).collect();
        let price = |own: &f32, all: &f32| (-libm::logf(own / all)).min(MOST);
        let of_label = |shares: &Option<Vec<f32>>| match shares {
            Some(own) => own.iter().zip(&all).map(|(own, all)| price(own, all)).collect(),
            None => vec![0.0; COLOURS],
        };
        shares.iter().map(of_label).collect()
    }
}
