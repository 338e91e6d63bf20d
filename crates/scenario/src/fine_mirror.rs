//! Fine mirror of a line of sight: a loop of its own that turns the image back, by the means of a guidance sensor over exposures.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::exponential::exponential;
use flexsc_numerics::quantity::{Frequency, NonNegative, Positive};
use flexsc_numerics::time::Span;
use nalgebra::{DMatrix, Matrix4};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Largest number of periods that a command may wait.
const MOST_WAITING: usize = 8;

/// Fine mirror behind a line of sight. About each of two axes across the line, its command changes at the end of each period by
/// `gain` times the mean of the error that is left, over an exposure of a guidance sensor. All angles are rotations of the
/// line of sight. The reaction torque on the body is left out.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FineMirror {
    /// Natural frequency of the mirror on its drive (rad/s).
    pub frequency: Frequency,
    /// Damping ratio of the mirror on its drive: 1 critical.
    pub damping: Positive,
    /// Period of its loop (s), over the whole of which the guidance sensor exposes.
    pub period: Span,
    /// Part of the mean error of an exposure by which the command changes.
    pub gain: Positive,
    /// Whole periods from the end of an exposure to the change of the command that it causes.
    #[serde(default = "one")]
    pub computing_periods: usize,
    /// Standard deviation of the noise of a mean over an exposure, about each axis (rad).
    #[serde(default)]
    pub noise: NonNegative,
    /// Largest command of either sign about each axis (rad); default: no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stroke: Option<Positive>,
    /// Largest change of the command about each axis in a period, over the period (rad/s); default: no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<Positive>,
}

fn one() -> usize {
    1
}

impl FineMirror {
    /// Returns the motion about an axis over a time (s) under a held command: rows and columns are the angle, its rate, the
    /// command, and the integral of the angle.
    pub fn flow(&self, time: f64) -> Matrix4<f64> {
        let (frequency, damping) = (self.frequency.get(), self.damping.get());
        let stiffness = frequency * frequency;
        let mut rates = DMatrix::zeros(4, 4);
        rates[(0, 1)] = 1.0;
        (rates[(1, 0)], rates[(1, 1)]) = (-stiffness, -2.0 * damping * frequency);
        rates[(1, 2)] = stiffness;
        rates[(3, 0)] = 1.0;
        let flow = exponential(&(rates * time));
        Matrix4::from_fn(|row, column| flow[(row, column)])
    }

    /// Returns the command that follows another one by a change (rad), within stroke and rate, and whether a limit shortened it.
    pub fn limited(&self, before: f64, change: f64) -> (f64, bool) {
        let within = |value: f64, limit: Option<f64>| limit.map_or(value, |limit| value.clamp(-limit, limit));
        let step = within(change, self.rate.map(|rate| rate.get() * self.period.seconds()));
        let command = within(before + step, self.stroke.map(Positive::get));
        (command, command != before + change)
    }

    /// Checks the mirror; returns the inconsistent key and the reason.
    pub(super) fn fault(&self) -> Option<ConfigError> {
        (self.computing_periods > MOST_WAITING).then(|| {
            let why = format!("must be at most {MOST_WAITING}, got {}", self.computing_periods);
            ConfigError::new("computing_periods", why)
        })
    }
}
