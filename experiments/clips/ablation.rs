//! The ablation: the same clips with one part of the way from pairs to objects left out. Parts that pairs are solved with are left out in
//! the ablation of masks.
use experiments::Failure;
use experiments::clips::cases::{Case, Data, generated};
use experiments::clips::scores::{Identities, Scores, scores};
use experiments::left_out::{Figures, Measured, Row, Worth, timed, with, worth};
use experiments::parallel::in_parallel;
use veronese::clip::{ClipOptions, ClipSegmenter, FramePairs, vary};
use veronese::{ClipModel, Frame};

/// The rows of the table, in its order.
const LEFT_OUT: [Row; 9] = [
    ("nothing", &[]),
    ("evidence of other frames", &[("decay", 0.0)]),
    ("second round", &[("cuts_twice", 0.0)]),
    ("comparisons with earlier frames", &[("looks_farther", 0.0)]),
    ("identities", &[("identities", 0.0)]),
    ("recognition of what was hidden", &[("likeness", 2.0)]),
    ("parting", &[("fragment", 2.0)]),
    ("joining of parts", &[("joins", 0.0)]),
    ("dropping of what lasts a few frames", &[("lasting", 0.0)]),
];

/// Every third clip is measured.
const EVERY: usize = 3;
/// Share of the usual speed of slow clips.
const SLOW: f64 = 0.25;
/// Frames of a real clip, from its first.
const FRAMES: usize = 16;

/// The clips of each table. Generated ones of the usual speed are others than the slow ones.
fn chosen(cases: Vec<Case>) -> Vec<(&'static str, Case)> {
    let (usual, real): (Vec<Case>, Vec<Case>) = cases.into_iter().partition(Case::is_generated);
    let mut slow = generated(SLOW);
    slow.retain(|case| usual.iter().any(|usual| usual.name == case.name));
    let named = |table, cases: Vec<Case>| cases.into_iter().step_by(EVERY).map(move |case| (table, case));
    let usual = usual.into_iter().skip(1).collect();
    named("real", real).chain(named("slow", slow)).chain(named("generated", usual)).collect()
}

/// What pairs tell, unless it is known, and the labels of every frame.
fn segmented(frames: &[Frame], known: &[FramePairs]) -> veronese::Result<(Vec<FramePairs>, Vec<Vec<u8>>)> {
    let mut segmenter = ClipSegmenter::new(ClipOptions::default())?;
    let mut told = Vec::new();
    for (t, frame) in frames.iter().enumerate() {
        match known.get(t) {
            Some(pairs) => segmenter.push_known(frame.clone(), pairs)?,
            None => told.push(segmenter.push(frame.clone())?),
        }
    }
    let clip = segmenter.conclude();
    let labels = frames.iter().enumerate().map(|(t, frame)| Ok(clip.frame(t, frame)?.labels));
    Ok((told, labels.collect::<veronese::Result<_>>()?))
}

fn figures(scores: &Scores) -> Figures {
    let own = [("auto", Some(scores.j_auto)), ("fAuto", scores.f_auto)];
    let of = |i: Identities| [("assigned", i.assigned), ("idf1", i.idf1), ("lost", i.lost), ("switches", i.switches)];
    let of_identities = scores.identities.map(of).into_iter().flatten();
    own.into_iter().filter_map(|(name, figure)| Some((name, figure?))).chain(of_identities).collect()
}

/// Measures the rows on those of the clips that are chosen for it, and on slow ones.
pub(crate) fn measure(cases: Vec<Case>) -> Result<Vec<Worth>, Failure> {
    let measured = in_parallel(&chosen(cases), |(table, case)| {
        let Data { mut frames, mut truths } = case.load()?;
        if !case.is_generated() {
            frames.truncate(FRAMES);
            truths.truncate(FRAMES);
        }
        let width = frames.first().ok_or_else(|| format!("{} has no frames", case.name))?.width();
        let figures = |labels: &[Vec<u8>]| figures(&scores(&truths, labels, width));
        vary(ClipModel::DEFAULT);
        let (all, time) = timed(|| segmented(&frames, &[]));
        let (pairs, all) = all?;
        let of_all = figures(&all);
        // No row changes what pairs tell: they are not solved again.
        let row = |row: &Row| {
            vary(with(ClipModel::DEFAULT, row, ClipModel::set));
            let (found, milliseconds) = timed(|| segmented(&frames, &pairs));
            let (_, labels) = found?;
            Ok((if labels == all { of_all.clone() } else { figures(&labels) }, milliseconds))
        };
        let mut rows = LEFT_OUT.iter().map(row).collect::<Result<Vec<_>, Failure>>()?;
        let of_pairs = time - rows[0].1;
        rows.iter_mut().for_each(|(_, milliseconds)| *milliseconds += of_pairs);
        eprintln!("{table}: {}", case.name);
        Ok(Measured { table, sequence: case.name.clone(), rows })
    })?;
    Ok(worth(&LEFT_OUT, &measured))
}
