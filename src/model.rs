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

/// Standard deviation of a window of twice the area of one of 1.75 pixels.
const WIDE: f32 = std::f32::consts::SQRT_2 * 1.75;

model! {
    /// The constants of the pipeline of frames. Only for measuring: nothing promises that they stay.
    Model of Constants;

    /// Longer side of the working size at most with quality `best`, pixels. Generated.
    work_side: usize = 480;
    /// The same with quality `fast`, and of the level on which motions are selected in frames that are not halved.
    /// Speed.
    work_side_fast: usize = 320;
    /// The coarsest level keeps the shorter side at least this long, pixels. Generated.
    smallest_side: usize = 24;

    /// κ: standard deviation of the position that a correct motion predicts, pixels. Generated.
    position_sigma: f32 = 0.15;
    /// Largest noise, grey levels: where no motion fits, misfit passes for noise. Guard.
    largest_noise: f32 = 8.0;

    /// Iterations of the alignment of a region, from a start that is close. Generated.
    region_iterations: usize = 3;
    /// The same of the whole frame, when the dominant motion is looked for. Generated.
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
    /// Rounds in which a proposal and its region take turns.
    proposal_rounds: usize = 2;
    /// Rounds in which the selected motions and their regions take turns.
    refit_rounds: usize = 2;
    /// Rounds in which the change of brightness and the noise of a background at rest take turns.
    rest_rounds: usize = 2;
    /// Rounds in which labels and the pixels that they hide take turns.
    visibility_rounds: usize = 2;
    /// Standard deviation of the window over which costs and gains are averaged, pixels of the level. Generated.
    cost_window: f32 = 1.75;
    /// The same of the products of gradients in a local flow, pixels. Generated.
    flow_window: f32 = 1.75;
    /// Standard deviation of the window of a change of light, pixels. Generated.
    light_window: f32 = WIDE;
    /// Standard deviation of the window in which there is texture or not, pixels. Generated.
    texture_window: f32 = WIDE;
    /// Fewest pixels of a region that a motion is estimated from: five for each entry. Generated.
    fewest: usize = 30;
    /// Fewest pixels that colours are learnt from. Generated.
    fewest_of_colours: usize = 30;
    /// Fewest pixels on both sides of a border along which two motions are compared. Generated.
    fewest_of_border: usize = 30;
    /// Smallest share of a region that is a body of its own. Generated.
    smallest_body: f64 = 0.1;
    /// Motions are distinct if they differ at a place, or this share of the frame's width or height beside it. Generated.
    distinct_span: f64 = 0.1;
    /// Weight up to which a pixel does not count in an alignment or a mean.
    smallest_weight: f32 = 1e-3;
    /// Added to the share of every colour, so that none is impossible. Generated.
    colour_prior: f32 = 1e-3;
    /// Penalty of a pixel of shift when the search for the dominant motion starts, mean costs: it decides between shifts that are as good.
    shift_penalty: f32 = 1e-3;
    /// Least slope of a reading of the multibody polynomial, as a share of their mean. Guard.
    least_slope: f32 = 1e-3;
    /// Least deviation of a frame's grey levels that a gain is computed from. Guard.
    least_deviation: f32 = 1e-3;

    /// Largest gain between the frames, or one over it. Guard: exposure changes less from frame to frame.
    largest_gain: f64 = 1.4;
    /// Largest linear entry, a zoom by 40 % or a rotation by 23°. Guard: the cost rewards moving pixels out of the frame.
    largest_linear: f64 = 0.4;
    /// Squared residual, in variances, at which the weight of a pixel has fallen to a quarter in the alignment of a region; also the
    /// largest cost of a pixel when motions are estimated, as the fit of a motion must feel pixels at two deviations. Generated.
    robustness: f32 = 4.0;
    /// Prior against linear terms of the dominant motion, as a share of the translation's information. Generated.
    ridge_background: f64 = 1e-4;
    /// The same of an object: small regions determine linear terms badly. Generated.
    ridge_object: f64 = 3e-3;

    /// Reach of the search for a start at the coarsest level, pixels of that level.
    reach: i32 = 3;
    /// The same where other motions may still be in sight: the first translation of a frame, the local flow of a window. Generated.
    robustness_loose: f32 = 9.0;

    /// Information added to every window, 1/pixel², so that flat ones do not move. Generated.
    flow_flat: f32 = 0.02;

    /// Distance of the windows that propose motions, pixels of the base level. Generated.
    tile_stride: usize = 6;
    /// Side of the blocks by which the colour model is cross-validated, working pixels. Generated.
    colour_block: usize = 12;
    /// Smaller eigenvalue of a window's structure tensor, in noise variances, from which on it proposes. Generated.
    tile_certain: f32 = 0.05;
    /// Proposals from windows, at most. Generated.
    tiles: usize = 48;
    /// The same with quality `fast`. Speed.
    tiles_fast: usize = 24;

    /// Highest degree of the multibody polynomial. Generated.
    degrees: usize = 3;
    /// Measurements that the polynomial is fitted to, at most. Generated.
    measurements: usize = 1000;
    /// Shortest gradient of a measurement, grey levels per pixel. Generated.
    algebra_gradient: f32 = 1.0;
    /// Unit of flow in the coordinates of the polynomial, pixels of the base level. Generated.
    algebra_unit: f64 = 2.0;

    /// Gain per pixel that does not count: windows across borders and chance produce as much. Generated.
    margin: f32 = 0.35;
    /// Proposals whose estimated gain is below this share of the penalty are not tried. Speed.
    smallest_tried_gain: f64 = 0.25;
    /// Proposals tried in earnest per round. Speed.
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
    /// Share of λ that remains at the strongest image edge: without it, texture falls to pieces. Real.
    edge_share: f32 = 0.02;
    /// Step of an edge at which the rest of λ has fallen to 1/e, in deviations of the noise or, if it is less, in grey levels. Generated; real.
    noise_steps: f32 = 4.0;
    /// Cost per nat of improbability of a colour, if colours can be trusted entirely.
    colour_weight: f32 = 1.0;
    /// Largest factor of the standard deviation where no motion fits. Real.
    largest_inflation: f32 = 3.0;
    /// The same with quality `fast`. Speed.
    visibility_rounds_fast: usize = 1;

    /// Nats per pixel of border. Generated; real.
    border_penalty: f64 = 0.5;
    /// Regions smaller than this share of the frame are not objects. Generated.
    smallest_share: f64 = 0.004;

    /// Guided filter: variance, grey levels², below which a window counts as flat; if it is infinite, masks are enlarged alone. Generated.
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
    /// Cost of a change of light; if it is infinite, none is looked for. Generated; real.
    light_penalty: f32 = 1.4;
    /// Confidence of being an object: weight of the probability of the motion. Fit to real pairs and generated scenes.
    doubt_motion: f64 = 0.55;
    /// Weight of the share of the outline on the frame's border. Fit to real pairs and generated scenes.
    doubt_frame_border: f64 = 5.64;
    /// Weight of the mean cost. Fit to real pairs and generated scenes.
    doubt_misfit: f64 = 5.32;
    /// Constant of the log odds of being an object. Fit to real pairs and generated scenes.
    doubt_constant: f64 = 2.89;
    /// Mean squared gradient, in noise variances, below which there is no texture: noise alone has .15 to .2.
    no_texture: f32 = 0.2;

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

    /// Weight of how central a figure is. Fit to real pairs and generated scenes.
    figure_centre: f64 = 20.5;
    /// Weight of how far its flow is from that of a plane. Fit.
    figure_plane: f64 = 2.1;
    /// Weight of the edges along its border. Fit.
    figure_edge: f64 = 7.3;
    /// Weight of its share of the jumps of the flow. Fit.
    figure_jump: f64 = 7.0;
    /// Weight of its share of what motions explain better. Fit.
    figure_gain: f64 = 4.7;
    /// Weight of its share of what is not in the largest group. Fit.
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

    /// Share by which the costs of followed motions may rise without a look at others. Real clips.
    follow_tolerance: f64 = 0.02;
    /// The same since the last search, where none is found missing. Real clips.
    follow_tolerance_searched: f64 = 0.05;

    /// Whether a background that may be at rest is solved a second time, at rest. This and the next five are 1, and 0 where an ablation leaves
    /// a part out that no other constant leaves nothing to do.
    solves_at_rest: usize = 1;
    /// Whether the search in large frames is carried on at a finer size.
    adds_detail: usize = 1;
    /// Whether regions are merged.
    merges: usize = 1;
    /// Whether regions are split.
    splits: usize = 1;
}

model! {
    /// The constants of clips and of corrections. Only for measuring: nothing promises that they stay.
    ClipModel of ClipConstants;

    /// Odds beyond this are no more certain, nats, probabilities of .018 and .982: mistakes of pairs, of other frames and of colours are
    /// not. In carried evidence 6, in a cut 5 and 8 give J within .003.
    certain: f32 = 4.0;
    /// Probability of either side that nothing excludes.
    doubt: f32 = 0.01;
    /// Log-odds of the first round's cut in the second one, nats. Real.
    first_cut: f32 = 2.0;
    /// Weight of the log-odds of pairs in the second round, as the first has decided by them. Real.
    first_log_odds: f32 = 0.5;
    /// Odds of the labels found automatically where a person first annotates an object, nats. 1.5 costs .004 J where a mask is given. Real.
    found: f32 = 2.0;
    /// Largest log-likelihood ratio of a label found automatically, nats. Real.
    labels: f32 = 2.0;
    /// Odds with which the fit of a prompt begins, nats: of the middle of a box or a disc, of a region. 1.5 costs .03 J where a click
    /// is given. Real.
    beginning: f32 = 2.0;
    /// Odds of an object where a person has seen it when strokes were drawn, and drawn none, nats. 0 costs .002 J after the second
    /// round of strokes, and rounds lose in five clips of thirty instead of two; 2 costs .004 after the first. Real.
    seen: f32 = 1.0;
    /// Log-odds within which evidence does not tell an object from ground, nats: probabilities of .27 to .73. Real; insensitive.
    undecided: f32 = 1.0;
    /// Cost of a pixel that leaves the objects of its motion, nats; half of the cost of leaving its own object.
    leaves_motion: f32 = 1.0;
    /// Weight of the odds of the pair with the frame before; the pair with the next one has the rest.
    backward: f32 = 0.5;
    /// Share of a frame's evidence that counts in the next frame. Real.
    decay: f32 = 0.8;
    /// Share of what is remembered of an object's looks, velocity and agreement with labels that is left a frame later. Real.
    memory_decay: f32 = 0.8;
    /// Share of carried evidence of ground that counts: an object that rests looks like ground, ground seldom like an object. Chosen on
    /// thirty real clips: J .659 with 1, .665 with .5. Less is better for people and animals, and worse where water or roads become objects.
    ground: f32 = 0.7;
    /// Rounds of learning and cutting after a click or a box.
    prompt_rounds: usize = 2;
    /// Weight of automatic evidence: neighbours and frames share its mistakes. More for colours takes ground of like colour. Real.
    automatic: f32 = 0.3;
    /// Weight of labels carried from the frame before: their evidence has decided before. Real.
    trust: f32 = 0.5;
    /// Penalty of a border pixel, costs. Real.
    smoothness: f32 = 3.0;

    /// Added to all odds for the object of a person, nats: without it masks shrink until they vanish. Fit to real clips.
    bias: f32 = 1.0;
    /// Weight of the odds of the memory of what an object of a person looks like. Fit to real clips.
    memory: f32 = 1.6;
    /// Weight of the odds of where pixels were in an annotated frame. Chosen on real clips; insensitive from 1.6 to 2.4.
    trace: f32 = 1.6;
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
    /// Penalty of a shift of a whole object, for each coarse pixel away from the one expected, truncated differences. Fit to real clips.
    shift: f32 = 0.003;
    /// Coarse pixels are so many of the working size. Speed.
    coarse: usize = 4;

    /// Ground around an object that is looked at, pixels of the working size.
    margin: usize = 48;
    /// How far an object is searched around the place that is expected, pixels of the working size.
    reach: usize = 48;
    /// Least pixels from which colours, a place or a region are known.
    pixels: usize = 100;
    /// Pixels of a template that are compared. Speed.
    samples: usize = 100;
    /// Pixels below which a change leaves no separate part behind.
    speck: usize = 100;
    /// Radius of a click, pixels of the working size.
    click: f32 = 3.0;
    /// Largest step of the fine search for a shift, pixels of the working size. Speed.
    fine: usize = 3;
    /// Standard deviation within which a border may be off, pixels of the working size.
    border: f32 = 3.0;
    /// Cells of the memory around an object, on each side.
    cells_around: usize = 3;
    /// Largest difference of displacements that are the same, pixels of the working size.
    same_motion: f32 = 1.0;
    /// The same, as a share of the displacement.
    same_relative_motion: f32 = 0.2;
    /// How much less well the place of an object is known with each frame, pixels of the working size.
    drift: f32 = 1.0;
    /// Standard deviation of the blur of the masks and colours that are propagated, pixels of the working size.
    blur: f32 = 1.0;
    /// Distance within which parts of an object are looked for, and which parts it, in roots of its size.
    search: f64 = 1.0;
    /// Share by which that distance grows in each frame in which the object is hidden.
    search_growth: f32 = 0.1;

    /// Least share of an object that is carried onto a part of the next frame to be there.
    carried: f32 = 0.1;
    /// Least likeness of an object that comes back.
    likeness: f32 = 0.2;
    /// Share of an object below which a part of it is a fragment, and no object of its own.
    fragment: f32 = 0.2;
    /// Share of an object below which a part that its division leaves goes to the other side.
    sliver: f32 = 0.1;
    /// Share of an object that is out of sight from which it is partly hidden.
    hidden: f32 = 0.1;
    /// Share of a partly hidden object that may look different; from there on it has changed instead.
    altered: f32 = 0.2;
    /// Mean truncated difference below which a template is found close to the expected place.
    same_template: f32 = 0.2;
    /// Difference of a template's pixel that is out of sight, below the largest one; beyond that nothing is seen again.
    unseen: f32 = 0.2;
    /// How much better than usual a shift must be at which a hidden object is seen again, mean truncated difference.
    distinct: f32 = 0.1;
    /// IoU of an object before and after strokes above which they have changed only part of it. Insensitive from .65 to .8. Real.
    part: f32 = 0.65;
    /// Least probability from which an object is expected at a pixel.
    expected: f32 = 0.1;
    /// Least probability from which a pixel counts for the centre of an object.
    central: f32 = 0.2;
    /// Weight, as ground, of a pixel without a seed where a person first annotates an object that was not found.
    unannotated: f32 = 0.1;
    /// Share of `back_off` with which the colours of all places count.
    places: f32 = 0.1;
    /// Rim of a disc or a box that need not be its object, as a share of the radius.
    rim: f32 = 0.2;
    /// Share of the votes of a click's parts from which it changes a pixel. .2 and .4 cost .01 J after the first click. Real.
    votes: f32 = 0.3;
    /// Share of an object below which a separate piece goes with any stroke that takes away from it.
    piece: f32 = 0.2;
    /// Share of a separate piece's length that a stroke through it may leave.
    uncrossed: f32 = 0.2;
    /// Share of an object's full size that is left in a frame in which less is in sight: objects also become smaller by moving away.
    shrinking: f32 = 0.97;
    /// Frames in which two must move together to be one, or, in a row, apart to be two. Generated.
    lasting_motion: usize = 5;
    /// An object seen in fewer frames, neither in the first nor in the last of its scene, is none. Generated.
    lasting: usize = 4;

    /// Whether a frame is compared with earlier ones where neighbours show nothing. As the next three 1, and 0 where an ablation leaves it out.
    looks_farther: usize = 1;
    /// Whether the foreground is cut in a second round.
    cuts_twice: usize = 1;
    /// Whether parts that move together are joined.
    joins: usize = 1;
    /// Whether there are several objects, each with its number. Else all that is found is one.
    identities: usize = 1;
}

impl Model {
    /// Longer side from which on frames are large, pixels: they are halved twice, and with quality `best` their search is carried on
    /// at this size.
    pub(crate) fn detail_side(&self) -> usize {
        2 * self.work_side
    }

    /// Longer side of the working size at most in a stream of quality `fast` for large frames, pixels: those that would be halved to
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
        0.5 * self.robustness
    }

    /// Longer side of the base level at most, pixels: there the dominant motion is found and others are proposed.
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
