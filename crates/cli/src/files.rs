//! Files that a command writes at once: whole, under the watch of `stop`, and by one process at a time.

use std::path::{Path, PathBuf};

use flexsc_core::whole;

use crate::failure::Failure;
use crate::stop;

/// Writes a file.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let _writing = stop::writing();
    whole::write(path, bytes).map_err(Failure::write(path))
}

/// Writes files that belong together.
pub fn write_all(files: &[(PathBuf, Vec<u8>)]) -> Result<(), Failure> {
    let _writing = stop::writing();
    whole::write_all(files).map_err(|(path, error)| Failure::write(&path)(error))
}

/// Makes a directory, unless it is there.
pub fn make_directory(path: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(path).map_err(Failure::write(path))
}
