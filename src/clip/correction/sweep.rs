//! One object, followed from frame to frame in one direction.
//!
//! ```text
//! z(p) = bias + w_T logit p_T + w_M logit p_M + w_A evidence        odds of the object against everything else, nats
//! ```
//! `p_T` are the labels of the frame before, moved along the motions of the pixels and by one shift of the whole object; `p_M` is what the
//! memory says of the pixel's colour at its place; the evidence is that of the labels found automatically. One cut gives the mask.

use super::constants::Constants;
use super::evidence::Evidence;
use super::look::Look;
use super::memory::{Memory, Part};
use super::placing::{Shift, middle, shift_of};
use crate::clip::evidence::Flow;
use crate::frame::Plane;
use crate::frame::area::Area;
use crate::frame::filter::gaussian;
use crate::frame::warp::Footprint;
use crate::labelling::solver::Solver;

/// What is said of a pixel: nothing, or whether it belongs to the object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Said {
    Nothing,
    Other,
    Object,
}

/// Odds of what is said, nats.
const CERTAIN: f32 = 99.0;
/// Largest odds of anything else.
const MOST: f32 = 5.0;
/// Probability added to both sides.
const FLOOR: f32 = 0.02;
/// Odds of the labels found automatically where the object begins with them.
const BEGINNING: f32 = 2.0;
/// Ground around the object that is looked at, pixels of the working size.
const AROUND: usize = 24;
/// Blur of carried labels, pixels.
const BLUR: f32 = 1.5;

/// Where an object may be in a frame, and how likely.
#[derive(Clone, Debug)]
pub(super) struct Claim {
    pub(super) area: Area,
    /// Odds of the object against everything else at the pixels of the area, nats.
    pub(super) odds: Vec<f32>,
    /// 1 for the object.
    pub(super) mask: Vec<u8>,
}

/// The object in the frame that a sweep has reached.
#[derive(Clone, Debug)]
struct Front {
    /// 1 at the object's pixels.
    mask: Plane,
    centre: [f32; 2],
    whole: Whole,
}

/// The object where it was last seen whole.
#[derive(Clone, Debug)]
struct Whole {
    mask: Plane,
    coarse: [Plane; 3],
    centre: [f32; 2],
    /// From there to the frame that the sweep has reached, and the last step of it.
    shift: Shift,
    step: Shift,
    /// Whether it is seen whole in that frame.
    now: bool,
    /// Pixels that it has.
    pixels: f32,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Sweep {
    front: Option<Front>,
    memory: Option<Memory>,
    evidence: Evidence,
    /// The label that it has where it was found automatically.
    pub(super) own: Option<u8>,
}

/// What a frame tells besides its pixels.
#[derive(Clone, Copy)]
pub(super) struct Given<'a> {
    /// What is said of each pixel, if anything.
    pub(super) said: Option<&'a [Said]>,
    /// Whether what is said speaks of the object. Else it counts only where it contradicts the sweep.
    pub(super) speaks: bool,
    /// Labels found automatically.
    pub(super) found: &'a [u8],
    /// From this frame to the one before in the direction of the sweep, and from that one to this.
    pub(super) flows: Option<[&'a Flow; 2]>,
}

impl Sweep {
    /// Whether the object has been met.
    pub(super) fn has_begun(&self) -> bool {
        self.front.is_some()
    }

    /// The same sweep in the other direction: it keeps all that was given, and forgets what it passed.
    pub(super) fn turned(&self, look: &Look, found: &[u8], constants: &Constants) -> Sweep {
        let (mut memory, mut evidence) = (self.memory.clone(), Evidence::default());
        if let (Some(memory), Some(front)) = (&mut memory, &self.front) {
            memory.forget_recent();
            memory.learn(look, front.centre, Part::Recent, 1.0 - constants.decay, |p| front.side(p));
            evidence.learn(found, &front.mask, true, self.own);
        }
        Sweep { front: self.front.clone(), memory, evidence, own: self.own }
    }

    /// Learns what the object looks like where it was found, before it begins.
    pub(super) fn survey(&mut self, look: &Look, inside: &dyn Fn(usize) -> bool, constants: &Constants) {
        let [width, height] = look.size;
        let mask = Plane::from_fn(width, height, |x, y| f32::from(u8::from(inside(y * width + x))));
        let Some(centre) = centre_of(&mask) else { return };
        let memory = self.memory.get_or_insert_with(|| Memory::of(&mask, constants));
        let weight: f32 = std::env::var("SURVEY").map_or(0.3, |t| t.parse().unwrap());
        memory.learn(look, centre, Part::Surveyed, weight, |p| usize::from(mask.values()[p] < 0.5));
    }

    /// The first frame: `unsaid` are the odds where nothing is said.
    pub(super) fn begin(&mut self, look: &Look, given: &Given<'_>, unsaid: &dyn Fn(usize) -> f32, constants: &Constants) -> Claim {
        let [width, height] = look.size;
        let mut odds: Vec<f32> = (0..width * height).map(unsaid).collect();
        let here = Plane::from_fn(width, height, |x, y| {
            let p = y * width + x;
            let object = match given.said.map(|said| said[p]) {
                Some(Said::Object) => true,
                Some(Said::Other) => false,
                _ => odds[p] > 0.0,
            };
            f32::from(u8::from(object))
        });
        let partly = given.said.is_none_or(|said| said.contains(&Said::Nothing));
        if let Some(centre) = centre_of(&here).filter(|_| partly) {
            let memory = self.memory.get_or_insert_with(|| Memory::of(&here, constants));
            memory.learn_said(look, centre, given.said);
            let area = Area::whole(width, height);
            let w: f32 = std::env::var("BEG").map_or(1.0, |t| t.parse().unwrap());
            for ((odds, p), &colour) in odds.iter_mut().zip(memory.read(look, &area, centre, constants)).zip(&look.colours) {
                let trust = memory.trust(colour)[usize::from(*odds < 0.0)];
                *odds = w * trust * *odds + constants.bias + constants.memory * logit(p);
            }
        }
        let claim = solved(look, Area::whole(width, height), odds, given.said, constants);
        let mask = claim.plane(look);
        let centre = centre_of(&mask).unwrap_or([0.5 * width as f32, 0.5 * height as f32]);
        let memory = self.memory.get_or_insert_with(|| Memory::of(&mask, constants));
        if !partly {
            memory.learn_said(look, centre, given.said);
        }
        self.arrive(look, given, mask, centre, None, !partly, true, constants);
        claim
    }

    /// The next frame. With `learns`, what is said there goes on.
    pub(super) fn step(&mut self, look: &Look, given: &Given<'_>, learns: bool, constants: &Constants) -> Option<Claim> {
        let front = self.front.take()?;
        let [width, height] = look.size;
        let still = Flow::still(look.size);
        let [to, from] = given.flows.unwrap_or([&still, &still]);
        let whole = front.whole;
        let lost = !whole.now;
        let expected = if lost { Some([0, 1].map(|k| whole.shift[k] + whole.step[k])) } else { middle(&whole.mask, from) };
        let accept: f32 = std::env::var("ACCEPT").map_or(0.4, |t| t.parse().unwrap());
        let shift = expected.map(|expected| {
            let (shift, misfit) = shift_of(&whole.mask, &whole.coarse, &look.coarse, expected, constants);
            if lost && misfit > accept { expected } else { shift }
        });
        let soft = gaussian(&front.mask, BLUR);
        let all = if lost { gaussian(&whole.mask, BLUR) } else { soft.clone() };
        let place = |x: f32, y: f32| Footprint::new(x, y, width, height).sample(soft.values());
        let inside = |x: f32, y: f32| x >= 0.0 && y >= 0.0 && x < width as f32 && y < height as f32;
        let place_all = |x: f32, y: f32| if inside(x, y) { Footprint::new(x, y, width, height).sample(all.values()) } else { 0.0 };
        let near = |p: usize| {
            let (x, y) = (p % width, p / width);
            let [u, v] = to.at(x, y);
            let along = place(x as f32 + u as f32, y as f32 + v as f32);
            let with_all = shift.map(|[dx, dy]| place_all(x as f32 - dx, y as f32 - dy));
            (along, with_all)
        };
        let reached = (0..width * height).filter(|&p| {
            let (along, with_all) = near(p);
            along > 0.1 || with_all.is_some_and(|share| share > 0.1) || soft.values()[p] > 0.1
        });
        let area = Area::of(&reached.collect::<Vec<usize>>(), width);
        let area = if area.width() == 0 { Area::whole(width, height) } else { area.grown(AROUND, width, height) };
        let mut carried = Vec::with_capacity(area.width() * area.height());
        let mut moments = [0.0f64; 3];
        for y in area.rows.clone() {
            for x in area.columns.clone() {
                let (along, with_all) = near(y * width + x);
                let share = with_all.map_or(along, |with_all| 0.5 * (along + with_all));
                if share > 0.3 {
                    let share = f64::from(share);
                    moments = [moments[0] + share, moments[1] + share * x as f64, moments[2] + share * y as f64];
                }
                carried.push(share);
            }
        }
        let centre = if let Some([dx, dy]) = shift.filter(|_| lost) {
            [whole.centre[0] + dx, whole.centre[1] + dy]
        } else if moments[0] > 3.0 { [1, 2].map(|k| (moments[k] / moments[0]) as f32) } else { front.centre };
        let learned = given.speaks && learns;
        if let Some(memory) = self.memory.as_mut().filter(|_| learned) {
            memory.learn_said(look, centre, given.said);
        }
        let remembered = self.memory.as_ref().map(|memory| memory.read(look, &area, centre, constants));
        let mut odds = Vec::with_capacity(carried.len());
        for (k, carried) in carried.iter().enumerate() {
            let p = (area.rows.start + k / area.width()) * width + area.columns.start + k % area.width();
            let memory = remembered.as_ref().map_or(0.0, |of| logit(of[k]));
            let z = constants.bias + constants.carried * logit(*carried) + constants.memory * memory
                + constants.found * self.evidence.ratio(given.found[p]);
            odds.push(z.clamp(-MOST, MOST));
        }
        let free = || solved(look, area.clone(), odds.clone(), None, constants);
        let mut contradicted = false;
        let (claim, goes_on) = match given.said {
            None => (free(), None),
            Some(said) => {
                let without = if given.speaks && learns { None } else { Some(free()) };
                let contradicts = |claim: &Claim| {
                    let mut pixels = claim.pixels(width);
                    pixels.any(|(p, k)| claim.mask[k] > 0 && said[p] == Said::Other)
                };
                match without {
                    Some(claim) if !given.speaks && !contradicts(&claim) => (claim, None),
                    without => {
                        contradicted = !given.speaks && learns;
                        let with = solved(look, area.clone(), odds.clone(), Some(said), constants);
                        (with, without.filter(|_| !learns))
                    }
                }
            }
        };
        let mask = goes_on.as_ref().unwrap_or(&claim).plane(look);
        let here = if lost { centre } else { centre_of(&mask).unwrap_or(centre) };
        let before = Some((whole, shift));
        if let Some(memory) = self.memory.as_mut().filter(|_| contradicted) {
            memory.learn_said(look, here, given.said);
        }
        self.arrive(look, given, mask, here, before, false, false, constants);
        Some(claim)
    }

    /// Learns from a frame and goes on from there.
    fn arrive(&mut self, look: &Look, given: &Given<'_>, mask: Plane, centre: [f32; 2], before: Option<(Whole, Option<Shift>)>, known: bool, begins: bool, constants: &Constants) {
        let pixels: f32 = mask.values().iter().sum();
        let shrink: f32 = std::env::var("SHRINK").map_or(0.99, |t| t.parse().unwrap());
        let part: f32 = std::env::var("PART").map_or(0.6, |t| t.parse().unwrap());
        let seen = |whole: &Whole| pixels < part * shrink * whole.pixels;
        let whole = match before {
            Some((whole, shift)) if seen(&whole) => {
                let next = shift.unwrap_or(whole.shift);
                let from = if whole.now { [0.0; 2] } else { whole.shift };
                let step = if whole.now { shift.unwrap_or(whole.step) } else { [0, 1].map(|k| next[k] - from[k]) };
                Whole { shift: next, step, now: false, pixels: shrink * whole.pixels, ..whole }
            }
            before => {
                let most = before.as_ref().map_or(pixels, |(whole, _)| pixels.max(shrink * whole.pixels));
                let step = before.and_then(|(_, shift)| shift).unwrap_or([0.0; 2]);
                Whole { mask: mask.clone(), coarse: look.coarse.clone(), centre, shift: [0.0; 2], step, now: true, pixels: most }
            }
        };
        let front = Front { mask, centre, whole };
        if let Some(memory) = &mut self.memory {
            memory.fade(constants.decay);
            if !known {
                memory.learn(look, centre, Part::Recent, 1.0 - constants.decay, |p| front.side(p));
            }
        }
        self.evidence.learn(given.found, &front.mask, begins, self.own);
        self.front = Some(front);
    }
}

impl Front {
    /// 0 for a pixel of the object, 1 for ground.
    fn side(&self, p: usize) -> usize {
        usize::from(self.mask.values()[p] < 0.5)
    }
}

impl Claim {
    /// The mask as a plane.
    fn plane(&self, look: &Look) -> Plane {
        let [width, height] = look.size;
        let mut plane = Plane::filled(width, height, 0.0);
        for (p, k) in self.pixels(width) {
            plane.values_mut()[p] = f32::from(self.mask[k]);
        }
        plane
    }

    /// Pixels of the area with their places in it.
    pub(super) fn pixels(&self, width: usize) -> impl Iterator<Item = (usize, usize)> {
        let Area { columns, rows } = self.area.clone();
        let across = columns.len();
        (0..across * rows.len()).map(move |k| ((rows.start + k / across) * width + columns.start + k % across, k))
    }

    /// Odds at a pixel.
    pub(super) fn at(&self, p: usize, width: usize) -> f32 {
        self.place(p, width).map_or(NOWHERE, |k| self.odds[k])
    }

    /// Place of a pixel within the area.
    pub(super) fn place(&self, p: usize, width: usize) -> Option<usize> {
        let (x, y) = (p % width, p / width);
        let Area { columns, rows } = &self.area;
        (columns.contains(&x) && rows.contains(&y)).then(|| (y - rows.start) * columns.len() + x - columns.start)
    }
}

/// The mask of least energy, with what is said of the frame.
fn solved(look: &Look, mut area: Area, mut odds: Vec<f32>, said: Option<&[Said]>, constants: &Constants) -> Claim {
    let [width, height] = look.size;
    let mut all_said = false;
    if let Some(said) = said {
        let mut whole = vec![-MOST; width * height];
        let claim = Claim { area, odds, mask: Vec::new() };
        for (p, k) in claim.pixels(width) {
            whole[p] = claim.odds[k];
        }
        (area, odds) = (Area::whole(width, height), whole);
        for (odds, said) in odds.iter_mut().zip(said) {
            match said {
                Said::Nothing => {}
                Said::Other => *odds = -CERTAIN,
                Said::Object => *odds = CERTAIN,
            }
        }
        all_said = !said.contains(&Said::Nothing);
    }
    let mask = if all_said { odds.iter().map(|&z| u8::from(z > 0.0)).collect() } else { cut(look, &area, &odds, constants) };
    Claim { area, odds, mask }
}

/// Centre of the object's pixels, if there are enough.
fn centre_of(mask: &Plane) -> Option<[f32; 2]> {
    let mut moments = [0.0f64; 3];
    for y in 0..mask.height() {
        for (x, &share) in mask.row(y).iter().enumerate() {
            let share = f64::from(share);
            moments = [moments[0] + share, moments[1] + share * x as f64, moments[2] + share * y as f64];
        }
    }
    (moments[0] >= 3.0).then(|| [1, 2].map(|k| (moments[k] / moments[0]) as f32))
}

pub(super) fn logit(p: f32) -> f32 {
    libm::logf((p + FLOOR) / (1.0 - p + FLOOR))
}

/// The mask of least energy.
pub(super) fn cut(look: &Look, area: &Area, odds: &[f32], constants: &Constants) -> Vec<u8> {
    let (width, height) = (area.width(), area.height());
    if width < 3 || height < 3 {
        return odds.iter().map(|&z| u8::from(z > 0.0)).collect();
    }
    let borders = look.borders.cropped(area, constants.smoothness);
    let object = Plane::from_buffer(width, height, odds.iter().map(|&z| -z).collect());
    borders.solve(&[Plane::filled(width, height, 0.0), object], Solver::FAST).to_vec()
}

/// Odds where nothing is said, of an object that begins with what was found of it.
pub(super) fn beginning(found: bool) -> f32 {
    if found { BEGINNING } else { -BEGINNING }
}

/// Odds where nothing is said, of an object that begins with what is said alone.
pub(super) const NOWHERE: f32 = -9.0;
