//! Fits the constants of the propagation on half of the clips and reports them on the other half, and the other way round.
use experiments::Failure;
use experiments::annotator::overlap::mean;
use experiments::clips::cases::{Case, Data};
use experiments::parallel::in_parallel;
use veronese::ClipModel;
use veronese::clip::vary;

use crate::Options;
use crate::measure;
use crate::session::Session;

/// The constants of the propagation that are fitted.
const FITTED: [&str; 9] =
    ["bias", "trust", "memory", "back_off", "memory_decay", "cell", "smoothness", "shift", "automatic"];
/// Factors that a constant is tried with, one constant after another.
const FACTORS: [f64; 2] = [1.25, 0.8];
/// Gain of a factor below which the constant stays: chance.
const LEAST: f64 = 0.0005;

/// A clip that is segmented.
struct Opened<'a> {
    case: &'a Case,
    data: &'a Data,
    session: Session<'a>,
}

/// Mean J of a mask given and of one round of strokes.
fn score(clips: &[&Opened<'_>], options: &Options, model: ClipModel) -> Result<f64, Failure> {
    let of_clip = |clip: &&Opened<'_>| {
        vary(model);
        measure::score(clip.case, clip.data, &clip.session, options)
    };
    Ok(mean(&in_parallel(clips, of_clip)?))
}

/// The constants fitted to some clips, with their score there.
fn fitted(clips: &[&Opened<'_>], options: &Options) -> Result<(ClipModel, f64), Failure> {
    let mut model = options.model;
    let mut best = score(clips, options, model)?;
    for name in FITTED {
        for factor in FACTORS {
            let mut other = model;
            // On in the same direction while that helps.
            loop {
                let value = factor * other.get(name).unwrap_or(0.0);
                other.set(name, value);
                let now = score(clips, options, other)?;
                println!("{name} {value:.4}: {now:.4}");
                if now < best + LEAST {
                    break;
                }
                (best, model) = (now, other);
            }
        }
    }
    Ok((model, best))
}

pub(crate) fn run(cases: &[Case], options: &Options) -> Result<(), Failure> {
    let options = Options { rounds: 1, ..options.clone() };
    let data = in_parallel(cases, Case::load)?;
    let cases: Vec<(&Case, &Data)> = cases.iter().zip(&data).collect();
    let clips =
        in_parallel(&cases, |&(case, data)| Ok(Opened { case, data, session: measure::open(case, data, &options)? }))?;
    let mut text = String::from("| constant | used |");
    let mut rows: Vec<String> =
        FITTED.iter().map(|name| format!("| {name} | {} |", options.model.get(name).unwrap_or(f64::NAN))).collect();
    let mut scores = String::new();
    for (held_out, fold) in ["first", "second"].into_iter().enumerate() {
        let half = |k: usize| clips.iter().skip(k).step_by(2).collect::<Vec<_>>();
        let (own, other) = (half(1 - held_out), half(held_out));
        let before = [score(&own, &options, options.model)?, score(&other, &options, options.model)?];
        let (model, fitted) = fitted(&own, &options)?;
        let after = score(&other, &options, model)?;
        text += &format!(" fitted without the {fold} half |");
        rows.iter_mut()
            .zip(FITTED)
            .for_each(|(row, name)| *row += &format!(" {:.3} |", model.get(name).unwrap_or(f64::NAN)));
        scores += &format!(
            "- without the {fold} half: {:.3} → {fitted:.3} on the {} clips fitted to, {:.3} → {after:.3} on the {} held out\n",
            before[0],
            own.len(),
            before[1],
            other.len()
        );
    }
    text += &format!("\n{}\n{}\n\n{scores}", "|---".repeat(4) + "|", rows.join("\n"));
    print!("\n{text}");
    Ok(())
}
