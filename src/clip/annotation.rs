//! What a person says of a clip: of which object, in which frame.
//!
//! A statement is about one object, or, as a label map, about the objects that it names. It is kept as it was said: a box stays a box. What a
//! box or clicks suppose to be ground is not their object, and nothing to anybody else.

use super::model;
use super::runs::Runs;
use super::saved::{Saved, saved};
use super::whole::NOTHING_SAID;
use crate::components::{Component, Connectivity, components};

/// Where what is said of a frame spreads.
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

impl Spread {
    /// Forward, backward.
    pub(super) fn ways(self) -> [bool; 2] {
        [matches!(self, Spread::Both | Spread::Forward), matches!(self, Spread::Both | Spread::Backward)]
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

/// What is painted in a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Painted {
    /// Index of the frame.
    pub frame: usize,
    /// The object that it is about. Without one it is about all objects that the labels name; labels that name none say of all objects
    /// where they are not.
    pub object: Option<u8>,
    /// One label per pixel of the frame, row by row: the number of an object, a new number for a new one, 0 where none of these objects
    /// is, 255 where nothing is said.
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
    /// Pixels that are the object's, or are not.
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

impl Prompt {
    /// Whether it points anywhere.
    pub(super) fn points(&self) -> bool {
        self.within.is_some() || self.clicks.iter().any(|click| click.inside)
    }
}

/// A frame that a person finds right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Accepted {
    /// Index of the frame.
    pub frame: usize,
    /// Its labels, one per pixel; without them those that it has.
    pub labels: Option<Vec<u8>>,
}

/// All that is said of a clip at one time, for [`SegmentedClip::annotate`](super::SegmentedClip::annotate).
#[derive(Clone, Debug, Default)]
pub struct Annotations {
    /// Label maps, for instance made elsewhere. Their numbers are theirs: objects found automatically under one of them get another.
    pub masks: Vec<Painted>,
    /// Label maps and strokes, which go before the mask of their frame where they say anything. Each replaces what was painted in its frame
    /// of the same object, or as a map; a map that says nothing takes back all that was said in its frame, prompts too.
    pub corrections: Vec<Painted>,
    /// One after another. Each replaces the prompt of its object in its frame; one that points nowhere takes it back.
    pub prompts: Vec<Prompt>,
    /// Objects that nothing changes until they are unlocked; none: as before.
    pub locked: Option<Vec<u8>>,
    /// Objects that only what is said of themselves changes, because a person named them; none: as before.
    pub named: Option<Vec<u8>>,
    /// Frames in which only what is painted there changes labels; none: as before.
    pub accepted: Option<Vec<Accepted>>,
    /// Objects and the numbers that they get for the whole clip: that of another object to merge them, 0 to make them background. Numbers
    /// that no object has change nothing.
    pub numbers: Vec<[u8; 2]>,
}

/// What is said of a pixel about one object: nothing, or whether it is the object's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Seed {
    Nothing,
    /// It is in a piece that was taken away as a whole: not the object's, though it may look like it.
    Dropped,
    Other,
    Object,
}

/// What is said of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Said {
    /// In the order in which they were last changed: later ones go over earlier ones.
    painted: Vec<Strokes>,
    /// By object, ascending.
    prompts: Vec<Outlined>,
    /// By object, ascending: 0 at separate pieces that strokes have taken away, 255 elsewhere.
    pieces: Vec<(u8, Runs)>,
    /// By object, ascending: 1 where it was when strokes were first drawn in the frame.
    bases: Vec<(u8, Runs)>,
    /// Objects that the frame speaks of: they are followed from here.
    pub(super) speaks_of: Vec<u8>,
    /// Other objects of a person that labels which name none take pixels from.
    pub(super) takes_from: Vec<u8>,
}

saved!(Said { painted, prompts, pieces, bases, speaks_of, takes_from });

/// What is painted: a label of each full-size pixel, or 255 for nothing.
#[derive(Clone, Debug, PartialEq)]
struct Strokes {
    /// 0 for a label map.
    object: u8,
    labels: Runs,
    spread: Spread,
}

saved!(Strokes { object, labels, spread });

/// A prompt, and what it outlines: the object's number, 0 elsewhere, 255 where another object is.
#[derive(Clone, Debug, PartialEq)]
struct Outlined {
    prompt: Prompt,
    labels: Runs,
}

saved!(Outlined { prompt, labels });
saved!(Prompt { frame, object, clicks, within, spread });
saved!(Click { at, inside });

/// What is new in a frame.
#[derive(Clone, Debug)]
pub(super) enum Change {
    /// Label maps and strokes; those that say nothing take back.
    Painted(Vec<Painted>),
    Prompt(Prompt),
}

impl Said {
    pub(super) fn is_empty(&self) -> bool {
        self.painted.is_empty() && self.prompts.is_empty()
    }

    pub(super) fn is_valid(&self, pixels: usize) -> bool {
        let painted = self.painted.iter().map(|strokes| &strokes.labels);
        let pieces = self.pieces.iter().chain(&self.bases).map(|(_, labels)| labels);
        painted.chain(self.prompts.iter().map(|of| &of.labels)).chain(pieces).all(|labels| labels.is_valid(pixels))
    }

    /// Takes what is painted in the place of what was painted of the same object. A label map that says nothing takes back everything.
    #[inline(never)]
    pub(super) fn paint(&mut self, painted: &Painted) {
        let object = painted.object.unwrap_or(0);
        let (labels, spread) = (Runs::of(&painted.labels), painted.spread);
        let strokes = Strokes { object, labels, spread };
        if self.painted.contains(&strokes) {
            return;
        }
        let is_nothing = painted.labels.iter().all(|&label| label == NOTHING_SAID);
        if is_nothing && painted.object.is_none() {
            *self = Said::default();
            return;
        }
        self.painted.retain(|strokes| strokes.object != object);
        if !is_nothing {
            self.painted.push(strokes);
        }
    }

    /// Takes a prompt with what it outlines in the place of that of the same object.
    #[inline(never)]
    pub(super) fn point(&mut self, prompt: Prompt, labels: &[u8]) {
        self.prompts.retain(|of| of.prompt.object != prompt.object);
        if prompt.points() {
            let at = self.prompts.partition_point(|of| of.prompt.object < prompt.object);
            self.prompts.insert(at, Outlined { prompt, labels: Runs::of(labels) });
        }
    }

    /// The prompt of an object.
    pub(super) fn prompt(&self, object: u8) -> Option<&Prompt> {
        self.outlined(object).map(|of| &of.prompt)
    }

    fn outlined(&self, object: u8) -> Option<&Outlined> {
        self.prompts.iter().find(|of| of.prompt.object == object)
    }

    fn strokes(&self, object: u8) -> Option<&Strokes> {
        self.painted.iter().find(|strokes| strokes.object == object)
    }

    /// The label map, if it is about an object: if it names it, or none.
    fn map_of(&self, object: u8) -> Option<&Strokes> {
        self.strokes(0).filter(|_| self.names_in_map(object) || self.names_none())
    }

    /// Whether its label map names no object: it says of all where they are not.
    #[inline(never)]
    pub(super) fn names_none(&self) -> bool {
        self.strokes(0).is_some_and(|map| map.labels.each().all(|(label, _)| label == 0 || label == NOTHING_SAID))
    }

    /// Whether it is about an object by number.
    #[inline(never)]
    pub(super) fn names(&self, object: u8) -> bool {
        self.names_in_map(object) || self.strokes(object).is_some() || self.outlined(object).is_some()
    }

    /// Whether another annotation of the frame says the same of an object by its number; of 0, of all that are under labels which name none.
    #[inline(never)]
    pub(super) fn agrees(&self, other: &Said, object: u8) -> bool {
        self.about(object) == other.about(object)
    }

    /// The label map, strokes and the outline that are about an object by its number; of 0, labels that name none.
    #[inline(never)]
    fn about(&self, object: u8) -> (Option<&Strokes>, Option<&Strokes>, Option<&Outlined>) {
        let is_map = if object == 0 { self.names_none() } else { self.names_in_map(object) };
        let map = self.strokes(0).filter(|_| is_map);
        (map, self.strokes(object).filter(|_| object > 0), self.outlined(object))
    }

    /// Whether another annotation of the frame is the same.
    pub(super) fn is_same(&self, other: &Said) -> bool {
        self.painted == other.painted && self.prompts == other.prompts
    }

    /// Separate pieces of objects that a stroke is in which takes away belong to them no more. `now` is what the frame shows, and `before`
    /// what was said.
    #[inline(never)]
    pub(super) fn drop_pieces(&mut self, before: &Said, now: &[u8], width: usize) {
        // Those whose stroke was taken back are the object's again.
        let mut pieces = std::mem::take(&mut self.pieces);
        pieces.retain(|(object, piece)| {
            let seeds = self.seeds(*object).unwrap_or_default();
            seeds.iter().zip(piece.values()).any(|(seed, label)| label == 0 && *seed == Seed::Other)
        });
        self.pieces = pieces;
        let mut objects = [false; 256];
        now.iter().for_each(|&label| objects[usize::from(label)] = true);
        for object in (1..NOTHING_SAID).filter(|&k| objects[usize::from(k)]) {
            let is_about = self.names_none() && !self.agrees(before, 0) || !self.agrees(before, object);
            let Some(seeds) = is_about.then(|| self.seeds(object)).flatten() else { continue };
            let old = before.seeds(object);
            let inside: Vec<u8> = now.iter().map(|&label| u8::from(label == object)).collect();
            let parts = components(&inside, width, Connectivity::Eight);
            let mut is_said = vec![false; parts.list.len()];
            // First and last column and row of the strokes in each.
            let mut strokes = vec![[usize::MAX, usize::MAX, 0, 0]; parts.list.len()];
            for p in 0..now.len() {
                let part = parts.of[p] as usize;
                is_said[part] |= seeds[p] == Seed::Object;
                if seeds[p] == Seed::Other && old.as_ref().is_none_or(|old| old[p] != Seed::Other) {
                    let ([x, y], [left, top, right, bottom]) = ([p % width, p / width], strokes[part]);
                    strokes[part] = [left.min(x), top.min(y), right.max(x), bottom.max(y)];
                }
            }
            let all: usize = parts.list.iter().filter(|part| part.label > 0).map(|part| part.size).sum();
            let goes = |part: usize| {
                let (Component { label, size, bounds, .. }, drawn) = (parts.list[part], strokes[part]);
                let length = |[left, top, right, bottom]: [usize; 4]| (right - left).max(bottom - top) + 1;
                if label == 0 || is_said[part] || drawn[0] > drawn[2] {
                    return false;
                }
                // A dab in a large piece may be about part of it; a stroke through it is not.
                let is_through = length(drawn) as f32 > (1.0 - model().part) * length(bounds) as f32;
                (size as f32) < model().part * all as f32 || is_through && 2 * size < all
            };
            let goes: Vec<bool> = (0..parts.list.len()).map(goes).collect();
            let mut piece: Vec<u8> =
                parts.of.iter().map(|&part| if goes[part as usize] { 0 } else { NOTHING_SAID }).collect();
            if !piece.contains(&0) {
                continue;
            }
            if let Some(at) = self.pieces.iter().position(|(of, _)| *of == object) {
                let (_, before) = self.pieces.swap_remove(at);
                piece.iter_mut().zip(before.values()).for_each(|(piece, before)| *piece = (*piece).min(before));
            }
            let at = self.pieces.partition_point(|(of, _)| *of < object);
            self.pieces.insert(at, (object, Runs::of(&piece)));
        }
    }

    /// Keeps where objects are before strokes change them, by the labels that the frame shows.
    #[inline(never)]
    pub(super) fn keep_bases(&mut self, shown: &[u8]) {
        let mut is_shown = [false; 256];
        shown.iter().for_each(|&label| is_shown[usize::from(label)] = true);
        let is_stroked = |k: u8| {
            self.strokes(k).is_some() || self.map_of(k).is_some() && (is_shown[usize::from(k)] || self.names_in_map(k))
        };
        let base = |k: u8| {
            let known = self.bases.iter().find(|(of, _)| *of == k).map(|(_, base)| base.clone());
            let now = || Runs::of(&shown.iter().map(|&label| u8::from(label == k)).collect::<Vec<u8>>());
            (k, known.unwrap_or_else(now))
        };
        self.bases = (1..NOTHING_SAID).filter(|&k| is_stroked(k)).map(base).collect();
    }

    /// Where an object was before strokes were drawn: 1 at its pixels. There is none without strokes.
    pub(super) fn base(&self, object: u8) -> Option<Vec<u8>> {
        self.bases.iter().find(|(of, _)| *of == object).map(|(_, base)| base.values())
    }

    fn names_in_map(&self, object: u8) -> bool {
        self.strokes(0).is_some_and(|map| map.labels.names(object))
    }

    /// Where what is said of an object spreads.
    #[inline(never)]
    pub(super) fn spread_of(&self, object: u8) -> Spread {
        let painted = self.strokes(object).or(self.map_of(object)).map(|strokes| strokes.spread);
        painted.or(self.prompt(object).map(|prompt| prompt.spread)).unwrap_or_default()
    }

    /// What is said of each full-size pixel about an object, if anything is. Strokes go before a label map, and that before a prompt.
    #[inline(never)]
    pub(super) fn seeds(&self, object: u8) -> Option<Vec<Seed>> {
        let mut seeds: Option<Vec<Seed>> = None;
        let layers = [
            (self.pieces.iter().find(|(of, _)| *of == object).map(|(_, labels)| labels), Seed::Dropped),
            (self.outlined(object).map(|of| &of.labels), Seed::Other),
            (self.map_of(object).map(|map| &map.labels), Seed::Other),
            (self.strokes(object).map(|strokes| &strokes.labels), Seed::Other),
        ];
        for (labels, other) in layers.into_iter().filter_map(|(labels, other)| Some((labels?, other))) {
            let labels = labels.values();
            let seeds = seeds.get_or_insert_with(|| vec![Seed::Nothing; labels.len()]);
            for (seed, label) in seeds.iter_mut().zip(labels).filter(|(_, label)| *label != NOTHING_SAID) {
                *seed = if label == object { Seed::Object } else { other };
            }
        }
        seeds
    }

    /// What is painted by hand at each full-size pixel: the object's number, 0 for ground of a label map, 255 for nothing.
    #[inline(never)]
    pub(super) fn by_hand(&self) -> Option<Vec<u8>> {
        let mut hand: Option<Vec<u8>> = None;
        for Strokes { object, labels, .. } in &self.painted {
            let labels = labels.values();
            let hand = hand.get_or_insert_with(|| vec![NOTHING_SAID; labels.len()]);
            for (hand, label) in hand.iter_mut().zip(labels) {
                if label != NOTHING_SAID && (label != 0 || *object == 0) {
                    *hand = label;
                } else if label == 0 && *hand == *object {
                    *hand = NOTHING_SAID;
                }
            }
        }
        hand
    }

    /// Whether a pixel is within all boxes of prompts.
    pub(super) fn is_within(&self, [x, y]: [usize; 2]) -> bool {
        let boxes = self.prompts.iter().filter_map(|of| of.prompt.within);
        boxes
            .into_iter()
            .all(|[left, top, columns, rows]| (left..left + columns).contains(&x) && (top..top + rows).contains(&y))
    }

    /// The numbers that prompts outline, with their pixels.
    pub(super) fn outlines(&self) -> impl Iterator<Item = (u8, Vec<u8>)> + '_ {
        self.prompts.iter().map(|of| (of.prompt.object, of.labels.values()))
    }
}
