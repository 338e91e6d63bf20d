//! Stopping on Ctrl-C or SIGTERM.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock};

use flexsc_core::record::{Record, RecordError, Sample};
use flexsc_core::time::Instant;

static ASKED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// From now on, the first Ctrl-C or SIGTERM asks to stop, so that files are finished; a second one ends the program.
pub fn listen() {
    let ask = || {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    };
    // A program that has its own handler, such as a Python session, keeps it, and what is told to ignore a signal, as by
    // `nohup` or as a script's background job, goes on doing so.
    if ctrlc::try_set_handler(ask).is_err() {
        #[cfg(unix)]
        listen_for_termination();
    }
}

/// SIGTERM alone.
#[cfg(unix)]
fn listen_for_termination() {
    use signal_hook::{consts::SIGTERM, flag};
    // In this order: the first signal finds the flag down, the second one finds it up.
    let _ = flag::register_conditional_shutdown(SIGTERM, 130, Arc::clone(&ASKED))
        .and_then(|_| flag::register(SIGTERM, Arc::clone(&ASKED)));
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
