//! The scores of the mask benchmark, on labellings with known scores.
#![allow(clippy::unwrap_used, reason = "test code may panic")]
use experiments::masks::scores::{VOID, scores};
use veronese::Random;

const WIDTH: usize = 160;
const HEIGHT: usize = 120;

fn paint(labels: &mut [u8], rows: std::ops::Range<usize>, columns: std::ops::Range<usize>, label: u8) {
    for y in rows {
        labels[y * WIDTH + columns.start..y * WIDTH + columns.end].fill(label);
    }
}

/// Two rectangles in front of a background.
fn truth() -> Vec<u8> {
    let mut labels = vec![0; WIDTH * HEIGHT];
    paint(&mut labels, 30..80, 40..100, 1);
    paint(&mut labels, 90..110, 100..150, 2);
    labels
}

fn close(found: f64, expected: f64) -> bool {
    (found - expected).abs() < 1e-12
}

#[test]
fn renumbered_labels_score_perfectly() {
    let renumbered: Vec<u8> = truth().iter().map(|l| (l + 3) % 7).collect();
    let s = scores(&truth(), &renumbered, WIDTH);
    assert!(close(s.miou, 1.0) && close(s.rand, 1.0), "{s:?}");
    let all = [s.j_oracle, s.j_background, s.boundary];
    assert!(all.iter().all(|j| *j == Some(1.0)), "{s:?}");
    assert_eq!((s.truth_count, s.found_count), (3, 3));
}

#[test]
fn half_an_object_overlaps_by_half() {
    let mut found = vec![0; WIDTH * HEIGHT];
    paint(&mut found, 30..80, 40..70, 1);
    let s = scores(&truth(), &found, WIDTH);
    // Half of object 1, nothing of object 2, and the whole background.
    let background = 15200.0;
    assert!(close(s.miou, (0.5 + 0.0 + background / (background + 1500.0 + 1000.0)) / 3.0), "{s:?}");
    assert_eq!((s.j_oracle, s.j_background), (Some(1500.0 / 4000.0), Some(1500.0 / 4000.0)));
}

#[test]
fn parts_of_an_object_count_together_for_the_oracle_only() {
    let mut found = truth();
    paint(&mut found, 30..80, 70..100, 3);
    paint(&mut found, 0..20, 0..WIDTH, 4);
    let s = scores(&truth(), &found, WIDTH);
    assert_eq!((s.found_count, s.j_oracle), (5, Some(1.0)));
    assert_eq!(s.j_background, Some(4000.0 / 7200.0));
}

#[test]
fn unknown_pixels_do_not_count_and_unlabelled_ones_match_nothing() {
    let (mut truth, mut found) = (truth(), truth());
    truth[..10 * WIDTH].fill(VOID);
    found[..10 * WIDTH].fill(9);
    let s = scores(&truth, &found, WIDTH);
    assert!(close(s.miou, 1.0) && s.found_count == 3 && s.boundary == Some(1.0), "{s:?}");
    paint(&mut found, 30..80, 40..100, VOID);
    let s = scores(&truth, &found, WIDTH);
    assert!(close(s.miou, 2.0 / 3.0) && s.found_count == 2, "{s:?}");
}

/// Compared with a count of all pairs of pixels.
#[test]
fn the_rand_index_is_that_of_all_pairs() {
    let mut random = Random::from_seed(3);
    let draw = |random: &mut Random| (0..60).map(|_| random.below(3) as u8).collect::<Vec<u8>>();
    let (a, b) = (draw(&mut random), draw(&mut random));
    let (mut both, mut in_a, mut in_b, mut pairs) = (0.0, 0.0, 0.0, 0.0);
    for i in 0..60 {
        for j in 0..i {
            let (same_a, same_b) = (a[i] == a[j], b[i] == b[j]);
            pairs += 1.0;
            in_a += f64::from(u8::from(same_a));
            in_b += f64::from(u8::from(same_b));
            both += f64::from(u8::from(same_a && same_b));
        }
    }
    let chance = in_a * in_b / pairs;
    assert!(close(scores(&a, &b, 10).rand, (both - chance) / (0.5 * (in_a + in_b) - chance)));
}

#[test]
fn a_border_counts_within_its_tolerance_and_not_beyond() {
    // The diagonal is 200 pixels, the tolerance 2.
    let square = |by: usize| {
        let mut labels = vec![0; WIDTH * HEIGHT];
        paint(&mut labels, 30..80, 40 + by..100 + by, 1);
        labels
    };
    let f = |by: usize| scores(&square(0), &square(by), WIDTH).boundary.unwrap();
    assert_eq!((f(0), f(2)), (1.0, 1.0));
    assert!(f(3) < 0.75 && f(3) > 0.4, "{}", f(3));
}
