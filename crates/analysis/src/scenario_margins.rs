//! Margins of the loop of a scenario: those of its signals, and in time the delay that all commands tolerate together and the
//! settling after a step.

use std::fmt;

use flexsc_formats::document::ConfigError;
use schemars::JsonSchema;
use serde::Serialize;

use super::fine_mirror::mirror_margins;
use super::margins::{SignalMargins, StabilityMargins, UnstableLoop, common_delay};
use super::open_loop::{LoopBreak, LoopParts, OpenLoop};
use super::settling_time::SettlingTime;
use flexsc_scenario::Scenario;

/// Margins of the loop of a scenario, cut open at a point.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ScenarioMargins {
    /// Margins of the signals.
    #[serde(flatten)]
    pub stability: StabilityMargins,
    /// Loop, cut open.
    #[serde(skip)]
    pub cut: OpenLoop,
    /// Smallest additional delay (s) of all actuators together that makes the loop unstable.
    #[schemars(extend("x-name" = "delay", "x-null" = "infinite"))]
    pub common_delay_s: Option<f64>,
    /// Settling times of each angle after a step of the target about each axis; none if they cannot be computed.
    #[schemars(extend("x-name" = "settling_times"))]
    pub settling: Vec<SettlingTime>,
    /// Margins of the loops of fine mirrors, cut open at the means of their guidance sensors.
    #[schemars(extend("x-key" = "signal"))]
    pub mirrors: Vec<SignalMargins>,
}

/// Reason why a scenario has no margins.
#[derive(Clone, Debug, PartialEq)]
pub enum MarginsFault {
    /// Part of the scenario that has no linear model.
    Key(ConfigError),
    /// Loop that is not stable.
    Unstable(UnstableLoop),
}

impl fmt::Display for MarginsFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Key(fault) => write!(f, "`{}` {}", fault.key, fault.why),
            Self::Unstable(unstable) => write!(f, "{unstable}"),
        }
    }
}

impl std::error::Error for MarginsFault {}

impl ScenarioMargins {
    /// Computes the margins of a scenario's loop, cut open at a point.
    ///
    /// # Errors
    /// A scenario without a linear loop, and a loop that is not stable.
    pub fn from_scenario(scenario: &Scenario, opened: LoopBreak) -> Result<Self, MarginsFault> {
        let parts = LoopParts::from_scenario(scenario, opened).map_err(MarginsFault::Key)?;
        let cut = OpenLoop::from_parts(&parts).map_err(MarginsFault::Key)?;
        let stability = StabilityMargins::new(&cut).map_err(MarginsFault::Unstable)?;
        let mirrors = mirror_margins(scenario).map_err(MarginsFault::Unstable)?;
        let mirrors = mirrors.into_iter().flat_map(|own| own.loops).collect();
        let parts = parts.opened_at(LoopBreak::Command);
        let common_delay_s = common_delay(&parts).map_err(MarginsFault::Key)?;
        let settling = parts.settling_times().unwrap_or_default();
        Ok(Self { stability, cut, common_delay_s, settling, mirrors })
    }
}
