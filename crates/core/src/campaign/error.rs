//! Errors of a campaign's directory.

use std::io;
use std::path::{Path, PathBuf};

use flexsc_formats::count::counted;
use flexsc_formats::document::ScenarioError;
use thiserror::Error;

/// Error of a campaign's directory.
#[derive(Debug, Error)]
pub enum DirectoryError {
    /// Directory that is no campaign, or has a file that does not belong to it.
    #[error("{}: {why}", path.display())]
    Wrong {
        /// Path of the file.
        path: PathBuf,
        /// Reason.
        why: String,
    },
    /// Directory of another campaign.
    #[error("{}: contains another campaign ({difference})", path.display())]
    Other {
        /// Path of its manifest.
        path: PathBuf,
        /// First difference of the campaigns.
        difference: String,
    },
    /// Directory with runs of this campaign that are not asked for.
    #[error("{}: holds {} of this campaign, and {asked} would replace them", path.display(), counted(*held, "run"))]
    More {
        /// Path of its manifest.
        path: PathBuf,
        /// Number of its runs.
        held: u64,
        /// Number of the runs that are asked for.
        asked: u64,
    },
    /// Directory that another process is writing.
    #[error("{}: another process is working in it", path.display())]
    Busy {
        /// Path of the directory.
        path: PathBuf,
    },
    /// File that cannot be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// Scenario that is not accepted.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// Interruption of the work.
    #[error("interrupted")]
    Interrupted,
}

/// Returns the error of a file with invalid content.
pub(super) fn invalid_file(path: &Path, why: impl Into<String>) -> DirectoryError {
    DirectoryError::Wrong { path: path.to_owned(), why: why.into() }
}

/// Returns the error of a file that cannot be read.
pub(super) fn unreadable(path: &Path) -> impl FnOnce(io::Error) -> DirectoryError + '_ {
    |source| invalid_file(path, source.to_string())
}

/// Returns the error of a file that cannot be written.
pub(super) fn io_error(path: &Path) -> impl FnOnce(io::Error) -> DirectoryError + '_ {
    |source| match source.kind() {
        io::ErrorKind::InvalidData | io::ErrorKind::Unsupported => invalid_file(path, source.to_string()),
        _ => DirectoryError::Io { path: path.to_owned(), source },
    }
}
