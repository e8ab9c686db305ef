//! Annotations that are given together take effect in a fixed order: reserved numbers, deletions, locks and names, accepted frames, label
//! maps and strokes, prompts, merges.

use std::collections::VecDeque;

use super::annotation::{Accepted, Annotations, ObjectSet, Painted, Prompt};
use super::changes::{Changed, Changes};
use super::correction::SceneCorrection;
use super::frame_annotation::{Change, FrameAnnotation};
use super::segmented_clip::SegmentedClip;
use crate::answer::UNLABELLED;
use crate::error::{Error, Result};
use crate::frame::Frame;

impl SegmentedClip {
    /// Begins a job that applies annotations. They are checked at once, and take effect as the job takes the frames that it wants.
    ///
    /// Objects that a person has named, painted, given as masks, prompted, accepted or locked change only by annotations of themselves. An
    /// object found automatically changes by the pixels that annotated objects take from it or give back.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] for a frame index that is not below [`len`](Self::len), labels that do not fill the frame, prompts outside
    /// the frame, and numbers that are not those of objects; [`Error::ObjectLocked`] for annotations of a locked object. The clip is then
    /// unchanged.
    pub fn annotate(&mut self, annotations: Annotations) -> Result<ClipJob> {
        ClipJob::new(self, annotations)
    }
}

/// Annotations that take effect in a [`SegmentedClip`]. A job asks for the frames that it needs:
///
/// ```
/// use veronese::Frame;
/// use veronese::clip::{Annotations, ClipOptions, ClipSegmenter, Painted, Spread};
///
/// # fn main() -> veronese::Result<()> {
/// let frames = [(); 3].map(|()| Frame::from_rgba(64, 48, [90; 4 * 64 * 48].as_slice()).expect("a frame"));
/// let mut segmenter = ClipSegmenter::new(ClipOptions::default())?;
/// for frame in &frames {
///     segmenter.push(frame.clone())?;
/// }
/// let mut clip = segmenter.conclude();
///
/// // The left half of frame 1 is object 7; the rest is not annotated.
/// let labels = (0..64 * 48).map(|p| if p % 64 < 32 { 7 } else { 255 }).collect();
/// let corrections = vec![Painted { frame: 1, object: None, labels, spread: Spread::Both }];
/// let mut job = clip.annotate(Annotations { corrections, ..Annotations::default() })?;
/// while let Some(index) = job.wanted() {
///     job.take(&mut clip, &frames[index])?;
/// }
/// assert!(job.changed().contains(&1));
/// assert_eq!(clip.frame(1, &frames[1])?.labels[0], 7);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct ClipJob {
    steps: VecDeque<Step>,
    correction: Option<SceneCorrection>,
    /// Objects to lock when all steps are done.
    locks: Vec<u8>,
    /// Objects and their new numbers; merges take effect when all steps are done.
    numbers: Vec<[u8; 2]>,
    changes: Changes,
}

#[derive(Clone, Debug)]
enum Step {
    Accept(Accepted),
    /// Annotations of the frames of a scene.
    Correct(VecDeque<(usize, Change)>),
}

impl ClipJob {
    fn new(clip: &mut SegmentedClip, annotations: Annotations) -> Result<ClipJob> {
        annotations.frames().into_iter().try_for_each(|frame| clip.check_index(frame))?;
        annotations.check(clip.size())?;
        if let Some(object) = annotated_locked_object(clip, &annotations) {
            return Err(Error::ObjectLocked { object });
        }
        let locks = locked_last(clip, &annotations);
        let Annotations { mut masks, cleared, corrections, prompts, locked, named, accepted, numbers } = annotations;
        let mut job = ClipJob { steps: VecDeque::new(), correction: None, locks, numbers, changes: Changes::default() };
        let mut is_given = [false; 256];
        for mask in &masks {
            mask.labels.iter().for_each(|&label| is_given[usize::from(label)] = true);
        }
        let given: Vec<u8> = (1..UNLABELLED).filter(|&label| is_given[usize::from(label)]).collect();
        given.iter().for_each(|&label| clip.objects_mut().given[usize::from(label)] = true);
        if !given.is_empty() {
            clip.reserve(&given).into_iter().for_each(|frame| job.changes.add(frame));
        }
        // Deleted objects claim no pixel from the first step on.
        job.renumber(clip, true);
        if let Some(objects) = locked {
            clip.objects_mut().locked = clip.objects.with_merged(&objects);
        }
        if let Some(objects) = named {
            clip.objects_mut().named = clip.objects.with_merged(&objects);
        }
        job.locks.iter().for_each(|&object| locks_of(clip)[usize::from(object)] = false);
        if let Some(accepted) = accepted {
            for (index, frame) in clip.frames.iter_mut().enumerate() {
                frame.accepted &= accepted.iter().any(|of| of.frame == index);
            }
            let is_new = |of: &Accepted| !clip.frames[of.frame].accepted || of.labels.is_some();
            let accept: Vec<Step> = accepted.into_iter().filter(is_new).map(Step::Accept).collect();
            if !accept.is_empty() {
                // A frame is accepted as it is after the masks.
                job.steps.extend(by_scene(clip, painted(&masks, &[])));
                job.steps.extend(accept);
                masks.retain(|mask| corrections.iter().any(|painted| painted.frame == mask.frame));
            }
        }
        let mut changes: Vec<(usize, Change)> = Vec::new();
        changes.extend(cleared.into_iter().map(|(frame, object)| (frame, Change::Clear(object))));
        changes.append(&mut painted(&masks, &corrections));
        changes.extend(prompts.into_iter().map(|prompt| (prompt.frame, Change::Prompt(prompt))));
        job.steps.extend(by_scene(clip, changes));
        job.conclude(clip);
        Ok(job)
    }

    /// Index of the frame to [`take`](Self::take) next; `None` when all annotations have taken effect.
    pub fn wanted(&self) -> Option<usize> {
        let of_correction = self.correction.as_ref().and_then(SceneCorrection::wanted);
        of_correction.or_else(|| match self.steps.front()? {
            Step::Accept(accepted) => Some(accepted.frame),
            Step::Correct(changes) => changes.front().map(|(index, _)| *index),
        })
    }

    /// The frames changed so far, each once, in the order in which they changed first. A frame may change again.
    pub fn changed(&self) -> &[usize] {
        self.changes.frames()
    }

    /// The same job after earlier ones: it goes on with their changes.
    pub(super) fn after(self, earlier: Changes) -> ClipJob {
        let mut changes = earlier;
        self.changes.frames().iter().for_each(|&frame| changes.add(frame));
        ClipJob { changes, ..self }
    }

    /// What has changed, for the next job.
    pub(super) fn into_changes(self) -> Changes {
        self.changes
    }

    /// Numbers of pixels that objects have gained and lost so far, by frame, then by object. Changes by [`Annotations::numbers`] are not
    /// counted.
    pub fn changes(&self) -> Vec<Changed> {
        self.changes.list()
    }

    /// Takes the frame that is [`wanted`](Self::wanted).
    ///
    /// # Errors
    /// [`Error::FrameSizeMismatch`], [`Error::OtherFrame`]; the job can continue with the right frame.
    pub fn take(&mut self, clip: &mut SegmentedClip, frame: &Frame) -> Result<()> {
        if self.correction.is_none() {
            let Some(wanted) = self.wanted() else { return Ok(()) };
            clip.check(wanted, frame)?;
            match self.steps.pop_front() {
                Some(Step::Accept(accepted)) => clip.accept(frame, accepted, &mut self.changes),
                Some(Step::Correct(changes)) => self.correction = Some(SceneCorrection::new(clip, changes)),
                None => {}
            }
        }
        if let Some(correction) = &mut self.correction {
            correction.take(clip, frame, &mut self.changes)?;
            if correction.wanted().is_none() {
                self.correction = None;
            }
        }
        self.conclude(clip);
        Ok(())
    }

    /// After the last step, locks objects and gives them their new numbers.
    fn conclude(&mut self, clip: &mut SegmentedClip) {
        if self.wanted().is_none() {
            std::mem::take(&mut self.locks).into_iter().for_each(|object| locks_of(clip)[usize::from(object)] = true);
            self.renumber(clip, false);
        }
    }

    /// Deletes objects, or merges them.
    #[inline(never)]
    fn renumber(&mut self, clip: &mut SegmentedClip, deletes: bool) {
        for &numbers in self.numbers.iter().filter(|[_, number]| (*number == 0) == deletes) {
            clip.renumber(numbers).into_iter().for_each(|frame| self.changes.add(frame));
        }
    }
}

/// For each object, whether it is locked.
fn locks_of(clip: &mut SegmentedClip) -> &mut ObjectSet {
    &mut clip.objects_mut().locked
}

/// One step per scene: annotations of its frames spread together.
#[inline(never)]
fn by_scene(clip: &SegmentedClip, changes: Vec<(usize, Change)>) -> Vec<Step> {
    let mut scenes: Vec<VecDeque<(usize, Change)>> = Vec::new();
    for (index, change) in changes {
        let scene = clip.scene(index);
        match scenes.iter_mut().find(|of| of.front().is_some_and(|(other, _)| clip.scene(*other) == scene)) {
            Some(changes) => changes.push_back((index, change)),
            None => scenes.push(VecDeque::from([(index, change)])),
        }
    }
    scenes.into_iter().map(Step::Correct).collect()
}

/// The painted annotations of each frame. A correction replaces the mask of its frame where it is not 255.
#[inline(never)]
fn painted(masks: &[Painted], corrections: &[Painted]) -> Vec<(usize, Change)> {
    let mut frames: Vec<(usize, Vec<Painted>)> = Vec::new();
    for painted in masks.iter().chain(corrections) {
        let at = frames.iter().position(|(index, _)| *index == painted.frame).unwrap_or_else(|| {
            frames.push((painted.frame, Vec::new()));
            frames.len() - 1
        });
        let of_frame = &mut frames[at].1;
        match of_frame.iter_mut().find(|before| before.object == painted.object) {
            None => of_frame.push(painted.clone()),
            Some(mask) => {
                let annotated = mask.labels.iter_mut().zip(&painted.labels).filter(|(_, label)| **label != UNLABELLED);
                annotated.for_each(|(mask, label)| *mask = *label);
                mask.spread = painted.spread;
            }
        }
    }
    frames.into_iter().map(|(index, painted)| (index, Change::Painted(painted))).collect()
}

/// Objects that are annotated and locked by the same call. Their annotations still take effect.
fn locked_last(clip: &SegmentedClip, annotations: &Annotations) -> Vec<u8> {
    let Annotations { masks, corrections, prompts, locked, .. } = annotations;
    let is_about = |object: u8| {
        let names =
            |painted: &Painted| painted.object.map_or_else(|| painted.labels.contains(&object), |of| of == object);
        masks.iter().chain(corrections).any(names) || prompts.iter().any(|prompt| prompt.object == object)
    };
    let is_new = |object: &u8| !clip.objects.locked[usize::from(*object)] && is_about(*object);
    locked.iter().flatten().copied().filter(is_new).collect()
}

/// An object that was locked before and stays locked, and that the annotations would change.
fn annotated_locked_object(clip: &SegmentedClip, annotations: &Annotations) -> Option<u8> {
    let Annotations { cleared, corrections, prompts, locked, numbers, .. } = annotations;
    let stays_locked = |object: &u8| match locked {
        Some(locked) => locked.contains(object),
        None => clip.objects.locked[usize::from(*object)],
    };
    let is_locked = |object: &u8| clip.objects.locked[usize::from(*object)] && stays_locked(object);
    let before =
        |frame: usize| -> FrameAnnotation { clip.frames[frame].annotation.as_deref().cloned().unwrap_or_default() };
    let changed = |frame: usize, change: &dyn Fn(&mut FrameAnnotation)| {
        let before = before(frame);
        let mut now = before.clone();
        change(&mut now);
        (1..UNLABELLED).find(|object| is_locked(object) && !now.agrees(&before, *object))
    };
    let painted = |painted: &Painted| changed(painted.frame, &|now| now.paint(painted));
    let taken_back = |(frame, object): &(usize, Option<u8>)| changed(*frame, &|now| now.clear(*object));
    let prompted =
        |prompt: &&Prompt| is_locked(&prompt.object) && before(prompt.frame).prompt(prompt.object) != Some(prompt);
    // An object cannot be deleted and locked at once, and a locked one is not merged.
    let edited = |[object, number]: &[u8; 2]| {
        let kept = match number {
            0 => stays_locked(object).then_some(*object),
            number if number == object => None,
            _ => [*object, *number].into_iter().find(is_locked),
        };
        kept.filter(|_| !clip.frames_with(*object).is_empty())
    };
    corrections
        .iter()
        .find_map(painted)
        .or_else(|| cleared.iter().find_map(taken_back))
        .or_else(|| prompts.iter().find(prompted).map(|prompt| prompt.object))
        .or_else(|| numbers.iter().find_map(edited))
}
