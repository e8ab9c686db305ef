//! Accuracy and time of the linear step without noise, up to n = 10. It prints measurements:
//! `cargo test --release --test degrees -- --ignored --nocapture`.
#![allow(clippy::unwrap_used, reason = "test code may panic")]
#![cfg(not(target_arch = "wasm32"))]

mod synthetic;

use std::time::Instant;

use synthetic::{Protocol, random_motions, worst_error};
use veronese::Random;
use veronese::embedding::monomials::unknowns;
use veronese::embedding::{EmbeddedData, MultibodyMotion};
use veronese::factorisation::differentiation::{POINTS, motions_from_points};
use veronese::factorisation::five_steps;

#[test]
#[ignore = "n = 10 takes long"]
fn degrees_up_to_ten() {
    let largest = std::env::var("LARGEST").ok().and_then(|s| s.parse().ok()).unwrap_or(10);
    for n in 2..=largest {
        let mut random = Random::from_seed(n as u64);
        let truth = random_motions(n, &mut random);
        let m = unknowns(n);
        let count = (2 * m).max(600);
        let data = Protocol::B1.measurements(&truth, count, 0.0, &mut random);
        let start = Instant::now();
        let embedded = EmbeddedData::new(&data, n);
        let qr = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let multibody = MultibodyMotion::from_embedded(&embedded);
        let null = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let motions = motions_from_points(&multibody, &data, POINTS, &mut random);
        let differentiation = start.elapsed().as_secs_f64();
        println!(
            "n {n} m {m} N {count}: QR {qr:.3} s ({:.2} Gflop/s), null vector {null:.3} s, differentiation {differentiation:.3} s; \
             worst error: differentiation {:.1e}, five steps {:.1e}",
            2e-9 * count as f64 * (m * m) as f64 / qr,
            worst_error(&truth, &motions),
            worst_error(&truth, &five_steps(&multibody)),
        );
    }
}
