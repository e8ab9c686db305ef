//! What the pairs of a frame with its neighbours tell about each of its pixels: the odds that it belongs to an object, and where it
//! comes from and goes to.

use crate::frame::Plane;
use crate::labelling::regions::description::counts;
use crate::motion::AffineMotion;
use crate::order::descending;
use crate::pair::solution::Solution;
use crate::workspace::Buffer;

/// Odds beyond ±4 nats, probabilities of .018 and .982, are no more certain than that: a pair's mistakes are not.
const MOST_ODDS: f32 = 4.0;
/// Probability added to both sides of the odds.
const PRIOR: f32 = 0.01;

/// One direction of a frame's evidence: to the next frame or to the one before.
#[derive(Clone, Debug)]
pub(crate) struct Evidence {
    /// Log-odds of object against background at every working pixel, nats.
    pub(crate) odds: Plane,
    /// The motion of every working pixel, an index to `motions`.
    pub(crate) labels: Buffer<u8>,
    /// Motions to the other frame, pixels of the working size.
    pub(crate) motions: Vec<AffineMotion>,
}

impl Evidence {
    /// The evidence of a solved pair. Its largest group is the background.
    pub(crate) fn new(solution: Solution) -> Evidence {
        let Solution { motions, labels, probabilities, groups, .. } = solution;
        let sizes = counts(&labels, motions.len());
        let total = |group: usize| (0..groups.len()).filter(|&k| groups[k] == group).map(|k| sizes[k]).sum::<usize>();
        let largest = descending((0..groups.len()).map(|k| total(groups[k]) as f64))[0];
        let background: Vec<bool> = groups.iter().map(|&g| g == groups[largest]).collect();
        let (width, height) = (probabilities[0].width(), probabilities[0].height());
        let [mut odds, mut ground] = [0, 1].map(|_| Plane::filled(width, height, PRIOR));
        for (probability, background) in probabilities.iter().zip(&background) {
            let sum = if *background { &mut ground } else { &mut odds };
            sum.values_mut().iter_mut().zip(probability.values()).for_each(|(s, p)| *s += p);
        }
        for (odds, ground) in odds.values_mut().iter_mut().zip(ground.values()) {
            *odds = libm::logf(*odds / ground).clamp(-MOST_ODDS, MOST_ODDS);
        }
        Evidence { odds, labels, motions }
    }
}
