//! Paths and opening of the files that a scenario names: regular files of limited size, texts without the mark of their encoding.

use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read, Take};
use std::path::Path;

use crate::read_files;

/// Largest size of a file (bytes): a full matrix of the largest order takes half of it.
const LONGEST: u64 = 256 << 20;
/// Mark with which some programs begin a text in UTF-8.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Makes the path of a file absolute, relative to `directory`.
pub fn locate(file: &mut String, directory: &Path) {
    if let Ok(path) = std::path::absolute(directory.join(&*file)) {
        *file = path.to_string_lossy().into_owned();
    }
}

/// Opens a file.
#[cfg(feature = "matrices")]
pub(crate) fn open(path: &Path) -> Result<File, String> {
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

/// Opens a text for sequential reading, limited to the largest size.
pub(crate) fn open_text(path: &Path) -> Result<BufReader<Take<File>>, String> {
    open_text_up_to(path, LONGEST)
}

/// Opens a text for sequential reading, limited to `longest` bytes, behind its byte order mark if it has one.
///
/// # Errors
/// A file that cannot be read, is too large, or is no text in UTF-8.
pub fn open_text_up_to(path: &Path, longest: u64) -> Result<BufReader<Take<File>>, String> {
    let mut text = BufReader::new(open_up_to(path, longest)?.take(longest));
    let start = text.fill_buf().map_err(|error| error.to_string())?;
    if start.starts_with(b"\xff\xfe") || start.starts_with(b"\xfe\xff") {
        return Err("is text in UTF-16: save it as UTF-8".to_owned());
    }
    let mark = if start.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 };
    text.consume(mark);
    Ok(text)
}

/// Reads a whole text of at most `longest` bytes, in which what is no UTF-8 is replaced.
///
/// # Errors
/// A file that cannot be read, is too large, or is in UTF-16.
pub fn read_text_up_to(path: &Path, longest: u64) -> Result<String, String> {
    let mut bytes = Vec::new();
    open_text_up_to(path, longest)?.read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_begin_behind_their_byte_order_mark() {
        let path = std::env::temp_dir().join(format!("flexsc-text-{}", std::process::id()));
        let read = |bytes: &[u8]| {
            fs::write(&path, bytes).expect("a file");
            read_text_up_to(&path, 100)
        };
        assert_eq!(read(b"\xef\xbb\xbft,x\r\n").as_deref(), Ok("t,x\r\n"));
        assert_eq!(read(b"").as_deref(), Ok(""));
        assert_eq!(read(b"\xef\xbb").as_deref(), Ok("\u{fffd}"));
        assert!(read(b"\xff\xfet\0").is_err_and(|why| why.contains("UTF-16")));
        fs::remove_file(&path).expect("a file");
    }
}
