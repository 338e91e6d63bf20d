//! Parquet files in a build without them: each is refused with what has them.

use std::io;
use std::path::Path;

use super::rows::{ColumnCells, Rows};

const WHY: &str = "Parquet files need the feature `parquet`, which this build left out\n\n\
                   hint: `cargo build --release --features full` has it, and `--table csv` needs none";

fn left_out() -> io::Error {
    io::Error::new(io::ErrorKind::Unsupported, WHY)
}

/// Whether this build reads and writes Parquet files.
///
/// # Errors
/// It does not, and what does.
pub fn parquet_is_built_in() -> io::Result<()> {
    Err(left_out())
}

/// The file, with notes about it by their names.
pub fn encode(_: &Rows, _: &[(&str, String)]) -> io::Result<Vec<u8>> {
    Err(left_out())
}

/// A file that is read.
pub struct Reading(());

#[expect(clippy::unused_self, reason = "the methods are those of a build with Parquet")]
impl Reading {
    /// Opens a file.
    pub fn open(_: &Path, _: bool) -> io::Result<Self> {
        Err(left_out())
    }

    /// A note about it.
    pub fn note(&self, _: &str) -> Option<String> {
        None
    }

    /// How many rows there are.
    pub fn rows(&self) -> u64 {
        0
    }

    /// A column.
    pub fn column(&self, _: &str) -> io::Result<Option<ColumnCells>> {
        Err(left_out())
    }
}
