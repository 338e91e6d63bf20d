//! Distribution of a campaign's runs to the workers of a Dask scheduler, by the Python package of flexsc.

use std::ffi::OsString;
use std::io;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::error::CliError;
use crate::stop;

/// Intended duration of a task (s): much longer than the scheduler's overhead.
pub const TASK_S: f64 = 1.0;

/// Exit code of the Python process for an address that is none.
const WRONG_ADDRESS: i32 = 2;
/// Polling period for the end of the Python process.
const POLL_PERIOD: Duration = Duration::from_millis(20);
/// Longest time for the Python process to end after it is asked to.
const STOP_TIMEOUT: Duration = Duration::from_millis(1500);

/// Makes the missing runs of a directory that all workers can reach, and waits for them.
pub fn make(directory: &Path, address: &str) -> Result<(), CliError> {
    // The command of the Python wheel names its interpreter.
    let python = std::env::var_os("FLEXSC_PYTHON").unwrap_or_else(|| OsString::from("python3"));
    let reported = python.to_string_lossy().into_owned();
    let mut command = Command::new(&python);
    command.args(["-m", "flexsc.dask", "--until-stdin-closes", address]).arg(directory);
    // The process ends when its stdin is closed, which the death of this process does too.
    let status = command.stdin(Stdio::piped()).spawn().and_then(ended);
    let why = match status {
        Ok(status) if status.success() => return Ok(()),
        Ok(_) if stop::stop_requested() => return Err(CliError::Interrupted(String::new())),
        Ok(status) if has_dask(&python) => {
            let why = format!("--scheduler {address}: `{reported} -m flexsc.dask` ended with {status}");
            let is_address = status.code() == Some(WRONG_ADDRESS);
            return Err(if is_address { CliError::Arguments(why) } else { CliError::Scheduler(why) });
        }
        Ok(_) => format!("`{reported}` has no `flexsc[dask]`"),
        Err(error) if error.kind() == io::ErrorKind::NotFound => format!("there is no `{reported}`"),
        Err(error) => format!("`{reported}` cannot be started: {error}"),
    };
    let hint = "hint: it needs Python with `pip install flexsc[dask]`; FLEXSC_PYTHON names another Python";
    Err(CliError::Arguments(format!("--scheduler {address}: {why}\n\n{hint}")))
}

/// Returns true if a Python has what the workers of a scheduler need.
fn has_dask(python: &OsString) -> bool {
    let mut command = Command::new(python);
    command.args(["-c", "import distributed, flexsc.dask"]);
    let tried = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status();
    tried.is_ok_and(|status| status.success())
}

/// Waits for the end of the Python process, or ends it when the user asks to stop.
fn ended(mut child: Child) -> io::Result<ExitStatus> {
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(status);
        }
        if stop::stop_requested() {
            drop(child.stdin.take());
            let started = Instant::now();
            while started.elapsed() < STOP_TIMEOUT {
                if let Some(status) = child.try_wait()? {
                    return Ok(status);
                }
                thread::sleep(POLL_PERIOD);
            }
            child.kill()?;
            return child.wait();
        }
        thread::sleep(POLL_PERIOD);
    }
}
