//! Annotations of a clip, read from the classes of the package: masks, corrections, prompts and accepted frames.

use std::collections::BTreeMap;

use pyo3::prelude::*;
use veronese::MAX_SIDE;
use veronese::clip::{Accepted, Annotations, Click, Painted, Prompt, Spread};

use crate::errors::Failure;
use crate::frames::label_image;
use crate::options::{invalid, whole};
use crate::results::class;

/// The values of the options of these names.
#[derive(Default)]
pub(crate) struct Given<'a, 'py> {
    pub(crate) masks: Option<&'a Bound<'py, PyAny>>,
    pub(crate) corrections: Option<&'a Bound<'py, PyAny>>,
    pub(crate) prompts: Option<&'a Bound<'py, PyAny>>,
    pub(crate) locked: Option<&'a Bound<'py, PyAny>>,
    pub(crate) named: Option<&'a Bound<'py, PyAny>>,
    pub(crate) accepted: Option<&'a Bound<'py, PyAny>>,
}

/// Annotations that are given together.
#[derive(Default)]
pub(crate) struct FrameAnnotations {
    pub(crate) annotations: Annotations,
    /// For each image of labels: the option, the frame, width and height.
    images: Vec<(&'static str, usize, [usize; 2])>,
}

/// The label of a pixel that is not annotated.
const NOTHING: u8 = u8::MAX;

/// Something with the frames to which it spreads, if these are given.
type Spreading<T> = (T, Option<Spread>);

/// Reads the entries one after another.
#[derive(Default)]
struct Reader {
    /// Number of frames.
    length: usize,
    masks: Vec<Spreading<Painted>>,
    corrections: Vec<Spreading<Painted>>,
    prompts: Vec<Spreading<Prompt>>,
    images: Vec<(&'static str, usize, [usize; 2])>,
}

impl FrameAnnotations {
    /// Checks everything that does not need the size of the frames.
    pub(crate) fn of(given: &Given<'_, '_>, length: usize) -> PyResult<FrameAnnotations> {
        let mut reader = Reader { length, ..Reader::default() };
        if let Some(masks) = given.masks {
            reader.read("masks", &["Mask"], masks)?;
        }
        if let Some(corrections) = given.corrections {
            reader.read("corrections", &["Correction", "Prompt"], corrections)?;
        }
        if let Some(prompts) = given.prompts {
            reader.read("prompts", &["Prompt"], prompts)?;
        }
        let accepted = given.accepted.map(|accepted| reader.accepted(accepted)).transpose()?;
        let locked = given.locked.map(|locked| objects("locked", locked)).transpose()?;
        let named = given.named.map(|named| objects("named", named)).transpose()?;
        Ok(reader.finished(Annotations { locked, named, accepted, ..Annotations::default() }))
    }

    /// Checks that labels fill frames of this size, and that prompts lie within them.
    pub(crate) fn check(&self, [width, height]: [usize; 2]) -> Result<(), Failure> {
        if let Some((option, frame, [w, h])) = self.images.iter().find(|(.., size)| *size != [width, height]) {
            let reason = format!("that of frame {frame} has {w}×{h} pixels, a frame has {width}×{height}");
            return Err(Failure::option(option, &reason));
        }
        let is_within = |Prompt { clicks, within, .. }: &Prompt| {
            clicks.iter().all(|Click { at: [x, y], .. }| *x < width && *y < height)
                && within.is_none_or(|[x, y, columns, rows]| x + columns <= width && y + rows <= height)
        };
        match self.annotations.prompts.iter().find(|prompt| !is_within(prompt)) {
            None => Ok(()),
            Some(Prompt { object, frame, .. }) => {
                let what = format!("what points to object {object} in frame {frame}");
                Err(Failure::option("prompts", &format!("{what} is not within {width}×{height} pixels")))
            }
        }
    }

    /// The annotations of the first frames alone.
    pub(crate) fn of_first(self, frames: usize) -> Annotations {
        let Annotations { mut masks, mut corrections, mut prompts, mut accepted, .. } = self.annotations;
        masks.retain(|mask| mask.frame < frames);
        corrections.retain(|correction| correction.frame < frames);
        prompts.retain(|prompt| prompt.frame < frames);
        if let Some(accepted) = &mut accepted {
            accepted.retain(|accepted| accepted.frame < frames);
        }
        Annotations { masks, corrections, prompts, accepted, ..self.annotations }
    }
}

impl Reader {
    fn read(&mut self, option: &'static str, forms: &[&str], given: &Bound<'_, PyAny>) -> PyResult<()> {
        let iterator =
            given.try_iter().map_err(|_| invalid(option, &format!("a sequence of {}", forms.join(" or ")), given))?;
        for (at, entry) in iterator.enumerate() {
            self.entry(option, forms, &format!("number {at} "), &entry?)?;
        }
        Ok(())
    }

    /// `place` says which of several entries it is.
    fn entry(&mut self, option: &'static str, forms: &[&str], place: &str, entry: &Bound<'_, PyAny>) -> PyResult<()> {
        let mut form = None;
        for name in forms {
            if entry.is_instance(&class(entry.py(), name)?)? {
                form = Some(*name);
            }
        }
        let wrong = |reason: &str| Failure::option(option, &format!("{place}{reason}"));
        let Some(form) = form else { return Err(wrong(&format!("is no {}", forms.join(" or "))).into()) };
        let frame = self.frame(option, place, &entry.getattr("frame")?)?;
        let spread = spread_of(&entry.getattr("propagate")?, &wrong)?;
        if form == "Prompt" {
            let prompt = prompt(entry, frame, &wrong)?;
            if self.prompts.iter().any(|(other, _)| (other.frame, other.object) == (frame, prompt.object)) {
                let reason = format!("points to object {} in frame {frame}, as one before does", prompt.object);
                return Err(wrong(&reason).into());
            }
            self.prompts.push((prompt, spread));
            return Ok(());
        }
        let about =
            if form == "Correction" { entry.getattr("object")? } else { entry.py().None().into_bound(entry.py()) };
        let object = match about.is_none() {
            true => None,
            false => Some(object(&about).ok_or_else(|| wrong("must have an object, a number from 1 to 254, or None"))?),
        };
        let labels = self.labels(option, place, frame, entry)?;
        if let Some(object) = object
            && labels.iter().any(|label| ![0, object, NOTHING].contains(label))
        {
            return Err(wrong(&format!("is about object {object} alone: its labels are 0, {object} and 255")).into());
        }
        let list = if form == "Mask" { &mut self.masks } else { &mut self.corrections };
        if list.iter().any(|(other, _)| (other.frame, other.object) == (frame, object)) {
            let what = object.map_or(String::new(), |object| format!("object {object} in "));
            return Err(wrong(&format!("is of {what}frame {frame}, as one before is")).into());
        }
        list.push((Painted { frame, object, labels, spread: Spread::Both }, spread));
        Ok(())
    }

    fn accepted(&mut self, given: &Bound<'_, PyAny>) -> PyResult<Vec<Accepted>> {
        let option = "accepted";
        let mut accepted: Vec<Accepted> = Vec::new();
        let iterator = given.try_iter().map_err(|_| invalid(option, "a sequence of frames or Accepted", given))?;
        for (at, entry) in iterator.enumerate() {
            let (entry, place) = (entry?, format!("number {at} "));
            let has_labels = entry.is_instance(&class(entry.py(), "Accepted")?)?;
            let frame = if has_labels { entry.getattr("frame")? } else { entry.clone() };
            let frame = self.frame(option, &place, &frame)?;
            let labels = if has_labels { Some(self.labels(option, &place, frame, &entry)?) } else { None };
            if accepted.iter().any(|other| other.frame == frame) {
                return Err(Failure::option(option, &format!("{place}is frame {frame}, as one before is")).into());
            }
            accepted.push(Accepted { frame, labels });
        }
        Ok(accepted)
    }

    fn frame(&self, option: &str, place: &str, given: &Bound<'_, PyAny>) -> Result<usize, Failure> {
        let frame = whole(given).filter(|&frame| frame < self.length);
        let reason = || match self.length {
            0 => format!("{place}is of a frame, and there is none"),
            _ => format!("{place}must have a frame from 0 to {}", self.length - 1),
        };
        frame.ok_or_else(|| Failure::option(option, &reason()))
    }

    fn labels(
        &mut self,
        option: &'static str,
        place: &str,
        frame: usize,
        entry: &Bound<'_, PyAny>,
    ) -> PyResult<Vec<u8>> {
        let (labels, size) = label_image(&entry.getattr("labels")?)
            .map_err(|failure| Failure::option(option, &format!("{place}has other labels: {}", failure.message)))?;
        self.images.push((option, frame, size));
        Ok(labels)
    }

    /// The annotations. Those without a direction of their own spread as the label map of their frame.
    fn finished(self, rest: Annotations) -> FrameAnnotations {
        let maps = self.masks.iter().chain(&self.corrections).filter(|(painted, _)| painted.object.is_none());
        let ways: BTreeMap<usize, Spread> = maps.filter_map(|(map, spread)| Some((map.frame, (*spread)?))).collect();
        let of_frame = |frame: usize| ways.get(&frame).copied().unwrap_or_default();
        let painted = |list: Vec<Spreading<Painted>>| -> Vec<Painted> {
            let spreads = list.into_iter();
            spreads.map(|(of, spread)| Painted { spread: spread.unwrap_or_else(|| of_frame(of.frame)), ..of }).collect()
        };
        let prompts = self.prompts.into_iter();
        let prompts =
            prompts.map(|(of, spread)| Prompt { spread: spread.unwrap_or_else(|| of_frame(of.frame)), ..of }).collect();
        let (masks, corrections) = (painted(self.masks), painted(self.corrections));
        FrameAnnotations { annotations: Annotations { masks, corrections, prompts, ..rest }, images: self.images }
    }
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

fn prompt(entry: &Bound<'_, PyAny>, frame: usize, wrong: &dyn Fn(&str) -> Failure) -> PyResult<Prompt> {
    let object =
        object(&entry.getattr("object")?).ok_or_else(|| wrong("must have an object, a number from 1 to 254"))?;
    let within = match given(entry, "box")? {
        None => None,
        Some(sides) => match places(&sides).as_deref() {
            Some(&[x, y, width, height]) if width > 0 && height > 0 => Some([x, y, width, height]),
            _ => return Err(wrong("must have a box, the whole numbers (x, y, width, height)").into()),
        },
    };
    let mut clicks = Vec::new();
    if let Some(place) = given(entry, "click")? {
        match places(&place).as_deref() {
            Some(&[x, y]) => clicks.push(Click { at: [x, y], inside: true }),
            _ => return Err(wrong("must have a click, the whole numbers (x, y)").into()),
        }
    }
    let form = || {
        wrong(
            "must have clicks, a sequence of (x, y, 1) for what belongs to the object and (x, y, -1) for what does not",
        )
    };
    for each in entry.getattr("clicks")?.try_iter().map_err(|_| form())? {
        let (x, y, sign): (Bound<'_, PyAny>, Bound<'_, PyAny>, i32) = each?.extract().map_err(|_| form())?;
        match (place(&x), place(&y), sign) {
            (Some(x), Some(y), 1 | -1) => clicks.push(Click { at: [x, y], inside: sign == 1 }),
            _ => return Err(form().into()),
        }
    }
    let inside = || clicks.iter().filter(|click| click.inside);
    if within.is_none() && !clicks.is_empty() && inside().next().is_none() {
        return Err(wrong(&format!("must have a box or a click that belongs to object {object}")).into());
    }
    if let Some([left, top, width, height]) = within
        && let Some(Click { at: [x, y], .. }) = inside()
            .find(|Click { at: [x, y], .. }| !(left..left + width).contains(x) || !(top..top + height).contains(y))
    {
        let reason = format!("has a click at {x}, {y} that belongs to object {object} and is not in its box");
        return Err(wrong(&reason).into());
    }
    Ok(Prompt { frame, object, clicks, within, spread: Spread::Both })
}

/// The value of a field, unless it is `None`.
fn given<'py>(entry: &Bound<'py, PyAny>, name: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
    Ok(Some(entry.getattr(name)?).filter(|value| !value.is_none()))
}

fn places(given: &Bound<'_, PyAny>) -> Option<Vec<usize>> {
    given.try_iter().ok()?.map(|side| place(&side.ok()?)).collect()
}

fn place(given: &Bound<'_, PyAny>) -> Option<usize> {
    whole(given).filter(|&place| place <= MAX_SIDE)
}

fn spread_of(given: &Bound<'_, PyAny>, wrong: &dyn Fn(&str) -> Failure) -> PyResult<Option<Spread>> {
    if given.is_none() {
        return Ok(None);
    }
    let spread = match given.extract::<String>().as_deref() {
        Ok("both") => Spread::Both,
        Ok("forward") => Spread::Forward,
        Ok("backward") => Spread::Backward,
        Ok("none") => Spread::None,
        _ => return Err(wrong("must propagate 'both', 'forward', 'backward' or 'none'").into()),
    };
    Ok(Some(spread))
}
