//! Stepping interface for batches that integrate the motion of many runs: each run senses, estimates and decides
//! itself.

use flexsc_control::estimator::kalman::KalmanFilter;
use flexsc_numerics::time::Instant;
use flexsc_record::Record;
use flexsc_spacecraft::flow::ExternalMotion;

use super::plant::{AppliedTorque, Plant};
use super::{Simulation, SimulationError};

impl Simulation {
    /// Hands the motion of the body to a batch before the run begins; `None` unless its modes are coupled or drift.
    /// Only for laws without guards and runs without rows between events.
    pub(crate) fn take_motion(&mut self) -> Option<ExternalMotion> {
        let Plant::OneAxis(plant) = &mut self.plant else { return None };
        if self.monitor.is_some() { None } else { plant.take_motion() }
    }

    /// Begins the run.
    ///
    /// # Errors
    /// Fails like [`Simulation::run_until`].
    pub(crate) fn begin_external(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.open(record)?;
        self.resume(None, record).map(|_| ())
    }

    /// Returns the next instant at which anything is due, at most the end, and whether that is within the run.
    pub(crate) fn next_event(&self) -> (Instant, bool) {
        let next = self.next();
        (next.min(self.end), next <= self.end)
    }

    /// Returns the start of the last motion segment, its reduced moment (rad/s²) and its torques, once per segment;
    /// `None` if no segment has begun since the last call.
    pub(crate) fn take_segment_start(&mut self) -> Option<(Instant, f64, AppliedTorque)> {
        let Plant::OneAxis(plant) = &mut self.plant else { return None };
        plant.take_segment_start().map(|(at, moment)| (at, moment, self.applied))
    }

    /// Sets the motion at `now`: angle and rate of each coordinate.
    pub(crate) fn set_motion(&mut self, now: Instant, motion: impl Iterator<Item = [f64; 2]>) {
        if let Plant::OneAxis(plant) = &mut self.plant {
            plant.set_motion(now, motion);
        }
        if now > self.now {
            self.now = now;
            self.decisions_at_now = 0;
        }
    }

    /// Reads the sensors that are due; returns true if anything was measured.
    pub(super) fn read_sensors(&mut self) -> bool {
        self.update_angle_origin(self.now);
        self.sensors.read(self.now, &self.plant, &self.angle_origin)
    }

    /// Returns the current instant of the run.
    pub(crate) fn now(&self) -> Instant {
        self.now
    }

    /// Returns true if a sample is due at the current instant.
    pub(crate) fn sample_is_due(&self) -> bool {
        self.sensors.next == Some(self.now)
    }

    /// Reads the sample at the current instant before the estimator uses it, and returns its angle (rad); `None` if the
    /// sensor gives no measurement.
    ///
    /// # Errors
    /// Fails if the state is no longer finite.
    pub(crate) fn read_sample_ahead(&mut self) -> Result<Option<f64>, SimulationError> {
        self.plant.evaluate(self.now)?;
        let measured = self.read_sensors();
        self.sample_read_ahead = Some(measured);
        Ok(measured.then(|| self.sensors.measured[0][0]))
    }

    /// Returns the filter, and the mean reduced moment since its last sample (rad/s²).
    pub(crate) fn filter(&mut self) -> Option<(&mut KalmanFilter, Option<f64>)> {
        self.estimator.batch()?.batch_filter(self.now)
    }

    /// Returns the true values of the filter's state components.
    pub(crate) fn true_state(&mut self) -> Vec<f64> {
        let truth = self.plant.about_axis(0, &self.angle_origin);
        self.estimator.batch().map_or_else(Vec::new, |filter| filter.true_filter_state(self.now, &truth))
    }

    /// Ends the run, if it is at its end.
    ///
    /// # Errors
    /// Fails like [`Simulation::run_until`].
    pub(crate) fn finish_external(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.plant.evaluate(self.now)?;
        self.finish(record)
    }
}
