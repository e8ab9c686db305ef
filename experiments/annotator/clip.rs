//! A long clip that is corrected often: how soon a stroke is seen, what the journal takes, and how much memory.
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use experiments::Failure;
use experiments::clips::cases::Case;
use serde::Serialize;
use veronese::clip::{Annotation, Clip, Command, Content, OpenOptions};
use veronese::codecs::decode_image;
use veronese::{Frame, SegmentOptions};

use crate::Options;

/// Number of frames: a clip is played to its end and back until there are so many.
const FRAMES: usize = 200;
const STROKES: usize = 50;
/// Radius of a stroke, pixels.
const RADIUS: usize = 14;

/// What corrections of one clip take. Times are in milliseconds, without decoding; sizes in bytes.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Row {
    clip: String,
    frames: usize,
    size: [usize; 2],
    /// From the end of a stroke until the labels of its own frame are known: median and largest.
    seen: [f64; 2],
    /// From there until it has spread, for each frame that it visited.
    spread_per_visit: f64,
    /// Frames that a stroke changed, mean.
    changed: f64,
    /// Undo of one step, and the labels of a frame that were known before: largest.
    undone: f64,
    /// Records that are kept when a stroke ends, and when it has spread: median and largest.
    given: [usize; 2],
    spread: [usize; 2],
    /// The journal after all strokes, and compacted.
    journal: usize,
    saved: usize,
    /// Reading the journal, and the labels that were saved.
    opened: f64,
    /// Memory of the program above what it took before the clip was opened, MiB: after segmentation, and after the strokes.
    memory: [f64; 2],
}

pub(crate) fn measure(case: &Case, options: &Options) -> Result<Row, Failure> {
    let files = files(&case.folder(&options.out)?.join("frames"))?;
    let turn = 2 * files.len() - 2;
    let index_of = |t: usize| (t % turn).min(turn - t % turn);
    let read = |t: usize| -> Result<Frame, Failure> { Ok(decode_image(&fs::read(&files[index_of(t)])?)?.frame()?) };
    let first = read(0)?;
    let (width, height) = (first.width(), first.height());
    drop(first);
    let before = memory("VmRSS")?;
    let mut clip = Clip::new(FRAMES, OpenOptions::default())?;
    let pair = SegmentOptions::default().with_quality(options.quality);
    clip.apply(Command::Segment { frames: 0..FRAMES, options: pair })?;
    let path = options.out.join("journal");
    // Returns how much was appended, and how many frames have changed.
    let keep = |clip: &mut Clip| -> Result<[usize; 2], Failure> {
        let events = clip.take_events();
        let mut file = fs::OpenOptions::new().create(true).append(true).open(&path)?;
        if events.replaces {
            file.set_len(0)?;
        }
        file.write_all(&events.records)?;
        Ok([if events.replaces { 0 } else { events.records.len() }, events.frames.len()])
    };
    while let Some(wanted) = clip.wanted() {
        clip.take(wanted.frame, &read(wanted.frame)?, None)?;
        keep(&mut clip)?;
    }
    let segmented = memory("VmRSS")?;
    let (mut seen, mut given, mut spread) = (Vec::new(), Vec::new(), Vec::new());
    let (mut time, mut visits, mut changed) = (Duration::ZERO, 0, 0);
    for k in 0..STROKES {
        let frame = 37 * k % FRAMES;
        let pixels = read(frame)?;
        known(&mut clip, frame, &pixels)?;
        let labels = clip.labels(frame).map(|of| of.objects).unwrap_or_default();
        // Every third stroke begins an object.
        let (object, [x, y]) = match labels.first().filter(|_| k % 3 > 0) {
            Some(object) => (object.id, [object.bbox[0] + object.bbox[2] / 2, object.bbox[1] + object.bbox[3] / 2]),
            None => (clip.next_object().unwrap_or(1), [width * (2 + k % 7) / 10, height * (3 + k % 5) / 10]),
        };
        let inside = |p: usize| (p % width).abs_diff(x).pow(2) + (p / width).abs_diff(y).pow(2) < RADIUS * RADIUS;
        let strokes = (0..width * height).map(|p| if inside(p) { 1 } else { 255 }).collect();
        let start = Instant::now();
        clip.apply(Command::Annotate(vec![Annotation::new(frame, Content::Strokes { object, labels: strokes })]))?;
        given.push(keep(&mut clip)?[0]);
        clip.take(frame, &pixels, None)?;
        known(&mut clip, frame, &pixels)?;
        seen.push(1e3 * start.elapsed().as_secs_f64());
        clip.look_at(None);
        let [mut records, mut frames] = [0; 2];
        while let Some(wanted) = clip.wanted() {
            let pixels = read(wanted.frame)?;
            let start = Instant::now();
            clip.take(wanted.frame, &pixels, None)?;
            time += start.elapsed();
            visits += 1;
            let [more, new] = keep(&mut clip)?;
            (records, frames) = (records + more, frames.max(new));
        }
        spread.push(records);
        changed += frames;
    }
    let corrected = memory("VmRSS")?;
    let mut undone: f64 = 0.0;
    while clip.steps()[0] > 1 {
        let start = Instant::now();
        clip.undo();
        clip.labels(0);
        undone = undone.max(1e3 * start.elapsed().as_secs_f64());
    }
    while clip.redo() {}
    keep(&mut clip)?;
    let journal = fs::read(&path)?;
    let saved = clip.save().len();
    let start = Instant::now();
    let recovered = Clip::read(&journal, OpenOptions::default())?;
    let opened = 1e3 * start.elapsed().as_secs_f64();
    if recovered.clip.frames() != clip.frames() {
        return Err(format!("{}: the journal gives another clip", case.name).into());
    }
    let row = Row {
        clip: case.name.clone(),
        frames: FRAMES,
        size: [width, height],
        seen: middle_and_largest(seen),
        spread_per_visit: 1e3 * time.as_secs_f64() / f64::from(visits.max(1)),
        changed: changed as f64 / STROKES as f64,
        undone,
        given: middle_and_largest(given),
        spread: middle_and_largest(spread),
        journal: journal.len(),
        saved,
        opened,
        memory: [segmented, corrected].map(|now| now - before),
    };
    println!("{row:#?}");
    Ok(row)
}

/// Makes the labels of a frame known.
fn known(clip: &mut Clip, index: usize, pixels: &Frame) -> Result<(), Failure> {
    clip.look_at(index);
    if clip.labels(index).is_none() {
        clip.take(index, pixels, None)?;
    }
    Ok(())
}

fn files(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let mut files = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>, Failure>>()?;
    files.sort();
    Ok(files)
}

fn middle_and_largest<T: PartialOrd + Copy>(mut values: Vec<T>) -> [T; 2] {
    values.sort_by(|one, other| one.partial_cmp(other).unwrap_or(std::cmp::Ordering::Equal));
    [values[values.len() / 2], values[values.len() - 1]]
}

/// Memory of this program as Linux tells it, MiB.
fn memory(name: &str) -> Result<f64, Failure> {
    let status = fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find_map(|line| line.strip_prefix(name)).unwrap_or_default();
    let kibibytes: f64 = line.trim_matches([':', ' ', '\t', 'k', 'B']).parse().unwrap_or(0.0);
    Ok(kibibytes / 1024.0)
}
