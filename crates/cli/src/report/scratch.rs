//! Directory for the files of a command while it runs.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};
use std::{env, process};

use flexsc_core::record::atomic_file;

use crate::error::CliError;

/// Start of the names of such directories.
const NAME: &str = "flexsc-report-";
/// Name of the file that the process of a directory has locked.
const LOCK: &str = ".lock";

/// Directory that is removed with its files at the end.
pub struct ScratchDirectory {
    path: PathBuf,
    /// Lock that ends with this process, by which others know that the directory is in use.
    _lock: File,
}

impl ScratchDirectory {
    /// Creates the directory among the temporary files of the system, and removes those of processes that were killed.
    pub fn new() -> Result<Self, CliError> {
        let within = env::temp_dir();
        remove_abandoned(&within);
        let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos());
        let path = within.join(format!("{NAME}{}-{now}", process::id()));
        fs::create_dir(&path).map_err(CliError::write(&path))?;
        // The lock has its name once it is held.
        let unnamed = path.join("lock");
        let lock = File::create_new(&unnamed).map_err(CliError::write(&path))?;
        if lock.try_lock().is_ok() {
            fs::rename(&unnamed, path.join(LOCK)).map_err(CliError::write(&path))?;
        }
        Ok(Self { path, _lock: lock })
    }

    /// Returns the path of the directory.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for ScratchDirectory {
    fn drop(&mut self) {
        // What cannot be removed stays among the temporary files.
        let _ = fs::remove_dir_all(&self.path);
    }
}

/// Removes the directories of processes that have ended without removing them: their locks are free.
fn remove_abandoned(within: &Path) {
    for entry in fs::read_dir(within).into_iter().flatten().flatten() {
        let is_directory = entry.file_type().is_ok_and(|kind| kind.is_dir());
        if is_directory && entry.file_name().to_string_lossy().starts_with(NAME) {
            let path = entry.path();
            let lock = atomic_file::open(&path.join(LOCK));
            if lock.is_ok_and(|lock| lock.try_lock().is_ok()) {
                // That of another user stays.
                let _ = fs::remove_dir_all(&path);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn abandoned_directories_are_removed_and_those_in_use_stay() {
        let within = tempfile::tempdir().expect("a directory");
        let make = |name: &str| {
            let path = within.path().join(name);
            fs::create_dir(&path).expect("made");
            (path.clone(), File::create_new(path.join(LOCK)).expect("made"))
        };
        let (abandoned, lock) = make("flexsc-report-1-1");
        drop(lock);
        let (used, lock) = make("flexsc-report-2-2");
        lock.try_lock().expect("locked");
        let (other, _) = make("notes");
        fs::create_dir(within.path().join("flexsc-report-mine")).expect("made");
        remove_abandoned(within.path());
        assert!(!abandoned.exists() && used.exists() && other.exists());
        assert!(within.path().join("flexsc-report-mine").exists());
    }
}
