//! What a person says of frames: masks, corrections, and what points to an object.

use pyo3::prelude::*;
use veronese::MAX_SIDE;
use veronese::clip::{Prompt, Spread};

use crate::errors::Failure;
use crate::frames::image;
use crate::options::{invalid, whole};
use crate::results::class;

/// What is said of a frame: 255 where nothing is.
pub(crate) struct Said {
    pub(crate) frame: usize,
    pub(crate) labels: Vec<u8>,
    /// Width and height.
    pub(crate) size: [usize; 2],
    pub(crate) spread: Option<Spread>,
}

/// What points to an object in a frame.
pub(crate) struct Pointed {
    pub(crate) frame: usize,
    pub(crate) object: u8,
    pub(crate) prompt: Prompt,
    pub(crate) spread: Option<Spread>,
}

/// One thing that is said.
pub(crate) enum Word {
    Labels(Said),
    Prompt(Pointed),
}

/// The label of a pixel of which nothing is said.
const NOTHING: u8 = u8::MAX;

/// Masks: one for a frame at most.
pub(crate) fn masks(given: &Bound<'_, PyAny>, length: usize) -> PyResult<Vec<Said>> {
    let mut masks: Vec<Said> = Vec::new();
    for (at, entry) in entries("masks", "Mask", given)?.iter().enumerate() {
        let place = format!("number {at} ");
        if !entry.is_instance(&class(given.py(), "Mask")?)? {
            return Err(Failure::option("masks", &format!("{place}is no Mask")).into());
        }
        let mask = labels("masks", &place, entry, length)?;
        check_first(masks.iter().any(|other| other.frame == mask.frame), "masks", &place, mask.frame)?;
        masks.push(mask);
    }
    Ok(masks)
}

/// Corrections and prompts. A frame has one correction at most; prompts come by frame, then by object: in which order they are given makes no
/// difference.
pub(crate) fn corrections(given: &Bound<'_, PyAny>, length: usize) -> PyResult<(Vec<Said>, Vec<Pointed>)> {
    let (mut corrections, mut prompts): (Vec<Said>, Vec<Pointed>) = Default::default();
    for (at, entry) in entries("corrections", "Correction or Prompt", given)?.iter().enumerate() {
        let place = format!("number {at} ");
        match word(&place, entry, length)? {
            Word::Labels(said) => {
                let again = corrections.iter().any(|other| other.frame == said.frame);
                check_first(again, "corrections", &place, said.frame)?;
                corrections.push(said);
            }
            Word::Prompt(pointed) => {
                let Pointed { frame, object, .. } = pointed;
                if prompts.iter().any(|other| (other.frame, other.object) == (frame, object)) {
                    let reason = format!("{place}points to object {object} in frame {frame}, as one before does");
                    return Err(Failure::option("corrections", &reason).into());
                }
                prompts.push(pointed);
            }
        }
    }
    prompts.sort_by_key(|prompt| (prompt.frame, prompt.object));
    Ok((corrections, prompts))
}

/// A correction or a prompt. `place`: which of several it is.
pub(crate) fn word(place: &str, entry: &Bound<'_, PyAny>, length: usize) -> PyResult<Word> {
    if entry.is_instance(&class(entry.py(), "Correction")?)? {
        return labels("corrections", place, entry, length).map(Word::Labels);
    }
    if entry.is_instance(&class(entry.py(), "Prompt")?)? {
        return pointed(place, entry, length).map(Word::Prompt);
    }
    Err(Failure::option("corrections", &format!("{place}is neither Correction nor Prompt")).into())
}

/// Numbers of objects.
pub(crate) fn objects(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Vec<u8>> {
    let iterator = given.try_iter();
    let wrong = || Failure::option(name, "must be numbers of objects, from 1 to 254");
    let numbers = iterator.map_err(|_| wrong())?.map(|number| Ok(object(&number?).ok_or_else(wrong)?));
    numbers.collect()
}

fn object(given: &Bound<'_, PyAny>) -> Option<u8> {
    whole(given).and_then(|number| u8::try_from(number).ok()).filter(|&number| number != 0 && number != NOTHING)
}

/// What is said of each frame: a correction goes before the mask of its frame where it says anything.
pub(crate) fn together(mut said: Vec<Said>, corrections: Vec<Said>) -> Vec<Said> {
    for mut correction in corrections {
        let Some(mask) = said.iter_mut().find(|mask| mask.frame == correction.frame) else {
            said.push(correction);
            continue;
        };
        for (label, &below) in correction.labels.iter_mut().zip(&mask.labels) {
            if *label == NOTHING {
                *label = below;
            }
        }
        correction.spread = correction.spread.or(mask.spread);
        *mask = correction;
    }
    said
}

/// Labels must fill the frames.
pub(crate) fn check_size(option: &str, said: &Said, [width, height]: [usize; 2]) -> Result<(), Failure> {
    if said.size == [width, height] {
        return Ok(());
    }
    let ([w, h], frame) = (said.size, said.frame);
    Err(Failure::option(option, &format!("that of frame {frame} has {w}×{h} pixels, a frame has {width}×{height}")))
}

/// Prompts must lie within the frames.
pub(crate) fn check_within(prompt: &Pointed, [width, height]: [usize; 2]) -> Result<(), Failure> {
    let [right, bottom] = match prompt.prompt {
        Prompt::Click([x, y]) => [x + 1, y + 1],
        Prompt::Box([x, y, columns, rows]) => [x + columns, y + rows],
    };
    if right <= width && bottom <= height {
        return Ok(());
    }
    let Pointed { frame, object, .. } = prompt;
    let reason = format!("what points to object {object} in frame {frame} is not within {width}×{height} pixels");
    Err(Failure::option("corrections", &reason))
}

fn entries<'py>(option: &str, form: &str, given: &Bound<'py, PyAny>) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let iterator = given.try_iter().map_err(|_| invalid(option, &format!("a sequence of {form}"), given))?;
    iterator.collect()
}

fn check_first(again: bool, option: &str, place: &str, frame: usize) -> Result<(), Failure> {
    if again { Err(Failure::option(option, &format!("{place}is of frame {frame}, as one before is"))) } else { Ok(()) }
}

fn labels(option: &str, place: &str, entry: &Bound<'_, PyAny>, length: usize) -> PyResult<Said> {
    let (frame, spread) = (frame_of(option, place, entry, length)?, spread_of(option, place, entry)?);
    let (labels, size) = image::<u8>("the labels", "uint8", &entry.getattr("labels")?)
        .map_err(|failure| Failure::option(option, &format!("{place}has other labels: {}", failure.message)))?;
    Ok(Said { frame, labels, size, spread })
}

fn pointed(place: &str, entry: &Bound<'_, PyAny>, length: usize) -> PyResult<Pointed> {
    let wrong = |reason: &str| Failure::option("corrections", &format!("{place}{reason}"));
    let frame = frame_of("corrections", place, entry, length)?;
    let spread = spread_of("corrections", place, entry)?;
    let number = object(&entry.getattr("label")?).ok_or_else(|| wrong("must have a label, a number from 1 to 254"))?;
    let sides = |name: &str| -> PyResult<Option<Vec<usize>>> {
        let given = entry.getattr(name)?;
        if given.is_none() {
            return Ok(None);
        }
        let numbers: Option<Vec<usize>> = match given.try_iter() {
            Ok(sides) => sides.map(|side| side.ok().and_then(|side| whole(&side))).collect(),
            Err(_) => None,
        };
        Ok(Some(numbers.filter(|sides| sides.iter().all(|&side| side <= MAX_SIDE)).unwrap_or_default()))
    };
    let prompt = match (sides("box")?, sides("click")?) {
        (Some(_), Some(_)) => return Err(wrong("must have a box or a click, not both").into()),
        (Some(sides), None) => match sides[..] {
            [x, y, width, height] if width > 0 && height > 0 => Prompt::Box([x, y, width, height]),
            _ => return Err(wrong("must have a box, the whole numbers (x, y, width, height)").into()),
        },
        (None, Some(sides)) => match sides[..] {
            [x, y] => Prompt::Click([x, y]),
            _ => return Err(wrong("must have a click, the whole numbers (x, y)").into()),
        },
        (None, None) => return Err(wrong("must have a box or a click").into()),
    };
    Ok(Pointed { frame, object: number, prompt, spread })
}

fn frame_of(option: &str, place: &str, entry: &Bound<'_, PyAny>, length: usize) -> PyResult<usize> {
    let frame = whole(&entry.getattr("frame")?).filter(|&frame| frame < length);
    let reason = || match length {
        0 => format!("{place}is of a frame, and there is none"),
        _ => format!("{place}must have a frame from 0 to {}", length - 1),
    };
    Ok(frame.ok_or_else(|| Failure::option(option, &reason()))?)
}

fn spread_of(option: &str, place: &str, entry: &Bound<'_, PyAny>) -> PyResult<Option<Spread>> {
    let given = entry.getattr("propagate")?;
    if given.is_none() {
        return Ok(None);
    }
    let spread = match given.extract::<String>().as_deref() {
        Ok("both") => Spread::Both,
        Ok("forward") => Spread::Forward,
        Ok("backward") => Spread::Backward,
        Ok("none") => Spread::None,
        _ => {
            let reason = format!("{place}must propagate 'both', 'forward', 'backward' or 'none'");
            return Err(Failure::option(option, &reason).into());
        }
    };
    Ok(Some(spread))
}
