//! Annotations of frames, read from the classes of the package. What follows from the clip is checked by the clip.

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use veronese::MAX_SIDE;
use veronese::clip::{Annotation, Click, Content, Spread};

use crate::errors::Failure;
use crate::frames::label_image;
use crate::options::{index, invalid, object, whole};
use crate::results::class;

/// The label of a pixel that is left open.
const OPEN: u8 = u8::MAX;

/// The annotations of frames of a size, width and height; 0 if it is not known, since there are no masks to annotate.
pub(crate) fn annotations(given: &Bound<'_, PyTuple>, size: [usize; 2]) -> PyResult<Vec<Annotation>> {
    given.iter().map(|entry| annotation(&entry, size)).collect()
}

fn annotation(entry: &Bound<'_, PyAny>, size: [usize; 2]) -> PyResult<Annotation> {
    let is = |name| entry.is_instance(&class(entry.py(), name)?);
    let number = || Ok::<_, PyErr>(object("object", &entry.getattr("object")?)?);
    let content = if is("Strokes")? {
        Content::Strokes { object: number()?, labels: mask(entry, OPEN, size)? }
    } else if is("Mask")? {
        Content::Mask { object: number()?, labels: mask(entry, 0, size)? }
    } else if is("Labels")? {
        let labels = labels("labels", entry, None, size)?;
        if entry.getattr("own")?.is_truthy()? { Content::Given(labels) } else { Content::Labels(labels) }
    } else if is("Prompt")? {
        let object = number()?;
        Content::Prompt { object, clicks: clicks(entry)?, within: within(entry)? }
    } else {
        return Err(invalid("annotations", "Strokes, Mask, Labels or Prompt", entry).into());
    };
    let frame = index("frame", &entry.getattr("frame")?)?;
    Ok(Annotation { frame, content, spread: spread(&entry.getattr("propagate")?)? })
}

/// The mask of an object.
fn mask(entry: &Bound<'_, PyAny>, no: u8, size: [usize; 2]) -> PyResult<Vec<u8>> {
    let labels = labels("mask", entry, Some(no), size)?;
    match labels.iter().find(|label| ![0, 1, OPEN].contains(label)) {
        None => Ok(labels),
        Some(other) => {
            let reason =
                format!("is 1 where the object is, 0 where it is not and 255 where that is open, never {other}");
            Err(Failure::option("mask", &reason).into())
        }
    }
}

/// The labels in a field, for all pixels of a frame.
fn labels(field: &str, entry: &Bound<'_, PyAny>, no: Option<u8>, size: [usize; 2]) -> PyResult<Vec<u8>> {
    let (labels, found) =
        label_image(&entry.getattr(field)?, no).map_err(|failure| Failure::option(field, &failure.message))?;
    if size != [0, 0] && found != size {
        let ([w, h], [width, height]) = (found, size);
        let reason = format!("it has {w}×{h} pixels, a frame has {width}×{height}");
        return Err(Failure::option(field, &reason).into());
    }
    Ok(labels)
}

fn within(entry: &Bound<'_, PyAny>) -> PyResult<Option<[usize; 4]>> {
    let given = entry.getattr("box")?;
    if given.is_none() {
        return Ok(None);
    }
    let sides = places(&given).and_then(|sides| <[usize; 4]>::try_from(sides).ok());
    Ok(Some(sides.ok_or_else(|| invalid("box", "the whole numbers (x, y, width, height)", &given))?))
}

/// The clicks, that of `click` first.
fn clicks(entry: &Bound<'_, PyAny>) -> PyResult<Vec<Click>> {
    let mut clicks = Vec::new();
    let first = entry.getattr("click")?;
    if !first.is_none() {
        let at = places(&first).and_then(|at| <[usize; 2]>::try_from(at).ok());
        clicks
            .push(Click { at: at.ok_or_else(|| invalid("click", "the whole numbers (x, y)", &first))?, inside: true });
    }
    let given = entry.getattr("clicks")?;
    let form = || {
        let wanted = "a sequence of (x, y, 1) for what belongs to the object and (x, y, -1) for what does not";
        invalid("clicks", wanted, &given)
    };
    for each in given.try_iter().map_err(|_| form())? {
        let (x, y, sign): (Bound<'_, PyAny>, Bound<'_, PyAny>, i32) = each?.extract().map_err(|_| form())?;
        match (place(&x), place(&y), sign) {
            (Some(x), Some(y), 1 | -1) => clicks.push(Click { at: [x, y], inside: sign == 1 }),
            _ => return Err(form().into()),
        }
    }
    Ok(clicks)
}

fn places(given: &Bound<'_, PyAny>) -> Option<Vec<usize>> {
    given.try_iter().ok()?.map(|side| place(&side.ok()?)).collect()
}

fn place(given: &Bound<'_, PyAny>) -> Option<usize> {
    whole(given).filter(|&place| place <= MAX_SIDE)
}

fn spread(given: &Bound<'_, PyAny>) -> Result<Spread, Failure> {
    match given.extract::<String>().as_deref() {
        Ok("both") => Ok(Spread::Both),
        Ok("forward") => Ok(Spread::Forward),
        Ok("backward") => Ok(Spread::Backward),
        Ok("none") => Ok(Spread::None),
        Ok("exact") => Ok(Spread::Exact),
        _ => Err(invalid("propagate", "'both', 'forward', 'backward', 'none' or 'exact'", given)),
    }
}
