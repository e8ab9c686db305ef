//! The ablation: the same cases with one part of the pipeline left out.

use crate::cases::{Case, Set};
use crate::measure::Measured;
use crate::outcome::Variant;
use crate::summary::Summary;

/// What is left out, and the constants that leave it out, in the order of the table.
const LEFT_OUT: [(&str, &[(&str, f64)]); 12] = [
    ("**nothing**", &[]),
    ("gain and bias", &[("largest_gain", 1.0)]),
    ("static background hypothesis", &[("rest", 0.0)]),
    ("algebraic candidates", &[("degrees", 0.0)]),
    ("candidates from windows", &[("tiles", 0.0), ("tiles_fast", 0.0)]),
    ("smoothness", &[("smoothness", 0.0), ("smoothness_halved", 0.0)]),
    ("smoothness lower at edges", &[("noise_steps", 1e9)]),
    ("occlusion handling and return of shadows", &[("unexplained", 1e3)]),
    ("larger variance where nothing fits", &[("largest_inflation", 1.0)]),
    ("price of borders", &[("border_price", 0.0)]),
    ("colour", &[("colour_price", 0.0)]),
    ("guided upsampling", &[("flat_variance", 1e9)]),
];

/// One form of the pipeline: its scores with `best` and with `fast`.
pub(crate) struct Worth {
    pub(crate) title: &'static str,
    pub(crate) with: [Scored; 2],
}

/// The scores of generated scenes, of scenes with a bare ground, and of the real pairs of the sequences.
pub(crate) struct Scored {
    pub(crate) scenes: Summary,
    /// The scenes with a bare ground, which need the static background hypothesis.
    pub(crate) bare: Summary,
    /// `None` if there are no real pairs.
    pub(crate) pairs: Option<Summary>,
}

/// The variants of the pipeline.
pub(crate) fn variants() -> Vec<Variant> {
    LEFT_OUT.iter().map(|(_, values)| Variant::with(values)).collect()
}

/// Whether the ablation includes a case: generated scenes of one to four objects, those with a bare ground, and the real pairs
/// of the sequences.
pub(crate) fn takes_part(case: &Case) -> bool {
    matches!(case.set, Set::Generated | Set::Colour | Set::Bare | Set::Sequences)
}

/// The rows of the table; empty if no case is included.
pub(crate) fn worths(measured: &[Measured]) -> Vec<Worth> {
    let mut rows = Vec::new();
    for (k, (title, _)) in LEFT_OUT.into_iter().enumerate() {
        let scored = |quality: usize| {
            let of = |sets: &[Set]| {
                let own = measured.iter().filter(|one| sets.contains(&one.case.set));
                Summary::of(own.filter_map(|one| one.variants.get(k).map(|both| (&one.case, &both[quality]))))
            };
            let pairs = Some(of(&[Set::Sequences])).filter(|pairs| pairs.cases > 0);
            Scored { scenes: of(&[Set::Generated, Set::Colour]), bare: of(&[Set::Bare]), pairs }
        };
        let with = [0, 1].map(scored);
        if with[0].scenes.cases > 0 || with[0].bare.cases > 0 || with[0].pairs.is_some() {
            rows.push(Worth { title, with });
        }
    }
    rows
}
