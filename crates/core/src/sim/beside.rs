//! A simulation whose motion is computed elsewhere, beside those of other runs: it senses, estimates and decides on its own.

use super::plant::{Exerted, Plant};
use super::{Simulation, SimulationError};
use crate::estimator::kalman::KalmanFilter;
use crate::flow::Lent;
use crate::record::Record;
use crate::time::Instant;

impl Simulation {
    /// Lends the motion of its body before the run begins: none but that of coupled or drifting modes. It is for laws without
    /// guards, and nothing may look between events.
    pub(crate) fn lend(&mut self) -> Option<Lent> {
        let Plant::Planar(plant) = &mut self.plant else { return None };
        if self.monitor.is_some() { None } else { plant.lend() }
    }

    /// Begins the run.
    ///
    /// # Errors
    /// As a run.
    pub(crate) fn begin_lent(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.open(record)?;
        self.resume(None, record).map(|_| ())
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

    /// Measures what there is.
    pub(super) fn measure(&mut self) -> bool {
        self.turn_to_target(self.now);
        self.sensing.read(self.now, &self.plant, &self.origin)
    }

    /// Where it is in time.
    pub(crate) fn now(&self) -> Instant {
        self.now
    }

    /// Whether a sample is due where the body is.
    pub(crate) fn samples(&self) -> bool {
        self.sensing.next == Some(self.now)
    }

    /// Takes the angle of a sample ahead of what is done with it (rad); none of a silent sensor.
    ///
    /// # Errors
    /// As a run.
    pub(crate) fn read_ahead(&mut self) -> Result<Option<f64>, SimulationError> {
        self.plant.view(self.now)?;
        let measured = self.measure();
        self.read = Some(measured);
        Ok(measured.then(|| self.sensing.measured[0][0]))
    }

    /// The filter, and the mean reduced moment since its last sample (rad/s²).
    pub(crate) fn filter(&mut self) -> Option<(&mut KalmanFilter, Option<f64>)> {
        self.estimator.filter(self.now)
    }

    /// The true state of the filter's components.
    pub(crate) fn true_state(&self) -> Vec<f64> {
        self.estimator.true_state(self.now, &self.plant.about(0, &self.origin))
    }

    /// Does what is due where the body is.
    ///
    /// # Errors
    /// As a run.
    pub(crate) fn act(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.serve(record)
    }

    /// Ends the run where the body is.
    ///
    /// # Errors
    /// As a run.
    pub(crate) fn end(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.plant.view(self.now)?;
        self.finish(record)
    }
}
