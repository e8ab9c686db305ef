//! The figures of the programs, on cases whose figures follow from their definition. One program: it is linked once.

mod ablation;
mod annotator;
mod clip_scores;
mod mask_scores;
mod score;
