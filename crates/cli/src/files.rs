//! Atomic writing of files: whole, guarded by `stop`, and by one process at a time.

use std::fs;
use std::path::{Path, PathBuf};

use flexsc_core::record::atomic_file;

use crate::error::CliError;
use crate::{out, stop};

/// Writes a file that the user named, creating its directory. A file with other content is replaced only with `force`.
pub fn write(path: &Path, bytes: &[u8], force: bool) -> Result<(), CliError> {
    out::refuse_read(path)?;
    refuse_other(path, bytes, force)?;
    in_new_directories(&[path], || {
        // A pipe waits for its reader, and is no file that is left half written.
        let is_waiting = fs::metadata(path).is_ok_and(|entry| !entry.is_file());
        let _writing = (!is_waiting).then(stop::writing);
        atomic_file::write(path, bytes).map_err(CliError::write(path))
    })
}

/// Returns an error if the file exists with other content, unless `force`: the same command may write it again.
pub fn refuse_other(path: &Path, bytes: &[u8], force: bool) -> Result<(), CliError> {
    let existing = fs::metadata(path).ok().filter(fs::Metadata::is_file);
    let is_other = |metadata: fs::Metadata| {
        metadata.len() != bytes.len() as u64 || fs::read(path).is_ok_and(|content| content != bytes)
    };
    if !force && existing.is_some_and(is_other) {
        return Err(exists(path, "already exists, with other content"));
    }
    Ok(())
}

/// Returns an error if the file exists, unless `force`: checked before long work whose result differs each time.
pub fn refuse_existing(path: &Path, force: bool) -> Result<(), CliError> {
    if force || !fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_file() || metadata.is_symlink())
    {
        return Ok(());
    }
    Err(exists(path, "already exists"))
}

fn exists(path: &Path, why: &str) -> CliError {
    CliError::Arguments(format!("{}: {why}\n\nhint: --force replaces it", path.display()))
}

/// Writes files whose names the command chose into a directory, which is created. Links and pipes of such names are
/// refused.
pub fn write_within(files: &[(PathBuf, Vec<u8>)]) -> Result<(), CliError> {
    let paths: Vec<&Path> = files.iter().map(|(path, _)| &**path).collect();
    in_new_directories(&paths, || {
        for path in &paths {
            out::refuse_read(path)?;
            atomic_file::unlinked(path).map_err(CliError::write(path))?;
        }
        let _writing = stop::writing();
        atomic_file::write_all(files).map_err(|(path, error)| CliError::write(&path)(error))
    })
}

/// Writes files after creating their directories, of which those that are new are removed if the writing fails.
fn in_new_directories(files: &[&Path], write: impl FnOnce() -> Result<(), CliError>) -> Result<(), CliError> {
    let named = |directory: &&Path| !directory.as_os_str().is_empty();
    let parents = files.iter().flat_map(|path| path.ancestors().skip(1).filter(named));
    let mut new: Vec<&Path> = parents.filter(|directory| !directory.exists()).collect();
    // Directories after those that contain them.
    new.sort_unstable();
    new.dedup();
    let written = files.iter().try_for_each(|path| make_parent(path)).and_then(|()| write());
    if written.is_err() {
        for directory in new.iter().rev() {
            // One that holds a file of another process stays.
            let _ = fs::remove_dir(directory);
        }
    }
    written
}

/// Creates a directory if it does not exist.
pub fn make_directory(path: &Path) -> Result<(), CliError> {
    fs::create_dir_all(path).map_err(CliError::write(path))
}

/// Creates the directory of a file if it does not exist.
pub fn make_parent(path: &Path) -> Result<(), CliError> {
    match path.parent().filter(|parent| !parent.as_os_str().is_empty() && !parent.exists()) {
        Some(parent) => make_directory(parent),
        None => Ok(()),
    }
}
