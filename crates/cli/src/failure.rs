//! What can go wrong, and the exit code that says so.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use anstyle::{AnsiColor, Style};
use flexsc_core::record::LogError;
use flexsc_core::whole::is_busy;
use flexsc_core::{ScenarioError, SimulationError};
use thiserror::Error;

/// Why the command did not do what it was asked.
#[derive(Debug, Error)]
pub enum Failure {
    /// A scenario is not accepted.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The arguments do not fit each other.
    #[error("{0}")]
    Arguments(String),
    /// A log is not accepted.
    #[error(transparent)]
    Log(#[from] LogError),
    /// A run failed.
    #[error("{name}: {source}")]
    Run { name: String, source: SimulationError },
    /// Some runs of a campaign failed.
    #[error("{failed} of {runs} runs failed; the first: run {number}: {why}")]
    Runs { failed: u64, runs: u64, number: u64, why: String },
    /// A file could not be written.
    #[error("cannot write {}: {source}", path.display())]
    Write { path: PathBuf, source: io::Error },
    /// A live run cannot be served.
    #[cfg(feature = "live")]
    #[error("cannot serve at {address}: {source}{}", hint(source))]
    Serve { address: String, source: io::Error },
    /// A figure could not be drawn.
    #[error("cannot draw {}: {why}", path.display())]
    Draw { path: PathBuf, why: String },
    /// A page could not be filled.
    #[error("{0}")]
    Page(String),
    /// What the papers say came out otherwise than it did.
    #[error("{} not as expected: {}", if .0.len() == 1 { "a verdict is" } else { "verdicts are" }, .0.join("; "))]
    Verdicts(Vec<String>),
    /// Stdout is closed.
    #[error("cannot write to stdout: {0}")]
    Stdout(io::Error),
    /// A file is being written by another process.
    #[error(
        "cannot write {}: another process is writing it\n\nhint: wait until that has ended, or give another place with -o",
        path.display()
    )]
    Busy { path: PathBuf },
    /// There is no thread to work on.
    #[error("cannot start a thread: {0}")]
    Thread(io::Error),
    /// The user asked to stop.
    #[error("interrupted{0}")]
    Interrupted(String),
}

/// Why a file is not replaced.
#[derive(Debug, Error)]
#[error("{0}")]
pub struct Refused(pub String);

impl From<Refused> for io::Error {
    fn from(refused: Refused) -> Self {
        Self::new(io::ErrorKind::AlreadyExists, refused)
    }
}

impl Failure {
    /// A failure to write a file.
    pub fn write(path: &Path) -> impl FnOnce(io::Error) -> Self + '_ {
        move |source| {
            let path = path.to_owned();
            if is_busy(&source) {
                return Self::Busy { path };
            }
            match source.downcast() {
                Ok(Refused(why)) => Self::Arguments(why),
                Err(source) => Self::Write { path, source },
            }
        }
    }

    /// Says what went wrong, and returns the exit code.
    pub fn tell(&self) -> u8 {
        // A reader that has enough, such as `head`, is no failure.
        if let Self::Stdout(error) = self
            && error.kind() == io::ErrorKind::BrokenPipe
        {
            return 0;
        }
        // Colours go to terminals that have them only, and never where NO_COLOR is set.
        let _ = anstream::stderr().lock().write_all(coloured(&self.to_string()).as_bytes());
        match self {
            Self::Log(LogError::Unwritable { source, .. }) if !is_busy(source) => 1,
            Self::Scenario(_) | Self::Arguments(_) | Self::Log(_) | Self::Busy { .. } => 2,
            Self::Interrupted(_) => 130,
            _ => 1,
        }
    }
}

/// What helps where an address is taken.
#[cfg(feature = "live")]
fn hint(error: &io::Error) -> &'static str {
    if error.kind() == io::ErrorKind::AddrInUse {
        "\n\nhint: another run may be live there; --live=127.0.0.1:0 takes any free port"
    } else {
        ""
    }
}

/// What went wrong, with its first word and those of its hints in colours.
fn coloured(text: &str) -> String {
    let (error, hint) = (AnsiColor::Red.on_default().bold(), AnsiColor::Cyan.on_default().bold());
    let word = |word: &str, style: Style| format!("{style}{word}{style:#}");
    let mut all = word("error:", error);
    for (index, line) in text.split('\n').enumerate() {
        let start = if index == 0 { " " } else { "\n" };
        let _ = match line.strip_prefix("hint:") {
            Some(rest) => write!(all, "{start}{}{rest}", word("hint:", hint)),
            None => write!(all, "{start}{line}"),
        };
    }
    all.push('\n');
    all
}
