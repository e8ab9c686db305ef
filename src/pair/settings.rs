//! Settings of a pair that depend on the quality, an option or the size of the frames. The numbers themselves are those of the [`Model`].

use crate::estimation::alignment::Convergence;
use crate::frame::Frame;
use crate::frame::pyramid::FramePyramid;
use crate::frame::scaling::Scaling;
use crate::labelling::options::LabellingOptions;
use crate::labelling::solver::Solver;
use crate::model::Model;
use crate::options::{MotionCount, Quality, SegmentOptions};

#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings {
    /// How often the frames are halved to reach the working size.
    pub(crate) halvings: usize,
    /// Largest longer side of the base level, pixels. There the dominant motion is found and others are proposed.
    pub(crate) base_side: usize,
    /// Largest longer side of the level on which motions are first selected, pixels.
    pub(crate) selection_side: usize,
    /// Largest longer side of the level on which labels are drafted, pixels.
    pub(crate) draft_side: usize,
    /// Smallest shorter side of the coarsest level, pixels.
    pub(crate) smallest_side: usize,
    /// Highest degree of the multibody polynomial.
    pub(crate) degrees: usize,
    /// Largest number of measurements to which the polynomial is fitted.
    pub(crate) measurements: usize,
    /// Largest number of proposals from single windows.
    pub(crate) tiles: usize,
    /// Number of proposals refined per round of the selection.
    pub(crate) tries: usize,
    /// The entries that must converge when the dominant motion is found.
    pub(crate) dominant: Convergence,
    /// The entries that must converge when motions are refined on their pixels during selection.
    pub(crate) refinement: Convergence,
    /// Whether motions that were refined on a sample of the working pixels are finally refined on all of them.
    pub(crate) completes: bool,
    /// Largest number of motions.
    pub(crate) most: usize,
    /// Smallest number of motions: none is removed below it.
    pub(crate) least: usize,
    /// How often labels are corrected for occlusion.
    pub(crate) visibility_rounds: usize,
    /// How labels are solved.
    pub(crate) labelling: LabellingOptions,
    /// Whether shadows of objects are given back to the background.
    pub(crate) returns_shadows: bool,
    /// Whether a pair starts from the labels of the one before, where there is one.
    pub(crate) follows: bool,
    /// Whether only the main subject is figure.
    pub(crate) subject: bool,
    /// The constants that do not depend on quality, options or size.
    pub(crate) model: &'static Model,
}

/// How often frames are halved with quality `fast`: to `side` or, if they are large, to `of_large`.
fn fast_halvings([side, of_large]: [usize; 2], size: [usize; 2], model: &Model) -> usize {
    Scaling::within(size, if size[0].max(size[1]) > model.detail_side() { of_large } else { side }).halvings()
}

/// λ of quality `fast` for frames that are halved so many times.
fn fast_smoothness(halvings: usize, model: &Model) -> f32 {
    if halvings > 1 { model.smoothness_halved } else { model.smoothness }
}

impl Settings {
    /// The settings for a pair of frames of the given width and height.
    pub(crate) fn new(options: &SegmentOptions, size: [usize; 2], model: &'static Model) -> Settings {
        let halvings = Scaling::within(size, model.work_side).halvings();
        // Halving averages the noise; what remains is model error, which neighbours share. Motions are then best selected at the working
        // size itself, with a higher smoothness. For frames at their original size, a coarser level averages the noise.
        let (fine_side, smoothness) = if halvings > 0 {
            (model.work_side, model.smoothness_halved)
        } else {
            (model.work_side_fast, model.smoothness)
        };
        let best = Settings {
            halvings,
            base_side: model.base_side(),
            selection_side: fine_side,
            draft_side: fine_side,
            smallest_side: model.smallest_side,
            degrees: model.degrees,
            measurements: model.measurements,
            tiles: model.tiles,
            tries: model.tries,
            dominant: Convergence::Every,
            refinement: Convergence::Every,
            completes: false,
            most: model.most,
            least: 1,
            visibility_rounds: model.visibility_rounds,
            labelling: LabellingOptions { smoothness, object_bias: model.object_bias, solver: Solver::BEST },
            returns_shadows: model.light_penalty.is_finite(),
            follows: false,
            subject: options.subject,
            model,
        };
        let mut settings = match options.quality {
            Quality::Best => best,
            Quality::Fast => Settings {
                refinement: Convergence::Translation,
                returns_shadows: false,
                halvings: fast_halvings([model.work_side_fast, model.work_side], size, model),
                // 640 × 480 and 1280 × 720 come out at 160 pixels; what lies between is not halved to less.
                selection_side: model.base_side(),
                draft_side: model.base_side(),
                tiles: model.tiles_fast,
                tries: model.tries_fast,
                visibility_rounds: model.visibility_rounds_fast,
                labelling: LabellingOptions {
                    smoothness: fast_smoothness(
                        fast_halvings([model.work_side_fast, model.work_side], size, model),
                        model,
                    ),
                    solver: Solver::FAST,
                    ..best.labelling
                },
                ..best
            },
        };
        if model.drafts == 0 {
            settings.draft_side = usize::MAX;
        }
        if let MotionCount::Given(n) = options.motions {
            // The number is given: every motion that helps is added, and none is removed below it.
            settings.most = n;
            settings.least = n;
        }
        settings
    }

    /// The settings for the pairs of a clip. Motions are selected on the base level and, with quality `best`, finally refined on all
    /// working pixels: on clips that nothing was tuned on this is as good as a selection at the working size, in half the time. Linear
    /// terms need not converge: waiting for them made fast streams worse, explained small unrelated frames too well for a cut to be seen,
    /// and gained no more than chance in whole clips. Shadows are given back with both qualities, because they would be carried from frame
    /// to frame.
    pub(crate) fn of_clip(options: &SegmentOptions, size: [usize; 2]) -> Settings {
        let settings = Settings::new(options, size, &Model::DEFAULT);
        let [dominant, refinement] = [Convergence::Translation; 2];
        let (selection_side, completes) = (settings.base_side, options.quality == Quality::Best);
        Settings { dominant, refinement, selection_side, completes, returns_shadows: true, ..settings }
    }

    /// The settings for the pair of a clip of two frames, where no other frames correct the result: as those of a clip, with motions
    /// selected on the level of a pair. In longer clips this costs half as much again, and improves neither masks nor corrections.
    pub(crate) fn of_lone_pair(options: &SegmentOptions, size: [usize; 2]) -> Settings {
        let Settings { selection_side, completes, .. } = Settings::new(options, size, &Model::DEFAULT);
        Settings { selection_side, completes, ..Settings::of_clip(options, size) }
    }

    /// The settings for the pairs of a stream. A fast one selects motions and drafts labels at the working size.
    pub(crate) fn of_stream(options: &SegmentOptions, size: [usize; 2]) -> Settings {
        let settings = Settings::of_clip(options, size);
        if options.quality == Quality::Best {
            return settings;
        }
        let (model, sides) = (settings.model, [settings.model.base_side(), settings.model.work_side_stream()]);
        let halvings = fast_halvings(sides, size, model);
        let labelling = LabellingOptions { smoothness: fast_smoothness(halvings, model), ..settings.labelling };
        let fine_side = model.work_side_stream();
        Settings { halvings, selection_side: fine_side, draft_side: fine_side, labelling, follows: true, ..settings }
    }

    /// The settings with which a search is continued at a finer working size, so that large frames get their detail; `None` with quality
    /// `fast`, or if the frames are not large.
    pub(crate) fn of_detail(&self, options: &SegmentOptions, size: [usize; 2]) -> Option<Settings> {
        let halvings = Scaling::within(size, self.model.detail_side()).halvings();
        let finer = self.halvings > 1 && halvings < self.halvings;
        let wanted = options.quality == Quality::Best && finer && self.model.adds_detail > 0;
        wanted.then_some(Settings { halvings, draft_side: self.model.detail_side(), ..*self })
    }

    /// The solver of final labels.
    pub(crate) fn solver(quality: Quality) -> Solver {
        match quality {
            Quality::Best => Solver::BEST,
            Quality::Fast => Solver::FAST,
        }
    }

    /// The working size of frames of the given width and height.
    pub(crate) fn scaling(&self, size: [usize; 2]) -> Scaling {
        Scaling::halved(size, self.halvings)
    }

    /// The pyramid of a frame.
    pub(crate) fn pyramid(&self, frame: &Frame) -> FramePyramid {
        FramePyramid::new(frame, self.halvings, self.smallest_side)
    }

    /// Whether a change of brightness is estimated.
    pub(crate) fn brightness(&self) -> bool {
        self.model.largest_gain > 1.0
    }
}
