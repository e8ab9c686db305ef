//! Reuse of buffers: a call like the previous one allocates its result and short lists only, for frames of any size. This is a separate
//! program because the allocator counts for the whole program.

#![cfg(not(target_arch = "wasm32"))]

use std::alloc::System;

use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use veronese::scene::{SceneOptions, generate};
use veronese::{Quality, SegmentOptions, segment_pair};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Allowance for lists and small matrices of one search, bytes.
const SHORT_LISTS: usize = 384 << 10;

#[test]
fn a_call_like_the_one_before_it_allocates_little_more_than_its_result() {
    for (width, height) in [(320, 240), (640, 480), (320, 240)] {
        let scene = generate(&SceneOptions { width, height, ..SceneOptions::default() }).unwrap();
        for quality in [Quality::Fast, Quality::Best] {
            let options = SegmentOptions { quality, confidence: true, ..SegmentOptions::default() };
            let call = || {
                let region = Region::new(ALLOCATOR);
                let found = segment_pair(scene.first(), scene.second(), &options, &mut |_| {}).unwrap();
                let asked = region.change();
                (found, asked.bytes_allocated)
            };
            let (first, asked_at_first) = call();
            let (second, asked) = call();
            assert!(first.labels == second.labels && first.confidence == second.confidence, "the same answer");
            let result = second.labels.len() + second.confidence.as_ref().map_or(0, Vec::len);
            println!("{width} × {height}, {quality:?}: {asked_at_first} bytes, then {asked}, of them result {result}");
            assert!(asked <= result + SHORT_LISTS, "{asked} bytes for a result of {result}, {asked_at_first} at first");
            assert!(asked_at_first > 10 * asked, "the first call filled the workspace with {asked_at_first} bytes");
        }
    }
}
