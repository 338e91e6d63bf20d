//! Opening of files of structures: regular files of limited size.

use std::fs::{self, File};
use std::io::{BufReader, Read, Take};
use std::path::Path;

use crate::read_files;

/// Largest size of a file (bytes): a full matrix of the largest order takes half of it.
const LONGEST: u64 = 256 << 20;

/// Opens a file.
pub fn open(path: &Path) -> Result<File, String> {
    open_up_to(path, LONGEST)
}

fn open_up_to(path: &Path, longest: u64) -> Result<File, String> {
    let reported = |error: std::io::Error| error.to_string();
    // A pipe or a device may never end, and opening a pipe may block.
    let metadata = fs::metadata(path).map_err(reported)?;
    if !metadata.is_file() {
        return Err("not a file".to_owned());
    }
    if metadata.len() > longest {
        return Err(format!("must have at most {longest} bytes, got {}", metadata.len()));
    }
    let file = File::open(path).map_err(reported)?;
    read_files::add(path);
    Ok(file)
}

/// Opens a file for sequential reading, limited to the largest size.
pub fn open_text(path: &Path) -> Result<BufReader<Take<File>>, String> {
    Ok(BufReader::new(open(path)?.take(LONGEST)))
}

/// Opens a file for sequential reading, limited to `longest` bytes.
pub fn open_text_up_to(path: &Path, longest: u64) -> Result<BufReader<Take<File>>, String> {
    Ok(BufReader::new(open_up_to(path, longest)?.take(longest)))
}
