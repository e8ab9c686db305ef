//! Interactive correction: strokes hold exactly, distant labels do not change, one stroke corrects a region.
#![allow(clippy::unwrap_used, clippy::panic, reason = "test code may panic")]

use std::sync::LazyLock;

use scenes::{Scene, SceneOptions};
use veronese::{
    AffineMotion, Correction, Error, Relabelling, SegmentOptions, Segmentation, UNLABELLED, relabel, segment_pair,
};

/// A pair, and what was found of it.
struct Case {
    scene: Scene,
    found: Segmentation,
    motions: Vec<AffineMotion>,
    groups: Vec<u8>,
}

/// The case that most tests ask.
static USUAL: LazyLock<Case> = LazyLock::new(|| Case::new(320, 240, 5));

impl Case {
    fn new(width: usize, height: usize, seed: u64) -> Case {
        let scene = scenes::generate(&SceneOptions { width, height, seed, ..SceneOptions::default() }).unwrap();
        let options = SegmentOptions::default();
        let found = segment_pair(scene.first(), scene.second(), &options, &mut |_| {}).unwrap();
        let motions = found.motions.iter().map(|m| m.matrix).collect();
        let groups = found.motions.iter().map(|m| m.group).collect();
        Case { scene, found, motions, groups }
    }

    fn pixels(&self) -> usize {
        self.found.labels.len()
    }

    fn ask(&self, labels: &[u8], allowed: &[u16]) -> Result<Relabelling, Error> {
        let correction = Correction { motions: &self.motions, groups: &self.groups, labels, allowed };
        let (first, second) = (self.scene.first(), self.scene.second());
        relabel(first, second, &correction, &SegmentOptions::default(), &mut |_| {})
    }

    /// A stroke: a disc of `radius` around a pixel.
    fn disc(&self, allowed: &mut [u16], [cx, cy]: [usize; 2], radius: usize, set: u16) {
        for y in cy.saturating_sub(radius)..(cy + radius + 1).min(self.found.height) {
            for x in cx.saturating_sub(radius)..(cx + radius + 1).min(self.found.width) {
                if x.abs_diff(cx).pow(2) + y.abs_diff(cy).pow(2) <= radius * radius {
                    allowed[y * self.found.width + x] = set;
                }
            }
        }
    }

    /// The pixel of a label that is nearest to the centre of its bounding box.
    fn middle(&self, label: u8) -> [usize; 2] {
        let [x, y, w, h] = self.found.motions[usize::from(label)].bbox;
        let centre = [x + w / 2, y + h / 2];
        let own = (0..self.pixels()).filter(|&p| self.found.labels[p] == label);
        let far = |p: usize| {
            let (u, v) = (p % self.found.width, p / self.found.width);
            u.abs_diff(centre[0]).pow(2) + v.abs_diff(centre[1]).pow(2)
        };
        let p = own.min_by_key(|&p| far(p)).unwrap();
        [p % self.found.width, p / self.found.width]
    }
}

#[test]
fn without_strokes_nothing_changes() {
    let case = &*USUAL;
    let again = case.ask(&case.found.labels, &vec![0; case.pixels()]).unwrap();
    assert_eq!(again.labels, case.found.labels);
    for (now, before) in again.motions.iter().zip(&case.found.motions) {
        assert_eq!(
            (now.pixels, now.bbox, now.group, now.label),
            (before.pixels, before.bbox, before.group, before.label)
        );
        assert_eq!(now.residual, before.residual);
    }
}

#[test]
fn strokes_hold_exactly_and_distant_labels_do_not_change() {
    let case = Case::new(640, 480, 5);
    assert!(case.found.count >= 2);
    let mut allowed = vec![0; case.pixels()];
    let [x, y] = case.middle(1);
    case.disc(&mut allowed, [x, y], 5, 0b1);
    let corrected = case.ask(&case.found.labels, &allowed).unwrap();
    for (p, &set) in allowed.iter().enumerate() {
        if set != 0 {
            assert_eq!(corrected.labels[p], 0);
        }
        let (u, v) = (p % 640, p / 640);
        // At two pixels per working pixel, the influence falls to e⁻⁴ at this distance for steps of full length. Objects are smaller.
        if u.abs_diff(x).max(v.abs_diff(y)) > 220 {
            assert_eq!(corrected.labels[p], case.found.labels[p]);
        }
    }
    // The object loses the stroke and what goes with it.
    let lost = (0..case.pixels()).filter(|&p| case.found.labels[p] == 1 && corrected.labels[p] == 0).count();
    let stroke = (0..case.pixels()).filter(|&p| case.found.labels[p] == 1 && allowed[p] != 0).count();
    assert!(stroke > 0 && lost > stroke, "{lost} of a stroke of {stroke}");
    let counted: usize = corrected.motions.iter().map(|m| m.pixels).sum();
    assert_eq!(counted + corrected.unlabelled, case.pixels());
}

#[test]
fn one_stroke_corrects_a_region() {
    // An object was labelled as background: its labels are lost, its motion is known.
    for (seed, case) in [(5, &*USUAL), (7, &Case::new(320, 240, 7)), (11, &Case::new(320, 240, 11))] {
        let object = 1u8;
        let wrong: Vec<u8> = case.found.labels.iter().map(|&l| if l == object { 0 } else { l }).collect();
        let mut allowed = vec![0; case.pixels()];
        case.disc(&mut allowed, case.middle(object), 4, 1 << object);
        let mended = case.ask(&wrong, &allowed).unwrap();
        let (mut both, mut either) = (0usize, 0usize);
        for (&now, &right) in mended.labels.iter().zip(&case.found.labels) {
            both += usize::from(now == object && right == object);
            either += usize::from(now == object || right == object);
        }
        let overlap = both as f64 / either as f64;
        assert!(overlap > 0.8, "seed {seed}: {overlap}");
    }
}

#[test]
fn an_excluded_label_is_removed_and_a_full_set_is_no_constraint() {
    let case = &*USUAL;
    let n = case.motions.len();
    let everything = (1u16 << n) - 1;
    let mut allowed = vec![0; case.pixels()];
    case.disc(&mut allowed, case.middle(1), 6, everything & !0b10);
    let erased = case.ask(&case.found.labels, &allowed).unwrap();
    assert!(allowed.iter().zip(&erased.labels).all(|(&set, &l)| set == 0 || l != 1));
    // All labels are possible: the disc is no constraint, and the mask keeps its centre.
    let mut open = vec![0; case.pixels()];
    case.disc(&mut open, case.middle(1), 6, everything);
    let kept = case.ask(&case.found.labels, &open).unwrap();
    let [x, y] = case.middle(1);
    assert_eq!(kept.labels[y * case.found.width + x], 1);
}

#[test]
fn unlabelled_pixels_without_strokes_stay_unlabelled() {
    let case = &*USUAL;
    let mut labels = case.found.labels.clone();
    labels[..320 * 20].fill(UNLABELLED);
    let mut allowed = vec![0; case.pixels()];
    let [x, y] = case.middle(1);
    case.disc(&mut allowed, [x, y.max(120)], 3, 0b1);
    let corrected = case.ask(&labels, &allowed).unwrap();
    assert!(corrected.unlabelled > 0);
    assert_eq!(corrected.unlabelled, corrected.labels.iter().filter(|&&l| l == UNLABELLED).count());
}

#[test]
fn strokes_on_unlabelled_pixels_alone_are_obeyed() {
    let case = Case::new(96, 72, 5);
    let mut labels = case.found.labels.clone();
    labels[..96 * 10].fill(UNLABELLED);
    let mut allowed = vec![0; case.pixels()];
    case.disc(&mut allowed, [30, 4], 3, 0b10);
    let corrected = case.ask(&labels, &allowed).unwrap();
    for p in 0..case.pixels() {
        let expected = if allowed[p] == 0 { labels[p] } else { 1 };
        assert_eq!(corrected.labels[p], expected, "pixel {p}");
    }
}

#[test]
fn inconsistent_input_is_rejected() {
    let case = Case::new(64, 48, 1);
    let (pixels, labels) = (case.pixels(), &case.found.labels);
    let reason = |result: Result<Relabelling, Error>| match result {
        Err(Error::InvalidOption { name, .. }) => name,
        other => panic!("{other:?}"),
    };
    assert_eq!(reason(case.ask(&labels[1..], &vec![0; pixels])), "labels");
    assert_eq!(reason(case.ask(&vec![200; pixels], &vec![0; pixels])), "labels");
    assert_eq!(reason(case.ask(labels, &vec![0; pixels - 1])), "evidence");
    assert_eq!(reason(case.ask(labels, &vec![1 << 15; pixels])), "evidence");
    let nan = AffineMotion::new([f64::NAN; 6]);
    let motions = vec![nan; case.motions.len()];
    let correction = Correction { motions: &motions, groups: &case.groups, labels, allowed: &vec![0; pixels] };
    let (first, second) = (case.scene.first(), case.scene.second());
    assert_eq!(reason(relabel(first, second, &correction, &SegmentOptions::default(), &mut |_| {})), "motions");
}
