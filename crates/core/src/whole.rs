//! Files that are whole or not there.

use std::path::{Path, PathBuf};
use std::{fs, io};

/// Writes a file: first beside its place, so that what was there stays until the new one is whole. A device is written as it
/// is, and a file that is read-only is refused.
pub fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_by(path, "partial", bytes)
}

/// The same by way of a file with this extension more, for programs that write one file side by side.
pub fn write_by(path: &Path, extension: &str, bytes: &[u8]) -> io::Result<()> {
    match fs::metadata(path) {
        Ok(there) if !there.is_file() => return fs::write(path, bytes),
        Ok(there) if there.permissions().readonly() => return Err(io::ErrorKind::PermissionDenied.into()),
        _ => {}
    }
    // A link stays one.
    let place = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let partial = PathBuf::from(format!("{}.{extension}", place.display()));
    let written = fs::write(&partial, bytes).and_then(|()| fs::rename(&partial, &place));
    written.inspect_err(|_| discard(&partial))
}

/// Removes a file that is of no use. That it cannot be removed is no news beside why it is of no use.
pub fn discard(path: &Path) {
    let _ = fs::remove_file(path);
}
