//! The native part of the comparison in the browser: `native scenes DIR 640x480 …` writes pairs of frames and clips, and `native times DIR
//! 640x480 …` prints the time of a call on each.

use std::error::Error;
use std::fs;
use std::path::Path;
use std::time::Instant;

use scenes::{ClipSceneOptions, Event, MIN_CLIP_FRAMES, SceneOptions, generate, generate_clip};
use veronese::{Frame, Quality, SegmentOptions, segment_pair};

/// Seed of the scenes of the browser benchmark.
const SCENE: u64 = 7;
/// Frames of its clips.
const CLIP_FRAMES: usize = 12;
const QUALITIES: [(&str, Quality); 2] = [("fast", Quality::Fast), ("best", Quality::Best)];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["scenes", folder, ref sizes @ ..] => sizes.iter().try_for_each(|size| write_scene(Path::new(folder), size)),
        ["times", folder, ref sizes @ ..] => print_times(Path::new(folder), sizes),
        _ => Err("usage: native scenes|times DIR WIDTHxHEIGHT…".into()),
    }
}

/// Writes the RGBA bytes of both frames, one label per pixel of the first, and the RGBA bytes of all frames of a clip.
fn write_scene(folder: &Path, size: &str) -> Result<(), Box<dyn Error>> {
    let (width, height) = sides(size)?;
    let scene = generate(&SceneOptions { width, height, seed: SCENE, ..SceneOptions::default() })?;
    for (name, bytes) in [("first", &scene.rgba[1]), ("second", &scene.rgba[2]), ("labels", &scene.labels)] {
        fs::write(folder.join(format!("{name}-{size}")), bytes)?;
    }
    let events = vec![Event::Pan, Event::Crossing];
    let options =
        ClipSceneOptions { width, height, frames: MIN_CLIP_FRAMES, events, seed: SCENE, ..ClipSceneOptions::default() };
    let clip = generate_clip(&options)?;
    let frames: Vec<Vec<u8>> = (0..CLIP_FRAMES).map(|t| clip.rgba(t)).collect::<veronese::Result<_>>()?;
    fs::write(folder.join(format!("clip-{size}")), frames.concat())?;
    Ok(())
}

fn sides(size: &str) -> Result<(usize, usize), Box<dyn Error>> {
    let (width, height) = size.split_once('x').ok_or("a size looks like 640x480")?;
    Ok((width.parse()?, height.parse()?))
}

/// Prints the milliseconds of a call for each size and quality.
fn print_times(folder: &Path, sizes: &[&str]) -> Result<(), Box<dyn Error>> {
    let mut rows = Vec::new();
    for size in sizes {
        let (width, height) = sides(size)?;
        let frame = |name: &str| {
            let bytes = fs::read(folder.join(format!("{name}-{size}")))?;
            Ok::<_, Box<dyn Error>>(Frame::from_rgba(width, height, &bytes)?)
        };
        let (first, second) = (frame("first")?, frame("second")?);
        let mut cells = Vec::new();
        for (name, quality) in QUALITIES {
            let options = SegmentOptions::default().with_quality(quality);
            let time = milliseconds(|| segment_pair(&first, &second, &options, &mut |_| {}).map(|found| found.count))?;
            cells.push(format!("\"{name}\": {time}"));
        }
        rows.push(format!("\"{size}\": {{{}}}", cells.join(", ")));
    }
    println!("{{{}}}", rows.join(", "));
    Ok(())
}

fn milliseconds<T>(work: impl FnOnce() -> veronese::Result<T>) -> veronese::Result<f64> {
    let start = Instant::now();
    std::hint::black_box(work()?);
    Ok(1e3 * start.elapsed().as_secs_f64())
}
