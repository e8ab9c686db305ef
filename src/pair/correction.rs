//! Interactive correction: the labels of a pair are solved again under strokes that say which motions are possible at a pixel.
//!
//! It is the labelling of [`segment_pair`](crate::segment_pair) at the working size with the motions given and one more term
//! ([`strokes`](crate::labelling::terms::strokes)). Labels that no stroke reaches are returned bit for bit.

use super::Pair;
use super::labels::LabelState;
use super::report::{SegmentedMotion, describe};
use super::settings::{Part, Settings};
use crate::answer::UNLABELLED;
use crate::error::{Error, Result};
use crate::frame::{Frame, Plane};
use crate::labelling::resolution::upsampling::upsample;
use crate::labelling::solver::MAX_LABELS;
use crate::labelling::terms::strokes::add_strokes;
use crate::motion::AffineMotion;
use crate::options::SegmentOptions;
use crate::progress::{Progress, Stages};
use crate::workspace::{self, Buffer};

const STAGES: &[&str] = &["frames", "labels", "masks"];

/// Largest number of motions in a [`Correction`]: what the labelling solves at once.
pub const MAX_CORRECTED: usize = MAX_LABELS;

/// A stroke has no influence below this share of its price. Not varied, nor are the next two.
const SMALLEST_INFLUENCE: f32 = 0.02;
/// Price of changing a label where no stroke has influence: that of a motion that does not fit.
const CHANGE_PRICE: f32 = 2.0;
/// Full-size labels are computed anew within this many working pixels of a change.
const MARGIN: usize = 3;

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
#[derive(Clone, Debug)]
pub struct Relabelling {
    /// The motions in the order given, including those without pixels.
    pub motions: Vec<SegmentedMotion>,
    /// One label per pixel of the frame.
    pub labels: Vec<u8>,
    /// Number of unlabelled pixels.
    pub unlabelled: usize,
}

/// Solves the labels of `first` again under a correction. The motions and their numbering stay the same, and the result depends on
/// the arguments alone: to undo a correction, call again without it.
///
/// `options.quality` should be that of the labels so far; the other options have no effect.
///
/// # Errors
/// [`Error::FrameSizeMismatch`]; [`Error::InvalidOption`] `motions`, `groups`, `labels` or `evidence` for arrays that do not match
/// each other or refer to motions that do not exist.
pub fn relabel(
    first: &Frame,
    second: &Frame,
    before: Option<&Frame>,
    correction: &Correction<'_>,
    options: &SegmentOptions,
    progress: Progress<'_>,
) -> Result<Relabelling> {
    super::check_sizes(first, second, before)?;
    correction.check(first.width() * first.height())?;
    let _call = workspace::begin([first.width(), first.height()]);
    // Strokes follow what a pixel shows, so that nothing is drafted on a coarser level.
    let settings = Settings { draft_side: usize::MAX, ..Settings::new(options, super::size(first)) };
    let mut stages = Stages::new(STAGES, progress);
    let labels = if correction.allowed.iter().all(|&set| set == 0) {
        correction.labels.to_vec()
    } else {
        stages.begin("frames");
        let pyramid = settings.pyramid(first);
        let before = before.map(|frame| settings.pyramid(frame));
        let mut pair = Pair::new(first, &pyramid, &settings.pyramid(second), before.as_ref(), &settings);
        drop(before);
        let working = WorkingCorrection::new(&pair, correction, first.width());
        pair.take_dominant(&working.motions[0], settings.has(Part::Brightness));
        stages.begin("labels");
        let solved = working.solve(&pair, &settings);
        stages.begin("masks");
        working.enlarge(&solved, correction, first.luminance())
    };
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
}

/// The correction at working size.
struct WorkingCorrection {
    motions: Vec<AffineMotion>,
    labels: Buffer<u8>,
    allowed: Buffer<u16>,
    /// Full-size pixels per working pixel.
    step: usize,
    size: [usize; 2],
}

impl WorkingCorrection {
    fn new(pair: &Pair, correction: &Correction<'_>, full_width: usize) -> WorkingCorrection {
        let level = pair.finest();
        let (width, height) = (level.width(), level.height());
        let step = pair.reduction as usize;
        let full_height = correction.labels.len() / full_width;
        let mut labels = Buffer::with_capacity(width * height);
        let mut allowed = Buffer::filled(width * height, 0u16);
        for y in 0..height {
            for x in 0..width {
                let (u, v) = ((x * step + step / 2).min(full_width - 1), (y * step + step / 2).min(full_height - 1));
                labels.push(correction.labels[v * full_width + u]);
            }
        }
        for (p, &set) in correction.allowed.iter().enumerate().filter(|&(_, &set)| set != 0) {
            let (x, y) = ((p % full_width / step).min(width - 1), (p / full_width / step).min(height - 1));
            let slot = &mut allowed[y * width + x];
            // Two strokes through one working pixel: the intersection of their sets or, if it is empty, the union.
            *slot = match (*slot, *slot & set) {
                (0, _) => set,
                (old, 0) => old | set,
                (_, both) => both,
            };
        }
        let motions = correction.motions.iter().map(|m| m.scaled(1.0 / pair.reduction)).collect();
        WorkingCorrection { motions, labels, allowed, step, size: [width, height] }
    }

    /// The labels of working size.
    fn solve(&self, pair: &Pair, settings: &Settings) -> Buffer<u8> {
        // Unlabelled pixels count as the dominant motion's here, as when the masks were corrected for occlusion.
        let known = self.labels.iter().map(|&l| if l == UNLABELLED { 0 } else { l }).collect();
        let mut state = LabelState::resumed(pair, self.motions.clone(), known, settings);
        state.update_occlusion();
        state.add_colour_costs(pair);
        let influence = add_strokes(&mut state.costs, &self.allowed, &pair.appearance.pictures[0].luminance);
        self.add_change_price(&mut state.costs, &influence);
        state.solve_final();
        for (p, label) in state.labels.iter_mut().enumerate() {
            if influence[p] < SMALLEST_INFLUENCE {
                *label = self.labels[p];
            }
        }
        state.labels
    }

    /// Adds the price of a change where strokes have little influence.
    fn add_change_price(&self, costs: &mut [Plane], influence: &[f32]) {
        for (k, cost) in costs.iter_mut().enumerate() {
            for ((c, &label), share) in cost.values_mut().iter_mut().zip(&self.labels).zip(influence) {
                if label != UNLABELLED && usize::from(label) != k {
                    *c += CHANGE_PRICE * (1.0 - share);
                }
            }
        }
    }

    /// Full-size labels: enlarged along the edges of the frame near changes, unchanged elsewhere. Strokes hold at every pixel of
    /// the frame.
    fn enlarge(&self, solved: &[u8], correction: &Correction<'_>, guide: &Plane) -> Vec<u8> {
        let [width, height] = self.size;
        let near = self.near_changes(solved);
        // Unlabelled pixels that no stroke reached stay unlabelled: they have a label of their own while labels are enlarged.
        let unlabelled = self.motions.len() as u8;
        let current: Vec<u8> = solved.iter().map(|&l| l.min(unlabelled)).collect();
        let full = upsample(&current, self.size, self.motions.len() + 1, guide);
        let mut labels = correction.labels.to_vec();
        for (p, label) in labels.iter_mut().enumerate() {
            let (x, y) = (p % guide.width() / self.step, p / guide.width() / self.step);
            let q = y.min(height - 1) * width + x.min(width - 1);
            if near[q] {
                *label = if full[p] == unlabelled { UNLABELLED } else { full[p] };
            }
            let set = correction.allowed[p];
            if set != 0 && (*label == UNLABELLED || set >> *label & 1 == 0) {
                let here = solved[q];
                *label = if here != UNLABELLED && set >> here & 1 == 1 { here } else { set.trailing_zeros() as u8 };
            }
        }
        labels
    }

    /// Working pixels within [`MARGIN`] of one whose label has changed.
    fn near_changes(&self, solved: &[u8]) -> Vec<bool> {
        let [width, height] = self.size;
        let mut near = vec![false; solved.len()];
        for p in (0..solved.len()).filter(|&p| solved[p] != self.labels[p]) {
            let (x, y) = (p % width, p / width);
            for v in y.saturating_sub(MARGIN)..=(y + MARGIN).min(height - 1) {
                near[v * width + x.saturating_sub(MARGIN)..=v * width + (x + MARGIN).min(width - 1)].fill(true);
            }
        }
        near
    }
}
