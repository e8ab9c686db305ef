//! Pairs and clips, in one program.

mod clips;
mod pairs;
