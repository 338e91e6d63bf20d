//! Composite records: none, one by reference, an optional one, and two.

use flexsc_dynamics::MotionPiece;
use flexsc_numerics::time::Instant;

use super::{PieceDemand, Record, RecordError, Sample, SceneSource};

/// Record that stores nothing, at no cost.
impl Record for () {
    fn wants_switchings(&self) -> bool {
        false
    }

    fn record(&mut self, _: Instant, _: Sample<'_>) -> Result<(), RecordError> {
        Ok(())
    }
}

impl<R: Record + ?Sized> Record for &mut R {
    fn wants_motion(&self) -> bool {
        (**self).wants_motion()
    }

    fn scene(&self) -> Option<Box<dyn SceneSource>> {
        (**self).scene()
    }

    fn wants_estimates(&self, now: Instant) -> bool {
        (**self).wants_estimates(now)
    }

    fn wants_journal(&self) -> bool {
        (**self).wants_journal()
    }

    fn wants_switchings(&self) -> bool {
        (**self).wants_switchings()
    }

    fn wants_requirement_signals(&self) -> bool {
        (**self).wants_requirement_signals()
    }

    fn piece_demand(&self) -> PieceDemand {
        (**self).piece_demand()
    }

    fn piece(&mut self, now: Instant, piece: &MotionPiece) -> Result<(), RecordError> {
        (**self).piece(now, piece)
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
    fn wants_motion(&self) -> bool {
        self.as_ref().is_some_and(Record::wants_motion)
    }

    fn scene(&self) -> Option<Box<dyn SceneSource>> {
        self.as_ref().and_then(Record::scene)
    }

    fn wants_estimates(&self, now: Instant) -> bool {
        self.as_ref().is_some_and(|record| record.wants_estimates(now))
    }

    fn wants_journal(&self) -> bool {
        self.as_ref().is_some_and(Record::wants_journal)
    }

    fn wants_switchings(&self) -> bool {
        self.as_ref().is_some_and(Record::wants_switchings)
    }

    fn wants_requirement_signals(&self) -> bool {
        self.as_ref().is_some_and(Record::wants_requirement_signals)
    }

    fn piece_demand(&self) -> PieceDemand {
        self.as_ref().map_or(PieceDemand::None, Record::piece_demand)
    }

    fn piece(&mut self, now: Instant, piece: &MotionPiece) -> Result<(), RecordError> {
        self.as_mut().map_or(Ok(()), |record| record.piece(now, piece))
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
    fn wants_motion(&self) -> bool {
        self.0.wants_motion() || self.1.wants_motion()
    }

    fn scene(&self) -> Option<Box<dyn SceneSource>> {
        self.0.scene().or_else(|| self.1.scene())
    }

    fn wants_estimates(&self, now: Instant) -> bool {
        self.0.wants_estimates(now) || self.1.wants_estimates(now)
    }

    fn wants_journal(&self) -> bool {
        self.0.wants_journal() || self.1.wants_journal()
    }

    fn wants_switchings(&self) -> bool {
        self.0.wants_switchings() || self.1.wants_switchings()
    }

    fn wants_requirement_signals(&self) -> bool {
        self.0.wants_requirement_signals() || self.1.wants_requirement_signals()
    }

    fn piece_demand(&self) -> PieceDemand {
        self.0.piece_demand().and(self.1.piece_demand())
    }

    fn piece(&mut self, now: Instant, piece: &MotionPiece) -> Result<(), RecordError> {
        self.0.piece(now, piece)?;
        self.1.piece(now, piece)
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
