//! A clip of frames that can be read again: it is segmented, corrected and read, from its opening to its closing.
//!
//! A call gives the clip a command, reads the frames that it wants, and returns when it has taken effect. Work on each frame is done in the
//! thread that keeps the clip.

mod annotations;
mod journal;
mod journaled;
mod source;
pub(crate) mod stream;

use std::path::PathBuf;

use pyo3::exceptions::{PyException, PyUserWarning};
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};
use veronese::clip::{Changed, ClipStage, Command, Description, OpenOptions, Wanted};

use crate::errors::Failure;
use crate::options::{self, index, invalid, object};
use crate::results;
use crate::worker::Worker;
use journaled::JournaledClip;
use source::Source;

/// An argument that may be left out.
type Optional<'a, 'py> = Option<&'a Bound<'py, PyAny>>;
type Changes<'py> = PyResult<Vec<Bound<'py, PyAny>>>;

/// Opens a clip, and finishes what was begun when its journal ended.
#[pyfunction]
pub(crate) fn open_clip(
    py: Python<'_>,
    frames: &Bound<'_, PyAny>,
    saved: Option<Vec<u8>>,
    journal: Option<PathBuf>,
    mark_unknown: bool,
) -> PyResult<Clip> {
    let source = Source::of(frames)?;
    let Some(length) = source.length() else {
        let sentence =
            "a clip needs frames that can be read again, a sequence or a folder: segment_stream takes others";
        return Err(Failure::input(sentence.into()).into());
    };
    let is_kept = journal.is_some();
    let options = OpenOptions::default().with_mark_unknown(mark_unknown);
    let (kept, warning) = py.detach(|| JournaledClip::open(length, saved.as_deref(), journal, options))?;
    let mut clip = Clip { worker: Some(Worker::start(kept)?), source, length, is_kept };
    let warn = |sentence: String| {
        let warnings = py.import("warnings")?;
        warnings.call_method1("warn", (sentence, py.get_type::<PyUserWarning>(), 2)).map(drop)
    };
    warning.map_or(Ok(()), warn)?;
    match clip.work(py, None) {
        Ok(_) => Ok(clip),
        // The steps before are there all the same.
        Err(error) if error.is_instance_of::<PyException>(py) => {
            clip.call(py, JournaledClip::cancel_all)?;
            warn(format!("annotations that were under way when the journal ended are left out: {error}"))?;
            Ok(clip)
        }
        Err(error) => {
            clip.close(py)?;
            Err(error)
        }
    }
}

/// A clip, from its opening to its closing.
#[pyclass(module = "veronese")]
pub(crate) struct Clip {
    /// `None` when the clip is closed.
    worker: Option<Worker<JournaledClip>>,
    source: Source,
    /// Number of frames.
    length: usize,
    /// Whether there is a journal.
    is_kept: bool,
}

#[pymethods]
impl Clip {
    fn __len__(&self) -> usize {
        self.length
    }

    fn __repr__(&self) -> String {
        match (&self.worker, self.length) {
            (None, _) => "Clip(closed)".into(),
            (_, 1) => "Clip(1 frame)".into(),
            (_, length) => format!("Clip({length} frames)"),
        }
    }

    /// The frames that have masks, in order.
    fn __iter__<'py>(clip: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        results::class(clip.py(), "labelled_frames")?.call1((clip,))
    }

    /// Segments a range of frames.
    #[pyo3(
        signature = (first = None, last = None, motions = None, quality = None, subject = false, progress = None),
        text_signature = "($self, first=0, last=None, motions='auto', quality='best', subject=False, progress=None)"
    )]
    #[allow(clippy::too_many_arguments, reason = "they are named in Python")]
    fn segment(
        &mut self,
        py: Python<'_>,
        first: Optional<'_, '_>,
        last: Optional<'_, '_>,
        motions: Optional<'_, '_>,
        quality: Optional<'_, '_>,
        subject: bool,
        progress: Optional<'_, '_>,
    ) -> PyResult<()> {
        if self.length < 2 {
            return Err(stream::too_few(self.length).into());
        }
        let options = options::pair(motions, quality, subject)?;
        let first = first.map_or(Ok(0), |first| index("first", first))?;
        let last = last.map_or(Ok(self.length - 1), |last| index("last", last))?;
        if last >= self.length || first >= last {
            let reason = format!("there are no two frames from {first} to {last} in a clip of {} frames", self.length);
            return Err(Failure::option(if last >= self.length { "last" } else { "first" }, &reason).into());
        }
        self.run(py, Command::Segment { frames: first..last + 1, options }, progress).map(drop)
    }

    /// Annotates frames, all in one step.
    #[pyo3(signature = (*annotations, progress = None))]
    fn annotate<'py>(
        &mut self,
        py: Python<'py>,
        annotations: &Bound<'_, PyTuple>,
        progress: Optional<'_, '_>,
    ) -> Changes<'py> {
        let size = self.call(py, |kept| Ok(kept.clip.size()))?;
        self.change(py, Command::Annotate(annotations::annotations(annotations, size)?), progress)
    }

    /// Takes back the annotations of a frame, of one object or of all.
    #[pyo3(signature = (frame, object = None))]
    fn clear<'py>(&mut self, py: Python<'py>, frame: &Bound<'_, PyAny>, object: Optional<'_, '_>) -> Changes<'py> {
        let object = object.map(|number| options::object("object", number)).transpose()?;
        self.change(py, Command::Clear { frame: index("frame", frame)?, object }, None)
    }

    /// Accepts frames as correct, or no longer.
    #[pyo3(signature = (frames, on = true))]
    fn accept<'py>(&mut self, py: Python<'py>, frames: &Bound<'_, PyAny>, on: bool) -> Changes<'py> {
        self.change(py, Command::Accept { frames: options::all("frames", frames, index)?, on }, None)
    }

    /// Locks objects, or unlocks them.
    #[pyo3(signature = (objects, on = true))]
    fn lock(&mut self, py: Python<'_>, objects: &Bound<'_, PyAny>, on: bool) -> PyResult<()> {
        self.run(py, Command::Lock { objects: options::all("objects", objects, object)?, on }, None).map(drop)
    }

    /// Gives an object a name, a class and a colour.
    #[pyo3(signature = (number, name = "", class_name = "", colour = None))]
    fn describe(
        &mut self,
        py: Python<'_>,
        number: &Bound<'_, PyAny>,
        name: &str,
        class_name: &str,
        colour: Optional<'_, '_>,
    ) -> PyResult<()> {
        let colour = colour.map(|given| {
            given.extract::<[u8; 3]>().map_err(|_| invalid("colour", "red, green and blue from 0 to 255", given))
        });
        let description = Description { name: name.into(), class: class_name.into(), colour: colour.transpose()? };
        let object = object("object", number)?;
        self.run(py, Command::Describe { object, description, coalesce: false }, None).map(drop)
    }

    /// Merges objects under the number of the first.
    #[pyo3(signature = (*objects))]
    fn merge(&mut self, py: Python<'_>, objects: &Bound<'_, PyTuple>) -> PyResult<()> {
        self.run(py, Command::Merge(options::all("objects", objects, object)?), None).map(drop)
    }

    /// Turns objects into background.
    #[pyo3(signature = (*objects))]
    fn delete(&mut self, py: Python<'_>, objects: &Bound<'_, PyTuple>) -> PyResult<()> {
        self.run(py, Command::Delete(options::all("objects", objects, object)?), None).map(drop)
    }

    /// Makes a new object of all connected pieces of an object but the largest in a frame.
    fn split<'py>(&mut self, py: Python<'py>, object: &Bound<'_, PyAny>, frame: &Bound<'_, PyAny>) -> Changes<'py> {
        let (object, frame) = (options::object("object", object)?, index("frame", frame)?);
        let none = || Failure::input("no number is left for another object".into());
        let new = self.call(py, move |kept| kept.clip.next_object().ok_or_else(none))?;
        self.change(py, Command::Split { object, frame, new }, None)
    }

    /// Takes back the last step. Returns whether there was one.
    fn undo(&mut self, py: Python<'_>) -> PyResult<bool> {
        self.call(py, |kept| kept.with(|clip| clip.undo()))
    }

    /// Does again the step that was taken back last. Returns whether there was one.
    fn redo(&mut self, py: Python<'_>) -> PyResult<bool> {
        self.call(py, |kept| kept.with(|clip| clip.redo()))
    }

    /// The labels and objects of a frame.
    fn labels<'py>(&mut self, py: Python<'py>, frame: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let frame = index("frame", frame)?;
        let labels = match self.call(py, move |kept| kept.labels(frame))? {
            Some(labels) => labels,
            None => self.read(py, frame, JournaledClip::labels_of)?,
        };
        let size = self.call(py, |kept| Ok(kept.clip.size()))?;
        results::clip_frame(py, labels, size)
    }

    /// All objects that there have been.
    #[getter]
    fn objects<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        results::clip_entries(py, &self.call(py, |kept| Ok(kept.clip.objects()))?)
    }

    /// What is known of each frame.
    #[getter]
    fn frames<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        results::frame_statuses(py, &self.call(py, |kept| Ok(kept.clip.frames()))?)
    }

    /// The lowest number that no object has had.
    #[getter]
    fn next_object(&self, py: Python<'_>) -> PyResult<Option<u8>> {
        self.call(py, |kept| Ok(kept.clip.next_object()))
    }

    /// The tracks of all objects in all frames that have masks.
    fn tracks<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        for index in 0..self.length {
            if self.call(py, move |kept| Ok(kept.needs(index)))? {
                self.read(py, index, JournaledClip::labels_of)?;
            }
        }
        let tracks = self.call(py, |kept| Ok(kept.clip.tracks()))?;
        let objects = tracks.objects.iter().map(|track| {
            let seen = track.frames.iter().map(|(frame, object)| (*frame, object));
            (track.id, seen.collect())
        });
        results::clip_tracks(py, objects, tracks.background.iter().copied(), tracks.dropped)
    }

    /// The clip as bytes.
    fn save<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let saved = self.call(py, |kept| Ok(kept.clip.save()))?;
        Ok(PyBytes::new(py, &saved))
    }

    /// Frees what the clip holds. Its journal can be opened again when this returns.
    fn close(&mut self, py: Python<'_>) -> PyResult<()> {
        let Some(worker) = self.worker.take().filter(|_| self.is_kept) else { return Ok(()) };
        let closed = worker.call(py, |kept| {
            kept.journal = None;
            Ok(())
        });
        // A worker that is lost has no journal; an interruption is passed on.
        closed.or_else(|error| if error.is_instance_of::<PyException>(py) { Ok(()) } else { Err(error) })
    }

    fn __enter__(clip: PyRef<'_, Self>) -> PyRef<'_, Self> {
        clip
    }

    #[pyo3(signature = (*_exception))]
    fn __exit__(&mut self, py: Python<'_>, _exception: &Bound<'_, PyTuple>) -> PyResult<()> {
        self.close(py)
    }

    // The source may refer back to the clip.
    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.source.traverse(&visit)
    }

    fn __clear__(&mut self) {
        self.source = Source::default();
    }
}

impl Clip {
    fn call<R: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut JournaledClip) -> Result<R, Failure> + Send + 'static,
    ) -> PyResult<R> {
        match &self.worker {
            Some(worker) => worker.call(py, work),
            None => Err(Failure::input("the clip is closed".into()).into()),
        }
    }

    /// Reads a frame and does something with it.
    fn read<R: Send + 'static>(
        &self,
        py: Python<'_>,
        index: usize,
        work: impl FnOnce(&mut JournaledClip, usize, &veronese::Frame) -> Result<R, Failure> + Send + 'static,
    ) -> PyResult<R> {
        let gone = || Failure::input(format!("frame {index} is not there any more"));
        let frame = self.source.frame(py, index)?.ok_or_else(gone)?;
        self.call(py, move |kept| work(kept, index, &frame))
    }

    /// Runs a command. Returns what it has changed.
    fn change<'py>(&mut self, py: Python<'py>, command: Command, progress: Optional<'_, '_>) -> Changes<'py> {
        results::clip_changes(py, &self.run(py, command, progress)?)
    }

    /// Runs a command until it has taken effect. If that ends early, it is taken back.
    fn run(&mut self, py: Python<'_>, command: Command, progress: Optional<'_, '_>) -> PyResult<Vec<Changed>> {
        let done = self.call(py, move |kept| kept.apply(command)).and_then(|()| {
            let failure = self.work(py, progress)?;
            let outcome = self.call(py, JournaledClip::outcome);
            failure.map_or(outcome, Err)
        });
        if let (Err(_), Some(worker)) = (&done, &self.worker) {
            worker.post(JournaledClip::take_back);
        }
        done
    }

    /// Reads the frames that are wanted, until none is. A frame that is unusable ends the range that is being segmented before it; the
    /// error is returned.
    fn work(&mut self, py: Python<'_>, progress: Optional<'_, '_>) -> PyResult<Option<PyErr>> {
        let mut failure = None;
        while let Some(Wanted { frame, stage, step, .. }) = self.call(py, JournaledClip::wanted)? {
            py.check_signals()?;
            let is_pairs = stage == ClipStage::Pairs;
            report(progress, if is_pairs { "pairs" } else { "annotations" }, frame, Some(self.length))?;
            match self.read(py, frame, JournaledClip::take) {
                Err(error) if is_pairs && is_of_frame(py, &error) => {
                    failure = Some(error);
                    self.call(py, move |kept| kept.with(|clip| step.into_iter().for_each(|step| clip.finish(step))))?;
                }
                taken => taken?,
            }
        }
        Ok(failure)
    }
}

/// Whether an error is about a frame: not an interruption, nor a journal that cannot be written.
fn is_of_frame(py: Python<'_>, error: &PyErr) -> bool {
    let code = error.value(py).getattr("code").and_then(|code| code.extract::<String>());
    error.is_instance_of::<PyException>(py) && code.map_or(true, |code| code != "write-failed")
}

/// Tells the listener that work on a frame begins.
fn report(progress: Optional<'_, '_>, stage: &str, index: usize, of: Option<usize>) -> PyResult<()> {
    progress.map_or(Ok(()), |progress| progress.call1((stage, index, of)).map(drop))
}
