//! Poles of a body whose wheels turn with points of the structure: modes that whirl.

use flexsc_formats::document::ConfigError;
use schemars::JsonSchema;
use serde::Serialize;

use super::eigenvalues::eigenvalues;
use super::linear_model::LinearModel;
use super::margins::frequency_response::modulus;
use super::state_space::StateSpaceModel;
use flexsc_scenario::Scenario;

/// Part of the largest pole below which a frequency is rounding.
const ROUNDING: f64 = 1e-9;

/// Poles of a body with the wheels at a speed.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct WhirlPoles {
    /// Speed of the wheels that points of the structure carry (rad/s); none for that of each at the start.
    pub wheel_speed_rad_s: Option<f64>,
    /// Poles in increasing order of their frequencies.
    pub poles: Vec<BodyPole>,
}

/// Pair of complex poles.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct BodyPole {
    /// Magnitude (rad/s).
    pub frequency_rad_s: f64,
    /// Damping ratio.
    pub damping: f64,
}

impl WhirlPoles {
    /// Returns the oscillations of a scenario's body at rest, without its loop, with the wheels that points of the structure carry at
    /// a speed (rad/s), or each at its speed at the start; `None` if there are none.
    ///
    /// # Errors
    /// A body that is no linear system: its key, and the reason.
    pub fn from_scenario(scenario: &Scenario, speed: Option<f64>) -> Result<Option<Self>, ConfigError> {
        if scenario.study.carried_rotors.is_empty() {
            return Ok(None);
        }
        let model = match speed {
            Some(speed) => LinearModel::at_wheel_speed(scenario, speed)?,
            None => LinearModel::from_scenario(scenario, 0.0)?,
        };
        let a = StateSpaceModel::from(model).matrices.a;
        // Without the rigid angles, on which nothing depends.
        let all = eigenvalues(&a.view_range(3.., 3..).into_owned()).unwrap_or_default();
        let least = ROUNDING * all.iter().map(|pole| modulus(*pole)).fold(0.0, f64::max);
        let oscillations = all.into_iter().filter(|pole| pole.im > least);
        let pole = |pole| BodyPole { frequency_rad_s: modulus(pole), damping: -pole.re / modulus(pole) };
        let mut poles: Vec<BodyPole> = oscillations.map(pole).collect();
        poles.sort_by(|a, b| a.frequency_rad_s.total_cmp(&b.frequency_rad_s));
        Ok(Some(Self { wheel_speed_rad_s: speed, poles }))
    }
}
