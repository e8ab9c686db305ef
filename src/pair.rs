//! The image pipeline: the stages that turn two frames into masks, in order.

mod background;
mod evidence;
mod hypothesis;
pub(crate) mod labels;
pub(crate) mod observer;
pub(crate) mod report;
pub(crate) mod settings;
pub(crate) mod solution;

pub use report::{Junction, PairEvidence, Segmentation, SegmentedMotion};

use std::rc::Rc;

use crate::error::{Error, Result};
use crate::estimation::alignment::{Alignment, Support, align};
use crate::estimation::dominant::{DominantSearch, dominant_motion};
use crate::frame::Frame;
use crate::frame::pyramid::{Appearance, FramePyramid};
use crate::model::Model;
use crate::motion::AffineMotion;
use crate::options::SegmentOptions;
use crate::progress::{Progress, Stages};
use crate::view::brightness::Photometric;
use crate::view::cost::noise;
use crate::view::level::{Level, levels};
use background::Solved;
use observer::Observer;
use settings::Settings;

/// The stages of [`segment_pair`], in order.
const STAGES: &[&str] =
    &["frames", "dominant", "measurements", "algebra", "selection", "refinement", "labels", "masks"];

/// Segments two frames: how many things move, how each one moves and which pixels belong to it.
///
/// # Errors
/// [`Error::InvalidOption`], [`Error::FrameSizeMismatch`].
pub fn segment_pair(
    first: &Frame,
    second: &Frame,
    options: &SegmentOptions,
    progress: Progress<'_>,
) -> Result<Segmentation> {
    segment_observed([first, second], options, &Model::DEFAULT, &mut Stages::new(STAGES, progress))
}

/// [`segment_pair`] with other constants, for studies and fits.
///
/// # Errors
/// As [`segment_pair`].
#[cfg(feature = "ablation")]
#[doc(hidden)]
pub fn segment_pair_with(
    model: &'static Model,
    first: &Frame,
    second: &Frame,
    options: &SegmentOptions,
) -> Result<Segmentation> {
    segment_observed([first, second], options, model, &mut ())
}

/// [`segment_pair`], of which an observer is told while it goes on.
pub(crate) fn segment_observed(
    [first, second]: [&Frame; 2],
    options: &SegmentOptions,
    model: &'static Model,
    observer: &mut dyn Observer,
) -> Result<Segmentation> {
    options.motions.validate()?;
    check_sizes(first, second)?;
    let settings = Settings::new(options, size(first), model);
    let detail = settings.of_detail(options, size(first));
    let rounds = 1 + usize::from(detail.is_some());
    observer.round_begins(0, rounds);
    let pair = Pair::of_frames([first, second], &settings);
    let mut solved = background::solve(pair, &[], &settings, observer);
    if let Some(settings) = detail {
        observer.round_begins(1, rounds);
        let pair = Pair::of_frames([first, second], &settings);
        solved = solved.continued(pair, &settings, observer);
    }
    let Solved { pair, mut labelled } = solved;
    labels::return_shadows(&pair, &mut labelled, &settings);
    observer.finished(&pair, &labelled.motions, &labelled.labels);
    observer.stage_begins("masks");
    Ok(report::report(&pair, labelled, &settings, [first, second], options))
}

fn size(frame: &Frame) -> [usize; 2] {
    [frame.width(), frame.height()]
}

pub(crate) fn check_sizes(first: &Frame, second: &Frame) -> Result<()> {
    let [first, second] = [first, second].map(|frame| (frame.width(), frame.height()));
    if first == second { Ok(()) } else { Err(Error::FrameSizeMismatch { first, second }) }
}

/// The levels of a pair, from the working size down. A pair of the same frames the other way round is one with the frames swapped.
#[derive(Clone)]
pub(crate) struct Pair {
    /// Level 0 is the working size.
    pub(crate) levels: Vec<Level>,
    /// Index of the level on which the dominant motion is found and others are proposed.
    pub(crate) base: usize,
    /// Index of the level on which motions are first selected, the base level or a finer one.
    pub(crate) selection: usize,
    /// Index of the level on which the draft labels are solved.
    pub(crate) draft: usize,
    /// What the labels follow, at the sizes of the levels down to the base or the draft level.
    appearance: Rc<Appearance>,
    /// Full-size pixels per working pixel.
    pub(crate) reduction: f64,
}

/// Objects before a background that may be at rest: their motions, and labels of the working size, whose rows are `width` long.
struct Objects<'a> {
    motions: &'a [AffineMotion],
    labels: &'a [u8],
    width: usize,
}

impl Objects<'_> {
    /// The change of brightness. Along a single motion that of plain ground would be that of the objects.
    fn brightness_at_rest(&self, level: &Level) -> Photometric {
        let motions: Vec<AffineMotion> = [AffineMotion::STATIC].iter().chain(self.motions).copied().collect();
        let step = level.stride << level.index;
        Photometric::along_labels(level, &motions, &|x, y| usize::from(self.labels[y * step * self.width + x * step]))
    }
}

impl Pair {
    /// The pair of two frames.
    fn of_frames([first, second]: [&Frame; 2], settings: &Settings) -> Pair {
        let [pyramid, second] = [first, second].map(|frame| settings.pyramid(frame));
        // The pyramids end here: the pair has the planes to itself and need not copy what it changes.
        Pair::new(first, &pyramid, &second, settings)
    }

    /// `pyramid` is that of `first`.
    pub(crate) fn new(first: &Frame, pyramid: &FramePyramid, second: &FramePyramid, settings: &Settings) -> Pair {
        let levels = levels(&pyramid.levels, &second.levels, settings.model);
        let within =
            |side: usize| levels.iter().position(|l| l.width().max(l.height()) <= side).unwrap_or(levels.len() - 1);
        let [base, selection, draft] = [settings.base_side, settings.selection_side, settings.draft_side].map(within);
        let appearance = Rc::clone(pyramid.appearance(first));
        Pair { levels, base, selection, draft, appearance, reduction: pyramid.reduction as f64 }
    }

    /// Finds the dominant motion, near one that is expected, measures the noise and removes the change of brightness, if it is estimated.
    fn find_dominant(&mut self, expected: Option<&AffineMotion>, search: DominantSearch) -> AffineMotion {
        let (mut motion, photometric) = dominant_motion(&self.levels, self.base, expected, search);
        self.remove(photometric);
        if motion != AffineMotion::STATIC {
            let base = &mut self.levels[self.base];
            let model = base.model;
            base.noise = noise(base, &motion);
            let how = Alignment {
                convergence: search.convergence,
                ..Alignment::of_region(model.iterations, model.ridge_background, model)
            };
            motion = align(base, &motion, &Support::everything(base), &mut Default::default(), how);
        }
        self.measure_along(&motion);
        motion
    }

    /// As [`find_dominant`](Self::find_dominant) where the dominant motion is known.
    pub(crate) fn take_dominant(&mut self, motion: &AffineMotion, brightness: bool) {
        if brightness {
            self.remove(Photometric::along(&self.levels[self.base], motion));
        }
        self.measure_along(motion);
    }

    /// As [`find_dominant`](Self::find_dominant) where the background is at rest and objects have these labels and motions.
    fn take_rest(&mut self, objects: &Objects<'_>, brightness: bool) {
        for _ in 0..self.rest_rounds(brightness) {
            self.remove(objects.brightness_at_rest(&self.levels[self.base]));
            let level = &mut self.levels[self.base];
            level.noise = noise(level, &AffineMotion::STATIC);
        }
        self.measure_along(&AffineMotion::STATIC);
    }

    /// A sample of the base level much as [`take_rest`](Self::take_rest) would leave it, for a fraction of the time.
    fn sample_of_rest(&self, objects: &Objects<'_>, brightness: bool) -> Level {
        let mut level = self.levels[self.base].clone();
        for _ in 0..self.rest_rounds(brightness) {
            objects.brightness_at_rest(&level.thinned()).remove_from(&mut level);
            level.noise = noise(&level, &AffineMotion::STATIC);
        }
        level.noise = noise(&level, &AffineMotion::STATIC);
        level.thinned()
    }

    /// How often the change of brightness and the noise of a background at rest take turns.
    fn rest_rounds(&self, brightness: bool) -> usize {
        if brightness { self.finest().model.rounds } else { 0 }
    }

    /// Measures the noise along the dominant motion.
    fn measure_along(&mut self, motion: &AffineMotion) {
        self.levels.iter_mut().for_each(|level| level.noise = noise(level, motion));
    }

    fn remove(&mut self, photometric: Photometric) {
        self.levels.iter_mut().for_each(|level| photometric.remove_from(level));
    }

    pub(crate) fn finest(&self) -> &Level {
        &self.levels[0]
    }
}
