//! Latency queue of a sensor: exposures whose readings are available later.

use std::collections::VecDeque;

use flexsc_numerics::time::{Instant, Span};

use super::{Orientation, Reading};

/// Readings delayed by the sensor's latency.
#[derive(Clone, Debug)]
pub(super) struct LatencyQueue {
    period: Span,
    latency: Span,
    /// Time of the next exposure.
    exposes: Instant,
    /// Delayed readings, with the times at which they become available.
    waiting: VecDeque<(Instant, Reading)>,
}

impl LatencyQueue {
    /// Creates an empty queue of a sensor with this period of exposures and this latency.
    pub fn new(period: Span, latency: Span) -> Self {
        Self { period, latency, exposes: Instant::START, waiting: VecDeque::new() }
    }

    /// Returns true if the sensor exposes at `now`.
    pub fn samples_now(&self, now: Instant) -> bool {
        now >= self.exposes
    }

    /// Queues the reading of an exposure. A reading at the start is available at once, as if exposed before.
    pub fn push(&mut self, now: Instant, reading: Option<Reading>) {
        let reported = if now == Instant::START { now } else { now + self.latency };
        self.exposes = now + self.period;
        self.waiting.extend(reading.map(|reading| (reported, reading)));
    }

    /// Replaces the orientation of the last queued reading.
    pub fn replace_last(&mut self, orientation: Orientation) {
        if let Some((_, reading)) = self.waiting.back_mut() {
            reading.at = orientation;
        }
    }

    /// Returns the reading whose latency has elapsed, if any.
    pub fn take_due(&mut self, now: Instant) -> Option<Reading> {
        let (available, reading) = *self.waiting.front()?;
        (available <= now).then(|| {
            self.waiting.pop_front();
            reading
        })
    }

    /// Returns the next time of an exposure or a reading.
    pub fn next_due(&self) -> Instant {
        self.waiting.front().map_or(self.exposes, |(available, _)| self.exposes.min(*available))
    }
}
