//! In-memory log of a run, for results that are read from logs that are not kept.

use std::path::Path;

use flexsc_core::campaign::{Campaign, CampaignRun, CommandLog};
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{Detail, Log, LogBytes, RunEnd};
use flexsc_core::{Scenario, SimulationError};

use crate::error::CliError;
use crate::simulate;
use crate::stop::stop_flag;

/// Returns the log of a scenario's own run in this detail; errors refer to it as `path`.
pub fn logged(scenario: Scenario, path: &Path, detail: Detail) -> Result<Log, CliError> {
    let run = simulate::scenario_run(&Campaign::new(scenario, &path.to_string_lossy(), None)?);
    log_run(&run, &CommandLog::default(), Instant::END, path, detail)
}

/// Returns the log of a run under these commands, up to an instant, in this detail.
pub fn log_run(
    run: &CampaignRun,
    commanded: &CommandLog,
    until: Instant,
    path: &Path,
    detail: Detail,
) -> Result<Log, CliError> {
    let failed = |source| CliError::Run { name: run.scenario.name.clone(), source };
    Ok(Log::read(path, bytes(run, commanded, until, detail).map_err(failed)?)?)
}

fn bytes(
    run: &CampaignRun,
    commanded: &CommandLog,
    until: Instant,
    detail: Detail,
) -> Result<Vec<u8>, SimulationError> {
    let mut log = LogBytes::new(&commanded.provenance(run), detail)?;
    let metrics = commanded.simulate(run, until, (&mut log, stop_flag()))?;
    Ok(log.finish(&metrics, RunEnd::at(until, run.scenario.duration))?)
}
