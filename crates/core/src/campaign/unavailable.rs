//! Stand-in for Parquet files in a build without them: each call fails with the name of a build that has them.

use std::io;
use std::path::Path;

use super::rows::{ColumnCells, RunRows};

const WHY: &str = "Parquet files need the feature `parquet`, which this build left out\n\n\
                   hint: `cargo build --release --features full` has it, and `--table csv` needs none";

fn unavailable() -> io::Error {
    io::Error::new(io::ErrorKind::Unsupported, WHY)
}

/// Checks that this build reads and writes Parquet files.
///
/// # Errors
/// Always: this build does not, and the message names those that do.
pub fn parquet_is_built_in() -> io::Result<()> {
    Err(unavailable())
}

/// Returns the content of a file with these rows and metadata.
pub fn encode(_: &RunRows, _: &[(&str, String)]) -> io::Result<Vec<u8>> {
    Err(unavailable())
}

/// Parquet file that is read.
pub struct ParquetFile(());

#[expect(clippy::unused_self, reason = "the methods are those of a build with Parquet")]
impl ParquetFile {
    /// Opens a file.
    pub fn open(_: &Path, _: bool) -> io::Result<Self> {
        Err(unavailable())
    }

    /// Returns a value of the metadata.
    pub fn metadata(&self, _: &str) -> Option<String> {
        None
    }

    /// Returns the number of rows.
    pub fn rows(&self) -> u64 {
        0
    }

    /// Returns a column.
    pub fn column(&self, _: &str) -> io::Result<Option<ColumnCells>> {
        Err(unavailable())
    }
}
