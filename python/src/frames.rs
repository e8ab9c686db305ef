//! Frames as they are given, arrays or files, and label images.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use numpy::{Element, PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use veronese::codecs::decode_image;
use veronese::{Error, Frame, MAX_SIDE, MIN_SIDE};

use crate::errors::Failure;

/// Largest file, bytes: more than the largest frame needs in the most wasteful of the formats.
const LARGEST: u64 = 512 * 1024 * 1024;

/// A frame that needs the interpreter no longer.
pub(crate) enum Given {
    Pixels { width: usize, height: usize, rgba: Vec<u8> },
    File(PathBuf),
}

/// A frame from an array or a path. Pixels are copied; the size is checked before.
pub(crate) fn given(which: &str, frame: &Bound<'_, PyAny>) -> Result<Given, Failure> {
    if !frame.is_instance_of::<PyUntypedArray>() {
        let path = frame.extract::<PathBuf>();
        return path
            .map(Given::File)
            .map_err(|_| Failure::input(format!("{which} must be an array of pixels or a path")));
    }
    let pixels = || {
        let forms = "(height, width), (height, width, 3) or (height, width, 4)";
        Failure::input(format!("{which} must be an array of uint8 of shape {forms}: grey, RGB or RGBA"))
    };
    let array = frame.cast::<PyArrayDyn<u8>>().map_err(|_| pixels())?;
    let (height, width, channels) = match *array.shape() {
        [height, width] => (height, width, 1),
        [height, width, channels @ (1 | 3 | 4)] => (height, width, channels),
        _ => return Err(pixels()),
    };
    if ![width, height].iter().all(|side| (MIN_SIDE..=MAX_SIDE).contains(side)) {
        let error = Error::FrameSizeUnsupported { width, height, min: MIN_SIDE, max: MAX_SIDE };
        return Err(Failure::from(error).about(which));
    }
    let bytes = values(which, array)?;
    let rgba = match channels {
        1 => bytes.iter().flat_map(|&grey| [grey, grey, grey, u8::MAX]).collect(),
        3 => bytes.as_chunks::<3>().0.iter().flat_map(|&[r, g, b]| [r, g, b, u8::MAX]).collect(),
        _ => bytes,
    };
    Ok(Given::Pixels { width, height, rgba })
}

/// A copy of the values of an array, row by row.
pub(crate) fn values<T: Element + Copy>(which: &str, array: &Bound<'_, PyArrayDyn<T>>) -> Result<Vec<T>, Failure> {
    let array = array.try_readonly().map_err(|_| Failure::input(format!("{which} is being written to")))?;
    let view = array.as_array();
    // The array's own slice may be one of columns.
    Ok(view.as_slice().map_or_else(|| view.iter().copied().collect(), <[T]>::to_vec))
}

/// The values of an image with one value per pixel, row by row, with its width and height.
pub(crate) fn image<T: Element + Copy>(
    what: &str,
    kind: &str,
    given: &Bound<'_, PyAny>,
) -> Result<(Vec<T>, [usize; 2]), Failure> {
    let shape = || Failure::input(format!("{what} must be an array of {kind} of shape (height, width)"));
    let array = given.cast::<PyArrayDyn<T>>().map_err(|_| shape())?;
    let [height, width] = *array.shape() else { return Err(shape()) };
    Ok((values(what, array)?, [width, height]))
}

impl Given {
    /// The frame itself; files are read and decoded.
    pub(crate) fn frame(self) -> Result<Frame, Failure> {
        match self {
            Given::Pixels { width, height, rgba } => Ok(Frame::from_rgba(width, height, rgba)?),
            Given::File(path) => {
                let decoded = decode_image(&content(&path)?);
                let frame = decoded.and_then(|picture| Frame::from_rgba(picture.width, picture.height, picture.rgba));
                frame.map_err(|error| Failure::from(error).about(&format!("'{}'", path.display())))
            }
        }
    }
}

/// The content of a file. A pipe is not waited for.
fn content(path: &Path) -> Result<Vec<u8>, Failure> {
    let name = path.display();
    let unreadable = |message: String| Failure { code: "unreadable-file", message };
    let failed = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound | ErrorKind::NotADirectory => {
            Failure { code: "file-not-found", message: format!("there is no file '{name}'") }
        }
        _ => unreadable(format!("'{name}' cannot be read: {error}")),
    };
    let status = fs::metadata(path).map_err(failed)?;
    if status.is_dir() {
        return Err(unreadable(format!("'{name}' is a folder")));
    }
    if !status.is_file() {
        return Err(unreadable(format!("'{name}' is a pipe or a device, not a file")));
    }
    if status.len() > LARGEST {
        return Err(unreadable(format!("'{name}' is larger than {} MB", LARGEST / 1024 / 1024)));
    }
    fs::read(path).map_err(failed)
}
