//! What a clip reports to its host: the frames that are wanted, and what has happened.

use crate::clip::changes::Changed;
use crate::error::Result;

/// A step: a command that was given to a [`Clip`](super::Clip).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct StepId(pub(super) u32);

impl From<u32> for StepId {
    fn from(number: u32) -> StepId {
        StepId(number)
    }
}

impl From<StepId> for u32 {
    fn from(StepId(number): StepId) -> u32 {
        number
    }
}

/// What a frame is wanted for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClipStage {
    /// Its pairs with the frames beside it, nearly all the work of segmenting a range.
    Pairs,
    /// Annotations that are applied and spread.
    Annotations,
    /// Its labels.
    Labels,
}

/// A frame that a [`Clip`](super::Clip) needs.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wanted {
    /// Index of the frame.
    pub frame: usize,
    /// What it is wanted for.
    pub stage: ClipStage,
    /// The step that needs it; `None` for [`ClipStage::Labels`].
    pub step: Option<StepId>,
}

/// What has happened in a [`Clip`](super::Clip) since the events were taken last.
#[non_exhaustive]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Events {
    /// Records for the journal. Write them to durable storage before you report any result.
    pub records: Vec<u8>,
    /// Whether the records take the place of the journal so far; otherwise they are appended to it.
    pub replaces: bool,
    /// Indices of the frames whose labels have changed, in ascending order.
    pub frames: Vec<usize>,
    /// Steps that have taken effect or failed, in order.
    pub settled: Vec<Settled>,
    /// Steps that were cancelled, or taken back before they took effect.
    pub cancelled: Vec<StepId>,
}

/// A step that has taken effect or failed.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Settled {
    /// The step.
    pub step: StepId,
    /// What objects have gained and lost by annotations, or why nothing has changed. Merges, deletions and ranges are not counted.
    pub changes: Result<Vec<Changed>>,
}
