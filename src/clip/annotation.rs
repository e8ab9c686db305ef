//! A person's annotations of a clip: label maps, strokes, prompts, accepted frames, and objects that are locked, named, merged or deleted.
//!
//! An annotation is about one object, or, as a label map, about the objects that it names. It is kept as it was given: a box stays a box. The
//! ground that a box or clicks suppose is not their object, and nothing to any other.

use super::saved::{Saved, saved};
use crate::answer::UNLABELLED;
use crate::error::{Error, Result};

/// By number: whether the object is one of a set.
pub(super) type ObjectSet = [bool; 256];

/// Where an annotation of a frame spreads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spread {
    /// To the frames before and after.
    #[default]
    Both,
    /// To the frames after.
    Forward,
    /// To the frames before.
    Backward,
    /// Nowhere: it holds in its frame alone.
    None,
}

/// A direction through the frames of a clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Direction {
    Forward,
    Backward,
}

impl Spread {
    /// Whether it spreads in a direction.
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
        let all = [Spread::Both, Spread::Forward, Spread::Backward, Spread::None];
        all.get(usize::from(u8::read(bytes)?)).copied()
    }
}

/// A label map or strokes in a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Painted {
    /// Index of the frame.
    pub frame: usize,
    /// The object that it is about. Without one it is about all objects whose numbers are among the labels. A map of 0 and 255 alone is an
    /// eraser: at its zeros there is no object.
    pub object: Option<u8>,
    /// One label per pixel of the frame, row by row: the number of an object, a new number for a new one, 0 where none of these objects
    /// is, 255 where nothing is said. Without 255, as of an outline, they are the mask of an object, to the pixel.
    pub labels: Vec<u8>,
    /// Where it spreads.
    pub spread: Spread,
}

/// Clicks and a box that point to an object in a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Prompt {
    /// Index of the frame.
    pub frame: usize,
    /// Number of the object, which may have been found or not, 1…254.
    pub object: u8,
    /// Pixels that are the object's, or are not. In this order each adds the part around it to the mask, or takes it away.
    pub clicks: Vec<Click>,
    /// A rectangle that has all of it: first column, first row, width and height.
    pub within: Option<[usize; 4]>,
    /// Where it spreads.
    pub spread: Spread,
}

/// A pixel, and whether it belongs to the object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Click {
    /// Column and row.
    pub at: [usize; 2],
    /// Whether it is the object's.
    pub inside: bool,
}

saved!(Prompt { frame, object, clicks, within, spread });
saved!(Click { at, inside });

/// A frame that a person finds right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Accepted {
    /// Index of the frame.
    pub frame: usize,
    /// Its labels, one per pixel; without them those that it has.
    pub labels: Option<Vec<u8>>,
}

/// Annotations that are given together, for [`SegmentedClip::annotate`](super::SegmentedClip::annotate).
#[derive(Clone, Debug, Default)]
pub struct Annotations {
    /// Label maps, for instance made elsewhere. Their numbers are theirs: objects found automatically under one of them get another.
    pub masks: Vec<Painted>,
    /// Label maps and strokes, which go before the mask of their frame where they say anything. Each replaces what was painted in its frame
    /// of the same object, or as a map; a map that says nothing takes back all that was said in its frame, prompts too.
    pub corrections: Vec<Painted>,
    /// One after another. Each replaces the prompt of its object in its frame; one that points nowhere takes it back.
    pub prompts: Vec<Prompt>,
    /// Numbers of the objects that are locked from now on: no annotation changes their pixels, but those given together with a new lock.
    /// Without this the locks stay as they are.
    pub locked: Option<Vec<u8>>,
    /// Numbers of the objects that a person has named: annotations of other objects do not change their pixels. Without this the names
    /// stay as they are.
    pub named: Option<Vec<u8>>,
    /// The frames that a person has accepted: annotations of other frames do not change their labels. Without this they stay as they are.
    pub accepted: Option<Vec<Accepted>>,
    /// Objects and the numbers that they get for the whole clip: that of another object to merge them, 0 to make them background: such
    /// an object claims nothing any more. Numbers that no object has change nothing.
    pub numbers: Vec<[u8; 2]>,
}

/// The annotation of a pixel about one object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Seed {
    Nothing,
    /// It is in a piece that was taken away as a whole: not the object's, though it may look like it.
    Dropped,
    Other,
    Object,
}

impl Prompt {
    /// Whether it points anywhere.
    pub(super) fn points(&self) -> bool {
        self.within.is_some() || self.clicks.iter().any(|click| click.inside)
    }

    /// Whether it is within a frame, and can be obeyed.
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
    /// Whether they are about pixels, and numbers of objects, that can be.
    pub(super) fn check(&self, size @ [width, height]: [usize; 2]) -> Result<()> {
        let fill = |name, labels: &[u8]| match labels.len() == width * height {
            true => Ok(()),
            false => invalid(name, format!("{} labels do not fill a frame of {width}×{height} pixels", labels.len())),
        };
        for (name, painted) in [("masks", &self.masks), ("corrections", &self.corrections)] {
            for Painted { object, labels, .. } in painted {
                fill(name, labels)?;
                let Some(object) = *object else { continue };
                if !is_object(object) || labels.iter().any(|label| ![0, object, UNLABELLED].contains(label)) {
                    let reason = format!("what is said of object {object} alone has the labels 0, {object} and 255");
                    return invalid(name, reason);
                }
            }
        }
        self.prompts.iter().try_for_each(|prompt| prompt.check(size))?;
        for labels in self.accepted.iter().flatten().filter_map(|of| of.labels.as_ref()) {
            fill("accepted", labels)?;
        }
        let is_number = |[object, number]: &&[u8; 2]| is_object(*object) && *number != UNLABELLED;
        if let Some([object, number]) = self.numbers.iter().find(|numbers| !is_number(numbers)) {
            let reason = "objects are 1 to 254, the background is 0";
            return invalid("objects", format!("object {object} cannot get the number {number}: {reason}"));
        }
        if let Some(object) = self.locked.iter().chain(&self.named).flatten().find(|object| !is_object(**object)) {
            return invalid("locked", format!("{object} is no number of an object: these are 1 to 254"));
        }
        Ok(())
    }

    /// The frames that they are about.
    pub(super) fn frames(&self) -> impl Iterator<Item = usize> {
        let painted = self.masks.iter().chain(&self.corrections).map(|painted| painted.frame);
        let accepted = self.accepted.iter().flatten().map(|accepted| accepted.frame);
        painted.chain(self.prompts.iter().map(|prompt| prompt.frame)).chain(accepted)
    }
}

fn is_object(number: u8) -> bool {
    number != 0 && number != UNLABELLED
}

fn invalid<T>(name: &'static str, reason: String) -> Result<T> {
    Err(Error::InvalidOption { name, reason })
}
