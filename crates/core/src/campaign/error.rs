//! Why the directory of a campaign cannot be used.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::document::ScenarioError;

/// Why a directory cannot be used.
#[derive(Debug, Error)]
pub enum DirectoryError {
    /// It is no campaign, or has a file that is none of it.
    #[error("{}: {why}", path.display())]
    Wrong {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        why: String,
    },
    /// It is of another campaign.
    #[error("{}: contains another campaign ({difference})", path.display())]
    Other {
        /// The manifest there.
        path: PathBuf,
        /// In what they differ.
        difference: String,
    },
    /// Another process is at work there.
    #[error("{}: another process is working in it", path.display())]
    Busy {
        /// The directory.
        path: PathBuf,
    },
    /// A file cannot be written.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// Its scenario is not accepted.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The work was stopped.
    #[error("interrupted")]
    Interrupted,
}

/// A file that is not what it should be.
pub(super) fn wrong(path: &Path, why: impl Into<String>) -> DirectoryError {
    DirectoryError::Wrong { path: path.to_owned(), why: why.into() }
}

/// A file that cannot be read.
pub(super) fn unread(path: &Path) -> impl FnOnce(io::Error) -> DirectoryError + '_ {
    |source| wrong(path, source.to_string())
}

/// A file that cannot be written.
pub(super) fn io_of(path: &Path) -> impl FnOnce(io::Error) -> DirectoryError + '_ {
    |source| match source.kind() {
        io::ErrorKind::InvalidData | io::ErrorKind::Unsupported => wrong(path, source.to_string()),
        _ => DirectoryError::Io { path: path.to_owned(), source },
    }
}
