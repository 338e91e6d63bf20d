//! Estimators: they compute the laws' state estimate from commands and measurements.

mod adaptation_run;
pub mod adaptive;
mod applied_pulses;
pub mod attitude;
mod consistency;
mod envelope;
mod envelope_monitor;
mod estimator_spec;
mod ideal_observer;
pub mod kalman;
mod objective_meter;
mod pass_through;
mod requirements;
mod rigid_rate;
mod sample_cost;
mod sampled;

use std::borrow::Cow;

use flexsc_dynamics::AxisState;
use flexsc_dynamics::axis_model::AxisModel;
use flexsc_dynamics::frequency_drift::FrequencyDrift;
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::{Instant, Span};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::actuator::PulsedActuator;
use crate::kinds::kinds;
use crate::part::Part;
use crate::sensor::{Orientation, Reading, VectorMeasurement};
use crate::state_estimate::{EstimateNeeds, StateEstimate};

pub use adaptation_run::AdaptationRun;
pub use adaptive::Adaptive;
pub use applied_pulses::AppliedPulses;
pub use attitude::AttitudeFilter;
pub use consistency::chi_square;
pub use envelope::{Envelope, EnvelopeMethod, EnvelopeMonitor};
pub use envelope_monitor::{EnvelopeWindow, WindowedEnvelope};
pub use estimator_spec::EstimatorSpec;
pub use ideal_observer::IdealObserver;
pub use kalman::{ExtendedKalman, FrequencyTracking, Kalman, UnscentedKalman};
pub use objective_meter::{MotionSample, ObjectiveMeter, ObjectiveWindow};
pub use rigid_rate::RigidRate;
pub use sampled::{LinearFilter, linear_filters};

kinds! {
    /// The kinds of estimator.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[schemars(rename = "Estimator")]
    pub enum EstimatorKind: dyn EstimatorSpec {
        /// The envelope of the elastic modes and its window means.
        "envelope" Envelope(Envelope),
        /// The true dominant mode, as an ideal observer gives it.
        "truth" Truth(IdealObserver),
        /// A Kalman filter of the motion, with constant natural frequencies.
        "kalman" Kalman(Kalman),
        /// An extended Kalman filter of the motion and the natural frequencies.
        #[schemars(with = "FrequencyTracking")]
        "extended_kalman" ExtendedKalman(ExtendedKalman),
        /// An unscented Kalman filter of the motion and the natural frequencies.
        #[schemars(with = "FrequencyTracking")]
        "unscented_kalman" UnscentedKalman(UnscentedKalman),
        /// A multiplicative extended Kalman filter of the attitude and gyro bias of a spatial body.
        "attitude" Attitude(AttitudeFilter),
        /// The rigid rates of a spatial body.
        "rigid_rate" RigidRate(RigidRate),
        /// Adaptive observers of the rigid rates and elastic modes of a spatial body.
        "adaptive" Adaptive(Box<Adaptive>),
    }
    own "An estimator from another crate; a scenario file cannot name it."
}

/// Scenario data that an estimator is built from.
#[derive(Clone, Debug)]
pub struct EstimatorContext<'a> {
    /// Estimator that the scenario asks for, if any.
    pub estimator: Option<&'a EstimatorKind>,
    /// Single-axis models of the body, one for each of its axes.
    pub axes: &'a [AxisModel],
    /// Back-EMF torque of a wheel per unit of rate (N m s); true if the rate is that of the elastic body, not the rigid
    /// one.
    pub back_emf: (f64, bool),
    /// Drift of the natural frequencies.
    pub drift: Option<&'a FrequencyDrift>,
    /// Sampling period; `None` without sampling.
    pub sampling: Option<Span>,
    /// Standard deviation of the sensor's angle (rad).
    pub angle_noise: f64,
    /// Standard deviation of the measured rate (rad/s) about each axis; `None` where no rate is measured.
    pub rate_noise: Vec<Option<f64>>,
    /// Estimates that the law about each axis reads.
    pub reads: Vec<EstimateNeeds>,
    /// Design of adaptive observers, if they are used.
    pub adaptive: Option<&'a adaptive::ObserverDesign>,
    /// Noise, latency and role of each sensor for an attitude filter.
    pub attitude: Option<&'a attitude::FilterSetup>,
}

/// Sensor sample with its time, the target, the actuator's output and the true state.
pub struct SampleContext<'a> {
    /// Time of the sample.
    pub now: Instant,
    /// Angle (rad) and rate (rad/s) about each axis; `None` if the sensor is silent.
    pub measured: Option<&'a [[f64; 2]]>,
    /// Reading of each sensor now, in the order of the scenario; `None` of a sensor that is not due or silent.
    pub readings: &'a [Option<Reading>],
    /// Orientation from which angles are measured.
    pub origin: &'a Orientation,
    /// True motion about an axis, for ideal observers.
    pub truth: &'a dyn Fn(usize) -> Cow<'a, AxisState>,
    /// Torque that the actuator holds about an axis (N m).
    pub held_torque: &'a dyn Fn(usize) -> f64,
    /// Actuator's jets with their executed and waiting pulses, if it has any.
    pub pulses: Option<&'a dyn PulsedActuator>,
    /// Change of the rate about the first axis (rad/s) that a command waveform has caused since the last sample.
    pub waveform_impulse: f64,
    /// Longest lead time (s) for which laws read predicted elastic rates.
    pub ahead: f64,
}

/// How well an attitude filter knows the attitude.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct FilterHealth {
    /// Time since the exposure of the last measurement that corrected it, or since the start (s).
    pub age: f64,
    /// Size of the innovation of the last correction (rad).
    pub innovation: f64,
    /// Standard deviation of the attitude about all axes together, by its covariance (rad).
    pub deviation: f64,
}

/// Run-time state of an estimator, which writes the whole state estimate of each axis.
pub trait Estimator: Part {
    /// Sets the reduced moments about the axes (rad/s²) that the actuator applies from now on.
    fn input_changed(&mut self, _now: Instant, _moments: [f64; 3]) {}

    /// Updates the state estimate with a sample.
    fn update(&mut self, taken: &SampleContext<'_>, state_estimates: &mut [StateEstimate]);

    /// Predicts the state estimate from the last sample to now, with angles from `origin`.
    fn predict(&self, _now: Instant, _origin: &Orientation, _state_estimates: &mut [StateEstimate]) {}

    /// Shifts the angle estimates by `by` (rad, about each axis) after a change of the target.
    fn shift_origin(&mut self, _by: [f64; 3]) {}

    /// Returns the known inputs about the axes with which filters have predicted the last sample: of Kalman filters the mean
    /// reduced moments (rad/s²), of filters of the rigid rate the changes of the rate by pulses (rad/s).
    fn known_inputs(&self) -> [f64; 3] {
        [0.0; 3]
    }

    /// Returns a vector that a sensor has measured, and that became available at an instant, with the reference with which the
    /// estimator compares it.
    fn with_reference(&self, _sensor: usize, measured: VectorMeasurement, _at: Instant) -> VectorMeasurement {
        measured
    }

    /// Returns true about each axis whose filter has lost lock.
    fn lock_lost(&self) -> [bool; 3] {
        [false; 3]
    }

    /// Returns how well an attitude filter knows the attitude at `now`; `None` of other estimators, and before its start.
    fn filter_health(&self, _now: Instant) -> Option<FilterHealth> {
        None
    }

    /// Returns the interface for a batch that processes the samples of many runs; `None` for most estimators.
    fn batch(&mut self) -> Option<&mut dyn BatchEstimator> {
        None
    }

    /// Returns a copy in the same state.
    fn copy(&self) -> Box<dyn Estimator>;
}

/// Estimator whose filter a batch can process.
pub trait BatchEstimator {
    /// Returns the filter of a one-axis body, and the mean reduced moment (rad/s²) from its last sample to `now`; the
    /// moment is `None` before the first sample.
    fn batch_filter(&mut self, now: Instant) -> Option<(&mut kalman::KalmanFilter, Option<f64>)>;

    /// Returns the true values of the state components of that filter.
    fn true_filter_state(&self, now: Instant, truth: &AxisState) -> Vec<f64>;
}

impl Clone for Box<dyn Estimator> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

/// Returns the run-time state of the scenario's estimator, or a pass-through without one.
pub fn start(known: &EstimatorContext<'_>, seed: Seed) -> Box<dyn Estimator> {
    known.estimator.map_or_else(|| Box::new(pass_through::PassThrough) as _, |spec| spec.start(known, seed))
}

/// Estimates that the law reads in addition to the dominant mode.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Feeds")]
pub enum EstimateOutputs {
    /// The dominant mode only; angle and rate are as measured.
    Modes,
    /// Angle and rate of the hub, elastic part included.
    Hub,
    /// The rigid angle and rate.
    Rigid,
}

impl EstimateOutputs {
    /// Returns the given outputs, or the default ones: for a law that reads the dominant mode (`dominant`) nothing more,
    /// else the motion of the hub.
    pub(crate) fn given_or_default(given: Option<Self>, dominant: bool) -> Self {
        given.unwrap_or(if dominant { Self::Modes } else { Self::Hub })
    }
}

impl EstimatorKind {
    /// Error text for an estimator that needs samples where there are none.
    pub const AT_SAMPLES: &str = "acts at each sample of a `[sensor.sampled]` or a `[sensor.gyro]`, or of a law with a period, and \
                                  there is none";

    /// Returns the attitude filter, if the estimator is one.
    pub fn attitude(&self) -> Option<&AttitudeFilter> {
        if let Self::Attitude(filter) = self { Some(filter) } else { None }
    }

    /// Returns the envelope monitor, if the estimator is one.
    pub fn envelope(&self) -> Option<&Envelope> {
        if let Self::Envelope(envelope) = self { Some(envelope) } else { None }
    }

    /// Between these the normalised estimation error squared of a sample, over its number of states, lies with a probability of 95 %
    /// if the filter is consistent.
    pub fn inside(states: usize) -> [f64; 2] {
        chi_square(states).map(|bound| bound / states as f64)
    }
}
