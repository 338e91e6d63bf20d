//! Flag that ends a run from another thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use flexsc_dynamics::MotionPiece;
use flexsc_numerics::time::Instant;

use super::{Record, RecordError, Sample};

/// Record that ends its run with [`RecordError::Interrupted`] once a stop is requested. Clones share the request.
#[derive(Clone, Debug, Default)]
pub struct StopFlag(Arc<AtomicBool>);

impl StopFlag {
    /// Requests the end of all runs that record to this flag or to a clone; returns true if it was requested before.
    pub fn request(&self) -> bool {
        self.0.swap(true, Ordering::Relaxed)
    }

    /// Returns true if the end of the runs was requested.
    pub fn is_requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Returns the flag itself, for handlers of signals.
    pub fn shared(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.0)
    }

    fn check(&self) -> Result<(), RecordError> {
        if self.is_requested() { Err(RecordError::Interrupted) } else { Ok(()) }
    }
}

impl Record for StopFlag {
    fn wants_journal(&self) -> bool {
        false
    }

    fn record(&mut self, _: Instant, _: Sample<'_>) -> Result<(), RecordError> {
        Ok(())
    }

    fn poll(&mut self) -> Result<(), RecordError> {
        self.check()
    }

    fn piece(&mut self, _: Instant, _: &MotionPiece) -> Result<(), RecordError> {
        self.check()
    }
}
