//! Stopping on Ctrl-C, SIGTERM or SIGHUP.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, Once, PoisonError};
use std::thread;
use std::time::{Duration, Instant as WallInstant};

use flexsc_core::SimulationError;
use flexsc_core::motion::Stretch;
use flexsc_core::record::{Record, RecordError, Sample};
use flexsc_core::time::Instant;

use crate::failure::Failure;

static ASKED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// How often the flag is looked at.
const LOOK: Duration = Duration::from_millis(20);
/// How long work may take to end by itself once it is asked to stop.
const PATIENCE: Duration = Duration::from_millis(50);
/// The same while files are written.
const PATIENCE_OF_FILES: Duration = Duration::from_secs(2);
/// How long the last message may take: whoever should read it may not.
const PATIENCE_OF_READERS: Duration = Duration::from_secs(1);
/// What the main thread of a program has on most systems (bytes).
const STACK: usize = 8 << 20;

/// How many threads write files, and whether none may begin to because the program ends.
static FILES: Mutex<(u32, bool)> = Mutex::new((0, false));

/// Files are being written as long as this lives: the program does not end then, but for work that cannot be stopped.
pub struct Writing(());

/// Begins to write files.
pub fn writing() -> Writing {
    loop {
        let mut files = files();
        if !files.1 {
            files.0 += 1;
            return Writing(());
        }
        drop(files);
        // The program ends.
        thread::park();
    }
}

impl Drop for Writing {
    fn drop(&mut self) {
        files().0 -= 1;
    }
}

fn files() -> MutexGuard<'static, (u32, bool)> {
    FILES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Does a command's work on a thread of its own and returns its exit code.
///
/// From now on, the first Ctrl-C, SIGTERM or SIGHUP asks to stop: simulations end with their files finished, and work that
/// does not look at the flag is left behind. A second one ends the program. A signal that is ignored, as by `nohup` or in
/// the background of a script, stays so.
pub fn watched(work: impl FnOnce() -> u8 + Send + 'static) -> u8 {
    static ONCE: Once = Once::new();
    ONCE.call_once(handle);
    let (done, wait) = channel();
    let builder = thread::Builder::new().stack_size(STACK);
    let working = match builder.spawn(move || done.send(work())) {
        Ok(working) => working,
        Err(source) => return Failure::Thread(source).tell(),
    };
    let mut noticed = None;
    loop {
        match wait.recv_timeout(LOOK) {
            Ok(code) => return code,
            // It panicked, and said so.
            Err(RecvTimeoutError::Disconnected) => match working.join() {
                Err(panic) => resume_unwind(panic),
                Ok(_) => return 1,
            },
            Err(RecvTimeoutError::Timeout) if asked() => {
                let waited = noticed.get_or_insert_with(WallInstant::now).elapsed();
                let mut files = files();
                if waited >= PATIENCE && (files.0 == 0 || waited >= PATIENCE_OF_FILES) {
                    files.1 = true;
                    drop(files);
                    return tell_interrupted();
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
    }
}

/// Tells that the user asked to stop, and returns the exit code. What waits to be read, such as in a pager, holds nothing up.
fn tell_interrupted() -> u8 {
    let (told, wait) = channel();
    // Without a thread the exit code says it.
    let _ = thread::Builder::new().spawn(move || told.send(Failure::Interrupted(String::new()).tell()));
    wait.recv_timeout(PATIENCE_OF_READERS).unwrap_or(130)
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

/// Why a run that had not begun is not made.
pub fn interrupted() -> SimulationError {
    RecordError::Interrupted.into()
}

/// A record that ends the simulation when the user asks.
pub struct Stop;

impl Record for Stop {
    fn record(&mut self, _: Instant, _: Sample<'_>) -> Result<(), RecordError> {
        Ok(())
    }

    fn poll(&mut self) -> Result<(), RecordError> {
        if asked() { Err(RecordError::Interrupted) } else { Ok(()) }
    }

    fn stretch(&mut self, _: Instant, _: &Stretch) -> Result<(), RecordError> {
        if asked() { Err(RecordError::Interrupted) } else { Ok(()) }
    }
}
