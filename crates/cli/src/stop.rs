//! Stopping on Ctrl-C or SIGTERM.

use std::sync::atomic::{AtomicBool, Ordering};

use flexsc_core::record::{Record, RecordError, Sample};
use flexsc_core::time::Instant;

static ASKED: AtomicBool = AtomicBool::new(false);

/// From now on, the first Ctrl-C or SIGTERM asks to stop, so that files are finished; a second one ends the program.
pub fn listen() {
    let ask = || {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    };
    // A program that has its own handler, such as a Python session, keeps it.
    let _ = ctrlc::try_set_handler(ask);
}

/// Asks to stop, as Ctrl-C does.
#[cfg(feature = "live")]
pub fn ask() {
    ASKED.store(true, Ordering::Relaxed);
}

/// Whether the user asked to stop.
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// A record that ends the simulation when the user asks.
pub struct Stop;

impl Record for Stop {
    fn record(&mut self, _: Instant, _: Sample<'_>) -> Result<(), RecordError> {
        if asked() { Err(RecordError::Interrupted) } else { Ok(()) }
    }
}
