//! Adaptive observers of one channel of a rate sensor: rigid rate, dominant elastic modes, and their parameters.
//!
//! y = w + sum g_i: the measured rate is the rigid one plus the elastic rates of some modes, which known pulses of
//! thrusters excite. The natural frequencies and the influence of the thrusters on each mode are identified as the
//! observer runs. Two forms exist: the recurrence of \[Timakov14\] (pages 41 to 46) and a recursive gradient with exact
//! pulses.

mod axis_observer;
mod design;
mod gradient;
mod observers_state;
mod oscillator;
mod recurrence;
mod residual;
mod spec;
#[cfg(test)]
mod tests;
mod tracker;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{NonNegative, Positive};

pub use crate::actuator::Pulse;
pub use axis_observer::AxisObserver;
pub use design::{ActuatorInput, AxisObserverDesign, ObserverDesign, RateMeasurement};
pub use gradient::{Gradient, GradientObserver};
pub use observers_state::ObserverSet;
pub use oscillator::{ModeVector, OscillatorModel};
pub use recurrence::{Recurrence, RecurrenceObserver, RecurrenceWeights};
pub use residual::MovingResidual;
pub use spec::{Adaptive, GivenModes, ObserverForm};
pub use tracker::{MergedTracker, Tracker, bounds, merge};

/// Observer's estimate of a mode.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModeEstimate {
    /// Elastic rate g of the mode in the channel, and s, which lags it by a quarter of a period (rad/s).
    pub phase: ModeVector,
    /// Natural frequency (rad/s).
    pub frequency: f64,
    /// Influence of each input (dimensionless).
    pub influence: Vec<f64>,
}

impl ModeEstimate {
    /// Returns the amplitude of the elastic rate (rad/s).
    pub fn amplitude(&self) -> f64 {
        amplitude(&self.phase)
    }

    /// Returns the angle of the mode (rad), from the component s that lags the rate by a quarter of a period.
    pub fn displacement(&self) -> f64 {
        self.phase[1] / self.frequency
    }
}

/// Returns the amplitude (rad/s) of an elastic rate and the component that lags it by a quarter of a period.
fn amplitude(phase: &ModeVector) -> f64 {
    libm::hypot(phase[0], phase[1])
}

/// Returns true if the amplitude is above a positive bound (rad/s). The root is only taken near the bound.
fn is_above(phase: &ModeVector, bound: f64) -> bool {
    let (square, bound_square) = (phase[0] * phase[0] + phase[1] * phase[1], bound * bound);
    let is_clear = (square - bound_square).abs() > 1e-9 * bound_square && bound_square > f64::MIN_POSITIVE;
    if is_clear { square > bound_square } else { amplitude(phase) > bound }
}

/// Returns the first key of either form that is inconsistent with the others, the trackers, the number of inputs or the
/// sampling period (s), and the reason. Bounds and reach are relative to the initial values.
fn validate(
    damping: NonNegative,
    influence_bounds: [NonNegative; 2],
    reach: Positive,
    trackers: &[Tracker],
    inputs: usize,
    period: f64,
) -> Option<ConfigError> {
    let error_at = |key: &str, why: String| Some(ConfigError::new(key, why));
    let (damping, reach) = (damping.get(), reach.get());
    if damping >= 1.0 {
        return error_at("damping", format!("must be below 1, got {damping}"));
    }
    let [low, high] = influence_bounds.map(NonNegative::get);
    if !(low <= 1.0 && 1.0 <= high && low < high) {
        let why = format!("must be [low, high] with 1, the start, between them, got [{low}, {high}]");
        return error_at("influence_bounds", why);
    }
    if reach <= 1.0 {
        return error_at("reach", format!("must be above 1, got {reach}"));
    }
    tracker::validate(trackers, reach, inputs, period)
}

/// Run-time observer of one axis: at each sample `update`, then `advance` over the cycle that follows.
pub trait AdaptiveObserver {
    /// Updates the estimates with the measured rate (rad/s). A value that is not finite, or unrealistic, is dropped.
    fn update(&mut self, measured: f64);

    /// Propagates the estimates over a cycle to the next sample under the pulses that are executed in it.
    fn advance(&mut self, pulses: &[Pulse]);

    /// Predicts the elastic rate of each mode (rad/s) at `ahead` (s) after the last sample, under all pulses until
    /// then.
    fn predict(&self, ahead: f64, pulses: &[Pulse]) -> Vec<f64>;

    /// Returns the rigid rate (rad/s).
    fn rate(&self) -> f64;

    /// Writes the mode estimates into `modes`, replacing its contents.
    fn put_modes(&self, modes: &mut Vec<ModeEstimate>);

    /// Returns the mode estimates.
    fn modes(&self) -> Vec<ModeEstimate> {
        let mut modes = Vec::new();
        self.put_modes(&mut modes);
        modes
    }

    /// Returns the moving mean squares of innovation and elastic rate.
    fn residual(&self) -> MovingResidual;
}
