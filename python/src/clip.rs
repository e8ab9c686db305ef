//! Clips: frames in, labelled frames and tracks out.
//!
//! A stream takes frames that come once. A whole clip reads its frames once for their pairs, where annotations need them, and once for their
//! labels. Each step is done in the thread that keeps the clip; frames are read between the steps.

mod annotations;
mod kept;
mod source;
mod tracks;

use std::collections::VecDeque;

use pyo3::exceptions::PyException;
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};
use veronese::clip::{Annotations, Changed, ClipFrame, ClipOptions, MAX_LOOK_AHEAD};
use veronese::{Frame, SegmentOptions};

use crate::errors::Failure;
use crate::options::{self, LookAhead};
use crate::results;
use crate::worker::Worker;
use annotations::{FrameAnnotations, Given};
use kept::{Kept, Step, Summary};
use source::Source;
use tracks::Tracks;

/// Begins a clip. Arguments are checked; segmentation begins with the first request.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "they are named in Python")]
pub(crate) fn segment_clip(
    py: Python<'_>,
    frames: &Bound<'_, PyAny>,
    motions: &Bound<'_, PyAny>,
    quality: &Bound<'_, PyAny>,
    mark_unknown: bool,
    subject: bool,
    look_ahead: Option<&Bound<'_, PyAny>>,
    masks: Option<&Bound<'_, PyAny>>,
    corrections: Option<&Bound<'_, PyAny>>,
    prompts: Option<&Bound<'_, PyAny>>,
    locked: Option<&Bound<'_, PyAny>>,
    named: Option<&Bound<'_, PyAny>>,
    accepted: Option<&Bound<'_, PyAny>>,
    state: Option<Vec<u8>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Clip> {
    let pair = SegmentOptions::default()
        .with_motions(options::motions(motions)?)
        .with_quality(options::quality(quality)?)
        .with_mark_unknown(mark_unknown)
        .with_subject(subject);
    let look_ahead = options::look_ahead(look_ahead)?;
    let source = Source::of(frames)?;
    // These need frames that can be read again.
    let needs = [
        ("masks", masks.is_some()),
        ("corrections", corrections.is_some()),
        ("prompts", prompts.is_some()),
        ("locked", locked.is_some()),
        ("named", named.is_some()),
        ("accepted", accepted.is_some()),
        ("state", state.is_some()),
        ("look_ahead", look_ahead == LookAhead::All),
    ];
    let needed = needs.iter().find(|(_, given)| *given).map(|(name, _)| *name);
    let length = match (source.length(), needed) {
        (None, Some(name)) => {
            let reason = "needs frames that can be read again: a sequence, or the path of a folder";
            return Err(Failure::option(name, reason).into());
        }
        (length, _) => length.unwrap_or(0),
    };
    let whole = needed.is_some() || (source.length().is_some() && look_ahead == LookAhead::Usual);
    let look_ahead = match look_ahead {
        LookAhead::Frames(frames) => Some(frames),
        _ if whole => None,
        _ => Some(MAX_LOOK_AHEAD),
    };
    let annotations = FrameAnnotations::of(&Given { masks, corrections, prompts, locked, named, accepted }, length)?;
    let worker = Worker::<Kept>::start()?;
    worker
        .call(py, move |kept| kept.begin(whole, ClipOptions::default().with_pair(pair).with_look_ahead(look_ahead)))?;
    Ok(Clip {
        worker: Some(worker),
        source,
        progress,
        mark_unknown,
        options: Some(Options { annotations, state }),
        size: None,
        place: if whole {
            Place::Unsegmented
        } else {
            Place::Stream { ready: VecDeque::new(), next: 0, ended: false, live: look_ahead == Some(0) }
        },
        changes: Vec::new(),
        tracks: Tracks::default(),
        failure: None,
    })
}

/// The options of a whole clip.
struct Options {
    annotations: FrameAnnotations,
    state: Option<Vec<u8>>,
}

/// The state of a clip.
enum Place {
    Stream {
        ready: VecDeque<ClipFrame>,
        /// The frame that is read next.
        next: usize,
        ended: bool,
        /// Whether frames are returned as they come, so that the clip may end at any time.
        live: bool,
    },
    Unsegmented,
    Segmented {
        length: usize,
        /// The frame that is returned next.
        next: usize,
    },
}

/// The frames of a clip, in order, as they are finished.
#[pyclass(module = "veronese")]
pub(crate) struct Clip {
    /// `None` when the clip is closed.
    worker: Option<Worker<Kept>>,
    source: Source,
    progress: Option<Py<PyAny>>,
    mark_unknown: bool,
    options: Option<Options>,
    /// Width and height of all frames, once known.
    size: Option<[usize; 2]>,
    place: Place,
    /// The changes by the last annotations.
    changes: Vec<Changed>,
    tracks: Tracks,
    /// The error of the source, or of a frame; it is raised after the frames before it.
    failure: Option<PyErr>,
}

#[pymethods]
impl Clip {
    fn __iter__(clip: PyRef<'_, Self>) -> PyRef<'_, Self> {
        clip
    }

    fn __repr__(&self) -> String {
        match (&self.worker, self.source.length()) {
            (None, _) => "Clip(closed)".into(),
            (_, None) => "Clip(a stream)".into(),
            (_, Some(1)) => "Clip(1 frame)".into(),
            (_, Some(length)) => format!("Clip({length} frames)"),
        }
    }

    fn __next__<'py>(&mut self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        if self.worker.is_none() {
            return Ok(None);
        }
        let next =
            if matches!(self.place, Place::Stream { .. }) { self.next_of_stream(py) } else { self.next_of_whole(py) };
        match next {
            Ok(Some(frame)) => self.returned(py, frame).map(Some),
            Ok(None) => {
                if matches!(self.place, Place::Stream { .. }) {
                    self.tracks.end();
                }
                self.failure.take().map_or(Ok(None), Err)
            }
            Err(error) => {
                self.close();
                Err(error)
            }
        }
    }

    /// A frame of a whole clip as it is now, as often as it is asked for.
    fn frame<'py>(&mut self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyAny>> {
        self.prepare(py)?;
        let frame = self.labelled(py, index)?;
        self.returned(py, frame)
    }

    /// Annotates frames of a whole clip by label maps, strokes and prompts. Returns the indices of the frames that change.
    #[pyo3(signature = (*annotations))]
    fn correct(&mut self, py: Python<'_>, annotations: &Bound<'_, PyTuple>) -> PyResult<Vec<usize>> {
        self.apply(py, &Given { corrections: Some(annotations), ..Given::default() })
    }

    /// Locks these objects: no annotation changes their pixels. All others are unlocked.
    fn lock(&mut self, py: Python<'_>, objects: &Bound<'_, PyAny>) -> PyResult<()> {
        self.apply(py, &Given { locked: Some(objects), ..Given::default() }).map(drop)
    }

    /// Names these objects: like annotated objects, they change only by annotations of themselves.
    fn name(&mut self, py: Python<'_>, objects: &Bound<'_, PyAny>) -> PyResult<()> {
        self.apply(py, &Given { named: Some(objects), ..Given::default() }).map(drop)
    }

    /// Accepts these frames as correct. Returns the indices of those that change.
    fn accept(&mut self, py: Python<'_>, frames: &Bound<'_, PyAny>) -> PyResult<Vec<usize>> {
        self.apply(py, &Given { accepted: Some(frames), ..Given::default() })
    }

    /// Merges objects under the number of the first. Returns the indices of the frames that change.
    #[pyo3(signature = (*objects))]
    fn merge(&mut self, py: Python<'_>, objects: &Bound<'_, PyTuple>) -> PyResult<Vec<usize>> {
        let objects = annotations::objects("objects", objects)?;
        let [kept, others @ ..] = &objects[..] else {
            return Err(Failure::option("objects", "there is nothing to merge").into());
        };
        self.renumber(py, others, *kept)
    }

    /// Turns objects into background. Returns the indices of the frames that change.
    #[pyo3(signature = (*objects))]
    fn delete(&mut self, py: Python<'_>, objects: &Bound<'_, PyTuple>) -> PyResult<Vec<usize>> {
        let objects = annotations::objects("objects", objects)?;
        self.renumber(py, &objects, 0)
    }

    /// The numbers of pixels that objects have gained and lost by the last annotations.
    fn changes<'py>(&mut self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        self.prepare(py)?;
        self.changes.iter().map(|changed| results::clip_change(py, changed)).collect()
    }

    /// The state of a whole clip, as bytes for the option `state`.
    fn state<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        self.prepare(py)?;
        let state = self.call(py, |kept| kept.segmented(|clip| Ok(clip.to_bytes())))?;
        Ok(PyBytes::new(py, &state))
    }

    /// The objects of the frames returned so far, as they are now.
    fn tracks<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        for index in self.tracks.stale() {
            let frame = self.labelled(py, index)?;
            self.tracks.add(&frame);
        }
        self.tracks.value(py)
    }

    /// Frees what the clip holds.
    fn close(&mut self) {
        self.worker = None;
    }

    fn __enter__(clip: PyRef<'_, Self>) -> PyRef<'_, Self> {
        clip
    }

    #[pyo3(signature = (*_exception))]
    fn __exit__(&mut self, _exception: &Bound<'_, PyTuple>) {
        self.close();
    }

    // The source or the listener may refer back to the clip.
    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.source.traverse(&visit)?;
        visit.call(&self.progress)
    }

    fn __clear__(&mut self) {
        self.source = Source::default();
        self.progress = None;
    }
}

impl Clip {
    fn call<R: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Kept) -> Result<R, Failure> + Send + 'static,
    ) -> PyResult<R> {
        match &self.worker {
            Some(worker) => worker.call(py, work),
            None => Err(Failure::input("the clip is closed".into()).into()),
        }
    }

    /// Calls the listener when work on a frame begins.
    fn report(&self, py: Python<'_>, stage: &str, index: usize) -> PyResult<()> {
        match &self.progress {
            Some(progress) => progress.call1(py, (stage, index, self.source.length())).map(|_| ()),
            None => Ok(()),
        }
    }

    /// A frame of the source, checked against the size of the others. `None` at the end.
    fn read(&mut self, py: Python<'_>, index: usize) -> PyResult<Option<Frame>> {
        let Some(given) = self.source.read(py, index)? else { return Ok(None) };
        let frame = py.detach(|| given.frame()).map_err(|failure| failure.about(&format!("frame {index}")))?;
        let (width, height) = (frame.width(), frame.height());
        let [w, h] = *self.size.get_or_insert([width, height]);
        if [w, h] != [width, height] {
            let message = format!("frame {index} has {width}×{height} pixels, the others have {w}×{h}");
            return Err(Failure { code: "frame-size-mismatch", message }.into());
        }
        Ok(Some(frame))
    }

    /// A frame that was read before.
    fn read_again(&mut self, py: Python<'_>, index: usize) -> PyResult<Frame> {
        let gone = || Failure::input(format!("frame {index} is not there any more"));
        Ok(self.read(py, index)?.ok_or_else(gone)?)
    }

    /// [`read`](Self::read), but an error is raised only after the frames before it.
    fn read_or_fail(&mut self, py: Python<'_>, index: usize) -> PyResult<Option<Frame>> {
        match self.read(py, index) {
            // Exceptions that end the program, such as KeyboardInterrupt, are raised at once.
            Err(error) if error.is_instance_of::<PyException>(py) => {
                self.failure = Some(error);
                Ok(None)
            }
            read => read,
        }
    }

    /// A frame to return.
    fn returned<'py>(&mut self, py: Python<'py>, frame: ClipFrame) -> PyResult<Bound<'py, PyAny>> {
        self.tracks.add(&frame);
        results::clip_frame(py, frame, self.size.unwrap_or_default())
    }

    fn next_of_stream(&mut self, py: Python<'_>) -> PyResult<Option<ClipFrame>> {
        loop {
            let Place::Stream { ready, next, ended, live } = &mut self.place else { return Ok(None) };
            if let Some(frame) = ready.pop_front() {
                return Ok(Some(frame));
            }
            if *ended {
                return Ok(None);
            }
            let (index, live) = (*next, *live);
            *next += 1;
            let done = match self.read_or_fail(py, index)? {
                Some(frame) => {
                    self.report(py, "pairs", index)?;
                    self.call(py, move |kept| kept.push(frame))?.into_iter().collect()
                }
                None if live => self.finished(py)?,
                None => {
                    self.check_count(index)?;
                    self.finished(py)?
                }
            };
            if let Place::Stream { ready, .. } = &mut self.place {
                ready.extend(done);
            }
        }
    }

    /// Rejects a source that ended, and did not fail, before its second frame.
    fn check_count(&self, frames: usize) -> Result<(), Failure> {
        if frames >= 2 || self.failure.is_some() {
            return Ok(());
        }
        let message = format!("a clip needs two frames, found {}", if frames == 0 { "none" } else { "one" });
        Err(Failure { code: "too-few-frames", message })
    }

    /// The frames of a stream that still wait.
    fn finished(&mut self, py: Python<'_>) -> PyResult<Vec<ClipFrame>> {
        let (rest, dropped) = self.call(py, Kept::finish)?;
        if let Place::Stream { ended, .. } = &mut self.place {
            *ended = true;
        }
        self.tracks.dropped = dropped;
        Ok(rest)
    }

    fn next_of_whole(&mut self, py: Python<'_>) -> PyResult<Option<ClipFrame>> {
        self.prepare(py)?;
        let Place::Segmented { length, next } = &mut self.place else { return Ok(None) };
        if next == length {
            return Ok(None);
        }
        let index = *next;
        *next += 1;
        let frame = self.read_again(py, index)?;
        self.report(py, "labels", index)?;
        self.described(py, index, frame).map(Some)
    }

    fn length(&self) -> usize {
        if let Place::Segmented { length, .. } = self.place { length } else { 0 }
    }

    fn labelled(&mut self, py: Python<'_>, index: usize) -> PyResult<ClipFrame> {
        let length = self.length();
        if index >= length {
            let reason = format!("there is no frame {index} in a clip of {length} frames");
            return Err(Failure::option("frame", &reason).into());
        }
        let frame = self.read_again(py, index)?;
        self.described(py, index, frame)
    }

    fn described(&self, py: Python<'_>, index: usize, frame: Frame) -> PyResult<ClipFrame> {
        self.call(py, move |kept| kept.segmented(|clip| clip.frame(index, &frame)))
    }

    /// Segments a whole clip, or restores its state, and applies the annotations given with it. Runs once.
    fn prepare(&mut self, py: Python<'_>) -> PyResult<()> {
        if matches!(self.place, Place::Stream { .. }) {
            let sentence = "this needs a whole clip, and the frames of this one come once".into();
            return Err(Failure::input(sentence).into());
        }
        let Some(options) = self.options.take() else { return Ok(()) };
        let prepared = self.prepare_as(py, options);
        if prepared.is_err() {
            self.close();
        }
        prepared
    }

    fn prepare_as(&mut self, py: Python<'_>, mut options: Options) -> PyResult<()> {
        let summary = match options.state.take() {
            Some(state) => self.restored(py, &options, state)?,
            None => self.solved(py, &options)?,
        };
        self.tracks.dropped = summary.dropped;
        self.place = Place::Segmented { length: summary.length, next: 0 };
        // The source may have failed before it reached an annotated frame.
        self.annotate(py, options.annotations.of_first(summary.length)).map(drop)
    }

    /// Solves all pairs. If the source fails, the frames before form the clip.
    fn solved(&mut self, py: Python<'_>, options: &Options) -> PyResult<Summary> {
        let mut index = 0;
        while let Some(frame) = self.read_or_fail(py, index)? {
            if let (0, Some(size)) = (index, self.size) {
                options.annotations.check(size)?;
            }
            self.report(py, "pairs", index)?;
            self.call(py, move |kept| kept.push(frame))?;
            index += 1;
        }
        self.check_count(index)?;
        self.call(py, Kept::conclude)
    }

    fn restored(&mut self, py: Python<'_>, options: &Options, state: Vec<u8>) -> PyResult<Summary> {
        let mark_unknown = self.mark_unknown;
        let summary = self.call(py, move |kept| kept.restore(&state, mark_unknown))?;
        let (found, wanted) = (summary.length, self.source.length().unwrap_or(0));
        if found != wanted {
            return Err(Failure::option("state", &format!("it is of a clip of {found} frames, not {wanted}")).into());
        }
        if found > 0 {
            self.size = Some(summary.size);
            options.annotations.check(summary.size)?;
        }
        Ok(summary)
    }

    fn apply(&mut self, py: Python<'_>, given: &Given<'_, '_>) -> PyResult<Vec<usize>> {
        self.prepare(py)?;
        let given = FrameAnnotations::of(given, self.length())?;
        given.check(self.size.unwrap_or_default())?;
        self.annotate(py, given.annotations)
    }

    fn renumber(&mut self, py: Python<'_>, objects: &[u8], number: u8) -> PyResult<Vec<usize>> {
        self.prepare(py)?;
        let others = objects.iter().filter(|&&object| object != number);
        let numbers = others.map(|&object| [object, number]).collect();
        self.annotate(py, Annotations { numbers, ..Annotations::default() })
    }

    /// Applies annotations. Returns the frames that have changed, in order. If it ends early, the clip is as before.
    fn annotate(&mut self, py: Python<'_>, annotations: Annotations) -> PyResult<Vec<usize>> {
        let done = self.annotate_through(py, annotations);
        if let Some(worker) = &self.worker {
            let holds = done.is_ok();
            worker.post(move |kept| kept.settle(holds));
        }
        let (mut changed, changes) = done?;
        self.changes = changes;
        self.tracks.changed(&changed);
        changed.sort_unstable();
        Ok(changed)
    }

    fn annotate_through(&mut self, py: Python<'_>, annotations: Annotations) -> PyResult<(Vec<usize>, Vec<Changed>)> {
        let mut step = self.call(py, move |kept| kept.annotate(annotations))?;
        loop {
            match step {
                Step::Done(changed, changes) => return Ok((changed, changes)),
                Step::Wants(index) => {
                    self.report(py, "corrections", index)?;
                    let frame = self.read_again(py, index)?;
                    step = self.call(py, move |kept| kept.take(&frame))?;
                }
            }
        }
    }
}
