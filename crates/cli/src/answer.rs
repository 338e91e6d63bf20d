//! First screen of a run: the answer, with the log and where to look next.

use std::io::Write;
use std::path::Path;

use anstyle::{AnsiColor, Style};
use flexsc_core::Scenario;
use flexsc_core::answer::{Answer, Observed, RunVerdict, ScreenOptions, ScreenStyle};
use flexsc_core::metrics::Metrics;

use crate::error::CliError;
use crate::human::{Units, UnitsArgs};
use crate::requirements;
use crate::say;

/// Narrowest screen that is respected.
const NARROW: usize = 40;

/// Options of verbs that answer for a run.
#[derive(clap::Args, Copy, Clone, Default)]
#[command(next_help_heading = "Answer")]
#[group(skip)]
pub struct AnswerArgs {
    #[command(flatten)]
    pub units: UnitsArgs,
    /// Print everything that is known of the run, not only the first screen
    #[arg(long)]
    pub all: bool,
    /// Exit with 3 also if all requirements are met, but target, filter or loop is lost in a run
    #[arg(long)]
    pub strict: bool,
}

impl AnswerArgs {
    /// Returns the options of a verb that has only units.
    pub fn from_units(units: Units) -> Self {
        Self { units: UnitsArgs { units }, ..Self::default() }
    }

    /// Returns the answer of a run.
    pub fn answer(self, scenario: &Scenario, metrics: &Metrics, observed: Option<&Observed>) -> Answer {
        Answer::new(scenario, metrics, observed, self.units.units.into())
    }

    /// Returns the options of the screen.
    pub fn screen(self) -> ScreenOptions {
        ScreenOptions { width: width(), all: self.all, style: style(), units: self.units.units.into() }
    }

    /// Prints an answer, with its log and its size, if there is one.
    pub fn print(self, answer: &Answer, took: f64, log: Option<(&Path, u64)>) {
        let screen = answer.screen(Some(took), self.screen());
        // Only terminals that support colours get them, and not if NO_COLOR is set.
        let _ = writeln!(anstream::stderr(), "{}", coloured(&screen, answer));
        let (log, plot) = log.map_or_else(Default::default, |(path, bytes)| {
            let path = path.display();
            (format!("log {path}, {}", size(bytes)), format!("flexsc plot {path}"))
        });
        let joined = |texts: &[&str]| {
            let texts: Vec<&str> = texts.iter().copied().filter(|text| !text.is_empty()).collect();
            format!("  {}", texts.join("     "))
        };
        let more = if self.all { "" } else { "more: --all" };
        let line = joined(&[&log, &plot, more]);
        if line.chars().count() > width() {
            say!("{}\n{}", joined(&[&log]), joined(&[&plot, more]));
        } else if !line.trim().is_empty() {
            say!("{line}");
        }
    }

    /// Fails if the run has failed, a requirement is missed, or, if it is strict, a warning is grave.
    pub fn validate(self, answers: &[(String, Answer)]) -> Result<(), CliError> {
        if let Some((name, answer)) = answers.iter().find(|(_, answer)| answer.verdict == RunVerdict::Failed)
        {
            return Err(CliError::Diverged(format!("{name}: {}", without_failed(&answer.verdict_text))));
        }
        requirements::validate_answers(answers)?;
        match answers.iter().find(|(_, answer)| self.strict && answer.verdict == RunVerdict::MetBut) {
            Some((name, answer)) => Err(CliError::Requirements(format!("{name}: {}", answer.verdict_text))),
            None => Ok(()),
        }
    }
}

fn without_failed(text: &str) -> &str {
    text.trim_start_matches("FAILED: ")
}

/// Returns the width of the terminal within bounds.
fn width() -> usize {
    let columns = std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    let widest = ScreenOptions::default().width;
    columns.unwrap_or(widest).clamp(NARROW, widest)
}

/// Returns the characters that the locale has.
pub fn style() -> ScreenStyle {
    let set = |name: &str| std::env::var(name).ok().filter(|value| !value.is_empty());
    let locale = set("LC_ALL").or_else(|| set("LC_CTYPE")).or_else(|| set("LANG"));
    let is_plain = locale.is_some_and(|locale| {
        let locale = locale.to_lowercase();
        !(locale.contains("utf-8") || locale.contains("utf8"))
    });
    if is_plain { ScreenStyle::Ascii } else { ScreenStyle::Unicode }
}

/// Returns a screen with its verdict and its marks in colours.
fn coloured(screen: &str, answer: &Answer) -> String {
    let paint = |text: &str, colour: AnsiColor| {
        let style = Style::new().fg_color(Some(colour.into())).bold();
        format!("{style}{text}{style:#}")
    };
    let colour = match answer.verdict {
        RunVerdict::Failed | RunVerdict::Missed => Some(AnsiColor::Red),
        RunVerdict::MetBut | RunVerdict::GoalMissed => Some(AnsiColor::Yellow),
        RunVerdict::Met => Some(AnsiColor::Green),
        RunVerdict::GoalMet | RunVerdict::NotAsked => None,
    };
    let mut lines: Vec<String> = screen.lines().map(str::to_owned).collect();
    if let (Some(first), Some(colour)) = (lines.first_mut(), colour) {
        *first = first.replacen(&answer.verdict_text, &paint(&answer.verdict_text, colour), 1);
    }
    let marks = [
        ("✓", AnsiColor::Green),
        ("✗", AnsiColor::Red),
        ("!", AnsiColor::Yellow),
        ("ok", AnsiColor::Green),
        ("NO", AnsiColor::Red),
    ];
    for line in &mut lines {
        if let Some((mark, colour)) = marks.iter().find(|(mark, _)| line.starts_with(&format!("  {mark} "))) {
            *line = line.replacen(mark, &paint(mark, *colour), 1);
        }
    }
    lines.join("\n")
}

/// Returns the size of a file: `9 kB`, `54 MB`.
fn size(bytes: u64) -> String {
    match bytes as f64 {
        bytes if bytes < 1e6 => format!("{:.0} kB", (bytes / 1e3).max(1.0)),
        bytes if bytes < 1e7 => format!("{:.1} MB", bytes / 1e6),
        bytes if bytes < 1e9 => format!("{:.0} MB", bytes / 1e6),
        bytes => format!("{:.1} GB", bytes / 1e9),
    }
}
