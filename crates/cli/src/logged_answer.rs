//! Answer of a log: of its run, which is repeated, or of its rows where that is impossible.

use std::io::Write;
use std::path::Path;

use flexsc_core::Scenario;
use flexsc_core::answer::{Answer, RunObserver};
use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_core::record::Log;

use crate::error::CliError;
use crate::{plot, say};

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
