//! Report: the rows of all parts at one instant, and the values that only metrics and figures read.

use std::any::{Any, TypeId};
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
    rows: Vec<RowSlot>,
    /// Values that are not logged.
    values: Vec<ValueSlot>,
}

/// Memory of a row for the log.
#[derive(Clone, Debug)]
struct RowSlot {
    /// Type of the row: it is compared more often than the row is read.
    kind: TypeId,
    /// Index of the row's topic among the declared ones; `None` for a topic of a program's own.
    topic: Option<usize>,
    row: Box<dyn LogRow>,
    /// True if the report contains the row; otherwise the memory is free for another row of its type.
    is_set: bool,
    /// Revision of a row that is logged only when the revision changes.
    revision: Option<u64>,
    /// True if a row of the same revision is already in the log.
    is_repeated: bool,
}

/// Memory of a value that is not logged.
#[derive(Clone, Debug)]
struct ValueSlot {
    kind: TypeId,
    value: Box<dyn ReportValue>,
    /// True if the report contains the value; otherwise the memory is free for another value of its type.
    is_set: bool,
}

impl Report {
    /// Creates an empty report.
    pub fn new() -> Self {
        Self::default()
    }

    /// Creates a report of one row.
    pub fn from_row(row: &dyn LogRow) -> Self {
        let kind = (row as &dyn Any).type_id();
        let topic = row.topic().declared_index();
        let slot = RowSlot { kind, topic, row: row.copy(), is_set: true, revision: None, is_repeated: false };
        Self { rows: vec![slot], values: Vec::new() }
    }

    /// Removes all rows and values. Their memory is kept, so that a report of the same rows allocates none.
    pub fn clear(&mut self) {
        self.rows.iter_mut().for_each(|slot| slot.is_set = false);
        self.values.iter_mut().for_each(|slot| slot.is_set = false);
    }

    /// Adds a row for the log.
    pub fn add(&mut self, row: impl LogRow) {
        self.add_reported(row, None);
    }

    /// Adds a row that is logged only if `revision` differs from that of the topic's last row, 0 at the start.
    pub fn add_revision(&mut self, revision: u64, row: impl LogRow) {
        self.add_reported(row, Some(revision));
    }

    /// Returns what `take` takes out of an earlier row or value of a type, so that its memory is used again; without one,
    /// the default.
    pub fn reuse<T: Any, M: Default>(&mut self, take: impl FnOnce(&mut T) -> M) -> M {
        let kind = TypeId::of::<T>();
        let row = self.rows.iter_mut().find(|slot| slot.kind == kind && !slot.is_set);
        let row = row.map(|slot| &mut *slot.row as &mut dyn Any);
        let value = self.values.iter_mut().find(|slot| slot.kind == kind && !slot.is_set);
        let earlier = row.or_else(|| value.map(|slot| &mut *slot.value as &mut dyn Any));
        earlier.and_then(|earlier| earlier.downcast_mut()).map(take).unwrap_or_default()
    }

    fn add_reported<R: LogRow>(&mut self, row: R, revision: Option<u64>) {
        match self.free_row(revision) {
            Some(place) => *place = row,
            None => self.insert_row(row, revision),
        }
    }

    /// Returns the first free row of a type, which belongs to the report from now on.
    fn free_row<R: LogRow>(&mut self, revision: Option<u64>) -> Option<&mut R> {
        let kind = TypeId::of::<R>();
        let slot = self.rows.iter_mut().find(|slot| slot.kind == kind && !slot.is_set)?;
        (slot.is_set, slot.revision, slot.is_repeated) = (true, revision, false);
        (&mut *slot.row as &mut dyn Any).downcast_mut()
    }

    /// Adds a row after those of topics that are written before its own.
    fn insert_row<R: LogRow>(&mut self, row: R, revision: Option<u64>) {
        let kind = TypeId::of::<R>();
        let topic = row.topic().declared_index();
        let own = report_rank(topic);
        let place = self.rows.partition_point(|other| report_rank(other.topic) <= own);
        let slot = RowSlot { kind, topic, row: Box::new(row), is_set: true, revision, is_repeated: false };
        self.rows.insert(place, slot);
    }

    /// Adds a value that metrics and figures read, and that is not logged.
    pub fn add_value<T: ReportValue>(&mut self, value: T) {
        match self.free_value() {
            Some(place) => *place = value,
            None => self.push_value(value),
        }
    }

    /// Adds a value that metrics and figures read, as `write` writes it over the default or over an earlier value, whose
    /// memory is used again. Returns what `write` returns.
    pub fn write_value<T: ReportValue + Default, R>(&mut self, write: impl FnOnce(&mut T) -> R) -> R {
        if let Some(place) = self.free_value() {
            return write(place);
        }
        let mut value = T::default();
        let returned = write(&mut value);
        self.push_value(value);
        returned
    }

    /// Returns the first free value of a type, which belongs to the report from now on.
    fn free_value<T: ReportValue>(&mut self) -> Option<&mut T> {
        let slot = self.values.iter_mut().find(|slot| !slot.is_set && slot.kind == TypeId::of::<T>())?;
        slot.is_set = true;
        (&mut *slot.value as &mut dyn Any).downcast_mut()
    }

    fn push_value<T: ReportValue>(&mut self, value: T) {
        self.values.push(ValueSlot { kind: TypeId::of::<T>(), value: Box::new(value), is_set: true });
    }

    /// Returns the first row or value of this type.
    pub fn get<T: Any>(&self) -> Option<&T> {
        let kind = TypeId::of::<T>();
        if let Some(slot) = self.rows.iter().find(|slot| slot.kind == kind && slot.is_set) {
            return slot.row.downcast();
        }
        let slot = self.values.iter().find(|slot| slot.kind == kind && slot.is_set)?;
        (&*slot.value as &dyn Any).downcast_ref()
    }

    /// Returns the first row for the log of this type.
    pub fn row<T: Any>(&self) -> Option<&T> {
        let kind = TypeId::of::<T>();
        let slot = self.rows.iter().find(|slot| slot.kind == kind && slot.is_set && !slot.is_repeated)?;
        slot.row.downcast()
    }

    /// Iterates over the rows for the log, in the order in which they are written.
    pub fn rows(&self) -> impl Iterator<Item = &dyn LogRow> {
        self.rows.iter().filter(|slot| slot.is_set && !slot.is_repeated).map(|slot| &*slot.row)
    }

    /// Returns true if there is neither a row nor a value.
    pub fn is_empty(&self) -> bool {
        !self.rows.iter().any(|slot| slot.is_set) && !self.values.iter().any(|slot| slot.is_set)
    }

    /// Marks the rows whose revision is already in the log, and stores the revisions of the others.
    pub fn skip_repeated(&mut self, logged: &mut LoggedRevisions) {
        for slot in self.rows.iter_mut().filter(|slot| slot.is_set) {
            let (Some(revision), Some(topic)) = (slot.revision, slot.topic) else { continue };
            slot.is_repeated = std::mem::replace(&mut logged.0[topic], revision) == revision;
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

#[cfg(test)]
mod tests {
    use std::mem;

    use super::*;
    use crate::{Wheel, Wheels};

    #[test]
    fn memory_of_cleared_rows_and_values_is_used_again() {
        let wheel = Wheel { speed_rad_s: 1.0, momentum_nm_s: 2.0, torque_nm: 3.0 };
        let take = |row: &mut Wheels| mem::take(&mut row.wheels);
        let add_row = |report: &mut Report, row: Wheels| report.add(row);
        let add_value = |report: &mut Report, row: Wheels| report.add_value(row);
        for add in [add_row as fn(&mut Report, Wheels), add_value] {
            let mut report = Report::new();
            assert_eq!(report.reuse(take), []);
            let wheels = vec![wheel.clone()];
            let place = wheels.as_ptr();
            add(&mut report, Wheels { wheels });
            // What the report contains stays in it.
            assert_eq!(report.reuse(take), []);
            assert_eq!(report.get::<Wheels>().map(|row| row.wheels.len()), Some(1));
            report.clear();
            let wheels = report.reuse(take);
            assert_eq!((wheels.as_ptr(), wheels.len()), (place, 1));
            add(&mut report, Wheels { wheels });
            assert_eq!(report.get::<Wheels>().map(|row| &row.wheels[..]), Some(&[wheel.clone()][..]));
        }
    }
}
