//! Trace: the rows of a run in memory, as columns.

use flexsc_numerics::time::Instant;

use super::row::TopicRow;
use super::topics::index_of;
use super::{Column, Columns, Detail, Record, RecordError, RowTaker, Sample, TOPICS};

/// Columns of every topic, each with the times of its rows.
#[derive(Clone, Debug)]
pub struct Trace {
    detail: Detail,
    /// Times (s) and columns, in the order of [`TOPICS`].
    topics: Vec<(Vec<f64>, Columns)>,
}

impl Trace {
    /// Creates a trace of this detail.
    pub fn new(detail: Detail) -> Self {
        let topics = TOPICS.iter().map(|t| (Vec::new(), Columns::new(t.fields))).collect();
        Self { detail, topics }
    }

    /// Returns the columns of each topic that has rows, by its name without the slash. The first column is `time_s`.
    pub fn into_columns(self) -> impl Iterator<Item = (&'static str, Columns)> {
        TOPICS.iter().zip(self.topics).filter(|(_, (times, _))| !times.is_empty()).map(
            |(topic, (times, mut columns))| {
                if columns.get("time_s").is_none() {
                    columns.columns.insert(0, ("time_s".to_owned(), Column::Numbers(times)));
                }
                (topic.name.trim_start_matches('/'), columns)
            },
        )
    }

    /// Returns the columns of a topic by its name with the slash.
    pub fn topic(&self, name: &str) -> Option<&Columns> {
        let index = TOPICS.iter().position(|t| t.name == name)?;
        Some(&self.topics[index].1)
    }
}

impl RowTaker for Trace {
    fn take_row<R: TopicRow>(&mut self, now: Instant, row: &R) -> Result<(), RecordError> {
        let index = const { index_of(R::TOPIC.name) };
        let (times, columns) = &mut self.topics[index];
        times.push(now.seconds());
        columns.push(row);
        Ok(())
    }
}

impl Record for Trace {
    fn wants_motion(&self) -> bool {
        self.detail >= Detail::Full
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        // The sample may be meant for a record of more detail, and data for viewers has no columns.
        let wanted = self.detail.min(Detail::Full);
        if sample.detail() > wanted { Ok(()) } else { self.take_sample_rows(now, sample) }
    }
}
