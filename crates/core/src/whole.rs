//! Files that are whole or not there.

use std::path::Path;
use std::{fs, io};

/// Writes a file; one that cannot be written to its end is removed. A device stays.
pub fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    fs::write(path, bytes).inspect_err(|_| {
        if path.is_file() {
            discard(path);
        }
    })
}

/// Removes a file that is of no use. That it cannot be removed is no news beside why it is of no use.
pub fn discard(path: &Path) {
    let _ = fs::remove_file(path);
}
