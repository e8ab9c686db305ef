//! Calls on whole clips whose states the caller keeps, for the page: a clip is pushed, then concluded (or restored from its saved state); after
//! that it gives labels of any frame and takes annotations. All calls return `null` if there is no such clip, or if it is in another state.

use std::cell::RefCell;

use wasm_bindgen::prelude::*;

use crate::Failure;
use crate::clip::{bytes, bytes_in, changed, clip_frame, each, get, indices, number, spread};
use crate::frames::frame_from_pixels;
use crate::plain::Record;
use crate::stream::clip_options;
use veronese::clip::{
    Accepted, Annotations, Click, ClipJob, ClipSegmenter, FramePairs, Painted, Prompt, SegmentedClip,
};
use veronese::{Error, Frame};

thread_local! {
    /// Clips in progress; rarely more than one.
    static CLIPS: RefCell<Vec<(u32, Clip)>> = const { RefCell::new(Vec::new()) };
}

/// The state of a clip.
enum Clip {
    Pairs(ClipSegmenter),
    Segmented {
        clip: SegmentedClip,
        job: Option<ClipJob>,
        /// Whether it was restored from bytes.
        restored: bool,
    },
}

/// Begins a clip. `clip` is a number that no other clip has had. Options: `motions`, `quality`, `markUnknown`, `subject` and `lookAhead`.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`.
#[wasm_bindgen(js_name = beginClip)]
pub fn begin_clip(clip: u32, options: &JsValue) -> Result<(), JsValue> {
    keep(clip, Clip::Pairs(ClipSegmenter::new(clip_options(options)?).map_err(Failure::from)?));
    Ok(())
}

/// Adds a frame, `{ data, width, height }`. Returns the solved pairs of the frame as bytes, or `undefined` if these bytes were `known`; bytes
/// that are damaged, or of another version, other options or other frames are ignored.
///
/// # Errors
/// A `VeroneseError` of code `frame-size-mismatch`, or `invalid-input` for a malformed frame. The clip can continue with another frame.
#[wasm_bindgen(js_name = pushClip)]
pub fn push_clip(clip: u32, frame: &JsValue, known: Option<Vec<u8>>) -> Result<JsValue, JsValue> {
    let mut given = Some((frame_from_pixels("the frame", frame)?, known));
    step(clip, &mut |clip| {
        let (frame, known) = given.take()?;
        match clip {
            Clip::Pairs(segmenter) => Some(push_pairs(segmenter, frame, known)),
            Clip::Segmented { .. } => None,
        }
    })
}

fn push_pairs(segmenter: &mut ClipSegmenter, frame: Frame, known: Option<Vec<u8>>) -> Result<JsValue, Error> {
    if let Some(pairs) = known.and_then(|bytes| FramePairs::from_bytes(&bytes).ok()) {
        match segmenter.push_known(frame.clone(), &pairs) {
            Err(Error::InvalidOption { .. }) => {}
            pushed => return pushed.map(|()| JsValue::UNDEFINED),
        }
    }
    segmenter.push(frame).map(|pairs| bytes(&pairs.to_bytes()))
}

/// A preview of the newest frame whose pairs are all solved, from these pairs alone, as [`push_clip`] of a stream returns a frame;
/// `undefined` if there is none that was not returned before.
#[wasm_bindgen(js_name = previewClip)]
pub fn preview_clip(clip: u32) -> Result<JsValue, JsValue> {
    step(clip, &mut |clip| match clip {
        Clip::Pairs(segmenter) => Some(Ok(segmenter.preview().map_or(JsValue::UNDEFINED, |frame| clip_frame(&frame)))),
        _ => None,
    })
}

/// Concludes a whole clip of the frames so far. Returns what [`restore_clip`] does.
#[wasm_bindgen(js_name = concludeClip)]
pub fn conclude_clip(clip: u32) -> JsValue {
    match take(clip) {
        Some(Clip::Pairs(segmenter)) => keep_segmented(clip, segmenter.conclude(), false),
        _ => JsValue::NULL,
    }
}

/// Puts a concluded clip, from the bytes of [`save_clip`], in the place of one that has begun. Returns `{ length, width, height, dropped }`.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option` for other bytes.
#[wasm_bindgen(js_name = restoreClip)]
pub fn restore_clip(clip: u32, state: &[u8], mark_unknown: bool) -> Result<JsValue, JsValue> {
    let mut segmented = SegmentedClip::from_bytes(state).map_err(Failure::from)?;
    segmented.mark_unknown(mark_unknown);
    end_clip(clip);
    Ok(keep_segmented(clip, segmented, true))
}

/// The bytes of a concluded clip, for [`restore_clip`].
#[wasm_bindgen(js_name = saveSegmented)]
pub fn save_segmented(clip: u32) -> Result<JsValue, JsValue> {
    segmented(clip, &mut |clip, _| Ok(bytes(&clip.to_bytes())))
}

/// A frame of a concluded clip, as [`push_clip`] of a stream returns it.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option`, `frame-size-mismatch` or `invalid-input`. A frame that is not the one that was segmented is
/// `invalid-input`, of a restored clip `invalid-option`.
#[wasm_bindgen(js_name = clipFrame)]
pub fn frame_of_clip(clip: u32, index: usize, frame: &JsValue) -> Result<JsValue, JsValue> {
    let frame = frame_from_pixels("the frame", frame)?;
    segmented(clip, &mut |clip, _| clip.frame(index, &frame).map(|frame| clip_frame(&frame)))
}

/// Begins to apply annotations to a concluded clip, given as `Annotations` of pkg/src/calls/messages.ts. Returns `{ wanted, changed,
/// changes, objects }`: the index of the frame to take next, `undefined` at the end; the indices of the changed frames; and at the end the
/// pixels that objects have gained and lost, and the numbers of all objects before merges and deletions.
///
/// # Errors
/// A `VeroneseError` of code `invalid-option` or `object-locked`. The clip is then unchanged.
#[wasm_bindgen(js_name = annotateClip)]
pub fn annotate_clip(clip: u32, annotations: &JsValue) -> Result<JsValue, JsValue> {
    let mut given = Some(annotations_of(annotations));
    segmented(clip, &mut |clip, job| {
        let begun = job.insert(clip.annotate(given.take().unwrap_or_default())?);
        Ok(news(clip, begun, 0))
    })
}

/// Takes the frame that the annotations want. Returns what [`annotate_clip`] does, with the frames that have changed for the first time
/// since the previous call.
///
/// # Errors
/// As [`frame_of_clip`].
#[wasm_bindgen(js_name = takeAnnotations)]
pub fn take_annotations(clip: u32, frame: &JsValue) -> Result<JsValue, JsValue> {
    let frame = frame_from_pixels("the frame", frame)?;
    segmented(clip, &mut |clip, job| {
        let Some(job) = job else { return Ok(JsValue::NULL) };
        let known = job.changed().len();
        job.take(clip, &frame)?;
        Ok(news(clip, job, known))
    })
}

/// Ends a clip and frees its memory. Does nothing if there is no such clip.
#[wasm_bindgen(js_name = endClip)]
pub fn end_clip(clip: u32) {
    drop(take(clip));
}

fn keep(number: u32, clip: Clip) {
    CLIPS.with_borrow_mut(|clips| clips.push((number, clip)));
}

fn keep_segmented(number: u32, clip: SegmentedClip, restored: bool) -> JsValue {
    let [width, height] = clip.size();
    let described = Record::new()
        .count("length", clip.len())
        .count("width", width)
        .count("height", height)
        .count("dropped", clip.dropped())
        .into_value();
    keep(number, Clip::Segmented { clip, job: None, restored });
    described
}

fn take(clip: u32) -> Option<Clip> {
    CLIPS.with_borrow_mut(|clips| {
        let place = clips.iter().position(|(number, _)| *number == clip)?;
        Some(clips.swap_remove(place).1)
    })
}

/// What `work` returns for a clip, or `null`. Not generic, so that it is compiled only once.
fn step(clip: u32, work: &mut dyn FnMut(&mut Clip) -> Option<Result<JsValue, Error>>) -> Result<JsValue, JsValue> {
    let done = CLIPS.with_borrow_mut(|clips| {
        let (_, clip) = clips.iter_mut().find(|(number, _)| *number == clip)?;
        work(clip)
    });
    Ok(done.transpose().map_err(Failure::from)?.unwrap_or(JsValue::NULL))
}

/// Work on a concluded clip and on the job of its annotations.
type Work<'a> = &'a mut dyn FnMut(&mut SegmentedClip, &mut Option<ClipJob>) -> Result<JsValue, Error>;

/// [`step`] for a concluded clip. If frames are not those of a restored state, the error is about the state.
fn segmented(clip: u32, work: Work<'_>) -> Result<JsValue, JsValue> {
    step(clip, &mut |clip| match clip {
        Clip::Segmented { clip, job, restored } => Some(work(clip, job).map_err(|error| match error {
            Error::OtherFrame { .. } if *restored => Error::InvalidOption { name: "state", reason: error.to_string() },
            error => error,
        })),
        _ => None,
    })
}

/// The progress of a job; the first `known` of its changed frames were returned before.
fn news(clip: &SegmentedClip, job: &ClipJob, known: usize) -> JsValue {
    let progress = Record::new().set("changed", &indices(&job.changed()[known..]));
    match job.wanted() {
        Some(index) => progress.count("wanted", index),
        None => {
            let objects = clip.objects();
            progress.list("changes", &job.changes(), changed).list("objects", &objects, |object| (*object).into())
        }
    }
    .into_value()
}

/// Annotations from their plain object, whose values the package has checked.
fn annotations_of(value: &JsValue) -> Annotations {
    let frames = |name| -> Option<Vec<Accepted>> {
        get(value, name)?;
        let accepted = |entry: &JsValue| Accepted { frame: number(entry, "frame"), labels: bytes_in(entry, "labels") };
        Some(each(value, name).iter().map(accepted).collect())
    };
    let numbers = bytes_in(value, "numbers").unwrap_or_default();
    Annotations {
        cleared: Vec::new(),
        masks: painted_in(value, "masks"),
        corrections: painted_in(value, "corrections"),
        prompts: each(value, "prompts").iter().map(prompt).collect(),
        locked: bytes_in(value, "locked"),
        named: bytes_in(value, "named"),
        accepted: frames("accepted"),
        numbers: numbers.as_chunks::<2>().0.to_vec(),
        ..Annotations::default()
    }
}

fn painted_in(value: &JsValue, name: &str) -> Vec<Painted> {
    let painted = |entry: JsValue| Painted {
        frame: number(&entry, "frame"),
        object: Some(number(&entry, "object") as u8).filter(|object| *object > 0),
        labels: bytes_in(&entry, "labels").unwrap_or_default(),
        spread: spread(&entry),
    };
    each(value, name).into_iter().map(painted).collect()
}

fn prompt(entry: &JsValue) -> Prompt {
    let places = |name| -> Vec<usize> {
        each(entry, name).into_iter().map(|place| place.as_f64().unwrap_or_default() as usize).collect()
    };
    let clicks = places("clicks")
        .as_chunks::<3>()
        .0
        .iter()
        .map(|&[x, y, inside]| Click { at: [x, y], inside: inside > 0 })
        .collect();
    Prompt {
        frame: number(entry, "frame"),
        object: number(entry, "object") as u8,
        clicks,
        within: places("box").try_into().ok(),
        spread: spread(entry),
    }
}
