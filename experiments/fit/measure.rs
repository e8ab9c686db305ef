//! The scores of a model on the pairs of both folds and on generated scenes.
use std::path::Path;

use experiments::Failure;
use experiments::masks::cases::{self, Case, Data, Set};
use experiments::masks::outcome::{Method, grouped, outcome};
use experiments::parallel::in_parallel;
use veronese::{Frame, Model, Quality, SegmentOptions, segment_pair_with};

/// What a case belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// Real pairs of the sequences with even place in the alphabet.
    A,
    /// Real pairs of the other sequences.
    B,
    /// Generated scenes that constants are fitted to, beside a fold.
    Scenes,
    /// Generated scenes of the mask benchmark, which nothing is fitted to.
    Others,
}

impl Part {
    pub(crate) const ALL: [Part; 4] = [Part::A, Part::B, Part::Scenes, Part::Others];

    pub(crate) fn is_fold(self) -> bool {
        matches!(self, Part::A | Part::B)
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Part::A => "A",
            Part::B => "B",
            Part::Scenes => "scenes",
            Part::Others => "other scenes",
        }
    }
}

/// A case in memory.
pub(crate) struct Loaded {
    pub(crate) part: Part,
    /// The sequence of a pair, the name of a scene.
    pub(crate) sequence: String,
    data: Data,
    /// Whether the main subject of a pair is wanted.
    subject: bool,
}

/// The scores of a case. Those of a scene: mean IoU, and 1 where the number of motions is right.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scored {
    /// J of the groups without the background; mean IoU of a scene.
    pub(crate) j: f64,
    /// J by hand; 1 where the number of motions of a scene is right.
    pub(crate) hand: f64,
    /// F of the border.
    pub(crate) f: f64,
}

/// The cases of these parts; of the pairs a third unless all are wanted.
pub(crate) fn load(shared: &Path, parts: &[Part], whole: bool, subject: bool) -> Result<Vec<Loaded>, Failure> {
    let all = cases::all(shared, false).map_err(|error| error.to_string())?;
    let (pairs, scenes): (Vec<Case>, Vec<Case>) = all.into_iter().partition(|case| case.set == Set::Sequences);
    let mut sequences: Vec<String> = pairs.iter().map(|case| case.sequence().to_owned()).collect();
    sequences.sort();
    sequences.dedup();
    let fold = |case: &Case| match sequences.iter().position(|name| name == case.sequence()) {
        Some(k) if k % 2 == 1 => Part::B,
        _ => Part::A,
    };
    let pairs = if whole { pairs } else { cases::a_third(pairs.into_iter()) };
    let others = scenes.into_iter().filter(|case| matches!(case.set, Set::Generated | Set::Colour | Set::Bare));
    let mut chosen: Vec<(Part, Case)> = pairs.into_iter().map(|case| (fold(&case), case)).collect();
    chosen.extend(cases::for_fitting().into_iter().map(|case| (Part::Scenes, case)));
    chosen.extend(others.map(|case| (Part::Others, case)));
    chosen.retain(|(part, _)| parts.contains(part));
    in_parallel(&chosen, |(part, case)| {
        let data = case.load().map_err(|error| error.to_string())?;
        let sequence = if part.is_fold() { case.sequence().to_owned() } else { case.name.clone() };
        Ok(Loaded { part: *part, sequence, data, subject })
    })
}

/// Ways to mirror a case: across, down.
const MIRRORED: [[bool; 2]; 4] = [[false, false], [true, false], [false, true], [true, true]];

/// The images of a case that count: a search that one pixel can turn has other luck in each.
fn mirrored(data: &Data, [across, down]: [bool; 2]) -> Result<Data, Failure> {
    let [width, height] = [data.first.width(), data.first.height()];
    let from = |p: usize| {
        let (x, y) = (p % width, p / width);
        let (x, y) = (if across { width - 1 - x } else { x }, if down { height - 1 - y } else { y });
        y * width + x
    };
    let frame = |k: usize| -> Result<Frame, Failure> {
        let pixels = (0..width * height).flat_map(|p| data.rgba[k][4 * from(p)..][..4].to_vec());
        Ok(Frame::from_rgba(width, height, pixels.collect::<Vec<u8>>())?)
    };
    Ok(Data {
        rgba: [Vec::new(), Vec::new()],
        first: frame(0)?,
        second: frame(1)?,
        truth: data.truth.as_ref().map(|truth| (0..truth.len()).map(|p| truth[from(p)]).collect()),
        occluded: None,
    })
}

/// The scores of all cases with a model, each the mean over so many mirror images of it.
pub(crate) fn measure(cases: &[Loaded], model: &Model, method: Method, images: usize) -> Result<Vec<Scored>, Failure> {
    // The levels of a pair refer to their model to the end of the program; a search makes some hundred.
    let model: &'static Model = Box::leak(Box::new(*model));
    let quality = if method == Method::Fast { Quality::Fast } else { Quality::Best };
    let mean = |scored: &[Scored]| {
        let of = |figure: fn(&Scored) -> f64| scored.iter().map(figure).sum::<f64>() / scored.len() as f64;
        Scored { j: of(|s| s.j), hand: of(|s| s.hand), f: of(|s| s.f) }
    };
    let one = |case: &Loaded, image: [bool; 2]| -> Result<Scored, Failure> {
        let Loaded { part, data, subject, .. } = case;
        let data = &mirrored(data, image)?;
        let options = SegmentOptions::default().with_quality(quality).with_subject(*subject);
        let found = segment_pair_with(model, &data.first, &data.second, &options)?;
        let scores = outcome(method, data, &found.labels, &grouped(&found), 0.0);
        let (Some(single), Some(groups)) = (scores.single, scores.grouped) else {
            return Err(format!("{} has no truth", case.sequence).into());
        };
        let f = groups.boundary.unwrap_or(0.0);
        Ok(match part.is_fold() {
            true => Scored { j: groups.j_background.unwrap_or(0.0), hand: single.j_oracle.unwrap_or(0.0), f },
            false => {
                let right = f64::from(u8::from(single.found_count == single.truth_count));
                Scored { j: single.miou, hand: right, f }
            }
        })
    };
    in_parallel(cases, |case| {
        let scored: Result<Vec<Scored>, Failure> = MIRRORED[..images].iter().map(|&image| one(case, image)).collect();
        Ok(mean(&scored?))
    })
}
