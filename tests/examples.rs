//! The examples: each is run, and what it prints is checked.
#![allow(clippy::unwrap_used, unreachable_pub, reason = "test code may panic; examples are programs elsewhere")]

use std::cell::RefCell;
use std::fmt::Arguments;

thread_local! {
    static PRINTED: RefCell<String> = const { RefCell::new(String::new()) };
}

fn print(line: Arguments<'_>) {
    PRINTED.with_borrow_mut(|printed| *printed += &format!("{line}\n"));
}

/// Keeps the lines that the examples below print.
macro_rules! println {
    ($($line:tt)*) => {
        crate::examples::print(format_args!($($line)*))
    };
}

#[path = "../examples/5_clip.rs"]
mod clip;
#[path = "../examples/3_number_of_motions.rs"]
mod number_of_motions;
#[path = "../examples/4_pair_of_frames.rs"]
mod pair_of_frames;
#[path = "../examples/2_two_motions.rs"]
mod two_motions;
#[path = "../examples/1_union_of_lines.rs"]
mod union_of_lines;

/// The lines that an example prints.
fn output(example: fn()) -> String {
    PRINTED.take();
    example();
    PRINTED.take()
}

/// The number before `unit` in a line.
fn number_before(line: &str, unit: &str) -> f64 {
    line.split(unit).next().unwrap().split_whitespace().last().unwrap().parse().unwrap()
}

#[test]
fn a_union_of_lines_is_factored() {
    let text = output(union_of_lines::main);
    for line in
        ["[1.000000, 2.000000, -1.000000]", "[0.500000, -1.000000, 2.000000]", "[-2.000000, 1.000000, 1.000000]"]
    {
        assert!(text.contains(&format!("the line {line}\n")), "{line} is missing in\n{text}");
    }
    assert_eq!(text.lines().count(), 4, "{text}");
}

#[test]
fn two_motions_are_found_from_points() {
    let text = output(|| two_motions::main().unwrap());
    assert_eq!(text.matches("without noise: wrong by less than 1e-9: true").count(), 2, "{text}");
    let noisy: Vec<&str> = text.lines().filter(|line| line.starts_with("with 5 % noise")).collect();
    assert_eq!(noisy.len(), 2, "{text}");
    for line in noisy {
        let count = number_before(line, " measurements");
        assert!((190.0..=210.0).contains(&count), "{line}");
        let error: f64 = line.strip_suffix(" %").unwrap().rsplit(' ').next().unwrap().parse().unwrap();
        assert!(error < 3.0, "{line}");
    }
}

#[test]
fn the_number_of_motions_is_found_by_the_likelihood_and_not_always_by_the_rank() {
    let text = output(|| number_of_motions::main().unwrap());
    assert_eq!(text.lines().count(), 12, "{text}");
    for line in text.lines() {
        assert!(line.ends_with(&format!("the likelihood {}", &line[..1])), "{line}");
    }
    assert!(text.contains("2 motions, noise    0: the rank says 2,"), "{text}");
    assert!(text.contains("4 motions, noise  0.1: the rank says 3,"), "{text}");
}

#[test]
fn a_pair_of_frames_is_segmented() {
    let text = output(|| pair_of_frames::main().unwrap());
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("3 motions"), "{text}");
    assert_eq!(lines.filter(|line| line.starts_with("motion ")).count(), 3, "{text}");
    assert!(number_before(text.lines().last().unwrap(), " % of the pixels agree") > 97.0, "{text}");
}

#[test]
fn a_clip_is_corrected_undone_and_read_again() {
    let text = output(|| clip::main().unwrap());
    let objects: Vec<&str> =
        text.lines().filter_map(|line| line.split_once(": ")).map(|(_, objects)| objects).collect();
    let [found, corrected, undone, again] = objects[..] else { panic!("{text}") };
    assert!(!found.contains("(9,") && corrected.contains("(9,"), "{text}");
    assert_eq!((found, corrected), (undone, again), "{text}");
    assert!(text.ends_with(" bytes of journal for 2 steps\n"), "{text}");
}
