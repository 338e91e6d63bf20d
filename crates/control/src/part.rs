//! Interface of every part of a run: sensors, estimators, laws, actuators and adaptations.

use std::borrow::Cow;
use std::fmt;

use flexsc_dynamics::AxisState;
use flexsc_dynamics::three_axis::RotorObservation;
use flexsc_numerics::time::Instant;
use flexsc_record::Report;

use crate::custom::PartError;
use crate::orientation::Orientation;
use crate::state_estimate::DampingStatus;

/// Part of a run: it may act by itself, report rows for the log, and fail.
pub trait Part: fmt::Debug + Send + Sync {
    /// Returns the next instant at which the part acts by itself.
    fn due(&self) -> Option<Instant> {
        None
    }

    /// Adds the part's rows for the log, and the values that metrics and figures read, to a report.
    fn report(&self, _at: &ReportContext<'_>, _report: &mut Report) {}

    /// Returns the error that a custom part failed with; the run ends there.
    fn failure(&self) -> Option<PartError> {
        None
    }
}

/// Occasion of a report.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Occasion {
    /// Sample of the sensors, after the estimator has processed it; only the estimator reports.
    Sample,
    /// Start of a cycle of a three-axis body, in every run; estimator and actuator report.
    Cycle,
    /// Period of a full log, and beginning or end of a pulse; every part reports.
    Period,
}

/// Circumstances of a report.
pub struct ReportContext<'a> {
    /// Instant of the report.
    pub now: Instant,
    /// Occasion of the report.
    pub occasion: Occasion,
    /// Number of axes of the body: 1 or 3.
    pub axes: usize,
    /// True state of the body.
    pub truth: &'a dyn TrueState,
    /// Status of active damping about each axis, in reports of a cycle; otherwise empty.
    pub damping: &'a [DampingStatus],
}

/// True state of a body at the instant of a report.
pub trait TrueState {
    /// Returns the orientation of the body.
    fn orientation(&self) -> Orientation;

    /// Returns the rates at the first sensor, elastic part included, and the rigid rates (rad/s).
    fn rates(&self) -> [[f64; 3]; 2];

    /// Returns the motion about an axis, with angles from the origin of the run.
    fn about_axis(&self, axis: usize) -> Cow<'_, AxisState>;

    /// Returns the rates of the modes of a three-axis body (m sqrt(kg)/s).
    fn mode_rates(&self) -> Vec<f64>;

    /// Returns the states of the wheels in bearings.
    fn rotors(&self) -> Vec<RotorObservation>;

    /// Returns the true bias of the first gyro (rad/s); 0 without a gyro.
    fn gyro_bias(&self) -> [f64; 3];
}
