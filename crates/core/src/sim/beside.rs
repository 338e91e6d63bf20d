//! A simulation whose motion is computed elsewhere, beside those of other runs: it senses, estimates and decides on its own.

use super::plant::{Exerted, Plant};
use super::{Simulation, SimulationError};
use crate::body::Drifting;
use crate::record::Record;
use crate::time::Instant;

impl Simulation {
    /// Lends the motion of its body: none but that of drifting modes under what is constant from event to event, where no guard
    /// or window looks between events.
    pub(crate) fn lend(&mut self) -> Option<Drifting> {
        let Plant::Planar(plant) = &mut self.plant else { return None };
        if self.sensing.next.is_none() || self.monitor.is_some() { None } else { plant.lend() }
    }

    /// Begins the run.
    ///
    /// # Errors
    /// As a run.
    pub(crate) fn begin_lent(&mut self, record: &mut impl Record) -> Result<(), SimulationError> {
        if self.telling.open(self.now, record)? { self.begin(record) } else { Ok(()) }
    }

    /// When anything is due next, and whether that is within the run; else its end.
    pub(crate) fn following(&self) -> (Instant, bool) {
        let next = self.next();
        (next.min(self.end), next <= self.end)
    }

    /// The motion that began last: when, its reduced moment (rad/s²), and its torques; none since this was asked last.
    pub(crate) fn departed(&mut self) -> Option<(Instant, f64, Exerted)> {
        let Plant::Planar(plant) = &mut self.plant else { return None };
        plant.departed().map(|(at, moment)| (at, moment, self.exerted))
    }

    /// Brings the body to an instant: angle and rate of each coordinate.
    pub(crate) fn bring(&mut self, now: Instant, motion: impl Iterator<Item = [f64; 2]>) {
        if let Plant::Planar(plant) = &mut self.plant {
            plant.bring(now, motion);
        }
        if now > self.now {
            self.now = now;
            self.decisions = 0;
        }
    }

    /// Does what is due where the body is.
    ///
    /// # Errors
    /// As a run.
    pub(crate) fn act(&mut self, record: &mut impl Record) -> Result<(), SimulationError> {
        self.serve(record)
    }

    /// Ends the run where the body is.
    ///
    /// # Errors
    /// As a run.
    pub(crate) fn end(&mut self, record: &mut impl Record) -> Result<(), SimulationError> {
        self.plant.view(self.now)?;
        self.finish(record)
    }
}
