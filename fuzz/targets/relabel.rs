//! Strokes on a pair, with any motions and labels: refused, or labels that obey the strokes.
#![no_main]

use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::fuzz_target;
use veronese::{AffineMotion, Correction, UNLABELLED, relabel};
use veronese_fuzz::{Choices, Film};

#[derive(Arbitrary, Debug)]
struct Input<'a> {
    choices: Choices,
    motions: Vec<[f64; 6]>,
    shifts: [[i8; 2]; 4],
    groups: Option<Vec<u8>>,
    /// Instead of labels and sets that fill the frame and name motions that exist.
    wrong: Option<(&'a [u8], Vec<u16>)>,
    labels: &'a [u8],
    strokes: Vec<([u8; 4], u16)>,
    film: Film<'a>,
}

fuzz_target!(|input: Input<'_>| {
    let Input { choices, motions, shifts, groups, wrong, labels, strokes, film } = input;
    let [width, height] = film.size();
    let shifts = shifts.map(|[u, v]| AffineMotion::translation(f64::from(u) / 16.0, f64::from(v) / 16.0));
    let motions: Vec<AffineMotion> = shifts.into_iter().chain(motions.into_iter().map(AffineMotion::new)).collect();
    let n = motions.len();
    let groups = groups.unwrap_or_else(|| (0..n).map(|k| k as u8).collect());
    let mut filled: Vec<u8> = labels.iter().chain(&[0]).copied().cycle().take(width * height).collect();
    filled.iter_mut().filter(|l| **l != UNLABELLED).for_each(|l| *l %= n.min(254) as u8);
    let mut allowed = vec![0; width * height];
    for ([x, y, wide, high], set) in strokes {
        let (left, top) = (usize::from(x) % width, usize::from(y) % height);
        let set = set & ((1_u32 << n.min(16)) - 1) as u16;
        for row in top..height.min(top + usize::from(high) % 16 + 1) {
            allowed[row * width..][left..width.min(left + usize::from(wide) % 16 + 1)].fill(set);
        }
    }
    let (labels, allowed) = wrong.as_ref().map_or((&filled[..], &allowed[..]), |(labels, sets)| (labels, sets));
    let correction = Correction { motions: &motions, groups: &groups, labels, allowed };
    if let Ok(found) = relabel(&film.frame(0), &film.frame(1), &correction, &choices.pair(), &mut |_| {}) {
        assert_eq!(found.motions.len(), n);
        for (&label, &set) in found.labels.iter().zip(allowed) {
            // A set of all motions is no evidence either.
            let free = set == 0 || set.count_ones() as usize == n;
            assert!(free || (label != UNLABELLED && set >> label & 1 == 1), "label {label} of the set {set:b}");
        }
    }
});
