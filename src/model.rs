//! Every number of the pipelines of frames and of clips that was chosen rather than derived: what it is, its unit, and where it comes from.
//!
//! Sources: *generated*, chosen on generated scenes; *real*, chosen or confirmed on pairs of real sequences; *fit*, a maximum likelihood
//! fit; *speed*, a compromise between quality and time; *guard*, a limit that correct results do not reach.

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

/// Standard deviation of a window of twice the area of one of 1.75 pixels.
const WIDE: f32 = std::f32::consts::SQRT_2 * 1.75;

model! {
    /// The constants of the pipeline of frames. Only for measuring: they may change in any version.
    Model of Constants;

    /// Largest longer side of the working size with quality `best`, pixels. Generated.
    work_side: usize = 480;
    /// The same with quality `fast`, and of the level on which motions are selected and labels are drafted in frames that are not halved.
    /// Speed.
    work_side_fast: usize = 320;
    /// Smallest shorter side of the coarsest level, pixels. Generated.
    smallest_side: usize = 24;

    /// κ: standard deviation of the position that a correct motion predicts, pixels. Generated.
    position_sigma: f32 = 0.15;
    /// Largest noise, grey levels: where no motion fits, misfit passes for noise. Guard.
    largest_noise: f32 = 8.0;

    /// Iterations of the alignment of a region, from a start that is close. Generated.
    region_iterations: usize = 3;
    /// The same for the whole frame, when the dominant motion is searched for. Generated.
    dominant_iterations: usize = 6;
    /// Iterations of the local flow on each level. Generated.
    flow_iterations: usize = 3;
    /// Iterations of the weights of the multibody polynomial. Generated.
    algebra_iterations: usize = 6;
    /// Iterations of the change of brightness. Generated.
    brightness_iterations: usize = 3;
    /// Iterations of the change of light in shadows. Generated.
    light_iterations: usize = 3;
    /// Rounds in which the pixels of a region go to the better of two motions. Generated.
    split_rounds: usize = 3;
    /// How often a proposal and its region are refined in turn.
    proposal_rounds: usize = 2;
    /// How often the selected motions and their regions are refined in turn.
    refit_rounds: usize = 2;
    /// How often the change of brightness and the noise of a background at rest are estimated in turn.
    rest_rounds: usize = 2;
    /// How often labels and the pixels that they occlude are computed in turn.
    visibility_rounds: usize = 2;
    /// Standard deviation of the window over which costs and gains are averaged, pixels of the level. Generated.
    cost_window: f32 = 1.75;
    /// The same for the products of gradients in a local flow, pixels. Generated.
    flow_window: f32 = 1.75;
    /// Standard deviation of the window of a change of light, pixels. Generated.
    light_window: f32 = WIDE;
    /// Standard deviation of the window in which texture is measured, pixels. Generated.
    texture_window: f32 = WIDE;
    /// Fewest pixels of a region from which a motion is estimated: five for each entry. Generated.
    fewest: usize = 30;
    /// Fewest pixels from which colours are learned. Generated.
    fewest_of_colours: usize = 30;
    /// Fewest pixels on both sides of a border along which two motions are compared. Generated.
    fewest_of_border: usize = 30;
    /// Smallest share of a region that can be a body of its own. Generated.
    smallest_body: f64 = 0.1;
    /// Two motions are compared at a position and at this share of the frame's width and height beside it. Generated.
    distinct_span: f64 = 0.1;
    /// Weight up to which a pixel is ignored in an alignment or a mean.
    smallest_weight: f32 = 1e-3;
    /// Added to the share of every colour, so that none is impossible. Generated.
    colour_prior: f32 = 1e-3;
    /// Penalty per pixel of shift when the search for the dominant motion starts, mean costs: it decides between equally good shifts.
    shift_penalty: f32 = 1e-3;
    /// Smallest slope of a reading of the multibody polynomial, relative to their mean. Guard.
    least_slope: f32 = 1e-3;
    /// Smallest deviation of a frame's grey levels from which a gain is computed. Guard.
    least_deviation: f32 = 1e-3;

    /// Largest gain between the frames; its reciprocal is the smallest. Guard: exposure changes less from frame to frame.
    largest_gain: f64 = 1.4;
    /// Largest linear entry, a zoom by 40 % or a rotation by 23°. Guard: the cost rewards moving pixels out of the frame.
    largest_linear: f64 = 0.4;
    /// Squared residual, in variances, at which the weight of a pixel has fallen to a quarter in the alignment of a region; also the
    /// largest cost of a pixel when motions are estimated. The fit must be sensitive to pixels at two deviations. Generated.
    truncation: f32 = 4.0;
    /// Prior against linear terms of the dominant motion, relative to the information about the translation. Generated.
    ridge_background: f64 = 1e-4;
    /// The same for an object: small regions determine linear terms badly. Generated.
    ridge_object: f64 = 3e-3;

    /// Reach of the search for a start at the coarsest level, pixels of that level.
    reach: i32 = 3;
    /// `truncation` where pixels may belong to other motions: the first translation of a frame, the local flow of a window. Generated.
    truncation_loose: f32 = 9.0;

    /// Information added to every window, 1/pixel², so that the flow of flat windows is zero. Generated.
    flow_flat: f32 = 0.02;

    /// Spacing of the windows that propose motions, pixels of the base level. Generated.
    tile_stride: usize = 6;
    /// Side of the blocks by which the colour model is cross-validated, working pixels. Generated.
    colour_block: usize = 12;
    /// Smallest value of the smaller eigenvalue of a window's structure tensor at which it proposes a motion, noise variances. Generated.
    tile_certain: f32 = 0.05;
    /// Largest number of proposals from windows. Generated.
    tiles: usize = 48;
    /// The same with quality `fast`. Speed.
    tiles_fast: usize = 24;

    /// Highest degree of the multibody polynomial. Generated.
    degrees: usize = 3;
    /// Largest number of measurements to which the polynomial is fitted. Generated.
    measurements: usize = 1000;
    /// Shortest gradient of a measurement, grey levels per pixel. Generated.
    algebra_gradient: f32 = 1.0;
    /// Unit of flow in the coordinates of the polynomial, pixels of the base level. Generated.
    algebra_unit: f64 = 2.0;

    /// Gain per pixel that is ignored: windows across borders and chance produce as much. Generated.
    margin: f32 = 0.35;
    /// Proposals whose estimated gain is below this share of the penalty are not tried. Speed.
    smallest_tried_gain: f64 = 0.25;
    /// Number of proposals refined per round. Speed.
    tries: usize = 6;
    /// The same with quality `fast`. Speed.
    tries_fast: usize = 2;
    /// Largest number of motions that are selected.
    most: usize = 10;

    /// λ: penalty of a border pixel of frames at their original size, costs. Generated.
    smoothness: f32 = 8.0;
    /// The same of frames that were halved. Real.
    smoothness_halved: f32 = 12.0;
    /// Penalty of an object's pixel, costs: 1/40 of the largest. Generated.
    object_bias: f32 = 0.05;
    /// Share of λ that remains at the strongest image edge: without it, textured regions break up. Real.
    edge_share: f32 = 0.02;
    /// Step of an edge at which the rest of λ has fallen to 1/e, in deviations of the noise or, if it is less, in grey levels. Generated; real.
    noise_steps: f32 = 4.0;
    /// Cost per nat of improbability of a colour, if colours are completely reliable.
    colour_weight: f32 = 1.0;
    /// Largest factor of the standard deviation where no motion fits. Real.
    largest_inflation: f32 = 3.0;
    /// The same with quality `fast`. Speed.
    visibility_rounds_fast: usize = 1;

    /// Penalty of a border, nats per pixel. Generated; real.
    border_penalty: f64 = 0.5;
    /// Regions smaller than this share of the frame are not objects. Generated.
    smallest_share: f64 = 0.004;

    /// Guided filter: variance, grey levels², below which a window counts as flat. If it is infinite, masks are only enlarged. Generated.
    flat_variance: f32 = 40.0;

    /// Confidence: weight of windowed costs. Fit to generated scenes.
    confidence_cost: f32 = 3.5;
    /// Weight of the surrounding labels. Fit to generated scenes.
    confidence_neighbours: f32 = 2.25;
    /// Weight of the own label. Fit to generated scenes.
    confidence_own: f32 = 1.4;
    /// Cost above which a motion does not explain a pixel. Fit to generated scenes.
    unexplained: f32 = 1.4;
    /// Largest cost of a motion at a pixel that it moves behind another object. Generated.
    hidden_cost: f32 = 1.4;
    /// Cost of a change of light. If it is infinite, shadows are not searched for. Generated; real.
    light_penalty: f32 = 1.4;
    /// Confidence of being an object: weight of the probability of the motion. Fit to real pairs and generated scenes.
    doubt_motion: f64 = 0.55;
    /// Weight of the share of the outline on the frame's border. Fit to real pairs and generated scenes.
    doubt_frame_border: f64 = 5.64;
    /// Weight of the mean cost. Fit to real pairs and generated scenes.
    doubt_misfit: f64 = 5.32;
    /// Constant of the log-odds of being an object. Fit to real pairs and generated scenes.
    doubt_constant: f64 = 2.89;
    /// Mean squared gradient, in noise variances, below which there is no texture: noise alone has .15 to .2.
    no_texture: f32 = 0.2;

    /// Log-odds that two regions are one thing: constant. Fit to real pairs and generated scenes.
    joint_constant: f64 = -3.9;
    /// Weight of the logarithm of the relative jump. Fit.
    joint_jump: f64 = 3.1;
    /// Weight of the frame's border on the outline that has more of it. Fit.
    joint_more: f64 = 3.3;
    /// Weight of the frame's border on the other outline. Fit.
    joint_less: f64 = 29.5;
    /// Share of that outline on the frame's border above which a larger share makes no difference. Real.
    joint_enough: f64 = 0.02;

    /// Weight of the centrality of a figure. Fit to real pairs and generated scenes.
    figure_centre: f64 = 20.5;
    /// Weight of the distance of its flow from that of a plane. Fit.
    figure_plane: f64 = 2.1;
    /// Weight of the edges along its border. Fit.
    figure_edge: f64 = 7.3;
    /// Weight of its share of the jumps of the flow. Fit.
    figure_jump: f64 = 7.0;
    /// Weight of its share of what motions explain better than the background's. Fit.
    figure_gain: f64 = 4.7;
    /// Weight of its share of what lies outside the largest group. Fit.
    figure_kept: f64 = 9.85;
    /// Weight of the overlap of the main subject and the figure. Fit to real pairs.
    subject_like: f64 = 10.1;
    /// Weight of the jumps of the flow along its border. Fit.
    subject_jump: f64 = 12.7;
    /// Weight of how central it is. Fit.
    subject_centre: f64 = 9.3;
    /// Weight of the edges along its border. Fit.
    subject_edge: f64 = 6.2;
    /// Weight of the share of its outline on the frame's border. Fit.
    subject_frame: f64 = 5.92;

    /// Share by which the costs of followed motions may rise before others are searched for. Real clips.
    follow_tolerance: f64 = 0.02;
    /// The same relative to the last search, if it found none missing. Real clips.
    follow_tolerance_searched: f64 = 0.05;

    /// Whether a background that may be at rest is also solved at rest. This and the following switches are 1; an ablation sets one to 0 to
    /// leave out a part that no other constant disables.
    solves_at_rest: usize = 1;
    /// Whether the background is put at rest where that shortens the description.
    tries_static: usize = 1;
    /// Whether labels are drafted on a coarser level.
    drafts: usize = 1;
    /// Whether the search in large frames is continued at a finer size.
    adds_detail: usize = 1;
    /// Whether regions are merged.
    merges: usize = 1;
    /// Whether regions are split.
    splits: usize = 1;
}

model! {
    /// The constants of clips and of corrections. Only for measuring: they may change in any version.
    ClipModel of ClipConstants;

    /// Log-odds are limited to this, nats, probabilities of .018 and .982: beyond it, mistakes of pairs, of other frames and of colours
    /// dominate. 6 for carried log-odds, and 5 or 8 in a cut, give J within .003.
    certain: f32 = 4.0;
    /// Added to the probability of either side, so that neither is excluded.
    doubt: f32 = 0.01;
    /// Log-odds of the first round's cut in the second one, nats. Real.
    first_cut: f32 = 2.0;
    /// Weight of the log-odds of pairs in the second round, because the cut of the first contains them. Real.
    first_log_odds: f32 = 0.5;
    /// Log-odds of the labels found automatically where a person first annotates an object, nats. 1.5 costs .004 J where a mask is given.
    /// Real.
    found: f32 = 2.0;
    /// Largest log-likelihood ratio of a label found automatically, nats. Real.
    labels: f32 = 2.0;
    /// Initial log-odds of the fit of a prompt, nats: in the middle of a box or a disc, or in a region. 1.5 costs .03 J where a click is
    /// given. Real.
    beginning: f32 = 2.0;
    /// Log-odds of an object where a person saw it when drawing strokes, and did not correct it, nats. 0 costs .002 J after the second
    /// round of strokes, and rounds lose in five clips of thirty instead of two; 2 costs .004 after the first. Real.
    seen: f32 = 1.0;
    /// Log-odds up to which a pixel is undecided between object and ground, nats: probabilities of .27 to .73. Real; insensitive.
    undecided: f32 = 1.0;
    /// Cost of a pixel whose label is not an object of its motion, nats; half of the cost of leaving its own object.
    leaves_motion: f32 = 1.0;
    /// Weight of the log-odds of the pair with the previous frame; the pair with the next one has the rest.
    backward: f32 = 0.5;
    /// Share of a frame's log-odds that is carried to the next frame. Real.
    decay: f32 = 0.8;
    /// Share of an object's remembered appearance, velocity and agreement with labels that is left a frame later. Real.
    memory_decay: f32 = 0.8;
    /// Share of carried negative log-odds that counts: an object that rests looks like ground, ground seldom like an object. Chosen on
    /// thirty real clips: J .659 with 1, .665 with .5. Less is better for people and animals, and worse where water or roads become
    /// objects.
    ground: f32 = 0.7;
    /// Rounds of learning and cutting after a click or a box.
    prompt_rounds: usize = 2;
    /// Weight of automatic log-odds and colours: neighbours and frames share their mistakes. More for colours takes ground of like colour.
    /// Real.
    automatic: f32 = 0.3;
    /// Weight of the mask carried from the previous frame: the same log-odds have decided it already. Real.
    trust: f32 = 0.5;
    /// Penalty of a border pixel, costs. Real.
    smoothness: f32 = 3.0;

    /// Added to all log-odds of an annotated object, nats: without it masks shrink until they vanish. Fit to real clips.
    bias: f32 = 1.0;
    /// Weight of the log-odds by the appearance of an annotated object. Fit to real clips.
    memory: f32 = 1.6;
    /// Weight of the log-odds by the mask of the annotated frame to which pixels are traced. Chosen on real clips; insensitive from 1.6 to
    /// 2.4.
    trace: f32 = 1.6;
    /// Number of pixels in a cell of the appearance below which it backs off to wider ones. Fit to real clips.
    back_off: f32 = 2.0;
    /// Side of a cell of the appearance, as a share of the frame's longer side. Fit to real clips.
    cell: f32 = 0.05;
    /// Step of a and b of L*a*b* between colours of the appearance; that of L is twice as large.
    colour_step: f32 = 6.0;
    /// Largest number of pixels found automatically that one pixel annotated otherwise outweighs.
    outweighed: f32 = 40.0;
    /// Squared difference of colours at which it is truncated, L*a*b*.
    truncation: f32 = 600.0;
    /// Penalty of a shift of a whole object, for each coarse pixel away from the expected one, truncated differences. Fit to real clips.
    shift: f32 = 0.003;
    /// Side of a coarse pixel, pixels of the working size. Speed.
    coarse: usize = 4;

    /// Width of the ground around an object that is used, pixels of the working size.
    margin: usize = 48;
    /// Radius of the search for an object around its expected position, pixels of the working size.
    reach: usize = 48;
    /// Fewest pixels from which colours, a position or a region are determined.
    pixels: usize = 100;
    /// Number of pixels of a template that are compared. Speed.
    samples: usize = 100;
    /// Number of pixels below which a separate part that a change leaves is removed.
    speck: usize = 100;
    /// Radius of a click, pixels of the working size.
    click: f32 = 3.0;
    /// Largest step of the fine search for a shift, pixels of the working size. Speed.
    fine: usize = 3;
    /// Standard deviation of the position of a border, pixels of the working size.
    border: f32 = 3.0;
    /// Number of cells of the appearance around an object, on each side.
    cells_around: usize = 3;
    /// Largest difference of displacements that count as the same, pixels of the working size.
    same_motion: f32 = 1.0;
    /// The same, as a share of the displacement.
    same_relative_motion: f32 = 0.2;
    /// Growth per frame of the uncertainty of an object's position, pixels of the working size.
    drift: f32 = 1.0;
    /// Standard deviation of the blur of the masks and colours that are propagated, pixels of the working size.
    blur: f32 = 1.0;
    /// Distance within which parts are joined and objects are searched for, and beyond which a piece is parted, in roots of the size.
    search: f64 = 1.0;
    /// Share by which that distance grows in each frame in which the object is hidden.
    search_growth: f32 = 0.1;

    /// Smallest share of a region that must be carried from an object for it to claim the region.
    carried: f32 = 0.1;
    /// Smallest overlap of the colours of an object that comes back.
    likeness: f32 = 0.2;
    /// Share of an object below which a piece of it is a fragment, not an object of its own.
    fragment: f32 = 0.2;
    /// Share of an object below which a part that its division leaves goes to the other side.
    sliver: f32 = 0.1;
    /// Share of an object out of sight above which it counts as partly hidden.
    hidden: f32 = 0.1;
    /// Share of a partly hidden object that may look different; above it, the object has changed instead.
    altered: f32 = 0.2;
    /// Mean truncated difference below which a template is found close to the expected place.
    same_template: f32 = 0.2;
    /// One minus the cost of a template's pixel that is out of sight. At that mean cost or above, nothing is seen again.
    unseen: f32 = 0.2;
    /// Difference between the usual cost and that of a shift at which a hidden object is seen again, mean truncated difference.
    distinct: f32 = 0.1;
    /// IoU of an object before and after strokes above which they have changed only part of it. Insensitive from .65 to .8. Real.
    part: f32 = 0.65;
    /// Smallest probability at which an object is expected at a pixel.
    expected: f32 = 0.1;
    /// Smallest probability at which a pixel counts for the centre of an object.
    central: f32 = 0.2;
    /// Weight, as ground, of a pixel without a seed where a person first annotates an object that was not found.
    unannotated: f32 = 0.1;
    /// Weight of the colours' shares over all positions, relative to `back_off`.
    places: f32 = 0.1;
    /// Rim of a disc or a box that need not belong to its object, as a share of the radius.
    rim: f32 = 0.2;
    /// Share of the votes of a click's parts above which it changes a pixel. .2 and .4 cost .01 J after the first click. Real.
    votes: f32 = 0.3;
    /// Share of an object below which a separate piece is removed by any stroke that removes pixels of it.
    piece: f32 = 0.2;
    /// Share of a separate piece's length that a stroke through it may leave uncrossed.
    uncrossed: f32 = 0.2;
    /// Share of its full size that a partly hidden object keeps from frame to frame: objects also become smaller by moving away.
    shrinking: f32 = 0.97;
    /// Frames in which two objects must move together to be joined, or, in a row, apart to be parted. Generated.
    lasting_motion: usize = 5;
    /// An object visible in fewer frames, neither in the first nor in the last of its scene, is dropped. Generated.
    lasting: usize = 4;

    /// Whether a frame is compared with earlier ones where neighbours show no object. This and the next three are 1; an ablation sets one
    /// to 0.
    looks_farther: usize = 1;
    /// Whether the foreground is cut in a second round.
    cuts_twice: usize = 1;
    /// Whether parts that move together are joined.
    joins: usize = 1;
    /// Whether there are several objects, each with its number. Else everything that is found is one object.
    identities: usize = 1;
}

impl Model {
    /// Smallest longer side of large frames, pixels: they are halved twice, and with quality `best` their search is continued at this size.
    pub(crate) fn detail_side(&self) -> usize {
        2 * self.work_side
    }

    /// Largest longer side of the working size in a stream of quality `fast` for large frames, pixels: those that would be halved to
    /// [`Model::work_side_fast`] are halved once more.
    pub(crate) fn work_side_stream(&self) -> usize {
        self.work_side_fast - 1
    }

    /// Standard deviation of the window of a local flow on the base level, of twice the area, pixels.
    pub(crate) fn flow_window_base(&self) -> f32 {
        std::f32::consts::SQRT_2 * self.flow_window
    }

    /// Largest cost of a pixel when it is labelled: half of the one in estimation, as labels must not follow single pixels. Generated,
    /// with true motions; real.
    pub(crate) fn largest_cost(&self) -> f32 {
        0.5 * self.truncation
    }

    /// Largest longer side of the base level, pixels. There the dominant motion is found and others are proposed.
    pub(crate) fn base_side(&self) -> usize {
        self.work_side / 2
    }

    /// Standard deviation of the window in which the fit is judged, pixels.
    pub(crate) fn window_of_fit(&self) -> f32 {
        2.0 * self.cost_window
    }

    /// κ²: variance of the position that a correct motion predicts, pixels².
    pub(crate) fn position_variance(&self) -> f32 {
        self.position_sigma * self.position_sigma
    }
}
