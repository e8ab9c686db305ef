//! The constants of the propagation of corrections.

/// The constants of the propagation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Constants {
    /// Added to all odds for the object, nats: without it masks shrink until they vanish.
    pub(super) bias: f32,
    /// Weight of the odds of the labels carried from the frame before.
    pub(super) carried: f32,
    /// Weight of the odds of the memory.
    pub(super) memory: f32,
    /// Pixels of a cell of the memory below which it falls back on wider ones.
    pub(super) back_off: f32,
    /// Share of the recent part of the memory that is left after a frame.
    pub(super) decay: f32,
    /// Side of a cell of the memory, as a share of the working frame's longer side.
    pub(super) cell: f32,
    /// Weight of the automatic labels.
    pub(super) found: f32,
    /// Price of a border.
    pub(super) smoothness: f32,
    /// Price of a shift of the whole object, for each coarse pixel away from the one expected.
    pub(super) shift: f32,
    /// Weight of a pixel of a frame in which the object was found automatically.
    pub(super) survey: f32,
}

impl Constants {
    const fn new(
        [bias, carried, memory, back_off, decay, cell, found, smoothness, shift, survey]: [f32; 10],
    ) -> Constants {
        Constants { bias, carried, memory, back_off, decay, cell, found, smoothness, shift, survey }
    }
}

/// The values, in the order of the names.
const FITTED: [f32; 10] = [1.0, 0.5, 1.6, 2.0, 0.8, 0.047, 1.0, 3.0, 0.003, 0.3];

#[cfg(feature = "ablation")]
thread_local! {
    static VARIED: std::cell::Cell<[f32; 10]> = const { std::cell::Cell::new(FITTED) };
}

/// The constants; without the feature `ablation` those fitted.
pub(super) fn constants() -> Constants {
    #[cfg(feature = "ablation")]
    return Constants::new(VARIED.get());
    #[cfg(not(feature = "ablation"))]
    Constants::new(FITTED)
}

/// Names and values of the constants of the propagation of corrections, for the program that fits them.
#[cfg(feature = "ablation")]
pub fn propagation_constants() -> [(&'static str, f32); 10] {
    let names = ["bias", "carried", "memory", "back_off", "decay", "cell", "found", "smoothness", "shift", "survey"];
    std::array::from_fn(|k| (names[k], FITTED[k]))
}

/// Sets the constants for this thread, in the order of [`propagation_constants`].
#[cfg(feature = "ablation")]
pub fn vary_propagation(values: [f32; 10]) {
    VARIED.set(values);
}
