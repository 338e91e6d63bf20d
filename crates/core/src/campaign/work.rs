//! What makes the rows of a campaign, with or without a file system.

use std::io;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use super::error::{DirectoryError, io_of, wrong};
use super::manifest::Manifest;
use super::parquet::encode;
use super::rows::{ColumnHeading, Rows};
use super::{Campaign, CampaignRun, RunError, RunOutcome, part};
use crate::metrics::{Metrics, Selection};
use crate::record::{Record, RecordError};
use crate::sim::SimulationError;

/// The note of a part that says which campaign it is of.
pub(super) const NOTE: &str = "flexsc.campaign";
/// The note that has the units of its columns.
const UNITS: &str = "flexsc.units";

/// What makes the rows of a campaign: its manifest, and what that comes to.
#[derive(Clone, Debug)]
pub struct Work {
    /// The manifest.
    pub manifest: Manifest,
    /// The campaign.
    pub campaign: Arc<Campaign>,
    /// The metrics of its rows.
    pub selection: Selection,
    fields: Arc<[ColumnHeading]>,
}

impl Work {
    /// The work that a manifest describes; `origin` is what errors call it.
    pub fn of(manifest: Manifest, origin: &Path) -> Result<Self, DirectoryError> {
        let selection = manifest.selection().map_err(|why| wrong(origin, why))?;
        let campaign = Arc::new(manifest.campaign()?);
        let fields = campaign.fields(&selection);
        Ok(Self { manifest, campaign, selection, fields })
    }

    /// The work of runs that are made here alone, with parts of a program's own too.
    pub fn here(campaign: Campaign, runs: Range<u64>, selection: Selection) -> Result<Self, String> {
        let manifest = Manifest::in_memory(&campaign, runs, &selection)?;
        let fields = campaign.fields(&selection);
        Ok(Self { manifest, campaign: Arc::new(campaign), selection, fields })
    }

    /// No rows yet.
    pub fn rows(&self) -> Rows {
        Rows::new(self.fields.clone())
    }

    /// The columns of the rows.
    pub fn fields(&self) -> &[ColumnHeading] {
        &self.fields
    }

    /// Rows as the bytes of a part.
    pub fn encode(&self, rows: &Rows) -> io::Result<Vec<u8>> {
        let units = self.fields.iter().filter(|field| !field.unit.is_empty());
        let units: serde_json::Map<_, _> =
            units.map(|field| (field.name.clone(), field.unit.into())).collect();
        let units = serde_json::Value::Object(units).to_string();
        encode(rows, &[(NOTE, self.manifest.hash.clone()), (UNITS, units)])
    }

    /// Makes some runs on so many threads, or with 0 on one for each core; `poll` is asked again and again whether to stop.
    pub fn make(
        &self,
        runs: Range<u64>,
        threads: usize,
        poll: impl Record + Clone + Send + Sync + 'static,
    ) -> Result<Rows, DirectoryError> {
        self.make_by(runs, threads, poll, Campaign::simulate_for)
    }

    /// The same where something else simulates a run, and comes to what [`Campaign::simulate_for`] does.
    pub fn make_by<R: Record + Clone + Send + Sync + 'static>(
        &self,
        runs: Range<u64>,
        threads: usize,
        poll: R,
        simulate: impl Fn(&CampaignRun, &Selection, R) -> Result<Metrics, SimulationError> + Send + Sync + 'static,
    ) -> Result<Rows, DirectoryError> {
        let mut rows = self.rows();
        let (selection, record) = (self.selection.clone(), poll.clone());
        let work = move |run: &CampaignRun| -> Result<Metrics, RunError> {
            Ok(simulate(run, &selection, record.clone())?)
        };
        let mut poll = poll;
        self.campaign.each_beside(runs, threads, &self.selection, work, |outcome: Option<RunOutcome>| {
            poll.poll().map_err(|_| DirectoryError::Interrupted)?;
            if let Some(outcome) = outcome {
                let stopped = matches!(
                    outcome.metrics,
                    Err(RunError::Simulation(SimulationError::Record(RecordError::Interrupted)))
                );
                if stopped {
                    return Err(DirectoryError::Interrupted);
                }
                rows.push(&self.campaign, &outcome);
            }
            Ok(())
        })?;
        Ok(rows)
    }

    /// A part as the name of its file and its bytes.
    pub fn part(
        &self,
        runs: Range<u64>,
        threads: usize,
        poll: impl Record + Clone + Send + Sync + 'static,
    ) -> Result<(String, Vec<u8>), DirectoryError> {
        let name = part::name(&runs);
        let rows = self.make(runs, threads, poll)?;
        let bytes = self.encode(&rows).map_err(io_of(Path::new(&name)))?;
        Ok((name, bytes))
    }
}
