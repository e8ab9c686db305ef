//! Clips with exact truth: things that cross, stop, enter, leave, hide and swing before a camera that may move, with labels that keep
//! their numbers through time.
//!
//! A clip is one shot, or two with a cut between them. A shot is a background and actors in a fixed depth order; an actor is an
//! object, or something of the background that hides objects. Every pose is an affine function of the moment, so that labels, motions
//! and flow are exact. Frames are rendered when asked for, as those of a [`Scene`](super::Scene) are: the same options give the same
//! bytes on every machine.

mod actor;
mod camera;
mod occurrence;
mod path;
mod script;

use std::ops::Range;

use super::layer::{RICH, Sprite};
use super::render::{blur, check as check_scene, compose, exposed};
use super::texture::Style;
use super::warp::Warp;
use super::{MAX_OBJECTS, SceneOptions};
use script::Script;
use veronese::{AffineMotion, Error, Frame, Random, Result};

/// Smallest number of frames of a clip: with fewer, events have no time to happen.
pub const MIN_CLIP_FRAMES: usize = 30;
/// Largest number of frames of a clip.
pub const MAX_CLIP_FRAMES: usize = 120;

/// Events of a clip. Speeds are in pixels per frame relative to the background; in frames smaller than 320 × 240 all but
/// [`Event::Slow`] are slower in proportion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// Two objects meet, and one passes before the other.
    Crossing,
    /// An object stops, stands for some frames and goes on.
    StopAndGo,
    /// An object is out of sight at first and comes in through the border of the frame.
    Entering,
    /// An object goes out through the border of the frame.
    Leaving,
    /// An object passes behind something that belongs to the background and is hidden for at most ten frames.
    HiddenByBackground,
    /// An object passes behind a larger one and is hidden for at most ten frames.
    HiddenByObject,
    /// An object with limbs that swing. It has one number.
    Articulated,
    /// An object that moves 0.3 to 0.8 pixels.
    Slow,
    /// An object that circles at 10 to 15 pixels.
    Fast,
    /// The camera pans by 0.8 to 3 pixels.
    Pan,
    /// The camera zooms by 0.3 to 0.7 per cent per frame.
    Zoom,
    /// Another shot follows, with other objects. The events of objects alternate between the shots.
    Cut,
    /// The exposure changes by 20 to 40 per cent over a third of the clip.
    Exposure,
    /// One or two frames are much brighter.
    Flash,
    /// About every eighth frame repeats the one before it, byte for byte.
    Repeats,
}

impl Event {
    /// All events.
    pub const ALL: [Event; 15] = [
        Event::Crossing,
        Event::StopAndGo,
        Event::Entering,
        Event::Leaving,
        Event::HiddenByBackground,
        Event::HiddenByObject,
        Event::Articulated,
        Event::Slow,
        Event::Fast,
        Event::Pan,
        Event::Zoom,
        Event::Cut,
        Event::Exposure,
        Event::Flash,
        Event::Repeats,
    ];

    /// Number of objects that take part in it; 0 if it is about the camera.
    pub fn objects(self) -> usize {
        match self {
            Event::Crossing | Event::HiddenByObject => 2,
            Event::StopAndGo | Event::Entering | Event::Leaving | Event::HiddenByBackground => 1,
            Event::Articulated | Event::Slow | Event::Fast => 1,
            Event::Pan | Event::Zoom | Event::Cut | Event::Exposure | Event::Flash | Event::Repeats => 0,
        }
    }
}

/// Contents of a clip and properties of its camera.
#[derive(Clone, Debug, PartialEq)]
pub struct ClipSceneOptions {
    /// Width in pixels; default 320.
    pub width: usize,
    /// Height in pixels; default 240.
    pub height: usize,
    /// Number of frames, [`MIN_CLIP_FRAMES`] to [`MAX_CLIP_FRAMES`]; default 32.
    pub frames: usize,
    /// Least number of objects of a shot, 0 to [`MAX_OBJECTS`]; default 1. Those without an event move at 1 to 5 pixels per frame.
    pub objects: usize,
    /// Events, by default none. Objects of their own take part in each, at most [`MAX_OBJECTS`] in all.
    pub events: Vec<Event>,
    /// Share of the usual speed at which everything happens, above 0 to 1; default 1. Of a slow clip, the middle of each shot is shown: less
    /// happens, and events may be outside.
    pub speed: f64,
    /// Standard deviation of the noise at grey level 128, in grey levels, 0 to 50; default 2. It grows with √I.
    pub noise: f64,
    /// Standard deviation of the camera's blur, pixels, 0 to 5; default 0.65.
    pub blur: f64,
    /// Colour or grey; default colour.
    pub colour: bool,
    /// Whether the objects of a shot are cut from one cloth, so that colours do not tell them apart; default false.
    pub alike: bool,
    /// Seed of everything else in the clip; default 1.
    pub seed: u64,
}

impl Default for ClipSceneOptions {
    fn default() -> Self {
        ClipSceneOptions {
            width: 320,
            height: 240,
            frames: 32,
            objects: 1,
            events: Vec::new(),
            speed: 1.0,
            noise: 2.0,
            blur: 0.65,
            colour: true,
            alike: false,
            seed: 1,
        }
    }
}

/// When an event of a clip happens, and to whom.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Occurrence {
    /// The event.
    pub event: Event,
    /// The objects that take part: of two that meet, the one that is hidden first.
    pub objects: Vec<u8>,
    /// When: while the objects overlap ([`Event::Crossing`]), while the object stands still until the next frame, is partly outside
    /// (after it was, or before it is out of sight), or is wholly hidden; while the brightness differs from that of the frame before
    /// ([`Event::Exposure`]) or of the others ([`Event::Flash`]); the first frame after a cut, a repeated frame; else the whole shot.
    pub frames: Range<usize>,
}

/// The moment and the shot that a frame of a clip shows.
#[derive(Clone, Copy, Debug)]
struct Shown {
    /// Index of the shot.
    shot: usize,
    /// Moment of the shot, of a slow one between two of those that its script names.
    moment: f64,
    /// The first frame that shows this moment.
    original: usize,
    /// Gain and bias.
    exposure: [f64; 2],
}

/// A script with the textures of all it names.
struct Shot {
    script: Script,
    backdrop: Sprite,
    /// One for each part, from back to front.
    sprites: Vec<Sprite>,
}

/// A generated clip and the truth about it. In its labels 0 is the background, and an object has the same number in all frames.
pub struct ClipScene {
    /// The options of the clip.
    pub options: ClipSceneOptions,
    /// The events and when they happen, in the order of [`ClipSceneOptions::events`]. An event that found no place, as may be in tiny frames,
    /// is missing.
    pub occurrences: Vec<Occurrence>,
    shots: Vec<Shot>,
    timeline: Vec<Shown>,
}

/// Generates a clip. Frames, labels, motions and flow are computed when asked for.
///
/// ```
/// use scenes::{ClipSceneOptions, Event};
///
/// let events = vec![Event::HiddenByBackground, Event::Pan];
/// let clip = scenes::generate_clip(&ClipSceneOptions { width: 160, height: 120, events, ..ClipSceneOptions::default() })?;
/// let hidden = &clip.occurrences[0];
/// assert!(!clip.labels(hidden.frames.start)?.contains(&hidden.objects[0]));
/// assert!(clip.labels(hidden.frames.end)?.contains(&hidden.objects[0]));
/// # Ok::<(), veronese::Error>(())
/// ```
///
/// # Errors
/// [`Error::FrameSizeUnsupported`], [`Error::InvalidOption`].
pub fn generate_clip(options: &ClipSceneOptions) -> Result<ClipScene> {
    check(options)?;
    let mut random = Random::from_seed(options.seed);
    let mut timeline = timeline(options, &mut random);
    let mut shots = Vec::new();
    let mut found = Vec::new();
    for (index, events) in events_of_shots(options).into_iter().enumerate() {
        let last = timeline.iter().filter(|s| s.shot == index).map(|s| s.moment).fold(0.0, f64::max);
        let (moments, middle) = (last as usize + 1, 0.5 * last);
        let of_shot = timeline.iter_mut().filter(|s| s.shot == index);
        of_shot.for_each(|s| s.moment = middle + options.speed * (s.moment - middle));
        let next = shots.iter().map(|shot: &Shot| shot.script.numbers().len()).sum::<usize>() + 1;
        let script = Script::draw(&mut random, options, &events, moments, next as u8);
        let shown = script.occurrences.iter().map(|o| on_timeline(o, index, &timeline));
        found.extend(shown.filter(|o| !o.frames.is_empty()));
        shots.push(Shot::dress(&mut random, options, script));
    }
    let asked = |event: &Event| options.events.contains(event);
    found.extend(Event::ALL.into_iter().filter(asked).flat_map(|event| of_recording(event, &timeline)));
    found.sort_by_key(|o: &Occurrence| options.events.iter().position(|&event| event == o.event));
    Ok(ClipScene { options: options.clone(), occurrences: found, shots, timeline })
}

/// The events of objects and of the moving camera, shot by shot.
fn events_of_shots(options: &ClipSceneOptions) -> Vec<Vec<Event>> {
    let mut shots = vec![Vec::new(); if options.events.contains(&Event::Cut) { 2 } else { 1 }];
    let count = shots.len();
    let mut next = 0;
    for &event in &options.events {
        if event.objects() > 0 {
            shots[next % count].push(event);
            next += 1;
        } else if matches!(event, Event::Pan | Event::Zoom) {
            shots.iter_mut().for_each(|events| events.push(event));
        }
    }
    shots
}

/// Shots, repeated frames and exposure.
fn timeline(options: &ClipSceneOptions, random: &mut Random) -> Vec<Shown> {
    let has = |event| options.events.contains(&event);
    let count = options.frames as f64;
    let cut = (count * random.uniform(0.42, 0.58)) as usize;
    let change = random.uniform(0.2, 0.34) * if random.unit() < 0.5 { 1.0 } else { -1.0 };
    let flash = (count * random.uniform(0.25, 0.75)) as usize;
    let flashes = 1 + random.below(2);
    let mut repeated = random.choose(options.frames, options.frames / 8);
    repeated.retain(|&t| has(Event::Repeats) && t > 0 && !(has(Event::Cut) && t == cut));
    let mut timeline: Vec<Shown> = Vec::new();
    for t in 0..options.frames {
        let shot = usize::from(has(Event::Cut) && t >= cut);
        let before = timeline.last().copied().filter(|last| last.shot == shot);
        let shown = match before {
            Some(before) if repeated.contains(&t) => before,
            _ => {
                let share = ((t as f64 / count - 0.33) * 3.0).clamp(0.0, 1.0);
                let eased = share * share * (3.0 - 2.0 * share);
                let exposure = match () {
                    () if has(Event::Flash) && (flash..flash + flashes).contains(&t) => [1.3, 40.0],
                    () if has(Event::Exposure) => [libm::exp(change * eased), 0.0],
                    () => [1.0, 0.0],
                };
                Shown { shot, moment: before.map_or(0.0, |before| before.moment + 1.0), original: t, exposure }
            }
        };
        timeline.push(shown);
    }
    timeline
}

/// An occurrence in moments of a shot as one in frames of the clip.
fn on_timeline(occurrence: &Occurrence, shot: usize, timeline: &[Shown]) -> Occurrence {
    let frame = |moment: usize| {
        let later = |s: &Shown| s.shot > shot || (s.shot == shot && s.moment >= moment as f64);
        timeline.iter().position(later).unwrap_or(timeline.len())
    };
    Occurrence { frames: frame(occurrence.frames.start)..frame(occurrence.frames.end), ..occurrence.clone() }
}

/// When an event of the recording happens.
fn of_recording(event: Event, timeline: &[Shown]) -> Vec<Occurrence> {
    let changes = |differ: &dyn Fn(&Shown, &Shown) -> bool| -> Vec<usize> {
        (1..timeline.len()).filter(|&t| differ(&timeline[t - 1], &timeline[t])).collect()
    };
    let whole = |frames: Vec<usize>| -> Vec<Range<usize>> {
        let ends = frames.first().zip(frames.last());
        ends.map(|(&first, &last)| first..last + 1).into_iter().collect()
    };
    let frames = match event {
        Event::Cut => whole(changes(&|before, now| before.shot != now.shot)),
        Event::Exposure => whole(changes(&|before, now| {
            before.exposure != now.exposure && before.exposure[1] == 0.0 && now.exposure[1] == 0.0
        })),
        Event::Flash => whole((0..timeline.len()).filter(|&t| timeline[t].exposure[1] != 0.0).collect()),
        Event::Repeats => {
            changes(&|before, now| before.original == now.original).into_iter().map(|t| t..t + 1).collect()
        }
        _ => Vec::new(),
    };
    frames.into_iter().map(|frames| Occurrence { event, objects: Vec::new(), frames }).collect()
}

impl Shot {
    fn dress(random: &mut Random, options: &ClipSceneOptions, script: Script) -> Shot {
        let [low, high] = script.camera.bounds([options.width, options.height]);
        let size = [0, 1].map(|k| (high[k] - low[k]) as usize + 1);
        let style = Style::draw(random);
        let backdrop = Sprite::backdrop(random, size, low.map(|v| -v), options.colour, (&style, RICH));
        let mut sprites = Vec::new();
        for actor in &script.actors {
            let style = Style::draw(random);
            for part in &actor.parts {
                sprites.push(Sprite::cut(random, part.shape.clone(), [0.0; 2], options.colour, &style));
            }
        }
        if options.alike {
            let owners = script.owners();
            Sprite::share(sprites.iter_mut().zip(owners).filter(|(_, owner)| *owner > 0).map(|(sprite, _)| sprite));
        }
        Shot { script, backdrop, sprites }
    }
}

impl ClipScene {
    /// Number of objects; they are numbered from 1.
    pub fn objects(&self) -> usize {
        self.shots.iter().map(|shot| shot.script.numbers().len()).sum()
    }

    /// Frame `t`, from 0.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] if there is no such frame.
    pub fn frame(&self, t: usize) -> Result<Frame> {
        Frame::from_rgba(self.options.width, self.options.height, self.rgba(t)?)
    }

    /// Frame `t` as RGBA bytes, row by row.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] if there is no such frame.
    pub fn rgba(&self, t: usize) -> Result<Vec<u8>> {
        let shown = self.shown(t)?;
        let (width, height) = (self.options.width, self.options.height);
        let Shot { script, backdrop, sprites } = &self.shots[shown.shot];
        let world = script.camera.at(shown.moment).inverse();
        let parts = script.parts(shown.moment).into_iter().map(|warp| warp.inverse());
        let all = std::iter::once((backdrop, world)).chain(sprites.iter().zip(parts));
        let (mut image, _) = compose(all, width, height);
        blur(&mut image, width, height, self.options.blur);
        // Each frame has a generator of its own, so that frames may be asked for in any order.
        let own = (shown.original as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let mut random = Random::from_seed(self.options.seed ^ own);
        let [gain, bias] = shown.exposure.map(|v| v as f32);
        Ok(exposed(&image, gain, bias, self.options.noise, &mut random))
    }

    /// The number of the object that is seen at every pixel of frame `t`, row by row; 0 is the background.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] if there is no such frame.
    pub fn labels(&self, t: usize) -> Result<Vec<u8>> {
        let shown = self.shown(t)?;
        let script = &self.shots[shown.shot].script;
        let owners = script.owners();
        let seen = occurrence::coverage(script, shown.moment, [self.options.width, self.options.height]);
        Ok(seen.into_iter().map(|parts| occurrence::front(parts).map_or(0, |part| owners[part])).collect())
    }

    /// The motion of an object (0 the background) from frame `t` to the next, in sight or not; of an articulated object that of its
    /// body. `None` if there is no such object in both frames, as at a cut and at the end.
    pub fn motion(&self, object: u8, t: usize) -> Option<AffineMotion> {
        let (now, next) = self.pair(t)?;
        let script = &self.shots[now.shot].script;
        let pose = |moment: f64| match object {
            0 => Some(script.camera.at(moment)),
            _ => script.owners().iter().rposition(|&owner| owner == object).map(|part| script.parts(moment)[part]),
        };
        Some(pose(next.moment)?.after(&pose(now.moment)?.inverse()).motion())
    }

    /// Where every pixel of frame `t` is in the next, relative to where it is, pixels, row by row. `None` at a cut and at the end.
    pub fn flow(&self, t: usize) -> Option<Vec<[f32; 2]>> {
        let (now, next) = self.pair(t)?;
        let script = &self.shots[now.shot].script;
        let motion = |after: &Warp, before: &Warp| after.after(&before.inverse()).motion();
        let background = motion(&script.camera.at(next.moment), &script.camera.at(now.moment));
        let (before, after) = (script.parts(now.moment), script.parts(next.moment));
        let motions: Vec<AffineMotion> =
            after.iter().zip(&before).map(|(after, before)| motion(after, before)).collect();
        let (width, height) = (self.options.width, self.options.height);
        let seen = occurrence::coverage(script, now.moment, [width, height]);
        let flow = seen.into_iter().enumerate().map(|(p, parts)| {
            let motion = occurrence::front(parts).map_or(&background, |part| &motions[part]);
            motion.flow((p % width) as f64, (p / width) as f64).map(|v| v as f32)
        });
        Some(flow.collect())
    }

    fn shown(&self, t: usize) -> Result<&Shown> {
        self.timeline.get(t).ok_or_else(|| Error::InvalidOption {
            name: "t",
            reason: format!("must be below {}, the number of frames, not {t}", self.timeline.len()),
        })
    }

    /// Frame `t` and the next, if they belong to one shot.
    fn pair(&self, t: usize) -> Option<(&Shown, &Shown)> {
        let (now, next) = (self.timeline.get(t)?, self.timeline.get(t + 1)?);
        (now.shot == next.shot).then_some((now, next))
    }
}

fn check(options: &ClipSceneOptions) -> Result<()> {
    let bad = |name, reason: String| Err(Error::InvalidOption { name, reason });
    let &ClipSceneOptions { width, height, frames, objects, speed, noise, blur, .. } = options;
    check_scene(&SceneOptions { width, height, objects, noise, blur, ..SceneOptions::default() })?;
    if !(MIN_CLIP_FRAMES..=MAX_CLIP_FRAMES).contains(&frames) {
        return bad("frames", format!("must be from {MIN_CLIP_FRAMES} to {MAX_CLIP_FRAMES}, not {frames}"));
    }
    if !(speed > 0.0 && speed <= 1.0) {
        return bad("speed", format!("must be above 0 and at most 1, not {speed}"));
    }
    let needed: usize = options.events.iter().map(|event| event.objects()).sum();
    if needed > MAX_OBJECTS {
        return bad("events", format!("must need at most {MAX_OBJECTS} objects, not {needed}"));
    }
    Ok(())
}
