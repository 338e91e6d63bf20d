//! Progress of a run, for a page.

use flexsc_core::dynamics::MotionPiece;
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{Record, RecordError, Sample};

/// Function that takes the part of a run that is done, from 0 to 1.
pub type ProgressReceiver = fn(f64);

/// Record that passes the part of a run that is done to a receiver.
pub struct PageProgress {
    receiver: ProgressReceiver,
    duration: f64,
    samples: u32,
}

impl PageProgress {
    /// Number of samples from one message to the next.
    const EACH: u32 = 4096;

    /// Returns the progress of a run of this duration (s).
    pub fn new(receiver: ProgressReceiver, duration: f64) -> Self {
        Self { receiver, duration, samples: 0 }
    }

    fn update(&mut self, now: f64) {
        self.samples = self.samples.wrapping_add(1);
        if self.samples.is_multiple_of(Self::EACH) {
            (self.receiver)(now / self.duration);
        }
    }
}

impl Record for PageProgress {
    fn record(&mut self, now: Instant, _: Sample<'_>) -> Result<(), RecordError> {
        self.update(now.seconds());
        Ok(())
    }

    fn piece(&mut self, _: Instant, piece: &MotionPiece) -> Result<(), RecordError> {
        self.update(piece.from);
        Ok(())
    }
}
