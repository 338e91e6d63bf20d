//! Directory for the files of a command while it runs.

use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};
use std::{env, fs, process};

use crate::error::CliError;

/// Directory that is removed with its files at the end.
pub struct ScratchDirectory(PathBuf);

impl ScratchDirectory {
    /// Creates the directory among the temporary files of the system.
    pub fn new() -> Result<Self, CliError> {
        let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos());
        let path = env::temp_dir().join(format!("flexsc-report-{}-{now}", process::id()));
        fs::create_dir(&path).map_err(CliError::write(&path))?;
        Ok(Self(path))
    }

    /// Returns the path of the directory.
    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for ScratchDirectory {
    fn drop(&mut self) {
        // What cannot be removed stays among the temporary files.
        let _ = fs::remove_dir_all(&self.0);
    }
}
