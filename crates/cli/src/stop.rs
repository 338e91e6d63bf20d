//! Stopping on Ctrl-C, SIGTERM or SIGHUP.

use std::io::Write;
use std::panic::resume_unwind;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{LazyLock, Mutex, MutexGuard, Once, PoisonError};
use std::thread;
use std::time::{Duration, Instant as WallInstant};

use flexsc_core::SimulationError;
use flexsc_core::record::{RecordError, StopFlag};

use crate::error::CliError;
use crate::say;

static STOP: LazyLock<StopFlag> = LazyLock::new(StopFlag::default);

/// Polling period of the flag.
const POLL_PERIOD: Duration = Duration::from_millis(20);
/// Time for work to end by itself after it is asked to stop.
const STOP_TIMEOUT: Duration = Duration::from_millis(50);
/// Time for the writing of files to end after it is asked to stop.
const FILE_TIMEOUT: Duration = Duration::from_secs(2);
/// Time limit of the last message, whose reader may be blocked.
const LAST_MESSAGE_TIMEOUT: Duration = Duration::from_secs(1);
/// Stack size of a program's main thread on most systems (bytes).
const STACK: usize = 8 << 20;

/// Number of threads that write files, and true if the program is ending, so that no further thread may begin to.
static FILES: Mutex<(u32, bool)> = Mutex::new((0, false));

/// Guard of file writing: while it exists, the program does not end, unless the writing takes too long to stop.
pub struct WriteGuard(());

/// Waits until files may be written, and returns the guard.
pub fn writing() -> WriteGuard {
    loop {
        let mut files = files();
        if !files.1 {
            files.0 += 1;
            return WriteGuard(());
        }
        drop(files);
        // The program is ending.
        thread::park();
    }
}

impl Drop for WriteGuard {
    fn drop(&mut self) {
        files().0 -= 1;
    }
}

fn files() -> MutexGuard<'static, (u32, bool)> {
    FILES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Runs a command's work on a thread of its own and returns its exit code.
///
/// From this call on, the first Ctrl-C, SIGTERM or SIGHUP asks to stop: simulations end with finished files, and work
/// that does not check the flag is abandoned. A second one ends the program. Ignored signals, as by `nohup` or in the
/// background of a script, stay ignored.
pub fn run_watched(work: impl FnOnce() -> u8 + Send + 'static) -> u8 {
    static ONCE: Once = Once::new();
    ONCE.call_once(handle);
    let (done, wait) = channel();
    let builder = thread::Builder::new().stack_size(STACK);
    let working = match builder.spawn(move || done.send(work())) {
        Ok(working) => working,
        Err(source) => return CliError::Thread(source).print(),
    };
    let mut noticed = None;
    let mut is_noted = false;
    loop {
        match wait.recv_timeout(POLL_PERIOD) {
            Ok(code) => return code,
            // The thread panicked and has printed its message.
            Err(RecvTimeoutError::Disconnected) => match working.join() {
                Err(panic) => resume_unwind(panic),
                Ok(_) => return 1,
            },
            Err(RecvTimeoutError::Timeout) if stop_requested() => {
                let waited = noticed.get_or_insert_with(WallInstant::now).elapsed();
                let mut files = files();
                if waited >= STOP_TIMEOUT && (files.0 == 0 || waited >= FILE_TIMEOUT) {
                    files.1 = true;
                    drop(files);
                    return print_interrupted();
                }
                if waited >= STOP_TIMEOUT && !is_noted {
                    is_noted = true;
                    note_second_signal();
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
    }
}

/// Announces that files are being finished, and that a second signal ends the program without it. A blocked reader of the
/// output delays neither.
fn note_second_signal() {
    let note = || say!("note: finishing files; a second Ctrl-C ends at once, without them");
    let _ = thread::Builder::new().spawn(note);
}

/// Reports that the user asked to stop, and returns the exit code. A blocked reader of the output, such as a pager,
/// does not delay it.
fn print_interrupted() -> u8 {
    let (finished, wait) = channel();
    // Without a thread, only the exit code reports it.
    let _ = thread::Builder::new().spawn(move || finished.send(CliError::Interrupted(String::new()).print()));
    wait.recv_timeout(LAST_MESSAGE_TIMEOUT).unwrap_or(130)
}

#[cfg(unix)]
fn handle() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::flag;

    for signal in [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| !is_ignored(*signal)) {
        // The order matters: the flag is false at the first signal and true at the second. Without a handler, a signal
        // ends the program by default.
        let _ = flag::register_conditional_shutdown(signal, 130, STOP.shared())
            .and_then(|_| flag::register(signal, STOP.shared()));
    }
}

#[cfg(unix)]
#[expect(unsafe_code, reason = "no crate tells what a signal does without changing it")]
fn is_ignored(signal: libc::c_int) -> bool {
    let mut present = std::mem::MaybeUninit::<libc::sigaction>::zeroed();
    // SAFETY: no new action is given; the present one is written to separate memory, of which zeros are a valid value.
    unsafe {
        libc::sigaction(signal, std::ptr::null(), present.as_mut_ptr()) == 0
            && present.assume_init().sa_sigaction == libc::SIG_IGN
    }
}

// Elsewhere, as in a browser, nothing signals.
#[cfg(not(any(unix, windows)))]
fn handle() {}

#[cfg(windows)]
fn handle() {
    let _ = ctrlc::try_set_handler(|| {
        if STOP.request() {
            std::process::exit(130);
        }
    });
}

/// Asks the program to stop, as Ctrl-C does.
#[cfg(feature = "live")]
pub fn request_stop() {
    STOP.request();
}

/// Returns true if the user asked to stop.
pub fn stop_requested() -> bool {
    STOP.is_requested()
}

/// Returns the record that ends a simulation when the user asks to stop.
pub fn stop_flag() -> StopFlag {
    STOP.clone()
}

/// Returns the error of a run that was not started because of the interruption.
pub fn interrupted() -> SimulationError {
    RecordError::Interrupted.into()
}
