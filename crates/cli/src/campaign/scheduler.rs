//! A campaign's runs on the workers of a Dask scheduler, by the Python package of flexsc.

use std::ffi::OsString;
use std::io;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::failure::Failure;
use crate::stop;

/// A task takes about so long (s): much more than a scheduler needs to hand it out.
pub const TASK_S: f64 = 1.0;

/// How often it is looked whether Python has ended.
const LOOK: Duration = Duration::from_millis(20);
/// How long it may take to end once it is asked to.
const PATIENCE: Duration = Duration::from_millis(1500);

/// Makes what is missing in a directory, which all workers reach, and waits for it.
pub fn make(directory: &Path, address: &str) -> Result<(), Failure> {
    // The wheel's own command says which Python it is of.
    let python = std::env::var_os("FLEXSC_PYTHON").unwrap_or_else(|| OsString::from("python3"));
    let told = python.to_string_lossy().into_owned();
    let mut command = Command::new(&python);
    command.args(["-m", "flexsc.dask", "--until-stdin-closes", address]).arg(directory);
    // It ends when its stdin is closed, as it is by the death of this process too.
    let status = command.stdin(Stdio::piped()).spawn().and_then(ended);
    let why = match status {
        Ok(status) if status.success() => return Ok(()),
        Ok(_) if stop::asked() => return Err(Failure::Interrupted(String::new())),
        Ok(status) => format!("`{told} -m flexsc.dask` ended with {status}"),
        Err(error) if error.kind() == io::ErrorKind::NotFound => format!("there is no `{told}`"),
        Err(error) => format!("`{told}` cannot be started: {error}"),
    };
    let hint = "hint: it needs Python with `pip install flexsc[dask]`; FLEXSC_PYTHON names another Python";
    Err(Failure::Arguments(format!("--scheduler {address}: {why}\n\n{hint}")))
}

/// Waits for the end of Python, or ends it when the user asks to stop.
fn ended(mut child: Child) -> io::Result<ExitStatus> {
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(status);
        }
        if stop::asked() {
            drop(child.stdin.take());
            let asked = Instant::now();
            while asked.elapsed() < PATIENCE {
                if let Some(status) = child.try_wait()? {
                    return Ok(status);
                }
                thread::sleep(LOOK);
            }
            child.kill()?;
            return child.wait();
        }
        thread::sleep(LOOK);
    }
}
