//! Streams: clips whose frames come once.

use std::collections::{BTreeMap, VecDeque};

use pyo3::exceptions::PyException;
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use veronese::AffineMotion;
use veronese::clip::{ClipFrame, ClipObject, ClipOptions, StreamSegmenter};

use crate::clip::report;
use crate::clip::source::Source;
use crate::errors::Failure;
use crate::options;
use crate::results;
use crate::worker::Worker;

/// Begins a stream. Arguments are checked; segmentation begins with the first request.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "they are named in Python")]
pub(crate) fn segment_stream(
    frames: &Bound<'_, PyAny>,
    look_ahead: &Bound<'_, PyAny>,
    motions: &Bound<'_, PyAny>,
    quality: &Bound<'_, PyAny>,
    mark_unknown: bool,
    subject: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<ClipStream> {
    let pair = options::pair(Some(motions), Some(quality), subject)?.with_mark_unknown(mark_unknown);
    let look_ahead = options::look_ahead(look_ahead)?;
    let options = ClipOptions::default().with_pair(pair).with_look_ahead(Some(look_ahead));
    let source = Source::of(frames)?;
    let worker = Worker::start(StreamSegmenter::new(options).map_err(Failure::from)?)?;
    Ok(ClipStream {
        worker: Some(worker),
        source,
        progress,
        size: [0, 0],
        ready: VecDeque::new(),
        next: 0,
        has_ended: false,
        is_live: look_ahead == 0,
        tracks: Tracks::default(),
        failure: None,
    })
}

/// The frames of a stream, in order, as they are finished.
#[pyclass(module = "veronese")]
pub(crate) struct ClipStream {
    /// `None` when the stream is closed.
    worker: Option<Worker<StreamSegmenter>>,
    source: Source,
    progress: Option<Py<PyAny>>,
    /// Width and height of the frames.
    size: [usize; 2],
    ready: VecDeque<ClipFrame>,
    /// The frame that is read next.
    next: usize,
    has_ended: bool,
    /// Whether frames are returned as they come, so that the stream may end at any time.
    is_live: bool,
    tracks: Tracks,
    /// The error of the source, or of a frame; it is raised after the frames before it.
    failure: Option<PyErr>,
}

#[pymethods]
impl ClipStream {
    fn __iter__(stream: PyRef<'_, Self>) -> PyRef<'_, Self> {
        stream
    }

    fn __repr__(&self) -> &str {
        if self.worker.is_some() { "ClipStream()" } else { "ClipStream(closed)" }
    }

    fn __next__<'py>(&mut self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        match self.next_frame(py) {
            Ok(Some(frame)) => {
                self.tracks.add(&frame);
                results::clip_frame(py, frame, self.size).map(Some)
            }
            Ok(None) => self.failure.take().map_or(Ok(None), Err),
            Err(error) => {
                self.close();
                Err(error)
            }
        }
    }

    /// The objects of the frames returned so far.
    fn tracks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.tracks.value(py)
    }

    /// Frees what the stream holds.
    fn close(&mut self) {
        self.worker = None;
    }

    fn __enter__(stream: PyRef<'_, Self>) -> PyRef<'_, Self> {
        stream
    }

    #[pyo3(signature = (*_exception))]
    fn __exit__(&mut self, _exception: &Bound<'_, PyTuple>) {
        self.close();
    }

    // The source or the listener may refer back to the stream.
    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.source.traverse(&visit)?;
        visit.call(&self.progress)
    }

    fn __clear__(&mut self) {
        self.source = Source::default();
        self.progress = None;
    }
}

impl ClipStream {
    fn next_frame(&mut self, py: Python<'_>) -> PyResult<Option<ClipFrame>> {
        let Some(worker) = &self.worker else { return Ok(None) };
        while self.ready.is_empty() && !self.has_ended {
            let index = self.next;
            let frame = match self.source.frame(py, index) {
                // Exceptions that end the program, such as KeyboardInterrupt, are raised at once.
                Err(error) if error.is_instance_of::<PyException>(py) => {
                    self.failure = Some(error);
                    None
                }
                frame => frame?,
            };
            if let Some(frame) = frame {
                report(self.progress.as_ref().map(|progress| progress.bind(py)), "pairs", index, self.source.length())?;
                let size = [frame.width(), frame.height()];
                match worker.call(py, |stream| Ok(stream.push(frame)))? {
                    Ok(done) => {
                        (self.size, self.next) = (size, index + 1);
                        self.ready.extend(done);
                        continue;
                    }
                    Err(error) => self.failure = Some(Failure::from(error).about(&format!("frame {index}")).into()),
                }
            }
            if self.failure.is_none() && !self.is_live && index < 2 {
                return Err(too_few(index).into());
            }
            self.has_ended = true;
            let (rest, dropped) = worker.call(py, |stream| Ok((stream.finish(), stream.dropped())))?;
            self.ready.extend(rest);
            self.tracks.dropped = dropped;
        }
        let next = self.ready.pop_front();
        if next.is_none() {
            self.tracks.end();
        }
        Ok(next)
    }
}

/// A clip of fewer than two frames.
pub(crate) fn too_few(frames: usize) -> Failure {
    let message = format!("a clip needs two frames, found {}", if frames == 0 { "none" } else { "one" });
    Failure { code: "too-few-frames", message }
}

/// The objects and the background of each frame that was returned.
#[derive(Default)]
struct Tracks {
    frames: Vec<(usize, Vec<ClipObject>, Option<AffineMotion>)>,
    dropped: usize,
}

impl Tracks {
    fn add(&mut self, frame: &ClipFrame) {
        self.frames.push((frame.index, frame.objects.clone(), frame.background));
    }

    /// No object moves on from the last frame.
    fn end(&mut self) {
        if let Some((_, objects, background)) = self.frames.last_mut() {
            objects.iter_mut().for_each(|object| object.matrix = None);
            *background = None;
        }
    }

    fn value<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let mut objects: BTreeMap<u8, Vec<(usize, &ClipObject)>> = BTreeMap::new();
        for (index, seen, _) in &self.frames {
            seen.iter().for_each(|object| objects.entry(object.id).or_default().push((*index, object)));
        }
        let background = self.frames.iter().filter_map(|(index, _, motion)| Some((*index, (*motion)?)));
        results::clip_tracks(py, objects, background, self.dropped)
    }
}
