//! Objects that the same frames speak of: they are followed together, and each has what none of the others has better reason to have.

use super::look::Look;
use super::placing::Placed;
use super::sweep::{Claim, Expected, Given, odds_at};
use super::track::{Track, Way};
use crate::clip::annotation::{Seed, Spread};
use crate::clip::evidence::Flow;
use crate::clip::model;
use crate::frame::Plane;
use crate::order::sort_few;

/// What is known of a frame besides its pixels.
pub(super) struct Known<'a> {
    /// What is said of each pixel about the object of a number, if anything is, and where that spreads.
    pub(super) seeds: &'a dyn Fn(u8) -> Option<(Vec<Seed>, Spread)>,
    pub(super) found: &'a [u8],
    /// From this frame to the one before in the direction of the sweep, and from that one to this.
    pub(super) flows: Option<[&'a Flow; 2]>,
}

#[derive(Clone, Debug)]
pub(super) struct World {
    pub(super) tracks: Vec<Track>,
    /// Numbers of the objects that it decides of. The others were spoken of together with these, and compete.
    pub(super) decides: Vec<u8>,
}

impl World {
    /// The frame in which a sweep begins.
    pub(super) fn first(&self, way: Way) -> Option<usize> {
        let firsts = self.tracks.iter().filter_map(|track| track.first(way));
        if way == Way::Forward { firsts.min() } else { firsts.max() }
    }

    /// The claims of a frame, to which the sweep backward may come `again`.
    pub(super) fn visit(
        &mut self,
        t: usize,
        way: Way,
        again: bool,
        look: &Look,
        known: &Known<'_>,
    ) -> Vec<(u8, Option<Claim>)> {
        let seeds: Vec<Option<(Vec<Seed>, Spread)>> =
            self.tracks.iter().map(|track| (known.seeds)(track.number)).collect();
        let given: Vec<Given<'_>> = self
            .tracks
            .iter()
            .zip(&seeds)
            .map(|(track, seeds)| Given {
                said: seeds.as_ref().map(|(seeds, _)| &seeds[..]),
                speaks: track.speaks(t),
                is_for_all: track.is_for_all(t),
                spreads: seeds.as_ref().is_none_or(|(_, spread)| spread.ways()[way as usize]),
                found: known.found,
                flows: known.flows,
            })
            .collect();
        // The more is seen of one, the further in front it is.
        let mut covered = vec![false; look.pixels()];
        let mut placed: Vec<Option<Placed>> = vec![None; self.tracks.len()];
        let mut order: Vec<usize> = (0..self.tracks.len()).collect();
        let shares: Vec<f32> =
            self.tracks.iter_mut().map(|track| track.coming(t, way).map_or(0.0, |sweep| sweep.share())).collect();
        sort_few(&mut order, |&one, &other| shares[other].total_cmp(&shares[one]));
        for k in order {
            let Some(sweep) = self.tracks[k].coming(t, way) else { continue };
            placed[k] = sweep.place(look, &given[k], &covered);
            if let Some(placed) = &placed[k] {
                sweep.cover(placed, &mut covered);
            }
        }
        let mut expected: Vec<Option<Expected>> = self
            .tracks
            .iter_mut()
            .zip(&given)
            .zip(placed)
            .map(|((track, given), placed)| track.coming(t, way)?.expect(look, given, placed))
            .collect();
        compete(&mut expected, look.size[0]);
        let mut claims = Vec::new();
        for ((track, given), expected) in self.tracks.iter_mut().zip(&given).zip(expected) {
            let claim = track.visit(t, way, look, given, expected);
            if again {
                track.keep(t, claim.clone());
            }
            if self.decides.contains(&track.number) {
                claims.push((track.number, claim));
            }
        }
        claims
    }
}

/// The odds of each object against everything else: the others are part of that.
fn compete(expected: &mut [Option<Expected>], width: usize) {
    // Where a hidden one is to appear again, no other grows.
    let awaited: Vec<Option<Plane>> = expected.iter().flatten().map(|of| of.awaited.clone()).collect();
    for (k, of) in expected.iter_mut().flatten().enumerate() {
        for (_, awaited) in awaited.iter().enumerate().filter(|(j, _)| *j != k) {
            let Some(awaited) = awaited else { continue };
            let pixels = of.odds.iter_mut().zip(of.area.pixels(width));
            pixels.for_each(|(odds, p)| *odds -= model().certain * awaited.values()[p]);
        }
    }
    let alone: Vec<_> = expected.iter().flatten().map(|of| (of.area.clone(), of.odds.clone())).collect();
    for (k, of) in expected.iter_mut().flatten().enumerate() {
        for (j, (area, odds)) in alone.iter().enumerate().filter(|(_, (area, _))| area.touches(&of.area)) {
            if j == k {
                continue;
            }
            for (at, p) in of.area.pixels(width).enumerate() {
                let rival = odds_at(area, odds, p, width);
                let own = alone[k].1[at];
                if rival > 0.0 {
                    of.odds[at] = of.odds[at].min(own - rival);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Random;
    use crate::motion::AffineMotion;

    const SIZE: [usize; 2] = [96, 64];

    /// What a label map that names an object says about it.
    fn of_object(said: &[u8], number: u8) -> Vec<Seed> {
        let of = |&label: &u8| match label {
            crate::clip::whole::NOTHING_SAID => Seed::Nothing,
            label if label == number => Seed::Object,
            _ => Seed::Other,
        };
        said.iter().map(of).collect()
    }

    #[test]
    fn two_rivals_share_no_pixel() {
        // Side by side and of one colour; the border between them was said in one frame alone.
        let look = Look::painted(SIZE, |x, y| match (20..68).contains(&x) && (20..44).contains(&y) {
            true => [190, 70, 60],
            false => [110, 120, 115],
        });
        let inside = |p: usize| (20..44).contains(&(p / SIZE[0]));
        let said = |p: usize| match p % SIZE[0] {
            20..44 if inside(p) => 1,
            44..68 if inside(p) => 2,
            _ => 0,
        };
        let said: Vec<u8> = (0..look.pixels()).map(said).collect();
        let tracks = [1, 2].map(|number| Track::new(number, vec![(0, Spread::Both)], 3)).to_vec();
        let mut world = World { tracks, decides: vec![1, 2] };
        let found = vec![0; look.pixels()];
        for t in 0..3 {
            let seeds = |number: u8| (t == 0).then(|| (of_object(&said, number), Spread::Both));
            let known = Known { seeds: &seeds, found: &found, flows: None };
            let claims = world.visit(t, Way::Forward, false, &look, &known);
            let mut owners = vec![0; look.pixels()];
            for (number, claim) in claims {
                let claim = claim.unwrap();
                let own: Vec<usize> =
                    claim.area.pixels(SIZE[0]).zip(&claim.mask).filter(|(_, m)| **m > 0).map(|(p, _)| p).collect();
                assert!((450..700).contains(&own.len()), "frame {t}: {number} has {} of 576 pixels", own.len());
                for p in own {
                    assert_eq!(std::mem::replace(&mut owners[p], number), 0, "frame {t}, pixel {p}");
                }
            }
        }
    }

    #[test]
    fn what_is_said_later_counts_before_it() {
        // Found as one; a stroke on the left part here, and in a later frame one that says what the right part is not.
        let place = |x: usize, y: usize| match (20..44).contains(&y) {
            true if (20..44).contains(&x) => 1,
            true if (44..68).contains(&x) => 2,
            _ => 0,
        };
        let look = Look::painted(SIZE, |x, y| [[110, 120, 115], [190, 70, 60], [60, 80, 190]][place(x, y)]);
        let at = |p: usize| place(p % SIZE[0], p / SIZE[0]);
        let found: Vec<u8> = (0..look.pixels()).map(|p| u8::from(at(p) > 0)).collect();
        let stroke = |part: usize, label: u8| -> Vec<u8> {
            let is_in = |p: &usize| at(*p) == part && (28..36).contains(&(p / SIZE[0]));
            (0..look.pixels()).map(|p| if is_in(&p) { label } else { crate::clip::whole::NOTHING_SAID }).collect()
        };
        let (here, later) = (stroke(1, 1), stroke(2, 0));
        let shares = [false, true].map(|hears| {
            let mut track = Track::new(1, vec![(0, Spread::Both), (3, Spread::Both)], 4);
            for said in [&here, &later].into_iter().filter(|_| hears) {
                track.hear(&look, &of_object(said, 1), &found);
            }
            let mut world = World { tracks: vec![track], decides: vec![1] };
            let seeds = |number: u8| Some((of_object(&here, number), Spread::Both));
            let known = Known { seeds: &seeds, found: &found, flows: None };
            let claims = world.visit(0, Way::Forward, true, &look, &known);
            let claim = claims[0].1.as_ref().unwrap();
            let of = |part: usize| {
                let pixels = claim.area.pixels(SIZE[0]).zip(&claim.mask);
                pixels.filter(|(p, inside)| **inside > 0 && at(*p) == part).count()
            };
            [of(1), of(2)]
        });
        assert_eq!(shares, [[24 * 24, 24 * 24], [24 * 24, 0]]);
    }

    #[test]
    fn one_comes_out_behind_its_like() {
        // Cut from one cloth; the first passes behind the second, which stands still, and is quite hidden for a while.
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
        let look = |t: usize| {
            Look::painted(SIZE, |x, y| match owner(t, x, y) {
                2 => cloth(x - second + 7, y - top),
                1 => cloth(x - place(t), y - top),
                _ => [150, 160, 170],
            })
        };
        let tracks = [1, 2].map(|number| Track::new(number, vec![(0, Spread::Both)], 16)).to_vec();
        let mut world = World { tracks, decides: vec![1, 2] };
        let found = vec![0; SIZE[0] * SIZE[1]];
        let mut seen_again = 0;
        for t in 0..16 {
            let truth: Vec<u8> = (0..SIZE[0] * SIZE[1]).map(|p| owner(t, p % SIZE[0], p / SIZE[0])).collect();
            let look = look(t);
            let seeds = |number: u8| (t == 0).then(|| (of_object(&truth, number), Spread::Both));
            // As pairs of frames measure it: to the frame before, and from there.
            let flow = |t: usize, step: f64| Flow {
                width: SIZE[0],
                labels: (0..look.pixels()).map(|p| u8::from(owner(t, p % SIZE[0], p / SIZE[0]) == 1)).collect(),
                motions: vec![AffineMotion::STATIC, AffineMotion::translation(step, 0.0)],
                measured: true,
            };
            let flows = [flow(t, -4.0), flow(t.saturating_sub(1), 4.0)];
            let flows = (t > 0).then_some([&flows[0], &flows[1]]);
            let known = Known { seeds: &seeds, found: &found, flows };
            for (number, claim) in world.visit(t, Way::Forward, false, &look, &known) {
                let claim = claim.unwrap();
                let mut own = vec![false; truth.len()];
                claim.area.pixels(SIZE[0]).zip(&claim.mask).for_each(|(p, &inside)| own[p] = inside > 0);
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
