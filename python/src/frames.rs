//! Frames as they are given: arrays, what NumPy makes an array of, or files; and label images.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use numpy::{Element, PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyMemoryView;
use veronese::codecs::decode_image;
use veronese::{Error, Frame, MAX_SIDE, MIN_SIDE};

use crate::errors::Failure;

/// Largest file, bytes: more than the largest frame needs in the most wasteful of the formats.
const LARGEST: u64 = 512 * 1024 * 1024;

/// A frame that no longer needs the interpreter.
pub(crate) enum Given {
    Pixels {
        width: usize,
        height: usize,
        rgba: Vec<u8>,
    },
    File(PathBuf),
    /// The content of a file.
    Bytes(Vec<u8>),
}

/// Modes of Pillow whose arrays are grey, RGB or RGBA, and others that Pillow converts without a loss of what is seen.
const MODES: [&str; 3] = ["L", "RGB", "RGBA"];
const OPAQUE: [&str; 7] = ["1", "P", "RGBX", "CMYK", "YCbCr", "LAB", "HSV"];
const WITH_ALPHA: [&str; 4] = ["LA", "La", "PA", "RGBa"];

/// A frame from an array, an object with the protocols of one, a path, or the bytes of a file. The size is checked before pixels are
/// copied.
pub(crate) fn given(which: &str, frame: &Bound<'_, PyAny>) -> Result<Given, Failure> {
    if !frame.is_instance_of::<PyUntypedArray>() {
        if let Ok(path) = frame.extract::<PathBuf>() {
            return Ok(Given::File(path));
        }
        let failed = |error: PyErr| Failure::input(format!("{which} cannot be taken as an array: {error}"));
        let bytes = PyMemoryView::from(frame).ok();
        if let Some(bytes) = bytes.as_ref().and_then(|bytes| content_of(bytes).transpose()) {
            return bytes.map(Given::Bytes).map_err(failed);
        }
        let has = |name| frame.hasattr(name).unwrap_or(false);
        if bytes.is_none() && !has("__array__") && !has("__array_interface__") {
            let sentence =
                format!("{which} must be an array of pixels, a picture, a path, or the bytes of an image file");
            return Err(Failure::input(sentence));
        }
        let colours = in_colours(which, frame)?;
        let numpy = frame.py().import("numpy").map_err(failed)?;
        return pixels(which, &numpy.call_method1("asarray", (colours,)).map_err(failed)?);
    }
    pixels(which, frame)
}

/// The bytes of a buffer that is one row of them, as that of `bytes`.
fn content_of(buffer: &Bound<'_, PyMemoryView>) -> PyResult<Option<Vec<u8>>> {
    let (dimensions, size): (usize, usize) =
        (buffer.getattr("ndim")?.extract()?, buffer.getattr("itemsize")?.extract()?);
    if (dimensions, size) != (1, 1) { Ok(None) } else { buffer.call_method0("tobytes")?.extract().map(Some) }
}

/// A picture of Pillow as one whose array has its colours, not the indices of a palette. Anything else is returned as it is.
fn in_colours<'py>(which: &str, frame: &Bound<'py, PyAny>) -> Result<Bound<'py, PyAny>, Failure> {
    let mode = frame.getattr("mode").and_then(|mode| mode.extract::<String>());
    let Ok(mode) = mode else { return Ok(frame.clone()) };
    if !frame.hasattr("convert").unwrap_or(false) || MODES.contains(&mode.as_str()) {
        return Ok(frame.clone());
    }
    let transparent = || frame.getattr("info").and_then(|info| info.contains("transparency")).unwrap_or(false);
    let wanted = match mode.as_str() {
        mode if WITH_ALPHA.contains(&mode) => "RGBA",
        mode if OPAQUE.contains(&mode) => {
            if transparent() {
                "RGBA"
            } else {
                "RGB"
            }
        }
        _ => return Err(Failure::input(format!("{which} is a picture of mode '{mode}': convert it to 'L' or 'RGB'"))),
    };
    let failed = |error: PyErr| Failure::input(format!("{which} cannot be converted to {wanted}: {error}"));
    frame.call_method1("convert", (wanted,)).map_err(failed)
}

fn pixels(which: &str, frame: &Bound<'_, PyAny>) -> Result<Given, Failure> {
    let pixels = || {
        let forms = "(height, width), (height, width, 3) or (height, width, 4)";
        Failure::input(format!("{which} must be an array of uint8 of shape {forms}: grey, RGB or RGBA"))
    };
    let array = frame.cast::<PyArrayDyn<u8>>().map_err(|_| pixels())?;
    let (height, width, channels) = match *array.shape() {
        [height, width] => (height, width, 1),
        [height, width, channels @ (1 | 3 | 4)] => (height, width, channels),
        [channels @ (1 | 3 | 4), _, width] if width > 4 => {
            let sentence =
                format!("{which} has its {channels} colours first: give it with them last, as permute(1, 2, 0) does");
            return Err(Failure::input(sentence));
        }
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
fn values<T: Element + Copy>(which: &str, array: &Bound<'_, PyArrayDyn<T>>) -> Result<Vec<T>, Failure> {
    let array = array.try_readonly().map_err(|_| Failure::input(format!("{which} is being written to")))?;
    let view = array.as_array();
    // The array's own slice may be one of columns.
    Ok(view.as_slice().map_or_else(|| view.iter().copied().collect(), <[T]>::to_vec))
}

/// The labels of an image, row by row, with its width and height. Of an array of bools, True is 1 and False is what is given for it.
pub(crate) fn label_image(given: &Bound<'_, PyAny>, no: Option<u8>) -> Result<(Vec<u8>, [usize; 2]), Failure> {
    let name = "an image of labels";
    let kinds = if no.is_some() { "uint8 or bool" } else { "uint8" };
    let form = || Failure::input(format!("must be an array of {kinds} of shape (height, width)"));
    let bools = no.and_then(|no| given.cast::<PyArrayDyn<bool>>().ok().map(|array| (no, array)));
    let (labels, shape) = match bools {
        Some((no, array)) => {
            let labels = values(name, array)?.into_iter().map(|is_set| if is_set { 1 } else { no });
            (labels.collect(), array.shape())
        }
        None => {
            let array = given.cast::<PyArrayDyn<u8>>().map_err(|_| form())?;
            (values(name, array)?, array.shape())
        }
    };
    let [height, width] = *shape else { return Err(form()) };
    Ok((labels, [width, height]))
}

impl Given {
    /// The frame itself; files are read and decoded.
    pub(crate) fn frame(self) -> Result<Frame, Failure> {
        match self {
            Given::Pixels { width, height, rgba } => Ok(Frame::from_rgba(width, height, rgba)?),
            Given::File(path) => {
                decoded(&content(&path)?).map_err(|error| error.about(&format!("'{}'", path.display())))
            }
            Given::Bytes(bytes) => decoded(&bytes),
        }
    }
}

fn decoded(bytes: &[u8]) -> Result<Frame, Failure> {
    let picture = decode_image(bytes)?;
    Ok(Frame::from_rgba(picture.width, picture.height, picture.rgba)?)
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
