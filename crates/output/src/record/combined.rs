//! Composite records: none, one by reference, an optional one, and two.

use super::{Course, Record, RecordError, Sample};
use crate::motion::Stretch;
use crate::time::Instant;

/// Record that stores nothing, at no cost.
impl Record for () {
    fn switchings(&self) -> bool {
        false
    }

    fn record(&mut self, _: Instant, _: Sample<'_>) -> Result<(), RecordError> {
        Ok(())
    }
}

impl<R: Record + ?Sized> Record for &mut R {
    fn dense(&self) -> bool {
        (**self).dense()
    }

    fn scene(&self) -> bool {
        (**self).scene()
    }

    fn estimates(&self) -> bool {
        (**self).estimates()
    }

    fn switchings(&self) -> bool {
        (**self).switchings()
    }

    fn course(&self) -> Course {
        (**self).course()
    }

    fn stretch(&mut self, now: Instant, stretch: &Stretch) -> Result<(), RecordError> {
        (**self).stretch(now, stretch)
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        (**self).record(now, sample)
    }

    fn poll(&mut self) -> Result<(), RecordError> {
        (**self).poll()
    }
}

/// Optional record: `None` stores nothing.
impl<R: Record> Record for Option<R> {
    fn dense(&self) -> bool {
        self.as_ref().is_some_and(Record::dense)
    }

    fn scene(&self) -> bool {
        self.as_ref().is_some_and(Record::scene)
    }

    fn estimates(&self) -> bool {
        self.as_ref().is_some_and(Record::estimates)
    }

    fn switchings(&self) -> bool {
        self.as_ref().is_some_and(Record::switchings)
    }

    fn course(&self) -> Course {
        self.as_ref().map_or(Course::None, Record::course)
    }

    fn stretch(&mut self, now: Instant, stretch: &Stretch) -> Result<(), RecordError> {
        self.as_mut().map_or(Ok(()), |record| record.stretch(now, stretch))
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        self.as_mut().map_or(Ok(()), |record| record.record(now, sample))
    }

    fn poll(&mut self) -> Result<(), RecordError> {
        self.as_mut().map_or(Ok(()), Record::poll)
    }
}

/// Pair of records that both get all samples.
impl<A: Record, B: Record> Record for (A, B) {
    fn dense(&self) -> bool {
        self.0.dense() || self.1.dense()
    }

    fn scene(&self) -> bool {
        self.0.scene() || self.1.scene()
    }

    fn estimates(&self) -> bool {
        self.0.estimates() || self.1.estimates()
    }

    fn switchings(&self) -> bool {
        self.0.switchings() || self.1.switchings()
    }

    fn course(&self) -> Course {
        self.0.course().and(self.1.course())
    }

    fn stretch(&mut self, now: Instant, stretch: &Stretch) -> Result<(), RecordError> {
        self.0.stretch(now, stretch)?;
        self.1.stretch(now, stretch)
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        self.0.record(now, sample)?;
        self.1.record(now, sample)
    }

    fn poll(&mut self) -> Result<(), RecordError> {
        self.0.poll()?;
        self.1.poll()
    }
}
