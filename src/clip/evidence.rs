//! What a pair tells about the pixels of its first frame: the odds that each belongs to an object, and where each goes.

use crate::frame::Plane;
use crate::labelling::regions::description::counts;
use crate::motion::AffineMotion;
use crate::order::descending;
use crate::pair::solution::Solution;
use crate::view::cost::inverse;
use crate::workspace::Buffer;

/// Odds beyond ±4 nats, probabilities of .018 and .982, are no more certain than that: a pair's mistakes are not. Not varied.
const MOST_ODDS: f32 = 4.0;
/// Probability added to both sides of the odds.
const PRIOR: f32 = 0.01;

/// The motion of every pixel of a frame to another frame. The first motion is that of the background.
#[derive(Clone, Debug)]
pub(crate) struct Flow {
    /// Width of the frame, working pixels.
    pub(crate) width: usize,
    /// The motion of every working pixel, an index to `motions`.
    pub(crate) labels: Buffer<u8>,
    /// Motions, pixels of the working size.
    pub(crate) motions: Vec<AffineMotion>,
    /// Whether the frames were compared; else everything is taken to keep its motion.
    pub(crate) measured: bool,
}

impl Flow {
    /// Displacement of the pixel (x, y).
    #[inline(always)]
    pub(crate) fn at(&self, x: usize, y: usize) -> [f64; 2] {
        self.motions[usize::from(self.labels[y * self.width + x])].flow(x as f64, y as f64)
    }

    /// Where the pixels go if they keep the motions with which they came.
    pub(crate) fn continued(&self) -> Flow {
        let motions = self.motions.iter().map(|motion| inverse(motion).unwrap_or(AffineMotion::STATIC)).collect();
        Flow { motions, measured: false, ..self.clone() }
    }
}

/// Log-odds of object against background at every working pixel, nats. The largest group of the solution is the background.
pub(crate) fn odds(solution: &Solution) -> Plane {
    let Solution { labels, probabilities, groups, .. } = solution;
    let sizes = counts(labels, groups.len());
    let total = |group: usize| (0..groups.len()).filter(|&k| groups[k] == group).map(|k| sizes[k]).sum::<usize>();
    let largest = groups[descending((0..groups.len()).map(|k| total(groups[k]) as f64))[0]];
    let (width, height) = (probabilities[0].width(), probabilities[0].height());
    let [mut odds, mut ground] = [0, 1].map(|_| Plane::filled(width, height, PRIOR));
    for (probability, group) in probabilities.iter().zip(groups) {
        let sum = if *group == largest { &mut ground } else { &mut odds };
        sum.values_mut().iter_mut().zip(probability.values()).for_each(|(s, p)| *s += p);
    }
    for (odds, ground) in odds.values_mut().iter_mut().zip(ground.values()) {
        *odds = libm::logf(*odds / ground).clamp(-MOST_ODDS, MOST_ODDS);
    }
    odds
}

/// The flow of a solution.
pub(crate) fn flow(solution: Solution) -> Flow {
    let Solution { labels, motions, probabilities, .. } = solution;
    Flow { width: probabilities[0].width(), labels, motions, measured: true }
}
