//! Objects that are propagated together and compete for pixels.

use super::features::FrameFeatures;
use super::placement::Placement;
use super::plan::Members;
use super::propagator::{Observation, Prediction};
use super::proposal::{Proposal, log_odds_at};
use super::track::Track;
use crate::clip::annotation::{Direction, Seed, Spread};
use crate::clip::options::model;
use crate::clip::pairs::LayeredMotion;
use crate::frame::Plane;
use crate::order::sort_few;

/// A frame, with all that is known about the objects in it.
pub(super) struct Scene<'a> {
    pub(super) features: &'a FrameFeatures,
    /// For an object number, its seeds in the frame, if there are any, and the frames to which they spread.
    pub(super) seeds: &'a dyn Fn(u8) -> Option<(Vec<Seed>, Spread)>,
    /// For an object number, the mask that the frame showed right after strokes were drawn: 1 inside.
    pub(super) seen: &'a dyn Fn(u8) -> Option<Vec<u8>>,
    /// Labels found automatically.
    pub(super) found: &'a [u8],
    /// Motion to the previous frame in the direction of propagation, and from that frame to this one.
    pub(super) flows: Option<[&'a LayeredMotion; 2]>,
}

#[derive(Clone, Debug)]
pub(super) struct Group {
    pub(super) tracks: Vec<Track>,
    /// Numbers of the objects that change. The others only compete with them.
    pub(super) changing: Vec<u8>,
}

impl Group {
    /// A group in a clip of so many frames.
    pub(super) fn new(Members { anchors, changing }: Members, frames: usize) -> Group {
        let tracks = anchors.into_iter().map(|(object, anchors)| Track::new(object, anchors, frames));
        Group { tracks: tracks.collect(), changing }
    }

    /// The proposals of the changing objects for a frame. With `is_kept`, each track also keeps its proposal for the backward pass.
    pub(super) fn visit(
        &mut self,
        frame: usize,
        direction: Direction,
        is_kept: bool,
        scene: &Scene<'_>,
    ) -> Vec<(u8, Option<Proposal>)> {
        let seeds: Vec<Option<(Vec<Seed>, Spread)>> =
            self.tracks.iter().map(|track| (scene.seeds)(track.object)).collect();
        let seen: Vec<Option<Vec<u8>>> = self.tracks.iter().map(|track| (scene.seen)(track.object)).collect();
        let observations: Vec<Observation<'_>> = self
            .tracks
            .iter()
            .zip(&seeds)
            .zip(&seen)
            .map(|((track, seeds), seen)| Observation {
                features: scene.features,
                found: scene.found,
                flows: scene.flows,
                seen: seen.as_deref(),
                seeds: seeds.as_ref().map(|(seeds, _)| &seeds[..]),
                is_anchor: track.anchor(frame).is_some(),
                spreads: seeds.as_ref().is_none_or(|(_, spread)| spread.goes(direction)),
                is_whole: track.anchor(frame).is_some_and(|anchor| anchor.is_whole),
                spreads_to_all: track.anchor(frame).is_some_and(|anchor| anchor.spread == Spread::Both),
            })
            .collect();
        let placements = self.place(frame, direction, &observations);
        let mut predictions: Vec<Option<Prediction>> = self
            .tracks
            .iter_mut()
            .zip(&observations)
            .zip(placements)
            .map(|((track, of), placement)| track.coming(frame, direction)?.predict(of, placement))
            .collect();
        compete(&mut predictions, scene.features.size[0]);
        let mut proposals = Vec::new();
        for ((track, of), prediction) in self.tracks.iter_mut().zip(&observations).zip(predictions) {
            let proposal = track.visit(frame, direction, of, prediction);
            if is_kept {
                track.keep(frame, proposal.clone());
            }
            if self.changing.contains(&track.object) {
                proposals.push((track.object, proposal));
            }
        }
        proposals
    }

    /// Places the objects from front to back: the larger the visible share of an object, the further in front it is.
    fn place(&mut self, frame: usize, direction: Direction, of: &[Observation<'_>]) -> Vec<Option<Placement>> {
        let share = |track: &mut Track| track.coming(frame, direction).map_or(0.0, |propagator| propagator.share());
        let shares: Vec<f32> = self.tracks.iter_mut().map(share).collect();
        let mut order: Vec<usize> = (0..self.tracks.len()).collect();
        sort_few(&mut order, |&one, &other| shares[other].total_cmp(&shares[one]));
        let mut covered = of.first().map_or_else(Vec::new, |of| vec![false; of.features.pixels()]);
        let mut placements = vec![None; self.tracks.len()];
        for k in order {
            let Some(propagator) = self.tracks[k].coming(frame, direction) else { continue };
            placements[k] = propagator.place(&of[k], &covered);
            if let Some(placement) = &placements[k] {
                propagator.cover(placement, &mut covered);
            }
        }
        placements
    }
}

/// Turns the log-odds of each object into those against everything else, including the other objects.
fn compete(predictions: &mut [Option<Prediction>], width: usize) {
    // Where a hidden object is expected to reappear, no other object grows.
    let awaited: Vec<Option<Plane>> = predictions.iter().flatten().map(|of| of.awaited.clone()).collect();
    for (k, of) in predictions.iter_mut().flatten().enumerate() {
        for (_, awaited) in awaited.iter().enumerate().filter(|(j, _)| *j != k) {
            let Some(awaited) = awaited else { continue };
            let pixels = of.log_odds.iter_mut().zip(of.area.pixels(width));
            pixels.for_each(|(log_odds, p)| *log_odds -= model().certain * awaited.values()[p]);
        }
    }
    let alone: Vec<_> = predictions.iter().flatten().map(|of| (of.area.clone(), of.log_odds.clone())).collect();
    for (k, of) in predictions.iter_mut().flatten().enumerate() {
        for (j, (area, log_odds)) in alone.iter().enumerate().filter(|(_, (area, _))| area.touches(&of.area)) {
            if j == k {
                continue;
            }
            for (at, p) in of.area.pixels(width).enumerate() {
                let rival = log_odds_at(area, log_odds, p, width);
                let own = alone[k].1[at];
                if rival > 0.0 {
                    of.log_odds[at] = of.log_odds[at].min(own - rival);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Random;
    use crate::answer::UNLABELLED;
    use crate::motion::AffineMotion;

    const SIZE: [usize; 2] = [96, 64];

    fn anchor(frame: usize) -> crate::clip::correction::plan::Anchor {
        crate::clip::correction::plan::Anchor { frame, spread: Spread::Both, is_whole: true }
    }

    /// The seeds of an object in a label map.
    fn of_object(labels: &[u8], number: u8) -> Vec<Seed> {
        let of = |&label: &u8| match label {
            UNLABELLED => Seed::Nothing,
            label if label == number => Seed::Object,
            _ => Seed::Other,
        };
        labels.iter().map(of).collect()
    }

    #[test]
    fn two_rivals_share_no_pixel() {
        // Two objects of one colour side by side; only one frame annotates the border between them.
        let features = FrameFeatures::painted(SIZE, |x, y| match (20..68).contains(&x) && (20..44).contains(&y) {
            true => [190, 70, 60],
            false => [110, 120, 115],
        });
        let inside = |p: usize| (20..44).contains(&(p / SIZE[0]));
        let label = |p: usize| match p % SIZE[0] {
            20..44 if inside(p) => 1,
            44..68 if inside(p) => 2,
            _ => 0,
        };
        let labels: Vec<u8> = (0..features.pixels()).map(label).collect();
        let tracks = [1, 2].map(|number| Track::new(number, vec![anchor(0)], 3)).to_vec();
        let mut group = Group { tracks, changing: vec![1, 2] };
        let found = vec![0; features.pixels()];
        for t in 0..3 {
            let seeds = |number: u8| (t == 0).then(|| (of_object(&labels, number), Spread::Both));
            let scene = Scene { features: &features, seeds: &seeds, seen: &|_| None, found: &found, flows: None };
            let proposals = group.visit(t, Direction::Forward, false, &scene);
            let mut owners = vec![0; features.pixels()];
            for (number, proposal) in proposals {
                let proposal = proposal.unwrap();
                let own: Vec<usize> = proposal
                    .area
                    .pixels(SIZE[0])
                    .zip(&proposal.mask)
                    .filter(|(_, m)| **m > 0)
                    .map(|(p, _)| p)
                    .collect();
                assert!((450..700).contains(&own.len()), "frame {t}: {number} has {} of 576 pixels", own.len());
                for p in own {
                    assert_eq!(std::mem::replace(&mut owners[p], number), 0, "frame {t}, pixel {p}");
                }
            }
        }
    }

    #[test]
    fn later_annotations_count_in_earlier_frames() {
        // Both parts were found as one object. This frame has a stroke on the left part, a later frame has a stroke that excludes the right
        // part.
        let place = |x: usize, y: usize| match (20..44).contains(&y) {
            true if (20..44).contains(&x) => 1,
            true if (44..68).contains(&x) => 2,
            _ => 0,
        };
        let features =
            FrameFeatures::painted(SIZE, |x, y| [[110, 120, 115], [190, 70, 60], [60, 80, 190]][place(x, y)]);
        let at = |p: usize| place(p % SIZE[0], p / SIZE[0]);
        let found: Vec<u8> = (0..features.pixels()).map(|p| u8::from(at(p) > 0)).collect();
        let stroke = |part: usize, label: u8| -> Vec<u8> {
            let is_in = |p: &usize| at(*p) == part && (28..36).contains(&(p / SIZE[0]));
            (0..features.pixels()).map(|p| if is_in(&p) { label } else { UNLABELLED }).collect()
        };
        let (here, later) = (stroke(1, 1), stroke(2, 0));
        let shares = [false, true].map(|learns| {
            let mut track = Track::new(1, vec![anchor(0), anchor(3)], 4);
            for labels in [&here, &later].into_iter().filter(|_| learns) {
                track.learn_seeds(&features, &of_object(labels, 1), &found);
            }
            let mut group = Group { tracks: vec![track], changing: vec![1] };
            let seeds = |number: u8| Some((of_object(&here, number), Spread::Both));
            let scene = Scene { features: &features, seeds: &seeds, seen: &|_| None, found: &found, flows: None };
            let proposals = group.visit(0, Direction::Forward, true, &scene);
            let proposal = proposals[0].1.as_ref().unwrap();
            let of = |part: usize| {
                let pixels = proposal.area.pixels(SIZE[0]).zip(&proposal.mask);
                pixels.filter(|(p, inside)| **inside > 0 && at(*p) == part).count()
            };
            [of(1), of(2)]
        });
        assert_eq!(shares, [[24 * 24, 24 * 24], [24 * 24, 0]]);
    }

    #[test]
    fn an_object_reappears_from_behind_a_like_one() {
        // Both have the same texture. The first passes behind the second, which rests, and is completely hidden for a while.
        let mut random = Random::from_seed(7);
        let patches: Vec<[u8; 3]> =
            (0..10 * 8).map(|_| [20, 30, 25].map(|step| 60 + step * random.uniform(0.0, 4.0) as u8)).collect();
        let cloth = |u: usize, v: usize| patches[v / 4 * 10 + u / 4];
        let place = |t: usize| 8 + 4 * t;
        let (second, top) = (34, 16);
        let owner = |t: usize, x: usize, y: usize| match y.checked_sub(top) {
            Some(v) if v < 30 && (second..second + 30).contains(&x) => 2,
            Some(v) if (3..25).contains(&v) && (place(t)..place(t) + 22).contains(&x) => 1,
            _ => 0,
        };
        let features = |t: usize| {
            FrameFeatures::painted(SIZE, |x, y| match owner(t, x, y) {
                2 => cloth(x - second + 7, y - top),
                1 => cloth(x - place(t), y - top),
                _ => [150, 160, 170],
            })
        };
        let tracks = [1, 2].map(|number| Track::new(number, vec![anchor(0)], 16)).to_vec();
        let mut group = Group { tracks, changing: vec![1, 2] };
        let found = vec![0; SIZE[0] * SIZE[1]];
        let mut seen_again = 0;
        for t in 0..16 {
            let truth: Vec<u8> = (0..SIZE[0] * SIZE[1]).map(|p| owner(t, p % SIZE[0], p / SIZE[0])).collect();
            let features = features(t);
            let seeds = |number: u8| (t == 0).then(|| (of_object(&truth, number), Spread::Both));
            // Motions to the previous frame and back, as pairs of frames measure them.
            let flow = |t: usize, step: f64| LayeredMotion {
                width: SIZE[0],
                labels: (0..features.pixels()).map(|p| u8::from(owner(t, p % SIZE[0], p / SIZE[0]) == 1)).collect(),
                motions: vec![AffineMotion::STATIC, AffineMotion::translation(step, 0.0)],
                measured: true,
            };
            let flows = [flow(t, -4.0), flow(t.saturating_sub(1), 4.0)];
            let flows = (t > 0).then_some([&flows[0], &flows[1]]);
            let scene = Scene { features: &features, seeds: &seeds, seen: &|_| None, found: &found, flows };
            for (number, proposal) in group.visit(t, Direction::Forward, false, &scene) {
                let proposal = proposal.unwrap();
                let mut own = vec![false; truth.len()];
                proposal.area.pixels(SIZE[0]).zip(&proposal.mask).for_each(|(p, &inside)| own[p] = inside > 0);
                let count = |of: &dyn Fn(bool, bool) -> bool| {
                    own.iter().zip(&truth).filter(|(own, truth)| of(**own, **truth == number)).count()
                };
                let [both, any] = [count(&|a, b| a && b), count(&|a, b| a || b)];
                let whole = truth.iter().filter(|&&truth| truth == number).count() == 22 * 22;
                if t > 8 && whole {
                    assert!(10 * both > 8 * any, "frame {t}: {number} has {both} of {any}");
                    seen_again += usize::from(number == 1);
                }
            }
        }
        assert!(seen_again >= 2, "{seen_again}");
    }
}
