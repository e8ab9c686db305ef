//! What a pair of frames shows about the pixels of its first frame: the log-odds that each belongs to an object, and its motion; and how
//! these are stored.

use super::runs::Runs;
use super::saved::saved;
use crate::clip::options::model;
use crate::frame::Plane;
use crate::frame::scaling::Scaling;
use crate::labelling::{BACKGROUND, is_background};
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::pair::frame_motions::{FrameMotions, Prior};

/// Log-odds are rounded to multiples of this many nats, so that they take little room.
const STEP: f32 = 0.25;

/// The motion of every pixel of a frame to another frame. The first motion is that of the background.
#[derive(Clone, Debug)]
pub(crate) struct LayeredMotion {
    /// Width of the frame, working pixels.
    pub(crate) width: usize,
    /// The motion of every working pixel, an index to `motions`.
    pub(crate) labels: Vec<u8>,
    /// Motions, pixels of the working size.
    pub(crate) motions: Vec<AffineMotion>,
    /// Whether the motion was measured between two frames; else it is an expectation.
    pub(crate) measured: bool,
}

impl LayeredMotion {
    /// The motion of a frame in which nothing moves.
    pub(crate) fn still([width, height]: [usize; 2]) -> LayeredMotion {
        let labels = vec![BACKGROUND as u8; width * height];
        LayeredMotion { width, labels, motions: vec![AffineMotion::STATIC], measured: false }
    }

    /// Index of the most frequent motion of some pixels, if there are any.
    pub(crate) fn most_frequent(&self, pixels: impl Iterator<Item = usize>) -> Option<usize> {
        let mut counts = vec![0usize; self.motions.len()];
        pixels.for_each(|p| counts[usize::from(self.labels[p])] += 1);
        (0..counts.len()).rev().max_by_key(|&k| counts[k]).filter(|&k| counts[k] > 0)
    }

    /// Displacement of the pixel (x, y), pixels.
    #[inline(always)]
    pub(crate) fn at(&self, x: usize, y: usize) -> [f64; 2] {
        self.motions[usize::from(self.labels[y * self.width + x])].flow(x as f64, y as f64)
    }

    /// The pixel of the other frame to which (x, y) moves, if it is inside.
    pub(crate) fn destination(&self, x: usize, y: usize) -> Option<[usize; 2]> {
        let [u, v] = self.at(x, y);
        let (px, py) = (x as f64 + u + 0.5, y as f64 + v + 0.5);
        let inside = px >= 0.0 && py >= 0.0 && px < self.width as f64 && py < self.height() as f64;
        inside.then_some([px as usize, py as usize])
    }

    /// Whether nothing moves, neither the camera nor an object, as where a recording repeats a frame.
    pub(crate) fn is_still(&self) -> bool {
        let [right, bottom] = [self.width - 1, self.height() - 1];
        let still = |(x, y): (usize, usize)| {
            let [u, v] = self.at(x, y);
            u * u + v * v < f64::from(Model::DEFAULT.position_sigma).powi(2)
        };
        self.labels.iter().all(|&label| is_background(label))
            && [(0, 0), (right, 0), (0, bottom), (right, bottom)].into_iter().all(still)
    }

    /// Height of the frame, working pixels.
    fn height(&self) -> usize {
        self.labels.len() / self.width
    }

    /// The motion at the size from which its own was halved.
    pub(crate) fn enlarged(&self, size: [usize; 2]) -> LayeredMotion {
        let scaling = Scaling::between(size, [self.width, self.height()]);
        let motions = self.motions.iter().map(|motion| motion.scaled(scaling.step as f64)).collect();
        LayeredMotion { width: size[0], labels: scaling.enlarged(&self.labels), motions, measured: self.measured }
    }

    /// The motion to the next frame if every pixel keeps the motion with which it came from the previous one.
    pub(crate) fn continued(&self) -> LayeredMotion {
        let motions = self.motions.iter().map(|motion| motion.inverse().unwrap_or(AffineMotion::STATIC)).collect();
        LayeredMotion { motions, measured: false, ..self.clone() }
    }
}

/// A [`LayeredMotion`] as it is stored.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KeptLayeredMotion {
    labels: Runs,
    motions: Vec<AffineMotion>,
    measured: bool,
}

saved!(KeptLayeredMotion { labels, motions, measured });

impl KeptLayeredMotion {
    pub(crate) fn of(flow: &LayeredMotion) -> KeptLayeredMotion {
        KeptLayeredMotion { labels: Runs::of(&flow.labels), motions: flow.motions.clone(), measured: flow.measured }
    }

    pub(crate) fn layered_motion(&self, width: usize) -> LayeredMotion {
        LayeredMotion { width, labels: self.labels.values(), motions: self.motions.clone(), measured: self.measured }
    }

    pub(crate) fn is_valid(&self, pixels: usize) -> bool {
        let is_unknown = |label: u8| usize::from(label) >= self.motions.len();
        self.labels.is_valid(pixels)
            && !self.labels.any(&is_unknown)
            && self.motions.iter().all(AffineMotion::is_finite)
    }
}

/// Log-odds as they are stored: multiples of a step.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KeptLogOdds(Runs);

saved!(KeptLogOdds { 0 });

impl KeptLogOdds {
    pub(crate) fn of(log_odds: &Plane) -> KeptLogOdds {
        // One byte; 128 stands for log-odds of zero.
        let code = |log_odds: &f32| (libm::roundf(log_odds / STEP).clamp(-127.0, 127.0) + 128.0) as u8;
        KeptLogOdds(Runs::of(&log_odds.values().iter().map(code).collect::<Vec<u8>>()))
    }

    pub(crate) fn log_odds(&self, width: usize, height: usize) -> Plane {
        // As above.
        let decoded = self.0.values().iter().map(|&code| STEP * (f32::from(code) - 128.0)).collect();
        Plane::from_vec(width, height, decoded)
    }

    pub(crate) fn is_valid(&self, pixels: usize) -> bool {
        self.0.is_valid(pixels)
    }
}

/// The solved pairs of a frame with the previous one, as they are stored.
#[derive(Clone, Debug)]
pub(crate) struct KeptPairs {
    /// From the previous frame to this one.
    onward: Option<(KeptLogOdds, KeptLayeredMotion)>,
    /// From this frame to the previous one.
    back: Option<(KeptLogOdds, KeptLayeredMotion)>,
    /// What a fast stream expects of the next pair.
    prior: Option<Prior>,
}

saved!(KeptPairs { onward, back, prior });

/// [`KeptPairs`] decoded.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pairs {
    pub(crate) onward: Option<(Plane, LayeredMotion)>,
    pub(crate) back: Option<(Plane, LayeredMotion)>,
    pub(crate) prior: Option<Prior>,
}

impl Pairs {
    pub(crate) fn kept(&self) -> KeptPairs {
        let kept = |view: &Option<(Plane, LayeredMotion)>| {
            view.as_ref().map(|(log_odds, flow)| (KeptLogOdds::of(log_odds), KeptLayeredMotion::of(flow)))
        };
        KeptPairs { onward: kept(&self.onward), back: kept(&self.back), prior: self.prior.clone() }
    }
}

impl KeptPairs {
    pub(crate) fn pairs(&self, [width, height]: [usize; 2]) -> Pairs {
        let view = |kept: &Option<(KeptLogOdds, KeptLayeredMotion)>| {
            kept.as_ref().map(|(log_odds, flow)| (log_odds.log_odds(width, height), flow.layered_motion(width)))
        };
        Pairs { onward: view(&self.onward), back: view(&self.back), prior: self.prior.clone() }
    }

    pub(crate) fn is_valid(&self, pixels: usize) -> bool {
        let valid =
            |(log_odds, flow): &(KeptLogOdds, KeptLayeredMotion)| log_odds.is_valid(pixels) && flow.is_valid(pixels);
        [&self.onward, &self.back].into_iter().flatten().all(valid) && self.prior.as_ref().is_none_or(Prior::is_valid)
    }
}

/// Log-odds of object against background at every working pixel, nats.
pub(crate) fn log_odds(found: &FrameMotions) -> Plane {
    let FrameMotions { probabilities, groups, .. } = found;
    let (width, height) = (probabilities[0].width(), probabilities[0].height());
    let [mut log_odds, mut ground] = [0, 1].map(|_| Plane::filled(width, height, model().doubt));
    for (probability, group) in probabilities.iter().zip(groups) {
        let sum = if *group == BACKGROUND { &mut ground } else { &mut log_odds };
        sum.values_mut().iter_mut().zip(probability.values()).for_each(|(s, p)| *s += p);
    }
    for (log_odds, ground) in log_odds.values_mut().iter_mut().zip(ground.values()) {
        *log_odds = STEP * libm::roundf(libm::logf(*log_odds / ground).clamp(-model().certain, model().certain) / STEP);
    }
    log_odds
}

/// The motion of every pixel.
pub(crate) fn layered_motion(found: FrameMotions) -> LayeredMotion {
    let FrameMotions { labels, motions, probabilities, .. } = found;
    LayeredMotion { width: probabilities[0].width(), labels, motions, measured: true }
}

/// Whether any pixel is more likely an object's than the background's.
pub(crate) fn shows_object(log_odds: &Plane) -> bool {
    log_odds.values().iter().any(|&log_odds| log_odds > 0.0)
}
