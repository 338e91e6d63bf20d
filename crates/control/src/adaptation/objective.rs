//! Objectives of an adaptation: the quantities over each window that it reduces.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::offers::Offers;

/// Quantity that is measured over each window.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Objective {
    /// Mean of the envelope (rad), over the windows of the `[estimator.envelope]`.
    #[default]
    EnvelopeMean,
    /// Mean distance from the goal (rad); on three axes the norm of the pointing error.
    PointingErrorMean,
    /// Root mean square of that distance (rad).
    PointingErrorRms,
    /// Largest such distance (rad).
    PointingErrorPeak,
    /// Root mean square of the rate beyond that of the goal (rad/s).
    RateErrorRms,
    /// Root mean square of the elastic part of the angle (rad); on three axes of the elastic rotation at the first sensor.
    ElasticRms,
    /// Mean absolute torque of the actuator (N m); on three axes the norm.
    TorqueMean,
    /// Number of switchings of the law, about all axes.
    Switchings,
    /// Number of pulses of jets, or how often thrusters begin to push.
    Firings,
    /// Mean of the absolute mechanical power of all wheels (W).
    WheelPowerMean,
}

impl Objective {
    /// All objectives.
    pub const ALL: [Self; 10] = [
        Self::EnvelopeMean,
        Self::PointingErrorMean,
        Self::PointingErrorRms,
        Self::PointingErrorPeak,
        Self::RateErrorRms,
        Self::ElasticRms,
        Self::TorqueMean,
        Self::Switchings,
        Self::Firings,
        Self::WheelPowerMean,
    ];

    /// Returns the objective with this name in a scenario.
    pub fn from_key(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|objective| objective.key() == word)
    }

    /// Returns true for the default.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the name of the objective in a scenario.
    pub fn key(self) -> &'static str {
        match self {
            Self::EnvelopeMean => "envelope_mean",
            Self::PointingErrorMean => "pointing_error_mean",
            Self::PointingErrorRms => "pointing_error_rms",
            Self::PointingErrorPeak => "pointing_error_peak",
            Self::RateErrorRms => "rate_error_rms",
            Self::ElasticRms => "elastic_rms",
            Self::TorqueMean => "torque_mean",
            Self::Switchings => "switchings",
            Self::Firings => "firings",
            Self::WheelPowerMean => "wheel_power_mean",
        }
    }

    /// Returns the reason why the objective cannot be measured with these parts, if it cannot.
    pub fn obstacle(self, offers: &Offers) -> Option<&'static str> {
        let has_jets = offers.has_actuator(|actuator| actuator.has_jets);
        let listed = || offers.actuators.iter().filter(|member| member.is_listed).count();
        match self {
            Self::ElasticRms if offers.body.modes == 0 || offers.body.is_chain => {
                Some("needs elastic modes, and the body has none")
            }
            Self::WheelPowerMean if !offers.lists_actuator(|actuator| actuator.has_wheel_speeds) => {
                Some("needs wheels whose speed is known: an `[actuator.wheels]`, or a wheel with a `rotor`")
            }
            Self::Firings if !offers.has_actuator(|actuator| actuator.pulses) => {
                Some("counts pulses of thrusters or jets, and there are none")
            }
            Self::Firings if !has_jets && listed() > 1 => Some(
                "counts the pulses of thrusters in the torque on the body, which is theirs alone if there are no other actuators",
            ),
            Self::Switchings if !offers.laws.iter().any(|law| law.offers.has_states) => {
                Some("counts the switchings of a law `relay` or `phase_plane`, and there is none")
            }
            Self::TorqueMean if offers.lists_actuator(|actuator| actuator.turns_with_field) => {
                Some("is not known for magnetorquers, whose torque changes with the field")
            }
            Self::TorqueMean if offers.lists_actuator(|actuator| actuator.turns_with_gimbals) => Some(
                "is not known for control moment gyros, whose torque changes with the gimbal angles between commands",
            ),
            _ => None,
        }
    }

    /// Returns the unit of the objective, given that of torques.
    pub fn unit(self, torque: &'static str) -> &'static str {
        match self {
            Self::EnvelopeMean
            | Self::PointingErrorMean
            | Self::PointingErrorRms
            | Self::PointingErrorPeak
            | Self::ElasticRms => "rad",
            Self::RateErrorRms => "rad/s",
            Self::TorqueMean => torque,
            Self::Switchings | Self::Firings => "",
            Self::WheelPowerMean => "W",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_those_of_scenarios() {
        #[derive(Deserialize)]
        struct Of {
            objective: Objective,
        }
        for objective in Objective::ALL {
            let text = format!("objective = \"{}\"", objective.key());
            assert_eq!(flexsc_formats::document::from_text::<Of>(&text).unwrap().objective, objective);
            assert_eq!(Objective::from_key(objective.key()), Some(objective));
        }
    }
}
