//! Work on threads without the interpreter's lock, stopped by Python's signals.

use std::process;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant as WallInstant};

use flexsc_core::record::StopFlag;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// Period at which Python's signals are checked.
pub const SIGNAL_PERIOD: Duration = Duration::from_millis(20);
/// Longest time for which a requested stop waits; work that has not ended then is abandoned.
const STOP_TIMEOUT: Duration = Duration::from_millis(150);
/// Stack of a main thread on most systems (bytes).
const STACK: usize = 8 << 20;

/// Work of a thread.
type Work = Box<dyn FnOnce() + Send>;

/// Threads that wait for work, each with the process in which it was started: a forked process has none of them.
static IDLE: Mutex<Vec<(u32, Sender<Work>)>> = Mutex::new(Vec::new());

/// Does work on an idle thread, or on a new one. Starting a thread takes longer than many a run.
fn on_a_thread(mut work: Work) -> PyResult<()> {
    let process = process::id();
    loop {
        let idle = IDLE.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let Some((started_in, thread)) = idle else { break };
        if started_in == process {
            match thread.send(work) {
                Ok(()) => return Ok(()),
                Err(unsent) => work = unsent.0,
            }
        }
    }
    let (give, take) = channel::<Work>();
    thread::Builder::new().stack_size(STACK).spawn(move || {
        work();
        loop {
            IDLE.lock().unwrap_or_else(PoisonError::into_inner).push((process, give.clone()));
            let Ok(next) = take.recv() else { return };
            next();
        }
    })?;
    Ok(())
}

/// Does work on another thread. Python answers signals on the calling thread alone, so this one waits, and
/// raises what they raise, such as `KeyboardInterrupt`.
pub fn aside<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(StopFlag) -> T + Send + 'static,
) -> PyResult<T> {
    let stop = StopFlag::default();
    let for_work = stop.clone();
    py.detach(|| {
        let (done, wait) = channel();
        on_a_thread(Box::new(move || {
            // The receiver is gone if the work was left behind.
            let _ = done.send(work(for_work));
        }))?;
        let mut raised: Option<(PyErr, WallInstant)> = None;
        loop {
            match (wait.recv_timeout(SIGNAL_PERIOD), &raised) {
                (Ok(worked), _) => return raised.map_or(Ok(worked), |(error, _)| Err(error)),
                (Err(RecvTimeoutError::Disconnected), _) => {
                    return Err(PyRuntimeError::new_err("the engine panicked: please report it"));
                }
                (Err(RecvTimeoutError::Timeout), None) => {
                    let error = Python::attach(|py| py.check_signals().err());
                    raised = error.map(|error| (error, WallInstant::now()));
                    if raised.is_some() {
                        stop.request();
                    }
                }
                (Err(RecvTimeoutError::Timeout), Some((error, since))) => {
                    if since.elapsed() >= STOP_TIMEOUT {
                        return Err(Python::attach(|py| error.clone_ref(py)));
                    }
                }
            }
        }
    })
}
