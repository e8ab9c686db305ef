//! Interactive correction: labels are solved again under strokes that say which motions are possible at a pixel.
//!
//! The motions do not change. A stroke is a hard constraint on its own pixels and a soft one around them: a label that the nearest
//! stroke excludes costs `STROKE_PRICE · exp(−d/STROKE_REACH)` more. The geodesic distance d grows slowly where the frames agree
//! with the stroke, at image edges where they cannot tell, and fast where they contradict it. One stroke therefore takes a whole
//! region with it and stops at its border. Labels that no stroke reaches are returned bit for bit.

use super::Pair;
use super::report::{SegmentedMotion, at_working_size, describe};
use super::settings::{Part, Settings};
use crate::answer::UNLABELLED;
use crate::error::{Error, Result};
use crate::frame::filter::gaussian;
use crate::frame::{Frame, Plane};
use crate::labelling::resolution::upsampling::upsample;
use crate::labelling::terms::colour::add_colours;
use crate::labelling::terms::data::label_costs;
use crate::labelling::terms::smoothness::Borders;
use crate::labelling::terms::visibility::with_visibility;
use crate::motion::AffineMotion;
use crate::options::SegmentOptions;
use crate::progress::{Progress, Stages};
use crate::workspace::{self, Buffer};

const STAGES: &[&str] = &["frames", "dominant", "labels", "masks"];

/// Largest number of motions in a [`Correction`]: the bits of a set.
pub const MAX_CORRECTED: usize = 16;

/// Price of an excluded label next to the stroke: twice the cost of a motion that does not fit.
const STROKE_PRICE: f32 = 4.0;
/// Geodesic distance at which it has fallen to 1/e.
const STROKE_REACH: f32 = 24.0;
/// A stroke has no influence below this share of its price.
const SMALLEST_INFLUENCE: f32 = 0.02;
/// Length of a step between neighbours where the frames agree with the stroke …
const AGREED_STEP: f32 = 0.25;
/// … added to it where the frames cannot tell …
const UNDECIDED_STEP: f32 = 2.0;
/// … and added at a strong edge where they cannot tell, and everywhere where they contradict the stroke.
const BARRIER: f32 = 40.0;
/// Intensity step, grey levels, at which an edge has 1 − 1/e of its full strength.
const STRONG_EDGE: f32 = 24.0;
/// Difference of two motions' costs at which the frames decide between them …
const DECISIVE_GAP: f32 = 0.5;
/// … averaged over this window, working pixels.
const GAP_WINDOW: f32 = 1.5;
/// Price of changing a label where no stroke has influence.
const CHANGE_PRICE: f32 = 2.0;
/// Double sweeps in which distances are propagated.
const SWEEPS: usize = 2;
/// Full-size labels are computed anew within this many working pixels of a change.
const MARGIN: usize = 3;
/// Price of an excluded label on the stroke itself.
const EXCLUDED_PRICE: f32 = 1e6;

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
    let settings = Settings::new(options, super::size(first));
    let mut stages = Stages::new(STAGES, progress);
    let labels = if correction.allowed.iter().all(|&set| set == 0) {
        correction.labels.to_vec()
    } else {
        stages.begin("frames");
        let pyramid = settings.pyramid(first);
        let mut pair = Pair::new(
            first,
            &pyramid,
            &settings.pyramid(second),
            before.map(|f| settings.pyramid(f)).as_ref(),
            &settings,
        );
        stages.begin("dominant");
        pair.find_dominant(settings.has(Part::Brightness));
        stages.begin("labels");
        let working = WorkingCorrection::new(&pair, correction, first.width());
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
    fn new(pair: &Pair<'_>, correction: &Correction<'_>, full_width: usize) -> WorkingCorrection {
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
        let motions = correction.motions.iter().map(|m| at_working_size(m, pair.reduction)).collect();
        WorkingCorrection { motions, labels, allowed, step, size: [width, height] }
    }

    /// The labels of working size.
    fn solve(&self, pair: &Pair<'_>, settings: &Settings) -> Buffer<u8> {
        let level = pair.finest();
        let coherence = settings.coherence;
        let mut costs = label_costs(level, &self.motions, coherence);
        // Unlabelled pixels count as the dominant motion's here, as when the masks were corrected for occlusion.
        let known: Buffer<u8> = self.labels.iter().map(|&l| if l == UNLABELLED { 0 } else { l }).collect();
        if self.motions.len() > 1 {
            costs = with_visibility(level, &self.motions, &costs, &known, coherence.object_bias);
            add_colours(&mut costs, &pair.appearance.palette, &known);
        }
        let influence = self.add_stroke_costs(&mut costs, &pair.appearance.pictures[0].luminance);
        let mut solved =
            Borders::new(&pair.appearance.pictures[0], level.noise, coherence).solve(&costs, coherence.solver);
        for (p, label) in solved.iter_mut().enumerate() {
            if influence[p] < SMALLEST_INFLUENCE {
                *label = self.labels[p];
            }
        }
        solved
    }

    /// Adds the prices of labels that strokes exclude, and the price of a change where strokes have little influence. Returns the
    /// influence of the nearest stroke at every pixel, 0…1.
    fn add_stroke_costs(&self, costs: &mut [Plane], edges: &Plane) -> Buffer<f32> {
        let mut influence: Buffer<f32> = self.allowed.iter().map(|&set| if set == 0 { 0.0 } else { 1.0 }).collect();
        let smooth: Vec<Plane> = costs.iter().map(|c| gaussian(c, GAP_WINDOW)).collect();
        for k in 0..costs.len() {
            let excluded = |p: usize| self.allowed[p] != 0 && self.allowed[p] >> k & 1 == 0;
            if !(0..self.allowed.len()).any(excluded) {
                continue;
            }
            let distance = distances(edges, &cost_gap(&smooth, k), excluded);
            for (p, c) in costs[k].values_mut().iter_mut().enumerate() {
                let strength = libm::expf(-distance[p] / STROKE_REACH);
                *c += if excluded(p) { EXCLUDED_PRICE } else { STROKE_PRICE * strength };
                influence[p] = influence[p].max(strength);
            }
        }
        for (k, cost) in costs.iter_mut().enumerate() {
            for (p, c) in cost.values_mut().iter_mut().enumerate() {
                if self.labels[p] != UNLABELLED && usize::from(self.labels[p]) != k {
                    *c += CHANGE_PRICE * (1.0 - influence[p]);
                }
            }
        }
        influence
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

/// By how much label k is more expensive than the cheapest other, in units of [`DECISIVE_GAP`], cut to −1…1.
fn cost_gap(costs: &[Plane], k: usize) -> Vec<f32> {
    let other =
        |p: usize| (0..costs.len()).filter(|&l| l != k).map(|l| costs[l].values()[p]).fold(f32::INFINITY, f32::min);
    let own = costs[k].values().iter().enumerate();
    own.map(|(p, &own)| ((own - other(p)) / DECISIVE_GAP).clamp(-1.0, 1.0)).collect()
}

/// Geodesic distance of every pixel from the nearest one that `starts`. `agreement`, −1…1, is how far the frames agree with the
/// stroke. Distances are propagated along rows and columns in [`SWEEPS`] double sweeps; behind many corners they come out too large.
fn distances(edges: &Plane, agreement: &[f32], starts: impl Fn(usize) -> bool) -> Vec<f32> {
    let (width, height) = (edges.width(), edges.height());
    let values = edges.values();
    let step = |p: usize, q: usize| {
        let both_agree = agreement[p].min(agreement[q]);
        let edge = 1.0 - libm::expf(-(values[p] - values[q]).abs() / STRONG_EDGE);
        AGREED_STEP + (1.0 - both_agree.abs()) * (UNDECIDED_STEP + BARRIER * edge) + BARRIER * (-both_agree).max(0.0)
    };
    let right: Vec<f32> = (0..values.len()).map(|p| if (p + 1) % width == 0 { 0.0 } else { step(p, p + 1) }).collect();
    let down: Vec<f32> = (0..(height - 1) * width).map(|p| step(p, p + width)).collect();
    let mut distance: Vec<f32> = (0..values.len()).map(|p| if starts(p) { 0.0 } else { f32::INFINITY }).collect();
    for _ in 0..SWEEPS {
        for p in 0..values.len() {
            if p % width > 0 {
                distance[p] = distance[p].min(distance[p - 1] + right[p - 1]);
            }
            if p >= width {
                distance[p] = distance[p].min(distance[p - width] + down[p - width]);
            }
        }
        for p in (0..values.len()).rev() {
            if (p + 1) % width != 0 {
                distance[p] = distance[p].min(distance[p + 1] + right[p]);
            }
            if p + width < values.len() {
                distance[p] = distance[p].min(distance[p + width] + down[p]);
            }
        }
    }
    distance
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 9;

    /// A flat image with a white column in the middle that has a gap in the last row.
    fn walled() -> Plane {
        Plane::from_fn(WIDTH, 5, |x, y| if x == 4 && y < 4 { 255.0 } else { 0.0 })
    }

    #[test]
    fn where_the_frames_cannot_tell_distance_goes_around_an_edge() {
        let distance = distances(&walled(), &[0.0; 45], |p| p == 0);
        let step = UNDECIDED_STEP + AGREED_STEP;
        assert_eq!(distance[3], 3.0 * step);
        // Down, through the gap, up again.
        assert_eq!(distance[8], 16.0 * step);
    }

    #[test]
    fn where_they_agree_it_crosses_edges_and_where_they_do_not_it_stops() {
        assert_eq!(distances(&walled(), &[1.0; 45], |p| p == 0)[8], 8.0 * AGREED_STEP);
        let mut agreement = [1.0; 45];
        (0..45).filter(|p| p % WIDTH > 4).for_each(|p| agreement[p] = -1.0);
        assert!(distances(&walled(), &agreement, |p| p == 0)[5] > BARRIER);
    }
}
