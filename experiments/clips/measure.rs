//! One clip after another through every method, and what comes out as figures.
use std::fs;
use std::path::Path;

use experiments::Result;
use experiments::clips::cases::{Case, Data};
use experiments::clips::methods::{Method, found};
use experiments::clips::scores::{Scores, scores};
use experiments::parallel::in_parallel;
use veronese::codecs::encode_grey_png;

use crate::strips::strip;

/// What a method found in a clip, in figures.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outcome {
    pub(crate) method: Method,
    pub(crate) scores: Scores,
    /// Of one frame.
    pub(crate) milliseconds: Option<f64>,
}

/// A clip with all its outcomes.
pub(crate) struct Measured {
    pub(crate) case: Case,
    pub(crate) size: [usize; 2],
    pub(crate) frames: usize,
    pub(crate) outcomes: Vec<Outcome>,
    /// Every fourth frame, our labels and the true ones, as a PNG file.
    pub(crate) strip: Vec<u8>,
}

impl Measured {
    pub(crate) fn of(&self, method: Method) -> Option<&Outcome> {
        self.outcomes.iter().find(|outcome| outcome.method == method)
    }

    /// The outcome of the clip segmenter, or of its stand-in.
    pub(crate) fn own(&self) -> Option<&Outcome> {
        self.outcomes.first()
    }
}

/// Some methods on all clips. Labels are written to `labels/METHOD/CLIP/NNNNN.png` in `out`; what other programs found is read from
/// there. What pairs of the real clips told is kept in `pairs`, where the annotator benchmark looks for it.
pub(crate) fn all(cases: &[Case], methods: &[Method], out: &Path, pairs: Option<&Path>) -> Result<Vec<Measured>> {
    in_parallel(cases, |case| {
        let measured = measure(case, methods, &out.join("labels"), pairs)?;
        let main = measured.own().map(|own| format!("{} {:.3}", own.method.name(), own.scores.j_tracks));
        eprintln!("{}: J of tracks, {}", case.name, main.unwrap_or_default());
        Ok(measured)
    })
}

fn measure(case: &Case, methods: &[Method], labels: &Path, pairs: Option<&Path>) -> Result<Measured> {
    let data = case.load()?;
    let first = data.frames.first().ok_or_else(|| format!("{} has no frames", case.name))?;
    let size = [first.width(), first.height()];
    let kept = pairs.filter(|_| !case.is_generated()).map(|pairs| pairs.join(format!("{}-best", case.name)));
    let (mut outcomes, mut picture) = (Vec::new(), None);
    for &method in methods {
        let Some(found) = found(method, &case.name, &data, labels, kept.as_deref())? else { continue };
        let scores = scores(&data.truths, &found.labels, size[0]);
        if found.milliseconds.is_some() {
            write(&found.labels, size, &labels.join(method.name()).join(&case.name))?;
        }
        outcomes.push(Outcome { method, scores, milliseconds: found.milliseconds });
        if picture.is_none() {
            picture = Some(strip(&data, &found.labels)?);
        }
    }
    let Data { frames, .. } = data;
    Ok(Measured { case: case.clone(), size, frames: frames.len(), outcomes, strip: picture.unwrap_or_default() })
}

fn write(labels: &[Vec<u8>], size: [usize; 2], folder: &Path) -> Result<()> {
    fs::create_dir_all(folder)?;
    for (t, labels) in labels.iter().enumerate() {
        fs::write(folder.join(format!("{t:05}.png")), encode_grey_png(size[0], size[1], labels)?)?;
    }
    Ok(())
}
