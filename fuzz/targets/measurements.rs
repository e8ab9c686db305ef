//! Measurements of any numbers: refused, or fitted with motions that are finite.
#![no_main]

use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::fuzz_target;
use veronese::{FitOptions, Measurements, Method, fit_motions};
use veronese_fuzz::Choices;

#[derive(Arbitrary, Debug)]
struct Input {
    choices: Choices,
    paper: bool,
    seed: u64,
    /// Whole numbers, so that there is more than noise; otherwise any.
    small: Vec<[i8; 5]>,
    any: Vec<[f64; 5]>,
    /// Derivatives that have no position.
    more: u8,
}

/// More take long, and show no more.
const MOST: usize = 96;

fuzz_target!(|input: Input| {
    let Input { choices, paper, seed, small, any, more } = input;
    let rows: Vec<[f64; 5]> = small.iter().map(|row| row.map(|v| f64::from(v) / 16.0)).chain(any).take(MOST).collect();
    let positions: Vec<[f64; 2]> = rows.iter().map(|&[x, y, ..]| [x, y]).collect();
    let mut derivatives: Vec<[f64; 3]> = rows.iter().map(|&[_, _, a, b, c]| [a, b, c]).collect();
    if more > 250 {
        derivatives.push([0.0; 3]);
        assert!(Measurements::new(positions, derivatives).is_err());
        return;
    }
    let Ok(data) = Measurements::new(positions, derivatives) else { return };
    let method = if paper { Method::Paper } else { Method::Best };
    let options = FitOptions::default().with_motions(choices.motions()).with_method(method).with_seed(seed);
    if let Ok(fit) = fit_motions(&data, &options, &mut |_| {}) {
        assert_eq!(fit.labels.len(), data.len());
        assert!(fit.motions.iter().all(|motion| motion.matrix.is_finite()));
    }
});
