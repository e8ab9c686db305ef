//! The ablation: the same cases with one part of the pipeline left out.
use experiments::Failure;
use experiments::left_out::{Figures, Measured, Row, Worth, timed, with, worth};
use experiments::masks::cases::{Case, Set, a_third};
use experiments::masks::outcome::{Method, Outcome, grouped, outcome, segmented};
use experiments::parallel::in_parallel;
use veronese::Model;

/// The rows of the table, in its order.
const LEFT_OUT: [Row; 20] = [
    ("nothing", &[]),
    ("gain and bias", &[("largest_gain", 1.0)]),
    ("algebraic candidates", &[("degrees", 0.0)]),
    ("all windows but 6", &[("tiles", 6.0), ("tiles_fast", 3.0)]),
    ("algebraic candidates and all windows but 6", &[("degrees", 0.0), ("tiles", 6.0), ("tiles_fast", 3.0)]),
    ("candidates from windows", &[("tiles", 0.0), ("tiles_fast", 0.0)]),
    ("second solution at rest", &[("solves_at_rest", 0.0)]),
    ("trial of a static background", &[("tries_static", 0.0)]),
    ("drafts", &[("drafts", 0.0)]),
    ("detail pass", &[("adds_detail", 0.0)]),
    ("smoothness", &[("smoothness", 0.0), ("smoothness_halved", 0.0)]),
    ("smoothness lower at edges", &[("noise_steps", 1e9)]),
    ("occlusion", &[("hidden_cost", f64::INFINITY), ("visibility_rounds", 0.0), ("visibility_rounds_fast", 0.0)]),
    ("return of shadows", &[("light_penalty", f64::INFINITY)]),
    ("larger variance where nothing fits", &[("largest_inflation", 1.0)]),
    ("penalty of borders", &[("border_penalty", 0.0)]),
    ("splitting", &[("splits", 0.0)]),
    ("merging", &[("merges", 0.0)]),
    ("colour", &[("colour_weight", 0.0)]),
    ("guided upsampling", &[("flat_variance", f64::INFINITY)]),
];

/// The width of the scenes that are measured, in their names.
const SCENE_WIDTH: &str = "-320-";
/// How many scenes of each set: the large ones are there for the detail pass.
const SCENES: [(Set, usize); 4] = [(Set::Generated, 6), (Set::Colour, 6), (Set::Bare, 6), (Set::Large, 2)];

/// The cases that are measured: a third of the pairs, two of each sequence, and some scenes.
fn chosen(cases: Vec<Case>) -> Vec<Case> {
    let (pairs, scenes): (Vec<Case>, Vec<Case>) = cases.into_iter().partition(|case| case.set == Set::Sequences);
    let mut chosen = a_third(pairs.into_iter());
    for (set, count) in SCENES {
        let sized = |case: &&Case| matches!(set, Set::Bare | Set::Large) || case.name.contains(SCENE_WIDTH);
        chosen.extend(scenes.iter().filter(|case| case.set == set).filter(sized).take(count).cloned());
    }
    chosen
}

/// The figures of a case, named by what it is.
fn figures(set: Set, Outcome { single, grouped, .. }: &Outcome) -> Figures {
    let (Some(single), Some(grouped)) = (single, grouped) else { return Figures::new() };
    let of = |name, figure: Option<f64>| Some((name, figure?));
    match set {
        Set::Sequences => {
            let all = [of("j", grouped.j_background), of("f", grouped.boundary), of("byHand", single.j_oracle)];
            all.into_iter().flatten().collect()
        }
        Set::Bare => Figures::from([("bare", single.miou)]),
        Set::Large => Figures::from([("large", single.miou)]),
        _ => Figures::from([("scenes", single.miou)]),
    }
}

/// Measures the rows on those of the cases that are chosen for it.
pub(crate) fn measure(cases: Vec<Case>) -> Result<Vec<Worth>, Failure> {
    // Models are kept to the end of the program.
    let model = |row| &*Box::leak(Box::new(with(Model::DEFAULT, row, Model::set)));
    let models: Vec<&'static Model> = LEFT_OUT.iter().map(model).collect();
    let measured: Vec<[Measured; 2]> = in_parallel(&chosen(cases), |case| {
        let data = case.load().map_err(|error| error.to_string())?;
        let with_method = |method: Method| -> Result<Measured, Failure> {
            let row = |model: &&'static Model| {
                let (found, milliseconds) = timed(|| segmented(model, method, &data));
                let found = found?;
                let outcome = outcome(method, &data, &found.labels, &grouped(&found), milliseconds);
                Ok((figures(case.set, &outcome), milliseconds))
            };
            let rows = models.iter().map(row).collect::<Result<_, Failure>>()?;
            Ok(Measured { table: method.name(), sequence: case.sequence().to_owned(), rows })
        };
        eprintln!("{}", case.name);
        Ok([with_method(Method::Best)?, with_method(Method::Fast)?])
    })?;
    Ok(worth(&LEFT_OUT, &measured.into_iter().flatten().collect::<Vec<_>>()))
}
