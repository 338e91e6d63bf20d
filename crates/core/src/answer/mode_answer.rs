//! Mode of operation in the answer: visits, time, pointing error, wheel speed, and time at a limit.

use serde::Serialize;

use super::error_statistics::ErrorSummary;
use super::lines::RunData;

/// Times at limits by mode, one list for each kind of limit.
const LIMIT_TIMES: [&str; 5] = [
    "wheel_torque_limit_times_s",
    "wheel_momentum_limit_times_s",
    "moment_limit_times_s",
    "jet_limit_times_s",
    "gimbal_rate_limit_times_s",
];

/// Mode of operation of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModeAnswer {
    /// Name.
    pub mode: String,
    /// Number of starts.
    pub visits: u64,
    /// Time in the mode (s).
    pub time_s: f64,
    /// Norm of the pointing error; absent without a target.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_rad: Option<ErrorSummary>,
    /// Largest speed of a wheel (rad/s).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wheel_speed_rad_s: Option<f64>,
    /// Longest time with actuators at limits of one kind (s).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_limit_s: Option<f64>,
}

impl RunData<'_> {
    /// Returns each mode of operation that was entered.
    pub(super) fn by_mode(&self) -> Vec<ModeAnswer> {
        let [times, visits] = ["mode_times_s", "mode_visits"].map(|name| self.list(name));
        let limits = LIMIT_TIMES.map(|name| self.list(name));
        let row = |(index, mode): (usize, &flexsc_control::operation::OperatingMode)| {
            let own = self.observed.and_then(|observed| observed.modes.get(index));
            let at_limit = limits.iter().filter_map(|of| of.get(index).copied()).fold(f64::NAN, f64::max);
            ModeAnswer {
                mode: mode.name.clone(),
                visits: visits.get(index).copied().unwrap_or(0.0) as u64,
                time_s: times.get(index).copied().unwrap_or(0.0),
                error_rad: own.and_then(super::run_observer::ModeObserved::errors),
                wheel_speed_rad_s: own.map(|own| own.wheel_speed[1]).filter(|speed| speed.is_finite()),
                at_limit_s: Some(at_limit).filter(|time| time.is_finite()),
            }
        };
        self.scenario.mode.iter().enumerate().map(row).collect()
    }
}
