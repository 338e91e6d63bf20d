//! Target of `-o`, by one rule for every command: a path with a file extension is a file, any other one a directory.

use std::fs;
use std::path::{Path, PathBuf};

use flexsc_core::formats::read_files::read_files;

use crate::error::CliError;

/// File extensions that flexsc or other programs write, and with which no directory is expected to be named.
const ENDINGS: [&str; 27] = [
    "aem", "bin", "bmp", "csv", "eps", "fmu", "gif", "glb", "htm", "html", "jpeg", "jpg", "json", "jsonl",
    "mcap", "md", "oem", "parquet", "partial", "pdf", "png", "ps", "svg", "tif", "tiff", "toml", "webp",
];

/// Target of results.
#[derive(Debug, PartialEq)]
pub enum Out {
    /// A file, and its extension of the accepted ones.
    File(PathBuf, &'static str),
    /// A directory, in which the command chooses the file names.
    Directory(PathBuf),
}

impl Out {
    /// Returns the target of a path, a file with an accepted extension or a directory; `inputs` are files that are
    /// read.
    ///
    /// # Errors
    /// A file with another extension, or one that is an input.
    pub fn new(path: &Path, accepted: &[&'static str], inputs: &[&Path]) -> Result<Self, CliError> {
        match for_path(path, accepted, inputs)? {
            Some(ending) => Ok(Self::File(path.to_owned(), ending)),
            None => Ok(Self::Directory(path.to_owned())),
        }
    }
}

/// Returns the extension of a path that must be a file with an accepted one; `inputs` are files that are read.
///
/// # Errors
/// A file with another extension or none, or one that is an input.
pub fn file(path: &Path, accepted: &[&'static str], inputs: &[&Path]) -> Result<&'static str, CliError> {
    match for_path(path, accepted, inputs)? {
        Some(ending) => Ok(ending),
        None => Err(CliError::Arguments(format!("-o {}: must end in {}", path.display(), listed(accepted)))),
    }
}

/// Returns the accepted extension of a file; `None` for a directory.
fn for_path(
    path: &Path,
    accepted: &[&'static str],
    inputs: &[&Path],
) -> Result<Option<&'static str>, CliError> {
    if let Some(input) = inputs.iter().find(|input| is_same(path, input)) {
        return Err(lost(path, input));
    }
    refuse_read(path)?;
    accepted_ending(path, accepted)
        .map_err(|why| CliError::Arguments(format!("-o {}: {why}", path.display())))
}

/// Returns the extension of a path among the accepted ones; `None` for a directory.
///
/// # Errors
/// Another extension of a file.
pub fn accepted_ending(path: &Path, accepted: &[&'static str]) -> Result<Option<&'static str>, String> {
    if path.is_dir() {
        return Ok(None);
    }
    if fs::metadata(path).is_ok_and(|metadata| !metadata.is_file()) {
        // Devices and pipes may have any name.
        return Ok(accepted.first().copied());
    }
    let Some(ending) = ending(path) else { return Ok(None) };
    match accepted.iter().find(|accepted| **accepted == ending) {
        Some(accepted) => Ok(Some(accepted)),
        None => Err(format!(
            "cannot be written as .{ending}\n\nhint: give a file that ends in {}, or a directory",
            listed(accepted)
        )),
    }
}

/// Returns an error if a scenario, or a file that a scenario names, was read at a path.
pub fn refuse_read(path: &Path) -> Result<(), CliError> {
    match read_files().iter().find(|read| is_same(path, read)) {
        Some(read) => Err(lost(path, read)),
        None => Ok(()),
    }
}

/// Returns the error of results in the place of an input.
fn lost(path: &Path, input: &Path) -> CliError {
    let (path, input) = (path.display(), input.display());
    CliError::Arguments(format!("-o {path}: is the input {input}, which would be lost"))
}

/// Returns the file extension of a path, or `None` for a directory.
pub fn ending(path: &Path) -> Option<&'static str> {
    let ending = path.extension()?.to_str()?.to_ascii_lowercase();
    ENDINGS.into_iter().find(|known| *known == ending)
}

fn listed(endings: &[&str]) -> String {
    let all: Vec<String> = endings.iter().map(|ending| format!(".{ending}")).collect();
    match all.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => all.concat(),
    }
}

/// Returns true if two paths denote the same file, also by symbolic or hard links.
#[cfg(unix)]
fn is_same(one: &Path, other: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let file = |path: &Path| fs::metadata(path).ok().filter(fs::Metadata::is_file);
    let identity = |path: &Path| file(path).map(|file| (file.dev(), file.ino()));
    identity(one).is_some_and(|one| identity(other) == Some(one))
}

#[cfg(not(unix))]
fn is_same(one: &Path, other: &Path) -> bool {
    let whole = |path: &Path| fs::canonicalize(path).ok().filter(|path| path.is_file());
    whole(one).is_some_and(|one| whole(other) == Some(one))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_decide() {
        let out_for =
            |path: &str| Out::new(path.as_ref(), &["svg", "csv"], &[]).map_err(|why| why.to_string());
        assert_eq!(out_for("a/b.CSV"), Ok(Out::File("a/b.CSV".into(), "csv")));
        for directory in ["figures", "v1.2", "a.d/b", "x.svg.d", ".svg"] {
            assert_eq!(out_for(directory), Ok(Out::Directory(directory.into())), "{directory}");
        }
        let refused = out_for("x.mcap").expect_err("another ending");
        assert!(refused.contains(".mcap") && refused.contains("ends in .svg or .csv"), "{refused}");
        let refused = file("x".as_ref(), &["json"], &[]).expect_err("none").to_string();
        assert_eq!(refused, "-o x: must end in .json");
    }
}
