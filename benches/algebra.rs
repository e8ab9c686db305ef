//! The stages of the algebra with protocol B1, 600 measurements and 2 % noise, and the linear step at the largest size.

#[allow(dead_code, unreachable_pub, clippy::expect_used, reason = "shared with the tests, which use more of it")]
#[path = "../src/stages/protocol.rs"]
mod protocol;

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use protocol::Protocol;
use veronese::embedding::rank::{MAX_TRIED, number_of_motions};
use veronese::embedding::{EmbeddedData, MultibodyMotion, monomials::unknowns, taubin_motion};
use veronese::factorisation::differentiation::{POINTS, motions_from_points};
use veronese::factorisation::five_steps;
use veronese::refinement::product::refine;
use veronese::{Measurements, Random};

const NOISE: f64 = 0.02;

fn data(motions: usize) -> Measurements {
    Protocol::new(motions, NOISE).problem(1).measurements.normalised().0
}

/// Embedding by the Veronese map and QR of the embedded data.
fn embedding(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("embedding");
    for n in 2..=5 {
        let data = data(n);
        group.bench_function(format!("n={n}"), |b| b.iter(|| EmbeddedData::new(black_box(&data), n)));
    }
}

fn null_vector(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("null vector");
    for n in 2..=5 {
        let embedded = EmbeddedData::new(&data(n), n);
        group.bench_function(format!("n={n}"), |b| b.iter(|| MultibodyMotion::from_embedded(black_box(&embedded))));
    }
    for n in 2..=3 {
        let data = data(n);
        group.bench_function(format!("Taubin, n={n}"), |b| b.iter(|| taubin_motion(black_box(&data), n)));
    }
}

fn rank_rule(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("rank rule");
    for n in 2..=4 {
        let data = data(n);
        group.bench_function(format!("n={n}"), |b| b.iter(|| number_of_motions(black_box(&data), MAX_TRIED)));
    }
}

/// The paper's five steps, its refinement (19), and differentiation at points.
fn factorisation(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("factorisation");
    for n in 2..=4 {
        let data = data(n);
        let multibody = MultibodyMotion::from_embedded(&EmbeddedData::new(&data, n));
        let start = five_steps(&multibody);
        group.bench_function(format!("five steps, n={n}"), |b| b.iter(|| five_steps(black_box(&multibody))));
        group.bench_function(format!("refinement (19), n={n}"), |b| b.iter(|| refine(black_box(&start), &data)));
        group.bench_function(format!("differentiation, n={n}"), |b| {
            b.iter(|| motions_from_points(black_box(&multibody), &data, POINTS, &mut Random::from_seed(1)));
        });
    }
}

/// n = 10 without noise: 2431 unknowns from 4862 measurements.
fn largest(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("largest");
    group.sample_size(10).warm_up_time(Duration::from_millis(1));
    let protocol = Protocol { count: 2 * unknowns(10), ..Protocol::new(10, 0.0) };
    let data = protocol.problem(1).measurements;
    group.bench_function("n=10", |b| {
        b.iter(|| {
            let multibody = MultibodyMotion::estimate(black_box(&data), 10);
            multibody.map(|all| motions_from_points(&all, &data, POINTS, &mut Random::from_seed(1)))
        });
    });
}

criterion_group!(benches, embedding, null_vector, rank_rule, factorisation, largest);
criterion_main!(benches);
