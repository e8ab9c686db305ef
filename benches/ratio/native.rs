//! The native part of two benchmarks. For `npm run bench:ratio`, `native inputs DIR` writes the inputs of all cases to files, and `native
//! times DIR` prints the time of each in milliseconds as JSON. For `npm run bench:browser`, `native scenes DIR 640x480 …` writes pairs of
//! frames and clips, and `native stages DIR 640x480 …` prints the time of each stage on them.

#[allow(dead_code, unreachable_pub, clippy::expect_used, reason = "shared with the tests, which use more of it")]
#[path = "../../src/stages/protocol.rs"]
mod protocol;

use std::error::Error;
use std::fs;
use std::path::Path;
use std::time::Instant;

use protocol::Protocol;
use scenes::{ClipSceneOptions, Event, MIN_CLIP_FRAMES, SceneOptions, generate, generate_clip};
use veronese::{
    FitOptions, Frame, Measurements, MotionCount, Quality, SegmentOptions, Stage, fit_motions, segment_pair,
};

/// Problems per number of motions.
const PROBLEMS: u64 = 8;
const MOTIONS: [usize; 3] = [2, 3, 4];
/// Seed of the scenes of the browser benchmark.
const SCENE: u64 = 7;
/// Frames of its clips.
const CLIP_FRAMES: usize = 12;
const WIDTH: usize = 320;
const HEIGHT: usize = 240;
const QUALITIES: [(&str, Quality); 2] = [("fast", Quality::Fast), ("best", Quality::Best)];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["inputs", folder] => write_inputs(Path::new(folder)),
        ["times", folder] => print_times(Path::new(folder)),
        ["scenes", folder, ref sizes @ ..] => sizes.iter().try_for_each(|size| write_scene(Path::new(folder), size)),
        ["stages", folder, ref sizes @ ..] => print_stages(Path::new(folder), sizes),
        _ => Err("usage: native inputs|times DIR | scenes|stages DIR WIDTHxHEIGHT…".into()),
    }
}

fn write_inputs(folder: &Path) -> Result<(), Box<dyn Error>> {
    for n in MOTIONS {
        for seed in 0..PROBLEMS {
            let data = Protocol::new(n, 0.05).problem(seed).measurements;
            let numbers = data.iter().flat_map(|(p, d)| [p[0], p[1], d[0], d[1], d[2]]);
            fs::write(
                folder.join(format!("points-{n}-{seed}")),
                numbers.flat_map(f64::to_le_bytes).collect::<Vec<u8>>(),
            )?;
        }
    }
    let scene = generate(&SceneOptions { width: WIDTH, height: HEIGHT, ..SceneOptions::default() })?;
    fs::write(folder.join("first"), &scene.rgba[1])?;
    fs::write(folder.join("second"), &scene.rgba[2])?;
    Ok(())
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

/// Prints the milliseconds of a call for each size and quality, in total and per stage. Times of a stage entered several times add up.
fn print_stages(folder: &Path, sizes: &[&str]) -> Result<(), Box<dyn Error>> {
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
            let (mut begun, start) = (Vec::<(&str, Instant)>::new(), Instant::now());
            let mut listen = |stage: Stage| begun.push((stage.name, Instant::now()));
            std::hint::black_box(segment_pair(&first, &second, &options, &mut listen)?);
            let end = Instant::now();
            let mut laps = vec![("total", 1e3 * (end - start).as_secs_f64())];
            for (k, &(stage, since)) in begun.iter().enumerate() {
                let until = begun.get(k + 1).map_or(end, |&(_, next)| next);
                let time = 1e3 * (until - since).as_secs_f64();
                match laps.iter_mut().find(|(known, _)| *known == stage) {
                    Some((_, sum)) => *sum += time,
                    None => laps.push((stage, time)),
                }
            }
            let laps: Vec<String> = laps.iter().map(|(stage, time)| format!("\"{stage}\": {time}")).collect();
            cells.push(format!("\"{name}\": {{{}}}", laps.join(", ")));
        }
        rows.push(format!("\"{size}\": {{{}}}", cells.join(", ")));
    }
    println!("{{{}}}", rows.join(", "));
    Ok(())
}

fn print_times(folder: &Path) -> Result<(), Box<dyn Error>> {
    let mut cases = Vec::new();
    for n in MOTIONS {
        let options = FitOptions::default().with_motions(MotionCount::Given(n));
        let mut times = Vec::new();
        for seed in 0..PROBLEMS {
            let data = read_points(&folder.join(format!("points-{n}-{seed}")))?;
            times.push(milliseconds(|| fit_motions(&data, &options, &mut |_| {}).map(|fit| fit.count))?);
        }
        cases.push(format!("\"points {n}\": {times:?}"));
    }
    let frame = |name: &str| Ok::<_, Box<dyn Error>>(Frame::from_rgba(WIDTH, HEIGHT, &fs::read(folder.join(name))?)?);
    let (first, second) = (frame("first")?, frame("second")?);
    for (name, quality) in QUALITIES {
        let options = SegmentOptions::default().with_quality(quality);
        let time = milliseconds(|| segment_pair(&first, &second, &options, &mut |_| {}).map(|found| found.count))?;
        cases.push(format!("\"pair {name}\": [{time}]"));
    }
    println!("{{{}}}", cases.join(", "));
    Ok(())
}

fn read_points(path: &Path) -> Result<Measurements, Box<dyn Error>> {
    let bytes = fs::read(path)?;
    let numbers: Vec<f64> = bytes.as_chunks::<8>().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect();
    let rows = numbers.as_chunks::<5>().0.iter();
    Ok(Measurements::new(rows.clone().map(|r| [r[0], r[1]]).collect(), rows.map(|r| [r[2], r[3], r[4]]).collect())?)
}

fn milliseconds<T>(work: impl FnOnce() -> veronese::Result<T>) -> veronese::Result<f64> {
    let start = Instant::now();
    std::hint::black_box(work()?);
    Ok(1e3 * start.elapsed().as_secs_f64())
}
