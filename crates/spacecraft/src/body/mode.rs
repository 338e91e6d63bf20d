//! One elastic mode, x'' + 2 zeta w x' + w² x = k m, as a scenario describes it.

use flexsc_dynamics::axis_model::AxisMode;
use flexsc_numerics::quantity::{Finite, Frequency, NonNegative};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An elastic mode (\[Silaev\], equation (1), with damping added).
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mode {
    /// Natural frequency w (rad/s).
    pub frequency: Frequency,
    /// Modal gain k: modal acceleration per unit of rigid acceleration.
    pub gain: Finite,
    /// Modal gain of a torque on the hub, if the commanded torque acts elsewhere: it determines the energy of the mode;
    /// default: `gain`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hub_gain: Option<Finite>,
    /// Damping ratio zeta: 0 undamped, 1 critical; more than 1 is allowed except with an `[estimator.envelope]`.
    #[serde(default)]
    pub damping: NonNegative,
    /// Displacement at the start (rad).
    #[serde(default)]
    pub displacement: Finite,
    /// Rate at the start (rad/s).
    #[serde(default)]
    pub rate: Finite,
}

impl From<&Mode> for AxisMode {
    fn from(mode: &Mode) -> Self {
        let Mode { frequency, gain, hub_gain, damping, displacement, rate } = *mode;
        Self { frequency, gain, hub_gain: hub_gain.unwrap_or(gain), damping, displacement, rate }
    }
}

impl From<&AxisMode> for Mode {
    fn from(mode: &AxisMode) -> Self {
        let AxisMode { frequency, gain, hub_gain, damping, displacement, rate } = *mode;
        let hub_gain = Some(hub_gain).filter(|at_hub| *at_hub != gain);
        Self { frequency, gain, hub_gain, damping, displacement, rate }
    }
}
