//! A part of a command that takes effect.

use std::sync::Arc;

use crate::answer::UNLABELLED;
use crate::clip::annotation::{Annotations, ObjectSet};
use crate::clip::runs::Runs;
use crate::error::{Error, Result};

/// A part of a command.
#[derive(Clone, Debug)]
pub(super) enum Phase {
    Annotate(Annotations),
    /// Draws labels exactly; of one object if there is one.
    Draw {
        frame: usize,
        object: Option<u8>,
        labels: Vec<u8>,
    },
    /// Makes a new object of pieces of another one.
    Split {
        object: u8,
        frame: usize,
        new: u8,
    },
    /// Locks these objects and no others.
    Lock(Vec<u8>),
    /// Restores locks, names and merges that were lifted.
    Restore(Box<Lifted>),
}

/// What protects objects from annotations of others: whether they are locked and named, and the numbers under which they go on.
#[derive(Clone, Debug)]
pub(super) struct Lifted {
    pub(super) locked: ObjectSet,
    pub(super) named: ObjectSet,
    pub(super) numbers: [u8; 256],
}

/// Labels as runs; `None` if all are open.
pub(super) fn some_labels(labels: &[u8]) -> Option<Arc<Runs>> {
    labels.iter().any(|label| *label != UNLABELLED).then(|| Arc::new(Runs::of(labels)))
}

pub(super) fn invalid<T>(name: &'static str, reason: String) -> Result<T> {
    Err(Error::InvalidOption { name, reason })
}
