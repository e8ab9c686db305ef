//! What the programs measure with, on cases whose figures follow from their definition. One program: it is linked once.

mod annotator;
mod clip_scores;
mod score;
mod scores;
