//! What is measured: generated scenes with fixed seeds, and what lies beside the project.

use std::fs;
use std::path::{Path, PathBuf};

use scenes::{Background, Scene, SceneOptions, Speed};
use veronese::Frame;
use veronese::codecs::{Picture, decode_image, encode_colour_png};

use super::scores::VOID;
use crate::Result;

/// Seeds of the generated scenes, far from those that anything was tuned on.
const SERIES_SEED: u64 = 40_000;
const COLOUR_SEED: u64 = 41_000;
const SLOW_SEED: u64 = 42_000;
const STILL_SEED: u64 = 43_000;
const LARGE_SEED: u64 = 44_000;
const ROBOT_SEED: u64 = 45_000;
const BARE_SEED: u64 = 46_000;
const FIT_SEED: u64 = 50_000;
/// Where a third of the pairs of a sequence is measured.
const EVERY: usize = 3;
/// CDnet's codes for shadow, outside the region of interest and unknown.
const CDNET_VOID: [u8; 3] = [50, 85, 170];

/// What a case belongs to; the tables have a row for each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Set {
    /// One to four objects on static and moving backgrounds, three sizes, three speeds; grey.
    Generated,
    /// The same in colour.
    Colour,
    /// Up to 1280 × 720.
    Large,
    /// The paper's leader and follower.
    Robots,
    /// Cars on static bare ground.
    Bare,
    /// One object that moves 0.3 pixels.
    Slow,
    /// Nothing moves; there is noise.
    Still,
    /// Generated scenes beside the project, textures from photographs.
    SharedScenes,
    /// Real pairs with masks.
    Pairs,
    /// Several real pairs of each of many sequences, with masks.
    Sequences,
}

impl Set {
    pub const ALL: [Set; 10] = [
        Set::Generated,
        Set::Colour,
        Set::Large,
        Set::Robots,
        Set::Bare,
        Set::Slow,
        Set::Still,
        Set::SharedScenes,
        Set::Pairs,
        Set::Sequences,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Set::Generated => "generated",
            Set::Colour => "colour",
            Set::Large => "large",
            Set::Robots => "robots",
            Set::Bare => "bare",
            Set::Slow => "slow",
            Set::Still => "still",
            Set::SharedScenes => "shared-scenes",
            Set::Pairs => "pairs",
            Set::Sequences => "sequences",
        }
    }

    pub fn title(self) -> &'static str {
        match self {
            Set::Generated => "generated, grey, 200 × 150 to 640 × 480",
            Set::Colour => "generated, colour, 200 × 150 and 320 × 240",
            Set::Large => "generated, colour, 1280 × 720",
            Set::Robots => "leader and follower (200 × 150)",
            Set::Bare => "cars on bare ground (384 × 216)",
            Set::Slow => "one object moving 0.3 pixels",
            Set::Still => "static scene, noise only",
            Set::SharedScenes => "generated outside the project, photographic textures",
            Set::Pairs => "24 pairs of DAVIS, CDnet 2014 and Wallflower",
            Set::Sequences => "30 sequences of DAVIS 2016",
        }
    }

    /// Whether the truth is one label for each thing that moves, rather than foreground and background.
    pub fn is_scene(self) -> bool {
        !matches!(self, Set::Pairs | Set::Sequences)
    }
}

/// Where a case comes from.
#[derive(Clone, Debug)]
enum Source {
    Scene(SceneOptions),
    Robots(u64),
    Bare(u64),
    Folder(PathBuf),
}

/// One pair of frames to segment.
#[derive(Clone, Debug)]
pub struct Case {
    pub name: String,
    pub set: Set,
    /// Whether things move by less than a pixel and a half relative to the background.
    pub sub_pixel: bool,
    source: Source,
}

/// A case's frames and what is known of them.
pub struct Data {
    /// The two frames as RGBA bytes.
    pub rgba: [Vec<u8>; 2],
    pub first: Frame,
    pub second: Frame,
    pub truth: Option<Vec<u8>>,
    /// Pixels that are hidden or outside in the second frame; known of generated scenes.
    pub occluded: Option<Vec<bool>>,
}

/// All cases, those of `shared` only if it is there. `quick` takes a third of the generated ones and none of the large.
pub fn all(shared: &Path, quick: bool) -> Result<Vec<Case>> {
    let mut cases = Vec::new();
    let sizes = [(200, 150), (320, 240), (640, 480)];
    series(&mut cases, Set::Generated, SERIES_SEED, if quick { &sizes[..1] } else { &sizes });
    let again = if quick { &sizes[..0] } else { &sizes[..2] };
    series(&mut cases, Set::Generated, SERIES_SEED + 100, again);
    series(&mut cases, Set::Colour, COLOUR_SEED, if quick { &sizes[..0] } else { &sizes[..2] });
    if !quick {
        let mut large = Vec::new();
        series(&mut large, Set::Large, LARGE_SEED, &[(1280, 720)]);
        // They take their time: three of them, a static and two moving backgrounds, slow to fast.
        cases.extend(large.into_iter().enumerate().filter(|(k, _)| [0, 3, 5].contains(k)).map(|(_, case)| case));
    }
    let few = if quick { 2 } else { 6 };
    for k in 0..few {
        let seed = ROBOT_SEED + k;
        let source = Source::Robots(seed);
        cases.push(Case { name: format!("robots-{seed}"), set: Set::Robots, sub_pixel: false, source });
        let seed = BARE_SEED + k;
        cases.push(Case { name: format!("bare-{seed}"), set: Set::Bare, sub_pixel: false, source: Source::Bare(seed) });
    }
    for k in 0..few {
        let size = if k % 2 == 0 { (200, 150) } else { (320, 240) };
        let options = |seed, objects, speed| SceneOptions {
            width: size.0,
            height: size.1,
            objects,
            speed,
            background: Background::Static,
            noise: 1.0 + 0.4 * k as f64,
            seed,
            ..SceneOptions::default()
        };
        cases.push(scene_case(Set::Slow, options(SLOW_SEED + k, 1, Speed::Creeping)));
        cases.push(scene_case(Set::Still, options(STILL_SEED + k, 0, Speed::Medium)));
    }
    for (folder, set) in [("scenes", Set::SharedScenes), ("pairs", Set::Pairs)] {
        for path in folders(&shared.join("data").join(folder))? {
            let has = |file: &str| path.join(file).is_file();
            let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
            let set = match set {
                set if has("mask.png") => set,
                _ => continue,
            };
            let sub_pixel = set == Set::SharedScenes && name.contains("-sub-");
            cases.push(Case { name, set, sub_pixel, source: Source::Folder(path) });
        }
    }
    if !quick {
        for path in folders(&shared.join("data").join("train"))? {
            let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
            cases.push(Case { name, set: Set::Sequences, sub_pixel: false, source: Source::Folder(path) });
        }
    }
    Ok(cases)
}

fn series(cases: &mut Vec<Case>, set: Set, seed: u64, sizes: &[(usize, usize)]) {
    for options in SceneOptions::series(seed, sizes) {
        cases.push(scene_case(set, SceneOptions { colour: matches!(set, Set::Colour | Set::Large), ..options }));
    }
}

fn scene_case(set: Set, options: SceneOptions) -> Case {
    let SceneOptions { width, seed, .. } = options;
    let sub_pixel = matches!(options.speed, Speed::SubPixel | Speed::Creeping) && options.objects > 0;
    Case { name: format!("{}-{width}-{seed}", set.name()), set, sub_pixel, source: Source::Scene(options) }
}

/// Generated scenes of other seeds than those of [`all`], smaller ones: for programs that fit constants.
pub fn for_fitting() -> Vec<Case> {
    let mut cases = Vec::new();
    series(&mut cases, Set::Generated, FIT_SEED, &[(200, 150), (320, 240)]);
    series(&mut cases, Set::Colour, FIT_SEED + 1_000, &[(200, 150), (320, 240)]);
    for seed in (FIT_SEED + 6_000..).take(6) {
        cases.push(Case { name: format!("bare-{seed}"), set: Set::Bare, sub_pixel: false, source: Source::Bare(seed) });
    }
    cases
}

/// Of the pairs of every sequence every third, beginning with the second.
pub fn a_third(pairs: impl Iterator<Item = Case>) -> Vec<Case> {
    let mut sequence = (String::new(), 0);
    let mut chosen = |case: &Case| {
        if sequence.0 != case.sequence() {
            sequence = (case.sequence().to_owned(), 0);
        }
        sequence.1 += 1;
        sequence.1 % EVERY == 2
    };
    pairs.filter(|case| chosen(case)).collect()
}

/// The folders in a folder, by name; none where there is no such folder.
fn folders(path: &Path) -> Result<Vec<PathBuf>> {
    if !path.is_dir() {
        return Ok(Vec::new());
    }
    let mut found = Vec::new();
    for entry in fs::read_dir(path)? {
        let entry = entry?.path();
        if entry.is_dir() {
            found.push(entry);
        }
    }
    found.sort();
    Ok(found)
}

impl Case {
    /// The sequence of a pair that is named `SEQUENCE_FRAME`.
    pub fn sequence(&self) -> &str {
        self.name.rsplit_once('_').map_or(&self.name, |(sequence, _)| sequence)
    }

    /// Reads or generates the frames.
    pub fn load(&self) -> Result<Data> {
        match &self.source {
            Source::Scene(options) => Ok(of_scene(scenes::generate(options)?)),
            Source::Robots(seed) => Ok(of_scene(scenes::leader_follower(*seed)?)),
            Source::Bare(seed) => Ok(of_scene(scenes::bare_ground(*seed)?)),
            Source::Folder(folder) => {
                of_folder(folder, self.set).map_err(|error| format!("{}: {error}", folder.display()).into())
            }
        }
    }

    /// The folder that has `first.png` and `second.png`: those of a generated case are written into one in `out`.
    pub fn folder(&self, out: &Path) -> Result<PathBuf> {
        if let Source::Folder(folder) = &self.source {
            return Ok(folder.clone());
        }
        let folder = out.join(&self.name);
        fs::create_dir_all(&folder)?;
        let data = self.load()?;
        for (name, rgba) in ["first.png", "second.png"].iter().zip(&data.rgba) {
            fs::write(folder.join(name), encode_colour_png(data.first.width(), data.first.height(), rgba)?)?;
        }
        Ok(folder)
    }
}

fn of_scene(scene: Scene) -> Data {
    let [_, first, second] = scene.frames;
    let [_, first_rgba, second_rgba] = scene.rgba;
    let (truth, occluded) = (Some(scene.labels), Some(scene.occluded));
    Data { rgba: [first_rgba, second_rgba], first, second, truth, occluded }
}

fn of_folder(folder: &Path, set: Set) -> Result<Data> {
    let read = |name: &str| -> Result<Vec<u8>> { Ok(fs::read(folder.join(name))?) };
    let picture = |name: &str| -> Result<Picture> { Ok(decode_image(&read(name)?)?) };
    // Masks are grey images of label numbers.
    let labels =
        |name: &str| -> Result<Vec<u8>> { Ok(picture(name)?.rgba.chunks_exact(4).map(|pixel| pixel[0]).collect()) };
    let has = |name: &str| folder.join(name).is_file();
    let frame =
        |name: &str| picture(&if has(&format!("{name}.jpg")) { format!("{name}.jpg") } else { format!("{name}.png") });
    let (one, two) = (frame("first")?, frame("second")?);
    let (first, second) = (one.frame()?, two.frame()?);
    let rgba = [one.rgba, two.rgba];
    let mut data = Data { rgba, first, second, truth: None, occluded: None };
    let mut truth = labels("mask.png")?;
    if set == Set::Sequences {
        // One object, in whatever grey its mask has.
        truth.iter_mut().for_each(|label| *label = u8::from(*label != 0));
    }
    if has("gt_raw.png") {
        for (label, code) in truth.iter_mut().zip(labels("gt_raw.png")?) {
            if CDNET_VOID.contains(&code) {
                *label = VOID;
            }
        }
    }
    data.truth = Some(truth);
    Ok(data)
}

/// What the baseline found in a folder.
pub struct Baseline {
    pub labels: Vec<u8>,
    pub milliseconds: f64,
}

/// Reads what the baseline wrote; none where it did not run.
pub fn baseline(folder: &Path) -> Result<Option<Baseline>> {
    let (labels, result) = (folder.join("labels.png"), folder.join("result.json"));
    if !labels.is_file() || !result.is_file() {
        return Ok(None);
    }
    let labels = decode_image(&fs::read(labels)?)?.rgba.chunks_exact(4).map(|pixel| pixel[0]).collect();
    let result: serde_json::Value = serde_json::from_slice(&fs::read(result)?)?;
    let milliseconds = result["ms"]["total"].as_f64().unwrap_or(f64::NAN);
    Ok(Some(Baseline { labels, milliseconds }))
}
