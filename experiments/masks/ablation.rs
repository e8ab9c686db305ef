//! The ablation: the same cases with one part of the pipeline left out.

use veronese::Part;

use crate::cases::{Case, Set};
use crate::measure::Measured;
use crate::outcome::Variant;
use crate::summary::Summary;

/// The variants of the pipeline, in the order of the table.
const VARIANTS: [(Variant, &str); 16] = [
    (Variant::Whole, "**nothing**"),
    (Variant::Without(Part::Brightness), "gain and bias"),
    (Variant::Without(Part::StaticHypothesis), "static background hypothesis"),
    (Variant::Without(Part::Algebra), "algebraic candidates"),
    (Variant::Without(Part::Windows), "candidates from windows"),
    (Variant::Without(Part::FinerLevels), "candidates on finer levels"),
    (Variant::Without(Part::Refinement), "refinement on the images"),
    (Variant::Without(Part::Coherence), "smoothness"),
    (Variant::Without(Part::Edges), "smoothness lower at edges"),
    (Variant::Without(Part::Visibility), "occlusion handling"),
    (Variant::Without(Part::Splitting), "region splitting"),
    (Variant::Without(Part::ModelSelection), "label cost"),
    (Variant::Without(Part::Colour), "colour"),
    (Variant::Without(Part::Shadows), "return of shadows"),
    (Variant::Without(Part::GuidedEnlarging), "guided upsampling"),
    (Variant::ThreeFrames, "*with the frame before*"),
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
    VARIANTS.map(|(variant, _)| variant).to_vec()
}

/// Whether the ablation includes a case: generated scenes of one to four objects, those with a bare ground, and the real pairs
/// of the sequences.
pub(crate) fn takes_part(case: &Case) -> bool {
    matches!(case.set, Set::Generated | Set::Colour | Set::Bare | Set::Sequences)
}

/// The rows of the table; empty if no case is included.
pub(crate) fn worths(measured: &[Measured]) -> Vec<Worth> {
    let mut rows = Vec::new();
    for (k, (variant, title)) in VARIANTS.into_iter().enumerate() {
        let scored = |quality: usize| {
            let of = |sets: &[Set]| {
                let own = measured.iter().filter(|one| sets.contains(&one.case.set));
                Summary::of(own.filter_map(|one| one.variants.get(k).map(|both| (&one.case, &both[quality]))))
            };
            // The real pairs have no frame before.
            let pairs = Some(of(&[Set::Sequences])).filter(|pairs| pairs.cases > 0 && variant != Variant::ThreeFrames);
            Scored { scenes: of(&[Set::Generated, Set::Colour]), bare: of(&[Set::Bare]), pairs }
        };
        let with = [0, 1].map(scored);
        if with[0].scenes.cases > 0 || with[0].bare.cases > 0 || with[0].pairs.is_some() {
            rows.push(Worth { title, with });
        }
    }
    rows
}
