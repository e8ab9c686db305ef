//! The constants of the propagation of corrections.

/// The constants of the propagation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constants {
    /// Added to all odds for the object, nats: without it masks shrink until they vanish.
    pub bias: f32,
    /// Weight of the odds of the labels carried from the frame before.
    pub carried: f32,
    /// Weight of the odds of the memory.
    pub memory: f32,
    /// Pixels of a cell of the memory below which it falls back on wider ones.
    pub back_off: f32,
    /// Share of the recent part of the memory that is left after a frame.
    pub decay: f32,
    /// Side of a cell of the memory, as a share of the working frame's longer side.
    pub cell: f32,
    /// Weight of the automatic labels.
    pub found: f32,
    /// Price of a border.
    pub smoothness: f32,
    /// Price of a shift of the whole object, per pixel away from its flow.
    pub shift: f32,
}

impl Default for Constants {
    fn default() -> Constants {
        Constants {
            bias: 1.0,
            carried: 0.5,
            memory: 1.6,
            back_off: 2.0,
            decay: 0.8,
            cell: 0.047,
            found: 1.0,
            smoothness: 3.0,
            shift: 0.5,
        }
    }
}

impl Constants {
    pub(super) fn current() -> Constants {
        let mut c = Constants::default();
        if let Ok(text) = std::env::var("VPROP") {
            for part in text.split(',') {
                let (name, value) = part.split_once('=').unwrap();
                let value: f32 = value.parse().unwrap();
                *match name { "bias" => &mut c.bias, "carried" => &mut c.carried, "memory" => &mut c.memory, "back_off" => &mut c.back_off,
                    "decay" => &mut c.decay, "cell" => &mut c.cell, "found" => &mut c.found, "smoothness" => &mut c.smoothness, "shift" => &mut c.shift, _ => panic!() } = value;
            }
        }
        c
    }
}
