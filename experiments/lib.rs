//! What the programs that measure veronese share with each other and with their tests: cases, methods, figures and tables.
#![allow(missing_docs, reason = "names of fields and methods that say all there is have no comment")]

use std::error::Error;

pub mod boundary;
pub mod left_out;
pub mod panels;
pub mod parallel;
pub mod program;

/// Of the annotator benchmark: the robot, and how masks are compared.
pub mod annotator {
    pub mod overlap;
    pub mod robot;
}

/// Of the clip benchmark: cases, methods, figures.
pub mod clips {
    pub mod cases;
    pub mod methods;
    pub mod scores;
}

/// Of the mask benchmark: cases, what a method finds in them, figures.
pub mod masks {
    pub mod cases;
    #[cfg(feature = "ablation")]
    pub mod outcome;
    pub mod scores;
}

/// Of the score: its report, and intervals.
pub mod score {
    pub mod report;
    pub mod statistics;
}

/// Why a program ends early.
pub type Failure = Box<dyn Error + Send + Sync>;

/// What may fail.
pub type Result<T> = std::result::Result<T, Failure>;
