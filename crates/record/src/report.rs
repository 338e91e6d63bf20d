//! Report: the rows of all parts at one instant, and the values that only metrics and figures read.

use std::any::Any;
use std::fmt;

use super::columns::Columns;
use super::log_topic::LogTopic;
use super::proto::Encoder;
use super::row::TopicRow;
use super::topics::{TOPICS, index_of, report_rank};

/// Row of any topic, with its type erased.
pub trait LogRow: Any + fmt::Debug + Send + Sync {
    /// Returns the topic of the row.
    fn topic(&self) -> LogTopic<'_>;

    /// Appends the row as protobuf to a buffer.
    fn encode(&self, buffer: &mut Vec<u8>);

    /// Appends the row to columns that were created for its topic.
    fn fill(&self, columns: &mut Columns);

    /// Returns a copy of the row.
    fn copy(&self) -> Box<dyn LogRow>;
}

impl<R: TopicRow + Clone + fmt::Debug + Send + Sync + 'static> LogRow for R {
    fn topic(&self) -> LogTopic<'_> {
        LogTopic::Declared(const { index_of(R::TOPIC.name) })
    }

    fn encode(&self, buffer: &mut Vec<u8>) {
        Encoder::encode(self, buffer);
    }

    fn fill(&self, columns: &mut Columns) {
        columns.push(self);
    }

    fn copy(&self) -> Box<dyn LogRow> {
        Box::new(self.clone())
    }
}

impl dyn LogRow {
    /// Returns the row, if it is of this type.
    pub fn downcast<T: Any>(&self) -> Option<&T> {
        (self as &dyn Any).downcast_ref()
    }
}

impl Clone for Box<dyn LogRow> {
    fn clone(&self) -> Self {
        (**self).copy()
    }
}

/// Value of a part at one instant that is not logged.
pub trait ReportValue: Any + fmt::Debug + Send + Sync {
    /// Returns a copy of the value.
    fn copy_value(&self) -> Box<dyn ReportValue>;
}

impl<T: Any + fmt::Debug + Clone + Send + Sync> ReportValue for T {
    fn copy_value(&self) -> Box<dyn ReportValue> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn ReportValue> {
    fn clone(&self) -> Self {
        (**self).copy_value()
    }
}

/// Rows and values of the parts at one instant.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Rows for the log, in the order in which they are written.
    rows: Vec<ReportedRow>,
    /// Values that are not logged.
    values: Vec<Box<dyn ReportValue>>,
    /// Boxes of earlier rows and values, for the next ones of their types.
    spare_rows: Vec<Box<dyn LogRow>>,
    spare_values: Vec<Box<dyn ReportValue>>,
}

/// Row for the log.
#[derive(Clone, Debug)]
struct ReportedRow {
    row: Box<dyn LogRow>,
    /// Revision of a row that is logged only when the revision changes.
    revision: Option<u64>,
    /// True if a row of the same revision is already in the log.
    is_repeated: bool,
}

impl Report {
    /// Creates an empty report.
    pub fn new() -> Self {
        Self::default()
    }

    /// Creates a report of one row.
    pub fn from_row(row: &dyn LogRow) -> Self {
        let mut report = Self::new();
        report.insert(ReportedRow { row: row.copy(), revision: None, is_repeated: false });
        report
    }

    /// Removes all rows and values. Their memory is kept, so that a report of the same rows allocates none.
    pub fn clear(&mut self) {
        self.spare_rows.extend(self.rows.drain(..).map(|reported| reported.row));
        self.spare_values.append(&mut self.values);
    }

    /// Adds a row for the log.
    pub fn add(&mut self, row: impl LogRow) {
        self.add_reported(row, None);
    }

    /// Adds a row that is logged only if `revision` differs from that of the topic's last row, 0 at the start.
    pub fn add_revision(&mut self, revision: u64, row: impl LogRow) {
        self.add_reported(row, Some(revision));
    }

    fn add_reported<R: LogRow>(&mut self, row: R, revision: Option<u64>) {
        let spare = self.spare_rows.iter().position(|spare| (&**spare as &dyn Any).is::<R>());
        let row = match spare.map(|index| self.spare_rows.swap_remove(index)) {
            Some(mut known) => {
                if let Some(place) = (&mut *known as &mut dyn Any).downcast_mut() {
                    *place = row;
                }
                known
            }
            None => Box::new(row),
        };
        self.insert(ReportedRow { row, revision, is_repeated: false });
    }

    /// Adds a value that metrics and figures read, and that is not logged.
    pub fn add_value<T: ReportValue>(&mut self, value: T) {
        let spare = self.spare_values.iter().position(|spare| (&**spare as &dyn Any).is::<T>());
        let value = match spare.map(|index| self.spare_values.swap_remove(index)) {
            Some(mut known) => {
                if let Some(place) = (&mut *known as &mut dyn Any).downcast_mut() {
                    *place = value;
                }
                known
            }
            None => Box::new(value),
        };
        self.values.push(value);
    }

    /// Inserts a row after those of topics that are written before its own.
    fn insert(&mut self, reported: ReportedRow) {
        let rank = |row: &dyn LogRow| report_rank(row.topic().declared_index());
        let own = rank(&*reported.row);
        let place = self.rows.partition_point(|other| rank(&*other.row) <= own);
        self.rows.insert(place, reported);
    }

    /// Returns the first row or value of this type.
    pub fn get<T: Any>(&self) -> Option<&T> {
        let row = self.rows.iter().find_map(|reported| reported.row.downcast());
        row.or_else(|| self.values.iter().find_map(|value| (&**value as &dyn Any).downcast_ref()))
    }

    /// Returns the first row for the log of this type.
    pub fn row<T: Any>(&self) -> Option<&T> {
        self.rows().find_map(|row| row.downcast())
    }

    /// Iterates over the rows for the log, in the order in which they are written.
    pub fn rows(&self) -> impl Iterator<Item = &dyn LogRow> {
        self.rows.iter().filter(|reported| !reported.is_repeated).map(|reported| &*reported.row)
    }

    /// Returns true if there is neither a row nor a value.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty() && self.values.is_empty()
    }

    /// Marks the rows whose revision is already in the log, and stores the revisions of the others.
    pub fn skip_repeated(&mut self, logged: &mut LoggedRevisions) {
        for reported in &mut self.rows {
            let topic = reported.row.topic().declared_index();
            let (Some(revision), Some(topic)) = (reported.revision, topic) else { continue };
            reported.is_repeated = std::mem::replace(&mut logged.0[topic], revision) == revision;
        }
    }
}

/// Revision of the last logged row of each topic, 0 before the first.
#[derive(Clone, Debug)]
pub struct LoggedRevisions(Vec<u64>);

impl Default for LoggedRevisions {
    fn default() -> Self {
        Self(vec![0; TOPICS.len()])
    }
}
