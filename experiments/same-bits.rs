//! The native part of `npm run same-bits`: `frames DIR PAIRS CLIPS` writes generated frames and a list of what is asked of them, and
//! `results DIR OUT` answers the list. An answer is two files of each pair and clip: its labels, and all its numbers.

use std::error::Error;
use std::fs;
use std::path::Path;

use scenes::{ClipSceneOptions, Event, MIN_CLIP_FRAMES, SceneOptions, generate, generate_clip};
use serde::{Deserialize, Serialize};
use veronese::clip::{ClipFrame, ClipOptions, ClipSegmenter, StreamSegmenter};
use veronese::{AffineMotion, Frame, MotionCount, Quality, SegmentOptions, Segmentation, segment_pair};

/// Width and height by turns. Large pairs of quality best also carry on at a finer size.
const SIZES: [(usize, usize); 4] = [(160, 120), (320, 240), (200, 150), (121, 97)];
const CLIP_SIZES: [(usize, usize); 2] = [(160, 120), (192, 144)];
/// Frames of each clip.
const CLIP_FRAMES: usize = 8;
const SEED: u64 = 500;

/// A pair or a clip, and its options in the words of the npm package.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Case {
    name: String,
    width: usize,
    height: usize,
    /// Files of RGBA bytes.
    frames: Vec<String>,
    clip: bool,
    options: Options,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Options {
    quality: String,
    mark_unknown: bool,
    /// Of pairs only.
    #[serde(skip_serializing_if = "Option::is_none")]
    confidence: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    motions: Option<usize>,
    /// Of streams only.
    #[serde(skip_serializing_if = "Option::is_none")]
    look_ahead: Option<usize>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["frames", folder, pairs, clips] => write_frames(Path::new(folder), pairs.parse()?, clips.parse()?),
        ["results", folder, out] => write_results(Path::new(folder), Path::new(out)),
        _ => Err("usage: same-bits frames DIR PAIRS CLIPS | results DIR OUT".into()),
    }
}

fn write_frames(folder: &Path, pairs: usize, clips: usize) -> Result<(), Box<dyn Error>> {
    let mut cases = Vec::new();
    for k in 0..pairs {
        let (width, height) = SIZES[k % SIZES.len()];
        // The speeds and backgrounds of a benchmark, in other sizes.
        let drawn = SceneOptions::series(SEED + k as u64, &[(width, height)])[k % 6];
        let scene = generate(&SceneOptions { colour: k % 3 == 0, ..drawn })?;
        let frames = write_all(folder, &format!("pair-{k:02}"), &scene.rgba[1..])?;
        let options = Options {
            quality: if k % 2 == 0 { "best" } else { "fast" }.into(),
            mark_unknown: k % 5 == 1,
            confidence: Some(k % 3 == 0),
            motions: (k % 7 == 3).then_some(2 + k % 2),
            look_ahead: None,
        };
        cases.push(Case { name: format!("pair-{k:02}"), width, height, frames, clip: false, options });
    }
    for k in 0..clips {
        let (width, height) = CLIP_SIZES[k % CLIP_SIZES.len()];
        let events = vec![Event::ALL[(4 * k) % Event::ALL.len()], Event::Pan];
        let options = ClipSceneOptions {
            width,
            height,
            frames: MIN_CLIP_FRAMES,
            events,
            seed: SEED + k as u64,
            ..ClipSceneOptions::default()
        };
        let clip = generate_clip(&options)?;
        let rgba: Vec<Vec<u8>> = (0..CLIP_FRAMES).map(|t| clip.rgba(t)).collect::<veronese::Result<_>>()?;
        let frames = write_all(folder, &format!("clip-{k}"), &rgba)?;
        let options = Options {
            quality: if k % 4 < 2 { "fast" } else { "best" }.into(),
            mark_unknown: k % 4 == 1,
            confidence: None,
            motions: None,
            look_ahead: (k % 2 == 1).then_some(2),
        };
        cases.push(Case { name: format!("clip-{k}"), width, height, frames, clip: true, options });
    }
    Ok(fs::write(folder.join("cases.json"), serde_json::to_vec_pretty(&cases)?)?)
}

fn write_all(folder: &Path, name: &str, frames: &[Vec<u8>]) -> Result<Vec<String>, Box<dyn Error>> {
    let files: Vec<String> = (0..frames.len()).map(|t| format!("{name}-{t}.rgba")).collect();
    for (file, frame) in files.iter().zip(frames) {
        fs::write(folder.join(file), frame)?;
    }
    Ok(files)
}

fn write_results(folder: &Path, out: &Path) -> Result<(), Box<dyn Error>> {
    let cases: Vec<Case> = serde_json::from_slice(&fs::read(folder.join("cases.json"))?)?;
    fs::create_dir_all(out)?;
    for case in &cases {
        let frames = case.frames.iter().map(|file| -> Result<Frame, Box<dyn Error>> {
            Ok(Frame::from_rgba(case.width, case.height, fs::read(folder.join(file))?)?)
        });
        let frames = frames.collect::<Result<Vec<_>, _>>()?;
        let (labels, numbers) =
            if case.clip { of_clip(&frames, &case.options)? } else { of_pair(&frames, &case.options)? };
        fs::write(out.join(format!("{}.labels", case.name)), labels)?;
        fs::write(
            out.join(format!("{}.numbers", case.name)),
            numbers.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>(),
        )?;
    }
    Ok(())
}

impl Options {
    fn of_pair(&self) -> SegmentOptions {
        SegmentOptions::default()
            .with_quality(if self.quality == "fast" { Quality::Fast } else { Quality::Best })
            .with_mark_unknown(self.mark_unknown)
            .with_confidence(self.confidence == Some(true))
            .with_motions(self.motions.map_or(MotionCount::Auto, MotionCount::Given))
    }
}

type Bits = (Vec<u8>, Vec<f64>);

/// The labels and all numbers, in the order of `scripts/lib/same-bits/bits.mjs`.
fn of_pair(frames: &[Frame], options: &Options) -> Result<Bits, Box<dyn Error>> {
    let Segmentation { labels, motions, junctions, evidence, confidence, .. } =
        segment_pair(&frames[0], &frames[1], &options.of_pair(), &mut |_| {})?;
    let mut numbers = Vec::new();
    for motion in &motions {
        numbers.push(f64::from(motion.label));
        numbers.extend(entries(&motion.matrix));
        numbers.extend([motion.pixels as f64, motion.share, motion.residual]);
        numbers.extend(motion.bbox.map(|v| v as f64));
        numbers.push(f64::from(motion.group));
    }
    for junction in &junctions {
        numbers.extend(junction.labels.map(f64::from));
        numbers.extend([junction.likelihood, junction.border as f64]);
    }
    numbers.extend(evidence.candidates.iter().flat_map(|candidate| [candidate.motions as f64, candidate.score]));
    numbers.extend(confidence.iter().flatten().map(|&v| f64::from(v)));
    Ok((labels, numbers))
}

fn of_clip(frames: &[Frame], options: &Options) -> Result<Bits, Box<dyn Error>> {
    let asked = ClipOptions::default().with_pair(options.of_pair()).with_look_ahead(options.look_ahead);
    let mut found = Vec::new();
    if options.look_ahead.is_some() {
        let mut stream = StreamSegmenter::new(asked)?;
        for frame in frames {
            found.extend(stream.push(frame.clone())?);
        }
        found.extend(stream.finish());
    } else {
        let mut segmenter = ClipSegmenter::new(asked)?;
        frames.iter().try_for_each(|frame| segmenter.push(frame.clone()).map(drop))?;
        let clip = segmenter.conclude();
        for (index, frame) in frames.iter().enumerate() {
            found.push(clip.frame(index, frame)?);
        }
    }
    let mut numbers = Vec::new();
    for ClipFrame { index, objects, background, .. } in &found {
        numbers.push(*index as f64);
        for object in objects {
            numbers.extend([f64::from(object.id), object.pixels as f64]);
            numbers.extend(object.bbox.map(|v| v as f64));
            numbers.push(object.confidence);
            numbers.extend(perhaps(object.matrix.as_ref()));
        }
        numbers.extend(perhaps(background.as_ref()));
    }
    Ok((found.into_iter().flat_map(|frame| frame.labels).collect(), numbers))
}

/// 0 for no motion; 1 and its entries for one.
fn perhaps(motion: Option<&AffineMotion>) -> Vec<f64> {
    motion.map_or(vec![0.0], |motion| std::iter::once(1.0).chain(entries(motion)).collect())
}

fn entries(motion: &AffineMotion) -> [f64; 6] {
    motion.matrix
}
