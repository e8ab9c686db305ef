//! What is measured: generated clips with fixed seeds, and real clips that lie beside the project.

use std::fs;
use std::path::{Path, PathBuf};

use scenes::{ClipSceneOptions, Event, generate_clip};
use veronese::codecs::{Picture, decode_image, encode_colour_png, encode_grey_png};
use veronese::{Frame, UNLABELLED};

use crate::Result;

/// Seed of the first generated clip.
const SEED: u64 = 50_000;

/// The generated clips: events, and the least number of objects.
const GENERATED: [(&[Event], usize); 26] = [
    (&[], 2),
    (&[Event::Pan, Event::Zoom], 3),
    (&[Event::Crossing], 2),
    (&[Event::Crossing, Event::Pan], 3),
    (&[Event::StopAndGo], 1),
    (&[Event::StopAndGo, Event::Pan], 2),
    (&[Event::Entering, Event::Leaving], 2),
    (&[Event::Entering, Event::Leaving, Event::Pan], 3),
    (&[Event::HiddenByBackground], 1),
    (&[Event::HiddenByBackground, Event::Pan], 2),
    (&[Event::HiddenByObject], 2),
    (&[Event::HiddenByObject, Event::Zoom], 3),
    (&[Event::Articulated], 1),
    (&[Event::Articulated, Event::Pan], 2),
    (&[Event::Articulated, Event::StopAndGo, Event::Zoom], 2),
    (&[Event::Slow], 1),
    (&[Event::Slow, Event::Pan], 2),
    (&[Event::Fast], 1),
    (&[Event::Fast, Event::Pan], 2),
    (&[Event::Articulated, Event::Articulated, Event::Crossing, Event::Pan], 4),
    (&[Event::Crossing, Event::StopAndGo, Event::HiddenByBackground, Event::Pan], 4),
    (&[Event::Crossing, Event::Exposure], 2),
    (&[Event::StopAndGo, Event::Pan, Event::Flash], 2),
    (&[Event::Crossing, Event::Repeats], 3),
    (&[Event::Crossing, Event::Articulated, Event::Cut], 2),
    (&[Event::HiddenByBackground, Event::Fast, Event::Pan, Event::Cut, Event::Exposure, Event::Repeats], 2),
];
/// Frames of a clip, and of one with a cut.
const FRAMES: usize = 32;
const FRAMES_WITH_CUT: usize = 48;

/// Where a clip comes from.
#[derive(Clone, Debug)]
enum Source {
    Generated(ClipSceneOptions),
    Folder(PathBuf),
}

/// One clip.
#[derive(Clone, Debug)]
pub struct Case {
    pub name: String,
    source: Source,
}

/// A clip's frames and their true labels.
pub struct Data {
    pub frames: Vec<Frame>,
    pub truths: Vec<Vec<u8>>,
}

/// All clips, those of `shared` only if it is there; with `quick` every fourth of the generated clips and none of the real ones.
pub fn all(shared: &Path, quick: bool) -> Result<Vec<Case>> {
    let mut cases = generated(1.0);
    if quick {
        cases = cases.into_iter().skip(2).step_by(4).collect();
    }
    let real = shared.join("data").join("clips");
    if !quick && real.is_dir() {
        cases.extend(of_folders(&real)?);
    }
    Ok(cases)
}

/// The generated clips, at a share of the usual speed.
pub fn generated(speed: f64) -> Vec<Case> {
    let mut cases = Vec::new();
    for (k, (events, objects)) in GENERATED.into_iter().enumerate() {
        let seed = SEED + k as u64;
        let frames = if events.contains(&Event::Cut) { FRAMES_WITH_CUT } else { FRAMES };
        let options =
            ClipSceneOptions { frames, objects, events: events.to_vec(), speed, seed, ..ClipSceneOptions::default() };
        let words = events.iter().map(|&event| word(event)).collect::<Vec<_>>().join("-");
        let name = format!("{seed}-{}", if words.is_empty() { "plain" } else { &words });
        cases.push(Case::generated(name, options));
    }
    cases
}

/// The real clips in the folders of `real`.
pub fn of_folders(real: &Path) -> Result<Vec<Case>> {
    let mut folders = files(real)?;
    folders.retain(|folder| folder.join("frames").is_dir() && folder.join("masks").is_dir());
    let case = |folder: PathBuf| {
        let name = folder.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        Case { name, source: Source::Folder(folder) }
    };
    Ok(folders.into_iter().map(case).collect())
}

/// An event in the name of a clip.
pub fn word(event: Event) -> &'static str {
    match event {
        Event::Crossing => "crossing",
        Event::StopAndGo => "stop",
        Event::Entering => "entering",
        Event::Leaving => "leaving",
        Event::HiddenByBackground => "hidden",
        Event::HiddenByObject => "covered",
        Event::Articulated => "limbs",
        Event::Slow => "slow",
        Event::Fast => "fast",
        Event::Pan => "pan",
        Event::Zoom => "zoom",
        Event::Cut => "cut",
        Event::Exposure => "exposure",
        Event::Flash => "flash",
        Event::Repeats => "repeats",
    }
}

impl Case {
    /// A generated clip.
    pub fn generated(name: String, options: ClipSceneOptions) -> Case {
        Case { name, source: Source::Generated(options) }
    }

    /// Whether the clip is generated, so that its truth has all that moves, and pictures of it may be shown.
    pub fn is_generated(&self) -> bool {
        matches!(self.source, Source::Generated(_))
    }

    /// Whether an event is part of the clip; of real clips nothing is known.
    pub fn has(&self, event: Event) -> bool {
        matches!(&self.source, Source::Generated(options) if options.events.contains(&event))
    }

    /// Reads or renders the clip.
    pub fn load(&self) -> Result<Data> {
        match &self.source {
            Source::Generated(options) => {
                let clip = generate_clip(options)?;
                let frames = (0..options.frames).map(|t| clip.frame(t)).collect::<veronese::Result<_>>()?;
                let truths = (0..options.frames).map(|t| clip.labels(t)).collect::<veronese::Result<_>>()?;
                Ok(Data { frames, truths })
            }
            Source::Folder(folder) => {
                of_folder(folder).map_err(|error| format!("{}: {error}", folder.display()).into())
            }
        }
    }

    /// The folder that has `frames` and `masks`: that of a generated clip is written into `out`.
    pub fn folder(&self, out: &Path) -> Result<PathBuf> {
        let options = match &self.source {
            Source::Folder(folder) => return Ok(folder.clone()),
            Source::Generated(options) => options,
        };
        let folder = out.join(&self.name);
        let clip = generate_clip(options)?;
        for part in ["frames", "masks"] {
            fs::create_dir_all(folder.join(part))?;
        }
        for t in 0..options.frames {
            let file = format!("{t:05}.png");
            let frame = encode_colour_png(options.width, options.height, &clip.rgba(t)?)?;
            fs::write(folder.join("frames").join(&file), frame)?;
            let mask = encode_grey_png(options.width, options.height, &clip.labels(t)?)?;
            fs::write(folder.join("masks").join(&file), mask)?;
        }
        Ok(folder)
    }
}

fn of_folder(folder: &Path) -> Result<Data> {
    let mut data = Data { frames: Vec::new(), truths: Vec::new() };
    for mask in files(&folder.join("masks"))? {
        let name = mask.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let frame = ["jpg", "png"].map(|kind| folder.join("frames").join(format!("{name}.{kind}")));
        let frame = frame.iter().find(|file| file.is_file()).ok_or(format!("there is no frame {name}"))?;
        data.frames.push(picture(frame)?.frame()?);
        // One object, in whatever colour its mask has.
        let object = |pixel: &[u8]| u8::from(pixel[..3] != [0; 3]);
        data.truths.push(picture(&mask)?.rgba.chunks_exact(4).map(object).collect());
    }
    Ok(data)
}

fn picture(file: &Path) -> Result<Picture> {
    Ok(decode_image(&fs::read(file)?)?)
}

/// The files of a folder by name.
fn files(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut files: Vec<PathBuf> = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
    files.sort();
    Ok(files)
}

/// Labels that another program wrote, one grey image per frame; none if it did not run. A frame that is missing has no labels.
pub fn labels(folder: &Path, data: &Data) -> Result<Option<Vec<Vec<u8>>>> {
    if !folder.is_dir() {
        return Ok(None);
    }
    let read = |t: usize| -> Result<Vec<u8>> {
        let pixels = data.truths[t].len();
        let file = folder.join(format!("{t:05}.png"));
        if !file.is_file() {
            return Ok(vec![UNLABELLED; pixels]);
        }
        let labels: Vec<u8> = picture(&file)?.rgba.chunks_exact(4).map(|pixel| pixel[0]).collect();
        if labels.len() == pixels { Ok(labels) } else { Err(format!("{} has another size", file.display()).into()) }
    };
    Ok(Some((0..data.frames.len()).map(read).collect::<Result<_>>()?))
}
