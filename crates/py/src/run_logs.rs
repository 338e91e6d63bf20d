//! Logs of the runs of a campaign, beside the parts of its directory.

use std::io;
use std::ops::Range;
use std::path::PathBuf;

use flexsc_cli::{NotReplaced, simulate_to_log};
use flexsc_core::SimulationError;
use flexsc_core::campaign::{CampaignRun, Directory, DirectoryError};
use flexsc_core::record::{Detail, RecordError, StopFlag};

/// Computes the runs of a part with the log of each, `NAME-RUN.mcap`, and writes it.
pub fn write_part(
    directory: &Directory,
    runs: Range<u64>,
    jobs: usize,
    (detail, force): (Detail, bool),
    stop: StopFlag,
) -> Result<PathBuf, DirectoryError> {
    let (work, place) = (directory.work(), directory.path().to_owned());
    let name = work.campaign.scenario().name.clone();
    let simulate = move |run: &CampaignRun, stop: StopFlag| {
        // Runs that had not started before the interruption have no log.
        if stop.is_requested() {
            return Err(SimulationError::Record(RecordError::Interrupted));
        }
        let path = place.join(format!("{name}-{}.mcap", run.number));
        Ok(simulate_to_log(run, &path, (detail, force), stop)?.0)
    };
    let rows = work.make_rows_singly(runs.clone(), jobs, stop, simulate)?;
    directory.write(&runs, &rows)
}

/// Returns why a log was not replaced, without the hint of the command.
pub fn refusal(source: &io::Error) -> Option<String> {
    let refused = source.get_ref()?.downcast_ref::<NotReplaced>()?;
    let why = refused.0.split("\n\n").next().unwrap_or_default();
    Some(format!("{why}\n\nhint: give another directory as `out`, or `force=True` to replace it"))
}
