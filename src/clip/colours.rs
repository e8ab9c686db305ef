//! Colours of objects and of the background, learned from neighbouring frames.

use crate::clip::options::model;
use crate::frame::Plane;
use crate::frame::palette::{COLOURS, Palette};
use crate::side::Side;

/// Numbers of pixels of each quantised colour, on objects and on the background.
#[derive(Clone, Debug)]
pub(crate) struct ColourCounts([Vec<f32>; 2]);

impl ColourCounts {
    pub(crate) fn none() -> ColourCounts {
        ColourCounts([(); 2].map(|()| vec![0.0; COLOURS]))
    }

    /// The counts of one frame. A pixel counts for the side that its log-odds of object against background favour; undecided pixels do not
    /// count.
    pub(crate) fn of(palette: &Palette, log_odds: &Plane) -> ColourCounts {
        let mut counts = ColourCounts::none();
        for (p, &log_odds) in
            log_odds.values().iter().enumerate().filter(|(_, log_odds)| log_odds.abs() > model().undecided)
        {
            counts.0[Side::favoured_by(log_odds)][palette.index(p)] += 1.0;
        }
        counts
    }

    pub(crate) fn add(&mut self, other: &ColourCounts) {
        let pairs = self.0.iter_mut().flatten().zip(other.0.iter().flatten());
        pairs.for_each(|(count, other)| *count += other);
    }

    /// Log-likelihood ratio of object against background for each colour, nats; all zero while either side has too few pixels.
    pub(crate) fn ratios(&self) -> Vec<f32> {
        let totals = self.0.each_ref().map(|side| side.iter().sum::<f32>());
        if totals.iter().any(|&total| total < model().pixels as f32) {
            return vec![0.0; COLOURS];
        }
        let share = |side: Side, colour: usize| (self.0[side][colour] + 1.0) / (totals[side] + COLOURS as f32);
        (0..COLOURS)
            .map(|colour| {
                libm::logf(share(Side::Object, colour) / share(Side::Ground, colour))
                    .clamp(-model().certain, model().certain)
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Frame;
    use crate::frame::scaling::Scaling;

    #[test]
    fn colours_of_one_side_speak_for_it_once_both_are_known() {
        let rgba: Vec<u8> =
            (0..64 * 48).flat_map(|p| if p % 64 < 20 { [250, 10, 10, 255] } else { [10, 10, 250, 255] }).collect();
        let palette = Palette::new(&Frame::from_rgba(64, 48, rgba).unwrap(), &Scaling::halved([64, 48], 0));
        let ratios = |log_odds: &dyn Fn(usize) -> f32| {
            ColourCounts::of(&palette, &Plane::from_fn(64, 48, |x, _| log_odds(x))).ratios()
        };
        let known = ratios(&|x| if x < 20 { 2.0 } else { -2.0 });
        assert!(known[palette.index(3)] > 3.0 && known[palette.index(40)] < -3.0);
        assert!(ratios(&|_| -2.0).iter().all(|&ratio| ratio == 0.0), "no object yet");
        assert!(ratios(&|x| if x < 20 { 0.1 } else { -2.0 }).iter().all(|&ratio| ratio == 0.0), "not sure enough");
    }
}
