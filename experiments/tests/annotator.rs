//! The robot of the annotator benchmark, and how it judges, on masks whose depths, parts and overlaps follow from their definition.
#![allow(clippy::unwrap_used, reason = "test code may panic")]
use experiments::annotator::overlap::{between, each, masks, mean, of_label, worst};
use experiments::annotator::robot::{NOTHING_SAID, View, depths, largest, stroke};
use proptest::prelude::*;

const WIDTH: usize = 40;
const HEIGHT: usize = 30;

/// A mask from a drawing: `#` is inside.
fn drawn(rows: &[&str]) -> (Vec<bool>, usize) {
    (rows.iter().flat_map(|row| row.bytes()).map(|byte| byte == b'#').collect(), rows[0].len())
}

fn rectangle(columns: std::ops::Range<usize>, rows: std::ops::Range<usize>) -> Vec<bool> {
    (0..WIDTH * HEIGHT).map(|p| columns.contains(&(p % WIDTH)) && rows.contains(&(p / WIDTH))).collect()
}

#[test]
fn a_depth_is_the_squared_distance_from_the_nearest_pixel_outside() {
    let (mask, width) = drawn(&["#######", "#######", "#######", "###.###", "#######", "#######", "#######"]);
    let depths = depths(&mask, width);
    assert_eq!(depths[..7], [1; 7]);
    // Two rows or columns from the border, diagonally beside the hole, in it.
    assert_eq!([depths[2 * 7 + 2], depths[2 * 7 + 1], depths[3 * 7 + 3]], [2, 4, 0]);
}

proptest! {
    #[test]
    fn depths_are_those_of_a_search_over_all_pixels(cells in prop::collection::vec(prop::bool::weighted(0.9), 13 * 11)) {
        let (width, height) = (13i64, 11i64);
        let outside = |x: i64, y: i64| {
            !(0..width).contains(&x) || !(0..height).contains(&y) || !cells[(y * width + x) as usize]
        };
        for (p, depth) in depths(&cells, width as usize).into_iter().enumerate() {
            let (x, y) = (p as i64 % width, p as i64 / width);
            let around = (-1..=height).flat_map(|v| (-1..=width).map(move |u| (u, v)));
            let least = around.filter(|&(u, v)| outside(u, v)).map(|(u, v)| (u - x).pow(2) + (v - y).pow(2)).min();
            prop_assert_eq!(Some(depth as i64), least);
        }
    }
}

#[test]
fn pixels_that_share_no_more_than_a_corner_or_the_end_of_a_row_are_of_different_parts() {
    for above in [["##..#", "#..#."], ["...##", "##..."], ["#...#", "#...."]] {
        let (mask, width) = drawn(&[above[0], above[1], "..#..", ".###."]);
        assert_eq!(largest(&mask, width), drawn(&[".....", ".....", "..#..", ".###."]).0);
    }
    // Of equals the first.
    let (mask, width) = drawn(&["#..#", "#..#"]);
    assert_eq!(largest(&mask, width), drawn(&["#...", "#..."]).0);
}

#[test]
fn a_stroke_is_the_deeper_half_of_the_largest_part() {
    // Eleven pixels wide, so that the middle is six deep and what is at least three deep is drawn.
    let mut region = rectangle(5..16, 5..16);
    rectangle(30..35, 5..10).iter().zip(&mut region).for_each(|(&other, own)| *own |= other);
    let expected: Vec<usize> =
        rectangle(7..14, 7..14).iter().enumerate().filter(|(_, inside)| **inside).map(|(p, _)| p).collect();
    assert_eq!(stroke(&region, WIDTH), expected);
    assert_eq!(stroke(&vec![false; WIDTH * HEIGHT], WIDTH), [0_usize; 0]);
}

#[test]
fn a_region_below_a_twentieth_of_a_per_cent_of_the_frame_gets_no_stroke() {
    let mut region = vec![false; 100 * 100];
    region[210..214].fill(true);
    assert_eq!(stroke(&region, 100), [0_usize; 0]);
    region[214] = true;
    assert_eq!(stroke(&region, 100), [210, 211, 212, 213, 214]);
}

#[test]
fn the_robot_adds_what_is_missing_and_takes_away_what_is_wrong_where_it_may() {
    let (truth, found) = (rectangle(4..20, 4..20), rectangle(12..30, 4..20));
    let mut said = vec![NOTHING_SAID; WIDTH * HEIGHT];
    said[0] = 9;
    let view = View { width: WIDTH, truth: &truth, found: &found };
    view.draw(7, |_| true, &mut said);
    let at = |said: &[u8], x: usize| said[12 * WIDTH + x];
    assert_eq!([3, 8, 12, 19, 25, 31].map(|x| at(&said, x)), [255, 7, 255, 255, 0, 255]);
    assert_eq!(said[0], 9, "what was said before stays");
    // The wrong pixels are another object's, and stay unmarked.
    let mut said = vec![NOTHING_SAID; WIDTH * HEIGHT];
    view.draw(7, |p| p % WIDTH < 20, &mut said);
    assert_eq!([8, 25].map(|x| at(&said, x)), [7, 255]);
}

#[test]
fn overlaps_count_pixels_and_empty_masks_agree() {
    let labels = [vec![0, 3, 3, 3], vec![3, 3, 0, 0], vec![0; 4], vec![0, 0, 0, 3]];
    let truths = [vec![0, 0, 1, 1], vec![1, 1, 1, 0], vec![0; 4], vec![1, 0, 0, 0]].map(|truth| of_label(&truth, 1));
    let each = each(&masks(&labels, 3), &truths);
    assert_eq!(each, [2.0 / 3.0, 2.0 / 3.0, 1.0, 0.0]);
    assert_eq!(between(&masks(&labels, 3), &truths), (2.0 / 3.0 + 1.0) / 2.0);
    assert_eq!((worst(&each), worst(&[0.5, 0.2, 0.2, f64::INFINITY])), (3, 1));
    assert!(mean(&[]).is_nan());
}
