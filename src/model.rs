//! Every number of the pipelines of frames and of clips that was chosen rather than derived: what it is, its unit, and where it comes from.
//!
//! Sources: *generated*, chosen on generated scenes; *real*, chosen or confirmed on pairs of real sequences; *fit*, a maximum likelihood fit;
//! *speed*, larger is better and slower, or the other way round; *guard*, a value that correct results stay away from.

/// Declares the constants with their defaults, and access to them by name for the programs that vary and fit them.
///
/// Without the feature `ablation` a model has no size: its constants are compiled into the code that reads them.
macro_rules! model {
    ($(#[$of:meta])* $model:ident of $values:ident; $($(#[$doc:meta])* $name:ident: $kind:ty = $value:expr;)*) => {
        $(#[$of])*
        #[cfg(feature = "ablation")]
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $model { $($(#[$doc])* pub $name: $kind,)* }

        $(#[$of])*
        #[cfg(not(feature = "ablation"))]
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(crate) struct $model;

        #[cfg(not(feature = "ablation"))]
        pub(crate) struct $values { $($(#[$doc])* pub(crate) $name: $kind,)* }

        #[cfg(not(feature = "ablation"))]
        impl $model {
            /// The constants that calls use.
            pub(crate) const DEFAULT: $model = $model;
        }

        #[cfg(not(feature = "ablation"))]
        impl std::ops::Deref for $model {
            type Target = $values;
            #[inline(always)]
            fn deref(&self) -> &$values {
                &$values { $($name: $value,)* }
            }
        }

        #[cfg(feature = "ablation")]
        impl $model {
            /// The constants that calls use.
            pub const DEFAULT: $model = $model { $($name: $value,)* };
            /// The names of all constants, in order.
            pub const NAMES: &[&str] = &[$(stringify!($name)),*];

            /// A constant by its name.
            pub fn get(&self, name: &str) -> Option<f64> {
                match name {
                    $(stringify!($name) => Some(self.$name as f64),)*
                    _ => None,
                }
            }

            /// Sets a constant. Returns whether there is one of that name.
            pub fn set(&mut self, name: &str, value: f64) -> bool {
                match name {
                    $(stringify!($name) => self.$name = value as $kind,)*
                    _ => return false,
                }
                true
            }
        }
    };
}

model! {
    /// The constants of the pipeline of frames. Only for measuring: nothing promises that they stay.
    Model of Constants;

    /// Longer side of the working size at most with quality `best`, pixels. Generated.
    work_side: usize = 480;
    /// The same with quality `fast`, and of the level on which motions are selected and labels drafted in frames that are not halved.
    /// Speed.
    work_side_fast: usize = 320;
    /// The same in a stream of quality `fast` for large frames, which then keep at least 160 pixels. Speed.
    work_side_stream: usize = 319;
    /// Longer side of the base level at most, pixels: there the dominant motion is found and others are proposed. Generated.
    base_side: usize = 224;
    /// Longer side from which on frames are large: with quality `best` their search is carried on at this size. Generated.
    detail_side: usize = 960;
    /// The coarsest level keeps the shorter side at least this long, pixels. Generated.
    smallest_side: usize = 24;
    /// A sample of a level keeps its shorter side at least this long, pixels. Guard.
    smallest_sample: usize = 8;

    /// κ: standard deviation of the position that a correct motion predicts, pixels. Generated.
    position_sigma: f32 = 0.15;
    /// Largest cost of a pixel when motions are estimated: the fit of a motion must feel pixels at two deviations. Generated.
    estimation_truncation: f32 = 4.0;
    /// Largest cost of a pixel when it is labelled. Generated, with true motions; real.
    label_truncation: f32 = 2.0;
    /// Noise before it is measured, grey levels: only the first search for the dominant motion uses it. Generated.
    initial_noise: f32 = 4.0;
    /// Least noise, grey levels: rounding both frames makes up to 0.41.
    smallest_noise: f32 = 0.5;
    /// Largest noise, grey levels: where no motion fits, misfit passes for noise. Guard.
    largest_noise: f32 = 8.0;
    /// Pixels in which the noise is measured: half of them give the deviation to within 2 %.
    noise_sample: f64 = 8192.0;
    /// Correlation of the noise of neighbouring pixels on halved levels. Measured.
    noise_correlation: f32 = 0.4;

    /// Smallest gain between the frames. Guard: exposure changes less from frame to frame.
    smallest_gain: f64 = 0.7;
    /// Largest gain between the frames. Guard.
    largest_gain: f64 = 1.4;
    /// Reweighted least squares steps for the change of brightness along known motions; three settle to a tenth of a grey level.
    brightness_steps: usize = 3;
    /// How often the brightness of a background at rest is measured: before its noise is known, and after.
    brightness_rounds: usize = 2;

    /// Squared residual, in variances, at which the weight of a pixel has fallen to a quarter in the alignment of a region. Generated.
    robustness: f32 = 4.0;
    /// Prior against linear terms of the dominant motion, which most of the frame determines, as a share of the translation's
    /// information. Generated.
    ridge_background: f64 = 1e-4;
    /// The same of an object. Generated.
    ridge_object: f64 = 1e-2;
    /// Blur that softens the border of a region before its motion is refined, pixels. Generated.
    region_blur: f32 = 0.7;
    /// A step shorter than this, pixels of the level, ends an alignment: a fiftieth of κ.
    small_step: f64 = 0.003;
    /// Largest linear entry, a zoom by 40 % or a rotation by 23°. Guard: the cost rewards moving pixels out of the frame.
    largest_linear: f64 = 0.4;
    /// A pixel of less weight does not count. Guard.
    smallest_weight: f32 = 1e-3;
    /// With how many times as many iterations linear terms converge in frames at their original size. Real.
    patience: usize = 2;
    /// The same in halved frames. Real.
    patience_halved: usize = 3;
    /// Share of the prior of regions in halved frames. Real.
    prior_halved: f64 = 0.1;

    /// Reach of the search for a start at the coarsest level, pixels of that level.
    reach: i32 = 3;
    /// Mean cost per pixel of length that decides ties of starts for the shorter shift.
    length_price: f64 = 1e-3;
    /// Prior against linear terms in the search for the dominant motion. Generated.
    ridge_dominant: f64 = 1e-3;
    /// Iterations with a translation at the coarsest level. Generated.
    iterations_translation: usize = 6;
    /// Iterations with an affine motion at every level. Generated.
    iterations_dominant: usize = 5;
    /// Iterations once the brightness is known. Generated.
    iterations_settling: usize = 3;
    /// Robustness of the translation in the search for the dominant motion. Generated.
    robustness_translation: f32 = 9.0;
    /// Robustness of the affine motions of that search. Generated.
    robustness_dominant: f32 = 6.0;
    /// Robustness of its last fit at the base level. Generated.
    robustness_strict: f32 = 2.0;
    /// Every so many pixels of every so many rows are looked at where a sample is enough. Speed.
    thinning: usize = 2;
    /// Largest windowed cost of the median pixel at rest that makes a background at rest likely: noise alone has .6. Real.
    rest: f32 = 0.8;

    /// Window of the local flow at the base level, pixels. Generated.
    flow_window: f32 = 3.0;
    /// The same at coarser levels. Generated.
    flow_window_coarse: f32 = 2.0;
    /// Iterations of the local flow per level. Generated.
    flow_iterations: usize = 3;
    /// Longest step of one iteration, pixels. Generated.
    flow_longest_step: f32 = 1.5;
    /// Information added to every window, 1/pixel², so that flat ones do not move. Generated.
    flow_flat: f32 = 0.02;
    /// Squared residual, in variances, at which a pixel's weight has fallen to a half. Generated.
    flow_robustness: f32 = 9.0;
    /// Variance of the position, pixels²: about κ². Generated.
    flow_position_variance: f32 = 0.02;

    /// Distance of the windows that propose motions, pixels of the base level. Generated.
    tile_stride: usize = 6;
    /// Smaller eigenvalue of a window's structure tensor, in noise variances, from which on it proposes. Generated.
    tile_certain: f32 = 0.05;
    /// Shorter flow counts as the dominant motion, pixels of the base level: κ.
    tile_moving: f32 = 0.15;
    /// Proposals closer than this are the same, pixels of the base level. Generated.
    tile_tolerance: f64 = 0.35;
    /// Proposals from windows, at most. Generated.
    tiles: usize = 48;
    /// The same with quality `fast`. Speed.
    tiles_fast: usize = 24;
    /// Share of the frame's width and height over which proposals are compared.
    compared: f64 = 0.1;

    /// Highest degree of the multibody polynomial. Generated.
    degrees: usize = 3;
    /// The same with quality `fast`. Speed.
    degrees_fast: usize = 2;
    /// Measurements that the polynomial is fitted to, at most. Generated.
    measurements: usize = 2000;
    /// The same with quality `fast`. Speed.
    measurements_fast: usize = 1000;
    /// Shortest gradient of a measurement, grey levels per pixel. Generated.
    algebra_gradient: f32 = 1.0;
    /// A pixel takes part when its weight e/(e + `algebra_half`) exceeds this; e is its squared residual in variances. Generated.
    algebra_weight: f32 = 0.45;
    /// Squared residual, in variances, at which that weight is a half. Generated.
    algebra_half: f32 = 6.0;
    /// Unit of flow in the coordinates of the polynomial, pixels of the base level. Generated.
    algebra_unit: f64 = 2.0;
    /// Longer flows are discarded, pixels of the base level. Generated.
    algebra_largest_flow: f64 = 8.0;
    /// Rounds of reweighting of the polynomial. Generated.
    algebra_rounds: usize = 5;
    /// Pixels per unknown that it takes to fit a polynomial.
    algebra_per_unknown: usize = 2;
    /// Squared gradient length, (grey levels per pixel)², from which on measurements have about the same length. Generated.
    algebra_flat: f64 = 4.0;
    /// Distance of an inlier from the polynomial, in medians of all distances. Generated.
    algebra_inlier: f64 = 1.5;
    /// Smallest slope that a measurement is weighted by, in mean slopes. Guard.
    algebra_slope: f64 = 1e-2;

    /// Window of costs in selection, pixels of the second frame. Generated.
    selection_window: f32 = 2.0;
    /// Window of gains, pixels looked at. Generated.
    gain_window: f32 = 2.0;
    /// The same with quality `fast`. Generated.
    gain_window_fast: f32 = 1.5;
    /// Gain per pixel that does not count: windows across borders and chance produce as much. Generated.
    margin: f32 = 0.35;
    /// Side of the blocks by whose means proposals are ranked, pixels. Speed.
    block: usize = 4;
    /// Prior against linear terms of a proposal: small regions determine them badly. Generated.
    ridge_proposal: f64 = 2e-2;
    /// Proposals whose estimated gain is below this share of the price are not tried. Speed.
    smallest_tried_gain: f64 = 0.25;
    /// Rounds in which a proposal is refined and its region found anew. Generated.
    proposal_rounds: usize = 2;
    /// Iterations in each of these rounds. Generated.
    proposal_iterations: usize = 3;
    /// Proposals tried in earnest per round. Speed.
    tries: usize = 6;
    /// The same with quality `fast`. Speed.
    tries_fast: usize = 1;
    /// The same on finer levels. Speed.
    tries_fine: usize = 2;
    /// Largest number of motions that are selected.
    most: usize = 7;
    /// Motions that splitting may add beyond that.
    parts: usize = 3;
    /// Regions with more pixels are eroded before their motion is refined.
    refit_large: usize = 200;
    /// Motions of regions with fewer pixels are not refined.
    refit_smallest: usize = 20;
    /// Iterations of a refinement. Generated.
    refit_iterations: usize = 2;
    /// Rounds of refinement after the first selection. Generated.
    refit_rounds: usize = 1;
    /// Rounds of refinement of the winner. Generated.
    refit_rounds_last: usize = 2;
    /// Rounds of refinement at each finer level. Generated.
    refit_rounds_fine: usize = 1;
    /// Iterations in which the motion of a label that goes on is refined.
    follow_iterations: usize = 3;
    /// Window of the corrections that finer levels propose, pixels. Generated.
    fine_window: f32 = 1.33;
    /// Distance of these windows, pixels. Generated.
    fine_stride: usize = 5;
    /// Number of these windows, the most promising first. Speed.
    fine_windows: usize = 200;
    /// Corrections that are proposed, at most. Speed.
    fine_most: usize = 16;
    /// Shortest correction, pixels. Generated.
    fine_shortest: f64 = 0.05;
    /// Longest correction, pixels. Generated.
    fine_longest: f64 = 2.0;
    /// Corrections closer than this are the same, pixels. Generated.
    fine_tolerance: f64 = 0.1;

    /// λ: price of a border pixel of frames at their original size, costs. Generated.
    smoothness: f32 = 8.0;
    /// The same of frames that were halved. Real.
    smoothness_halved: f32 = 12.0;
    /// Share of λ on a coarser level: borders have half as many pixels. Generated.
    coarse_smoothness: f32 = 0.7;
    /// Price of an object's pixel, costs: 1/40 of the largest. Generated.
    object_bias: f32 = 0.05;
    /// Share of λ that an object pays for every pixel on the frame's border. Real.
    frame_border: f32 = 0.375;
    /// Share of λ that remains at the strongest image edge. Real.
    edge_share: f32 = 0.02;
    /// Step at which the rest of λ has fallen to 1/e: at least so many grey levels. Generated; real.
    smallest_step: f32 = 5.0;
    /// The same in noise deviations. Generated; real.
    noise_steps: f32 = 4.0;
    /// Weight of a step in RGB relative to one in luminance: about 1/√3, so that a grey step counts alike in both.
    colour_share: f32 = 0.6;
    /// Prior probability of every colour under every label: half of an even share.
    colour_prior: f32 = 1e-3;
    /// Cost per nat of improbability if colours can be trusted entirely. Real.
    colour_price: f32 = 1.0;
    /// Largest cost of a colour.
    largest_colour_price: f32 = 2.0;
    /// Summed margins, in costs, below which the colours of a label are unknown: ten pixels of the largest margin.
    colour_support: f32 = 20.0;
    /// Side of the blocks that form the two halves, working pixels.
    colour_block: usize = 12;
    /// Window in which the fit is judged, pixels. Real.
    inflation_window: f32 = 4.0;
    /// Largest windowed cost that noise alone explains. Real.
    expected: f32 = 0.5;
    /// Largest factor of the standard deviation where no motion fits. Real.
    largest_inflation: f32 = 3.0;
    /// Largest cost of a motion at a pixel that it moves behind another object. Generated; real.
    hidden: f32 = 1.5;
    /// How often labels are corrected for occlusion. Generated.
    visibility_rounds: usize = 2;
    /// The same with quality `fast`. Speed.
    visibility_rounds_fast: usize = 1;

    /// Nats for the six parameters of a motion, per ln N of its N pixels: 6/2 (Schwarz, Annals of Statistics 6(2), 1978).
    motion_price: f64 = 3.0;
    /// Nats per pixel of border. Generated; real.
    border_price: f64 = 0.5;
    /// Weight of a pixel of a coarser level, or of a sample of the pixels, in working pixels. It stands for four, but their noise is not
    /// independent. Real.
    coarse_pixel: f32 = 2.0;
    /// Regions smaller than this share of the frame are not objects. Generated.
    smallest_share: f64 = 0.004;
    /// Smallest number of pixels of a part.
    smallest_part: usize = 30;
    /// Window over which two halves compete, pixels. Generated.
    split_window: f32 = 2.5;
    /// Rounds in which pixels are reassigned to the better half. Generated.
    split_rounds: usize = 3;
    /// Smallest share of a region that counts as a half.
    smallest_half: f64 = 0.1;
    /// Iterations in which a motion is refined on a part. Generated.
    split_iterations: usize = 3;
    /// Iterations of the refinement on the joint region.
    merge_iterations: usize = 4;

    /// Window in which light changes as one, pixels.
    shadow_window: f32 = 3.0;
    /// How often the change of light is computed.
    shadow_rounds: usize = 3;
    /// Price of a change of light at a pixel. Real.
    shadow_price: f32 = 1.5;
    /// Mean weight of a window up to which its light is unknown.
    shadow_weight: f32 = 1e-3;
    /// Largest weight of a colour of a shadow, nats.
    shadow_most: f32 = 2.0;
    /// Smallest probability of such a colour.
    shadow_prior: f32 = 1e-3;
    /// Pixels from which the colours of objects are known.
    shadow_fewest: f32 = 100.0;

    /// Guided filter: variance, grey levels², below which a window counts as flat. Generated.
    flat_variance: f32 = 40.0;

    /// Confidence: weight of windowed costs. Fit to generated scenes.
    confidence_cost: f32 = 3.5;
    /// Weight of the surrounding labels. Fit to generated scenes.
    confidence_neighbours: f32 = 2.25;
    /// Weight of the own label. Fit to generated scenes.
    confidence_own: f32 = 1.4;
    /// Windowed cost above which a motion does not explain a pixel. Fit to generated scenes.
    unexplained: f32 = 1.4;
    /// Window of costs for confidence, working pixels.
    confidence_window: f32 = 8.0;
    /// Window of labels for confidence, working pixels.
    confidence_label_window: f32 = 3.0;
    /// Confidence of being an object: weight of the probability of the motion. Fit to real pairs and generated scenes.
    doubt_motion: f64 = 0.55;
    /// Weight of the share of the outline on the frame's border. Fit to real pairs and generated scenes.
    doubt_frame_border: f64 = 5.64;
    /// Weight of the mean cost. Fit to real pairs and generated scenes.
    doubt_misfit: f64 = 5.32;
    /// Constant of the log odds of being an object. Fit to real pairs and generated scenes.
    doubt_constant: f64 = 2.89;
    /// Unknown pixels: window in which a motion must explain a pixel, working pixels. Generated.
    unknown_window: f32 = 1.5;
    /// Share of the largest cost above which a motion does not explain a pixel. Generated.
    unknown_cost: f32 = 0.7;
    /// Window in which texture is measured, working pixels. Generated.
    texture_window: f32 = 3.0;
    /// Mean squared gradient, in noise variances, below which there is no texture: noise alone has .15 to .2.
    no_texture: f32 = 0.2;

    /// Shorter borders do not decide on groups, pixel pairs.
    shortest_border: usize = 12;
    /// Log odds that two regions are one thing: constant. Fit to real pairs and generated scenes.
    joint_constant: f64 = -3.9;
    /// Weight of the logarithm of the relative jump. Fit.
    joint_jump: f64 = 3.1;
    /// Weight of the frame's border on the outline that has more of it. Fit.
    joint_more: f64 = 3.3;
    /// Weight of the frame's border on the other outline. Fit.
    joint_less: f64 = 29.5;
    /// A larger share of that outline on the frame's border says no more. Real.
    joint_enough: f64 = 0.02;

    /// Share of the largest cost, in the mean, above which two frames show different scenes.
    cut: f32 = 0.5;
    /// Share by which the costs of followed motions may rise without a look at others. Real clips.
    follow_tolerance: f64 = 0.02;
    /// The same since the last search, where none is found missing. Real clips.
    follow_tolerance_searched: f64 = 0.05;
}

model! {
    /// The constants of clips and of corrections. Only for measuring: nothing promises that they stay.
    ClipModel of ClipConstants;

    /// Odds beyond this are no more certain, nats, probabilities of .018 and .982: mistakes of pairs, of other frames and of colours are
    /// not. In carried evidence 6, in a cut 5 and 8 give J within .003.
    certain: f32 = 4.0;
    /// Probability of either side that nothing excludes.
    doubt: f32 = 0.01;
    /// Odds of a first guess, nats: the cut of the first round, what was found where a person begins, the middle of a box or of a disc,
    /// votes, and at most those of labels found automatically. 1.5 costs .004 J where a mask is given, .03 where a click is. Real.
    guess: f32 = 2.0;
    /// Odds within which evidence does not tell an object from ground, nats: probabilities of .27 to .73. Also what it costs a pixel to
    /// leave the objects of its motion, half of what it costs to leave its own. Real; insensitive.
    undecided: f32 = 1.0;
    /// Weight of the odds of the pair with the frame before; the pair with the next one has the rest.
    backward: f32 = 0.5;
    /// Share of evidence, and of what is remembered of an object's looks, that is left a frame later. Real.
    decay: f32 = 0.8;
    /// Share of carried evidence of ground that counts: an object that rests looks like ground, ground seldom like an object. Chosen on
    /// thirty real clips: J .659 with 1, .665 with .5. Less is better for people and animals, and worse where water or roads become objects.
    ground: f32 = 0.7;
    /// Rounds over a clip, and of learning and cutting after a click or a box.
    rounds: usize = 2;
    /// Weight of automatic evidence: neighbours and frames share its mistakes. More for colours takes ground of like colour. Real.
    automatic: f32 = 0.3;
    /// Weight of evidence that has decided before: in the second round, and of labels carried from the frame before. Real.
    trust: f32 = 0.5;
    /// Price of a border pixel, costs. Real.
    smoothness: f32 = 3.0;

    /// Added to all odds for the object of a person, nats: without it masks shrink until they vanish. Fit to real clips.
    bias: f32 = 1.0;
    /// Weight of the odds of the memory of what an object of a person looks like. Fit to real clips.
    memory: f32 = 1.6;
    /// Pixels of a cell of the memory below which it falls back on wider ones. Fit to real clips.
    back_off: f32 = 2.0;
    /// Side of a cell of the memory, as a share of the frame's longer side. Fit to real clips.
    cell: f32 = 0.05;
    /// Step of a and b of L*a*b* between colours of the memory; that of L is twice as large.
    colour_step: f32 = 6.0;
    /// Pixels found automatically that a pixel of which something else is said silences at most.
    silences: f32 = 40.0;
    /// Squared difference of colours beyond which it does not matter, L*a*b*.
    truncation: f32 = 600.0;
    /// Price of a shift of a whole object, for each coarse pixel away from the one expected, truncated differences. Fit to real clips.
    shift: f32 = 0.003;
    /// Coarse pixels are so many of the working size. Speed.
    coarse: usize = 4;

    /// Ground around an object that is looked at, and how far it is searched, pixels of the working size.
    margin: usize = 48;
    /// Pixels that it takes to know colours or a place.
    pixels: usize = 100;
    /// Distance of places that are the same, pixels of the working size or cells of the memory: around a click, a shift, a border.
    near: f32 = 3.0;
    /// Difference of displacements that are the same, and how well a place is known after a frame, pixels of the working size.
    motion: f32 = 1.0;
    /// Distance within which parts of an object are looked for, and which parts it, in roots of its size.
    search: f64 = 1.0;
    /// A smaller share of a thing is nothing: what grazes it, what is not expected; more than the rest is all of it. Also the weight as ground
    /// of a pixel of which nothing is said.
    few: f32 = 0.1;
    /// A larger share of a thing is a part of it, and a larger relative difference is one; more than the rest is most of it.
    part: f32 = 0.2;
    /// What is left of an object's full size in a frame in which less is in sight: objects also become smaller by moving away.
    shrinking: f32 = 0.97;
    /// Frames in a row in which two must move together to be one, or apart to be two. Generated.
    together: usize = 5;
    /// An object seen in fewer frames, neither in the first nor in the last of its scene, is none. Generated.
    lasting: usize = 4;
}
