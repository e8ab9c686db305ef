//! The figures of the programs, on cases whose figures follow from their definition. One program: it is linked once.

mod annotator;
#[path = "../boundary.rs"]
mod boundary;
mod clip_scores;
mod left_out;
mod mask_scores;
mod score;
