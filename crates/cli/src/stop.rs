//! Stopping on Ctrl-C, SIGTERM or SIGHUP.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock, Once};

use flexsc_core::body::Stretch;
use flexsc_core::record::{Record, RecordError, Sample};
use flexsc_core::time::Instant;

static ASKED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// From now on, the first Ctrl-C, SIGTERM or SIGHUP asks to stop, so that files are finished; a second one ends the program.
///
/// A signal that is ignored, as by `nohup` or in the background of a script, stays so.
pub fn listen() {
    static ONCE: Once = Once::new();
    ONCE.call_once(handle);
}

#[cfg(unix)]
fn handle() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::flag;

    for signal in [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| !is_ignored(*signal)) {
        // In this order: the first signal finds the flag down, the second one finds it up. Without a handler, a signal ends
        // the program as it always does.
        let _ = flag::register_conditional_shutdown(signal, 130, Arc::clone(&ASKED))
            .and_then(|_| flag::register(signal, Arc::clone(&ASKED)));
    }
}

#[cfg(unix)]
#[expect(unsafe_code, reason = "no crate tells what a signal does without changing it")]
fn is_ignored(signal: libc::c_int) -> bool {
    let mut present = std::mem::MaybeUninit::<libc::sigaction>::zeroed();
    // SAFETY: no new action is given; the present one is written to a place of its own, of which zeros are a valid value.
    unsafe {
        libc::sigaction(signal, std::ptr::null(), present.as_mut_ptr()) == 0
            && present.assume_init().sa_sigaction == libc::SIG_IGN
    }
}

#[cfg(not(unix))]
fn handle() {
    let _ = ctrlc::try_set_handler(|| {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
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

    fn stretch(&mut self, _: Instant, _: &Stretch) -> Result<(), RecordError> {
        if asked() { Err(RecordError::Interrupted) } else { Ok(()) }
    }
}
