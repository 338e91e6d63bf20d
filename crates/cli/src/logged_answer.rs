//! Run of a log, which is repeated, and its answer, which is that of its rows where that is impossible.

use std::io::Write;
use std::path::Path;

use flexsc_core::Scenario;
use flexsc_core::answer::{Answer, RunObserver};
use flexsc_core::campaign::CommandLog;
use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::Log;
use flexsc_core::record::metrics::Metrics;

use crate::error::CliError;
use crate::{plot, say};

/// Run that repeats a log.
pub struct LoggedRun {
    /// Scenario of the run.
    pub scenario: Scenario,
    /// Number of the run.
    pub run: u64,
    /// Commands from outside.
    pub commands: CommandLog,
    /// Instant up to which the log has the run.
    pub until: Instant,
    /// Metrics of the run.
    pub metrics: Metrics,
}

/// Returns the run of a log, repeated once to see that it is that of the log.
///
/// # Errors
/// A log without a scenario, or whose run takes long, needs parts or commands that the log lacks, or differs from the log.
pub fn run_of_log(log: &Log, path: &Path) -> Result<LoggedRun, CliError> {
    let events = plot::RunEvents::read(log, path, None)?;
    let metrics = events.repeat(log, path, "motion between its rows", &mut ())?;
    let until = events.until();
    let commands = events.commanded.unwrap_or_default();
    Ok(LoggedRun { scenario: events.scenario, run: events.run, commands, until, metrics })
}

/// Returns the scenario of a log and the answer of its run.
///
/// # Errors
/// A log without a scenario, or whose rows cannot be read, or an interruption.
pub fn answer_of_log(log: &Log, path: &Path, units: ReaderUnits) -> Result<(Scenario, Answer), CliError> {
    let story = plot::RunEvents::read(log, path, None)?;
    let mut observer = RunObserver::new(&story.scenario);
    // A run that did not end has no verdict to repeat.
    if log.metadata().get("end").is_some_and(|end| end == "complete") {
        match story.repeat(log, path, "rows of every control cycle", &mut observer) {
            Ok(metrics) => {
                let answer = Answer::new(&story.scenario, &metrics, Some(&observer.finish()), units);
                return Ok((story.scenario, answer));
            }
            Err(CliError::Interrupted(text)) => return Err(CliError::Interrupted(text)),
            Err(why) => {
                let why = why.to_string();
                say!("note: {}; the answer is that of its rows", why.lines().next().unwrap_or_default());
            }
        }
    }
    let answer = Answer::from_rows(&story.scenario, log, units)?;
    Ok((story.scenario, answer))
}
