//! The figures of the clip benchmark, on labels whose figures follow from their definition.
#![allow(clippy::unwrap_used, reason = "test code may panic")]
use experiments::clips::scores::{Identities, Scores, VOID, scores};

const WIDTH: usize = 80;
const HEIGHT: usize = 60;
const FRAMES: usize = 12;

type Labels = Vec<Vec<u8>>;

fn paint(labels: &mut [u8], rows: std::ops::Range<usize>, columns: std::ops::Range<usize>, label: u8) {
    for y in rows {
        labels[y * WIDTH + columns.start..y * WIDTH + columns.end].fill(label);
    }
}

/// Object 1, 400 pixels, goes to the right; object 2, 300 pixels, to the left.
fn truth() -> Labels {
    let frame = |t: usize| {
        let mut labels = vec![0; WIDTH * HEIGHT];
        paint(&mut labels, 10..30, 10 + t..30 + t, 1);
        paint(&mut labels, 40..55, 50 - t..70 - t, 2);
        labels
    };
    (0..FRAMES).map(frame).collect()
}

/// The truth with every label replaced by what `change` makes of frame and label.
fn changed(change: impl Fn(usize, u8) -> u8) -> Labels {
    truth().iter().enumerate().map(|(t, labels)| labels.iter().map(|&label| change(t, label)).collect()).collect()
}

fn of(found: &Labels) -> Scores {
    scores(&truth(), found, WIDTH)
}

#[track_caller]
fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-12, "{found} instead of {expected}");
}

#[test]
fn other_numbers_for_the_same_labels_are_perfect() {
    for found in [truth(), changed(|_, label| (label + 3) % 7)] {
        let s = of(&found);
        for j in [s.j_auto, s.j_tracks, s.j_oracle, s.f_auto.unwrap(), s.f_tracks.unwrap()] {
            close(j, 1.0);
        }
        close(s.j_track, 400.0 / 700.0);
        assert_eq!(s.identities.unwrap(), Identities { assigned: 1.0, switches: 0.0, lost: 0.0, idf1: 1.0 });
        assert_eq!((s.label_count, s.object_count), (3, 2));
    }
}

#[test]
fn numbers_that_change_places_halfway_cost_the_identities_only() {
    let swapped = changed(|t, label| if t < FRAMES / 2 { label } else { [0, 2, 1][usize::from(label)] });
    let s = of(&swapped);
    [s.j_auto, s.j_tracks, s.j_oracle].iter().for_each(|&j| close(j, 1.0));
    let found = s.identities.unwrap();
    close(found.assigned, 0.5);
    close(found.switches, 30.0 / FRAMES as f64);
    close(found.idf1, 0.5);
    assert_eq!(found.lost, 0.0);
}

#[test]
fn new_numbers_in_every_frame_leave_little_to_a_click() {
    let s = of(&changed(|t, label| if label > 0 { label + 10 * t as u8 } else { 0 }));
    [s.j_auto, s.j_tracks, s.j_oracle].iter().for_each(|&j| close(j, 1.0));
    let frames = FRAMES as f64;
    close(s.j_track, 400.0 / 700.0 / frames);
    let found = s.identities.unwrap();
    close(found.switches, (frames - 1.0) * 30.0 / frames);
    close(found.assigned, 1.0 / frames);
    close(found.idf1, 1.0 / frames);
    assert_eq!(s.label_count, 2 * FRAMES + 1);
}

#[test]
fn nothing_found_is_lost_and_switches_nothing() {
    for found in [changed(|_, _| 0), changed(|_, _| VOID)] {
        let s = of(&found);
        assert_eq!((s.j_auto, s.f_auto), (0.0, Some(0.0)));
        let found = s.identities.unwrap();
        assert_eq!((found.lost, found.switches, found.idf1), (1.0, 0.0, 0.0));
    }
    // One label everywhere is the background by its size, and a click on it takes the whole frame.
    let s = of(&changed(|_, _| 0));
    close(s.j_track, 700.0 / (WIDTH * HEIGHT) as f64);
    close(s.j_oracle, 700.0 / (WIDTH * HEIGHT) as f64);
}

#[test]
fn frames_without_foreground_are_right_if_nothing_is_found_in_them() {
    let late = changed(|t, label| if t < FRAMES / 2 { 0 } else { label });
    let s = of(&late);
    close(s.j_auto, 0.5);
    close(s.identities.unwrap().lost, 0.5);
    // The same as the truth: objects that are not there at first.
    let s = scores(&late, &late, WIDTH);
    close(s.j_auto, 1.0);
    close(s.identities.unwrap().assigned, 1.0);
    close(scores(&late, &truth(), WIDTH).j_auto, 0.5);
}

#[test]
fn a_union_with_a_label_that_covers_too_much_leaves_it_out() {
    // Object 2 found with a margin: 20 × 15 pixels in 40 × 35.
    let mut found = truth();
    for (t, labels) in found.iter_mut().enumerate() {
        paint(labels, 30..60, 40 - t..80 - t, 2);
    }
    let s = of(&found);
    // With it 700 of 400 + 1200 pixels, without it 400 of 700.
    close(s.j_auto, 700.0 / 1600.0);
    close(s.j_tracks, 400.0 / 700.0);
    close(s.j_oracle, 400.0 / 700.0);
    // Object 2 has an IoU of 300 / 1200, which is just enough to carry it and too little to detect it.
    let found = s.identities.unwrap();
    close(found.assigned, (1.0 + 0.25) / 2.0);
    assert_eq!(found.lost, 0.0);
    close(found.idf1, 2.0 * 12.0 / (24.0 + 24.0));
}

#[test]
fn unknown_pixels_do_not_count() {
    let (mut void, mut wrong) = (truth(), truth());
    for (void, wrong) in void.iter_mut().zip(&mut wrong) {
        void[..5 * WIDTH].fill(VOID);
        wrong[..5 * WIDTH].fill(9);
    }
    let s = scores(&void, &wrong, WIDTH);
    close(s.j_auto, 1.0);
    close(s.f_auto.unwrap(), 1.0);
    close(s.identities.unwrap().assigned, 1.0);
}

#[test]
fn a_clip_without_objects_has_no_identities() {
    let none = vec![vec![0u8; WIDTH * HEIGHT]; 3];
    let s = scores(&none, &none, WIDTH);
    assert_eq!((s.j_auto, s.f_auto, s.identities, s.object_count), (1.0, Some(1.0), None, 0));
}
