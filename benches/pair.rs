//! The image pipeline in both qualities, on a generated pair of 320 × 240 pixels with two objects.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use scenes::{SceneOptions, generate};
use veronese::{Quality, SegmentOptions, segment_pair};

fn pair(criterion: &mut Criterion) {
    let Ok(scene) = generate(&SceneOptions::default()) else { return };
    let mut group = criterion.benchmark_group("pair 320×240");
    group.sample_size(10);
    for (name, quality) in [("fast", Quality::Fast), ("best", Quality::Best)] {
        let options = SegmentOptions::default().with_quality(quality);
        group.bench_function(name, |b| {
            b.iter(|| segment_pair(black_box(scene.first()), scene.second(), &options, &mut |_| {}));
        });
    }
}

criterion_group!(benches, pair);
criterion_main!(benches);
