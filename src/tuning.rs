//! Tuned constants that the benchmark of masks varies one at a time, to measure how much depends on them (docs/masks.md, "Sensitivity").

#[cfg(feature = "ablation")]
use std::cell::Cell;
use std::ops::Mul;

/// A tuned constant, or several of one kind. Only for measuring: without the feature `ablation` none can be varied, and nothing promises
/// that they stay.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tuned {
    /// Standard deviation of the position that a correct motion predicts.
    PositionSigma,
    /// Largest cost when motions are estimated.
    EstimationTruncation,
    /// Largest cost when pixels are labelled.
    LabelTruncation,
    /// Robustness of the alignment of a motion.
    Robustness,
    /// Prior against linear terms of a motion.
    Ridge,
    /// Blur that softens the border of a region before its motion is refined.
    RegionBlur,
    /// Window over which costs are averaged during selection.
    SelectionWindow,
    /// Window over which the gain of a motion is averaged.
    GainWindow,
    /// Gain per pixel that does not count.
    GainMargin,
    /// Price of a border between labels.
    Smoothness,
    /// Share of it that remains at the strongest edge.
    EdgeShare,
    /// Intensity step that makes an edge.
    EdgeStep,
    /// Weight of a step in colour relative to one in luminance.
    ColourShare,
    /// Price of an object's pixel on the frame's border.
    FrameBorder,
    /// Price of an object's pixel.
    ObjectBias,
    /// Largest cost of an occluded pixel.
    HiddenCost,
    /// Misfit that noise alone explains.
    ExpectedMisfit,
    /// Largest factor of the standard deviation where no motion fits.
    LargestInflation,
    /// Window in which the fit is judged.
    InflationWindow,
    /// Cost of an improbable colour.
    ColourPrice,
    /// Largest cost of a colour.
    LargestColourPrice,
    /// Nats for the parameters of a motion.
    MotionPrice,
    /// Nats per pixel of border.
    BorderPrice,
    /// Share of the frame below which a region is not an object.
    SmallestShare,
    /// Weight of a pixel of a coarser level.
    CoarsePixel,
    /// Jump of the flow, as a share of the largest, below which motions form a group.
    GroupTolerance,
    /// The largest such jump, as a share of the frame's longer side.
    LargestGroupTolerance,
}

#[cfg(feature = "ablation")]
thread_local! {
    /// The constant that is varied on this thread, and its factor.
    static VARIED: Cell<Option<(Tuned, f32)>> = const { Cell::new(None) };
}

/// The value of a tuned constant; without the feature `ablation` the one given.
#[inline(always)]
pub(crate) fn tuned<T: From<f32> + Mul<Output = T>>(constant: Tuned, value: T) -> T {
    #[cfg(feature = "ablation")]
    return match VARIED.get() {
        Some((varied, factor)) if varied == constant => value * T::from(factor),
        _ => value,
    };
    #[cfg(not(feature = "ablation"))]
    {
        let _ = constant;
        value
    }
}

/// What `work` returns with a constant multiplied by a factor.
#[cfg(feature = "ablation")]
pub(crate) fn varied<T>(constant: Tuned, factor: f32, work: impl FnOnce() -> T) -> T {
    VARIED.set(Some((constant, factor)));
    let result = work();
    VARIED.set(None);
    result
}
