//! What can be asked of a [`Clip`](super::Clip): commands, and the annotations in them.

use std::ops::Range;

use super::annotation::{Click, ObjectSet, Spread};
use super::objects::Description;
use super::runs::Runs;
use super::saved::{Saved, saved};
use crate::error::{Error, Result};
use crate::frame::MAX_SIDE;
use crate::options::{MotionCount, Quality, SegmentOptions};

/// A change of a [`Clip`](super::Clip), and one step of undo.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Segments a range of at least two frames, for the first time or again. Objects keep their numbers, and annotations of these frames are
    /// applied again. Other commands take effect while the range is being segmented.
    Segment {
        /// The frames.
        frames: Range<usize>,
        /// Options of each pair. `mark_unknown` and `confidence` have no effect: see [`OpenOptions`](super::OpenOptions).
        options: SegmentOptions,
    },
    /// Annotates frames. All annotations take effect together: label maps and strokes first, then prompts.
    Annotate(Vec<Annotation>),
    /// Takes back the annotations of a frame.
    Clear {
        /// Index of the frame.
        frame: usize,
        /// The object whose annotations are taken back; `None` for all annotations of the frame.
        object: Option<u8>,
    },
    /// Accepts frames as correct, or no longer. Annotations of other frames do not change the labels of an accepted frame; an annotation of
    /// the frame itself ends the acceptance.
    Accept {
        /// Indices of the frames.
        frames: Vec<usize>,
        /// Whether they are accepted from now on.
        on: bool,
    },
    /// Locks objects, or unlocks them. Nothing changes the pixels of a locked object but segmenting its frames again.
    Lock {
        /// Numbers of the objects.
        objects: Vec<u8>,
        /// Whether they are locked from now on.
        on: bool,
    },
    /// Gives an object a name, a class and a colour, in place of those before.
    Describe {
        /// Number of the object.
        object: u8,
        /// What it is called, and how it is shown.
        description: Description,
        /// Whether this is part of the step before, unless that has segmented a range: one undo takes back both.
        coalesce: bool,
    },
    /// Merges objects under the number of the first.
    Merge(Vec<u8>),
    /// Turns objects into background. Their numbers are not given again.
    Delete(Vec<u8>),
    /// Makes a new object of all connected pieces of an object but the largest in a frame. Other frames follow.
    Split {
        /// Number of the object.
        object: u8,
        /// Index of the frame.
        frame: usize,
        /// Number of the new object, for instance the [next one](super::Clip::next_object).
        new: u8,
    },
    /// Replaces everything that was annotated, described, merged, deleted and accepted.
    ReplaceAnnotations(Declaration),
}

/// All annotations, descriptions and edits of a clip, for [`Command::ReplaceAnnotations`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Declaration {
    /// The annotations of all frames.
    pub annotations: Vec<Annotation>,
    /// Numbers of the locked objects.
    pub locked: Vec<u8>,
    /// Descriptions of objects, by number.
    pub described: Vec<(u8, Description)>,
    /// Groups of objects that are merged, each under the number of its first.
    pub merged: Vec<Vec<u8>>,
    /// Numbers of deleted objects.
    pub deleted: Vec<u8>,
    /// Indices of the accepted frames. A frame that is accepted already keeps its labels, except under masks that are given.
    pub accepted: Vec<usize>,
}

/// An annotation of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Annotation {
    /// Index of the frame.
    pub frame: usize,
    /// What the annotation is.
    pub content: Content,
    /// The frames to which it spreads.
    pub spread: Spread,
}

/// The content of an [`Annotation`]. Labels are one per pixel of the frame, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Content {
    /// Strokes over earlier strokes of the object in the frame.
    Strokes {
        /// Number of the object, 1…254; it may be new.
        object: u8,
        /// 1 where the object is, 0 where it is not, 255 where that is left open.
        labels: Vec<u8>,
    },
    /// A mask in place of earlier strokes of the object in the frame.
    Mask {
        /// Number of the object, 1…254; it may be new.
        object: u8,
        /// 1 where the object is, 0 where it is not, 255 where that is left open.
        labels: Vec<u8>,
    },
    /// A label map: the number of the object, 0 where none of these objects is, 255 where that is left open. It lies over earlier label maps
    /// and, unless they are locked, over strokes of any object. A map of 0 and 255 alone erases all objects at its zeros.
    Labels(Vec<u8>),
    /// A label map of another program, whose objects keep their numbers. An object found automatically under one of these numbers gets the
    /// lowest free one.
    Given(Vec<u8>),
    /// Clicks and a box that point to an object, in place of earlier ones.
    Prompt {
        /// Number of the object, 1…254; it may be new.
        object: u8,
        /// Pixels that belong to the object or do not. They are applied in order: each adds the part around it to the mask, or removes it.
        clicks: Vec<Click>,
        /// A rectangle that contains the whole object: first column, first row, width and height, pixels.
        within: Option<[usize; 4]>,
    },
}

impl Annotation {
    /// An annotation that spreads to the frames before and after.
    pub const fn new(frame: usize, content: Content) -> Annotation {
        Annotation { frame, content, spread: Spread::Both }
    }
}

impl Command {
    /// The frames that have to be segmented before it can take effect.
    pub(super) fn frames(&self) -> Vec<usize> {
        let of = |annotations: &[Annotation]| annotations.iter().map(|of| of.frame).collect::<Vec<_>>();
        match self {
            Command::Annotate(annotations) => of(annotations),
            Command::Clear { frame, .. } | Command::Split { frame, .. } => vec![*frame],
            Command::Accept { frames, .. } => frames.clone(),
            Command::ReplaceAnnotations(all) => [of(&all.annotations), all.accepted.clone()].concat(),
            Command::Segment { .. }
            | Command::Lock { .. }
            | Command::Describe { .. }
            | Command::Merge(_)
            | Command::Delete(_) => Vec::new(),
        }
    }
}

impl Command {
    fn annotations(&self) -> &[Annotation] {
        match self {
            Command::Annotate(annotations) => annotations,
            Command::ReplaceAnnotations(all) => &all.annotations,
            _ => &[],
        }
    }

    /// Adds the objects that may be new.
    pub(super) fn add_objects(&self, objects: &mut ObjectSet) {
        if let Command::Split { new, .. } = self {
            objects[usize::from(*new)] = true;
        }
        for annotation in self.annotations() {
            let numbers = match &annotation.content {
                Content::Strokes { object, .. } | Content::Mask { object, .. } | Content::Prompt { object, .. } => {
                    std::slice::from_ref(object)
                }
                Content::Labels(labels) | Content::Given(labels) => labels,
            };
            numbers.iter().for_each(|&number| objects[usize::from(number)] = true);
        }
    }

    /// Checks that labels and places are of frames that there can be.
    pub(super) fn check_sizes(&self) -> Result<()> {
        let fits = |annotation: &Annotation| match &annotation.content {
            Content::Strokes { labels, .. } | Content::Mask { labels, .. } => labels.len() <= MAX_SIDE * MAX_SIDE,
            Content::Labels(labels) | Content::Given(labels) => labels.len() <= MAX_SIDE * MAX_SIDE,
            Content::Prompt { clicks, within, .. } => {
                let mut places = clicks.iter().flat_map(|click| click.at).chain(within.iter().flatten().copied());
                places.all(|place| place <= MAX_SIDE)
            }
        };
        match self.annotations().iter().find(|annotation| !fits(annotation)) {
            None => Ok(()),
            Some(Annotation { frame, .. }) => {
                let reason = format!("the annotation of frame {frame} is larger than {MAX_SIDE}×{MAX_SIDE} pixels");
                Err(Error::InvalidOption { name: "annotations", reason })
            }
        }
    }
}

saved!(Annotation { frame, content, spread });
saved!(Declaration { annotations, locked, described, merged, deleted, accepted });

/// Label images are saved as runs.
impl Saved for Content {
    fn write(&self, bytes: &mut Vec<u8>) {
        let runs = |kind: u8, labels: &[u8], bytes: &mut Vec<u8>| {
            kind.write(bytes);
            Runs::of(labels).write(bytes);
        };
        match self {
            Content::Strokes { object, labels } => {
                runs(0, labels, bytes);
                object.write(bytes);
            }
            Content::Mask { object, labels } => {
                runs(1, labels, bytes);
                object.write(bytes);
            }
            Content::Labels(labels) => runs(2, labels, bytes),
            Content::Given(labels) => runs(3, labels, bytes),
            Content::Prompt { object, clicks, within } => {
                4u8.write(bytes);
                object.write(bytes);
                clicks.write(bytes);
                within.write(bytes);
            }
        }
    }

    fn read(bytes: &mut &[u8]) -> Option<Content> {
        let kind = u8::read(bytes)?;
        if kind == 4 {
            let (object, clicks, within) = (u8::read(bytes)?, Vec::read(bytes)?, Option::read(bytes)?);
            return Some(Content::Prompt { object, clicks, within });
        }
        let labels = Runs::read(bytes)?.bounded_values()?;
        match kind {
            0 => Some(Content::Strokes { object: u8::read(bytes)?, labels }),
            1 => Some(Content::Mask { object: u8::read(bytes)?, labels }),
            2 => Some(Content::Labels(labels)),
            3 => Some(Content::Given(labels)),
            _ => None,
        }
    }
}

impl Saved for Command {
    fn write(&self, bytes: &mut Vec<u8>) {
        match self {
            Command::Segment { frames, options: SegmentOptions { motions, quality, subject, .. } } => {
                let motions = if let MotionCount::Given(motions) = motions { *motions } else { 0 };
                0u8.write(bytes);
                [frames.start, frames.end, motions].write(bytes);
                [*quality == Quality::Best, *subject].write(bytes);
            }
            Command::Annotate(annotations) => (1u8.write(bytes), annotations.write(bytes)).1,
            Command::Clear { frame, object } => (2u8.write(bytes), frame.write(bytes), object.write(bytes)).2,
            Command::Accept { frames, on } => (3u8.write(bytes), frames.write(bytes), on.write(bytes)).2,
            Command::Lock { objects, on } => (4u8.write(bytes), objects.write(bytes), on.write(bytes)).2,
            Command::Describe { object, description, coalesce } => {
                (5u8.write(bytes), object.write(bytes), description.write(bytes), coalesce.write(bytes)).3
            }
            Command::Merge(objects) => (6u8.write(bytes), objects.write(bytes)).1,
            Command::Delete(objects) => (7u8.write(bytes), objects.write(bytes)).1,
            Command::Split { object, frame, new } => {
                (8u8.write(bytes), [*object, *new].write(bytes), frame.write(bytes)).2
            }
            Command::ReplaceAnnotations(all) => (9u8.write(bytes), all.write(bytes)).1,
        }
    }

    fn read(bytes: &mut &[u8]) -> Option<Command> {
        Some(match u8::read(bytes)? {
            0 => {
                let [start, end, motions] = Saved::read(bytes)?;
                let [best, subject] = Saved::read(bytes)?;
                let options = SegmentOptions {
                    motions: if motions == 0 { MotionCount::Auto } else { MotionCount::Given(motions) },
                    quality: if best { Quality::Best } else { Quality::Fast },
                    subject,
                    ..SegmentOptions::default()
                };
                Command::Segment { frames: start..end, options }
            }
            1 => Command::Annotate(Vec::read(bytes)?),
            2 => Command::Clear { frame: usize::read(bytes)?, object: Option::read(bytes)? },
            3 => Command::Accept { frames: Vec::read(bytes)?, on: bool::read(bytes)? },
            4 => Command::Lock { objects: Vec::read(bytes)?, on: bool::read(bytes)? },
            5 => Command::Describe {
                object: u8::read(bytes)?,
                description: Description::read(bytes)?,
                coalesce: bool::read(bytes)?,
            },
            6 => Command::Merge(Vec::read(bytes)?),
            7 => Command::Delete(Vec::read(bytes)?),
            8 => {
                let [object, new] = Saved::read(bytes)?;
                Command::Split { object, new, frame: usize::read(bytes)? }
            }
            9 => Command::ReplaceAnnotations(Declaration::read(bytes)?),
            _ => return None,
        })
    }
}
