//! Trace: the rows of a run in memory, as columns.

use flexsc_numerics::time::Instant;

use super::custom_topic::CustomTopics;
use super::report::LogRow;
use super::{Column, Columns, Detail, LogTopic, Record, RecordError, RowTaker, Sample, TOPICS};

/// Columns of every topic, each with the times of its rows.
#[derive(Clone, Debug)]
pub struct Trace {
    detail: Detail,
    /// Times (s) and columns, in the order of [`TOPICS`] and then of the custom topics.
    topics: Vec<(Vec<f64>, Columns)>,
    custom: CustomTopics,
}

impl Trace {
    /// Creates a trace of this detail.
    pub fn new(detail: Detail) -> Self {
        let topics = TOPICS.iter().map(|t| (Vec::new(), Columns::new(t.fields))).collect();
        Self { detail, topics, custom: CustomTopics::default() }
    }

    /// Iterates over the names of the topics with their slashes, in the order of their columns.
    fn names(&self) -> impl Iterator<Item = &str> {
        TOPICS.iter().map(|topic| topic.name).chain(self.custom.iter().map(|topic| topic.name()))
    }

    /// Returns the columns of each topic that has rows, by its name without the slash. The first column is `time_s`.
    pub fn into_columns(self) -> impl Iterator<Item = (String, Columns)> {
        let names: Vec<String> = self.names().map(|name| name.trim_start_matches('/').to_owned()).collect();
        names.into_iter().zip(self.topics).filter(|(_, (times, _))| !times.is_empty()).map(
            |(name, (times, mut columns))| {
                if columns.get("time_s").is_none() {
                    columns.columns.insert(0, ("time_s".to_owned(), Column::Numbers(times)));
                }
                (name, columns)
            },
        )
    }

    /// Returns the columns of a topic by its name with the slash.
    pub fn topic(&self, name: &str) -> Option<&Columns> {
        let index = self.names().position(|own| own == name)?;
        Some(&self.topics[index].1)
    }
}

impl RowTaker for Trace {
    fn take_row(&mut self, now: Instant, row: &dyn LogRow) -> Result<(), RecordError> {
        let index = match row.topic() {
            LogTopic::Declared(index) => index,
            LogTopic::Custom(topic) => {
                let (index, is_new) = self.custom.index(topic)?;
                if is_new {
                    self.topics.push((Vec::new(), topic.columns()));
                }
                TOPICS.len() + index
            }
        };
        let (times, columns) = &mut self.topics[index];
        times.push(now.seconds());
        row.fill(columns);
        Ok(())
    }
}

impl Record for Trace {
    fn wants_motion(&self) -> bool {
        self.detail >= Detail::Full
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        // Data for viewers has no columns.
        let detail = self.detail.min(Detail::Full);
        self.take_sample_rows(now, sample, detail)
    }
}
