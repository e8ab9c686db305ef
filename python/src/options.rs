//! Options as Python has them.

use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFloat};
use veronese::clip::MAX_LOOK_AHEAD;
use veronese::{MAX_MOTIONS, Method, MotionCount, Quality, SegmentOptions};

use crate::errors::Failure;

pub(crate) fn motions(given: &Bound<'_, PyAny>) -> Result<MotionCount, Failure> {
    match (text(given).as_deref(), whole(given)) {
        (Some("auto"), _) => Ok(MotionCount::Auto),
        (_, Some(count)) if (1..=MAX_MOTIONS).contains(&count) => Ok(MotionCount::Given(count)),
        _ => Err(invalid("motions", &format!("'auto' or a whole number from 1 to {MAX_MOTIONS}"), given)),
    }
}

pub(crate) fn quality(given: &Bound<'_, PyAny>) -> Result<Quality, Failure> {
    choice("quality", given, [("fast", Quality::Fast), ("best", Quality::Best)])
}

pub(crate) fn method(given: &Bound<'_, PyAny>) -> Result<Method, Failure> {
    choice("method", given, [("paper", Method::Paper), ("best", Method::Best)])
}

pub(crate) fn seed(given: &Bound<'_, PyAny>) -> Result<u64, Failure> {
    let seed = whole(given).and_then(|seed| u64::try_from(seed).ok()).filter(|&seed| seed <= MAX_SEED);
    seed.ok_or_else(|| invalid("seed", &format!("a whole number from 0 to {MAX_SEED}"), given))
}

/// 2⁵³ − 1, the largest that JavaScript has.
const MAX_SEED: u64 = (1 << 53) - 1;

/// Options of each pair of a clip.
pub(crate) fn pair(
    motions: Option<&Bound<'_, PyAny>>,
    quality: Option<&Bound<'_, PyAny>>,
    subject: bool,
) -> Result<SegmentOptions, Failure> {
    let mut options = SegmentOptions::default().with_subject(subject);
    if let Some(motions) = motions {
        options = options.with_motions(self::motions(motions)?);
    }
    quality.map_or(Ok(options), |quality| Ok(options.with_quality(self::quality(quality)?)))
}

pub(crate) fn look_ahead(given: &Bound<'_, PyAny>) -> Result<usize, Failure> {
    let frames = whole(given).filter(|&frames| frames <= MAX_LOOK_AHEAD);
    frames.ok_or_else(|| invalid("look_ahead", &format!("a whole number from 0 to {MAX_LOOK_AHEAD}"), given))
}

/// An index, of a frame for instance.
pub(crate) fn index(name: &str, given: &Bound<'_, PyAny>) -> Result<usize, Failure> {
    whole(given).ok_or_else(|| invalid(name, "a whole number from 0 on", given))
}

/// The number of an object.
pub(crate) fn object(name: &str, given: &Bound<'_, PyAny>) -> Result<u8, Failure> {
    let number =
        whole(given).and_then(|number| u8::try_from(number).ok()).filter(|number| (1..u8::MAX).contains(number));
    number.ok_or_else(|| invalid(name, "the number of an object, from 1 to 254", given))
}

/// Several values of an option.
pub(crate) fn all<T>(
    name: &str,
    given: &Bound<'_, PyAny>,
    one: impl Fn(&str, &Bound<'_, PyAny>) -> Result<T, Failure>,
) -> PyResult<Vec<T>> {
    let values = given.try_iter().map_err(|_| invalid(name, "a sequence", given))?;
    values.map(|value| Ok(one(name, &value?)?)).collect()
}

fn choice<T: Copy>(name: &str, given: &Bound<'_, PyAny>, choices: [(&str, T); 2]) -> Result<T, Failure> {
    let word = text(given);
    let [(one, _), (other, _)] = choices;
    match choices.iter().find(|(choice, _)| word.as_deref() == Some(*choice)) {
        Some(&(_, choice)) => Ok(choice),
        None => Err(invalid(name, &format!("'{one}' or '{other}'"), given)),
    }
}

fn text(given: &Bound<'_, PyAny>) -> Option<String> {
    given.extract().ok()
}

/// A whole number from 0; True and False are none.
pub(crate) fn whole(given: &Bound<'_, PyAny>) -> Option<usize> {
    if given.is_instance_of::<PyBool>() || given.is_instance_of::<PyFloat>() { None } else { given.extract().ok() }
}

pub(crate) fn invalid(name: &str, wanted: &str, found: &Bound<'_, PyAny>) -> Failure {
    let found = found.repr().map_or_else(|_| "something else".into(), |text| text.to_string());
    let found = if found.chars().count() <= 60 { found } else { "something else".into() };
    Failure::option(name, &format!("must be {wanted}, not {found}"))
}
