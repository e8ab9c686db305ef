//! The cases of the measurement, by name, so that the measurement stays the same and stays short.
use std::collections::BTreeSet;
use std::path::Path;

use experiments::Failure;
use experiments::clips;
use experiments::masks::cases::{Case, Set, a_third, all};
use experiments::masks::outcome::{Method, of_model};
use experiments::score::report::Entry;
use veronese::clip::{ClipOptions, ClipSegmenter};
use veronese::{Model, Quality, SegmentOptions};

/// Clips on which constants were set: every second one of the ten.
const TUNED_ON: [&str; 5] = ["boat", "car-turn", "flamingo", "kite-walk", "soccerball"];
/// Clips on which none was: every fourth of the twenty.
const NOT_TUNED_ON: [&str; 5] = ["dance-jump", "horsejump-low", "motocross-bumps", "rollerblade", "train"];
/// Clips that are measured with quality *best* too.
const WITH_BEST: [&str; 3] = ["flamingo", "horsejump-low", "rollerblade"];
/// Frames of a clip, from its first.
const FRAMES: usize = 16;

/// How many generated scenes of each set: those of 320 × 240 pixels where there are several sizes.
const SCENES: [(Set, usize); 5] =
    [(Set::Generated, 6), (Set::Colour, 6), (Set::Bare, 6), (Set::Slow, 1), (Set::Still, 1)];
const SCENE_WIDTH: &str = "-320-";

/// One case with one quality.
pub(crate) struct Job {
    /// The row of the table.
    part: &'static str,
    quality: Quality,
    source: Source,
}

enum Source {
    Pair(Case),
    Clip(clips::cases::Case),
}

/// All jobs, the longest first, and what of `shared` is not there.
pub(crate) fn jobs(shared: &Path) -> Result<(Vec<Job>, Vec<String>), Failure> {
    let (mut jobs, mut missing) = (Vec::new(), Vec::new());
    let found = clips::cases::all(shared, false)?;
    let mut clip = |part, quality, name: &&str| match found.iter().find(|case| case.name == *name) {
        Some(case) => jobs.push(Job { part, quality, source: Source::Clip(case.clone()) }),
        None => missing.push((*name).to_owned()),
    };
    WITH_BEST.iter().for_each(|name| clip("clips, three of the ten", Quality::Best, name));
    TUNED_ON.iter().for_each(|name| clip("clips, tuned on", Quality::Fast, name));
    NOT_TUNED_ON.iter().for_each(|name| clip("clips, not tuned on", Quality::Fast, name));

    let cases = all(shared, false).map_err(|error| error.to_string())?;
    let mut both = |part, case: &Case| {
        let job = |quality| Job { part, quality, source: Source::Pair(case.clone()) };
        jobs.extend([Quality::Best, Quality::Fast].map(job));
    };
    let pairs = a_third(cases.iter().filter(|case| case.set == Set::Sequences).cloned());
    // Pairs of one sequence are alike, so that folds are made of whole sequences.
    let sequences: BTreeSet<&str> = pairs.iter().map(Case::sequence).collect();
    for pair in &pairs {
        let even = sequences.range(..pair.sequence()).count().is_multiple_of(2);
        both(if even { "pairs, first fold" } else { "pairs, second fold" }, pair);
    }
    if pairs.is_empty() {
        missing.push("pairs".into());
    }
    for (set, count) in SCENES {
        let sized = |case: &&Case| set == Set::Bare || case.name.contains(SCENE_WIDTH);
        cases.iter().filter(|case| case.set == set).filter(sized).take(count).for_each(|case| both("scenes", case));
    }
    missing.sort();
    missing.dedup();
    Ok((jobs, missing))
}

impl Job {
    pub(crate) fn name(&self) -> &str {
        match &self.source {
            Source::Pair(case) => &case.name,
            Source::Clip(case) => &case.name,
        }
    }

    pub(crate) fn part(&self) -> &'static str {
        self.part
    }

    /// Segments the case and compares with the truth.
    pub(crate) fn measure(&self) -> Result<Entry, Failure> {
        let mut entry = Entry {
            part: self.part.into(),
            case: self.name().into(),
            sequence: self.name().into(),
            quality: if self.quality == Quality::Best { "best" } else { "fast" }.into(),
            j: None,
            by_hand: None,
            f: None,
            n_right: None,
        };
        match &self.source {
            Source::Pair(case) => {
                let method = if self.quality == Quality::Best { Method::Best } else { Method::Fast };
                let data = case.load().map_err(|error| error.to_string())?;
                let outcome = of_model(&Model::DEFAULT, method, &data)?;
                let (Some(single), Some(grouped)) = (outcome.single, outcome.grouped) else {
                    return Err(format!("{} has no true labels", case.name).into());
                };
                if case.set.is_scene() {
                    (entry.j, entry.f) = (Some(single.miou), single.boundary);
                    entry.n_right = Some(f64::from(u8::from(single.found_count == single.truth_count)));
                } else {
                    entry.sequence = case.sequence().into();
                    (entry.j, entry.by_hand, entry.f) = (grouped.j_background, single.j_oracle, grouped.boundary);
                }
            }
            Source::Clip(case) => {
                let mut data = case.load()?;
                data.frames.truncate(FRAMES);
                data.truths.truncate(FRAMES);
                let width = data.frames.first().ok_or_else(|| format!("{} has no frames", case.name))?.width();
                let pair = SegmentOptions::default().with_quality(self.quality);
                let segmenter = ClipSegmenter::new(ClipOptions::default().with_pair(pair))?;
                let found = clips::methods::clip_labels(segmenter, &data.frames, None)?;
                let scores = clips::scores::scores(&data.truths, &found, width);
                (entry.j, entry.by_hand, entry.f) = (Some(scores.j_auto), Some(scores.j_tracks), scores.f_auto);
            }
        }
        Ok(entry.rounded())
    }
}
