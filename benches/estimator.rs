//! The estimator with a given and with an unknown number of motions: protocol B1, 600 measurements, 5 % noise, eight problems in turn.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use scenes::protocol::Protocol;
use veronese::{FitOptions, Measurements, MotionCount, fit_motions};

fn bench(
    criterion: &mut Criterion,
    name: &str,
    motions: std::ops::RangeInclusive<usize>,
    count: fn(usize) -> MotionCount,
) {
    let mut group = criterion.benchmark_group(name);
    group.sample_size(20);
    for n in motions {
        let protocol = Protocol::new(n, 0.05);
        let problems: Vec<Measurements> = (0..8).map(|seed| protocol.problem(seed).measurements).collect();
        let options = FitOptions::default().with_motions(count(n));
        let mut turn = problems.iter().cycle();
        group.bench_function(format!("n={n}"), |b| {
            b.iter_batched(
                || turn.next(),
                |data| data.map(|data| fit_motions(black_box(data), &options, &mut |_| {})),
                criterion::BatchSize::SmallInput,
            );
        });
    }
}

fn fit(criterion: &mut Criterion) {
    bench(criterion, "fit", 1..=6, MotionCount::Given);
}

fn number(criterion: &mut Criterion) {
    bench(criterion, "number of motions", 1..=4, |_| MotionCount::Auto);
}

criterion_group!(benches, fit, number);
criterion_main!(benches);
