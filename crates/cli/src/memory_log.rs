//! In-memory log of a run, for results that are read from logs that are not kept.

use std::path::Path;

use flexsc_core::campaign::{Campaign, CampaignRun, CommandLog};
use flexsc_core::metrics::Metrics;
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{Detail, Log, LogBytes, Record, RunEnd};
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
    recorded(run, commanded, until, path, (detail, ())).map(|(log, _)| log)
}

/// Returns the log of a scenario's own run in this detail with its metrics, and records the run; errors refer to the log as
/// `path`.
pub fn observed(
    scenario: Scenario,
    path: &Path,
    detail: Detail,
    record: impl Record,
) -> Result<(Log, Metrics), CliError> {
    let run = simulate::scenario_run(&Campaign::new(scenario, &path.to_string_lossy(), None)?);
    recorded(&run, &CommandLog::default(), Instant::END, path, (detail, record))
}

fn recorded(
    run: &CampaignRun,
    commanded: &CommandLog,
    until: Instant,
    path: &Path,
    (detail, record): (Detail, impl Record),
) -> Result<(Log, Metrics), CliError> {
    let simulated = || -> Result<(Vec<u8>, Metrics), SimulationError> {
        let mut log = LogBytes::new(&commanded.provenance(run), detail)?;
        let metrics = commanded.simulate(run, until, (&mut log, (stop_flag(), record)))?;
        Ok((log.finish(&metrics, RunEnd::at(until, run.scenario.duration))?, metrics))
    };
    let failed = |source| CliError::run(&run.scenario.name, source);
    let (bytes, metrics) = simulated().map_err(failed)?;
    Ok((Log::read(path, bytes)?, metrics))
}
