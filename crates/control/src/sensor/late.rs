//! Exposures that are told some time later.

use std::collections::VecDeque;

use super::{Fault, Orientation, Reading};
use crate::time::{Instant, Span};

/// What was seen and is not told yet.
#[derive(Clone, Debug)]
pub(super) struct Late {
    period: Span,
    latency: Span,
    /// When it exposes next.
    exposes: Instant,
    /// What was seen, and when it is told.
    waiting: VecDeque<(Instant, Reading)>,
}

impl Late {
    /// Nothing was seen yet, of a sensor that exposes at this period and tells so late.
    pub fn new(period: Span, latency: Span) -> Self {
        Self { period, latency, exposes: Instant::START, waiting: VecDeque::new() }
    }

    /// Whether it exposes now.
    pub fn exposes(&self, now: Instant) -> bool {
        now >= self.exposes
    }

    /// Takes what was seen in an exposure. What is seen at the start is told then, as if it had been exposed before.
    pub fn take(&mut self, now: Instant, seen: Option<Reading>) {
        let told = if now == Instant::START { now } else { now + self.latency };
        self.exposes = now + self.period;
        self.waiting.extend(seen.map(|reading| (told, reading)));
    }

    /// Makes something else of the orientation that was seen last.
    pub fn amend(&mut self, at: Orientation) {
        if let Some((_, reading)) = self.waiting.back_mut() {
            reading.at = at;
        }
    }

    /// What is told now.
    pub fn told(&mut self, now: Instant) -> Option<Reading> {
        let (told, reading) = *self.waiting.front()?;
        (told <= now).then(|| {
            self.waiting.pop_front();
            reading
        })
    }

    /// When there is something to see or to tell next.
    pub fn next(&self) -> Instant {
        self.waiting.front().map_or(self.exposes, |(told, _)| self.exposes.min(*told))
    }
}

/// What a sensor with these failures makes of what it would see now, after the last reading.
pub(super) fn failing(
    faults: &[Fault],
    now: Instant,
    seen: Option<Reading>,
    last: Option<&Reading>,
) -> Option<Reading> {
    match faults.iter().find(|fault| fault.outage().lasts(now)) {
        None => seen,
        Some(Fault::Stuck(_)) => last.copied().or(seen),
        Some(Fault::Silent(_)) => None,
    }
}
