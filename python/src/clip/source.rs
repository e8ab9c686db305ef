//! Where the frames of a clip come from.

use std::cmp::Ordering;
use std::fs;
use std::path::PathBuf;

use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyIterator};
use veronese::Frame;

use crate::errors::Failure;
use crate::frames::{Given, given};

/// The ends of the names of images.
const IMAGES: [&str; 9] = ["png", "jpg", "jpeg", "webp", "bmp", "pbm", "pgm", "pnm", "ppm"];

pub(crate) enum Source {
    /// Frames that come once.
    Iterator(Py<PyIterator>),
    /// Frames that can be read again, and their number.
    Sequence(Py<PyAny>, usize),
    Files(Vec<PathBuf>),
}

impl Default for Source {
    /// Without frames.
    fn default() -> Source {
        Source::Files(Vec::new())
    }
}

impl Source {
    /// A folder, a sequence, or anything that can be iterated over.
    pub(crate) fn of(frames: &Bound<'_, PyAny>) -> PyResult<Source> {
        if let Ok(folder) = frames.extract::<PathBuf>() {
            return Ok(Source::Files(images(&folder)?));
        }
        let is_sequence = frames.hasattr("__getitem__")? && frames.hasattr("__len__")?;
        if is_sequence && !frames.is_instance_of::<PyDict>() {
            return Ok(Source::Sequence(frames.clone().unbind(), frames.len()?));
        }
        let iterator = frames.try_iter().map_err(|_| {
            Failure::input(
                "the frames must be a sequence or an iterator of arrays or paths, or the path of a folder".into(),
            )
        })?;
        Ok(Source::Iterator(iterator.unbind()))
    }

    /// Shows what it refers to to the garbage collector.
    pub(crate) fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        match self {
            Source::Iterator(frames) => visit.call(frames),
            Source::Sequence(frames, _) => visit.call(frames),
            Source::Files(_) => Ok(()),
        }
    }

    /// The number of frames, if they can be read again.
    pub(crate) fn length(&self) -> Option<usize> {
        match self {
            Source::Iterator(_) => None,
            Source::Sequence(_, length) => Some(*length),
            Source::Files(paths) => Some(paths.len()),
        }
    }

    /// A frame; of an iterator it is the next one. `None` at the end.
    pub(crate) fn frame(&self, py: Python<'_>, index: usize) -> PyResult<Option<Frame>> {
        let name = format!("frame {index}");
        let frame = match self {
            Source::Files(paths) => paths.get(index).cloned().map(Given::File),
            Source::Sequence(_, length) if index >= *length => None,
            Source::Sequence(frames, _) => Some(given(&name, &frames.bind(py).get_item(index)?)?),
            Source::Iterator(frames) => {
                let next = frames.bind(py).clone().next().transpose()?;
                next.map(|frame| given(&name, &frame)).transpose()?
            }
        };
        let Some(frame) = frame else { return Ok(None) };
        Ok(Some(py.detach(|| frame.frame()).map_err(|failure| failure.about(&name))?))
    }
}

/// The images in a folder, by name, numbers by their value: the order of the command line.
fn images(folder: &PathBuf) -> Result<Vec<PathBuf>, Failure> {
    let name = folder.display();
    let failed = |error: std::io::Error| Failure {
        code: if error.kind() == std::io::ErrorKind::NotFound { "file-not-found" } else { "unreadable-file" },
        message: format!("the folder '{name}' cannot be read: {error}"),
    };
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let name = entry.map_err(failed)?.file_name().to_string_lossy().into_owned();
        let end = name.rsplit_once('.').map(|(_, end)| end.to_ascii_lowercase());
        if !name.starts_with('.') && end.is_some_and(|end| IMAGES.contains(&end.as_str())) {
            names.push(name);
        }
    }
    if names.is_empty() {
        return Err(Failure { code: "file-not-found", message: format!("there is no image in the folder '{name}'") });
    }
    names.sort_by(|one, other| by_numbers(one, other));
    Ok(names.iter().map(|name| folder.join(name)).collect())
}

fn by_numbers(one: &str, other: &str) -> Ordering {
    sort_key(one).cmp(&sort_key(other)).then_with(|| one.cmp(other))
}

/// The name with each number preceded by how many digits it has.
fn sort_key(name: &str) -> String {
    let mut key = String::new();
    let mut rest = name;
    while let Some(next) = rest.chars().next() {
        let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let (piece, after) = rest.split_at(if digits > 0 { digits } else { next.len_utf8() });
        if digits > 0 {
            let value = match piece.trim_start_matches('0') {
                "" => "0",
                value => value,
            };
            key.push_str(&format!("{:03}{value}", value.len()));
        } else {
            key.push_str(piece);
        }
        rest = after;
    }
    key
}
