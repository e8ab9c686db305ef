//! Work in threads without the interpreter. The thread that waits for it checks for signals: Ctrl-C ends a call at once, and its thread at
//! the next stage or, for a clip, when the frame is done. A clip is kept by a thread of its own, which does one thing after another.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::Builder;
use std::time::Duration;

use pyo3::prelude::*;
use veronese::{Progress, Stage};

use crate::errors::Failure;

/// Time between two checks for signals.
const PATIENCE: Duration = Duration::from_millis(50);

/// Messages of a worker to the thread that waits for it.
enum Message<R> {
    Stage(Stage),
    Done(Result<R, Failure>),
}

/// Unwinds a call whose result is no longer wanted.
struct Abandoned;

/// Runs a call in its own thread. `progress` is called with the name of each stage, its index and the number of stages; an exception that
/// it raises ends the call.
pub(crate) fn alone<R: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Progress<'_>) -> Result<R, Failure> + Send + 'static,
) -> PyResult<R> {
    let (sender, messages) = channel();
    spawn(move || {
        let mut listener = |stage| {
            if sender.send(Message::Stage(stage)).is_err() {
                resume_unwind(Box::new(Abandoned));
            }
        };
        if let Some(done) = caught(|| work(&mut listener)) {
            // The other thread may have stopped waiting.
            let _ = sender.send(Message::Done(done));
        }
    })?;
    answer(py, messages, |Stage { name, index, of, .. }| match progress {
        Some(progress) => progress.call1((name, index, of)).map(|_| ()),
        None => Ok(()),
    })
}

type Job<T> = Box<dyn FnOnce(&mut T) -> bool + Send>;

/// A thread that keeps a value until this is dropped.
pub(crate) struct Worker<T> {
    jobs: Sender<Job<T>>,
    /// The process that has the thread: a forked one has not.
    process: u32,
}

impl<T: Send + 'static> Worker<T> {
    pub(crate) fn start(mut kept: T) -> PyResult<Worker<T>> {
        let (jobs, given) = channel::<Job<T>>();
        spawn(move || {
            for job in given {
                if !job(&mut kept) {
                    break;
                }
            }
        })?;
        Ok(Worker { jobs, process: std::process::id() })
    }

    /// Runs some work on the value. After a panic there is no value any more.
    pub(crate) fn call<R: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut T) -> Result<R, Failure> + Send + 'static,
    ) -> PyResult<R> {
        if std::process::id() != self.process {
            let message = "a clip stays in the process that began it".into();
            return Err(Failure { code: "worker-failed", message }.into());
        }
        let (sender, messages) = channel();
        let job = move |kept: &mut T| {
            let done = caught(|| work(kept));
            let goes_on = !matches!(done, None | Some(Err(Failure { code: "internal", .. })));
            let _ = done.is_none_or(|done| sender.send(Message::Done(done)).is_ok());
            goes_on
        };
        self.jobs.send(Box::new(job)).map_err(|_| lost())?;
        answer(py, messages, |_| Ok(()))
    }

    /// Runs some work without waiting for it, before any later work.
    pub(crate) fn post(&self, work: impl FnOnce(&mut T) + Send + 'static) {
        let job = move |kept: &mut T| {
            caught(|| {
                work(kept);
                Ok(())
            })
            .is_some_and(|done| done.is_ok())
        };
        // If the thread has ended, there is nothing left to do.
        let _ = self.jobs.send(Box::new(job));
    }
}

fn lost() -> Failure {
    Failure::internal("the clip was lost when a call failed".into())
}

fn spawn(work: impl FnOnce() + Send + 'static) -> Result<(), Failure> {
    match Builder::new().name("veronese".into()).spawn(work) {
        Ok(_) => Ok(()),
        Err(error) => {
            Err(Failure { code: "worker-failed", message: format!("a thread could not be started: {error}") })
        }
    }
}

/// The outcome of some work; a panic is an error of code `internal`. `None` if nobody waits.
fn caught<R>(work: impl FnOnce() -> Result<R, Failure>) -> Option<Result<R, Failure>> {
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(done) => Some(done),
        Err(thrown) if thrown.is::<Abandoned>() => None,
        Err(thrown) => Some(Err(Failure::internal(sentence(&*thrown)))),
    }
}

fn sentence(thrown: &(dyn Any + Send)) -> String {
    let known = thrown.downcast_ref::<&str>().map(|text| (*text).to_owned());
    known.or_else(|| thrown.downcast_ref::<String>().cloned()).unwrap_or_else(|| "the call failed".into())
}

/// Waits for the result without holding the interpreter.
fn answer<R: Send>(
    py: Python<'_>,
    mut messages: Receiver<Message<R>>,
    mut on_stage: impl FnMut(Stage) -> PyResult<()>,
) -> PyResult<R> {
    loop {
        let (received, waiting) = py.detach(move || (messages.recv_timeout(PATIENCE), messages));
        messages = waiting;
        match received {
            Ok(Message::Stage(stage)) => on_stage(stage)?,
            Ok(Message::Done(done)) => return Ok(done?),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Err(lost().into()),
        }
        py.check_signals()?;
    }
}
