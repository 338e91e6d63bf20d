//! Mode of operation in the answer: visits, time, pointing error, wheel speed, and time at a limit.

use serde::Serialize;

use super::error_statistics::ErrorSummary;
use super::lines::RunData;

/// Times at limits by mode, one list for each kind of limit, with the word for the limit.
pub(super) const LIMIT_TIMES: [(&str, &str); 5] = [
    ("wheel_torque_limit_times_s", "torque"),
    ("wheel_momentum_limit_times_s", "speed"),
    ("moment_limit_times_s", "rods"),
    ("jet_limit_times_s", "jets"),
    ("gimbal_rate_limit_times_s", "gimbals"),
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
    /// Limit at which this longest time is spent: `torque` or `speed` of wheels, `rods`, `jets` or `gimbals`; absent if none is reached.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_limit_of: Option<&'static str>,
}

impl RunData<'_> {
    /// Returns each mode of operation that was entered.
    pub(super) fn by_mode(&self) -> Vec<ModeAnswer> {
        let [times, visits] = ["mode_times_s", "mode_visits"].map(|name| self.list(name));
        let limits = LIMIT_TIMES.map(|(name, word)| (self.list(name), word));
        let row = |(index, mode): (usize, &flexsc_control::operation::OperatingMode)| {
            let own = self.observed.and_then(|observed| observed.modes.get(index));
            let reached = limits.iter().filter_map(|(of, word)| Some((of.get(index).copied()?, *word)));
            let longest = reached.reduce(|most, own| if own.0 > most.0 { own } else { most });
            ModeAnswer {
                mode: mode.name.clone(),
                visits: visits.get(index).copied().unwrap_or(0.0) as u64,
                time_s: times.get(index).copied().unwrap_or(0.0),
                error_rad: own.and_then(super::run_observer::ModeObserved::errors),
                wheel_speed_rad_s: own.map(|own| own.wheel_speed[1]).filter(|speed| speed.is_finite()),
                at_limit_s: longest.map(|(time, _)| time),
                at_limit_of: longest.filter(|(time, _)| *time > 0.0).map(|(_, word)| word),
            }
        };
        self.scenario.mode.iter().enumerate().map(row).collect()
    }
}
