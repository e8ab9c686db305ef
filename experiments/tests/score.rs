//! The report of `npm run score`: intervals over sequences, and figures that rose or fell.
#![allow(clippy::unwrap_used, reason = "test code may panic")]
use experiments::score::report::{Entry, changes, file, table};
use experiments::score::statistics::{Verdict, estimate, verdict};

const NAMES: [&str; 8] = ["a", "b", "c", "d", "e", "f", "g", "h"];

/// Two pairs of each sequence.
fn twice(values: [f64; 8]) -> Vec<(&'static str, f64)> {
    NAMES.into_iter().zip(values).flat_map(|one| [one; 2]).collect()
}

fn entries(values: [f64; 8]) -> Vec<Entry> {
    let entry = |(k, (name, j)): (usize, (&str, f64))| Entry {
        part: "pairs".into(),
        case: format!("{name}-{k}"),
        sequence: name.into(),
        quality: "fast".into(),
        j: Some(j),
        by_hand: Some(0.5),
        f: None,
        n_right: None,
    };
    twice(values).into_iter().enumerate().map(entry).map(Entry::rounded).collect()
}

#[test]
fn whole_sequences_are_drawn() {
    let values = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8];
    let once: Vec<(&str, f64)> = NAMES.into_iter().zip(values).collect();
    let (one, two) = (estimate(&once).unwrap(), estimate(&twice(values)).unwrap());
    // A second pair that is like the first of its sequence adds nothing.
    let close = |a: f64, b: f64| (a - b).abs() < 1e-12;
    let ([low, high], [low_of_two, high_of_two]) = (one.interval.unwrap(), two.interval.unwrap());
    assert!(close(one.mean, 0.45) && close(low, low_of_two) && close(high, high_of_two));
    // The standard error of the mean is .081, without the correction for a small sample.
    assert!((0.27..0.32).contains(&low) && (0.58..0.63).contains(&high), "{low} to {high}");
    assert_eq!(two, estimate(&twice(values)).unwrap());
}

#[test]
fn few_sequences_have_no_interval_and_none_no_mean() {
    assert_eq!(estimate(&[("a", 0.2), ("a", 0.4), ("b", 0.6), ("c", 0.8), ("d", 1.0)]).unwrap().interval, None);
    assert_eq!(estimate(&[]), None);
}

#[test]
fn a_change_counts_if_it_is_not_that_of_one_sequence() {
    let says = |values| verdict(&twice(values)).unwrap().1;
    assert_eq!(says([0.0; 8]), Verdict::Same);
    assert_eq!(says([0.01, 0.02, 0.01, 0.03, 0.0, 0.01, 0.02, 0.01]), Verdict::Rose);
    assert_eq!(says([-0.01, -0.02, -0.01, -0.03, 0.0, -0.01, -0.02, 0.01]), Verdict::Fell);
    assert_eq!(says([0.4, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), Verdict::Unclear);
    assert_eq!(verdict(&[("a", 0.1), ("b", 0.1)]).unwrap().1, Verdict::Unclear);
}

#[test]
fn what_was_saved_is_compared_case_by_case() {
    let before = entries([0.5; 8]);
    let kept: Vec<Entry> = serde_json::from_str(&file(&before).unwrap()).unwrap();
    assert_eq!(kept, before);
    assert_eq!(changes(&kept, &before), "Nothing changed.\n");

    // The mean rises everywhere but in one sequence, which is named.
    let now = entries([0.6, 0.6, 0.6, 0.6, 0.6, 0.6, 0.6, 0.1]);
    let text = changes(&kept, &now);
    assert!(text.contains("16 of 16 cases changed") && text.contains("unclear"), "{text}");
    assert!(text.contains("h-15, fast: J fell from 0.500 to 0.100"), "{text}");
    assert!(!text.contains("by hand"), "{text}");
    assert!(changes(&kept, &entries([0.4; 8])).contains("FELL"));
    assert!(changes(&kept, &entries([0.51; 8])).contains("rose     +0.010 [+0.010, +0.010]"));
    assert!(changes(&kept[1..], &before).contains("1 results have nothing to compare with"));
}

#[test]
fn the_table_has_a_row_for_each_part() {
    let text = table(&entries([0.5; 8]));
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!(rows.len(), 2, "{text}");
    assert!(rows[1].starts_with("pairs, fast") && rows[1].contains("16  0.500 [0.500, 0.500]"), "{text}");
    assert!(rows[1].ends_with('–'), "{text}");
}
