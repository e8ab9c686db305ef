//! The tables of an ablation: paired differences, and rows that measure nothing.
#![allow(clippy::unwrap_used, reason = "test code may panic")]

use experiments::left_out::{Figures, Measured, Row, all_change, worth};
use scenes::SceneOptions;
use veronese::{Quality, SegmentOptions, segment_pair};

fn measured(sequence: &str, rows: &[f64]) -> Measured {
    let rows = rows.iter().enumerate().map(|(k, &j)| (Figures::from([("j", j)]), 10.0 - k as f64)).collect();
    Measured { table: "pairs", sequence: sequence.into(), rows }
}

#[test]
fn a_row_that_sets_nothing_fails() {
    const ROWS: [Row; 3] = [("nothing", &[]), ("what the row forgets", &[]), ("the care of best", &[])];
    let of_scene = |seed: u64| {
        let scene =
            scenes::generate(&SceneOptions { width: 160, height: 120, seed, ..SceneOptions::default() }).unwrap();
        let row = |quality| {
            let options = SegmentOptions::default().with_quality(quality);
            let found = segment_pair(scene.first(), scene.second(), &options, &mut |_| {}).unwrap();
            let right = found.labels.iter().zip(&scene.labels).filter(|(found, label)| found == label).count();
            (Figures::from([("right", right as f64)]), 1.0)
        };
        let rows = [Quality::Best, Quality::Best, Quality::Fast].map(row).into();
        Measured { table: "scenes", sequence: seed.to_string(), rows }
    };
    let message = all_change(&worth(&ROWS, &[1, 2].map(of_scene))).unwrap_err();
    assert!(message.contains("without: what the row forgets."), "{message}");
}

#[test]
fn a_row_counts_if_one_case_of_one_table_changes() {
    const ROWS: [Row; 2] = [("nothing", &[]), ("a part", &[])];
    let cases = |last: f64| {
        let of = |table, sequence: &str, j| Measured { table, ..measured(sequence, &[0.5, j]) };
        [of("best", "a", 0.5), of("best", "b", 0.5), of("fast", "a", 0.5), of("fast", "b", last)]
    };
    assert!(all_change(&worth(&ROWS, &cases(0.5))).is_err());
    assert_eq!(all_change(&worth(&ROWS, &cases(0.4999))), Ok(()));
}

#[test]
fn differences_are_those_of_the_same_case() {
    const ROWS: [Row; 2] = [("nothing", &[]), ("a part", &[])];
    let cases: Vec<Measured> =
        (0..8).map(|k| measured(&k.to_string(), &[0.1 * f64::from(k), 0.1 * f64::from(k) - 0.25])).collect();
    let tables = serde_json::to_value(worth(&ROWS, &cases)).unwrap();
    let close = |value: &serde_json::Value, expected: f64| (value.as_f64().unwrap() - expected).abs() < 1e-12;
    let [all, without] = [0, 1].map(|row| &tables[row]["tables"]["pairs"]);
    assert!(close(&all["figures"]["j"]["mean"], 0.35) && all["changed"] == 0, "{all}");
    // However much the cases differ, all of them lose the same.
    let lost = &without["figures"]["j"];
    assert!(close(&lost["mean"], -0.25) && lost["cases"] == 8, "{without}");
    assert!(close(&lost["interval"][0], -0.25) && close(&lost["interval"][1], -0.25), "{without}");
    assert!(without["changed"] == 8 && close(&without["time"], 0.9), "{without}");
}
