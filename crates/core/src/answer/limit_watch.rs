//! Watch of actuators at their limits in every control cycle.

use flexsc_control::actuator::{ActuatorLimits, SATURATION_GAP};
use flexsc_numerics::time::Instant;
use flexsc_record::Report;

/// Watch of the limits of a run's actuators.
#[derive(Clone, Debug)]
pub(super) struct LimitWatch {
    limits: ActuatorLimits,
    stays: Vec<LimitStay>,
    /// For each limit its last stay, as an index, if there is one.
    latest: Vec<Option<usize>>,
    /// Stays of the last cycle, which last until the next one.
    open: Vec<usize>,
    /// Largest number of stays that are kept.
    most: usize,
}

/// Time at a limit, with gaps of at most [`SATURATION_GAP`].
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct LimitStay {
    /// Index of the limit.
    pub limit: usize,
    /// Index of the mode of operation in which it begins.
    pub mode: usize,
    /// Start and end (s).
    pub from: f64,
    pub to: f64,
}

impl LimitWatch {
    /// Creates a watch of limits that keeps this number of stays at most.
    pub fn new(limits: ActuatorLimits, most: usize) -> Self {
        Self { latest: vec![None; limits.count()], limits, stays: Vec::new(), open: Vec::new(), most }
    }

    /// Observes the report of a cycle that begins now in a mode of operation.
    pub fn observe(&mut self, now: Instant, mode: usize, report: &Report) {
        if self.limits.is_empty() {
            return;
        }
        let now = now.seconds();
        self.close(now);
        self.limits.observe(report);
        for (limit, ..) in self.limits.reached() {
            let latest = self.latest[limit].filter(|stay| now - self.stays[*stay].to <= SATURATION_GAP);
            let stay = latest.unwrap_or(self.stays.len());
            if latest.is_none() {
                if self.stays.len() == self.most {
                    continue;
                }
                self.stays.push(LimitStay { limit, mode, from: now, to: now });
                self.latest[limit] = Some(stay);
            }
            self.open.push(stay);
        }
    }

    /// Returns the stays up to the end of the run, each with the description of its limit: `wheel 3 at its speed limit`.
    pub fn finish(mut self, end: Instant) -> Vec<(String, LimitStay)> {
        self.close(end.seconds());
        self.stays.iter().map(|stay| (self.limits.name(stay.limit).to_owned(), *stay)).collect()
    }

    /// Lets the stays of the last cycle last until a time (s).
    fn close(&mut self, now: f64) {
        for stay in self.open.drain(..) {
            self.stays[stay].to = now;
        }
    }
}
