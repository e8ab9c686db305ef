//! Every number of the pipeline that depends on the quality, an option or the size of the frames. Unless something else is said they were
//! chosen on generated scenes, those of `fast` for speed. Numbers that never change are constants beside the code that uses them.

use crate::estimation::alignment::Convergence;
use crate::frame::pyramid::FramePyramid;
use crate::frame::{Frame, MIN_SIDE};
use crate::labelling::coherence::Coherence;
use crate::labelling::solver::Solver;
use crate::options::{MotionCount, Quality, SegmentOptions};
use crate::tuning::{Tuned, tuned};

/// A part of the pipeline that can be left out, for ablation studies. Without the feature `ablation` all parts are enabled. Not covered by
/// semantic versioning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Estimation of gain and bias between the frames.
    Brightness,
    /// The hypothesis of a static background.
    StaticHypothesis,
    /// Candidate motions from the multibody constraint.
    Algebra,
    /// Candidate motions from single windows.
    Windows,
    /// Candidates and selection on levels finer than that of the first selection.
    FinerLevels,
    /// Refinement of motions on the pixels they explain best, after each stage of the selection.
    Refinement,
    /// Lower smoothness cost along image edges.
    Edges,
    /// The smoothness cost.
    Coherence,
    /// Correction of the costs for occlusion.
    Visibility,
    /// Splitting of regions into separate bodies.
    Splitting,
    /// Removal of motions that do not pay for their description.
    ModelSelection,
    /// The colour term.
    Colour,
    /// Shadows given back to the background.
    Shadows,
    /// Upsampling along the edges of the full-size frame.
    GuidedEnlarging,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings {
    /// How often the frames are halved to reach the working size.
    pub(crate) halvings: usize,
    /// Longer side of the base level at most, pixels: there the dominant motion is found and others are proposed.
    pub(crate) base_side: usize,
    /// Longer side of the level on which motions are first selected at most, pixels.
    pub(crate) selection_side: usize,
    /// Longer side of the level on which labels are drafted at most, pixels.
    pub(crate) draft_side: usize,
    /// The coarsest level keeps the shorter side at least this long, pixels.
    pub(crate) smallest_side: usize,
    /// Highest degree of the multibody polynomial.
    pub(crate) degrees: usize,
    /// Measurements that the polynomial is fitted to, at most.
    pub(crate) measurements: usize,
    /// Proposals from single windows, at most.
    pub(crate) tiles: usize,
    /// Proposals tried in earnest per round of the selection.
    pub(crate) tries: usize,
    /// What has to converge when the dominant motion is found …
    pub(crate) dominant: Convergence,
    /// … and when motions are refined on their pixels during selection.
    pub(crate) refinement: Convergence,
    /// Largest number of motions.
    pub(crate) most: usize,
    /// Number of motions below which none is taken away again.
    pub(crate) least: usize,
    /// Standard deviation of the window over which the gain of a motion is gathered, pixels looked at.
    pub(crate) gain_window: f32,
    /// How often labels are corrected for occlusion.
    pub(crate) visibility_rounds: usize,
    /// How labels hold together.
    pub(crate) coherence: Coherence,
    /// Whether shadows of objects are given back to the background.
    pub(crate) returns_shadows: bool,
    /// Whether a pair starts from the labels of the one before, where there is one.
    pub(crate) follows: bool,
    /// What is left out.
    #[cfg(feature = "ablation")]
    pub(crate) without: Option<Part>,
}

/// Longer side of the working size at most, pixels. Chosen on generated scenes.
const WORK_SIDE_BEST: usize = 480;
/// The same for the detail of frames that are halved more than once to that size. Chosen on generated scenes.
const DETAIL_SIDE: usize = 960;
/// Frames whose longer side has more pixels than this are large: most of their time passes at full size, so that a larger working size
/// costs little.
const LARGE: usize = 960;
/// The longer side of the working size at most with quality `fast`, of other frames and of large ones. For speed.
const WORK_SIDE_FAST: [usize; 2] = [320, 480];
/// The same in a stream. The second keeps at least 160 pixels.
const WORK_SIDE_STREAM: [usize; 2] = [BASE_SIDE, 319];
/// Longer side of the level on which motions are selected and labels drafted at most, pixels, unless frames are halved. Chosen on generated
/// scenes.
const SELECTION_SIDE: usize = 320;
/// Longer side of the base level at most, pixels. Chosen on generated scenes.
const BASE_SIDE: usize = 224;
/// λ of frames at their original size, chosen on generated scenes, and of frames that were halved, chosen on real pairs.
const SMOOTHNESS: [f32; 2] = [8.0, 12.0];
/// How the linear terms of motions converge in frames at their original size, where a motion with little prior spans two small bodies that
/// move alike, and in frames that were halved. The latter was chosen on real pairs, where priors of .01 to .3 differ by less than chance.
const CONVERGING: [Convergence; 2] =
    [Convergence::Every { patience: 2, prior: 1.0 }, Convergence::Every { patience: 3, prior: 0.1 }];
/// Price of an object's pixel, costs: 1/40 of the largest. Chosen on generated scenes.
const OBJECT_BIAS: f32 = 0.05;

/// How often frames are halved until their longer side is at most `work_side`, or their shorter side would be too short.
fn halvings_to(work_side: usize, [width, height]: [usize; 2]) -> usize {
    let (mut longer, mut shorter, mut halvings) = (width.max(height), width.min(height), 0);
    while longer > work_side && shorter >= 2 * MIN_SIDE {
        (longer, shorter) = (longer.div_ceil(2), shorter.div_ceil(2));
        halvings += 1;
    }
    halvings
}

/// How often frames are halved with quality `fast`, with these sides of the working size.
fn fast_halvings([side, of_large]: [usize; 2], size: [usize; 2]) -> usize {
    halvings_to(if size[0].max(size[1]) > LARGE { of_large } else { side }, size)
}

/// λ of quality `fast` for frames that are halved so many times.
fn fast_smoothness(halvings: usize) -> f32 {
    tuned(Tuned::Smoothness, SMOOTHNESS[usize::from(halvings > 1)])
}

impl Settings {
    /// The settings for a pair of frames of the given width and height.
    pub(crate) fn new(options: &SegmentOptions, size: [usize; 2]) -> Settings {
        let halvings = halvings_to(WORK_SIDE_BEST, size);
        // Halving averages the noise; what remains is model error, which neighbours share. Motions are then best selected at the working
        // size itself, with a higher smoothness. For frames at their original size, a coarser level averages the noise.
        let (fine_side, smoothness) =
            if halvings > 0 { (WORK_SIDE_BEST, SMOOTHNESS[1]) } else { (SELECTION_SIDE, SMOOTHNESS[0]) };
        let converging = CONVERGING[usize::from(halvings > 0)];
        let best = Settings {
            halvings,
            base_side: BASE_SIDE,
            selection_side: fine_side,
            draft_side: fine_side,
            smallest_side: 24,
            degrees: 3,
            measurements: 2000,
            tiles: 48,
            tries: 6,
            dominant: converging,
            refinement: converging,
            most: 7,
            least: 1,
            gain_window: tuned(Tuned::GainWindow, 2.0),
            visibility_rounds: 2,
            coherence: Coherence {
                smoothness: tuned(Tuned::Smoothness, smoothness),
                object_bias: tuned(Tuned::ObjectBias, OBJECT_BIAS),
                draft_solver: Solver::FAST,
                solver: Solver::BEST,
                sharpening: Solver::BEST,
            },
            returns_shadows: true,
            follows: false,
            #[cfg(feature = "ablation")]
            without: None,
        };
        let mut settings = match options.quality {
            Quality::Best => best,
            Quality::Fast => Settings {
                dominant: CONVERGING[0],
                refinement: Convergence::Translation,
                returns_shadows: false,
                halvings: fast_halvings(WORK_SIDE_FAST, size),
                // 640 × 480 and 1280 × 720 come out at 160 pixels; what lies between is not halved to less.
                selection_side: BASE_SIDE,
                draft_side: BASE_SIDE,
                degrees: 2,
                measurements: 1000,
                tiles: 24,
                tries: 1,
                visibility_rounds: 1,
                gain_window: tuned(Tuned::GainWindow, 1.5),
                coherence: Coherence {
                    smoothness: fast_smoothness(fast_halvings(WORK_SIDE_FAST, size)),
                    solver: Solver::FAST,
                    sharpening: Solver::LIGHT,
                    ..best.coherence
                },
                ..best
            },
        };
        if let MotionCount::Given(n) = options.motions {
            // The caller knows better than the price: anything that helps is added, nothing needed is taken away.
            settings.most = n;
            settings.least = n;
        }
        settings
    }

    /// The settings for the pairs of a clip. They do not wait for linear terms: fast streams lost by it, in small frames unrelated ones were
    /// explained too well for a cut to be seen, and whole clips gained no more than chance. Shadows are given back with both qualities, as they
    /// would be carried from frame to frame.
    pub(crate) fn of_clip(options: &SegmentOptions, size: [usize; 2]) -> Settings {
        let [dominant, refinement] = [Convergence::Translation; 2];
        Settings { dominant, refinement, returns_shadows: true, ..Settings::new(options, size) }
    }

    /// The settings for the pairs of a stream. A fast one selects motions and drafts labels at the working size.
    pub(crate) fn of_stream(options: &SegmentOptions, size: [usize; 2]) -> Settings {
        let settings = Settings::of_clip(options, size);
        if options.quality == Quality::Best {
            return settings;
        }
        let halvings = fast_halvings(WORK_SIDE_STREAM, size);
        let coherence = Coherence { smoothness: fast_smoothness(halvings), ..settings.coherence };
        let [_, fine_side] = WORK_SIDE_STREAM;
        Settings { halvings, selection_side: fine_side, draft_side: fine_side, coherence, follows: true, ..settings }
    }

    /// The settings with which a search is carried on at a finer working size, so that large frames get their detail; none where quality
    /// `fast` or the size of the frames asks for no more.
    pub(crate) fn of_detail(&self, options: &SegmentOptions, size: [usize; 2]) -> Option<Settings> {
        let halvings = halvings_to(DETAIL_SIDE, size);
        let wanted = options.quality == Quality::Best && self.halvings > 1 && halvings < self.halvings;
        wanted.then_some(Settings { halvings, draft_side: DETAIL_SIDE, ..*self })
    }

    /// The solver of final labels.
    pub(crate) fn solver(quality: Quality) -> Solver {
        match quality {
            Quality::Best => Solver::BEST,
            Quality::Fast => Solver::FAST,
        }
    }

    /// Width and height of the working size of frames of the given width and height.
    pub(crate) fn working_size(&self, size: [usize; 2]) -> [usize; 2] {
        size.map(|side| (0..self.halvings).fold(side, |side, _| side.div_ceil(2)))
    }

    /// The pyramid of a frame.
    pub(crate) fn pyramid(&self, frame: &Frame) -> FramePyramid {
        FramePyramid::new(frame, self.halvings, self.smallest_side)
    }

    /// Whether a part takes part.
    pub(crate) fn has(&self, part: Part) -> bool {
        #[cfg(feature = "ablation")]
        return self.without != Some(part);
        #[cfg(not(feature = "ablation"))]
        {
            let _ = part;
            true
        }
    }
}
