//! The log of a run in memory, for what is read from logs and not kept.

use std::io::Cursor;
use std::path::Path;

use flexsc_core::campaign::{Campaign, Run};
use flexsc_core::record::{Detail, Log, McapLog, RunEnd};
use flexsc_core::{Scenario, SimulationError};

use crate::failure::Failure;
use crate::simulate;
use crate::stop::Stop;

/// The log of a scenario's own run in this detail. `path` is what errors call it.
pub fn logged(scenario: Scenario, path: &Path, detail: Detail) -> Result<Log, Failure> {
    let run = simulate::itself(&Campaign::new(scenario, &path.to_string_lossy(), None)?);
    of_run(&run, path, detail)
}

/// The log of a run in this detail.
pub fn of_run(run: &Run, path: &Path, detail: Detail) -> Result<Log, Failure> {
    let failed = |source| Failure::Run { name: run.scenario.name.clone(), source };
    Ok(Log::read(path, bytes(run, detail).map_err(failed)?)?)
}

fn bytes(run: &Run, detail: Detail) -> Result<Vec<u8>, SimulationError> {
    let mut log = McapLog::new(Cursor::new(Vec::new()), &Campaign::provenance(run, detail), detail)?;
    let metrics = Campaign::simulate(run, (&mut log, Stop))?;
    Ok(log.finish(&metrics, RunEnd::Complete)?.into_inner())
}
