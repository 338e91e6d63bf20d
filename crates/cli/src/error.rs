//! Errors of the command, and their exit codes.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use anstyle::{AnsiColor, Style};
use flexsc_core::formats::count::counted;
use flexsc_core::formats::document::ConfigError;
use flexsc_core::record::atomic_file::is_busy;
use flexsc_core::record::{LogError, RecordError};
use flexsc_core::worst_case::WorstCaseFault;
use flexsc_core::{ScenarioError, SimulationError};
use thiserror::Error;

/// Error of the command.
#[derive(Debug, Error)]
pub enum CliError {
    /// Invalid scenario.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// Invalid scenarios whose errors have been printed.
    #[error("not every scenario is accepted")]
    Told,
    /// Arguments that contradict each other.
    #[error("{0}")]
    Arguments(String),
    /// Invalid log.
    #[error(transparent)]
    Log(#[from] LogError),
    /// Failed run.
    #[error("{name}: {source}")]
    Run { name: String, source: SimulationError },
    /// Campaign with failed runs.
    #[error("{failed} of {} failed; the first: run {number}: {why}", counted(runs, "run"))]
    Runs { failed: u64, runs: u64, number: u64, why: String },
    /// Failed run that ended its campaign.
    #[error("run {number} failed, and --fail-fast stops there: {why}")]
    First { number: u64, why: String },
    /// File that could not be written.
    #[error("cannot write {}: {source}", path.display())]
    Write { path: PathBuf, source: io::Error },
    /// Live run that cannot be served.
    #[cfg(feature = "live")]
    #[error("cannot serve at {address}: {source}{}", hint(source))]
    Serve { address: String, source: io::Error },
    /// Server of a run in lockstep that cannot be reached.
    #[error("cannot serve at {address}: {source}{}", other_port(source))]
    Bind { address: String, source: io::Error },
    /// Run in lockstep that its client ended.
    #[error("{0}")]
    Lockstep(String),
    /// Scheduler of a campaign that is lost or failed.
    #[error("{0}")]
    Scheduler(String),
    /// Figure that could not be drawn.
    #[error("cannot draw {}: {why}", path.display())]
    Draw { path: PathBuf, why: String },
    /// Page that could not be filled.
    #[cfg(feature = "papers")]
    #[error("{0}")]
    Page(String),
    /// Changed verdicts of the papers' page.
    #[cfg(feature = "papers")]
    #[error("{} not as expected: {}", if .0.len() == 1 { "a verdict is" } else { "verdicts are" }, .0.join("; "))]
    Verdicts(Vec<String>),
    /// Closed stdout.
    #[error("cannot write to stdout: {0}")]
    Stdout(io::Error),
    /// File that another process is writing.
    #[error(
        "cannot write {}: another process is writing it\n\nhint: wait until it has ended, or give another path with -o",
        path.display()
    )]
    Busy { path: PathBuf },
    /// Thread that could not be started.
    #[error("cannot start a thread: {0}")]
    Thread(io::Error),
    /// Stopped campaign whose completed rows are kept.
    #[error("{failure}; {} holds the runs before", path.display())]
    Kept { failure: Box<CliError>, path: PathBuf },
    /// Requirements that are not met.
    #[error("{0}")]
    Requirements(String),
    /// Run whose motion diverges.
    #[error("{0}")]
    Diverged(String),
    /// Campaign with missing runs.
    #[error("{0}")]
    Incomplete(String),
    /// Claims about outputs that are violated or not decided.
    #[error("{failed} of {} not proved", counted(*claims as u64, "claim"))]
    Claims { failed: usize, claims: usize },
    /// Interruption by the user.
    #[error("interrupted{0}")]
    Interrupted(String),
}

/// Reason why a file must not be replaced.
#[derive(Debug, Error)]
#[error("{0}")]
pub struct NotReplaced(pub String);

impl From<NotReplaced> for io::Error {
    fn from(refused: NotReplaced) -> Self {
        Self::new(io::ErrorKind::AlreadyExists, refused)
    }
}

impl CliError {
    /// Returns the error of a run with this name: that it was interrupted, or why it failed.
    pub fn run(name: &str, source: SimulationError) -> Self {
        match source {
            SimulationError::Record(RecordError::Interrupted) => Self::Interrupted(String::new()),
            source => Self::Run { name: name.to_owned(), source },
        }
    }

    /// Returns the error of a search for the worst case of a scenario.
    pub fn worst_case(scenario: &str, fault: WorstCaseFault) -> Self {
        match fault {
            WorstCaseFault::Key(ConfigError { key, why, .. }) => {
                ScenarioError::Key { origin: scenario.to_owned(), key, why }.into()
            }
            WorstCaseFault::Scenario(error) => error.into(),
            WorstCaseFault::Request(why) => Self::Arguments(format!("{scenario}: {why}")),
            WorstCaseFault::Interrupted => Self::Interrupted(String::new()),
        }
    }

    /// Returns the conversion of an I/O error to a failure to write `path`.
    pub fn write(path: &Path) -> impl FnOnce(io::Error) -> Self + '_ {
        move |source| {
            let path = path.to_owned();
            if is_busy(&source) {
                return Self::Busy { path };
            }
            match source.downcast() {
                Ok(NotReplaced(why)) => Self::Arguments(why),
                Err(source) => Self::Write { path, source },
            }
        }
    }

    /// Prints the error, and returns the exit code.
    pub fn print(&self) -> u8 {
        // A reader that stops early, such as `head`, is not an error.
        if let Self::Stdout(error) = self
            && error.kind() == io::ErrorKind::BrokenPipe
        {
            return 0;
        }
        if matches!(self, Self::Told) {
            return self.code();
        }
        // Only terminals that support colours get them, and not if NO_COLOR is set.
        let _ = anstream::stderr()
            .lock()
            .write_all(coloured(&for_terminal(&without_zeros(&self.to_string()))).as_bytes());
        self.code()
    }

    fn code(&self) -> u8 {
        match self {
            Self::Kept { failure, .. } => failure.code(),
            Self::Scenario(_) | Self::Told | Self::Arguments(_) | Self::Log(_) | Self::Busy { .. } => 2,
            Self::Requirements(_) | Self::Claims { .. } => 3,
            Self::Interrupted(_) => 130,
            _ => 1,
        }
    }
}

/// Longest run of zeros in a number of a message.
const MOST_ZEROS: usize = 24;

/// Replaces numbers with many zeros by their exponential form: quoted input may be as large or small as doubles can be.
/// Quoted lines of a scenario, behind a bar, stay unchanged.
pub fn without_zeros(text: &str) -> String {
    let is_shown = |line: &str| {
        line.split_once('|').is_some_and(|(before, _)| before.chars().all(|c| c.is_ascii_digit() || c == ' '))
    };
    let lines = text.split_inclusive('\n');
    lines.map(|line| if is_shown(line) { line.to_owned() } else { shortened(line) }).collect()
}

fn shortened(text: &str) -> String {
    let mut all = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let (before, number) = rest.split_at(start);
        all.push_str(before);
        let end = number.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(number.len());
        let (number, after) = number.split_at(end);
        let zeros = "0".repeat(MOST_ZEROS);
        match number.parse::<f64>() {
            Ok(value) if number.contains(&zeros) && !before.ends_with(|c: char| c.is_alphanumeric()) => {
                let _ = write!(all, "{value:e}");
            }
            _ => all.push_str(number),
        }
        rest = after;
    }
    all + rest
}

/// Returns a hint on how to avoid an address that is in use.
#[cfg(feature = "live")]
fn hint(error: &io::Error) -> &'static str {
    if error.kind() == io::ErrorKind::AddrInUse {
        "\n\nhint: another run may be live there; --live=127.0.0.1:0 uses any free port"
    } else {
        ""
    }
}

/// Returns a hint on how to avoid a port that is in use.
fn other_port(error: &io::Error) -> &'static str {
    if error.kind() == io::ErrorKind::AddrInUse {
        "\n\nhint: another run may be served there; --bind 127.0.0.1:0 uses any free port"
    } else {
        ""
    }
}

/// Longest line of a message (characters); quotations may be longer.
const LONGEST_LINE: usize = 4000;

/// Prepares a message for terminals: shortens long lines in the middle and escapes control characters.
pub fn for_terminal(text: &str) -> String {
    let mut all = String::new();
    for (index, line) in text.split('\n').enumerate() {
        if index > 0 {
            all.push('\n');
        }
        let cut = line.chars().count().saturating_sub(LONGEST_LINE);
        for (place, c) in line.chars().enumerate() {
            let middle = LONGEST_LINE / 2..LONGEST_LINE / 2 + cut;
            if cut > 0 && place == middle.start {
                let _ = write!(all, "[{cut} characters]");
            }
            match c {
                _ if middle.contains(&place) => {}
                c if c.is_control() && c != '\t' => all.extend(c.escape_default()),
                c => all.push(c),
            }
        }
    }
    all
}

/// Returns a text of TOML whose control characters, which TOML does not allow as such, are escaped as in its strings.
pub fn without_controls(text: &str) -> String {
    let mut all = String::with_capacity(text.len());
    let mut characters = text.chars().peekable();
    while let Some(c) = characters.next() {
        let is_line_end = c == '\r' && characters.peek() == Some(&'\n');
        if c.is_control() && !matches!(c, '\t' | '\n') && !is_line_end {
            let _ = write!(all, "\\u{:04X}", u32::from(c));
        } else {
            all.push(c);
        }
    }
    all
}

/// Returns an error message with its first word and those of its hints in colours.
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

#[cfg(test)]
mod tests {
    use super::{LONGEST_LINE, for_terminal, without_controls, without_zeros};

    #[test]
    fn control_characters_are_escaped_as_toml_does() {
        let text = "name = \"a\"\r\n\tb = 1 # é\n";
        assert_eq!(without_controls(text), text);
        assert_eq!(
            without_controls("a\u{1b}[2J\rb\u{9b}\u{7f}\0"),
            "a\\u001B[2J\\u000Db\\u009B\\u007F\\u0000"
        );
    }

    #[test]
    fn numbers_of_many_zeros_have_an_exponent() {
        let (large, small) = (1e300, 1e-300);
        assert_eq!(
            without_zeros(&format!("got {large}, {small}; 10 of 1000000")),
            "got 1e300, 1e-300; 10 of 1000000"
        );
        assert_eq!(
            without_zeros("a00000000000000000000000000.toml: 1.5"),
            "a00000000000000000000000000.toml: 1.5"
        );
    }

    #[test]
    fn messages_can_be_shown() {
        assert_eq!(for_terminal("a\tb\nhint: c\u{e9}"), "a\tb\nhint: c\u{e9}");
        assert_eq!(for_terminal("a\u{1b}[31m\r\n\u{9b}b\0"), "a\\u{1b}[31m\\r\n\\u{9b}b\\u{0}");
        let (half, whole) = (LONGEST_LINE / 2, "x".repeat(LONGEST_LINE));
        let long = format!("{whole}\n{}{}", "a".repeat(half), "\u{e9}".repeat(half + 1));
        let cut = format!("{whole}\n{}[1 characters]{}", "a".repeat(half), "\u{e9}".repeat(half));
        assert_eq!(for_terminal(&long), cut);
    }
}
