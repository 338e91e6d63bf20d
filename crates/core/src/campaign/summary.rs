//! What the rows of a directory come to: failures, and the statistics of every metric that is a number.

use super::directory::{Directory, DirectoryError};
use super::rows::{Column, ERROR, Kind, RUN};
use crate::metrics::{self, goal};
use crate::statistics::Statistics;

/// No more numbers of the rows are held at once, or those of one metric (64 MB).
const HELD: usize = 1 << 23;

/// What rows come to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// How many there are.
    pub runs: usize,
    /// How many runs failed, the first of them, and why.
    pub failed: Option<(u64, u64, String)>,
    /// The statistics of each metric.
    pub statistics: Vec<Statistics>,
}

impl Directory {
    /// What the rows that are there come to.
    pub fn summary(&self) -> Result<Summary, DirectoryError> {
        let (mut runs, mut failed) = (0, None);
        let about = (self.column(RUN)?, self.column(ERROR)?);
        if let (Some(Column::Integers(numbers)), Some(Column::Words(errors))) = about {
            runs = numbers.len();
            for (number, error) in numbers.into_iter().zip(errors) {
                let (Some(number), Some(error)) = (number, error) else { continue };
                let (count, first, why) = failed.unwrap_or_else(|| (0, number.cast_unsigned(), error));
                failed = Some((count + 1, first, why));
            }
        }
        Ok(Summary { runs, failed, statistics: self.statistics(runs)? })
    }

    /// The statistics of the metrics that are numbers, some columns at a time.
    fn statistics(&self, runs: usize) -> Result<Vec<Statistics>, DirectoryError> {
        let work = self.work();
        let keys: Vec<&str> = work.campaign.keys().collect();
        let counts = |kind: Kind, name: &str| match kind {
            Kind::Integers | Kind::Numbers => true,
            Kind::Words => goal::NAMES.contains(&name),
            Kind::Lists => false,
        };
        let meaning = |name: &str| metrics::meaning(name, Some(work.campaign.scenario()));
        let metrics = work.fields().iter().filter(|field| !keys.contains(&field.name.as_str()));
        let numeric: Vec<_> = metrics
            .filter(|field| counts(field.kind, &field.name))
            .filter_map(|field| Some((field.name.as_str(), meaning(&field.name)?)))
            .collect();
        let mut all = Vec::new();
        for some in numeric.chunks((HELD / runs.max(1)).max(1)) {
            let names: Vec<&str> = some.iter().map(|(name, _)| *name).collect();
            for ((_, meaning), column) in some.iter().zip(self.columns(&names)?) {
                all.push(Statistics::of(meaning, column.map_or_else(Vec::new, |column| column.numbers())));
            }
        }
        Ok(all)
    }
}
