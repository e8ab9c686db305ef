//! One object, followed from frame to frame in one direction.
//!
//! ```text
//! z(p) = bias + w_T logit p_T + w_M logit p_M + w_A evidence        odds of the object against everything else, nats
//! ```
//! `p_T` are the labels of the frame before, moved along the motions of the pixels and by one shift of the whole object; `p_M` is what the
//! memory says of the pixel's colour at its place; the evidence is that of the labels found automatically. One cut gives the mask.

use super::evidence::Evidence;
use super::look::Look;
use super::memory::{Memory, Part};
use super::placing::{Placed, Whole};
use crate::clip::annotation::Seed;
use crate::clip::evidence::Flow;
use crate::clip::model;
use crate::frame::Plane;
use crate::frame::area::Area;
use crate::frame::filter::gaussian;
use crate::frame::warp::Footprint;
use crate::labelling::solver::Solver;

/// Odds of what is said, nats: more than all borders of a pixel cost.
pub(super) const CERTAIN: f32 = 99.0;

/// What a frame tells besides its pixels.
#[derive(Clone, Copy)]
pub(super) struct Given<'a> {
    /// What is said of each pixel, if anything.
    pub(super) said: Option<&'a [Seed]>,
    /// Whether what is said speaks of the object. Else it counts only where it contradicts the sweep.
    pub(super) speaks: bool,
    /// Whether that is for all frames.
    pub(super) is_for_all: bool,
    /// Whether what is said goes on from here.
    pub(super) spreads: bool,
    /// Labels found automatically.
    pub(super) found: &'a [u8],
    /// From this frame to the one before in the direction of the sweep, and from that one to this.
    pub(super) flows: Option<[&'a Flow; 2]>,
}

/// Where an object may be in a frame, and how likely.
#[derive(Clone, Debug)]
pub(super) struct Claim {
    pub(super) area: Area,
    /// Odds of the object against everything else at the pixels of the area, nats.
    pub(super) odds: Vec<f32>,
    /// 1 for the object.
    pub(super) mask: Vec<u8>,
    /// Odds of the object by its looks alone at every pixel of the frame, 0 where they are not known; empty if they are nowhere.
    looks: Vec<f32>,
}

/// What is expected of an object in the next frame.
pub(super) struct Expected {
    pub(super) area: Area,
    pub(super) odds: Vec<f32>,
    looks: Vec<f32>,
    centre: [f32; 2],
    placed: Option<Placed>,
    /// How much each pixel is awaited to be that of a hidden object.
    pub(super) awaited: Option<Plane>,
}

/// The object in the frame that a sweep has reached.
#[derive(Clone, Debug)]
struct Front {
    /// 1 at the object's pixels.
    mask: Plane,
    centre: [f32; 2],
    whole: Whole,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Sweep {
    front: Option<Front>,
    memory: Option<Memory>,
    evidence: Evidence,
    /// Whether it knows already what is said for all frames.
    has_heard: bool,
}

impl Sweep {
    /// Whether the object has been met.
    pub(super) fn has_begun(&self) -> bool {
        self.front.is_some()
    }

    /// The same sweep in the other direction: it keeps all that was given, and forgets what it passed.
    pub(super) fn turned(&self, look: &Look, found: &[u8]) -> Sweep {
        let (mut memory, mut evidence) = (self.memory.clone(), Evidence::default());
        if let (Some(memory), Some(front)) = (&mut memory, &self.front) {
            memory.forget_recent();
            memory.learn(look, front.centre, Part::Recent, 1.0 - model().decay, &|p| front.side(p));
            evidence.learn(found, &front.mask, true);
        }
        let front = self.front.as_ref().map(|front| Front { whole: front.whole.turned(), ..front.clone() });
        Sweep { front, memory, evidence, has_heard: self.has_heard }
    }

    /// Learns what the object looks like in a frame where it was found, before it begins.
    pub(super) fn survey(&mut self, look: &Look, inside: &dyn Fn(usize) -> bool) {
        let mask = look.plane(inside);
        let Some(centre) = centre_of(&mask) else { return };
        let memory = self.memory.get_or_insert_with(|| Memory::of(&mask));
        memory.learn(look, centre, Part::Found, model().automatic, &|p| usize::from(mask.values()[p] < 0.5));
    }

    /// Takes what a frame shows of the object for what it looks like.
    pub(super) fn know(&mut self, look: &Look, inside: &dyn Fn(usize) -> bool) {
        let mask = look.plane(inside);
        let Some(centre) = centre_of(&mask) else { return };
        let memory = self.memory.get_or_insert_with(|| Memory::of(&mask));
        memory.learn(look, centre, Part::Recent, 1.0, &|p| usize::from(mask.values()[p] < 0.5));
    }

    /// Learns what is said in some frame for all frames.
    pub(super) fn hear(&mut self, look: &Look, said: &[Seed], found: &[u8], number: u8) {
        let shown = shown(look, Some(said), found, number);
        let centre = centre_of(&shown).unwrap_or_else(|| look.middle());
        let memory = self.memory.get_or_insert_with(|| Memory::of(&shown));
        memory.learn_said(look, centre, Some(said));
        self.has_heard = true;
    }

    /// Whether it has learnt already what is said of a frame.
    fn knows(&self, given: &Given<'_>) -> bool {
        self.has_heard && given.is_for_all
    }

    /// The first frame. `number` is what the object is called where it was found.
    pub(super) fn begin(&mut self, look: &Look, given: &Given<'_>, number: u8) -> Claim {
        let is_found = given.found.contains(&number);
        let unsaid = |p: usize| match is_found {
            true if given.found[p] == number => model().guess,
            true => -model().guess,
            false => -2.0 * model().certain,
        };
        let mut odds: Vec<f32> = (0..look.pixels()).map(unsaid).collect();
        let shown = shown(look, given.said, given.found, number);
        let partly = given.said.is_none_or(|said| said.contains(&Seed::Nothing));
        let centre = centre_of(&shown).unwrap_or_else(|| look.middle());
        let knows = self.knows(given);
        let memory = self.memory.get_or_insert_with(|| Memory::of(&shown));
        if !knows {
            memory.learn_said(look, centre, given.said);
        }
        let area = look.area();
        if partly {
            if !is_found {
                // Most of what nothing is said of is ground.
                let is_said = |p: usize| given.said.is_some_and(|said| said[p] != Seed::Nothing);
                memory.learn(look, centre, Part::Recent, model().few, &|p| if is_said(p) { 2 } else { 1 });
            }
            let remembered = memory.read(look, &area, centre);
            for ((odds, remembered), trust) in odds.iter_mut().zip(remembered).zip(memory.trusts(look)) {
                *odds = trust[usize::from(*odds < 0.0)] * *odds + model().bias + model().memory * logit(remembered);
            }
        }
        let claim = solved(look, area, odds, given.said);
        let mask = claim.plane(look);
        let centre = centre_of(&mask).unwrap_or(centre);
        let whole = Whole::new(&mask, look, centre, !partly);
        self.arrive(look, given, Front { mask, centre, whole }, [partly, true]);
        claim
    }

    /// The share of the object that was seen last.
    pub(super) fn share(&self) -> f32 {
        self.front.as_ref().map_or(0.0, |front| front.whole.share)
    }

    /// Where the object is in the next frame.
    pub(super) fn place(&self, look: &Look, given: &Given<'_>, covered: &[bool]) -> Option<Placed> {
        let front = self.front.as_ref()?;
        let still = Flow::still(look.size);
        let [_, from] = given.flows.unwrap_or([&still, &still]);
        front.whole.place(look, from, covered)
    }

    /// Marks where the object is expected.
    pub(super) fn cover(&self, placed: &Placed, covered: &mut [bool]) {
        if let Some(front) = &self.front {
            front.whole.view.cover(placed.shift, covered);
        }
    }

    /// What is expected in the next frame.
    pub(super) fn expect(&mut self, look: &Look, given: &Given<'_>, placed: Option<Placed>) -> Option<Expected> {
        let front = self.front.as_ref()?;
        let [width, height] = look.size;
        let still = Flow::still(look.size);
        let [to, _] = given.flows.unwrap_or([&still, &still]);
        let soft = gaussian(&front.mask, model().motion);
        let all = gaussian(&front.whole.view.mask, model().motion);
        let near = |p: usize| {
            let (x, y) = ((p % width) as f32, (p / width) as f32);
            let [u, v] = to.at(p % width, p / width);
            let along = Footprint::new(x + u as f32, y + v as f32, width, height).sample(soft.values());
            let with_all = placed.as_ref().map(|Placed { shift: [dx, dy], .. }| {
                let footprint = Footprint::new(x - dx, y - dy, width, height);
                if footprint.inside { footprint.sample(all.values()) } else { 0.0 }
            });
            [along, with_all.unwrap_or(along)]
        };
        let mut both: Vec<[f32; 2]> = (0..width * height).map(near).collect();
        let hidden = placed.as_ref().and_then(|placed| placed.hidden.as_ref());
        let mut awaited = None;
        if let Some([alike, around]) = hidden {
            let alike = gaussian(alike, model().motion);
            both.iter_mut().zip(alike.values()).for_each(|(both, &alike)| *both = [both[0].max(alike); 2]);
            awaited = Some(look.plane_of(&|p| alike.values()[p] + around.values()[p]));
        }
        let weight = if hidden.is_some() { 1.0 } else { model().trust };
        let reached =
            |p: &usize| both[*p][0] > model().few || both[*p][1] > model().few || soft.values()[*p] > model().few;
        let area = Area::of(&(0..width * height).filter(reached).collect::<Vec<usize>>(), width);
        let area = if area.width() == 0 { look.area() } else { area.grown(model().margin, width, height) };
        let carried = look.plane_of(&|p| 0.5 * (both[p][0] + both[p][1]));
        let central = look.plane_of(&|p| if carried.values()[p] > model().part { carried.values()[p] } else { 0.0 });
        let centre =
            front.whole.expected_centre(placed.as_ref()).or_else(|| centre_of(&central)).unwrap_or(front.centre);
        let learns = given.speaks && given.spreads && !self.knows(given);
        if let Some(memory) = self.memory.as_mut().filter(|_| learns) {
            memory.learn_said(look, centre, given.said);
        }
        let remembered = self.memory.as_ref().map(|memory| memory.read(look, &area, centre));
        let odds = area.pixels(width).enumerate().map(|(k, p)| {
            let memory = remembered.as_ref().map_or(0.0, |of| logit(of[k]));
            let found = self.evidence.ratio(given.found[p]);
            let z = model().bias + weight * logit(carried.values()[p]) + model().memory * memory + found;
            // What neither was its own nor looks as it did is not of a hidden object, whatever its colours.
            let most = if hidden.is_some() && carried.values()[p] < model().few {
                -model().undecided
            } else {
                model().certain
            };
            z.clamp(-model().certain, most)
        });
        let odds = odds.collect();
        let mut looks = vec![0.0; look.pixels()];
        if let Some(remembered) = &remembered {
            area.pixels(width).zip(remembered).for_each(|(p, r)| looks[p] = logit(*r));
        }
        Some(Expected { area, odds, looks, centre, placed, awaited })
    }

    /// Comes to the next frame, with what was expected of it and what is said there.
    pub(super) fn step(&mut self, look: &Look, given: &Given<'_>, expected: Expected) -> Claim {
        let Expected { area, odds, looks, centre, placed, .. } = expected;
        let solve = |said| solved(look, area.clone(), odds.clone(), said);
        let contradicts = |claim: &Claim, said: &[Seed]| {
            let mut pixels = claim.area.pixels(look.size[0]).zip(&claim.mask);
            pixels.any(|(p, &inside)| inside > 0 && said[p] == Seed::Other)
        };
        // The claim of this frame, and what goes on from it if that is something else.
        let (claim, goes_on) = match given.said {
            None => (solve(None), None),
            Some(said) if given.speaks && given.spreads => (solve(Some(said)), None),
            Some(said) => {
                let free = solve(None);
                if !given.speaks && !contradicts(&free, said) {
                    (free, None)
                } else if given.spreads {
                    let claim = solve(Some(said));
                    let centre = centre_of(&claim.plane(look)).unwrap_or(centre);
                    if let Some(memory) = &mut self.memory {
                        memory.learn_said(look, centre, Some(said));
                    }
                    (claim, None)
                } else {
                    (solve(Some(said)), Some(free))
                }
            }
        };
        let mask = goes_on.as_ref().unwrap_or(&claim).plane(look);
        if let Some(front) = self.front.take() {
            let seen = centre_of(&mask).unwrap_or(centre);
            let whole = front.whole.gone_on(&mask, look, seen, placed.as_ref());
            let centre = if whole.now { seen } else { centre };
            self.arrive(look, given, Front { mask, centre, whole }, [true, false]);
        }
        let mut claim = claim;
        claim.looks = looks;
        claim
    }

    /// Goes on from a frame. It learns its labels there if it `knows_little` of them.
    fn arrive(&mut self, look: &Look, given: &Given<'_>, front: Front, [knows_little, begins]: [bool; 2]) {
        // Of an object that is partly hidden it would learn what hides it.
        if let Some(memory) = self.memory.as_mut().filter(|_| front.whole.now) {
            memory.fade(model().decay);
            if knows_little {
                memory.learn(look, front.centre, Part::Recent, 1.0 - model().decay, &|p| front.side(p));
            }
        }
        self.evidence.learn(given.found, &front.mask, begins);
        self.front = Some(front);
    }
}

/// The object in a frame that speaks of it: what is said, and what was found of it elsewhere.
fn shown(look: &Look, said: Option<&[Seed]>, found: &[u8], number: u8) -> Plane {
    look.plane(&|p| match said.map_or(Seed::Nothing, |said| said[p]) {
        Seed::Nothing => found[p] == number,
        said => said == Seed::Object,
    })
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
        let mut plane = Plane::filled(look.size[0], look.size[1], 0.0);
        for (p, &inside) in self.area.pixels(look.size[0]).zip(&self.mask) {
            plane.values_mut()[p] = f32::from(inside);
        }
        plane
    }

    /// Odds of the object at a pixel by its looks alone; 0 if they are not known.
    pub(super) fn looks_at(&self, p: usize) -> f32 {
        self.looks.get(p).copied().unwrap_or(0.0)
    }

    /// The odds of two claims, by the weights of each.
    pub(super) fn joined(look: &Look, claims: [&Claim; 2], weights: [f32; 2]) -> Claim {
        let (area, width) = (claims[0].area.with(&claims[1].area), look.size[0]);
        let mean = |of: [f32; 2]| (of[0] * weights[0] + of[1] * weights[1]) / (weights[0] + weights[1]);
        let odds: Vec<f32> = area.pixels(width).map(|p| mean(claims.map(|claim| claim.at(p, width)))).collect();
        let looks = (0..look.pixels()).map(|p| mean(claims.map(|claim| claim.looks_at(p)))).collect();
        let mask = cut(look, &area, &odds);
        Claim { area, odds, mask, looks }
    }

    /// Odds at a pixel.
    pub(super) fn at(&self, p: usize, width: usize) -> f32 {
        odds_at(&self.area, &self.odds, p, width)
    }
}

/// Odds at a pixel of which an area may know.
pub(super) fn odds_at(area: &Area, odds: &[f32], p: usize, width: usize) -> f32 {
    let inside = area.columns.contains(&(p % width)) && area.rows.contains(&(p / width));
    if inside { odds[area.index_of(p, width)] } else { -2.0 * model().certain }
}

/// Centre of the object's pixels, if there are any.
pub(super) fn centre_of(mask: &Plane) -> Option<[f32; 2]> {
    let mut moments = [0.0f64; 3];
    for y in 0..mask.height() {
        for (x, &share) in mask.row(y).iter().enumerate() {
            let share = f64::from(share);
            moments = [moments[0] + share, moments[1] + share * x as f64, moments[2] + share * y as f64];
        }
    }
    (moments[0] > 0.0).then(|| [1, 2].map(|k| (moments[k] / moments[0]) as f32))
}

pub(super) fn logit(p: f32) -> f32 {
    libm::logf((p + model().doubt) / (1.0 - p + model().doubt))
}

/// The mask of least energy, with what is said of the frame.
pub(super) fn solved(look: &Look, area: Area, odds: Vec<f32>, said: Option<&[Seed]>) -> Claim {
    let Some(said) = said else {
        let mask = cut(look, &area, &odds);
        return Claim { area, odds, mask, looks: Vec::new() };
    };
    let odds: Vec<f32> = (0..look.pixels())
        .map(|p| match said[p] {
            Seed::Nothing => odds_at(&area, &odds, p, look.size[0]),
            Seed::Other | Seed::Dropped => -CERTAIN,
            Seed::Object => CERTAIN,
        })
        .collect();
    let area = look.area();
    let mask = if said.contains(&Seed::Nothing) {
        cut(look, &area, &odds)
    } else {
        odds.iter().map(|&z| u8::from(z > 0.0)).collect()
    };
    Claim { area, odds, mask, looks: Vec::new() }
}

/// The mask of least energy.
pub(super) fn cut(look: &Look, area: &Area, odds: &[f32]) -> Vec<u8> {
    let (width, height) = (area.width(), area.height());
    let borders = look.borders.cropped(area, model().smoothness);
    let object = Plane::from_vec(width, height, odds.iter().map(|&z| -z).collect());
    borders.solve(&[Plane::filled(width, height, 0.0), object], Solver::FAST)
}
