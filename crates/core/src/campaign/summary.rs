//! Summary of a campaign's rows: failures, and the statistics of every numeric metric.

use super::campaign_runs::CampaignRuns;
use super::directory::Directory;
use super::error::DirectoryError;
use super::row_maker::RowMaker;
use super::rows::{ColumnCells, ColumnKind, ERROR, RUN};
use crate::metrics::{self, goal};
use crate::statistics::Statistics;

/// Largest number of values that are held at once, unless one metric has more (64 MB).
const HELD: usize = 1 << 23;

/// Summary of rows.
#[derive(Clone, Debug)]
pub struct CampaignSummary {
    /// Number of rows.
    pub runs: usize,
    /// Number of runs that failed, the number of the first of them, and its error.
    pub failed: Option<(u64, u64, String)>,
    /// Statistics of each metric.
    pub statistics: Vec<Statistics>,
    /// Values of requirements and uncertain keys.
    pub values: CampaignRuns,
}

impl Directory {
    /// Returns the summary of the existing rows.
    pub fn summary(&self) -> Result<CampaignSummary, DirectoryError> {
        let (mut runs, mut failed) = (0, None);
        let columns = (self.column(RUN)?, self.column(ERROR)?);
        if let (Some(ColumnCells::Integers(numbers)), Some(ColumnCells::Text(errors))) = columns {
            runs = numbers.len();
            for (number, error) in numbers.into_iter().zip(errors) {
                let (Some(number), Some(error)) = (number, error) else { continue };
                let (count, first, why) = failed.unwrap_or_else(|| (0, number.cast_unsigned(), error));
                failed = Some((count + 1, first, why));
            }
        }
        Ok(CampaignSummary {
            runs,
            failed,
            statistics: self.work().statistics(runs, |names| self.columns(names))?,
            values: self.work().campaign_runs(|names| self.columns(names))?,
        })
    }
}

impl RowMaker {
    /// Returns the statistics of the numeric metrics, computed for some of them at a time; `columns` returns columns by
    /// their names, `None` for a missing one.
    pub fn statistics<E>(
        &self,
        runs: usize,
        columns: impl Fn(&[&str]) -> Result<Vec<Option<ColumnCells>>, E>,
    ) -> Result<Vec<Statistics>, E> {
        let keys: Vec<&str> = self.campaign.keys().collect();
        let counts = |kind: ColumnKind, name: &str| match kind {
            ColumnKind::Integers | ColumnKind::Numbers | ColumnKind::Lists => true,
            ColumnKind::Text => goal::NAMES.contains(&name),
        };
        let meaning = |name: &str| metrics::meaning(name, Some(self.campaign.scenario()));
        let metrics = self.fields().iter().filter(|field| !keys.contains(&field.name.as_str()));
        let numeric: Vec<_> = metrics
            .filter(|field| counts(field.kind, &field.name))
            .filter_map(|field| Some((field.name.as_str(), meaning(&field.name)?)))
            .collect();
        let mut all = Vec::new();
        for some in numeric.chunks((HELD / runs.max(1)).max(1)) {
            let names: Vec<&str> = some.iter().map(|(name, _)| *name).collect();
            for ((_, meaning), column) in some.iter().zip(columns(&names)?) {
                let Some(column) = column else { continue };
                if !matches!(column, ColumnCells::Lists(_)) {
                    all.push(Statistics::from_values(meaning, None, column.numbers()));
                }
                for index in 0..column.elements() {
                    let element = column.element(index).map_or_else(Vec::new, |cells| cells.numbers());
                    all.push(Statistics::from_values(meaning, Some(index), element));
                }
            }
        }
        Ok(all)
    }
}
