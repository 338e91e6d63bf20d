//! Computation of a campaign's rows, with or without a file system.

use std::io;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use flexsc_record::{Record, RecordError};

use super::error::{DirectoryError, invalid_file, io_error};
use super::manifest::Manifest;
use super::parquet::encode;
use super::rows::{ColumnHeading, RunRows};
use super::{Campaign, CampaignRun, RunError, RunOutcome, part};
use crate::metrics::{Metrics, Selection};
use flexsc_sim::SimulationError;

/// Metadata name of the campaign to which a part belongs.
pub(super) const NOTE: &str = "flexsc.campaign";
/// Metadata name of the units of the columns.
const UNITS: &str = "flexsc.units";

/// Maker of a campaign's rows: its manifest, with the campaign and the metrics that it describes.
#[derive(Clone, Debug)]
pub struct RowMaker {
    /// Manifest of the campaign.
    pub manifest: Manifest,
    /// Campaign of the manifest.
    pub campaign: Arc<Campaign>,
    /// Metrics of the rows.
    pub selection: Selection,
    fields: Arc<[ColumnHeading]>,
}

impl RowMaker {
    /// Creates the row maker of a manifest; `origin` is the name of the manifest in errors.
    pub fn from_manifest(manifest: Manifest, origin: &Path) -> Result<Self, DirectoryError> {
        let selection = manifest.selection().map_err(|why| invalid_file(origin, why))?;
        let campaign = Arc::new(manifest.campaign()?);
        let fields = campaign.fields(&selection);
        Ok(Self { manifest, campaign, selection, fields })
    }

    /// Creates the row maker of a campaign without a manifest file, which may have custom parts of a program.
    pub fn in_memory(campaign: Campaign, runs: Range<u64>, selection: Selection) -> Result<Self, String> {
        let manifest = Manifest::in_memory(&campaign, runs, &selection)?;
        let fields = campaign.fields(&selection);
        Ok(Self { manifest, campaign: Arc::new(campaign), selection, fields })
    }

    /// Returns an empty table.
    pub fn rows(&self) -> RunRows {
        RunRows::new(self.fields.clone())
    }

    /// Returns the headings of the columns.
    pub fn fields(&self) -> &[ColumnHeading] {
        &self.fields
    }

    /// Returns the content of a part's file with these rows.
    pub fn encode(&self, rows: &RunRows) -> io::Result<Vec<u8>> {
        let units = self.fields.iter().filter(|field| !field.unit.is_empty());
        let units: serde_json::Map<_, _> =
            units.map(|field| (field.name.clone(), field.unit.into())).collect();
        let units = serde_json::Value::Object(units).to_string();
        encode(rows, &[(NOTE, self.manifest.hash.clone()), (UNITS, units)])
    }

    /// Computes the rows of some runs on `threads` threads, or with 0 on one for each core; `poll` is called repeatedly
    /// to ask for a stop.
    pub fn make_rows(
        &self,
        runs: Range<u64>,
        threads: usize,
        poll: impl Record + Clone + Send + Sync + 'static,
    ) -> Result<RunRows, DirectoryError> {
        self.make_rows_with(runs, threads, poll, Campaign::simulate_metrics)
    }

    /// Computes rows with a function that simulates a run, with the results of [`Campaign::simulate_metrics`].
    pub fn make_rows_with<R: Record + Clone + Send + Sync + 'static>(
        &self,
        runs: Range<u64>,
        threads: usize,
        poll: R,
        simulate: impl Fn(&CampaignRun, &Selection, R) -> Result<Metrics, SimulationError> + Send + Sync + 'static,
    ) -> Result<RunRows, DirectoryError> {
        let (selection, record) = (self.selection.clone(), poll.clone());
        let work = move |run: &CampaignRun| -> Result<Metrics, RunError> {
            Ok(simulate(run, &selection, record.clone())?)
        };
        let (mut rows, mut poll) = (self.rows(), poll);
        let report = |outcome| self.push(&mut rows, outcome, &mut poll);
        self.campaign.for_each_run_in_batches(runs, threads, &self.selection, work, report)?;
        Ok(rows)
    }

    /// Computes rows with a function that simulates a run with all of its metrics and has other effects, such as a log.
    ///
    /// # Errors
    /// An interruption, and a log that cannot be written.
    pub fn make_rows_singly<R: Record + Clone + Send + Sync + 'static>(
        &self,
        runs: Range<u64>,
        threads: usize,
        poll: R,
        simulate: impl Fn(&CampaignRun, R) -> Result<Metrics, SimulationError> + Send + Sync + 'static,
    ) -> Result<RunRows, DirectoryError> {
        let (selection, record) = (self.selection.clone(), poll.clone());
        let work = move |run: &CampaignRun| -> Result<Metrics, RunError> {
            Ok(selection.select(simulate(run, record.clone())?))
        };
        let (mut rows, mut poll) = (self.rows(), poll);
        let report = |outcome| self.push(&mut rows, outcome, &mut poll);
        self.campaign.for_each_run(runs, threads, work, report)?;
        Ok(rows)
    }

    /// Appends the row of a run, unless a stop is requested or a log could not be written.
    fn push(
        &self,
        rows: &mut RunRows,
        outcome: Option<RunOutcome>,
        poll: &mut impl Record,
    ) -> Result<(), DirectoryError> {
        poll.poll().map_err(|_| DirectoryError::Interrupted)?;
        let Some(outcome) = outcome else { return Ok(()) };
        match outcome.metrics {
            Err(RunError::Simulation(SimulationError::Record(RecordError::Interrupted))) => {
                return Err(DirectoryError::Interrupted);
            }
            Err(RunError::Simulation(SimulationError::Record(RecordError::Io(source)))) => {
                let path = format!("the log of run {}", outcome.number).into();
                return Err(DirectoryError::Io { path, source });
            }
            _ => rows.push(&self.campaign, &outcome),
        }
        Ok(())
    }

    /// Computes a part, and returns the name and the content of its file.
    pub fn part(
        &self,
        runs: Range<u64>,
        threads: usize,
        poll: impl Record + Clone + Send + Sync + 'static,
    ) -> Result<(String, Vec<u8>), DirectoryError> {
        let name = part::file_name(&runs);
        let rows = self.make_rows(runs, threads, poll)?;
        let bytes = self.encode(&rows).map_err(io_error(Path::new(&name)))?;
        Ok((name, bytes))
    }
}
