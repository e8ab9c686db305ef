//! What each part of the pipeline is worth: the same cases without it.

use veronese::Part;

use crate::cases::{Case, Set};
use crate::measure::{Measured, Variant};
use crate::summary::Summary;

/// The forms of the pipeline, in the order of the table.
const VARIANTS: [(Variant, &str); 15] = [
    (Variant::Whole, "**everything**"),
    (Variant::Without(Part::Brightness), "gain and bias"),
    (Variant::Without(Part::StaticHypothesis), "the hypothesis of a static background"),
    (Variant::Without(Part::Algebra), "the algebraic start"),
    (Variant::Without(Part::Windows), "proposals from windows"),
    (Variant::Without(Part::FinerLevels), "proposals on finer levels"),
    (Variant::Without(Part::Refinement), "refinement on the images after selection"),
    (Variant::Without(Part::Coherence), "spatial coherence"),
    (Variant::Without(Part::Edges), "coherence that respects edges"),
    (Variant::Without(Part::Visibility), "visibility"),
    (Variant::Without(Part::Splitting), "splitting"),
    (Variant::Without(Part::ModelSelection), "the last model selection"),
    (Variant::Without(Part::Colour), "colour"),
    (Variant::Without(Part::GuidedEnlarging), "guided enlarging"),
    (Variant::ThreeFrames, "*with the frame before*"),
];

/// One row: the figures of generated scenes, of those with a bare ground, and of real pairs.
pub(crate) struct Worth {
    pub(crate) title: &'static str,
    pub(crate) scenes: Summary,
    /// The scenes of a bare ground, which need the hypothesis of a static background.
    pub(crate) bare: Summary,
    /// None where there are no real pairs.
    pub(crate) pairs: Option<Summary>,
}

/// The forms of the pipeline.
pub(crate) fn variants() -> Vec<Variant> {
    VARIANTS.map(|(variant, _)| variant).to_vec()
}

/// Whether a case takes part: generated ones of one to four objects, those with a bare ground, and the real pairs.
pub(crate) fn takes_part(case: &Case) -> bool {
    matches!(case.set, Set::Generated | Set::Colour | Set::Bare | Set::Pairs)
}

/// The rows of the table; none where nothing took part.
pub(crate) fn worths(measured: &[Measured]) -> Vec<Worth> {
    let mut rows = Vec::new();
    for (k, (variant, title)) in VARIANTS.into_iter().enumerate() {
        let of = |sets: &[Set]| {
            let own = measured.iter().filter(|one| sets.contains(&one.case.set));
            Summary::of(own.filter_map(|one| one.variants.get(k).map(|outcome| (&one.case, outcome))))
        };
        // The real pairs have no frame before.
        let pairs = Some(of(&[Set::Pairs])).filter(|pairs| pairs.cases > 0 && variant != Variant::ThreeFrames);
        let (scenes, bare) = (of(&[Set::Generated, Set::Colour]), of(&[Set::Bare]));
        if scenes.cases > 0 || bare.cases > 0 || pairs.is_some() {
            rows.push(Worth { title, scenes, bare, pairs });
        }
    }
    rows
}
