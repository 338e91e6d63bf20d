//! Work beside Python: without the interpreter's lock, and stopped by its signals.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use flexsc_core::body::Stretch;
use flexsc_core::record::{Record, RecordError, Sample};
use flexsc_core::time::Instant;
use pyo3::prelude::*;

use pyo3::exceptions::PyRuntimeError;

/// How often Python is asked for signals.
const PATIENCE: Duration = Duration::from_millis(50);

/// A record that ends its run when Python asks.
#[derive(Copy, Clone)]
pub struct Stop<'a>(&'a AtomicBool);

impl Stop<'_> {
    pub fn asked(self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl Record for Stop<'_> {
    fn record(&mut self, _: Instant, _: Sample<'_>) -> Result<(), RecordError> {
        if self.asked() { Err(RecordError::Interrupted) } else { Ok(()) }
    }

    fn stretch(&mut self, _: Instant, _: &Stretch) -> Result<(), RecordError> {
        if self.asked() { Err(RecordError::Interrupted) } else { Ok(()) }
    }
}

/// Does work on a thread of its own. Python answers signals on the calling thread alone, so this one waits, and
/// raises what they raise, such as `KeyboardInterrupt`.
pub fn aside<T: Send>(py: Python<'_>, work: impl FnOnce(Stop<'_>) -> T + Send) -> PyResult<T> {
    let asked = AtomicBool::new(false);
    let stop = Stop(&asked);
    py.detach(|| {
        thread::scope(|scope| {
            let (done, wait) = channel::<()>();
            let working = thread::Builder::new().spawn_scoped(scope, move || {
                // Dropped at the end, also by a panic.
                let _done = done;
                work(stop)
            })?;
            let mut raised = None;
            while wait.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                if raised.is_none() {
                    raised = Python::attach(|py| py.check_signals().err());
                    asked.store(raised.is_some(), Ordering::Relaxed);
                }
            }
            let worked = working
                .join()
                .map_err(|_| PyRuntimeError::new_err("the engine panicked: please report it"))?;
            raised.map_or(Ok(worked), Err)
        })
    })
}
