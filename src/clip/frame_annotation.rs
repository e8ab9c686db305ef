//! A person's annotations of one frame, as they were given, and the seeds of each object that follow from them.

use super::annotation::{ObjectSet, Painted, Prompt, Seed, Spread, is_object};
use super::options::model;
use super::runs::Runs;
use super::saved::saved;
use crate::answer::UNLABELLED;
use crate::components::{Component, Connectivity, components};

/// The annotations of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct FrameAnnotation {
    /// In the order of their last change; later ones cover earlier ones.
    painted: Vec<Strokes>,
    /// In ascending order of objects.
    prompts: Vec<Outlined>,
    /// In ascending order of objects: 0 in separate pieces that strokes have removed, 255 elsewhere.
    pieces: Vec<(u8, Runs)>,
    /// In ascending order of objects: 1 in the object's mask before strokes were first drawn in the frame.
    bases: Vec<(u8, Runs)>,
    /// In ascending order of objects: 1 in the mask that a person saw right after strokes were drawn.
    seen: Vec<(u8, Runs)>,
    /// Objects of which this frame is an anchor.
    pub(super) anchored: Vec<u8>,
    /// Annotated objects from which a label map without object numbers takes pixels.
    pub(super) takes_from: Vec<u8>,
}

saved!(FrameAnnotation { painted, prompts, pieces, bases, seen, anchored, takes_from });

/// Strokes or a label map: a label for each full-size pixel, 255 where there is none.
#[derive(Clone, Debug, PartialEq)]
struct Strokes {
    /// Number of the object; 0 for a label map.
    object: u8,
    labels: Runs,
    spread: Spread,
}

saved!(Strokes { object, labels, spread });

/// A prompt, and its outline: the object's number inside, 0 outside, 255 where another object keeps its pixels.
#[derive(Clone, Debug, PartialEq)]
struct Outlined {
    prompt: Prompt,
    labels: Runs,
}

saved!(Outlined { prompt, labels });

/// A new annotation of a frame.
#[derive(Clone, Debug)]
pub(super) enum Change {
    /// Label maps and strokes; empty ones remove earlier ones.
    Painted(Vec<Painted>),
    Prompt(Prompt),
    /// Takes back what was annotated of an object; without an object, everything.
    Clear(Option<u8>),
}

impl FrameAnnotation {
    pub(super) fn is_empty(&self) -> bool {
        self.painted.is_empty() && self.prompts.is_empty()
    }

    pub(super) fn is_valid(&self, pixels: usize) -> bool {
        let painted = self.painted.iter().map(|strokes| &strokes.labels);
        let pieces = self.pieces.iter().chain(&self.bases).chain(&self.seen).map(|(_, labels)| labels);
        painted.chain(self.prompts.iter().map(|of| &of.labels)).chain(pieces).all(|labels| labels.is_valid(pixels))
    }

    /// Replaces the label map, or the strokes of the same object. An empty label map removes all annotations of the frame.
    #[inline(never)]
    pub(super) fn paint(&mut self, painted: &Painted) {
        let object = painted.object.unwrap_or(0);
        let (labels, spread) = (Runs::of(&painted.labels), painted.spread);
        let strokes = Strokes { object, labels, spread };
        if self.painted.contains(&strokes) {
            return;
        }
        let is_nothing = painted.labels.iter().all(|&label| label == UNLABELLED);
        if is_nothing && painted.object.is_none() {
            *self = FrameAnnotation::default();
            return;
        }
        self.take_back_painted(object);
        if !is_nothing {
            self.painted.push(strokes);
        }
    }

    /// Replaces the prompt of the same object and its outline.
    #[inline(never)]
    pub(super) fn point(&mut self, prompt: Prompt, labels: &[u8]) {
        self.take_back_prompt(prompt.object);
        if prompt.points() {
            let at = self.prompts.partition_point(|of| of.prompt.object < prompt.object);
            self.prompts.insert(at, Outlined { prompt, labels: Runs::of(labels) });
        }
    }

    /// Removes all annotations of an object: its strokes, its prompt, and its labels in a label map, which goes if no other object is in it.
    pub(super) fn clear(&mut self, object: Option<u8>) {
        let Some(object) = object else {
            *self = FrameAnnotation::default();
            return;
        };
        self.take_back_painted(object);
        self.take_back_prompt(object);
        if self.names_in_map(object) {
            let without = |label: u8| if label == object { UNLABELLED } else { label };
            self.painted.iter_mut().filter(|of| of.object == 0).for_each(|map| map.labels = map.labels.map(without));
            if self.names_no_object() {
                self.take_back_painted(0);
            }
        }
    }

    /// The label maps and strokes, and the prompts, as they were given.
    pub(super) fn given(&self, frame: usize) -> (Vec<Painted>, Vec<Prompt>) {
        let painted = |Strokes { object, labels, spread }: &Strokes| Painted {
            frame,
            object: Some(*object).filter(|&object| object > 0),
            labels: labels.values(),
            spread: *spread,
        };
        let prompts = self.prompts.iter().map(|of| of.prompt.clone()).collect();
        (self.painted.iter().map(painted).collect(), prompts)
    }

    /// Marks the labels of the label map, and the objects of strokes and prompts.
    pub(super) fn mark(&self, is_there: &mut ObjectSet) {
        for Strokes { object, labels, .. } in &self.painted {
            is_there[usize::from(*object)] = true;
            if *object == 0 {
                labels.mark(is_there);
            }
        }
        self.prompts.iter().for_each(|of| is_there[usize::from(of.prompt.object)] = true);
    }

    /// Removes the strokes and prompts of deleted objects, whose `numbers` are 0. Label maps stay, because they also exclude other objects.
    #[inline(never)]
    pub(super) fn forget(&mut self, numbers: &[u8]) {
        for object in (1..UNLABELLED).filter(|&object| numbers[usize::from(object)] == 0) {
            self.take_back_painted(object);
            self.take_back_prompt(object);
        }
    }

    #[inline(never)]
    fn take_back_painted(&mut self, object: u8) {
        self.painted.retain(|strokes| strokes.object != object);
    }

    #[inline(never)]
    fn take_back_prompt(&mut self, object: u8) {
        self.prompts.retain(|of| of.prompt.object != object);
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

    /// The strokes of an object: its number inside, 0 outside, 255 where there are none.
    pub(super) fn painted_of(&self, object: u8) -> Option<Vec<u8>> {
        Some(self.strokes(object)?.labels.values())
    }

    /// The label map, if it annotates an object: if it contains the object's number, or no object number at all.
    fn map_of(&self, object: u8) -> Option<&Strokes> {
        self.strokes(0).filter(|_| self.names_in_map(object) || self.names_no_object())
    }

    /// Whether there is a label map without object numbers. It erases all objects at its zeros.
    #[inline(never)]
    pub(super) fn names_no_object(&self) -> bool {
        self.strokes(0).is_some_and(|map| !map.labels.any(&is_object))
    }

    /// Whether any annotation has the number of an object.
    #[inline(never)]
    pub(super) fn names(&self, object: u8) -> bool {
        self.names_in_map(object) || self.strokes(object).is_some() || self.outlined(object).is_some()
    }

    /// Whether other annotations of the frame annotate an object equally by its number. For 0, whether both have the same label map without
    /// object numbers.
    #[inline(never)]
    pub(super) fn agrees(&self, other: &FrameAnnotation, object: u8) -> bool {
        self.about(object) == other.about(object)
    }

    /// The label map, strokes and outline that have the number of an object; for 0, a label map without object numbers.
    #[inline(never)]
    fn about(&self, object: u8) -> (Option<&Strokes>, Option<&Strokes>, Option<&Outlined>) {
        let is_map = if object == 0 { self.names_no_object() } else { self.names_in_map(object) };
        let map = self.strokes(0).filter(|_| is_map);
        (map, self.strokes(object).filter(|_| object > 0), self.outlined(object))
    }

    /// Whether seeds of an object were only added since `before`, none removed.
    pub(super) fn extends(&self, before: &FrameAnnotation, object: u8) -> bool {
        if self.agrees(before, object) {
            return true;
        }
        let now = self.seeds(object).unwrap_or_default();
        let is_kept = |(p, seed): (usize, &Seed)| *seed == Seed::Nothing || now.get(p) == Some(seed);
        before.seeds(object).unwrap_or_default().iter().enumerate().all(is_kept)
    }

    /// Whether other annotations of the frame have the same labels and prompts.
    pub(super) fn is_same(&self, other: &FrameAnnotation) -> bool {
        self.painted == other.painted && self.prompts == other.prompts
    }

    /// Removes a separate piece of an object as a whole when a new stroke removes pixels in it. `now` are the labels that the frame shows,
    /// `before` its annotations so far.
    #[inline(never)]
    pub(super) fn drop_pieces(&mut self, before: &FrameAnnotation, now: &[u8], width: usize) {
        // A piece whose stroke was taken back belongs to the object again.
        let mut pieces = std::mem::take(&mut self.pieces);
        pieces.retain(|(object, piece)| {
            let seeds = self.seeds(*object).unwrap_or_default();
            seeds.iter().zip(piece.values()).any(|(seed, label)| label == 0 && *seed == Seed::Other)
        });
        self.pieces = pieces;
        let mut objects = [false; 256];
        now.iter().for_each(|&label| objects[usize::from(label)] = true);
        for object in (1..UNLABELLED).filter(|&k| objects[usize::from(k)]) {
            let is_about = self.names_no_object() && !self.agrees(before, 0) || !self.agrees(before, object);
            let Some(seeds) = is_about.then(|| self.seeds(object)).flatten() else { continue };
            let old = before.seeds(object);
            let inside: Vec<u8> = now.iter().map(|&label| u8::from(label == object)).collect();
            let parts = components(&inside, width, Connectivity::Eight);
            let mut is_annotated = vec![false; parts.list.len()];
            // First and last column and row of the new strokes in each component.
            let mut strokes = vec![[usize::MAX, usize::MAX, 0, 0]; parts.list.len()];
            for p in 0..now.len() {
                let part = parts.of[p] as usize;
                is_annotated[part] |= seeds[p] == Seed::Object;
                if seeds[p] == Seed::Other && old.as_ref().is_none_or(|old| old[p] != Seed::Other) {
                    let ([x, y], [left, top, right, bottom]) = ([p % width, p / width], strokes[part]);
                    strokes[part] = [left.min(x), top.min(y), right.max(x), bottom.max(y)];
                }
            }
            let all: usize = parts.list.iter().filter(|part| part.label > 0).map(|part| part.size).sum();
            let goes = |part: usize| {
                let (Component { label, size, bounds, .. }, drawn) = (parts.list[part], strokes[part]);
                let length = |[left, top, right, bottom]: [usize; 4]| (right - left).max(bottom - top) + 1;
                if label == 0 || is_annotated[part] || drawn[0] > drawn[2] {
                    return false;
                }
                // A short stroke in a large piece may be about part of it; a stroke across the piece is about all of it.
                let is_through = length(drawn) as f32 > (1.0 - model().uncrossed) * length(bounds) as f32;
                (size as f32) < model().piece * all as f32 || is_through && 2 * size < all
            };
            let goes: Vec<bool> = (0..parts.list.len()).map(goes).collect();
            let mut piece: Vec<u8> =
                parts.of.iter().map(|&part| if goes[part as usize] { 0 } else { UNLABELLED }).collect();
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

    /// Keeps the masks of objects before strokes change them, from the labels that the frame shows.
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
        self.bases = (1..UNLABELLED).filter(|&k| is_stroked(k)).map(base).collect();
    }

    /// The mask of an object before strokes were drawn: 1 inside. `None` without strokes.
    pub(super) fn base(&self, object: u8) -> Option<Vec<u8>> {
        self.bases.iter().find(|(of, _)| *of == object).map(|(_, base)| base.values())
    }

    /// Keeps the masks of changed objects with strokes, from the labels of the frame.
    #[inline(never)]
    pub(super) fn keep_seen(&mut self, labels: &[u8], changing: &ObjectSet) {
        let seen = |k: u8| {
            let known = self.seen.iter().find(|(of, _)| *of == k && !changing[usize::from(k)]);
            let now = || Runs::of(&labels.iter().map(|&label| u8::from(label == k)).collect::<Vec<u8>>());
            (k, known.map_or_else(now, |(_, seen)| seen.clone()))
        };
        self.seen = self.bases.iter().map(|(k, _)| seen(*k)).filter(|(_, seen)| seen.names(1)).collect();
    }

    /// The mask of an object right after strokes were drawn: 1 inside. `None` if it had no pixels.
    pub(super) fn seen(&self, object: u8) -> Option<Vec<u8>> {
        self.seen.iter().find(|(of, _)| *of == object).map(|(_, seen)| seen.values())
    }

    fn names_in_map(&self, object: u8) -> bool {
        self.strokes(0).is_some_and(|map| map.labels.names(object))
    }

    /// Whether a person has painted the whole mask of an object. The outline of a prompt does not count.
    pub(super) fn is_whole(&self, object: u8) -> bool {
        let painted = [self.strokes(object), self.strokes(0).filter(|_| self.names_in_map(object))];
        painted.into_iter().flatten().any(|of| !of.labels.names(UNLABELLED))
    }

    /// The frames to which the annotations of an object spread.
    #[inline(never)]
    pub(super) fn spread_of(&self, object: u8) -> Spread {
        let painted = self.strokes(object).or(self.map_of(object)).map(|strokes| strokes.spread);
        painted.or(self.prompt(object).map(|prompt| prompt.spread)).unwrap_or_default()
    }

    /// The seeds of an object at full size, if it is annotated. Strokes take precedence over a label map, and that over a prompt.
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
            for (seed, label) in seeds.iter_mut().zip(labels).filter(|(_, label)| *label != UNLABELLED) {
                *seed = if label == object { Seed::Object } else { other };
            }
        }
        seeds
    }

    /// The seeds of an object at full size, if it was painted.
    pub(super) fn painted_seeds(&self, object: u8) -> Option<Vec<Seed>> {
        let is_painted = self.strokes(object).is_some() || self.names_in_map(object);
        is_painted.then(|| self.seeds(object)).flatten()
    }

    /// The painted labels at full size: the number of an object, 0 for the ground of a label map, 255 where nothing is painted.
    #[inline(never)]
    pub(super) fn painted_labels(&self) -> Option<Vec<u8>> {
        let mut painted: Option<Vec<u8>> = None;
        for Strokes { object, labels, .. } in &self.painted {
            let labels = labels.values();
            let painted = painted.get_or_insert_with(|| vec![UNLABELLED; labels.len()]);
            for (painted, label) in painted.iter_mut().zip(labels) {
                if label != UNLABELLED && (label != 0 || *object == 0) {
                    *painted = label;
                } else if label == 0 && *painted == *object {
                    *painted = UNLABELLED;
                }
            }
        }
        painted
    }

    /// Whether a pixel is inside the boxes of all prompts.
    pub(super) fn is_within(&self, [x, y]: [usize; 2]) -> bool {
        let boxes = self.prompts.iter().filter_map(|of| of.prompt.within);
        boxes
            .into_iter()
            .all(|[left, top, columns, rows]| (left..left + columns).contains(&x) && (top..top + rows).contains(&y))
    }

    /// The objects of prompts, with their outlines.
    pub(super) fn outlines(&self) -> impl Iterator<Item = (u8, Vec<u8>)> + '_ {
        self.prompts.iter().map(|of| (of.prompt.object, of.labels.values()))
    }
}
