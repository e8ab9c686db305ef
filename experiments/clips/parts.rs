//! The parts of the clip segmenter that can be left out, and other values of its constants.

use veronese::ClipModel;

/// A part: its name, what is left without it, and the values of constants that leave it nothing to do.
pub(crate) struct Part {
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    values: &'static [(&'static str, f64)],
}

pub(crate) const PARTS: [Part; 5] = [
    // The motions of backward pairs are still used.
    Part { name: "both-directions", title: "without the evidence of backward pairs", values: &[("backward", 0.0)] },
    Part { name: "carrying", title: "without the evidence of other frames", values: &[("decay", 0.0)] },
    Part { name: "colours", title: "without colours", values: &[("pixels", f64::MAX)] },
    Part { name: "second-round", title: "without the second round", values: &[("rounds", 1.0)] },
    Part { name: "grouping", title: "without grouping", values: &[("together", f64::MAX), ("lasting", 0.0)] },
];

impl Part {
    /// The constants without it.
    pub(crate) fn left_out_of(&self, mut model: ClipModel) -> ClipModel {
        self.values.iter().for_each(|(name, value)| {
            model.set(name, *value);
        });
        model
    }
}

/// Sets a constant as `NAME=VALUE` says.
pub(crate) fn set(model: &mut ClipModel, text: &str) -> Result<(), String> {
    let (name, value) = text.split_once('=').ok_or(format!("--set needs NAME=VALUE, not '{text}'."))?;
    let number = value.parse().map_err(|_| format!("'{value}' is no number."))?;
    if model.set(name, number) { Ok(()) } else { Err(format!("There is no constant '{name}'.")) }
}
