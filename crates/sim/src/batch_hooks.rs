//! Stepping interface for batches that integrate the motion of many runs: each run senses, estimates and decides
//! itself.

use flexsc_control::estimator::kalman::KalmanFilter;
use flexsc_dynamics::flow::ExternalMotion;
use flexsc_numerics::time::Instant;
use flexsc_record::Record;

use super::plant::AppliedTorque;
use super::{Simulation, SimulationError};

impl Simulation {
    /// Hands the motion of the body to a batch before the run begins; `None` unless its modes are coupled or drift.
    /// Only for laws without guards and runs without rows between events.
    pub fn take_motion(&mut self) -> Option<ExternalMotion> {
        if self.estimation.monitor.is_some() { None } else { self.plant.take_motion() }
    }

    /// Begins the run.
    ///
    /// # Errors
    /// Fails like [`Simulation::run_until`].
    pub fn begin_external(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.open(record)?;
        self.resume(None, record).map(|_| ())
    }

    /// Returns the next instant at which anything is due, at most the end, and whether that is within the run.
    pub fn next_stop(&self) -> (Instant, bool) {
        let (next, end) = (self.next_due(), self.clock.end());
        (next.min(end), next <= end)
    }

    /// Returns the start of the last motion segment, its reduced moment (rad/s²) and its torques, once per segment;
    /// `None` if no segment has begun since the last call.
    pub fn take_segment_start(&mut self) -> Option<(Instant, f64, AppliedTorque)> {
        let start = self.plant.external()?.take_segment_start();
        start.map(|(at, moment)| (at, moment, self.loads.applied))
    }

    /// Sets the motion at `now`: angle and rate of each coordinate.
    pub fn set_motion(&mut self, now: Instant, motion: impl Iterator<Item = [f64; 2]>) {
        if let Some(flow) = self.plant.external() {
            flow.set_motion(now, motion);
        }
        self.clock.advance_to(now);
    }

    /// Returns the current instant of the run.
    pub fn now(&self) -> Instant {
        self.clock.now()
    }

    /// Returns true if a sample is due at the current instant.
    pub fn sample_is_due(&self) -> bool {
        self.sensors.sample_is_due(self.clock.now())
    }

    /// Reads the sample at the current instant before the estimator uses it, and returns its angle (rad); `None` if the
    /// sensor gives no measurement.
    ///
    /// # Errors
    /// Fails if the state is no longer finite.
    pub fn read_sample_ahead(&mut self) -> Result<Option<f64>, SimulationError> {
        let now = self.clock.now();
        self.plant.evaluate(now)?;
        let measured = self.sensors.read_ahead(now, &self.plant, self.estimation.origin());
        Ok(measured.then(|| self.sensors.measured[0][0]))
    }

    /// Returns the filter, and the mean reduced moment since its last sample (rad/s²).
    pub fn filter(&mut self) -> Option<(&mut KalmanFilter, Option<f64>)> {
        self.estimation.batch_filter(self.clock.now())
    }

    /// Returns the true values of the filter's state components.
    pub fn true_state(&mut self) -> Vec<f64> {
        self.estimation.true_filter_state(self.clock.now(), &self.plant)
    }

    /// Ends the run, if it is at its end.
    ///
    /// # Errors
    /// Fails like [`Simulation::run_until`].
    pub fn finish_external(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.plant.evaluate(self.clock.now())?;
        self.finish(record)
    }
}
