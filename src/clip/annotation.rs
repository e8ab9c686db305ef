//! A person's annotations of a clip: label maps, strokes, prompts, accepted frames, and objects that are locked, named, merged or deleted.
//!
//! Strokes and prompts annotate one object; a label map annotates every object whose number is among its labels. Annotations are stored as
//! they were given: a box stays a box. The ground that follows from a box or from clicks is ground for their own object only.

use super::saved::{Saved, saved};
use crate::answer::UNLABELLED;
use crate::error::{Error, Result};

/// For each object number, whether the object is in the set.
pub(super) type ObjectSet = [bool; 256];

/// The frames to which an annotation of a frame spreads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spread {
    /// The frames before and after.
    #[default]
    Both,
    /// The frames after.
    Forward,
    /// The frames before.
    Backward,
    /// No other frame.
    None,
    /// No other frame, and the annotation changes no other pixel of its own frame: labels are drawn exactly, over all others. Only a
    /// [`Clip`](super::Clip) draws so.
    Exact,
}

/// A direction through the frames of a clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Direction {
    Forward,
    Backward,
}

impl Spread {
    /// Whether an annotation spreads in this direction.
    pub(super) fn goes(self, direction: Direction) -> bool {
        match direction {
            Direction::Forward => matches!(self, Spread::Both | Spread::Forward),
            Direction::Backward => matches!(self, Spread::Both | Spread::Backward),
        }
    }
}

impl Saved for Spread {
    fn write(&self, bytes: &mut Vec<u8>) {
        bytes.push(*self as u8);
    }

    fn read(bytes: &mut &[u8]) -> Option<Spread> {
        let all = [Spread::Both, Spread::Forward, Spread::Backward, Spread::None, Spread::Exact];
        all.get(usize::from(u8::read(bytes)?)).copied()
    }
}

/// A label map or strokes in a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Painted {
    /// Index of the frame.
    pub frame: usize,
    /// Number of the annotated object. `None` for a label map: it annotates every object whose number is among its labels. A label map of 0
    /// and 255 alone is an eraser: it removes all objects from its pixels with the label 0.
    pub object: Option<u8>,
    /// One label per pixel of the frame, row by row: an object's number, which may be new; 0 for pixels that belong to none of the
    /// annotated objects; 255 for pixels that are not annotated. Labels without any 255, such as a filled outline, are the object's exact
    /// mask.
    pub labels: Vec<u8>,
    /// The frames to which it spreads.
    pub spread: Spread,
}

/// Clicks and a box that point to an object in a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Prompt {
    /// Index of the frame.
    pub frame: usize,
    /// Number of the object, 1…254; it may be new.
    pub object: u8,
    /// Pixels that belong to the object or do not. They are applied in order: each adds the part around it to the mask, or removes it.
    pub clicks: Vec<Click>,
    /// A rectangle that contains the whole object: first column, first row, width and height, pixels.
    pub within: Option<[usize; 4]>,
    /// The frames to which it spreads.
    pub spread: Spread,
}

/// A pixel, and whether it belongs to the object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Click {
    /// Column and row.
    pub at: [usize; 2],
    /// Whether the pixel belongs to the object.
    pub inside: bool,
}

saved!(Prompt { frame, object, clicks, within, spread });
saved!(Click { at, inside });

/// A frame whose labels a person accepts as correct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Accepted {
    /// Index of the frame.
    pub frame: usize,
    /// The accepted labels, one per pixel; `None` for the labels that the frame has.
    pub labels: Option<Vec<u8>>,
}

impl Accepted {
    /// Frames with the labels that they have.
    pub(super) fn as_shown(frames: Vec<usize>) -> Vec<Accepted> {
        frames.into_iter().map(|frame| Accepted { frame, labels: None }).collect()
    }
}

/// Annotations that are given together, for [`SegmentedClip::annotate`](super::SegmentedClip::annotate).
#[derive(Clone, Debug, Default)]
pub struct Annotations {
    /// Label maps that are applied first, for instance from another program. They keep their numbers: an object found automatically under
    /// one of these numbers gets another one.
    pub masks: Vec<Painted>,
    /// Frames and objects whose annotations there are taken back; all annotations of a frame without an object.
    pub cleared: Vec<(usize, Option<u8>)>,
    /// Label maps and strokes. Where they are not 255, they replace the labels of the mask of their frame. Strokes replace the earlier
    /// strokes of their object in their frame, and a label map the earlier label map. A label map of 255 alone removes all annotations of
    /// its frame, prompts too.
    pub corrections: Vec<Painted>,
    /// Prompts, applied in order. Each replaces the prompt of its object in its frame; one without a box and without a click inside the
    /// object removes it.
    pub prompts: Vec<Prompt>,
    /// Numbers of the objects that are locked from now on. Annotations do not change the pixels of a locked object, except those given
    /// together with a new lock. `None` leaves the locks as they are.
    pub locked: Option<Vec<u8>>,
    /// Numbers of the objects that a person has named. Annotations of other objects do not change their pixels. `None` leaves the names as
    /// they are.
    pub named: Option<Vec<u8>>,
    /// The frames that a person has accepted. Annotations of other frames do not change their labels. `None` leaves them as they are.
    pub accepted: Option<Vec<Accepted>>,
    /// Objects and their new numbers in the whole clip: the number of another object merges both, 0 turns the object into background.
    /// Numbers that no object has are ignored.
    pub numbers: Vec<[u8; 2]>,
}

/// The annotation of a pixel with respect to one object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Seed {
    Nothing,
    /// In a separate piece of the object that was removed as a whole: not the object, although it may look like it.
    Dropped,
    Other,
    Object,
}

impl Prompt {
    /// Whether the prompt points to an object: it has a box or a click inside the object.
    pub(super) fn points(&self) -> bool {
        self.within.is_some() || self.clicks.iter().any(|click| click.inside)
    }

    /// Checks that the prompt lies in the frame and does not contradict itself.
    fn check(&self, [width, height]: [usize; 2]) -> Result<()> {
        if !is_object(self.object) {
            return invalid("label", format!("{} is no number of an object: these are 1 to 254", self.object));
        }
        let fits = |from: usize, count: usize, side: usize| count > 0 && from < side && count <= side - from;
        let outside = |name, [x, y, columns, rows]: [usize; 4]| {
            let area = format!("{columns}×{rows} pixels from ({x}, {y}) on");
            invalid(name, format!("{area} are not within a frame of {width}×{height} pixels"))
        };
        for Click { at: [x, y], inside } in &self.clicks {
            if *x >= width || *y >= height {
                return outside("click", [*x, *y, 1, 1]);
            }
            if let Some([left, top, columns, rows]) = self.within
                && *inside
                && !(fits(x.wrapping_sub(left), 1, columns) && fits(y.wrapping_sub(top), 1, rows))
            {
                return invalid("click", format!("({x}, {y}) is to be the object's, but is not within its box"));
            }
        }
        if let Some(sides @ [x, y, columns, rows]) = self.within
            && !(fits(x, columns, width) && fits(y, rows, height))
        {
            return outside("box", sides);
        }
        if !self.points() && !self.clicks.is_empty() {
            return invalid("prompts", format!("object {} needs a box or a click that is its own", self.object));
        }
        Ok(())
    }
}

impl Annotations {
    /// Checks labels, positions and object numbers for frames of the given size.
    pub(super) fn check(&self, size: [usize; 2]) -> Result<()> {
        for (name, painted) in [("masks", &self.masks), ("corrections", &self.corrections)] {
            for Painted { object, labels, .. } in painted {
                check_labels(name, labels, size)?;
                let Some(object) = *object else { continue };
                if !is_object(object) || labels.iter().any(|label| ![0, object, UNLABELLED].contains(label)) {
                    let reason = format!("what is said of object {object} alone has the labels 0, {object} and 255");
                    return invalid(name, reason);
                }
            }
        }
        self.prompts.iter().try_for_each(|prompt| prompt.check(size))?;
        for Accepted { labels, .. } in self.accepted.iter().flatten() {
            if let Some(labels) = labels {
                check_labels("accepted", labels, size)?;
            }
        }
        let is_number = |[object, number]: &&[u8; 2]| is_object(*object) && *number != UNLABELLED;
        if let Some([object, number]) = self.numbers.iter().find(|numbers| !is_number(numbers)) {
            let reason = "objects are 1 to 254, the background is 0";
            return invalid("objects", format!("object {object} cannot get the number {number}: {reason}"));
        }
        for objects in [&self.locked, &self.named].into_iter().flatten() {
            if let Some(object) = objects.iter().find(|object| !is_object(**object)) {
                return invalid("locked", format!("{object} is no number of an object: these are 1 to 254"));
            }
        }
        Ok(())
    }

    /// The indices of the annotated frames.
    pub(super) fn frames(&self) -> Vec<usize> {
        let mut frames = Vec::new();
        self.masks.iter().chain(&self.corrections).for_each(|of| frames.push(of.frame));
        self.prompts.iter().for_each(|of| frames.push(of.frame));
        self.accepted.iter().flatten().for_each(|of| frames.push(of.frame));
        self.cleared.iter().for_each(|(frame, _)| frames.push(*frame));
        frames
    }
}

/// Checks that labels fill a frame of a width and height.
pub(super) fn check_labels(name: &'static str, labels: &[u8], [width, height]: [usize; 2]) -> Result<()> {
    match labels.len() == width * height {
        true => Ok(()),
        false => invalid(name, format!("{} labels do not fill a frame of {width}×{height} pixels", labels.len())),
    }
}

pub(super) fn is_object(number: u8) -> bool {
    number != 0 && number != UNLABELLED
}

fn invalid<T>(name: &'static str, reason: String) -> Result<T> {
    Err(Error::InvalidOption { name, reason })
}
