//! Propagation of one object from frame to frame in one direction: predict, cut, update.
//!
//! ```text
//! z(p) = bias + w_T logit p_T + w_M logit p_M + w_A logit p_A + r      log-odds of the object against everything else, nats
//! ```
//! `p_T` is the mask of the previous frame, moved along the motions of the pixels and by one shift of the whole object; `p_M` is the
//! probability of the pixel's colour at its position by the appearance model; `p_A` is the mask of the annotated frame where the pixel was
//! there; `r` is the log-likelihood ratio of the label found automatically. One cut gives the mask.

use super::appearance::{AppearanceModel, Source};
use super::features::FrameFeatures;
use super::label_ratios::LabelRatios;
use super::placement::{OcclusionState, Placement};
use super::prompt::overlap;
use super::proposal::{Patch, Proposal, Signs, centre_of, logit};
use super::strokes;
use super::trace::Trace;
use crate::clip::annotation::Seed;
use crate::clip::options::model;
use crate::clip::pairs::LayeredMotion;
use crate::frame::Plane;
use crate::frame::area::Area;
use crate::frame::filter::gaussian;
use crate::frame::warp::Footprint;
use crate::side::Side;

/// A frame, with all that is known about one object in it.
#[derive(Clone, Copy)]
pub(super) struct Observation<'a> {
    pub(super) features: &'a FrameFeatures,
    /// Labels found automatically.
    pub(super) found: &'a [u8],
    /// Motion to the previous frame in the direction of propagation, and from that frame to this one.
    pub(super) flows: Option<[&'a LayeredMotion; 2]>,
    pub(super) seeds: Option<&'a [Seed]>,
    /// The mask that the frame showed right after strokes were drawn: 1 inside.
    pub(super) seen: Option<&'a [u8]>,
    /// Whether the frame is an anchor of the object. If not, its seeds count only where they contradict the propagated mask.
    pub(super) is_anchor: bool,
    /// Whether the annotation spreads in the direction of propagation.
    pub(super) spreads: bool,
    /// Whether a person has given the object's whole mask.
    pub(super) is_whole: bool,
    /// Whether the annotation spreads to all frames.
    pub(super) spreads_to_all: bool,
}

/// The expected object in the next frame.
pub(super) struct Prediction {
    pub(super) area: Area,
    pub(super) log_odds: Vec<f32>,
    signs: Signs,
    centre: [f32; 2],
    placement: Option<Placement>,
    /// Where a hidden object is expected to reappear: 0 or more, the higher the likelier.
    pub(super) awaited: Option<Plane>,
}

/// The object in the last frame reached.
#[derive(Clone, Debug)]
struct Reached {
    /// 1 inside the object.
    mask: Plane,
    centre: [f32; 2],
    occlusion: OcclusionState,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Propagator {
    reached: Option<Reached>,
    appearance: Option<AppearanceModel>,
    label_ratios: LabelRatios,
    /// Leads back to the last frame passed whose whole mask a person has given.
    trace: Option<Trace>,
    /// 1 where annotations have changed the object in the last frame reached; `None` if they are about all of it.
    change: Option<Plane>,
    /// Whether it has learned the annotations that spread to all frames.
    learned_annotations: bool,
}

impl Observation<'_> {
    /// Log-odds of the object from the mask that a person saw after drawing strokes, nats.
    fn log_odds_seen(&self, p: usize) -> f32 {
        match self.seen {
            Some(seen) if seen[p] > 0 => model().seen,
            Some(_) => -model().seen,
            None => 0.0,
        }
    }
}

impl Propagator {
    pub(super) fn has_begun(&self) -> bool {
        self.reached.is_some()
    }

    /// The propagator for the opposite direction: it keeps what it learned from annotations, and forgets the frames passed.
    pub(super) fn turned(&self, features: &FrameFeatures, found: &[u8]) -> Propagator {
        let (mut appearance, mut label_ratios) = (self.appearance.clone(), LabelRatios::default());
        if let (Some(appearance), Some(reached)) = (&mut appearance, &self.reached) {
            appearance.forget_recent();
            appearance.learn(
                features,
                reached.centre,
                Source::Recent,
                1.0 - model().memory_decay,
                &side(&reached.mask),
            );
            label_ratios.learn(found, &reached.mask, true);
        }
        let reached =
            self.reached.as_ref().map(|reached| Reached { occlusion: reached.occlusion.turned(), ..reached.clone() });
        Propagator {
            reached,
            appearance,
            label_ratios,
            trace: self.trace.clone(),
            change: self.change.clone(),
            learned_annotations: self.learned_annotations,
        }
    }

    /// Learns the appearance of an object from its mask in a frame, before the propagation begins.
    pub(super) fn learn(
        &mut self,
        features: &FrameFeatures,
        source: Source,
        weight: f32,
        inside: &dyn Fn(usize) -> bool,
    ) {
        let mask = features.plane(inside);
        let Some(centre) = centre_of(&mask) else { return };
        let appearance = self.appearance.get_or_insert_with(|| AppearanceModel::of(&mask));
        appearance.learn(features, centre, source, weight, &side(&mask));
    }

    /// Learns an annotation that spreads to all frames, before the propagation begins.
    pub(super) fn learn_seeds(&mut self, features: &FrameFeatures, seeds: &[Seed], found: &[u8], object: u8) {
        let shown = shown(features, Some(seeds), found, object);
        let centre = centre_of(&shown).unwrap_or_else(|| features.middle());
        let appearance = self.appearance.get_or_insert_with(|| AppearanceModel::of(&shown));
        appearance.learn_seeds(features, centre, Some(seeds));
        self.learned_annotations = true;
    }

    /// Whether it has learned the annotation of a frame already.
    fn has_learned(&self, of: &Observation<'_>) -> bool {
        self.learned_annotations && of.spreads_to_all
    }

    /// Begins at an anchor of an object.
    pub(super) fn begin(&mut self, of: &Observation<'_>, object: u8) -> Proposal {
        let features = of.features;
        let is_found = of.found.contains(&object);
        let unannotated = |p: usize| match is_found {
            true if of.found[p] == object => model().found,
            true => -model().found,
            false => -2.0 * model().certain,
        };
        let mut log_odds: Vec<f32> = (0..features.pixels()).map(unannotated).collect();
        let shown = shown(features, of.seeds, of.found, object);
        let partly = of.seeds.is_none_or(|seeds| seeds.contains(&Seed::Nothing));
        let centre = centre_of(&shown).unwrap_or_else(|| features.middle());
        let has_learned = self.has_learned(of);
        let appearance = self.appearance.get_or_insert_with(|| AppearanceModel::of(&shown));
        if !has_learned {
            appearance.learn_seeds(features, centre, of.seeds);
        }
        let area = features.area();
        if partly {
            if !is_found {
                // Most pixels without a seed are ground.
                let has_seed = |p: usize| of.seeds.is_some_and(|seeds| seeds[p] != Seed::Nothing);
                let ground = |p: usize| (!has_seed(p)).then_some(Side::Ground);
                appearance.learn(features, centre, Source::Recent, model().unannotated, &ground);
            }
            let remembered = appearance.read(features, &area, centre);
            for ((log_odds, remembered), trust) in log_odds.iter_mut().zip(remembered).zip(appearance.trusts(features))
            {
                *log_odds =
                    trust[Side::favoured_by(*log_odds)] * *log_odds + model().bias + model().memory * logit(remembered);
            }
        }
        log_odds.iter_mut().enumerate().for_each(|(p, log_odds)| *log_odds += of.log_odds_seen(p));
        let proposal = Proposal::solved(features, area, log_odds, of.seeds);
        let mask = proposal.plane(features);
        let centre = centre_of(&mask).unwrap_or(centre);
        let occlusion = OcclusionState::new(&mask, features, centre, !partly);
        self.trace = of.is_whole.then(|| Trace::new(&mask, features));
        self.change = Self::changed(of, object, &proposal.inside(features), &Signs::default());
        self.reach(of, Reached { mask, centre, occlusion }, [partly, true]);
        proposal
    }

    /// The visible share of the object in the last frame reached, 0…1.
    pub(super) fn share(&self) -> f32 {
        self.reached.as_ref().map_or(0.0, |reached| reached.occlusion.visible_share)
    }

    /// Where the object is in the next frame; `covered` marks the pixels of objects in front.
    pub(super) fn place(&self, of: &Observation<'_>, covered: &[bool]) -> Option<Placement> {
        let reached = self.reached.as_ref()?;
        let still = LayeredMotion::still(of.features.size);
        let [_, from] = of.flows.unwrap_or([&still, &still]);
        reached.occlusion.place(of.features, from, covered)
    }

    /// Marks the pixels where the object is expected.
    pub(super) fn cover(&self, placement: &Placement, covered: &mut [bool]) {
        if let Some(reached) = &self.reached {
            reached.occlusion.template.cover(placement.shift, covered);
        }
    }

    /// Predicts the object in the next frame.
    pub(super) fn predict(&mut self, of: &Observation<'_>, placement: Option<Placement>) -> Option<Prediction> {
        let reached = self.reached.as_ref()?;
        let (features, [width, height]) = (of.features, of.features.size);
        let still = LayeredMotion::still(features.size);
        let flows @ [to, _] = of.flows.unwrap_or([&still, &still]);
        let soft = gaussian(&reached.mask, model().blur);
        let all = gaussian(&reached.occlusion.template.mask, model().blur);
        let along = |of: &Plane, p: usize| {
            let [u, v] = to.at(p % width, p / width);
            let [x, y] = [(p % width) as f32 + u as f32, (p / width) as f32 + v as f32];
            Footprint::new(x, y, width, height).sample(of.values())
        };
        let near = |p: usize| {
            let (x, y) = ((p % width) as f32, (p / width) as f32);
            let along = along(&soft, p);
            let with_all = placement.as_ref().map(|Placement { shift: [dx, dy], .. }| {
                let footprint = Footprint::new(x - dx, y - dy, width, height);
                if footprint.inside { footprint.sample(all.values()) } else { 0.0 }
            });
            [along, with_all.unwrap_or(along)]
        };
        let mut both: Vec<[f32; 2]> = (0..width * height).map(near).collect();
        let hidden = placement.as_ref().and_then(|placement| placement.hidden.as_ref());
        let mut awaited = None;
        if let Some([alike, around]) = hidden {
            let alike = gaussian(alike, model().blur);
            both.iter_mut().zip(alike.values()).for_each(|(both, &alike)| *both = [both[0].max(alike); 2]);
            awaited = Some(features.plane_of(&|p| alike.values()[p] + around.values()[p]));
        }
        let weight = if hidden.is_some() { 1.0 } else { model().trust };
        let is_near = |p: &usize| {
            both[*p][0] > model().expected || both[*p][1] > model().expected || soft.values()[*p] > model().expected
        };
        let area = Area::of(&(0..width * height).filter(is_near).collect::<Vec<usize>>(), width);
        let area = if area.width() == 0 { features.area() } else { area.grown(model().margin, width, height) };
        let carried = features.plane_of(&|p| 0.5 * (both[p][0] + both[p][1]));
        let central =
            features.plane_of(&|p| if carried.values()[p] > model().central { carried.values()[p] } else { 0.0 });
        let centre = reached
            .occlusion
            .expected_centre(placement.as_ref())
            .or_else(|| centre_of(&central))
            .unwrap_or(reached.centre);
        let learns = of.is_anchor && of.spreads && !self.has_learned(of);
        if let Some(appearance) = self.appearance.as_mut().filter(|_| learns) {
            appearance.learn_seeds(features, centre, of.seeds);
        }
        let remembered = self.appearance.as_ref().map(|appearance| appearance.read(features, &area, centre));
        let traced = self.trace.as_mut().map(|trace| trace.follow(features, flows, &area));
        let log_odds = area.pixels(width).enumerate().map(|(k, p)| {
            let traced = traced.as_ref().map_or(0.0, |of| of[k]);
            let memory = remembered.as_ref().map_or(0.0, |of| logit(of[k]));
            let ratio = self.label_ratios.ratio(of.found[p]);
            let z = of.log_odds_seen(p)
                + model().bias
                + weight * logit(carried.values()[p])
                + model().memory * memory
                + model().trace * traced
                + ratio;
            // A pixel that did not belong to the hidden object and does not look like it at that position is not its own, whatever its
            // colour.
            let most = if hidden.is_some() && carried.values()[p] < model().expected {
                -model().undecided
            } else {
                model().certain
            };
            z.clamp(-model().certain, most)
        });
        let log_odds = log_odds.collect();
        let looks = |k: usize| {
            let memory = remembered.as_ref().map_or(0.0, |of| logit(of[k]));
            memory + model().trace * traced.as_ref().map_or(0.0, |of| of[k])
        };
        let looks = Patch::new(area.clone(), width, (0..area.width() * area.height()).map(looks).collect());
        let change = self.change.as_ref().map(|change| gaussian(change, model().blur));
        let change = change.map(|change| {
            let values: Vec<f32> = (0..width * height).map(|p| along(&change, p)).collect();
            Patch::of(&values, width)
        });
        let signs = Signs { looks, change };
        Some(Prediction { area, log_odds, signs, centre, placement, awaited })
    }

    /// Cuts the mask of the next frame from its prediction and its seeds, and continues from there.
    pub(super) fn update(&mut self, of: &Observation<'_>, prediction: Prediction, object: u8) -> Proposal {
        let features = of.features;
        let Prediction { area, log_odds, signs, centre, placement, .. } = prediction;
        let solve = |seeds| Proposal::solved(features, area.clone(), log_odds.clone(), seeds);
        let contradicts = |proposal: &Proposal, seeds: &[Seed]| {
            let mut pixels = proposal.area.pixels(features.size[0]).zip(&proposal.mask);
            pixels.any(|(p, &inside)| inside > 0 && seeds[p] == Seed::Other)
        };
        // The proposal of this frame, and the one to continue from if that is another.
        let (mut proposal, goes_on) = match of.seeds {
            None => (solve(None), None),
            Some(seeds) if of.is_anchor && of.spreads => (solve(Some(seeds)), None),
            Some(seeds) => {
                let free = solve(None);
                if !of.is_anchor && !contradicts(&free, seeds) {
                    (free, None)
                } else if of.spreads {
                    let proposal = solve(Some(seeds));
                    let centre = centre_of(&proposal.plane(features)).unwrap_or(centre);
                    if let Some(appearance) = &mut self.appearance {
                        appearance.learn_seeds(features, centre, Some(seeds));
                    }
                    (proposal, None)
                } else {
                    (solve(Some(seeds)), Some(free))
                }
            }
        };
        let mask = goes_on.as_ref().unwrap_or(&proposal).plane(features);
        if of.is_whole && of.spreads {
            self.trace = Some(Trace::new(&mask, features));
        }
        let now = goes_on.as_ref().unwrap_or(&proposal).inside(features);
        self.change = Self::changed(of, object, &now, &signs);
        if let Some(reached) = self.reached.take() {
            let seen = centre_of(&mask).unwrap_or(centre);
            let occlusion = reached.occlusion.advanced(&mask, features, seen, placement.as_ref());
            let centre = if occlusion.fully_visible { seen } else { centre };
            self.reach(of, Reached { mask, centre, occlusion }, [true, false]);
        }
        proposal.signs = signs;
        proposal
    }

    /// Where annotations have changed the object, after a frame with the mask `now`: 0…1. A connected change counts only if it contains
    /// seeds, or pixels of the change that is propagated from an anchor. `None` without annotations, or if they are about all of the
    /// object.
    fn changed(of: &Observation<'_>, object: u8, now: &[u8], signs: &Signs) -> Option<Plane> {
        let (features, width) = (of.features, of.features.size[0]);
        let seeds = of.seeds.filter(|_| of.is_anchor && of.spreads);
        if seeds.is_none() && signs.change.is_none() {
            return None;
        }
        let found: Vec<u8> = of.found.iter().map(|label| u8::from(*label == object)).collect();
        let mut is_changed = vec![false; found.len()];
        let mut mark = |mask: &[u8]| {
            is_changed
                .iter_mut()
                .zip(mask)
                .zip(&found)
                .for_each(|((is_changed, now), found)| *is_changed |= now != found);
        };
        if let Some(seeds) = seeds {
            let mut now = now.to_vec();
            strokes::keep(&mut now, &found, seeds, width);
            if of.is_whole || overlap(&now, &found) < model().part {
                return None;
            }
            mark(&now);
        }
        if let Some(change) = &signs.change {
            let change = change.values(features.pixels());
            if !found.contains(&1) {
                return Some(features.plane_of(&|p| change[p]));
            }
            let looks = signs.looks.values(features.pixels());
            let mut now = now.to_vec();
            strokes::settle(&mut now, &found, &|p| looks[p], Some(&|p| change[p]), width);
            mark(&now);
        }
        Some(features.plane(&|p| is_changed[p]))
    }

    /// Continues from a frame. The appearance is learned from its mask if it `knows_little` of it.
    fn reach(&mut self, of: &Observation<'_>, reached: Reached, [knows_little, begins]: [bool; 2]) {
        // From a partly hidden object it would learn the object in front.
        if let Some(appearance) = self.appearance.as_mut().filter(|_| reached.occlusion.fully_visible) {
            appearance.fade(model().memory_decay);
            if knows_little {
                let weight = 1.0 - model().memory_decay;
                appearance.learn(of.features, reached.centre, Source::Recent, weight, &side(&reached.mask));
            }
        }
        self.label_ratios.learn(of.found, &reached.mask, begins);
        self.reached = Some(reached);
    }
}

/// The object in an anchor: its annotated pixels and, where there is no annotation, those found automatically.
fn shown(features: &FrameFeatures, seeds: Option<&[Seed]>, found: &[u8], object: u8) -> Plane {
    features.plane(&|p| match seeds.map_or(Seed::Nothing, |seeds| seeds[p]) {
        Seed::Nothing => found[p] == object,
        seed => seed == Seed::Object,
    })
}

/// The side of each pixel by a mask.
fn side(mask: &Plane) -> impl Fn(usize) -> Option<Side> {
    |p| Some(Side::object_if(mask.values()[p] >= 0.5))
}
