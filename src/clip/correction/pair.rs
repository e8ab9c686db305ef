//! Interactive correction: the labels of a pair are decided anew under strokes that say which motions are possible at a pixel.
//!
//! It is the correction of clips with two frames: the looks of an object and what is said of it, and how its pixels move to the second frame.
//! A stroke parts the motions that are possible from those of the pixels that it takes; one cut for each such division moves pixels from one
//! side to the other, and all others keep their labels.

use super::still::Still;
use crate::answer::UNLABELLED;
use crate::clip::annotation::Seed;
use crate::error::{Error, Result};
use crate::frame::scaling::Scaling;
use crate::frame::{Frame, Plane};
use crate::labelling::BACKGROUND;
use crate::labelling::solver::MAX_LABELS;
use crate::labelling::upsampling::upsample;
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::options::SegmentOptions;
use crate::pair::dominant::Dominant;
use crate::pair::frames::Pair;
use crate::pair::labels::visible_costs;
use crate::pair::report::{SegmentedMotion, describe};
use crate::pair::settings::Settings;
use crate::progress::{Progress, Stages};

const STAGES: &[&str] = &["frames", "labels", "masks"];

/// Largest number of motions in a [`Correction`]: what the labelling solves at once.
pub const MAX_CORRECTED: usize = MAX_LABELS;

/// Input of [`relabel`].
#[derive(Clone, Copy, Debug)]
pub struct Correction<'a> {
    /// The motions, pixels of the full frame; their order is that of the labels. At most [`MAX_CORRECTED`].
    pub motions: &'a [AffineMotion],
    /// Group of each motion; copied to the result.
    pub groups: &'a [u8],
    /// The labels so far, one per pixel of the frame, row by row; [`UNLABELLED`] where there is none.
    pub labels: &'a [u8],
    /// The possible motions, one set per pixel of the frame: bit k is set where motion k is possible; 0 means no constraint.
    /// "This is motion 2 or 3" is `0b1100`, "this is not motion 0" of four is `0b1110`.
    pub allowed: &'a [u16],
}

/// Result of [`relabel`].
#[non_exhaustive]
#[derive(Clone, Debug)]
pub struct Relabelling {
    /// The motions in the order given, including those without pixels.
    pub motions: Vec<SegmentedMotion>,
    /// One label per pixel of the frame.
    pub labels: Vec<u8>,
    /// Number of unlabelled pixels.
    pub unlabelled: usize,
}

/// Decides the labels of `first` anew under a correction. The motions and their numbering stay the same, and the result depends on the
/// arguments alone: to undo a correction, call again without it. Pixels change only between motions that a stroke tells apart, and where
/// that is connected with it.
///
/// `options.quality` should be that of the labels so far; the other options have no effect.
///
/// # Errors
/// [`Error::FrameSizeMismatch`]; [`Error::InvalidOption`] `motions`, `groups`, `labels` or `evidence` for arrays that do not match
/// each other or refer to motions that do not exist.
pub fn relabel(
    first: &Frame,
    second: &Frame,
    correction: &Correction<'_>,
    options: &SegmentOptions,
    progress: Progress<'_>,
) -> Result<Relabelling> {
    first.check_size_of(second)?;
    correction.check(first.width() * first.height())?;
    let settings = Settings::new(options, [first.width(), first.height()], &Model::DEFAULT);
    let mut stages = Stages::new(STAGES, progress);
    let mut labels = correction.labels.to_vec();
    if correction.is_disobeyed() {
        let divisions = correction.divisions();
        stages.begin("frames");
        let working = Working::new(first, second, correction, &settings);
        stages.begin("labels");
        divisions.into_iter().for_each(|division| working.divide(division, &mut labels));
        stages.begin("masks");
        working.obey(&mut labels);
    }
    let groups: Vec<usize> = correction.groups.iter().map(|&g| usize::from(g)).collect();
    let mut motions = describe(correction.motions, &groups, &labels, first.luminance(), second.luminance());
    motions.iter_mut().zip(correction.groups).for_each(|(motion, &group)| motion.group = group);
    let unlabelled = labels.iter().filter(|&&l| l == UNLABELLED).count();
    Ok(Relabelling { motions, labels, unlabelled })
}

impl Correction<'_> {
    fn check(&self, pixels: usize) -> Result<()> {
        let invalid = |name, reason| Err(Error::InvalidOption { name, reason });
        let n = self.motions.len();
        if n == 0 || n > MAX_CORRECTED {
            return invalid("motions", format!("there must be 1 to {MAX_CORRECTED} motions, not {n}"));
        }
        if let Some(k) = self.motions.iter().position(|m| !m.is_finite()) {
            return invalid("motions", format!("the matrix of motion {k} must hold six finite numbers"));
        }
        if self.groups.len() != n {
            return invalid("groups", format!("{} groups do not fit {n} motions", self.groups.len()));
        }
        if self.labels.len() != pixels {
            return invalid("labels", format!("{} labels do not fill {pixels} pixels", self.labels.len()));
        }
        if let Some(label) = self.labels.iter().find(|&&l| usize::from(l) >= n && l != UNLABELLED) {
            return invalid("labels", format!("label {label} is not one of {n} motions"));
        }
        if self.allowed.len() != pixels {
            return invalid("evidence", format!("{} sets do not fill {pixels} pixels", self.allowed.len()));
        }
        if let Some(set) = self.allowed.iter().find(|&&set| u32::from(set) >> n != 0) {
            return invalid("evidence", format!("the set {set:#b} speaks of more than {n} motions"));
        }
        Ok(())
    }

    /// All motions.
    fn all(&self) -> u16 {
        u16::MAX >> (u16::BITS as usize - self.motions.len())
    }

    /// Whether the label of a pixel is what its set says. A set of none or of all motions says nothing.
    fn is_obeyed(&self, label: u8, set: u16) -> bool {
        set == 0 || set == self.all() || is_in(label, set)
    }

    /// Whether there is anything to do.
    fn is_disobeyed(&self) -> bool {
        self.labels.iter().zip(self.allowed).any(|(&label, &set)| !self.is_obeyed(label, set))
    }

    /// The divisions that strokes make. Strokes that agree with the labels under them make none.
    fn divisions(&self) -> Vec<Division> {
        let mut taken = vec![0u16; 1 << self.motions.len()];
        for (&set, &label) in self.allowed.iter().zip(self.labels) {
            if set != 0 && label != UNLABELLED && !is_in(label, set) {
                taken[usize::from(set)] |= 1 << label;
            }
        }
        let mut divisions: Vec<Division> = Vec::new();
        for (set, &taken) in (0u16..).zip(&taken).filter(|(_, taken)| **taken != 0) {
            // A stroke that gives pixels to one side and a stroke that gives them to the other are of the same division.
            let [object, others] =
                if taken.trailing_zeros() < set.trailing_zeros() { [set, taken] } else { [taken, set] };
            match divisions.iter_mut().find(|known| known.object == object) {
                Some(known) => known.others |= others,
                None => divisions.push(Division { object, others }),
            }
        }
        divisions
    }
}

/// Two sides that strokes tell apart, sets of motions. The smallest label is one of the others.
#[derive(Clone, Copy, Debug)]
struct Division {
    object: u16,
    others: u16,
}

/// Whether a label is one of a set of motions.
fn is_in(label: u8, set: u16) -> bool {
    label != UNLABELLED && set >> label & 1 == 1
}

/// A correction and what the frames tell, at the size at which objects are corrected.
struct Working<'a> {
    frame: &'a Frame,
    correction: &'a Correction<'a>,
    still: Still,
    /// Price of each motion at every pixel.
    costs: Vec<Plane>,
}

impl<'a> Working<'a> {
    fn new(first: &'a Frame, second: &Frame, correction: &'a Correction<'a>, settings: &Settings) -> Working<'a> {
        let mut pair = Pair::of_frames([first, second], settings);
        let reduction = pair.scaling.step as f64;
        let motions: Vec<AffineMotion> = correction.motions.iter().map(|m| m.scaled(1.0 / reduction)).collect();
        pair.settle_dominant(Dominant::Known(&motions[0]), settings);
        let (width, step) = (first.width(), reduction as usize);
        let (w, h) = (pair.finest().width(), pair.finest().height());
        let middle = |p: usize| {
            let at = |k: usize, side: usize| (k * step + step / 2).min(side - 1);
            at(p / w, first.height()) * width + at(p % w, width)
        };
        // Unlabelled pixels count as the dominant motion's here, as when the masks were corrected for occlusion.
        let label = |p: usize| Some(correction.labels[middle(p)]).filter(|&l| l != UNLABELLED).unwrap_or_default();
        let labels: Vec<u8> = (0..w * h).map(label).collect();
        let costs = visible_costs(&pair, &motions, &labels, settings);
        let still = Still::new(first);
        let [columns, rows] = still.size();
        // In pixels of the costs for each of those of the corrections.
        let scale = |k: usize| (k * still.step() + still.step() / 2) / step;
        let at_size =
            |cost: &Plane| Plane::from_fn(columns, rows, |x, y| cost.at(scale(x).min(w - 1), scale(y).min(h - 1)));
        Working { frame: first, correction, costs: costs.iter().map(at_size).collect(), still }
    }

    /// The pixel that a full-size one belongs to.
    fn pixel(&self, p: usize) -> usize {
        let ([columns, rows], step, width) = (self.still.size(), self.still.step(), self.frame.width());
        (p / width / step).min(rows - 1) * columns + (p % width / step).min(columns - 1)
    }

    /// The motions of a set with their prices.
    fn of(&self, set: u16) -> impl Iterator<Item = (u8, &Plane)> {
        (0u8..).zip(&self.costs).filter(move |(k, _)| is_in(*k, set))
    }

    /// Price of the motion of a set that fits a pixel best.
    fn price(&self, set: u16, p: usize) -> f32 {
        self.of(set).map(|(_, cost)| cost.values()[p]).fold(f32::INFINITY, f32::min)
    }

    /// Which motion of a set every pixel would have: of an object the largest one, else the one that fits.
    fn choice(&self, set: u16) -> Vec<u8> {
        let [columns, rows] = self.still.size();
        let pixels = |k: &u8| self.correction.labels.iter().filter(|label| *label == k).count();
        let has_ground = is_in(BACKGROUND as u8, set);
        if let Some(largest) = self.of(set).map(|(k, _)| k).max_by_key(pixels).filter(|_| !has_ground) {
            return vec![largest; columns * rows];
        }
        let (labels, costs): (Vec<u8>, Vec<Plane>) = self.of(set).map(|(k, cost)| (k, cost.clone())).unzip();
        self.still.labels(&costs).iter().map(|&k| labels[usize::from(k)]).collect()
    }

    /// Which pixels are on which side of a division.
    fn divide(&self, Division { object, others }: Division, labels: &mut [u8]) {
        let size @ [columns, rows] = self.still.size();
        let mut said = vec![Seed::Nothing; columns * rows];
        let mut found = vec![0usize; columns * rows];
        for (p, (&allowed, &label)) in self.correction.allowed.iter().zip(&*labels).enumerate() {
            let here = self.pixel(p);
            found[here] += usize::from(is_in(label, object));
            match [allowed & object, allowed & others] {
                _ if allowed == 0 => {}
                [own, 0] if own != 0 => said[here] = Seed::Object,
                // Where strokes contradict each other inside a pixel, it is the object's.
                [0, _] if said[here] == Seed::Nothing => said[here] = Seed::Other,
                _ => {}
            }
        }
        let half = self.still.step().pow(2) / 2;
        let found: Vec<bool> = found.into_iter().map(|pixels| pixels > half).collect();
        let odds = |x, y| self.price(others, y * columns + x) - self.price(object, y * columns + x);
        let mask = self.still.mask(&said, &found, &Plane::from_fn(columns, rows, odds));
        let full = upsample(
            &mask,
            &Scaling::between([self.frame.width(), self.frame.height()], size),
            2,
            self.frame.luminance(),
            &Model::DEFAULT,
        );
        let [within, without] = [object, others].map(|side| self.choice(side));
        for (p, (label, &inside)) in labels.iter_mut().zip(&full).enumerate() {
            if inside > 0 && (is_in(*label, others) || *label == UNLABELLED) {
                *label = within[self.pixel(p)];
            } else if inside == 0 && is_in(*label, object) {
                *label = without[self.pixel(p)];
            }
        }
    }

    /// Strokes hold at every pixel of the frame.
    fn obey(&self, labels: &mut [u8]) {
        let mut choices: Vec<Option<Vec<u8>>> = vec![None; 1 << self.costs.len()];
        for (p, (label, &set)) in labels.iter_mut().zip(self.correction.allowed).enumerate() {
            if !self.correction.is_obeyed(*label, set) {
                *label = choices[usize::from(set)].get_or_insert_with(|| self.choice(set))[self.pixel(p)];
            }
        }
    }
}
