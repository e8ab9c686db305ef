//! The ablation: the same cases with one part of the pipeline left out.

use serde::Serialize;
use veronese::Model;

use crate::Failure;
use crate::cases::{Case, Set, a_third};
use crate::outcome::{Method, Outcome, of_model};
use crate::parallel::in_parallel;
use crate::summary::Summary;

/// What is left out, and the constants that leave it out, in the order of the table.
const LEFT_OUT: [(&str, &[(&str, f64)]); 11] = [
    ("nothing", &[]),
    ("gain and bias", &[("largest_gain", 1.0)]),
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
#[derive(Serialize)]
pub(crate) struct Worth {
    without: &'static str,
    best: Scored,
    fast: Scored,
}

/// The scores of generated scenes, of scenes with a bare ground, and of the real pairs of the sequences.
#[derive(Serialize)]
pub(crate) struct Scored {
    scenes: Summary,
    /// The scenes with a bare ground, which need the static background hypothesis.
    bare: Summary,
    /// `None` if there are no real pairs.
    pairs: Option<Summary>,
}

/// Of the pairs that the score measures every fourth: eleven forms of the pipeline take their time.
const EVERY: usize = 4;

/// The cases that are measured: generated scenes, those with a bare ground, and a few pairs of some sequences.
fn chosen(cases: Vec<Case>) -> Vec<Case> {
    let (pairs, mut chosen): (Vec<Case>, Vec<Case>) = cases.into_iter().partition(|case| case.set == Set::Sequences);
    chosen.retain(|case| matches!(case.set, Set::Generated | Set::Colour | Set::Bare));
    chosen.extend(a_third(pairs.into_iter()).into_iter().step_by(EVERY));
    chosen
}

/// The model with some constants set to other values.
fn with(values: &[(&str, f64)]) -> &'static Model {
    let mut model = Model::DEFAULT;
    for (name, value) in values {
        assert!(model.set(name, *value), "there is no constant {name}");
    }
    // Kept to the end of the program: there are a dozen.
    Box::leak(Box::new(model))
}

/// Measures the rows of the table on those of the cases that are chosen for it.
pub(crate) fn measure(cases: Vec<Case>) -> Result<Vec<Worth>, Failure> {
    let cases = &chosen(cases);
    let models: Vec<&'static Model> = LEFT_OUT.iter().map(|(_, values)| with(values)).collect();
    let measured: Vec<Vec<[Outcome; 2]>> = in_parallel(cases, |case| {
        let data = case.load().map_err(|error| error.to_string())?;
        let with_both = |&model: &&'static Model| -> veronese::Result<[Outcome; 2]> {
            Ok([of_model(model, Method::Best, &data)?, of_model(model, Method::Fast, &data)?])
        };
        let outcomes = models.iter().map(with_both).collect::<Result<_, _>>()?;
        eprintln!("{}", case.name);
        Ok(outcomes)
    })?;
    let worth = |(k, (without, _)): (usize, &(&'static str, _))| {
        let scored = |quality: usize| {
            let of = |sets: &[Set]| {
                let own = cases.iter().zip(&measured).filter(|(case, _)| sets.contains(&case.set));
                Summary::of(own.map(|(case, outcomes)| (case, &outcomes[k][quality])))
            };
            let pairs = Some(of(&[Set::Sequences])).filter(|pairs| pairs.cases > 0);
            Scored { scenes: of(&[Set::Generated, Set::Colour]), bare: of(&[Set::Bare]), pairs }
        };
        let [best, fast] = [0, 1].map(scored);
        Worth { without, best, fast }
    };
    Ok(LEFT_OUT.iter().enumerate().map(worth).collect())
}
