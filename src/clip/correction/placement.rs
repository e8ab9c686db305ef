//! Where the whole object is in a frame: the shift by which its pixels are found again since it was last fully visible. The pairs of frames
//! need not have found its motion.

use super::features::FrameFeatures;
use super::template::{Shift, Template};
use crate::clip::options::model;
use crate::clip::pairs::LayeredMotion;
use crate::frame::Plane;
use crate::order::median;

/// The last fully visible appearance of an object, and its motion since then.
#[derive(Clone, Debug)]
pub(super) struct OcclusionState {
    pub(super) template: Template,
    centre: [f32; 2],
    /// Shift from that frame to the current one, and its change per frame, working pixels.
    shift: Shift,
    velocity: Option<Shift>,
    /// Number of frames since then.
    frames: usize,
    /// Whether the object is almost fully visible in the current frame, and the share of it that is visible, 0…1.
    pub(super) fully_visible: bool,
    pub(super) visible_share: f32,
    /// Number of pixels of the whole object.
    pixels: f32,
    /// Whether its whole mask was annotated once. If not, its mask may also shrink because it was too large before.
    is_complete: bool,
}

/// Where an object is in a frame.
#[derive(Clone, Debug)]
pub(super) struct Placement {
    /// Shift since the frame in which it was fully visible.
    pub(super) shift: Shift,
    /// Whether it was found there; else the shift is extrapolated.
    found: bool,
    /// For a hidden object: how much each pixel looks like the object there, and where the object may be, both 0…1.
    pub(super) hidden: Option<[Plane; 2]>,
}

impl OcclusionState {
    pub(super) fn new(mask: &Plane, features: &FrameFeatures, centre: [f32; 2], is_complete: bool) -> OcclusionState {
        OcclusionState {
            template: Template::new(mask, features),
            centre,
            shift: [0.0; 2],
            velocity: None,
            frames: 0,
            fully_visible: true,
            visible_share: 1.0,
            pixels: mask.values().iter().sum(),
            is_complete,
        }
    }

    /// The state one frame later. A partly hidden object keeps its template and moves on with its velocity.
    pub(super) fn advanced(
        self,
        mask: &Plane,
        features: &FrameFeatures,
        centre: [f32; 2],
        placed: Option<&Placement>,
    ) -> OcclusionState {
        let pixels: f32 = mask.values().iter().sum();
        let expected = if self.fully_visible { model().shrinking * self.pixels } else { self.pixels };
        let (shift, found) = placed.map_or((self.shift, false), |placed| (placed.shift, placed.found));
        let velocity = self.velocity.unwrap_or_default();
        let onward = |share: f32, step: Shift| [0, 1].map(|k| velocity[k] + share * (step[k] - velocity[k]));
        let has_changed = || {
            let alike = self.template.alike(features, shift, &[]);
            let same = mask.values().iter().zip(alike.values()).filter(|(mask, alike)| **mask > 0.5 && **alike > 0.5);
            pixels > 0.5 * expected && (same.count() as f32) < (1.0 - model().altered) * pixels
        };
        let is_hidden = self.is_complete && pixels < (1.0 - model().hidden) * expected && !has_changed();
        let is_partly =
            self.is_complete && pixels < model().shrinking * self.pixels && pixels >= (1.0 - model().hidden) * expected;
        if is_hidden || is_partly || self.is_complete && self.frames > 0 && pixels < model().shrinking * self.pixels {
            // The deviation has accumulated over all frames since then.
            let share = match self.velocity {
                None => 1.0,
                Some(_) if found && self.frames > 0 => 1.0 / (self.frames as f32 + 2.0),
                Some(_) => 0.0,
            };
            let velocity = Some(onward(share, [0, 1].map(|k| shift[k] - self.shift[k])));
            let (frames, visible_share) = (self.frames + 1, pixels / expected);
            return OcclusionState {
                shift,
                velocity,
                frames,
                fully_visible: !is_hidden,
                visible_share,
                pixels: expected,
                ..self
            };
        }
        let step = [0, 1].map(|k| (centre[k] - self.centre[k]) / (self.frames as f32 + 1.0));
        let velocity = Some(self.velocity.map_or(step, |_| onward(1.0 - model().memory_decay, step)));
        OcclusionState {
            velocity,
            pixels: pixels.max(expected),
            ..OcclusionState::new(mask, features, centre, self.is_complete)
        }
    }

    /// The state for propagation in the opposite direction: the velocity is reversed.
    pub(super) fn turned(&self) -> OcclusionState {
        let velocity = self.velocity.map(|velocity| velocity.map(|speed| -speed));
        OcclusionState { velocity, ..self.clone() }
    }

    /// The expected centre of a hidden object; `None` for a visible one.
    pub(super) fn expected_centre(&self, placed: Option<&Placement>) -> Option<[f32; 2]> {
        placed.filter(|_| !self.fully_visible).map(|placed| [0, 1].map(|k| self.centre[k] + placed.shift[k]))
    }

    /// Where the object is in a frame; `None` if it is too small. `flow` leads to that frame from the previous one. `covered` marks the
    /// pixels of objects in front.
    pub(super) fn place(&self, features: &FrameFeatures, flow: &LayeredMotion, covered: &[bool]) -> Option<Placement> {
        let [width, height] = features.size;
        let inside: Vec<usize> = (0..features.pixels()).filter(|&p| self.template.mask.values()[p] > 0.5).collect();
        if (inside.len() as f32) < model().pixels as f32 {
            return None;
        }
        let velocity = self.velocity.unwrap_or_default();
        let onward = [0, 1].map(|k| self.shift[k] + velocity[k]);
        let again = || self.template.seen_again(features, onward, self.frames, covered);
        if !self.fully_visible {
            let seen = again();
            let shift = seen.unwrap_or(onward);
            let alike = self.template.alike(features, shift, covered);
            let around = self.template.around(features, shift, self.frames, covered);
            return Some(Placement { shift, found: seen.is_some(), hidden: Some([alike, around]) });
        }
        let placed = |shift: Shift| Some(Placement { shift, found: true, hidden: None });
        if let Some(shift) = (self.frames > 0).then(again).flatten() {
            return placed(shift);
        }
        let at = |at: usize, k: usize, size: usize| ((at as f32 + self.shift[k] + 0.5).max(0.0) as usize).min(size - 1);
        let along = [0, 1].map(|k| {
            let flow = |&p: &usize| flow.at(at(p % width, 0, width), at(p / width, 1, height))[k] as f32;
            self.shift[k] + median(&inside.iter().map(flow).collect::<Vec<f32>>()).unwrap_or(0.0)
        });
        let [(by_flow, one), (by_velocity, other)] =
            [along, onward].map(|expected| self.template.close(features, expected));
        if self.frames > 0 || one.min(other) < model().same_template {
            return placed(if other < one { by_velocity } else { by_flow });
        }
        placed(self.template.nearest(features, along))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Random;

    const SIZE: [usize; 2] = [128, 96];

    /// A patch of coarse texture at a position, over grey ground.
    fn features(place: [usize; 2]) -> FrameFeatures {
        look_behind(place, SIZE[0])
    }

    /// As [`features`], with an occluder from a column on.
    fn look_behind([left, top]: [usize; 2], column: usize) -> FrameFeatures {
        let mut random = Random::from_seed(3);
        let texture: Vec<[u8; 3]> =
            (0..36).map(|_| std::array::from_fn(|_| random.uniform(20.0, 230.0) as u8)).collect();
        FrameFeatures::painted(SIZE, |x, y| match (x.checked_sub(left), y.checked_sub(top)) {
            _ if x >= column => [30, 30, 90],
            (Some(u), Some(v)) if u < 24 && v < 24 => texture[v / 4 * 6 + u / 4],
            _ => [110, 120, 115],
        })
    }

    fn mask(features: &FrameFeatures, [left, top]: [usize; 2]) -> Plane {
        let inside = |at: usize, from: usize| (from..from + 24).contains(&at);
        features.plane(&|p| inside(p % SIZE[0], left) && inside(p / SIZE[0], top))
    }

    fn begun() -> OcclusionState {
        let first = features([16, 20]);
        OcclusionState::new(&mask(&first, [16, 20]), &first, [28.0, 32.0], true)
    }

    fn place(state: &OcclusionState, features: &FrameFeatures) -> Option<Placement> {
        state.place(features, &LayeredMotion::still(SIZE), &vec![false; features.pixels()])
    }

    #[test]
    fn a_patch_that_has_moved_is_found() {
        for [dx, dy] in [[12, 8], [40, -16], [0, 0], [3, -5]] {
            let here = features([16 + dx, 20 + dy].map(|at: isize| at as usize));
            let shift = place(&begun(), &here).unwrap().shift;
            assert_eq!(shift, [dx as f32, dy as f32], "the pairs know nothing of its motion");
        }
        let first = features([16, 20]);
        let nothing = Plane::filled(SIZE[0], SIZE[1], 0.0);
        assert!(place(&OcclusionState::new(&nothing, &first, [28.0, 32.0], true), &first).is_none());
    }

    /// The object one frame later, fully visible.
    fn moved_on(seen: &FrameFeatures, corner: [usize; 2]) -> OcclusionState {
        let placed = place(&begun(), seen);
        let centre = corner.map(|at| at as f32 + 12.0);
        begun().advanced(&mask(seen, corner), seen, centre, placed.as_ref())
    }

    #[test]
    fn one_that_is_hidden_moves_on() {
        let (gone, seen) = (features([200, 200]), features([24, 24]));
        let mut state = moved_on(&seen, [24, 24]);
        assert!(state.fully_visible && state.expected_centre(place(&state, &seen).as_ref()).is_none());
        // It moves behind the occluder until two thirds of it are visible, and then nothing.
        let covered = |p: usize| p % SIZE[0] >= 48;
        let partly = look_behind([32, 28], 48);
        let all = mask(&partly, [32, 28]);
        let left = partly.plane(&|p| all.values()[p] > 0.5 && !covered(p));
        for k in 1..4 {
            let (here, mask) =
                if k == 1 { (&partly, left.clone()) } else { (&gone, Plane::filled(SIZE[0], SIZE[1], 0.0)) };
            let placed = place(&state, here);
            assert_eq!(placed.as_ref().unwrap().shift, [8.0 * k as f32, 4.0 * k as f32], "frame {k}");
            state = state.advanced(&mask, here, [0.0; 2], placed.as_ref());
            assert!(!state.fully_visible);
            assert_eq!(state.expected_centre(placed.as_ref()), Some([36.0 + 8.0 * k as f32, 36.0 + 4.0 * k as f32]));
        }
        // The template is kept until the object reappears.
        assert_eq!(state.template.mask, mask(&seen, [24, 24]));
        let corner = [24 + 32, 24 + 16];
        let out = features(corner);
        let placed = place(&state, &out);
        state = state.advanced(&mask(&out, corner), &out, [68.0, 52.0], placed.as_ref());
        assert!(state.fully_visible);
        assert_eq!(state.template.mask, mask(&out, corner));
    }

    #[test]
    fn one_that_has_changed_is_not_hidden() {
        let seen = features([24, 24]);
        let state = moved_on(&seen, [24, 24]);
        // Two thirds of its pixels, in another colour.
        let left = |p: usize| (32..48).contains(&(p % SIZE[0])) && (28..52).contains(&(p / SIZE[0]));
        let other =
            FrameFeatures::painted(SIZE, |x, y| if left(y * SIZE[0] + x) { [40, 200, 60] } else { [110, 120, 115] });
        let mask = other.plane(&left);
        let state = state.clone().advanced(&mask, &other, [39.5, 39.5], place(&state, &other).as_ref());
        assert!(state.fully_visible);
        assert_eq!(state.template.mask, mask);
    }
}
